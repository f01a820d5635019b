#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lsys/compose/composer.h"

namespace graftal {

/// Whether derivations of the grammar can have a limit. If not, an error says why.
bool may_have_limit(const LsysGrammar& grammar, Diagnostics& diagnostics);

/// Folds the levels of a long derivation into cycles, so that the graph is that of infinitely many steps.
///
/// Objects are taken for the same if their lists of instances agree, numbers to 1e-9, down to `depth` levels
/// below. The objects of the deepest levels, which see the end of the derivation, are left out. Where the
/// classes of the others are closed under "is instanced by", the graph over them unfolds to the limit of the
/// derivations (Prusinkiewicz and Hammel 1994; Hart 1992, section 4.3).
///
/// The instances of the whole model over the folded graph, or nothing if the levels do not repeat. New
/// objects are appended to `graph`. `steps`: of the derivation that `origins` belong to. An error, and
/// nothing, if a parameter that changes from level to level decides what is derived: repetition need not
/// last for ever then.
std::optional<std::vector<Instance>>
fold_levels(const std::vector<Instance>& instances, unsigned steps,
            const std::unordered_map<ObjectId, LsysComposer::Origin>& origins, const LsysRewriter& rewriter,
            Graph& graph, ObjectPool& pool, Diagnostics& diagnostics);

/// The limit of figures that grow has no size of its own. This map makes the way from the start to the end of
/// the figure one `step` long, upwards, or, where the way comes back, its reach. Figures that settle stay as
/// they are. `half`, `most`: the reach of the figure after half of its steps, and after three quarters.
Affine unit_limit(const TurtlePart& figure, double half, double most, double step);

} // namespace graftal
