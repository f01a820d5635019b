#include "compiler/import/eisenscript/text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/support/number.h"

namespace graftal::eisenscript {

Hsv hsv_of(const std::array<double, 3>& rgb) {
    return hsv_from_rgb(Rgb(rgb[0], rgb[1], rgb[2]));
}

std::string hsv_text(const std::array<double, 3>& rgb) {
    const Hsv hsv = hsv_of(rgb);
    return fmt::format("hsv({}, {}, {})", shortest(hsv.hue_deg), shortest(hsv.saturation),
                       shortest(hsv.value));
}

std::string vector_text(Vec3 v) {
    return fmt::format("{}, {}, {}", shortest(v.x), shortest(v.y), shortest(v.z));
}

bool sets_colour(const std::vector<Operator>& operators) {
    return std::ranges::any_of(operators,
                               [](const Operator& op) { return op.kind == Operator::Kind::colour; });
}

bool draws_colour(const std::vector<Operator>& operators) {
    return std::ranges::any_of(
        operators, [](const Operator& op) { return op.kind == Operator::Kind::colour && !op.colour; });
}

/// Maps the corners of our triangle to three points.
std::optional<std::string> triangle_map(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 middle = (a + b + c) / 3.0;
    const Vec3 up = a - middle, side = (c - b) / std::numbers::sqrt3;
    const Vec3 normal = glm::cross(side, up);
    const double area = glm::length(normal);
    if (!(area > 1e-9 * (glm::dot(side, side) + glm::dot(up, up)))) return std::nullopt;
    const Vec3 out = normal / std::sqrt(area);
    std::string text = "instance: triangle  matrix:";
    for (int row = 0; row < 3; ++row)
        text += fmt::format(" {}, {}, {}, {}{}", shortest(side[row]), shortest(up[row]), shortest(out[row]),
                            shortest(middle[row]), row < 2 ? ", " : "");
    return text;
}

} // namespace graftal::eisenscript
