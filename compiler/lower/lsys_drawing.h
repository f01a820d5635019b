#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/lsys_grammar.h"
#include "compiler/lower/object_pool.h"

namespace graftal {

struct LsysDrawing {
    std::vector<Instance> instances; ///< the whole model, in world space
    Derivation derivation;
};

/// Draws what a grammar derives in `steps` steps into `graph`. `models`: the roots of what `~NAME` places, by
/// symbol; `pool` makes the objects. Nothing after an error.
std::optional<LsysDrawing> draw_lsys(const LsysGrammar& grammar, const std::map<SymbolId, ObjectId>& models,
                                     unsigned steps, std::size_t max_parts, Graph& graph, ObjectPool& pool,
                                     Diagnostics& diagnostics);

} // namespace graftal
