// The loops of an unfolding.

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/unfolding.h"

namespace graftal::cfdg {

namespace {

/// Turns of a loop that are not written one by one.
constexpr double least_even_turns = 32, most_even_turns = 1e9;

} // namespace

bool Unfolding::is_unseen(const Affine& map) {
    constexpr double least_width = 1e-11;
    const glm::dvec2 across(map.linear[0]), up(map.linear[1]);
    const double area = std::abs(across.x * up.y - across.y * up.x);
    return !(area > least_width * std::hypot(glm::length(across), glm::length(up)));
}

void Unfolding::expand_loop(const Element& element, Surroundings at, Under under) {
    const std::optional<LoopBounds> bounds = evaluator_.bounds(element, at);
    if (!bounds) return;
    double index = bounds->begin;
    const double turns = bounds->turns();
    if (turns >= least_even_turns && turns <= most_even_turns && is_even(element, at.space)) {
        const std::optional<Change> change = evaluator_.change(element.modification, at);
        if (!change) return;
        if (std::abs(size_of(change->map) - 1) < 1e-9 && change->map.linear[2][2] == 1 &&
            is_plain(change->colours)) {
            under.change = expand_even(element, at, under, *change, turns);
            index += turns * bounds->step;
        }
    }
    for (; bounds->goes_on(index); index += bounds->step) {
        if (file_.diagnostics.error_count() > 0) return;
        file_.work(1, ImportPrice::unfolded);
        if (++turns_ > most_loop_turns || lines_ > 2 * most_unfolded_lines)
            return fail(element.span,
                        fmt::format("the loops of this grammar turn more than {} times, or place more than "
                                    "{} shapes",
                                    most_loop_turns, 2 * most_unfolded_lines),
                        fewer_shapes);
        if (!element.name.empty()) at.values.insert_or_assign(element.name, Value::of(index));
        expand(element.body, at, under);
        const std::optional<Change> change = evaluator_.change(element.modification, at);
        if (!change) return;
        under.change.add(*change);
        if (under.change.colours.size() > 64) { // as few steps as do the same
            Change short_one{under.change.map, shortened(under.change.colours)};
            under.change = std::move(short_one);
        }
    }
    if (!element.name.empty()) at.values.insert_or_assign(element.name, Value::of(index));
    expand(element.other, at, under);
}

/// Whether the turns of a loop draw the same.
bool Unfolding::is_even(const Element& loop, const std::string& space) const {
    const auto fixed = [&](const auto& self, const Elements& elements) -> bool {
        return std::ranges::all_of(elements, [&](const Element& element) {
            const std::optional<std::size_t> shape = grammar_.shape(element.name, space);
            if (element.kind == Element::Kind::shape &&
                (element.computed || (shape ? random_[*shape] : primitive_named(element.name).empty())))
                return false;
            return self(self, element.body) && self(self, element.other) &&
                   std::ranges::all_of(element.cases, [&](const Case& one) { return self(self, one.body); });
        });
    };
    const auto is_index = [&](const Expr& expression) {
        return expression.kind == Expr::Kind::name && expression.text == loop.name;
    };
    return even_ && nodes_.size() < most_nodes && !chance_.decides(loop.modification, space) &&
           !chance_.decides(loop.body, space) && fixed(fixed, loop.body) &&
           (loop.name.empty() || (!any_part(loop.modification, is_index) && !any_part(loop.body, is_index)));
}

/// Draws parts of 1, 2, 4 and more turns, each of which draws the one before it twice. Gives the change after
/// all turns.
Change Unfolding::expand_even(const Element& loop, const Surroundings& at, const Under& under, Change step,
                              double turns) {
    std::size_t part = part_of(under.node, under.change);
    expand(loop.body, at, {part, {}});
    const auto place_part = [&](std::size_t in, const Change& change) {
        if (is_unseen(change.map) || !check_bounds(change.map, loop.span)) return;
        add_line(in, {.node = part, .map = change.map, .colours = change.colours, .span = loop.span});
        see(nodes_[in].world * change.map);
    };
    const auto sum = [](const Change& first, const Change& second) {
        Change both = first;
        both.add(second);
        both.colours = shortened(both.colours);
        return both;
    };
    Change change = under.change;
    for (; turns >= 1; turns = std::floor(turns / 2)) {
        if (std::fmod(turns, 2) == 1) {
            place_part(under.node, change);
            change = sum(change, step);
        }
        if (turns < 2) break;
        const std::size_t twice = part_of(part, {});
        place_part(twice, {});
        place_part(twice, step);
        step = sum(step, step);
        part = twice;
    }
    return change;
}

/// A new object of lines of the rule of a node.
std::size_t Unfolding::part_of(std::size_t id, const Change& change) {
    const Node& of = nodes_[id];
    Node part{.shape = of.shape,
              .value = of.value,
              .target = of.target,
              .generation = of.generation,
              .world = of.world * change.map,
              .size = of.size,
              .done = true,
              .part = true};
    ink_text(change.colours, part.target);
    nodes_.push_back(std::move(part));
    return nodes_.size() - 1;
}

} // namespace graftal::cfdg
