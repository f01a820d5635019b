#include "compiler/import/cfdg/evaluate/expression.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <set>
#include <vector>

#include "compiler/import/cfdg/evaluate/functions.h"

namespace graftal::cfdg {

namespace {

constexpr int deepest_calls = 32;
constexpr std::size_t most_work = 5'000'000;

/// Names that rules give other meanings than the file.
void add_own_names(const Elements& elements, std::set<std::string>& names) {
    for (const Element& element : elements) {
        if (element.kind == Element::Kind::define || element.kind == Element::Kind::loop)
            names.insert(element.name);
        add_own_names(element.body, names);
        add_own_names(element.other, names);
        for (const Case& one : element.cases)
            add_own_names(one.body, names);
    }
}

} // namespace

Expressions::Expressions(const Grammar& grammar) {
    std::set<std::string> own;
    for (const Shape& shape : grammar.shapes) {
        for (const Parameter& parameter : shape.parameters)
            own.insert(parameter.name);
        for (const Rule& rule : shape.rules)
            add_own_names(rule.body, own);
    }
    for (const Definition& definition : grammar.definitions)
        if (definition.is_function || !own.contains(definition.name))
            definitions_.emplace(definition.name, &definition);
    for (const Definition& definition : grammar.definitions) {
        if (!definitions_.contains(definition.name) || definition.is_function ||
            definition.name.starts_with("CF::"))
            continue;
        const std::optional<double> value = evaluate(definition.value, {}, 0);
        if (value) values_.emplace(definition.name, *value);
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
