#include "compiler/detail/mesh/facet_set.h"

#include <algorithm>
#include <utility>

namespace graftal {

namespace {

/// Positions that round to the same multiple of 1 / weld_cells, in body units, are one vertex: a few steps of
/// POV-Ray's float32.
constexpr double weld_cells = 1 << 21;

using Corners = std::array<std::uint32_t, 4>;
using Cell = std::array<std::int64_t, 3>;

Cell cell_of(Vec3 point) {
    Cell cell;
    for (int k = 0; k < 3; ++k) {
        const double place = point[k] * weld_cells + 0.5;
        const auto towards_zero = static_cast<std::int64_t>(place);
        cell[static_cast<std::size_t>(k)] = towards_zero - (place < static_cast<double>(towards_zero));
    }
    return cell;
}

/// The corners, ascending.
Corners sorted(Corners c) {
    const auto order = [](std::uint32_t& a, std::uint32_t& b) {
        const std::uint32_t least = std::min(a, b);
        b = std::max(a, b);
        a = least;
    };
    order(c[0], c[1]);
    order(c[2], c[3]);
    order(c[0], c[2]);
    order(c[1], c[3]);
    order(c[1], c[2]);
    return c;
}

/// Whether the corners run from the least towards its smaller neighbour: turning a facet over changes it.
bool turns_to_smaller(const Corners& c) {
    const std::size_t count = c[3] == Facet::no_corner ? 3 : 4;
    const auto least = static_cast<std::size_t>(std::min_element(c.begin(), c.begin() + count) - c.begin());
    return c[(least + 1) % count] < c[(least + count - 1) % count];
}

} // namespace

std::uint32_t FacetSet::vertex(Vec3 point) {
    const Cell cell = cell_of(point);
    std::uint64_t hash = 0;
    for (const std::int64_t coordinate : cell)
        hash = mixed(hash, static_cast<std::uint64_t>(coordinate));
    const auto next = static_cast<std::uint32_t>(vertices_.size());
    const std::uint32_t id = vertex_ids_.find_or_add(
        hash, next, [&](std::uint32_t other) { return cell_of(vertices_[other]) == cell; });
    if (id == next) vertices_.push_back(point);
    return id;
}

void FacetSet::add(const Facet& facet) {
    const Corners corners = sorted(facet.corners);
    if (corners[0] == corners[1] || corners[1] == corners[2]) return; // too thin to have an inside
    const std::uint64_t hash = mixed(mixed(0, static_cast<std::uint64_t>(corners[1]) << 32 | corners[0]),
                                     static_cast<std::uint64_t>(corners[3]) << 32 | corners[2]);
    const auto next = static_cast<std::uint32_t>(facets_.size());
    const std::uint32_t id = facet_ids_.find_or_add(
        hash, next, [&](std::uint32_t other) { return sorted(facets_[other].corners) == corners; });
    if (id == next) {
        facets_.push_back(facet);
        triangle_count_ += facet.triangle_count();
        return;
    }
    Facet& other = facets_[id];
    const bool back_to_back = turns_to_smaller(facet.corners) != turns_to_smaller(other.corners);
    if (facet.solid && other.solid && facet.leaf != other.leaf && back_to_back && !other.hidden) {
        other.hidden = true;
        triangle_count_ -= facet.triangle_count();
    }
}

void FacetSet::move_to(FacetSet& other) {
    moved_.assign(vertices_.size(), UINT32_MAX);
    for (Facet& facet : facets_) {
        if (facet.hidden) continue;
        for (std::uint32_t& corner : facet.corners) {
            if (corner == Facet::no_corner) continue;
            std::uint32_t& there = moved_[corner];
            if (there == UINT32_MAX) there = other.vertex(vertices_[corner]);
            corner = there;
        }
        other.add(facet);
    }
    vertices_.clear();
    facets_.clear();
    vertex_ids_.clear();
    facet_ids_.clear();
    triangle_count_ = 0;
}

} // namespace graftal
