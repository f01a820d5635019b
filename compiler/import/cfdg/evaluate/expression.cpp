#include "compiler/import/cfdg/evaluate/expression.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "compiler/import/cfdg/evaluate/affine.h"

namespace graftal::cfdg {

namespace {

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

Expressions::Expressions(const ForeignFile& file, const Grammar& grammar, const Chance& chance)
    : file_{file.file, file.sources, silent_, file.read_beside, file.meter}, evaluator_(file_, grammar),
      chance_(chance) {
    for (const Shape& shape : grammar.shapes) {
        for (const Parameter& parameter : shape.parameters)
            own_.insert(parameter.name);
        for (const Rule& rule : shape.rules)
            add_own_names(rule.body, own_);
    }
}

std::optional<double> Expressions::number(const Expr& expression, const std::string& space) {
    return is_open(expression, space) ? std::nullopt : evaluator_.number(expression, {.space = space});
}

std::optional<double> Expressions::turns(const Element& loop, const std::string& space) {
    for (const Expr& bound : loop.arguments)
        if (is_open(bound, space)) return std::nullopt;
    const std::optional<LoopBounds> bounds = evaluator_.bounds(loop, {.space = space});
    return bounds ? std::optional(bounds->turns()) : std::nullopt;
}

double Expressions::growth(const Modification& modification, const std::string& space) {
    if (!is_open(modification, space))
        if (const std::optional<Change> change = evaluator_.change(modification, {.space = space}))
            return std::log(std::max(largest_factor(change->map), 1e-100));
    double growth = 0;
    for (const Adjustment& adjustment : modification.adjustments) {
        if (adjustment.word == "skew" || adjustment.word == "trans")
            return std::numeric_limits<double>::infinity();
        if (adjustment.word != "s") continue;
        double largest = 0;
        for (std::size_t i = 0; i < adjustment.values.size() && i < 2; ++i) {
            const std::optional<Interval> range_of_one = range(adjustment.values[i], space);
            if (!range_of_one) return std::numeric_limits<double>::infinity();
            largest = std::max({largest, std::abs(range_of_one->least), std::abs(range_of_one->most)});
        }
        growth += std::log(std::max(largest, 1e-100));
    }
    return growth;
}

std::optional<Interval> Expressions::range(const Expr& expression, const std::string& space) {
    if (const std::optional<double> value = number(expression, space)) return Interval{*value, *value};
    const auto hull = [](std::initializer_list<double> values) {
        return Interval{std::min(values), std::max(values)};
    };
    if (expression.kind == Expr::Kind::unary && expression.text == "-") {
        const std::optional<Interval> a = range(expression.operands[0], space);
        return a ? std::optional(hull({-a->least, -a->most})) : std::nullopt;
    }
    const bool drawn = expression.kind == Expr::Kind::call && expression.text.starts_with("rand") &&
                       expression.text != "rand::normal";
    if (drawn && expression.operands.empty()) return Interval{0, 1};
    if (drawn && expression.operands.size() == 1) {
        const std::optional<Interval> a = range(expression.operands[0], space);
        return a ? std::optional(hull({0, a->least, a->most})) : std::nullopt;
    }
    if (expression.operands.size() != 2) return std::nullopt;
    const std::optional<Interval> a = range(expression.operands[0], space),
                                  b = range(expression.operands[1], space);
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
