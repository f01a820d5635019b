#pragma once

#include <cstddef>
#include <optional>

#include "compiler/graph/graph.h"
#include "compiler/inst/parse/ast.h"
#include "compiler/lower/lowering.h"

namespace graftal {

/// Lowers an `.inst` file, Hart's textual instancing language (Hart 1992, sections 2.1 and 4.2;
/// docs/language.md). Objects with parameters are enumerated for the arguments that are reached, under names
/// like `tip(3)`; without recursion, whatever the depth. Tints of one group compose, later lines in front.
std::optional<Graph> lower_inst(const InstModule& module, Lowering& lowering);

/// One object may be reached with this many different arguments; more is taken for unbounded recursion.
inline constexpr std::size_t max_argument_tuples = 100'000;

} // namespace graftal
