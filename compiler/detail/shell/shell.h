#pragma once

// Shells: looks of parts from outside, where too many copies lie in each other to unfold them.

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/detail/baked.h"
#include "compiler/detail/shell/store.h"

namespace graftal {

struct ShellRequest {
    NodeId node = 0;
    std::uint32_t steps = unlimited_steps;
    double detail_per_unit = 0;         ///< of the node's frame; a cell of the shell has the detail 1
    std::optional<MaterialId> material; ///< the finish of what names no material
    std::uint64_t most_work = PointLimits().work;
    std::vector<Rgb> inherited;  ///< by painter: the colour of what names no material
    ShellStore* store = nullptr; ///< shells made already; null: each is made anew
    CancelFlag cancel{};         ///< ends it by Cancelled
};

/// The node as a closed surface, in the node's frame (Baked::representative_from_body reads node_from_body):
/// the faces of the cells that its points (points.h) fill, smoothed by at most half a cell (S. Gibson,
/// "Constrained Elastic Surface Nets", 1998). A set in the plane z = const becomes a sheet. Its
/// cells are larger where the limits do not suffice. Not complete where they suffice for none.
Baked bake_shell(const DetailGraph& cut, const ShellRequest& request, std::size_t max_triangles);

} // namespace graftal
