#pragma once

#include <string_view>
#include <vector>

#include "compiler/import/flame/variations.h"

namespace graftal::flame {

/// The formulas of variations that have numbers of their own (`julian_power`), or that are made of several
/// steps. Empty if it is none of these, or if its numbers make more branches than `most_branches`.
std::vector<Formula> parametric_formulas(std::string_view variation, const Setting& setting);

/// Whether there is such a variation.
bool is_parametric(std::string_view variation);

inline constexpr int most_branches = 64;

} // namespace graftal::flame
