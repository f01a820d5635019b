#include "compiler/syntax/expression_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <boost/math/special_functions/erf.hpp>

#include "compiler/support/check.h"

namespace graftal {

namespace {

/// Sine of an angle in degrees, exact at multiples of 30 and 90 where the value is 0, 1/2 or 1.
double sin_deg(double degrees) {
    const double turn = std::remainder(degrees, 360.0);
    const double acute = std::abs(turn) > 90 ? 180 - std::abs(turn) : std::abs(turn);
    double value = std::sin(acute * std::numbers::pi / 180);
    if (acute == 30) value = 0.5;
    if (acute == 90) value = 1;
    return turn < 0 ? -value : value;
}

double cos_deg(double degrees) {
    return sin_deg(90 - std::abs(std::remainder(degrees, 360.0)));
}
double to_deg(double radians) {
    return radians * 180 / std::numbers::pi;
}
double sign(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// Growth that is slow at first, fastest at `middle`, and comes to an end: limit / (1 + e^(-rate (t -
/// middle))), the solution of x' = rate x (1 - x / limit). Far before the middle it is 0.
double logistic(double t, double limit, double rate, double middle) {
    return limit / (1 + std::exp(-rate * (t - middle)));
}

/// A step from 0 at `lo` to 1 at `hi` by 3 x^2 - 2 x^3, level at both ends; sudden where they are one.
double smooth(double lo, double hi, double t) {
    if (lo == hi) return t < lo ? 0 : 1;
    const double x = std::clamp((t - lo) / (hi - lo), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

using Arguments = std::span<const double>;

constexpr std::array functions = {
    ExpressionFunction{"sin", 1, [](Arguments a) { return sin_deg(a[0]); }},
    ExpressionFunction{"cos", 1, [](Arguments a) { return cos_deg(a[0]); }},
    ExpressionFunction{"tan", 1, [](Arguments a) { return sin_deg(a[0]) / cos_deg(a[0]); }},
    ExpressionFunction{"asin", 1, [](Arguments a) { return to_deg(std::asin(a[0])); }},
    ExpressionFunction{"acos", 1, [](Arguments a) { return to_deg(std::acos(a[0])); }},
    ExpressionFunction{"atan", 1, [](Arguments a) { return to_deg(std::atan(a[0])); }},
    ExpressionFunction{"atan2", 2, [](Arguments a) { return to_deg(std::atan2(a[0], a[1])); }},
    ExpressionFunction{"sqrt", 1, [](Arguments a) { return std::sqrt(a[0]); }},
    ExpressionFunction{"exp", 1, [](Arguments a) { return std::exp(a[0]); }},
    ExpressionFunction{"log", 1, [](Arguments a) { return std::log(a[0]); }},
    ExpressionFunction{"floor", 1, [](Arguments a) { return std::floor(a[0]); }},
    ExpressionFunction{"ceil", 1, [](Arguments a) { return std::ceil(a[0]); }},
    ExpressionFunction{"abs", 1, [](Arguments a) { return std::abs(a[0]); }},
    ExpressionFunction{"sign", 1, [](Arguments a) { return sign(a[0]); }},
    ExpressionFunction{"min", 2, [](Arguments a) { return std::min(a[0], a[1]); }},
    ExpressionFunction{"max", 2, [](Arguments a) { return std::max(a[0], a[1]); }},
    ExpressionFunction{"mod", 2, [](Arguments a) { return std::fmod(a[0], a[1]); }},
    ExpressionFunction{"pow", 2, [](Arguments a) { return std::pow(a[0], a[1]); }},
    ExpressionFunction{"lerp", 3, [](Arguments a) { return a[0] + a[2] * (a[1] - a[0]); }},
    ExpressionFunction{"choose", 3, [](Arguments a) { return a[0] != 0 ? a[1] : a[2]; }, true},
    ExpressionFunction{"smooth", 3, [](Arguments a) { return smooth(a[0], a[1], a[2]); }},
    ExpressionFunction{"logistic", 4, [](Arguments a) { return logistic(a[0], a[1], a[2], a[3]); }},
};

/// The deviations at which the normal distribution is cut off: about 0.27 % are moved inside.
constexpr double most_deviations = 3;

double normal_quantile(double uniform, double mean, double deviation) {
    if (deviation < 0) return std::numeric_limits<double>::quiet_NaN();
    const double within = std::erf(most_deviations / std::numbers::sqrt2);
    const double standard = std::numbers::sqrt2 * boost::math::erf_inv(within * (2 * uniform - 1));
    return mean + deviation * std::clamp(standard, -most_deviations, most_deviations);
}

constexpr std::array random_functions = {
    ExpressionFunction{"normal", 3, [](Arguments a) { return normal_quantile(a[0], a[1], a[2]); }},
    ExpressionFunction{"random", 3, [](Arguments a) { return a[1] + a[0] * (a[2] - a[1]); }},
};

constexpr std::array<std::string_view, 14> operators = {
    "+", "-", "*", "/", "%", "^", "==", "!=", "<", "<=", ">", ">=", "&&", "||"};

} // namespace

std::span<const ExpressionFunction> expression_functions() {
    return functions;
}

const ExpressionFunction* expression_function(std::string_view name) {
    const auto found = std::ranges::find_if(
        functions, [&](const ExpressionFunction& function) { return name == function.name; });
    return found == functions.end() ? nullptr : &*found;
}

double table_value(std::span<const double> table, double x) {
    const auto pieces = static_cast<double>(table.size() - 1);
    const double place = std::clamp(x, 0.0, 1.0) * pieces;
    const double piece = std::min(std::floor(place), pieces - 1);
    const auto at = static_cast<std::size_t>(piece);
    const double rise = table[at + 1] - table[at], share = place - piece;
    return std::isfinite(rise) ? table[at] + share * rise : (1 - share) * table[at] + share * table[at + 1];
}

std::span<const ExpressionFunction> chance_functions() {
    return random_functions;
}

const ExpressionFunction* chance_function(std::string_view name) {
    const auto found = std::ranges::find_if(
        random_functions, [&](const ExpressionFunction& function) { return name == function.name; });
    return found == random_functions.end() ? nullptr : &*found;
}

BinaryOperator binary_operator(std::string_view text) {
    const auto found = std::ranges::find(operators, text);
    GRAFTAL_CHECK(found != operators.end(), "unknown operator in an expression: " + std::string(text));
    return static_cast<BinaryOperator>(found - operators.begin());
}

double apply_binary(BinaryOperator op, double a, double b) {
    switch (op) {
    case BinaryOperator::add:
        return a + b;
    case BinaryOperator::subtract:
        return a - b;
    case BinaryOperator::multiply:
        return a * b;
    case BinaryOperator::divide:
        return a / b;
    case BinaryOperator::remainder:
        return std::fmod(a, b);
    case BinaryOperator::power:
        return std::pow(a, b);
    case BinaryOperator::equal:
        return a == b;
    case BinaryOperator::unequal:
        return a != b;
    case BinaryOperator::less:
        return a < b;
    case BinaryOperator::less_equal:
        return a <= b;
    case BinaryOperator::greater:
        return a > b;
    case BinaryOperator::greater_equal:
        return a >= b;
    case BinaryOperator::logical_and:
        return a != 0 && b != 0;
    case BinaryOperator::logical_or:
        return a != 0 || b != 0;
    }
    return 0;
}

} // namespace graftal
