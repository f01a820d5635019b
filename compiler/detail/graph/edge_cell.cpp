#include "compiler/detail/graph/edge_cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

using std::numbers::pi;

/// Limits for cells, as build_detail_graph.cpp has them for other objects.
constexpr std::size_t uncullable_leaves_of_cell = 16;
constexpr double thinnest_proxy_of_cell = 0.02;

CellEdge edge_to(const CellSource& source, const RunItem& item, RunShape shape, const Affine& place,
                 double length) {
    CellEdge edge;
    edge.shape = shape;
    edge.colour = item.colour;
    edge.child = source.child[shape.index()];
    edge.node_from_child = place;
    edge.material = source.materials[item.colour];
    edge.stretch = std::max(item.radius, length);
    edge.volume_stretch = std::cbrt(item.radius * item.radius * length);
    if (!(edge.volume_stretch > 0)) edge.volume_stretch = edge.stretch;
    edge.similarity = std::abs(length - item.radius) <= 1e-9 * edge.stretch;
    return edge;
}

/// The mean shadow of an ellipsoid: a quarter of its surface (K. Thomsen's formula, to 1 %).
double mean_shadow(Vec3 half) {
    constexpr double p = 1.6075;
    const double ab = std::pow(half.x * half.y, p), bc = std::pow(half.y * half.z, p),
                 ca = std::pow(half.z * half.x, p);
    return pi * std::pow((ab + bc + ca) / 3, 1 / p);
}

class CellBuilder {
  public:
    CellBuilder(DetailGraph& cut, std::shared_ptr<const CellSource> source, const RunBounds& bounds)
        : cut_(cut), source_(std::move(source)), bounds_(bounds) {}

    void fill(DetailNode& node, std::size_t level, std::size_t index) {
        const Box& box = bounds_.boxes(level)[index];
        if (level <= cell_level)
            fill_cell(node, box, index * RunBounds::range_size(level), RunBounds::range_size(level));
        else
            fill_inner(node, box, level, index);
    }

  private:
    static DetailNode like(const DetailNode& node) {
        DetailNode child;
        child.name = node.name;
        return child;
    }

    void fill_inner(DetailNode& node, const Box& box, std::size_t level, std::size_t index) {
        const std::size_t first = index * RunBounds::ranges_a_range;
        const std::size_t end = std::min(first + RunBounds::ranges_a_range, bounds_.boxes(level - 1).size());
        Ball ball{box.centre(), 0};
        for (std::size_t i = first; i < end; ++i) {
            DetailNode child = like(node);
            fill(child, level - 1, i);
            ball.radius =
                std::max(ball.radius, glm::distance(ball.centre, child.ball.centre) + child.ball.radius);
            DetailEdge edge;
            edge.child = static_cast<NodeId>(cut_.nodes.size());
            edge.similarity = true;
            node.edges.push_back(edge);
            cut_.nodes.push_back(std::move(child));
        }
        ball.radius = std::min(ball.radius, 0.5 * glm::length(box.size()));
        node.ball = ball;
        node.node_from_proxy = Affine::translate(box.centre()) * Affine::scale(half_of(box));
    }

    void fill_cell(DetailNode& node, const Box& box, std::size_t first, std::size_t most) {
        auto cell = std::make_shared<EdgeCell>();
        const Run& run = *source_->run;
        *cell = {source_, first, std::min(most, run.size() - first), box};
        const Vec3 centre = box.centre();
        double reach = 0, shadow = 0;
        std::size_t leaves = 0;
        MeanColour mean{Rgb(0.0), 0};
        std::vector<double> seen(cut_.materials.size() + 1, 0);
        for (std::size_t i = first; i < first + cell->count; ++i) {
            const RunItem& item = run[i];
            reach = std::max({reach, glm::distance(centre, item.base) + item.radius,
                              glm::distance(centre, item.base + item.axis) + item.radius});
            const double area = mean_shadow(item);
            shadow += area;
            leaves += item.ball ? 2 : 1;
            const double length = glm::length(item.axis);
            note(*cell, item.shape, std::max(item.radius, length));
            cell->flattest = std::min(cell->flattest, std::min(item.radius / length, length / item.radius));
            if (item.ball) note(*cell, PrimitiveKind::sphere, item.radius);
            const std::optional<MaterialId>& material = source_->materials[item.colour];
            seen[material.value_or(static_cast<MaterialId>(cut_.materials.size()))] += area;
            if (material)
                mean.fixed += area * cut_.materials[*material].rgb;
            else
                mean.open += area;
        }
        node.mean = shadow > 0 ? MeanColour{mean.fixed / shadow, mean.open / shadow} : MeanColour{};
        node.finish = most_seen(seen, cut_.materials);
        node.cullable = leaves > uncullable_leaves_of_cell;
        node.ball = {centre, std::min(reach, 0.5 * glm::length(box.size()))};
        // Parts that lie anyhow in the ellipsoid hide each other: so much of its shadow is left dark (Beer's
        // law).
        const Vec3 half = half_of(box);
        const double dark = 1 - std::exp(-shadow / mean_shadow(half));
        node.node_from_proxy = Affine::translate(centre) * Affine::scale(std::sqrt(dark) * half);
        node.cell = std::move(cell);
    }

    static void note(EdgeCell& cell, RunShape shape, double stretch) {
        int octave = 0;
        const double share = std::frexp(stretch, &octave); // its fourth power is in range
        const double square = share * share;
        const std::int32_t quarter_octave = 4 * octave + std::ilogb(square * square);
        for (EdgeCell::Alike& alike : cell.alike)
            if (alike.shape == shape && alike.quarter_octave == quarter_octave) {
                ++alike.count;
                return;
            }
        cell.alike.push_back({shape, quarter_octave, 1});
    }

    static Vec3 half_of(const Box& box) {
        const Vec3 half = 0.5 * box.size();
        return glm::max(half, Vec3(thinnest_proxy_of_cell * std::max({half.x, half.y, half.z, 1e-12})));
    }

    DetailGraph& cut_;
    const std::shared_ptr<const CellSource> source_;
    const RunBounds& bounds_;
};

} // namespace

double mean_shadow(const RunItem& item) {
    const double r = item.radius;
    if (item.shape.is_sphere()) return pi * r * r;
    const double middle = 0.5 * r * (1 + (item.ball ? 1 : item.shape.top_radius()));
    return (2 * pi * middle * glm::length(item.axis) + (item.ball ? 4 : 2) * pi * middle * middle) / 4;
}

CellEdge edge_to_body(const CellSource& source, const RunItem& item) {
    return edge_to(source, item, item.shape, run_from_body(item), glm::length(item.axis));
}

CellEdge edge_to_ball(const CellSource& source, const RunItem& item) {
    return edge_to(source, item, PrimitiveKind::sphere, run_from_ball(item), item.radius);
}

std::size_t EdgeCell::size() const {
    std::size_t edges = 0;
    for (const Alike& some : alike)
        edges += some.count;
    return edges;
}

std::size_t edge_count(const DetailNode& node, bool cut) {
    return node.cell && !cut ? node.cell->size() : followed_edges(node, cut).size();
}

void add_cells(DetailGraph& cut, DetailNode& node, const PackedEdges& edges, const RunBounds& bounds,
               const std::function<NodeId(const Primitive&)>& node_of) {
    auto source = std::make_shared<CellSource>();
    static_cast<PackedEdges&>(*source) = edges;
    std::array<bool, RunShape::count> met{};
    for (std::size_t i = 0; i < edges.run->size(); ++i) {
        const RunItem& item = (*edges.run)[i];
        for (const RunShape shape : {item.shape, item.ball ? PrimitiveKind::sphere : item.shape})
            if (!std::exchange(met[shape.index()], true))
                source->child[shape.index()] = node_of(shape.primitive());
    }
    CellBuilder(cut, std::move(source), bounds).fill(node, bounds.level_count() - 1, 0);
}

} // namespace graftal
