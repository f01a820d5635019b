#include "compiler/import/cfdg/recursion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "compiler/graph/components.h"
#include "compiler/import/cfdg/evaluate/evaluator.h"

namespace graftal::cfdg {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();
/// The logarithm of a size that becomes smaller: an unfolding tells the sizes of all turns apart.
constexpr double least_growth = -2e-6;
/// Recursion that shrinks less than by this factor is slow.
const double slow_growth = std::log(0.85);
/// The share of its own area that recursion draws again where it fills a picture.
constexpr double filling_area = 0.95;
/// Components up to this size are searched for cycles that grow.
constexpr std::size_t most_shapes = 150;

} // namespace

Recursion::Recursion(const Grammar& grammar, Expressions& expressions)
    : grammar_(grammar), expressions_(expressions) {
    call_passed();
    for (std::size_t shape = 0; shape < grammar_.shapes.size(); ++shape)
        for (const Rule& rule : grammar_.shapes[shape].rules)
            walk(shape, rule.body, 0);
    find_rates();
}

/// The growth of the largest copy of a transform.
double Recursion::growth_of_transform(const Element& element, const std::string& space) {
    double growth = -unknown;
    for (const Expr& change : element.arguments)
        growth = std::max(growth, change.kind == Expr::Kind::modification
                                      ? expressions_.growth(*change.change, space)
                                      : unknown);
    return growth;
}

void Recursion::walk(std::size_t from, const Elements& elements, double growth) {
    const std::string& space = grammar_.shapes[from].space;
    for (const Element& element : elements) {
        double inner = growth + expressions_.growth(element.modification, space);
        if (element.kind == Element::Kind::transform) inner += growth_of_transform(element, space);
        if (element.kind == Element::Kind::loop) {
            // The last copy is the largest where copies grow.
            const double copies = expressions_.turns(element, space).value_or(100);
            const double step = inner - growth;
            inner = growth + (step > 0 ? step * std::max(1.0, copies) : 0);
        }
        walk(from, element.body, inner);
        walk(from, element.other, inner);
        for (const Case& one : element.cases)
            walk(from, one.body, growth);
        if (element.kind != Element::Kind::shape) continue;
        if (const std::optional<std::size_t> to = grammar_.shape(element.name, space);
            to && !element.computed)
            call(from, *to, element, inner);
        else if (element.computed || primitive_named(element.name).empty())
            call(from, grammar_.shapes.size(), element,
                 inner); // a parameter, or a function that gives a shape
    }
}

void Recursion::call(std::size_t from, std::size_t to, const Element& element, double growth) {
    Call call{from, to, growth};
    const std::vector<Parameter>& own = grammar_.shapes[from].parameters;
    for (std::size_t i = 0; i < element.arguments.size(); ++i) {
        const Expr& argument = element.arguments[i];
        const bool handed_on =
            argument.kind == Expr::Kind::name && from == to && i < own.size() && own[i].name == argument.text;
        if (!handed_on && !expressions_.number(argument, grammar_.shapes[from].space))
            call.changes_parameters = true;
    }
    for (const Adjustment& adjustment : element.modification.adjustments)
        call.changes_parameters = call.changes_parameters || adjustment.sets_target;
    calls_.push_back(call);
}

/// Shapes that expressions name may be called by another name.
void Recursion::call_passed() {
    std::set<std::size_t> passed;
    const auto in_expression = [&](const auto& self, const Expr& expression,
                                   const std::string& space) -> void {
        if (expression.kind == Expr::Kind::name || expression.kind == Expr::Kind::call)
            if (const std::optional<std::size_t> shape = grammar_.shape(expression.text, space))
                passed.insert(*shape);
        for (const Expr& operand : expression.operands)
            self(self, operand, space);
    };
    const auto in_elements = [&](const auto& self, const Elements& elements,
                                 const std::string& space) -> void {
        for (const Element& element : elements) {
            for (const Expr& argument : element.arguments)
                in_expression(in_expression, argument, space);
            self(self, element.body, space);
            self(self, element.other, space);
            for (const Case& one : element.cases)
                self(self, one.body, space);
        }
    };
    for (const Shape& shape : grammar_.shapes)
        for (const Rule& rule : shape.rules)
            in_elements(in_elements, rule.body, shape.space);
    for (const Definition& definition : grammar_.definitions)
        in_expression(in_expression, definition.value, definition.space);
    if (grammar_.start)
        for (const Expr& argument : grammar_.start->arguments)
            in_expression(in_expression, argument, "");
    for (const std::size_t shape : passed)
        calls_.push_back({grammar_.shapes.size(), shape});
}

/// Whether the areas of its calls add up to nearly the whole, or more: the largest eigenvalue by power
/// iteration.
bool Recursion::fills(const std::vector<const Call*>& calls,
                      const std::map<std::size_t, std::size_t>& place) {
    constexpr int rounds = 40;
    std::vector<double> areas(place.size(), 1);
    double grown = 0;
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> next(place.size());
        for (const Call* const call : calls)
            next[place.at(call->from)] +=
                std::exp(2 * std::clamp(call->growth, -50.0, 1.0)) * areas[place.at(call->to)];
        grown = *std::ranges::max_element(next);
        if (!(grown > 0)) return false;
        for (double& area : next)
            area /= grown;
        areas = std::move(next);
    }
    return grown > filling_area;
}

bool Recursion::is_endless(std::size_t from) const {
    std::vector<std::vector<std::size_t>> to(component_.size());
    for (const Call& call : calls_)
        to[call.from].push_back(call.to);
    std::vector<std::array<bool, 2>> seen(component_.size()); // by whether recursion leads there
    std::vector<std::pair<std::size_t, bool>> open = {{from, false}};
    bool found = false;
    while (!open.empty()) {
        const auto [shape, below] = open.back();
        open.pop_back();
        if (std::exchange(seen[shape][below ? 1 : 0], true)) continue;
        const std::size_t component = component_[shape];
        if (recurs_[component] && (!shrinks_[component] || changes_[component])) return false;
        if (branches_[component] || (slow_[component] && below)) return false;
        found = found || recurs_[component];
        for (const std::size_t next : to[shape])
            open.emplace_back(next, below || (recurs_[component] && component_[next] != component));
    }
    return found;
}

void Recursion::mark_callers(std::vector<bool>& marked) const {
    marked.resize(grammar_.shapes.size() + 1);
    std::vector<std::vector<std::size_t>> callers(marked.size());
    for (const Call& call : calls_)
        callers[call.to].push_back(call.from);
    std::vector<std::size_t> open;
    for (std::size_t shape = 0; shape < marked.size(); ++shape)
        if (marked[shape]) open.push_back(shape);
    while (!open.empty()) {
        const std::size_t shape = open.back();
        open.pop_back();
        for (const std::size_t caller : callers[shape])
            if (!marked[caller]) {
                marked[caller] = true;
                open.push_back(caller);
            }
    }
}

void Recursion::find_rates() {
    Graph edges; // shapes as objects
    edges.objects.resize(grammar_.shapes.size() + 1);
    for (const Call& call : calls_)
        edges.objects[call.from].instances.emplace_back().master = static_cast<ObjectId>(call.to);
    Components found = strong_components(edges);
    const std::size_t count = found.members.size();
    component_ = std::move(found.component_of);
    recurs_ = std::move(found.cyclic);
    shrinks_.assign(count, true);
    slow_ = branches_ = changes_ = std::vector<bool>(count, false);
    std::vector<std::vector<const Call*>> calls_within(count);
    for (const Call& call : calls_)
        if (component_[call.from] == component_[call.to])
            calls_within[component_[call.from]].push_back(&call);
    for (std::size_t component = 0; component < count; ++component) {
        const std::vector<const Call*>& inner = calls_within[component];
        if (inner.empty()) continue;
        std::map<std::size_t, std::size_t> place;
        for (const ObjectId member : found.members[component])
            place.emplace(member, place.size());
        const std::size_t n = place.size();
        changes_[component] = std::ranges::any_of(inner, &Call::changes_parameters);
        // The largest growth of any way from one to another (Floyd 1962; Warshall 1962).
        double largest = unknown;
        if (n <= most_shapes) {
            std::vector<std::vector<double>> way(n, std::vector<double>(n, -unknown));
            for (const Call* const call : inner) {
                double& growth = way[place[call->from]][place[call->to]];
                growth = std::max(growth, call->growth);
            }
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t i = 0; i < n; ++i)
                    for (std::size_t j = 0; j < n; ++j)
                        if (way[i][k] > -unknown && way[k][j] > -unknown)
                            way[i][j] = std::max(way[i][j], std::min(way[i][k] + way[k][j], 1e6));
            largest = -unknown;
            for (std::size_t i = 0; i < n; ++i)
                largest = std::max(largest, way[i][i]);
        }
        shrinks_[component] = largest < least_growth;
        branches_[component] = inner.size() > n && fills(inner, place);
        slow_[component] = largest > slow_growth;
    }
}

} // namespace graftal::cfdg
