#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace graftal::cfdg {

using Point = glm::dvec2;

/// A row of points; a closed one leads back to its first.
struct Outline {
    std::vector<Point> points;
    bool closed = false;
};

enum class Join { miter, round, bevel };
enum class Cap { butt, round, square };

struct Stroke {
    double width = 0.1;
    Join join = Join::miter;
    Cap cap = Cap::butt;
};

/// Corners of simple polygons, as the numbers of `polygon(...)`: rings neither cross nor touch.
using Polygon = std::vector<Point>;

/// TRIANGLE: of sides of 1 around its middle.
inline const Polygon triangle = {
    {0, 1 / std::numbers::sqrt3}, {-0.5, -0.5 / std::numbers::sqrt3}, {0.5, -0.5 / std::numbers::sqrt3}};

/// The areas that outlines fill, by the even-odd or the nonzero rule. Nothing if too many outlines cross to
/// be cut, or if they take more than the `work` that is left, which they lessen.
std::optional<std::vector<Polygon>> filled(const std::vector<Outline>& outlines, bool even_odd,
                                           std::size_t& work);

/// The areas that a pen draws along outlines.
std::optional<std::vector<Polygon>> stroked(const std::vector<Outline>& outlines, const Stroke& stroke,
                                            std::size_t& work);

/// `instance: polygon(...)`, and a scale where the numbers need one.
std::string polygon_text(const Polygon& polygon);

} // namespace graftal::cfdg
