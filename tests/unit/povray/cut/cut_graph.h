#pragma once

#include <optional>
#include <vector>

#include "compiler/detail/prepare.h"
#include "compiler/povray/cut/cut.h"

namespace graftal::test {

/// cut_prepared() of a graph that is prepared for this cut alone.
inline std::optional<Cut> cut_graph(const Graph& graph, const Components& components,
                                    const std::vector<ObjectBounds>& bounds, const View& view,
                                    const DetailOptions& detail, Diagnostics& diagnostics,
                                    const CutOptions& options = {}, const Control& control = no_control()) {
    if (refuse_endless(graph, components, detail, diagnostics)) return std::nullopt;
    const PreparedGraph prepared = prepare_graph(graph, components, bounds, detail.preparing());
    return cut_prepared(graph, prepared, view, detail, diagnostics, options, control);
}

} // namespace graftal::test
