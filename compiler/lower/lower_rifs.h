#pragma once

#include <optional>

#include "compiler/graph/graph.h"
#include "compiler/support/source.h"

namespace graftal {

struct Lowering;

/// Lowers a `.rifs` file (docs/language.md, ".rifs") after Hart 1992, section 3.3: one object a map, whose
/// instances all carry the map's transform and tint, and a root that unions them. Edge (i, j) of the control
/// digraph lets w_j be applied after w_i, so object j instances the objects i (eq. (2)). What is wrong goes
/// to the lowering's diagnostics and gives nothing. O(maps + edges); at most max_rifs_instances.
std::optional<Graph> lower_rifs(FileId file, Lowering& lowering);

/// More instances than this are refused: `follow all` of n maps makes n * n of them.
inline constexpr std::size_t max_rifs_instances = 4'000'000;

}  // namespace graftal
