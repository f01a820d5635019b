#include "runtime/trace/model/leaf_group.h"

#include <algorithm>

#include "runtime/trace/model/trace_model.h"

namespace graftal {

namespace {

double half_area(const Box& box) {
    const Vec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// To meet a group takes about as long as to meet two triangles.
constexpr double cost_of_group = 2;

/// Number of edges from the first on that are better met as a group; 1 if none are. `box`: of all of them.
std::uint32_t group_at(const TraceModel& model, std::span<const std::uint32_t> numbers, Box& box) {
    const bool similar = model.edges[numbers.front()].similarity;
    const auto is_triangle = [&](std::uint32_t number) {
        const TraceEdge& edge = model.edges[number];
        if (edge.upright || edge.similarity != similar || edge.box.empty()) return false;
        const auto& primitive = model.layers.cut.nodes[edge.child].primitive;
        return primitive && *primitive == PrimitiveKind::triangle;
    };
    box = model.edges[numbers.front()].box;
    if (!is_triangle(numbers.front())) return 1;
    std::uint32_t best = 1;
    Box all = box;
    double apart = half_area(box);
    for (std::uint32_t count = 2; count <= std::min<std::size_t>(LeafGroup::most, numbers.size()); ++count) {
        const std::uint32_t last = numbers[count - 1];
        if (last != numbers.front() + count - 1 || !is_triangle(last)) break;
        all.include(model.edges[last].box);
        apart += half_area(model.edges[last].box);
        if (!(cost_of_group * half_area(all) <= apart)) continue;
        best = count;
        box = all;
    }
    return best;
}

EvenTriangles side_by_side(const TraceModel& model, const LeafGroup& group) {
    EvenTriangles triangles{};
    triangles.first = group.first;
    triangles.count = group.count;
    triangles.similar = model.edges[group.first].similarity;
    for (std::uint32_t lane = 0; lane < LeafGroup::most; ++lane) {
        const TraceEdge& edge = model.edges[group.first + std::min(lane, group.count - 1)];
        for (int row = 0; row < 3; ++row) {
            Double4* const to = triangles.row[(row + 1) % 3];
            for (int column = 0; column < 3; ++column)
                to[column][lane] = edge.child_from_parent.column[column][row];
            to[3][lane] = edge.child_from_parent.translation[row];
        }
        triangles.stretch[lane] = edge.stretch;
        triangles.growth[lane] = edge.growth;
    }
    return triangles;
}

} // namespace

std::vector<BoxedItem> grouped_items(const TraceModel& model, std::span<const std::uint32_t> numbers) {
    std::vector<BoxedItem> items;
    while (!numbers.empty()) {
        Box box;
        const LeafGroup group(numbers.front(), group_at(model, numbers, box));
        if (!box.empty()) items.emplace_back(box, group.item());
        numbers = numbers.subspan(group.count);
    }
    return items;
}

void add_even_triangles(TraceModel& model) {
    std::vector<EvenTriangles>& all = model.even_triangles;
    for (const BoxNode& node : model.boxes)
        for (const std::uint32_t item : node.entry) {
            if (!LeafGroup::is(item)) continue;
            const LeafGroup group(item);
            // An edge is in several trees, and may begin groups of several sizes.
            std::uint32_t& known = model.even_parts[group.first].group;
            if (known < all.size() && all[known].first == group.first && all[known].count >= group.count)
                continue;
            known = static_cast<std::uint32_t>(all.size());
            all.push_back(side_by_side(model, group));
        }
}

} // namespace graftal
