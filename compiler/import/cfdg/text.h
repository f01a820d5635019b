#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/import/cfdg/evaluate/value.h"

namespace graftal::cfdg {

/// The target of a shape's colour: hue, saturation, brightness and alpha.
using Target = std::array<double, 4>;
inline constexpr Target first_target = {0, 0, 0, 1};

/// Lines of `.inst` for a map: `  scale: 2  rotate: z, 30  translate: 1, 2, 0`; "" of the identity.
std::string moves_text(const Affine& map);

/// `  ink { hue 10 value to 1 by 0.2 }` for the steps, and what they make of the target; "" where they do not
/// change the colour. Nothing if a step leads away from a colour.
std::optional<std::string> ink_text(const std::vector<ColourStep>& steps, Target& target);

/// Whether steps look at no target, and go no way around the hues.
bool is_plain(const std::vector<ColourStep>& steps);

/// Fewer steps that do the same, where they are plain.
std::vector<ColourStep> shortened(const std::vector<ColourStep>& steps);

} // namespace graftal::cfdg
