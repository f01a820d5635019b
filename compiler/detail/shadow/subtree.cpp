#include "compiler/detail/shadow/subtree.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <glm/geometric.hpp>

#include "compiler/graph/walk.h"

namespace graftal {

namespace {

/// Factor on the cost of a measurement for a primitive of several bodies.
constexpr std::size_t bodies_a_piece = 4;

/// The axes of an icosahedron, then those of a dodecahedron, turned away from the coordinate axes and
/// towards all sides alike.
std::vector<Vec3> directions(std::size_t count) {
    const double g = std::numbers::phi;
    std::vector<Vec3> axes;
    for (const double s : {1.0, -1.0})
        axes.insert(axes.end(), {{0, s, g}, {g, 0, s}, {s, g, 0}});
    for (const double s : {1.0, -1.0}) {
        axes.insert(axes.end(), {{s, 1, 1}, {-s, s, -1}});
        axes.insert(axes.end(), {{0, s / g, g}, {g, 0, s / g}, {s / g, g, 0}});
    }
    axes.resize(count);
    const Affine turn = Affine::rotate({0.36, 0.48, 0.8}, 37);
    double sign = 1;
    for (Vec3& axis : axes) {
        axis = sign * glm::normalize(turn(axis));
        sign = -sign;
    }
    return axes;
}

} // namespace

ShadowMeasurer::ShadowMeasurer(const DetailGraph& cut, std::size_t direction_count)
    : cut_(cut), directions_(directions(direction_count)), coarse_(Effort::coarse_grid),
      fine_(Effort::fine_grid) {}

SubtreeShadow ShadowMeasurer::measure(NodeId node, const Effort& effort, bool ended) {
    unfold(node, effort.pieces, ended);
    place_bodies();
    SubtreeShadow result;
    result.seen.assign(followed_edges(cut_.nodes[node], ended).size(), 0);
    area_of_part_.assign(parts_.size(), 0);
    Shadow& shadow = effort.grid == Effort::coarse_grid ? coarse_ : fine_;
    const double square = 4.0 / (effort.grid * effort.grid);
    for (const Vec3& direction : directions_) {
        shadow.start(direction, cut_.nodes[node].ball);
        result.area.push_back(square * draw(shadow, result.seen));
        result.mean += result.area.back() / static_cast<double>(directions_.size());
    }
    const double sum = std::accumulate(area_of_part_.begin(), area_of_part_.end(), 0.0);
    result.centre = cut_.nodes[node].ball.centre;
    for (std::size_t i = 0; i < parts_.size() && sum > 0; ++i)
        result.centre += area_of_part_[i] / sum * (bodies_[i].centre - cut_.nodes[node].ball.centre);
    return result;
}

std::size_t ShadowMeasurer::bodies_of(const Part& part) const {
    const auto& primitive = cut_.nodes[part.node].primitive;
    return primitive && *primitive != PrimitiveKind::plane ? Shadow::bodies_of(*primitive) : 1;
}

/// Largest parts first.
void ShadowMeasurer::unfold(NodeId root, std::size_t most, bool ended) {
    parts_.clear();
    std::size_t bodies = 0;
    using Waiting = std::pair<double, std::int64_t>; // its size, and less its place among the parts
    Walk<Waiting, std::less<>> largest;
    const auto open = [&](const Part& parent, std::size_t reused) {
        const bool first = reused == SIZE_MAX;
        const std::vector<DetailEdge>& edges = followed_edges(cut_.nodes[parent.node], first && ended);
        for (std::uint32_t i = 0; i < edges.size(); ++i) {
            const DetailEdge& edge = edges[i];
            Part part{edge.child, parent.place * edge.node_from_child, parent.scale * edge.stretch,
                      first ? i : parent.edge, edge.material ? edge.material : parent.material};
            const std::size_t at = i == 0 && !first ? reused : parts_.size();
            if (at == parts_.size()) parts_.emplace_back();
            parts_[at] = part;
            bodies += bodies_of(part);
            // The earlier of two that are alike first.
            if (!cut_.nodes[part.node].edges.empty() && !cut_.nodes[part.node].is_combined())
                largest.push(
                    {part.scale * cut_.nodes[part.node].ball.radius, -static_cast<std::int64_t>(at)});
        }
    };
    open({root, {}, 1, 0, {}}, SIZE_MAX);
    // A cycle of single instances would be opened for ever, and never make more parts.
    Waiting next;
    while (largest.visits() < 4 * most && bodies < bodies_a_piece * most && largest.next(next)) {
        const auto at = static_cast<std::size_t>(-next.second);
        const Part part = parts_[at];
        if (parts_.size() + cut_.nodes[part.node].edges.size() <= most + 1) open(part, at);
    }
}

void ShadowMeasurer::place_bodies() {
    bodies_.clear();
    for (const Part& part : parts_) {
        const DetailNode& node = cut_.nodes[part.node];
        const Primitive primitive = node.primitive.value_or(PrimitiveKind::sphere);
        bodies_.push_back(
            {primitive,
             node.primitive ? part.place * solid_part(node, part) : part.place * node.node_from_proxy,
             part.place(node.primitive ? node.ball.centre : node.node_from_proxy.translation)});
    }
}

/// Where the material's picture is clear a primitive throws no shadow: it is as much smaller.
Affine ShadowMeasurer::solid_part(const DetailNode& primitive, const Part& part) const {
    const double coverage = part.material ? cut_.materials[*part.material].coverage : 1;
    if (coverage == 1) return {};
    const Vec3 centre = primitive.ball.centre;
    return Affine::translate(centre) * Affine::scale(Vec3(std::sqrt(coverage))) * Affine::translate(-centre);
}

/// The area of the union: the sum of the parts' areas, which is exact, times the share of it that the grid
/// finds not to overlap. Good for what is much thinner than the grid, too.
double ShadowMeasurer::draw(Shadow& shadow, std::vector<double>& seen) {
    order_.clear();
    for (std::size_t i = 0; i < parts_.size(); ++i)
        order_.emplace_back(shadow.depth(bodies_[i].centre), i);
    std::sort(order_.begin(), order_.end());
    double area = 0, samples = 0, uncovered = 0;
    for (const auto& [depth, i] : order_) {
        if (bodies_[i].primitive == PrimitiveKind::plane) continue;
        const Shadow::Cover cover = shadow.draw(bodies_[i].primitive, bodies_[i].place);
        area += cover.area;
        samples += cover.samples;
        uncovered += cover.uncovered;
        area_of_part_[i] += cover.area;
        seen[parts_[i].edge] += cover.area * (cover.samples > 0 ? cover.uncovered / cover.samples : 0.5);
    }
    return samples > 0 ? area * uncovered / samples : area;
}

} // namespace graftal
