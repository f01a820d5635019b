#pragma once

#include <optional>

#include "compiler/graph/graph.h"
#include "compiler/rifs/ast.h"

namespace graftal {

struct Lowering;

/// Lowers a `.rifs` file (docs/language.md, ".rifs") after Hart 1992, section 3.3: one object a map, whose
/// instances all carry the map's transform and tint, and a root that unions them. Edge (i, j) of the control
/// digraph lets w_j be applied after w_i, so object j instances the objects i (eq. (2)). Faults go to the
/// lowering's diagnostics and give nothing. O(maps + edges), within the limits of the options: note that
/// `follow all` of n maps makes n * n instances.
std::optional<Graph> lower_rifs(const RifsFile& tree, Lowering& lowering);

} // namespace graftal
