#include "compiler/import/cfdg_recursion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace graftal::cfdg {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();
/// Recursion that does not shrink is drawn so deep.
constexpr int endless_generations = 300;
/// The share of a size that no picture shows.
constexpr double invisible = 1e-4;
/// Components up to this size are searched for cycles that grow.
constexpr std::size_t most_shapes = 150;

} // namespace

double growth_of(const Modification& modification, const Expressions& expressions) {
    double growth = 0;
    for (const Adjustment& adjustment : modification.adjustments) {
        if (adjustment.word == "skew") return unknown;
        if (adjustment.word == "trans") {
            const Definition* const inner = expressions.modification(adjustment);
            if (!inner || inner->modification.adjustments.size() > 20) return unknown;
            for (const Adjustment& part : inner->modification.adjustments)
                if (part.word == "trans") return unknown;
            growth += growth_of(inner->modification, expressions);
            continue;
        }
        if (adjustment.word != "s") continue;
        double largest = 0;
        for (std::size_t i = 0; i < adjustment.values.size() && i < 2; ++i) {
            const std::optional<Interval> range = expressions.range(adjustment.values[i]);
            if (!range) return unknown;
            largest = std::max({largest, std::abs(range->least), std::abs(range->most)});
        }
        growth += std::log(std::max(largest, 1e-100));
    }
    return growth;
}

Recursion::Recursion(const Grammar& grammar, const Expressions& expressions)
    : grammar_(grammar), expressions_(expressions) {
    for (std::size_t shape = 0; shape < grammar_.shapes.size(); ++shape)
        for (const Rule& rule : grammar_.shapes[shape].rules)
            walk(shape, rule.body, 0);
    find_components();
    find_limits();
}

std::optional<std::size_t> Recursion::index(const std::string& name) const {
    const auto found = std::ranges::find(grammar_.shapes, name, &Shape::name);
    if (found == grammar_.shapes.end()) return std::nullopt;
    return static_cast<std::size_t>(found - grammar_.shapes.begin());
}

void Recursion::walk(std::size_t from, const Elements& elements, double growth) {
    for (const Element& element : elements) {
        double inner = growth + growth_of(element.modification, expressions_);
        for (const Modification& modification : element.modifications)
            inner += growth_of(modification, expressions_);
        if (element.kind == Element::Kind::loop) {
            // The last copy is the largest where copies grow.
            const double copies =
                element.arguments.empty() ? 1 : expressions_.number(element.arguments[0]).value_or(100);
            const double step = inner - growth;
            inner = growth + (step > 0 ? step * std::max(1.0, copies) : 0);
        }
        walk(from, element.body, inner);
        walk(from, element.other, inner);
        for (const Case& one : element.cases)
            walk(from, one.body, growth);
        const std::optional<std::size_t> to =
            element.kind == Element::Kind::shape ? index(element.name) : std::nullopt;
        if (!to) continue;
        Call call{from, *to, inner};
        const std::vector<Parameter>& own = grammar_.shapes[from].parameters;
        for (std::size_t i = 0; i < element.arguments.size(); ++i) {
            const Expr& argument = element.arguments[i];
            const bool handed_on = argument.kind == Expr::Kind::name && from == *to && i < own.size() &&
                                   own[i].name == argument.text;
            if (!handed_on && !expressions_.number(argument)) call.changes_parameters = true;
        }
        calls_.push_back(call);
    }
}

/// Kosaraju's two walks, without recursion.
void Recursion::find_components() {
    const std::size_t count = grammar_.shapes.size();
    std::vector<std::vector<std::size_t>> to(count), back(count);
    for (const Call& call : calls_) {
        to[call.from].push_back(call.to);
        back[call.to].push_back(call.from);
    }
    std::vector<std::size_t> order, at(count);
    std::vector<bool> seen(count);
    for (std::size_t root = 0; root < count; ++root) {
        if (seen[root]) continue;
        std::vector<std::size_t> path = {root};
        seen[root] = true;
        while (!path.empty()) {
            const std::size_t id = path.back();
            if (at[id] == to[id].size()) {
                order.push_back(id);
                path.pop_back();
                continue;
            }
            const std::size_t next = to[id][at[id]++];
            if (seen[next]) continue;
            seen[next] = true;
            path.push_back(next);
        }
    }
    component_.assign(count, count);
    std::size_t components = 0;
    for (auto root = order.rbegin(); root != order.rend(); ++root) {
        if (component_[*root] != count) continue;
        std::vector<std::size_t> open = {*root};
        component_[*root] = components;
        while (!open.empty()) {
            const std::size_t id = open.back();
            open.pop_back();
            for (const std::size_t next : back[id])
                if (component_[next] == count) component_[next] = components, open.push_back(next);
        }
        ++components;
    }
    limits_.resize(components);
    shrinks_.assign(components, true);
}

void Recursion::find_limits() {
    for (std::size_t component = 0; component < limits_.size(); ++component) {
        std::vector<std::size_t> members;
        for (std::size_t shape = 0; shape < component_.size(); ++shape)
            if (component_[shape] == component) members.push_back(shape);
        std::map<std::size_t, std::size_t> place;
        for (const std::size_t member : members)
            place.emplace(member, place.size());
        const std::size_t n = members.size();
        std::vector<const Call*> inner;
        bool changes = false;
        for (const Call& call : calls_)
            if (place.contains(call.from) && place.contains(call.to)) {
                inner.push_back(&call);
                changes = changes || call.changes_parameters;
            }
        if (inner.empty()) continue;
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
        shrinks_[component] = largest < -1e-9;
        if (shrinks_[component] && !changes) continue;
        limits_[component] = endless_generations;
        if (!shrinks_[component]) continue;
        const double steps = std::log(invisible) / largest * static_cast<double>(n);
        limits_[component] = static_cast<int>(std::clamp(std::ceil(steps), 20.0, 2000.0));
    }
}

} // namespace graftal::cfdg
