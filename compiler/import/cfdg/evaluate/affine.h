#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/import/cfdg/evaluate/expression.h"
#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/support/affine.h"

namespace graftal::cfdg {

/// The last adjustment of each word, which replaces those before it, in the order of the words.
std::vector<const Adjustment*> last_of_each(const Modification& modification,
                                            std::span<const std::string_view> words);

/// The adjustments that move, in the order in which they multiply: x y z, r, s, skew, f; as written where the
/// modification keeps its order. The first is outermost.
std::vector<const Adjustment*> moves_of(const Modification& modification);

/// The size of what a map draws, as Context Free measures it: the root of the area of a square of 1.
double size_of(const Affine& map);

/// The map of a modification where all numbers are known. z is scaled by the geometric mean of x and y.
std::optional<Affine> affine_of(const Modification& modification, const Expressions& expressions,
                                const Numbers& known = {});

} // namespace graftal::cfdg
