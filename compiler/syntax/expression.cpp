#include "compiler/syntax/expression.h"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/syntax/expression_functions.h"
#include "compiler/syntax/lost_value.h"

namespace graftal {

namespace {

class Evaluator {
  public:
    Evaluator(const Environment& environment, const ChanceDraws& draws, const ExpressionCells& cells,
              Diagnostics& diagnostics)
        : environment_(environment), draws_(draws), cells_(cells), diagnostics_(diagnostics) {}

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
        case Expression::Kind::element:
            return element(e);
        }
        return std::nullopt;
    }

  private:
    std::optional<double> name(const Expression& e) {
        if (const auto found = environment_.find(e.text); found != environment_.end()) {
            if (std::isnan(found->second)) return std::nullopt; // lost_value
            return found->second;
        }
        if (const CellPlace* const cell = cells_.find(e.text)) {
            if (cell->dimensions == 0) return cells_.values[cell->first];
            diagnostics_.error(e.span, fmt::format("'{}' is an array", e.text))
                .with_hint(fmt::format("write an element of it: {}{}", e.text,
                                       cell->dimensions == 1 ? "[0]" : "[0][0]"));
            return std::nullopt;
        }
        if (e.text == "pi") return std::numbers::pi;
        Diagnostic& error = diagnostics_.error(e.span, fmt::format("unknown name '{}'", e.text));
        if (expression_function(e.text)) {
            error.with_hint(fmt::format("'{}' is a function and needs its arguments in parentheses", e.text));
            return std::nullopt;
        }
        std::vector<std::string> candidates = {"pi"};
        for (const auto& [known, value] : environment_)
            candidates.push_back(known);
        if (cells_.places)
            for (const auto& [known, place] : *cells_.places)
                candidates.push_back(known);
        const bool unit = e.text == "deg" || e.text == "degrees" || e.text == "rad" || e.text == "radians";
        error.with_hint(unit ? "angles are in degrees, and numbers have no units"
                        : candidates.size() == 1 && e.text != "PI" && e.text != "Pi"
                            ? fmt::format("'let {} = ...' names a number", e.text)
                            : choices(e.text, candidates));
        return std::nullopt;
    }

    std::optional<double> element(const Expression& e) {
        const CellPlace* const array = cells_.find(e.text);
        if (!array || environment_.contains(e.text)) return unknown_array(e);
        if (array->dimensions != e.operands.size()) {
            diagnostics_.error(e.span,
                               array->dimensions == 0
                                   ? fmt::format("'{}' is a number, not an array", e.text)
                                   : fmt::format("'{}' has {} ind{}, not {}", e.text, array->dimensions,
                                                 array->dimensions == 1 ? "ex" : "ices", e.operands.size()));
            return std::nullopt;
        }
        std::uint32_t at = 0;
        for (std::size_t i = 0; i < e.operands.size(); ++i) {
            const std::optional<double> number = value(e.operands[i]);
            if (!number) return std::nullopt;
            const std::optional<std::uint32_t> index = cell_index(*number, array->sizes[i]);
            if (!index) {
                diagnostics_.error(e.operands[i].span,
                                   fmt::format("this index of '{}' must lie between 0 and {}, but is {}",
                                               e.text, array->sizes[i] - 1, shortest(*number)));
                return std::nullopt;
            }
            at = at * array->sizes[i] + *index;
        }
        return cells_.values[array->first + at];
    }

    std::nullopt_t unknown_array(const Expression& e) {
        if (environment_.contains(e.text)) {
            diagnostics_.error(e.span, fmt::format("'{}' is a number, not an array", e.text));
            return std::nullopt;
        }
        std::vector<std::string> candidates;
        if (cells_.places)
            for (const auto& [known, place] : *cells_.places)
                if (place.dimensions > 0) candidates.push_back(known);
        diagnostics_.error(e.span, fmt::format("unknown array '{}'", e.text))
            .with_hint(candidates.empty() ? "only a block of an L-system has arrays: array a[3] = 1, 2, 3"
                                          : choices(e.text, candidates));
        return std::nullopt;
    }

    std::optional<double> call(const Expression& e) {
        const ExpressionFunction* function = expression_function(e.text);
        if (e.table) return of_table(e);
        if (chance_function(e.text)) return chance(e);
        if (!function) {
            std::vector<std::string> candidates;
            for (const ExpressionFunction& known : expression_functions())
                candidates.push_back(known.name);
            diagnostics_.error(e.span, fmt::format("unknown function '{}'", e.text))
                .with_hint(e.text == "radians" || e.text == "degrees" ? "angles are in degrees everywhere"
                                                                      : choices(e.text, candidates));
            return std::nullopt;
        }
        if (e.operands.size() != function->arity) return wrong_count(e, function->arity);
        if (function->chooses) {
            const std::optional<double> condition = value(e.operands[0]);
            if (!condition) return std::nullopt;
            return value(e.operands[*condition != 0 ? 1 : 2]);
        }
        std::array<double, max_function_arity> arguments{};
        for (std::size_t i = 0; i < function->arity; ++i) {
            const std::optional<double> argument = value(e.operands[i]);
            if (!argument) return std::nullopt;
            arguments[i] = *argument;
        }
        const std::span<const double> used(arguments.data(), function->arity);
        if (e.text == "mod" && arguments[1] == 0) return division_by_zero(e);
        return finite(function->apply(used), e, [&] { return call_text(e.text, used); });
    }

    std::optional<double> of_table(const Expression& e) {
        if (e.operands.size() != 1) return wrong_count(e, 1);
        const std::optional<double> x = value(e.operands[0]);
        if (!x) return std::nullopt;
        return table_value(*e.table, *x);
    }

    std::nullopt_t wrong_count(const Expression& e, std::size_t arity) {
        diagnostics_.error(e.span, fmt::format("'{}' takes {} argument{}, not {}", e.text, arity,
                                               arity == 1 ? "" : "s", e.operands.size()));
        return std::nullopt;
    }

    std::optional<double> chance(const Expression& e) {
        if (e.operands.size() != chance_arguments) return wrong_count(e, chance_arguments);
        const auto draw = draws_.find(&e);
        if (draw == draws_.end()) {
            diagnostics_.error(e.span,
                               fmt::format("'{}' draws random numbers, which only the lines of an object "
                                           "(.inst) and productions (.lsys) may use",
                                           e.text));
            return std::nullopt;
        }
        const std::optional<double> first = value(e.operands[0]), second = value(e.operands[1]);
        if (!first || !second) return std::nullopt;
        if (e.text == "normal" && *second < 0) {
            diagnostics_.error(e.operands[1].span,
                               fmt::format("a deviation must not be negative, but is {}", shortest(*second)));
            return std::nullopt;
        }
        const std::array arguments = {draw->second, *first, *second};
        return finite(chance_function(e.text)->apply(arguments), e,
                      [&] { return call_text(e.text, std::span(arguments).subspan(1)); });
    }

    static std::string call_text(std::string_view name, std::span<const double> arguments) {
        std::string text;
        for (const double argument : arguments)
            text += (text.empty() ? "" : ", ") + shortest(argument);
        return fmt::format("{}({})", name, text);
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
        return finite(apply_binary(binary_operator(e.text), *left, *right), e,
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
    const ChanceDraws& draws_;
    const ExpressionCells& cells_;
    Diagnostics& diagnostics_;
};

} // namespace

std::optional<double> evaluate(const Expression& expression, const Environment& environment,
                               Diagnostics& diagnostics, const ChanceDraws& draws,
                               const ExpressionCells& cells) {
    return Evaluator(environment, draws, cells, diagnostics).value(expression);
}

std::optional<std::uint32_t> cell_index(double index, std::uint32_t size) {
    constexpr double rounding = 1e-9;
    const double whole = std::floor(index + rounding);
    if (!(whole >= 0 && whole < size)) return std::nullopt;
    return static_cast<std::uint32_t>(whole);
}

} // namespace graftal
