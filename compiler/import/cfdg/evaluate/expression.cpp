#include "compiler/import/cfdg/evaluate/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/cfdg/evaluate/functions.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

constexpr int deepest_calls = 32;
constexpr std::size_t longest_text = 1'000'000;
constexpr std::size_t most_work = 5'000'000;

std::string our_name(const std::string& function) {
    return function == "ceiling" ? "ceil" : function;
}

// Expressions nest deep: the functions that call each other for their operands keep small frames, and leave
// the making of text to functions that call none of them.

std::string unary_text(const Expr& expression, const std::string& operand) {
    if (expression.text == "!") return fmt::format("!({})", operand);
    return expression.operands[0].kind == Expr::Kind::number ? "-" + operand : fmt::format("-({})", operand);
}

std::string binary_text(const std::string& sign, const std::string& a, const std::string& b) {
    if (sign == "..") return fmt::format("random({}, {})", a, b);
    if (sign == "+/-") return fmt::format("random({0} - ({1}), {0} + ({1}))", a, b);
    if (sign == "_") return fmt::format("max(0, {} - ({}))", a, b);
    if (sign == "^^") return fmt::format("((({}) != 0) != (({}) != 0))", a, b);
    return fmt::format("({} {} {})", a, sign == "<>" ? "!=" : sign, b);
}

} // namespace

bool is_random(const std::string& text) {
    return text.find("random(") != std::string::npos || text.find("normal(") != std::string::npos;
}

Expressions::Expressions(const ForeignFile& file, const Grammar& grammar) : file_(file), grammar_(grammar) {
    for (const Definition& definition : grammar_.definitions)
        definitions_.emplace(definition.name, &definition);
    for (const Definition& definition : grammar_.definitions) {
        if (definition.is_function || definition.name.starts_with("CF::")) continue;
        const std::optional<double> value = evaluate(definition.value, {}, 0);
        if (!value) continue;
        values_.emplace(definition.name, *value);
        constants_.push_back(&definition);
    }
}

const Definition* Expressions::definition(const std::string& name) const {
    const auto found = definitions_.find(name);
    return found == definitions_.end() ? nullptr : found->second;
}

const Definition* Expressions::modification(const Adjustment& adjustment) const {
    if (adjustment.values.size() != 1 || adjustment.values[0].kind != Expr::Kind::name) return nullptr;
    const Definition* const found = definition(adjustment.values[0].text);
    return found && found->value.kind == Expr::Kind::modification && !found->is_function ? found : nullptr;
}

bool Expressions::mentions(const Expr& expression, const std::string& name) {
    if (expression.kind == Expr::Kind::name && expression.text == name) return true;
    const auto in = [&](const Expr& operand) { return mentions(operand, name); };
    return std::ranges::any_of(expression.operands, in) ||
           (expression.change &&
            std::ranges::any_of(expression.change->adjustments, [&](const Adjustment& adjustment) {
                return std::ranges::any_of(adjustment.values, in);
            }));
}

std::nullopt_t Expressions::fail(const Expr& expression, std::string message) {
    file_.diagnostics.error(expression.span, std::move(message));
    return std::nullopt;
}

std::optional<std::string> Expressions::text(const Expr& expression, const Scope& scope) {
    std::optional<std::string> result;
    switch (expression.kind) {
    case Expr::Kind::number:
        result = shortest(expression.number);
        break;
    case Expr::Kind::name:
        result = name(expression, scope);
        break;
    case Expr::Kind::unary:
        if (const std::optional<std::string> operand = text(expression.operands[0], scope))
            result = unary_text(expression, *operand);
        break;
    case Expr::Kind::binary: {
        const std::optional<std::string> left = text(expression.operands[0], scope);
        if (!left) return std::nullopt; // where functions call themselves, the right one has no end
        const std::optional<std::string> right = text(expression.operands[1], scope);
        if (right) result = binary_text(expression.text, *left, *right);
        break;
    }
    case Expr::Kind::call:
        result = call(expression, scope);
        break;
    case Expr::Kind::list:
        return fail(expression, "vectors are not translated");
    case Expr::Kind::modification:
        return fail(expression, "an adjustment as a value is not translated");
    }
    if (!result) return std::nullopt;
    written_ += result->size();
    if (written_ > longest_text) return fail(expression, "the expressions of the file become too long");
    return result;
}

std::optional<std::string> Expressions::name(const Expr& expression, const Scope& scope) {
    if (const auto known = scope.find(expression.text); known != scope.end()) return known->second;
    if (const auto known = values_.find(expression.text); known != values_.end())
        return shortest(known->second);
    const Definition* const global = definition(expression.text);
    if (!global || global->is_function)
        return fail(expression, fmt::format("'{}' has no counterpart here", expression.text));
    if (depth_ == deepest_calls)
        return fail(expression, fmt::format("'{}' depends on itself", expression.text));
    ++depth_;
    const std::optional<std::string> value = text(global->value, {});
    --depth_;
    if (!value) return std::nullopt;
    return fmt::format("({})", *value);
}

std::optional<std::string> Expressions::element(const Expr& expression, const Scope& scope) {
    const Definition* const vector = definition(expression.operands[0].text);
    if (expression.operands[0].kind != Expr::Kind::name || !vector ||
        vector->value.kind != Expr::Kind::list || scope.contains(expression.operands[0].text))
        return fail(expression, "elements of this vector are not translated");
    const std::vector<Expr>& parts = vector->value.operands;
    if (const std::optional<double> index = number(expression.operands[1])) {
        if (!(*index >= 0 && *index < static_cast<double>(parts.size())))
            return fail(expression, fmt::format("the vector has {} elements", parts.size()));
        return text(parts[static_cast<std::size_t>(*index)], {});
    }
    const std::optional<std::string> index = text(expression.operands[1], scope);
    if (!index) return std::nullopt;
    if (is_random(*index)) return fail(expression, "a random element of a vector is not translated");
    std::string sum;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::optional<std::string> part = text(parts[i], {});
        if (!part) return std::nullopt;
        sum += fmt::format("{}(floor({}) == {}) * ({})", sum.empty() ? "" : " + ", *index, i, *part);
    }
    return fmt::format("({})", sum);
}

std::optional<std::string> Expressions::let(const Expr& expression, const Scope& scope) {
    Scope inner = scope;
    for (const Expr& local : expression.operands) {
        if (local.text != "=" || local.kind != Expr::Kind::binary) return text(local, inner);
        const std::optional<std::string> value = text(local.operands[1], inner);
        if (!value) return std::nullopt;
        if (is_random(*value)) return fail(local, "a random number of 'let' is not translated");
        inner[local.operands[0].text] = fmt::format("({})", *value);
    }
    return std::nullopt;
}

std::optional<std::string> Expressions::call(const Expr& expression, const Scope& scope) {
    if (expression.text == "[]") return element(expression, scope);
    if (expression.text == "let") return let(expression, scope);
    std::vector<std::string> arguments;
    for (const Expr& operand : expression.operands) {
        std::optional<std::string> argument = text(operand, scope);
        if (!argument) return std::nullopt;
        arguments.push_back(std::move(*argument));
    }
    const Definition* const function = definition(expression.text);
    if (function && function->is_function) return own_function(expression, *function, arguments);
    return known_function(expression, arguments);
}

std::optional<std::string> Expressions::own_function(const Expr& expression, const Definition& function,
                                                     const std::vector<std::string>& arguments) {
    if (function.parameters.size() != arguments.size())
        return fail(expression,
                    fmt::format("'{}' takes {} arguments", expression.text, function.parameters.size()));
    if (depth_ == deepest_calls)
        return fail(expression, fmt::format("'{}' calls itself: recursive functions are not translated",
                                            expression.text));
    Scope inner;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (is_random(arguments[i]))
            return fail(expression.operands[i],
                        "a random number as the argument of a function is not translated");
        inner[function.parameters[i].name] = fmt::format("({})", arguments[i]);
    }
    ++depth_;
    std::optional<std::string> value = text(function.value, inner);
    --depth_;
    if (value) value = fmt::format("({})", *value);
    return value;
}

std::optional<std::string> Expressions::known_function(const Expr& expression,
                                                       const std::vector<std::string>& arguments) {
    const std::string& name = expression.text;
    const std::size_t count = arguments.size();
    const auto number_of = [&](std::size_t i) { return fmt::format("({})", arguments[i]); };
    if (count == 1 && name == "log10")
        return fmt::format("(log({}) / {})", arguments[0], shortest(std::numbers::ln10));
    static const std::set<std::string, std::less<>> shared = {
        "sin", "cos", "tan", "asin", "acos", "atan", "sqrt", "exp", "log", "floor", "ceiling", "abs"};
    if (count == 1 && shared.contains(name)) return fmt::format("{}({})", our_name(name), arguments[0]);
    if (count == 1 && name == "sg") return fmt::format("({} != 0)", number_of(0));
    if (count == 2 && name == "atan2") return fmt::format("atan2({}, {})", arguments[0], arguments[1]);
    if (count == 2 && name == "mod") return fmt::format("({} % {})", number_of(0), number_of(1));
    if (count == 2 && (name == "div" || name == "divides")) {
        if (name == "div") return fmt::format("floor({} / {})", number_of(0), number_of(1));
        return fmt::format("(mod({}, {}) == 0)", arguments[0], arguments[1]);
    }
    if (count >= 1 && (name == "min" || name == "max")) {
        std::string result = arguments[0];
        for (std::size_t i = 1; i < count; ++i)
            result = fmt::format("{}({}, {})", name, result, arguments[i]);
        return result;
    }
    if (name == "factorial" || name == "isNatural" || name == "ftime" || name == "frame") {
        const std::optional<double> value = number(expression);
        if (value) return shortest(*value);
    }
    if (name == "if" && count == 3) {
        if (is_random(arguments[0])) return fail(expression, "a random condition is not translated");
        return fmt::format("(({0}) != 0) * {1} + (({0}) == 0) * {2}", arguments[0], number_of(1),
                           number_of(2));
    }
    if (name == "select" && count >= 2) {
        if (is_random(arguments[0])) return fail(expression, "a random selection is not translated");
        std::string sum;
        for (std::size_t i = 1; i < count; ++i) {
            const std::string test = i == 1           ? fmt::format("{} < 1", number_of(0))
                                     : i + 1 == count ? fmt::format("{} >= {}", number_of(0), i - 1)
                                                      : fmt::format("(floor({}) == {})", arguments[0], i - 1);
            sum += fmt::format("{}({}) * {}", sum.empty() ? "" : " + ", test, number_of(i));
        }
        return fmt::format("({})", sum);
    }
    const bool fixed = name.starts_with("rand_static");
    if (fixed || name == "rand" || name == "randint" || name == "rand_static" || name == "rand::normal") {
        const std::string least = count == 2 ? arguments[0] : "0";
        const std::string most = count == 0 ? (name == "randint" ? "2" : "1") : arguments[count - 1];
        if (count > 2) return fail(expression, fmt::format("'{}' takes at most two numbers", name));
        if (name == "rand::normal") return fmt::format("normal({}, {})", least, most);
        if (fixed) {
            const double share =
                CounterRandom::unit(CounterRandom::scrambled(expression.span.begin)); // one for each place
            return fmt::format("lerp({}, {}, {})", least, most, shortest(std::round(1e6 * share) / 1e6));
        }
        const std::string drawn = fmt::format("random({}, {})", least, most);
        return name == "randint" ? fmt::format("floor({})", drawn) : drawn;
    }
    return fail(expression, fmt::format("the function '{}' is not translated", name));
}

std::optional<double> Expressions::number(const Expr& expression, const Numbers& known) const {
    return evaluate(expression, known, 0);
}

std::optional<double> Expressions::evaluate(const Expr& expression, const Numbers& known, int depth) const {
    if (depth > deepest_calls || ++work_ > most_work) return std::nullopt;
    if (expression.kind == Expr::Kind::call && expression.text == "let") {
        Numbers inner = known;
        for (const Expr& local : expression.operands) {
            const bool last = local.text != "=" || local.kind != Expr::Kind::binary;
            const std::optional<double> value = evaluate(last ? local : local.operands[1], inner, depth + 1);
            if (!value || last) return value;
            inner[local.operands[0].text] = *value;
        }
    }
    if (expression.kind == Expr::Kind::call && expression.text == "[]") {
        const Definition* const vector = definition(expression.operands[0].text);
        const std::optional<double> index = evaluate(expression.operands[1], known, depth + 1);
        if (!vector || !index || vector->value.kind != Expr::Kind::list) return std::nullopt;
        if (!(*index >= 0 && *index < static_cast<double>(vector->value.operands.size())))
            return std::nullopt;
        return evaluate(vector->value.operands[static_cast<std::size_t>(*index)], {}, depth + 1);
    }
    if (expression.kind == Expr::Kind::call && expression.text == "if" && expression.operands.size() == 3) {
        const std::optional<double> test = evaluate(expression.operands[0], known, depth);
        return test ? evaluate(expression.operands[*test != 0 ? 1 : 2], known, depth) : std::nullopt;
    }
    std::vector<double> operands;
    for (const Expr& operand : expression.operands) {
        const std::optional<double> value = evaluate(operand, known, depth);
        if (!value) return std::nullopt;
        operands.push_back(*value);
    }
    const auto finite = [](double value) {
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
    };
    const std::string& name = expression.text;
    switch (expression.kind) {
    case Expr::Kind::number:
        return expression.number;
    case Expr::Kind::name: {
        if (const auto found = known.find(name); found != known.end()) return found->second;
        if (const auto found = values_.find(name); found != values_.end()) return found->second;
        const Definition* const global = definition(name);
        return global && !global->is_function ? evaluate(global->value, {}, depth + 1) : std::nullopt;
    }
    case Expr::Kind::unary:
        return name == "!" ? static_cast<double>(operands[0] == 0) : -operands[0];
    case Expr::Kind::binary:
        if (name == ".." || name == "+/-") return std::nullopt;
        return finite(binary(name, operands[0], operands[1]));
    case Expr::Kind::call: {
        if (const Definition* const function = definition(name); function && function->is_function) {
            Numbers inner;
            if (function->parameters.size() != operands.size()) return std::nullopt;
            for (std::size_t i = 0; i < operands.size(); ++i)
                inner[function->parameters[i].name] = operands[i];
            return evaluate(function->value, inner, depth + 1);
        }
        if (const auto plain = plain_functions().find(name);
            plain != plain_functions().end() && operands.size() == 1)
            return finite(plain->second(operands[0]));
        if (operands.size() == 2 && name == "mod")
            return operands[1] == 0 ? std::nullopt : finite(std::fmod(operands[0], operands[1]));
        if (operands.size() == 2 && name == "atan2")
            return std::atan2(operands[0], operands[1]) * 180 / std::numbers::pi;
        if (operands.size() == 2 && name == "div") return finite(std::floor(operands[0] / operands[1]));
        if (!operands.empty() && name == "min") return *std::ranges::min_element(operands);
        if (!operands.empty() && name == "max") return *std::ranges::max_element(operands);
        if (operands.size() == 1 && name == "factorial")
            return finite(std::round(std::tgamma(operands[0] + 1)));
        if (operands.size() == 1 && name == "isNatural")
            return operands[0] >= 0 && operands[0] == std::floor(operands[0]);
        if (operands.empty() && (name == "ftime" || name == "frame")) return 0.0;
        return std::nullopt;
    }
    default:
        return std::nullopt;
    }
}

std::optional<Interval> Expressions::range(const Expr& expression) const {
    if (const std::optional<double> value = number(expression)) return Interval{*value, *value};
    const auto hull = [](std::initializer_list<double> values) {
        return Interval{std::min(values), std::max(values)};
    };
    if (expression.kind == Expr::Kind::unary && expression.text == "-") {
        const std::optional<Interval> a = range(expression.operands[0]);
        return a ? std::optional(hull({-a->least, -a->most})) : std::nullopt;
    }
    const bool drawn = expression.kind == Expr::Kind::call && expression.text.starts_with("rand") &&
                       expression.text != "rand::normal";
    if (drawn && expression.operands.empty()) return Interval{0, 1};
    if (drawn && expression.operands.size() == 1) {
        const std::optional<Interval> a = range(expression.operands[0]);
        return a ? std::optional(hull({0, a->least, a->most})) : std::nullopt;
    }
    if (expression.operands.size() != 2) return std::nullopt;
    const std::optional<Interval> a = range(expression.operands[0]), b = range(expression.operands[1]);
    if (!a || !b) return std::nullopt;
    if (drawn) return hull({a->least, a->most, b->least, b->most});
    if (expression.kind != Expr::Kind::binary) return std::nullopt;
    const std::string& sign = expression.text;
    if (sign == "..") return hull({a->least, a->most, b->least, b->most});
    if (sign == "+/-") return Interval{a->least - std::abs(b->most), a->most + std::abs(b->most)};
    if (sign == "+") return Interval{a->least + b->least, a->most + b->most};
    if (sign == "-") return Interval{a->least - b->most, a->most - b->least};
    if (sign == "*")
        return hull({a->least * b->least, a->least * b->most, a->most * b->least, a->most * b->most});
    return std::nullopt;
}

} // namespace graftal::cfdg
