#pragma once

// Small texts that the files of the writer share.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/import/eisenscript/parser.h"
#include "compiler/support/affine.h"
#include "compiler/support/hue.h"

namespace graftal::eisenscript {

Hsv hsv_of(const std::array<double, 3>& rgb);
/// `hsv(30, 1, 0.5)`, to what screens tell apart.
std::string hsv_text(const std::array<double, 3>& rgb);
std::string vector_text(Vec3 v);
/// An instance of our triangle with these corners; nothing if they lie on a line.
std::optional<std::string> triangle_map(Vec3 a, Vec3 b, Vec3 c);

/// Whether a list of operators has `color`, or `color random`.
bool sets_colour(const std::vector<Operator>& operators);
bool draws_colour(const std::vector<Operator>& operators);

} // namespace graftal::eisenscript
