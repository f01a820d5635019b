#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/support/affine.h"

namespace graftal::cfdg {

/// The last adjustment of each word, which replaces those before it, in the order of the words.
std::vector<const Adjustment*> last_of_each(const Modification& modification,
                                            std::span<const std::string_view> words);

/// The size of what a map draws, as Context Free measures it: the root of the area of a square of 1.
double size_of(const Affine& map);

/// The largest factor by which a map lengthens lines of the plane: its norm.
double largest_factor(const Affine& map);

} // namespace graftal::cfdg
