#include "compiler/import/cfdg/evaluate/functions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cfdg/evaluate/evaluator.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/hue.h"

namespace graftal::cfdg {

namespace {

constexpr double one_degree = std::numbers::pi / 180;

/// Exact at multiples of 90 degrees.
double sine(double degrees) {
    const double turns = std::fmod(degrees, 360);
    if (turns == 0 || std::abs(turns) == 180) return 0;
    return std::sin(turns * one_degree);
}

double not_in_52_bits(double x) {
    if (!(x >= 0 && x < 0x1p52)) return std::nan("");
    return static_cast<double>(~static_cast<std::uint64_t>(x) & 0xfffffffffffffULL);
}

/// Functions of one number; angles are in degrees.
const std::map<std::string, double (*)(double)>& plain_functions() {
    static const std::map<std::string, double (*)(double)> table = {
        {"sin", sine},
        {"cos", [](double x) { return sine(x + 90); }},
        {"tan", [](double x) { return std::tan(x * one_degree); }},
        {"cot", [](double x) { return 1 / std::tan(x * one_degree); }},
        {"asin", [](double x) { return std::asin(x) / one_degree; }},
        {"acos", [](double x) { return std::acos(x) / one_degree; }},
        {"atan", [](double x) { return std::atan(x) / one_degree; }},
        {"acot", [](double x) { return std::atan(1 / x) / one_degree; }},
        {"sinh", [](double x) { return std::sinh(x); }},
        {"cosh", [](double x) { return std::cosh(x); }},
        {"tanh", [](double x) { return std::tanh(x); }},
        {"asinh", [](double x) { return std::asinh(x); }},
        {"acosh", [](double x) { return std::acosh(x); }},
        {"atanh", [](double x) { return std::atanh(x); }},
        {"sqrt", [](double x) { return std::sqrt(x); }},
        {"exp", [](double x) { return std::exp(x); }},
        {"log", [](double x) { return std::log(x); }},
        {"log10", [](double x) { return std::log10(x); }},
        {"floor", [](double x) { return std::floor(x); }},
        {"ceiling", [](double x) { return std::ceil(x); }},
        {"abs", [](double x) { return std::abs(x); }},
        {"sg", [](double x) { return x == 0 ? 0.0 : 1.0; }},
        {"bitnot", not_in_52_bits},
    };
    return table;
}

} // namespace

double binary(const std::string& sign, double a, double b) {
    if (sign == "+") return a + b;
    if (sign == "-") return a - b;
    if (sign == "*") return a * b;
    if (sign == "/") return a / b;
    if (sign == "^") return std::pow(a, b);
    if (sign == "_") return std::max(0.0, a - b);
    if (sign == "<") return a < b;
    if (sign == "<=") return a <= b;
    if (sign == ">") return a > b;
    if (sign == ">=") return a >= b;
    if (sign == "==") return a == b;
    if (sign == "<>") return a != b;
    if (sign == "&&") return a != 0 && b != 0;
    if (sign == "||") return a != 0 || b != 0;
    return (a != 0) != (b != 0);
}

std::optional<Value> Evaluator::of_numbers(const Expr& expression, const std::vector<double>& n) {
    const std::string& name = expression.text;
    const auto finite = [&](double made) -> std::optional<Value> {
        if (std::isfinite(made)) return Value::of(made);
        return fail(expression.span, fmt::format("'{}' has no value here", name));
    };
    const auto whole = [&](std::size_t i) {
        return static_cast<std::uint64_t>(std::clamp(n[i], 0.0, 0x1p62));
    };
    const std::size_t count = n.size();
    if (name.starts_with("rand")) return random(expression, n);
    if (count == 0 && (name == "ftime" || name == "frame")) {
        const Definition* const time = definition(name == "ftime" ? "CF::FrameTime" : "CF::Frame", "");
        return time ? global(*time) : Value::of(0);
    }
    if (name == "infinity") return Value::of(count == 1 && n[0] < 0 ? -endless : endless);
    if (const auto plain = plain_functions().find(name); plain != plain_functions().end() && count == 1)
        return finite(plain->second(n[0]));
    if (count == 1 && name == "factorial") return finite(std::round(std::tgamma(std::floor(n[0]) + 1)));
    if (count == 1 && name == "isNatural") return Value::of(n[0] >= 0 && n[0] == std::floor(n[0]));
    if (count == 2) {
        if (name == "atan2") return finite(std::atan2(n[0], n[1]) * 180 / std::numbers::pi);
        if (name == "mod") return finite(std::fmod(n[0], n[1]));
        if (name == "abs") return Value::of(std::abs(n[0] - n[1]));
        if ((name == "div" || name == "divides") && whole(1) > 0)
            return Value::of(static_cast<double>(
                name == "div" ? whole(0) / whole(1) : static_cast<std::uint64_t>(whole(0) % whole(1) == 0)));
        if (name == "bitor") return Value::of(static_cast<double>(whole(0) | whole(1)));
        if (name == "bitand") return Value::of(static_cast<double>(whole(0) & whole(1)));
        if (name == "bitxor") return Value::of(static_cast<double>(whole(0) ^ whole(1)));
        if (name == "bitleft" && n[1] < 52)
            return Value::of(static_cast<double>((whole(0) << whole(1)) & 0xfffffffffffffULL));
        if (name == "bitright" && n[1] < 64) return Value::of(static_cast<double>(whole(0) >> whole(1)));
    }
    if (count > 0 && name == "min") return Value::of(*std::ranges::min_element(n));
    if (count > 0 && name == "max") return Value::of(*std::ranges::max_element(n));
    if (name == "dot" && count >= 2 && count % 2 == 0) {
        double sum = 0;
        for (std::size_t i = 0; i < count / 2; ++i)
            sum += n[i] * n[i + count / 2];
        return finite(sum);
    }
    if (name == "cross" && count == 6)
        return Value{
            .numbers = {n[1] * n[5] - n[2] * n[4], n[2] * n[3] - n[0] * n[5], n[0] * n[4] - n[1] * n[3]}};
    if (name == "vec" && count >= 2 && n[0] >= 1 && n[0] <= 1000) {
        Value result;
        for (std::size_t i = 0; i < static_cast<std::size_t>(n[0]); ++i)
            result.numbers.push_back(n[1 + i % (count - 1)]);
        return result;
    }
    if (name == "hsb2rgb" && count == 3) {
        const Rgb rgb = rgb_from_hsv(n[0], n[1], n[2]);
        return Value{.numbers = {rgb.r, rgb.g, rgb.b}};
    }
    if (name == "rgb2hsb" && count == 3) {
        const auto [most, least] = std::pair(std::max({n[0], n[1], n[2]}), std::min({n[0], n[1], n[2]}));
        if (most - least < 1e-12) return Value{.numbers = {0, 0, most}};
        const double sector = most == n[0]   ? (n[1] - n[2]) / (most - least)
                              : most == n[1] ? 2 + (n[2] - n[0]) / (most - least)
                                             : 4 + (n[0] - n[1]) / (most - least);
        return Value{.numbers = {std::fmod(60 * sector + 360, 360), (most - least) / most, most}};
    }
    if (plain_functions().contains(name) || name == "min" || name == "max" || name == "mod")
        return fail(expression.span, fmt::format("'{}' takes another number of arguments", name));
    return fail(expression.span, fmt::format("the function '{}' is not translated", name));
}

std::optional<Value> Evaluator::random(const Expr& expression, const std::vector<double>& n) {
    const std::string& name = expression.text;
    if (name == "rand" || name == "randint" || name == "rand_static") {
        if (n.size() > 2) return fail(expression.span, fmt::format("'{}' takes at most two numbers", name));
        const double a = n.size() == 2 ? n[0] : 0, b = n.empty() ? (name == "randint" ? 2 : 1) : n.back();
        const double k = name == "rand_static" // one for each place
                             ? CounterRandom::unit(CounterRandom::scrambled(expression.span.begin + seed))
                             : draws.unit();
        const double drawn = std::min(a, b) + k * std::abs(b - a);
        return Value::of(name == "randint" ? std::floor(drawn) : drawn);
    }
    if (const std::optional<double> drawn = draws.distribution(name, n)) return Value::of(*drawn);
    return fail(expression.span, fmt::format("'{}' is not translated with these numbers", name));
}

} // namespace graftal::cfdg
