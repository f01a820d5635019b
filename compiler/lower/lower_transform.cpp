#include "compiler/lower/lower_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/lower/point_maps.h"
#include "compiler/primitives/primitive.h"
#include "compiler/support/hue.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

using LineKind = TransformLine::Kind;

/// Numbers of a line, as many as it has, and zeros.
using Numbers = std::array<double, 24>;

template<std::size_t count>
std::optional<std::array<double, count>>
evaluate_all(const std::vector<Expression>& values, const Environment& environment, Diagnostics& diagnostics,
             const ChanceDraws& draws = {}) {
    std::array<double, count> numbers{};
    bool good = values.size() <= count;
    for (std::size_t i = 0; i < values.size() && i < count; ++i) {
        const std::optional<double> number = evaluate(values[i], environment, diagnostics, draws);
        if (number)
            numbers[i] = *number;
        else
            good = false;
    }
    if (!good) return std::nullopt;
    return numbers;
}

Diagnostic& outside_unit_range(const char* what, double number, Span span, Diagnostics& diagnostics) {
    return diagnostics.error(span,
                             fmt::format("{} must lie between 0 and 1, not {}", what, shortest(number)));
}

/// Checks that evaluated values lie in [0,1].
template<std::size_t count>
bool in_unit_range(const std::array<double, count>& numbers, const std::vector<Expression>& values,
                   Diagnostics& diagnostics) {
    bool good = true, too_bright = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (numbers[i] >= 0 && numbers[i] <= 1) continue;
        good = false;
        // A colour that counts to 255 does so three times, and is one error.
        if (i < 3 && numbers[i] > 1 && std::exchange(too_bright, true)) continue;
        const char* what = i == 3 ? "alpha" : "a colour component";
        Diagnostic& error = outside_unit_range(what, numbers[i], values[i].span, diagnostics);
        if (i < 3 && numbers[i] >= 2 && numbers[i] <= 255)
            error.with_hint("colours are linear light: 1 is all of it, where pictures have 255");
    }
    return good;
}

/// `hsv(h, s, v)` in place of three components (syntax/expression_parser.h).
bool is_hsv(const Expression& value) {
    return value.kind == Expression::Kind::call && value.text == "hsv";
}

/// `most`: what the value may be.
std::optional<Rgb> lower_hsv(const Expression& call, double most, const Environment& environment,
                             Diagnostics& diagnostics, const ChanceDraws& draws = {}) {
    const auto n = evaluate_all<3>(call.operands, environment, diagnostics, draws);
    if (!n) return std::nullopt;
    const auto [hue_deg, saturation, value] = *n;
    const auto check = [&](std::size_t i, const char* what, double limit) {
        if ((*n)[i] >= 0 && (*n)[i] <= limit) return true;
        diagnostics
            .error(call.operands[i].span, fmt::format("{} must lie between 0 and {}, not {}", what,
                                                      shortest(limit), shortest((*n)[i])))
            .with_hint("write hsv(hue, saturation, value), with the hue in degrees");
        return false;
    };
    if (!check(1, "a saturation", 1) || !check(2, "the value of a colour", most)) return std::nullopt;
    return rgb_from_hsv(hue_deg, saturation, value);
}

int axis_index(char axis) {
    return axis - 'x';
}

Vec3 axis_vector(char axis) {
    Vec3 unit(0.0);
    unit[axis_index(axis)] = 1;
    return unit;
}

/// Exact for equal magnitudes, and without overflow.
double geometric_mean(double a, double b) {
    if (std::abs(a) == std::abs(b)) return std::abs(a);
    return std::sqrt(std::abs(a)) * std::sqrt(std::abs(b));
}

Vec3 scale_factors(const Numbers& n, std::size_t count) {
    if (count == 1) return Vec3(n[0]);
    if (count == 2) return {n[0], n[1], geometric_mean(n[0], n[1])};
    return {n[0], n[1], n[2]};
}

Affine from_rows(const Numbers& n) {
    Affine result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            result.linear[column][row] = n[static_cast<std::size_t>(4 * row + column)];
        result.translation[row] = n[static_cast<std::size_t>(4 * row + 3)];
    }
    return result;
}

Affine shear(std::string_view axes, double factor) {
    Affine result;
    result.linear[axis_index(axes[1])][axis_index(axes[0])] = factor;
    return result;
}

std::optional<Affine> rotation(const TransformLine& line, const Numbers& n, Diagnostics& diagnostics) {
    if (!line.axes.empty()) return Affine::rotate(axis_vector(line.axes[0]), n[0]);
    const Vec3 axis(n[0], n[1], n[2]);
    // The largest component first, so that neither tiny nor huge axes leave the range of doubles.
    const double largest = largest_entry(axis);
    if (largest > 0) return Affine::rotate(axis / largest, n[3]);
    diagnostics.error(line.span, "the axis of this rotation has no direction");
    return std::nullopt;
}

std::optional<Affine> of_points(const TransformLine& line, const Numbers& n, Diagnostics& diagnostics) {
    const std::size_t count = line.numbers.size(), dimensions = point_dimensions(count);
    std::vector<Vec3> at;
    for (std::size_t i = 0; i < count; i += dimensions)
        at.emplace_back(n[i], n[i + 1], dimensions == 3 ? n[i + 2] : 0);
    const std::span<const Vec3> points(at);
    const std::optional<Affine> map = map_by_points(points.first(at.size() / 2), points.last(at.size() / 2));
    if (!map)
        diagnostics
            .error(line.span, dimensions == 3  ? "these four points lie in one plane"
                              : at.size() == 4 ? "these two points are one"
                                               : "these three points lie on one line")
            .with_hint("the points before '->' must span the space that the map is of");
    return map;
}

bool check_map(const Affine& map, bool projection, Span span, std::string_view what,
               Diagnostics& diagnostics) {
    if (const std::string fault = range_fault(map); !fault.empty()) {
        Diagnostic& error = diagnostics.error(span, fmt::format("{} {}", what, fault));
        if (map.linear != Mat3(0.0)) error.with_hint(range_hint);
        return false;
    }
    if (!projection && is_singular(map)) {
        diagnostics.error(span, fmt::format("{} is singular: it flattens what it maps", what))
            .with_hint("use 'projection' with the numbers of the matrix if that is meant");
        return false;
    }
    return true;
}

} // namespace

std::optional<Vec3> lower_vector(const std::vector<Expression>& values, const Environment& environment,
                                 Diagnostics& diagnostics) {
    const auto n = evaluate_all<3>(values, environment, diagnostics);
    if (!n) return std::nullopt;
    return Vec3((*n)[0], (*n)[1], (*n)[2]);
}

std::optional<Rgb> lower_color(const std::vector<Expression>& values, const Environment& environment,
                               Diagnostics& diagnostics) {
    if (is_hsv(values[0])) return lower_hsv(values[0], 1, environment, diagnostics);
    const auto n = evaluate_all<3>(values, environment, diagnostics);
    if (!n || !in_unit_range(*n, values, diagnostics)) return std::nullopt;
    return Rgb((*n)[0], (*n)[1], (*n)[2]);
}

std::optional<Rgb> lower_light_color(const std::vector<Expression>& values, const Environment& environment,
                                     Diagnostics& diagnostics) {
    if (is_hsv(values[0])) return lower_hsv(values[0], brightest_light, environment, diagnostics);
    const auto n = evaluate_all<3>(values, environment, diagnostics);
    if (!n) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
        if ((*n)[i] >= 0 && (*n)[i] <= brightest_light) continue;
        diagnostics.error(values[i].span,
                          fmt::format("the brightness of a light must lie between 0 and {:.0f}, not {}",
                                      brightest_light, shortest((*n)[i])));
        return std::nullopt;
    }
    return Rgb((*n)[0], (*n)[1], (*n)[2]);
}

std::optional<Tint> lower_tint(const std::vector<Expression>& values, const Environment& environment,
                               Diagnostics& diagnostics, const ChanceDraws& draws) {
    if (is_hsv(values[0])) {
        const std::optional<Rgb> rgb = lower_hsv(values[0], 1, environment, diagnostics, draws);
        const std::optional<double> alpha = evaluate(values[1], environment, diagnostics, draws);
        if (!rgb || !alpha) return std::nullopt;
        if (*alpha >= 0 && *alpha <= 1) return Tint{*rgb, *alpha};
        outside_unit_range("alpha", *alpha, values[1].span, diagnostics);
        return std::nullopt;
    }
    const auto n = evaluate_all<4>(values, environment, diagnostics, draws);
    if (!n || !in_unit_range(*n, values, diagnostics)) return std::nullopt;
    return Tint{Rgb((*n)[0], (*n)[1], (*n)[2]), (*n)[3]};
}

std::optional<Affine> lower_transform(const TransformLine& line, const Environment& environment,
                                      Diagnostics& diagnostics, const ChanceDraws& draws) {
    const auto n = evaluate_all<24>(line.numbers, environment, diagnostics, draws);
    if (!n) return std::nullopt;
    std::optional<Affine> map;
    switch (line.kind) {
    case LineKind::scale:
        map = Affine::scale(scale_factors(*n, line.numbers.size()));
        break;
    case LineKind::rotate:
        map = rotation(line, *n, diagnostics);
        break;
    case LineKind::translate:
        map = Affine::translate({(*n)[0], (*n)[1], (*n)[2]});
        break;
    case LineKind::shear:
        map = shear(line.axes, (*n)[0]);
        break;
    case LineKind::matrix:
    case LineKind::projection:
        map = from_rows(*n);
        break;
    case LineKind::points:
        map = of_points(line, *n, diagnostics);
        break;
    }
    const std::string_view keyword = transform_keywords[static_cast<std::size_t>(line.kind)];
    if (!map || !check_map(*map, line.kind == LineKind::projection, line.span,
                           fmt::format("this {}", keyword), diagnostics))
        return std::nullopt;
    return map;
}

std::optional<PrimitiveKind> kind_of_numbers(std::string_view name) {
    const std::optional<PrimitiveKind> kind = primitive_kind_named(name);
    return kind && traits_of(*kind).make ? kind : std::nullopt;
}

bool is_reserved_name(std::string_view name) {
    const std::optional<PrimitiveKind> kind = primitive_kind_named(name);
    return kind && form_of(*kind) != PrimitiveForm::shaped;
}

bool takes_count(PrimitiveKind kind, std::size_t count) {
    const PrimitiveArguments& arguments = traits_of(kind).arguments;
    return count >= arguments.least && count <= arguments.most;
}

std::string counts_taken(PrimitiveKind kind) {
    const auto [least, most] = traits_of(kind).arguments;
    const std::string range = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
    return fmt::format("{} argument{}", range, most == 1 ? "" : "s");
}

std::optional<Primitive> lower_primitive(PrimitiveKind kind, std::span<const double> numbers, Span place,
                                         Diagnostics& diagnostics) {
    std::string fault;
    std::optional<Primitive> primitive = traits_of(kind).make(numbers, fault);
    if (!primitive) diagnostics.error(place, std::move(fault));
    return primitive;
}

std::optional<double> lower_size_px(const Expression& size_px, const Environment& environment,
                                    Diagnostics& diagnostics, const ChanceDraws& draws) {
    constexpr double most = 1e6;
    const std::optional<double> value = evaluate(size_px, environment, diagnostics, draws);
    if (!value || (*value >= 0 && *value <= most)) return value;
    diagnostics.error(size_px.span, fmt::format("a size in pixels lies between 0 and {}, not at {}", most,
                                                shortest(*value)));
    return std::nullopt;
}

std::optional<Affine> lower_transforms(const std::vector<TransformLine>& lines,
                                       const Environment& environment, Diagnostics& diagnostics,
                                       const ChanceDraws& draws) {
    std::optional<Affine> product;
    bool good = true;
    bool projection = false;
    for (const TransformLine& line : lines) {
        const std::optional<Affine> map = lower_transform(line, environment, diagnostics, draws);
        good = good && map;
        projection |= line.kind == LineKind::projection;
        if (good) product = product ? *map * *product : *map;
    }
    if (!good) return std::nullopt;
    if (lines.size() > 1 && !check_map(*product, projection, join(lines.front().span, lines.back().span),
                                       "the product of these transforms", diagnostics))
        return std::nullopt;
    return product.value_or(Affine());
}

} // namespace graftal
