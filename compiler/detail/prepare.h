#pragma once

#include <memory>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/detail_options.h"
#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/symmetry.h"
#include "compiler/detail/shell/store.h"
#include "compiler/graph/components.h"
#include "compiler/passes/pipeline.h"
#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// A graph made ready to be unfolded for a view: what the cut and the tracer unfold alike, so that both draw
/// the same parts.
struct PreparedGraph {
    DetailGraph cut;
    Symmetry symmetry;
    std::uint32_t root_steps = unlimited_steps; ///< levels that the root has
    Box bounds;                                 ///< of the limit set
    std::uint64_t instances = 0;                ///< of the graph that it was made of
    double work_seconds = 0;                    ///< counted, of all stages up to here (support/stage_work.h)
    std::unique_ptr<ShellStore> shells = std::make_unique<ShellStore>(); ///< of this graph
};

/// Runs the passes for detail, which `after_each` sees. Requires a verified graph whose contraction is proved
/// or acyclic. O(graph).
PreparedGraph prepare_graph(const Graph& graph, const Components& components,
                            const std::vector<ObjectBounds>& bounds, const PrepareOptions& options,
                            const Control& control = no_control(), const PassObserver& after_each = {});

/// True, after an error, if nothing says how deep the graph is to be unfolded.
bool refuse_endless(const Graph& graph, const Components& components, const DetailOptions& options,
                    Diagnostics& diagnostics);

/// Notes that parts of a set without area are drawn wider than they are (least_width.h). The note says how
/// the model can give their look, where it does not. For models of which something is culled.
void note_shadowless(const DetailGraph& cut, const Graph& graph, Diagnostics& diagnostics);

/// The least distance from the eye that counts (Projection), so that the eye may lie on the model.
double nearest_to_eye(const DetailGraph& cut);

} // namespace graftal
