#include "compiler/lower/lower_area.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "compiler/support/check.h"

namespace graftal {

namespace {

FlatArea area_of(const std::vector<double>& n) {
    if (n.size() == 4)
        return FlatArea::rectangle(glm::min(Vec2(n[0], n[1]), Vec2(n[2], n[3])),
                                   glm::max(Vec2(n[0], n[1]), Vec2(n[2], n[3])));
    GRAFTAL_CHECK(n.size() == 1 || n.size() == 3, "an area is a rectangle or a disc");
    return FlatArea::round(n.size() == 3 ? Vec2(n[1], n[2]) : Vec2(0.0), std::max(n[0], 0.0));
}

} // namespace

std::optional<FlatArea> lower_area(const std::vector<Expression>& numbers, Span span,
                                   const Environment& environment, Diagnostics& diagnostics) {
    std::vector<double> values;
    for (const Expression& number : numbers)
        if (const std::optional<double> value = evaluate(number, environment, diagnostics))
            values.push_back(*value);
    if (values.size() < numbers.size()) return std::nullopt;
    const FlatArea area = area_of(values);
    const Vec2 extent = area.high - area.low;
    // Doubles may not tell the borders of a place far from the origin apart.
    if (!(area.size() > 0) || !(std::min(extent.x, extent.y) > 0)) {
        diagnostics.error(span, "this area is empty");
        return std::nullopt;
    }
    if (!std::isfinite(area.size()) || !std::isfinite(extent.x * extent.x + extent.y * extent.y)) {
        diagnostics.error(span, "this area is too large");
        return std::nullopt;
    }
    return area;
}

} // namespace graftal
