#include "compiler/syntax/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/check.h"
#include "compiler/support/number.h"

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

using Arguments = std::span<const double>;

struct Function {
    const char* name;
    std::size_t arity;
    double (*apply)(Arguments);
};

constexpr std::array functions = {
    Function{"sin", 1, [](Arguments a) { return sin_deg(a[0]); }},
    Function{"cos", 1, [](Arguments a) { return cos_deg(a[0]); }},
    Function{"tan", 1, [](Arguments a) { return sin_deg(a[0]) / cos_deg(a[0]); }},
    Function{"asin", 1, [](Arguments a) { return to_deg(std::asin(a[0])); }},
    Function{"acos", 1, [](Arguments a) { return to_deg(std::acos(a[0])); }},
    Function{"atan", 1, [](Arguments a) { return to_deg(std::atan(a[0])); }},
    Function{"atan2", 2, [](Arguments a) { return to_deg(std::atan2(a[0], a[1])); }},
    Function{"sqrt", 1, [](Arguments a) { return std::sqrt(a[0]); }},
    Function{"exp", 1, [](Arguments a) { return std::exp(a[0]); }},
    Function{"log", 1, [](Arguments a) { return std::log(a[0]); }},
    Function{"floor", 1, [](Arguments a) { return std::floor(a[0]); }},
    Function{"ceil", 1, [](Arguments a) { return std::ceil(a[0]); }},
    Function{"abs", 1, [](Arguments a) { return std::abs(a[0]); }},
    Function{"sign", 1, [](Arguments a) { return sign(a[0]); }},
    Function{"min", 2, [](Arguments a) { return std::min(a[0], a[1]); }},
    Function{"max", 2, [](Arguments a) { return std::max(a[0], a[1]); }},
    Function{"mod", 2, [](Arguments a) { return std::fmod(a[0], a[1]); }},
    Function{"pow", 2, [](Arguments a) { return std::pow(a[0], a[1]); }},
};

const Function* function_named(std::string_view name) {
    const auto found =
        std::find_if(functions.begin(), functions.end(), [&](const Function& f) { return name == f.name; });
    return found == functions.end() ? nullptr : &*found;
}

double apply_binary(std::string_view op, double a, double b) {
    if (op == "+") return a + b;
    if (op == "-") return a - b;
    if (op == "*") return a * b;
    if (op == "/") return a / b;
    if (op == "%") return std::fmod(a, b);
    if (op == "^") return std::pow(a, b);
    if (op == "==") return a == b;
    if (op == "!=") return a != b;
    if (op == "<") return a < b;
    if (op == "<=") return a <= b;
    if (op == ">") return a > b;
    GRAFTAL_CHECK(op == ">=", "unknown operator in an expression");
    return a >= b;
}

class Evaluator {
  public:
    Evaluator(const Environment& environment, Diagnostics& diagnostics)
        : environment_(environment), diagnostics_(diagnostics) {}

    /// Recursion is as deep as the tree, which the parser bounds.
    std::optional<double> value(const Expression& e) {
        switch (e.kind) {
        case Expression::Kind::number:
            return e.number;
        case Expression::Kind::name:
            return name(e);
        case Expression::Kind::call:
            return call(e);
        case Expression::Kind::unary:
            return unary(e);
        case Expression::Kind::binary:
            return binary(e);
        }
        return std::nullopt;
    }

  private:
    std::optional<double> name(const Expression& e) {
        if (const auto found = environment_.find(e.text); found != environment_.end()) return found->second;
        if (e.text == "pi") return std::numbers::pi;
        Diagnostic& error = diagnostics_.error(e.span, fmt::format("unknown name '{}'", e.text));
        if (function_named(e.text)) {
            error.with_hint(fmt::format("'{}' is a function and needs its arguments in parentheses", e.text));
            return std::nullopt;
        }
        std::vector<std::string> candidates = {"pi"};
        for (const auto& [known, value] : environment_)
            candidates.push_back(known);
        error.with_hint(did_you_mean(e.text, candidates));
        return std::nullopt;
    }

    std::optional<double> call(const Expression& e) {
        const Function* function = function_named(e.text);
        if (!function) {
            std::vector<std::string> candidates;
            for (const Function& known : functions)
                candidates.push_back(known.name);
            diagnostics_.error(e.span, fmt::format("unknown function '{}'", e.text))
                .with_hint(did_you_mean(e.text, candidates));
            return std::nullopt;
        }
        if (e.operands.size() != function->arity) {
            diagnostics_.error(e.span,
                               fmt::format("'{}' takes {} argument{}, not {}", e.text, function->arity,
                                           function->arity == 1 ? "" : "s", e.operands.size()));
            return std::nullopt;
        }
        std::array<double, 2> arguments{};
        for (std::size_t i = 0; i < function->arity; ++i) {
            const std::optional<double> argument = value(e.operands[i]);
            if (!argument) return std::nullopt;
            arguments[i] = *argument;
        }
        const Arguments used(arguments.data(), function->arity);
        if (e.text == "mod" && arguments[1] == 0) return division_by_zero(e);
        const std::string_view separator = function->arity == 2 ? ", " : "";
        return finite(function->apply(used), e, [&] {
            return fmt::format("{}({}{}{})", e.text, shortest(arguments[0]), separator,
                               function->arity == 2 ? shortest(arguments[1]) : "");
        });
    }

    std::optional<double> unary(const Expression& e) {
        const std::optional<double> operand = value(e.operands[0]);
        if (!operand) return std::nullopt;
        return e.text == "!" ? static_cast<double>(*operand == 0) : -*operand;
    }

    std::optional<double> binary(const Expression& e) {
        const std::optional<double> left = value(e.operands[0]);
        if (!left) return std::nullopt;
        if (e.text == "&&" && *left == 0) return 0.0;
        if (e.text == "||" && *left != 0) return 1.0;
        const std::optional<double> right = value(e.operands[1]);
        if (!right) return std::nullopt;
        if (e.text == "&&" || e.text == "||") return static_cast<double>(*right != 0);
        if ((e.text == "/" || e.text == "%") && *right == 0) return division_by_zero(e);
        return finite(apply_binary(e.text, *left, *right), e,
                      [&] { return fmt::format("{} {} {}", shortest(*left), e.text, shortest(*right)); });
    }

    std::optional<double> division_by_zero(const Expression& e) {
        diagnostics_.error(e.span, "division by zero");
        return std::nullopt;
    }

    template<typename Describe>
    std::optional<double> finite(double result, const Expression& e, const Describe& describe) {
        if (std::isfinite(result)) return result;
        diagnostics_.error(e.span, fmt::format("{} is not a finite number", describe()));
        return std::nullopt;
    }

    const Environment& environment_;
    Diagnostics& diagnostics_;
};

} // namespace

std::optional<double> evaluate(const Expression& expression, const Environment& environment,
                               Diagnostics& diagnostics) {
    return Evaluator(environment, diagnostics).value(expression);
}

} // namespace graftal
