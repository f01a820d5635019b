#pragma once

// The cut: Graph + View + budget -> bodies and placements. POV-Ray shares only mesh data between instances,
// so a scene is one level of instancing: a list of placements of shared baked meshes (and of single
// primitives). Which subtrees become meshes is chosen so that the whole costs least memory; with N visible
// leaves both lists are about sqrt(N) long.

#include <optional>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/detail_options.h"
#include "compiler/graph/components.h"
#include "compiler/povray/cut_parts.h"
#include "compiler/scene/scene.h"
#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

struct CutOptions {
    bool flatten = false; ///< every leaf its own placement: the absolute specification
    bool operator==(const CutOptions&) const = default;
};

struct PreparedGraph;

/// Cuts the graph for the view. Nothing, after an error in `diagnostics`, where the budget cannot be kept
/// with culling off. A budget that only allows a coarser picture gives that, with a warning that states the
/// error reached. Requires a verified graph whose contraction is proved or acyclic, which refuse_endless()
/// lets pass, and which was prepared by detail.preparing(). The control follows the pieces that are chosen,
/// unfolded and baked, in all tries.
std::optional<Cut> cut_prepared(const Graph& graph, const PreparedGraph& prepared, const View& view,
                                const DetailOptions& detail, Diagnostics& diagnostics,
                                const CutOptions& options = {}, const Control& control = no_control());

} // namespace graftal
