#include "compiler/import/cfdg/evaluate/evaluator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cfdg/evaluate/functions.h"
#include "compiler/support/counter_random.h"

namespace graftal::cfdg {

namespace {

constexpr int deepest_expressions = 1000; ///< expressions within expressions, through functions too
constexpr std::size_t most_evaluations = 100'000'000; ///< expressions that are evaluated
constexpr std::size_t longest_vector = 10'000;

/// Number of numbers that a parameter of this type holds.
std::size_t numbers_of_type(std::string_view type) {
    if (!type.starts_with("vector")) return 1;
    std::size_t size = 0;
    for (const char c : type.substr(6))
        size = c >= '0' && c <= '9'
                   ? std::min<std::size_t>(10 * size + static_cast<std::size_t>(c - '0'), 1000)
                   : 1;
    return std::max<std::size_t>(size, 1);
}

bool is_setting(std::string_view name) {
    return name.starts_with("CF::");
}

/// Whether the left operand decides alone; it is the result then.
bool decides(const std::string& sign, Value& left) {
    if (left.kind != Value::Kind::numbers) return false;
    if (sign == "&&") return left.numbers == std::vector{0.0};
    if (sign != "||" || left.numbers.size() != 1 || left.numbers[0] == 0) return false;
    left.numbers[0] = 1;
    return true;
}

} // namespace

std::string key_of(const Value& value) {
    std::string key;
    const auto add = [&](double number) {
        fmt::format_to(std::back_inserter(key), "{:a},", number == 0 ? 0 : number);
    };
    switch (value.kind) {
    case Value::Kind::numbers:
        for (const double number : value.numbers)
            add(number);
        break;
    case Value::Kind::change:
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                add(value.change.map.linear[column][row]);
        for (int row = 0; row < 3; ++row)
            add(value.change.map.translation[row]);
        for (const ColourStep& step : value.change.colours) {
            key += fmt::format("{}{}", static_cast<int>(step.kind), static_cast<int>(step.channel));
            add(step.amount);
            add(step.goal);
        }
        break;
    case Value::Kind::shape:
        key += value.shape->name + "(";
        for (const Value& argument : value.shape->arguments)
            key += key_of(argument) + ";";
        key += ")";
        break;
    case Value::Kind::flags:
        key += value.flags;
        break;
    }
    return key;
}

std::nullopt_t Evaluator::fail(Span place, std::string message, std::string hint) {
    file_.diagnostics.error(place, std::move(message)).with_hint(std::move(hint));
    return std::nullopt;
}

void Evaluator::note(Span place, std::string message) {
    if (noted_.insert(place.begin).second) file_.diagnostics.note(place, std::move(message));
}

bool Evaluator::spend(Span place) {
    file_.work(1, ImportPrice::evaluation);
    if (++work_ <= most_evaluations) return true;
    if (work_ == most_evaluations + 1)
        fail(place, fmt::format("the grammar evaluates more than {} expressions", most_evaluations),
             "give its loops fewer turns, and its functions fewer steps in which they call themselves");
    return false;
}

const Definition* Evaluator::definition(std::string_view name, std::string_view space) const {
    return in_spaces(name, space, [&](const std::string& full) -> const Definition* {
        const auto found = definitions_.find(full);
        return found == definitions_.end() ? nullptr : found->second;
    });
}

std::optional<Value> Evaluator::value(const Expr& expression, const Surroundings& at) {
    if (!spend(expression.span)) return std::nullopt;
    if (depth_ >= deepest_expressions)
        return fail(expression.span,
                    fmt::format("expressions and functions nest more than {} deep here", deepest_expressions),
                    "let functions call themselves less often");
    ++depth_;
    std::optional<Value> result = value_of_kind(expression, at);
    --depth_;
    return result;
}

// Expressions nest deep, and functions call themselves: each of these on the way keeps a small frame.

std::optional<Value> Evaluator::value_of_kind(const Expr& expression, const Surroundings& at) {
    switch (expression.kind) {
    case Expr::Kind::name:
        return value_of_name(expression, at);
    case Expr::Kind::list:
        return list(expression, at);
    case Expr::Kind::modification:
        return change_value(*expression.change, at);
    case Expr::Kind::unary:
        return unary(expression, at);
    case Expr::Kind::binary:
        return operation(expression, at);
    case Expr::Kind::call:
        return call(expression, at);
    case Expr::Kind::number:
        break;
    }
    return Value::of(expression.number);
}

std::optional<Value> Evaluator::change_value(const Modification& modification, const Surroundings& at) {
    std::optional<Change> made = change(modification, at);
    if (!made) return std::nullopt;
    return Value{.kind = Value::Kind::change, .change = std::move(*made)};
}

std::optional<std::vector<double>> Evaluator::numbers(const Expr& expression, const Surroundings& at) {
    std::optional<Value> result = value(expression, at);
    if (!result) return std::nullopt;
    if (result->kind != Value::Kind::numbers) return fail(expression.span, "this is no number");
    return std::move(result->numbers);
}

std::optional<double> Evaluator::number(const Expr& expression, const Surroundings& at) {
    if (expression.kind == Expr::Kind::number) return expression.number;
    const std::optional<std::vector<double>> n = numbers(expression, at);
    if (!n) return std::nullopt;
    if (n->size() != 1)
        return fail(expression.span, fmt::format("one number is expected here, not {}", n->size()));
    return n->front();
}

std::optional<Value> Evaluator::value_of_name(const Expr& expression, const Surroundings& at) {
    const std::string& name = expression.text;
    if (const auto found = at.values.find(name); found != at.values.end()) return found->second;
    if (const Definition* const found = definition(name, at.space); found && !found->is_function)
        return global(*found);
    if (grammar_.shape(name, at.space) || !primitive_named(name).empty())
        return shape_value(expression, name, at);
    if (is_setting(name)) return Value{.kind = Value::Kind::flags, .flags = name};
    if (name == "infinity") return Value::of(endless);
    return fail(expression.span, fmt::format("unknown name '{}'", name));
}

/// Evaluated once, with random numbers of its own.
std::optional<Value> Evaluator::global(const Definition& definition) {
    if (const auto known = globals_.find(definition.name); known != globals_.end()) return known->second;
    if (!open_.insert(definition.name).second)
        return fail(definition.span, fmt::format("'{}' depends on itself", definition.name));
    const Draws before = std::exchange(draws, Draws(CounterRandom::scrambled(definition.span.begin + seed)));
    std::optional<Value> result = value(definition.value, {.space = definition.space});
    draws = before;
    open_.erase(definition.name);
    if (result) globals_.emplace(definition.name, *result);
    return result;
}

std::optional<Value> Evaluator::list(const Expr& expression, const Surroundings& at) {
    Value all;
    for (const Expr& part : expression.operands) {
        std::optional<Value> one = value(part, at);
        if (!one) return std::nullopt;
        if (one->kind == Value::Kind::flags) {
            all.kind = Value::Kind::flags;
            all.flags += one->flags;
            continue;
        }
        if (one->kind != Value::Kind::numbers) return fail(part.span, "only numbers make a vector");
        all.numbers.insert(all.numbers.end(), one->numbers.begin(), one->numbers.end());
        if (all.numbers.size() > longest_vector) return fail(expression.span, "this vector is too long");
    }
    return all;
}

std::optional<Value> Evaluator::unary(const Expr& expression, const Surroundings& at) {
    std::optional<std::vector<double>> n = numbers(expression.operands[0], at);
    if (!n) return std::nullopt;
    for (double& number : *n)
        number = expression.text == "!" ? static_cast<double>(number == 0) : -number;
    return Value{.numbers = std::move(*n)};
}

std::optional<Value> Evaluator::operation(const Expr& expression, const Surroundings& at) {
    std::optional<Value> left = value(expression.operands[0], at);
    if (!left || decides(expression.text, *left)) return left;
    const std::optional<Value> right = value(expression.operands[1], at);
    if (!right) return std::nullopt;
    return combined(expression, *left, *right);
}

std::optional<Value> Evaluator::combined(const Expr& expression, const Value& left, const Value& right) {
    const std::string& sign = expression.text;
    if (left.kind == Value::Kind::flags && (sign == "+" || sign == "||"))
        return Value{.kind = Value::Kind::flags, .flags = left.flags + right.flags};
    for (std::size_t i = 0; i < 2; ++i)
        if ((i == 0 ? left : right).kind != Value::Kind::numbers)
            return fail(expression.operands[i].span, "this is no number");
    const std::vector<double>&a = left.numbers, &b = right.numbers;
    if (a.empty() || b.empty()) return fail(expression.span, "this is no number");
    if (sign == ".." || sign == "+/-") {
        const double k = draws.unit();
        return Value::of(sign == ".." ? std::min(a[0], b[0]) + k * std::abs(b[0] - a[0])
                                      : a[0] + (2 * k - 1) * b[0]);
    }
    if (sign == "==" || sign == "<>") return Value::of((a == b) == (sign == "=="));
    if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
        return fail(expression.span, "these vectors have different lengths");
    Value result;
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
        const double made = binary(sign, a[a.size() == 1 ? 0 : i], b[b.size() == 1 ? 0 : i]);
        if (!std::isfinite(made)) return fail(expression.span, "this has no finite value");
        result.numbers.push_back(made);
    }
    return result;
}

std::optional<std::vector<Value>> Evaluator::arguments(const std::vector<Expr>& expressions,
                                                       const Surroundings& at) {
    std::vector<Value> all;
    for (const Expr& expression : expressions) {
        std::optional<Value> one = value(expression, at);
        if (!one) return std::nullopt;
        all.push_back(std::move(*one));
    }
    return all;
}

std::optional<Values> Evaluator::bind(const std::vector<Parameter>& parameters,
                                      const std::vector<Value>& arguments, Span place) {
    Values bound;
    if (arguments.size() == parameters.size()) {
        for (std::size_t i = 0; i < parameters.size(); ++i)
            bound.insert_or_assign(parameters[i].name, arguments[i]);
        return bound;
    }
    std::vector<double> flat;
    bool plain = true;
    for (const Value& argument : arguments) {
        plain = plain && argument.kind == Value::Kind::numbers;
        flat.insert(flat.end(), argument.numbers.begin(), argument.numbers.end());
    }
    std::size_t wanted = 0, used = 0;
    for (const Parameter& parameter : parameters)
        wanted += numbers_of_type(parameter.type);
    if (!plain || flat.size() != wanted)
        return fail(place,
                    fmt::format("{} arguments for {} parameters", arguments.size(), parameters.size()));
    for (const Parameter& parameter : parameters) {
        const auto from = flat.begin() + static_cast<std::ptrdiff_t>(used);
        used += numbers_of_type(parameter.type);
        bound.insert_or_assign(parameter.name,
                               Value{.numbers = {from, flat.begin() + static_cast<std::ptrdiff_t>(used)}});
    }
    return bound;
}

std::optional<Value> Evaluator::function(const Definition& function, const Expr& expression,
                                         const Surroundings& at) {
    const std::optional<std::vector<Value>> given = arguments(expression.operands, at);
    if (!given) return std::nullopt;
    std::optional<Values> bound = bind(function.parameters, *given, expression.span);
    if (!bound) return std::nullopt;
    return value(function.value, {.values = std::move(*bound), .space = function.space});
}

std::optional<Value> Evaluator::call(const Expr& expression, const Surroundings& at) {
    const std::string& name = expression.text;
    if (name == "[]") return element(expression, at);
    if (name == "let") return let(expression, at);
    if (name == "if" || name == "select") return select(expression, at);
    if (const Definition* const found = definition(name, at.space); found && found->is_function)
        return function(*found, expression, at);
    if (grammar_.shape(name, at.space) || !primitive_named(name).empty() || at.values.contains(name))
        return shape_value(expression, name, at);
    std::vector<double> n;
    for (const Expr& operand : expression.operands) {
        const std::optional<std::vector<double>> part = numbers(operand, at);
        if (!part) return std::nullopt;
        n.insert(n.end(), part->begin(), part->end());
    }
    return of_numbers(expression, n);
}

std::optional<Value> Evaluator::element(const Expr& expression, const Surroundings& at) {
    const std::optional<std::vector<double>> vector = numbers(expression.operands[0], at);
    if (!vector) return std::nullopt;
    std::vector<double> n = {0, 1, 1}; // the first, how many, and their distance
    for (std::size_t i = 1; i < expression.operands.size(); ++i) {
        const std::optional<double> one = number(expression.operands[i], at);
        if (!one) return std::nullopt;
        if (i > n.size() || !(std::abs(*one) < 1e6))
            return fail(expression.span, "a vector has no such element");
        n[i - 1] = std::floor(*one);
    }
    Value result;
    for (double i = 0; i < n[1]; ++i) {
        const double place = n[0] + i * n[2];
        if (!(place >= 0 && place < static_cast<double>(vector->size())) ||
            i > static_cast<double>(longest_vector))
            return fail(expression.span, fmt::format("the vector has {} elements", vector->size()));
        result.numbers.push_back((*vector)[static_cast<std::size_t>(place)]);
    }
    return result;
}

std::optional<Value> Evaluator::let(const Expr& expression, const Surroundings& at) {
    Surroundings inner = at;
    for (const Expr& local : expression.operands) {
        const bool last = local.kind != Expr::Kind::binary || local.text != "=";
        std::optional<Value> one = value(last ? local : local.operands[1], inner);
        if (!one || last) return one;
        inner.values.insert_or_assign(local.operands[0].text, std::move(*one));
    }
    return std::nullopt;
}

/// `if(test, a, b)` and `select(index, a, b, ...)` evaluate only what they give.
std::optional<Value> Evaluator::select(const Expr& expression, const Surroundings& at) {
    std::vector<const Expr*> parts;
    for (const Expr& operand : expression.operands)
        parts.push_back(&operand);
    if (parts.size() < 2 || (expression.text == "if" && parts.size() > 3))
        return fail(expression.span, fmt::format("'{}' takes other arguments", expression.text));
    const std::optional<double> index = number(*parts[0], at);
    if (!index) return std::nullopt;
    if (expression.text == "if") {
        if (*index == 0 && parts.size() == 2) return fail(expression.span, "'if' has no value for this case");
        return value(*parts[*index != 0 ? 1 : 2], at);
    }
    const double last = static_cast<double>(parts.size() - 2);
    return value(*parts[1 + static_cast<std::size_t>(std::clamp(std::floor(*index), 0.0, last))], at);
}

const Rule& Evaluator::rule(const Shape& shape) {
    if (shape.rules.size() == 1) return shape.rules.front();
    double percents = 0, weights = 0;
    for (const Rule& rule : shape.rules)
        (rule.percent ? percents : weights) += rule.weight.value_or(1);
    const double plain = percents > 0 && weights > 0 ? std::max(0.0, 100 - percents) / weights : 1;
    double all = percents + weights * plain;
    double drawn = draws.unit() * all;
    for (const Rule& rule : shape.rules) {
        drawn -= rule.weight.value_or(1) * (rule.percent ? 1 : plain);
        if (drawn < 0) return rule;
    }
    return shape.rules.back();
}

std::optional<Value> Evaluator::shape_value(const Expr& expression, std::string_view name,
                                            const Surroundings& at) {
    const bool reuses = expression.operands.size() == 1 && expression.operands[0].kind == Expr::Kind::name &&
                        expression.operands[0].text == "=";
    Element element;
    element.name = name;
    element.span = expression.span;
    element.reuses_arguments = reuses;
    if (!reuses) element.arguments = expression.operands;
    std::optional<ShapeValue> made = shape(element, at);
    if (!made) return std::nullopt;
    return Value{.kind = Value::Kind::shape, .shape = std::make_shared<const ShapeValue>(std::move(*made))};
}

std::optional<ShapeValue> Evaluator::shape(const Element& element, const Surroundings& at) {
    if (element.computed) {
        const std::optional<Value> made = value(element.arguments[0], at);
        if (!made) return std::nullopt;
        if (made->kind != Value::Kind::shape) return fail(element.span, "this gives no shape");
        return *made->shape;
    }
    const std::string& name = element.name;
    const auto from_value = [&](const std::optional<Value>& held) -> std::optional<ShapeValue> {
        if (!held) return std::nullopt;
        if (held->kind != Value::Kind::shape)
            return fail(element.span, fmt::format("'{}' is no shape", name));
        if (element.arguments.empty()) return *held->shape;
        return fail(element.span, fmt::format("the shape '{}' has its arguments already", name));
    };
    if (const auto local = at.values.find(name); local != at.values.end()) return from_value(local->second);
    const std::optional<std::size_t> number = grammar_.shape(name, at.space);
    const Definition* const named = number ? nullptr : definition(name, at.space);
    if (named && !named->is_function) return from_value(global(*named));
    if (named || (!number && (name == "if" || name == "select"))) {
        Expr expression{
            .kind = Expr::Kind::call, .text = name, .operands = element.arguments, .span = element.span};
        const std::optional<Value> made = value(expression, at);
        if (!made) return std::nullopt;
        if (made->kind != Value::Kind::shape)
            return fail(element.span, fmt::format("'{}' gives no shape", name));
        return *made->shape;
    }
    if (!number) {
        if (!primitive_named(name).empty() || name == "FILL") return ShapeValue{.name = std::string(name)};
        std::vector<std::string> names = {"CIRCLE", "SQUARE", "TRIANGLE"};
        for (const Shape& shape : grammar_.shapes)
            names.push_back(shape.name);
        file_.diagnostics.error(element.span, fmt::format("unknown shape '{}'", name))
            .with_hint(did_you_mean(name, names));
        return std::nullopt;
    }
    const Shape& shape = grammar_.shapes[*number];
    ShapeValue made{.name = shape.name};
    if (element.reuses_arguments) {
        if (!at.shape || at.shape->parameters.size() != shape.parameters.size())
            return fail(element.span, "'(=)' needs a shape with the same parameters");
        for (const Parameter& parameter : at.shape->parameters)
            if (const auto held = at.values.find(parameter.name); held != at.values.end())
                made.arguments.push_back(held->second);
        return made;
    }
    std::optional<std::vector<Value>> given = arguments(element.arguments, at);
    if (!given) return std::nullopt;
    const std::optional<Values> bound = bind(shape.parameters, *given, element.span);
    if (!bound) return std::nullopt;
    for (const Parameter& parameter : shape.parameters)
        made.arguments.push_back(bound->at(parameter.name));
    return made;
}

} // namespace graftal::cfdg
