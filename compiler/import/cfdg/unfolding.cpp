#include "compiler/import/cfdg/unfolding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/paths/path.h"
#include "compiler/support/counter_random.h"

namespace graftal::cfdg {

namespace {

constexpr const char* fewer_shapes = "ask for less: fewer turns of its loops, such as a coarser grid";
/// Most variants of a random shape: as many as .inst makes of a random object.
constexpr std::size_t most_variants = 64;
constexpr std::uint64_t most_trials = 20; ///< where chance draws nothing
/// Turns of a loop that are not written one by one.
constexpr double least_even_turns = 32, most_even_turns = 1e9;
constexpr int most_generations = 2000;
constexpr std::size_t most_nodes = 60'000;
constexpr std::size_t most_unfolded_lines = 600'000;
constexpr std::size_t most_loop_turns = 2'000'000;
/// Most colour steps of all shapes together: each turn of a loop may add one to those before it.
constexpr std::size_t most_colour_steps = 4'000'000;
/// The share of the picture below which Context Free draws no shape: 0.3 pixels of 500.
constexpr double too_small = 6e-4;
constexpr double smallest_pixels = 0.3;

std::uint64_t hash_of(std::string_view text) {
    std::uint64_t hash = 0x811c9dc5;
    for (const char c : text)
        hash = CounterRandom::scrambled(hash ^ static_cast<unsigned char>(c));
    return hash;
}

/// A text that maps share which stretch alike, whatever their size: entries of the induced metric.
std::string stretch_text(const Affine& map) {
    const glm::dvec2 across(map.linear[0]), up(map.linear[1]);
    const double area = std::abs(across.x * up.y - across.y * up.x);
    const auto entry = [&](double product) { return std::llround(1e6 * std::min(product / area, 1e9)); };
    if (!(area > 0)) return "flat";
    return fmt::format("m{},{},{}", entry(glm::dot(across, across)), entry(glm::dot(across, up)),
                       entry(glm::dot(up, up)));
}

/// Whether nothing is seen of a part: its thickness of 1 is so much larger than it that the language would
/// call its map flat.
bool is_unseen(const Affine& map) {
    constexpr double least_width = 1e-11;
    const glm::dvec2 across(map.linear[0]), up(map.linear[1]);
    const double area = std::abs(across.x * up.y - across.y * up.x);
    return !(area > least_width * std::hypot(glm::length(across), glm::length(up)));
}

} // namespace

Unfolding::Unfolding(const ForeignFile& file, const Grammar& grammar)
    : SceneWriter(file, grammar), chance_(grammar), expressions_(file, grammar, chance_),
      recursion_(grammar, expressions_), random_(grammar.shapes.size()), named_(grammar.shapes.size()) {
    for (std::size_t i = 0; i < grammar.shapes.size(); ++i) {
        const Shape& shape = grammar.shapes[i];
        random_[i] = shape.rules.size() > 1 || std::ranges::any_of(shape.rules, [&](const Rule& rule) {
                         return chance_.decides(rule.body, shape.space);
                     });
    }
    recursion_.mark_callers(random_);
}

Translation Unfolding::write() {
    comment("from a grammar of Context Free; an object is a shape with its arguments");
    if (!grammar_.start) {
        fail_without_start();
        return std::move(out_);
    }
    check_definitions();
    if (const std::optional<Modification>& view = grammar_.size ? grammar_.size : grammar_.tile)
        if (const std::optional<Change> size = evaluator_.change(*view, {}))
            extent_ = std::max(std::abs(size->map.linear[0].x), std::abs(size->map.linear[1].y));
    const Element& start = *grammar_.start;
    const std::optional<ShapeValue> shape = evaluator_.shape(start, {});
    const std::optional<Change> change = evaluator_.change(start.modification, {});
    if (!shape || !change) return std::move(out_);
    Target target = first_target;
    const std::optional<std::string> inks = ink_text(change->colours, target);
    if (!inks) fail(start.span, "this changes a colour away from another");
    std::string master = primitive_named(shape->name).empty() ? "" : primitive(primitive_named(shape->name));
    std::optional<std::size_t> first;
    if (grammar_.numbers.contains(shape->name)) {
        first = unfold_from(*shape, target, change->map);
        if (first) master = name_of(*first);
    } else if (master.empty()) {
        fail(start.span, fmt::format("'{}' is no shape to start from", shape->name));
    }
    if (full_ && !drawn_)
        fail(start.span,
             fmt::format("the grammar makes more than {} different shapes before it draws one", most_nodes),
             fewer_shapes);
    if (fills_) { // a shape that covers all must not frame the picture
        const Vec3 half = 0.55 * (most_ - least_);
        middle_and_half_ = {0.5 * (least_ + most_), glm::max(half, Vec3(0.05 * std::max(extent_, 1e-3)))};
    }
    if (file_.diagnostics.has_errors()) return std::move(out_);
    write_scene();
    if (first) {
        if (full_)
            file_.diagnostics.warning(
                start.span,
                fmt::format("the grammar makes more than {} shapes; the smallest are left out", lines_));
        write_nodes(*first);
    }
    if (inks) write_start(master + moves_text(change->map), *inks);
    write_end();
    return std::move(out_);
}

/// Where chance draws nothing at all, it is asked again.
std::optional<std::size_t> Unfolding::unfold_from(const ShapeValue& shape, const Target& target,
                                                  const Affine& world) {
    std::optional<std::size_t> first;
    const bool may_be_endless = !deep_ && recursion_.is_endless(grammar_.numbers.at(shape.name));
    endless_ = may_be_endless && !translucent_;
    for (salt_ = 0; salt_ < most_trials && !drawn_ && file_.diagnostics.error_count() == 0; ++salt_) {
        const bool known = stretches_;
        first = unfold_once(shape, target, world);
        // Paths may depend on how they are stretched: so do the shapes that lead to them. Other shapes cover
        // the canvas whatever their size, or recursion makes new ones for ever.
        const bool compact = endless_ || std::ranges::any_of(nodes_, &Node::part);
        if ((stretches_ && !known) || (fills_ && compact) || (full_ && endless_)) {
            endless_ = false;
            even_ = !stretches_ && !fills_;
            turns_ = colour_steps_ = 0;
            first = unfold_once(shape, target, world);
        }
        if (!random_[grammar_.numbers.at(shape.name)]) break;
    }
    if (!first || file_.diagnostics.error_count() > 0) return first;
    find_order(*first);
    if (!may_be_endless || endless_ || fills_ || stretches_ || !order_->is_crowded()) return first;
    // Veils lie in their order. Where there are more than heights tell apart, recursion has no end either.
    for (const bool endless : {true, false}) {
        endless_ = endless;
        turns_ = colour_steps_ = 0;
        first = unfold_once(shape, target, world);
        if (!full_) break; // else recursion made new shapes for ever
    }
    if (first) find_order(*first);
    return first;
}

std::optional<std::size_t> Unfolding::unfold_once(const ShapeValue& shape, const Target& target,
                                                  const Affine& world) {
    nodes_.clear();
    known_.clear();
    uses_.clear();
    open_ = {};
    lines_ = 0;
    full_ = false;
    const std::optional<std::size_t> first = node_for(shape, target, std::nullopt, world);
    while (!open_.empty() && file_.diagnostics.error_count() == 0) {
        const auto [size, id] = open_.top();
        open_.pop();
        if (nodes_[id].done) continue;
        // All others are smaller. A canvas of a size is as many pixels wide, if that is more than usual.
        if (!endless_ &&
            size < std::min(too_small * extent_, grammar_.size ? smallest_pixels : too_small * extent_))
            break;
        if (lines_ > most_unfolded_lines || turns_ > most_loop_turns) {
            full_ = true;
            break;
        }
        unfold(id);
    }
    return first;
}

// Nodes

std::optional<std::size_t> Unfolding::node_for(const ShapeValue& value, const Target& target,
                                               std::optional<std::size_t> from, const Affine& world) {
    const std::size_t shape = grammar_.numbers.at(value.name);
    // Sizes end all other recursion.
    std::optional<int> left = recursion_.shrinks(shape) ? std::nullopt : std::optional(most_generations);
    if (left && from && recursion_.together(nodes_[*from].shape, shape))
        left = nodes_[*from].left.value_or(*left) - 1;
    if (left && *left <= 0) {
        if (!std::exchange(noted_, true))
            file_.diagnostics.note(
                grammar_.shapes[shape].span,
                fmt::format("'{}' calls itself without becoming smaller, as far as can be told; "
                            "it is drawn to {} generations",
                            value.name, most_generations));
        return std::nullopt;
    }
    std::string key =
        key_of({.kind = Value::Kind::shape, .shape = std::make_shared<const ShapeValue>(value)});
    for (const double part : target)
        key += fmt::format("{:a},", part);
    if (left) key += fmt::format("n{}", *left);
    // Most recursion ends where its shapes are too small, so that those of each size are others.
    const double size = size_of(world);
    if (recursion_.recurs(shape) && !endless_)
        key += fmt::format("s{}", std::llround(1e6 * std::log(std::max(size, 1e-100))));
    if (const double depth = world.linear[2][2]; depth != 1 && !endless_) key += fmt::format("z{:a}", depth);
    if (stretches_) key += stretch_text(world);
    std::vector<std::size_t>& known = known_[key];
    const std::size_t variants = random_[shape] ? most_variants : 1;
    if (known.size() >= variants) {
        const std::size_t id = known[random_[shape] ? uses_[key]++ % variants : 0];
        if (Node& node = nodes_[id]; size > node.size && !node.done) {
            node.size = size;
            node.world = world;
            open_.emplace(size, id);
        }
        return id;
    }
    if (nodes_.size() >= most_nodes) {
        full_ = true;
        if (known.empty()) return std::nullopt;
        return known.front();
    }
    Node node{.shape = shape, .value = value, .target = target, .left = left, .world = world, .size = size};
    node.seed = hash_of(key) + known.size() + 1000 * salt_ + evaluator_.seed;
    known.push_back(nodes_.size());
    // The first shape, and paths, are drawn whatever their size.
    const bool certain = !from || grammar_.shapes[shape].is_path;
    open_.emplace(certain ? 1e300 : node.size, nodes_.size());
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
}

void Unfolding::unfold(std::size_t id) {
    const Shape& shape = grammar_.shapes[nodes_[id].shape];
    nodes_[id].done = true;
    evaluator_.draws = Draws(nodes_[id].seed);
    std::optional<Values> values = evaluator_.bind(shape.parameters, nodes_[id].value.arguments, shape.span);
    if (!values) return;
    if (shape.rules.empty()) return fail(shape.span, fmt::format("'{}' has no rule", shape.name));
    const Surroundings at{std::move(*values), shape.space, &shape};
    if (shape.is_path) return unfold_path(id, at);
    expand(evaluator_.rule(shape).body, at, {id, {}});
}

void Unfolding::unfold_path(std::size_t id, const Surroundings& at) {
    const std::optional<std::vector<PathPart>> parts =
        follow(grammar_.shapes[nodes_[id].shape], at, nodes_[id].world, file_, grammar_, evaluator_);
    if (!parts) return;
    stretches_ = stretches_ || std::ranges::any_of(*parts, &PathPart::of_world);
    for (const PathPart& part : *parts) {
        Target target = nodes_[id].target;
        const std::optional<std::string> inks = ink_text(part.change.colours, target);
        if (!inks) return fail(part.span, "this changes a colour away from another");
        for (const Polygon& polygon : part.polygons) {
            add_line(id, {.master = polygon_text(polygon) + "  material: flat",
                          .map = part.change.map,
                          .colours = part.change.colours,
                          .span = part.span,
                          .beside = &polygon != &part.polygons.front()});
            for (const Point point : polygon)
                see(nodes_[id].world * part.change.map * Affine::translate({point.x, point.y, 0}));
        }
    }
}

void Unfolding::see(const Affine& world) {
    if (grammar_.size || grammar_.tile) return;
    least_ = glm::min(least_, world.translation);
    most_ = glm::max(most_, world.translation);
    extent_ = std::max(most_.x - least_.x, most_.y - least_.y);
}

void Unfolding::add_line(std::size_t id, Line line) {
    file_.work(1, ImportPrice::unfolded);
    ++lines_;
    drawn_ = drawn_ || !line.master.empty();
    nodes_[id].lines.push_back(std::move(line));
}

// Elements

void Unfolding::expand(const Elements& elements, Surroundings at, const Under& under) {
    for (const Element& element : elements) {
        if (file_.diagnostics.error_count() > 0 || turns_ > most_loop_turns) return;
        switch (element.kind) {
        case Element::Kind::define: {
            std::optional<Value> value = evaluator_.value(element.arguments[0], at);
            if (!value) return;
            at.values.insert_or_assign(element.name, std::move(*value));
            break;
        }
        case Element::Kind::shape:
            place(element, at, under);
            break;
        case Element::Kind::loop:
            expand_loop(element, at, under);
            break;
        case Element::Kind::condition:
            if (const std::optional<double> test = evaluator_.number(element.arguments[0], at))
                expand(*test != 0 ? element.body : element.other, at, under);
            break;
        case Element::Kind::choice:
            if (const Elements* const chosen = evaluator_.choice(element, at)) expand(*chosen, at, under);
            break;
        case Element::Kind::transform:
            expand_transform(element, at, under);
            break;
        case Element::Kind::path_operation:
            fail(element.span, fmt::format("'{}' belongs to a path", element.name));
            break;
        }
    }
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
              .left = of.left,
              .world = of.world * change.map,
              .size = of.size,
              .done = true,
              .part = true};
    ink_text(change.colours, part.target);
    nodes_.push_back(std::move(part));
    return nodes_.size() - 1;
}

void Unfolding::expand_transform(const Element& element, const Surroundings& at, const Under& under) {
    std::vector<Change> changes;
    std::vector<Affine> maps;
    SymmetryReader reader({}, maps, [&](const std::string& fault) { fail(element.span, fault); });
    for (const Expr& expression : element.arguments) {
        const std::optional<Value> value = evaluator_.value(expression, at);
        if (!value) return;
        if (value->kind == Value::Kind::flags) {
            reader.begin(value->flags);
        } else if (value->kind == Value::Kind::change) {
            reader.end();
            changes.push_back(value->change);
        } else if (value->kind != Value::Kind::numbers || !reader.add(value->numbers)) {
            return fail(expression.span, "a transform takes adjustments and symmetries");
        }
    }
    reader.end();
    for (const Affine& map : maps)
        changes.push_back({map, {}});
    const Draws before = evaluator_.draws;
    for (const Change& change : changes) {
        Under inner = under;
        inner.change.add(change);
        if (element.clones) evaluator_.draws = before;
        expand(element.body, at, inner);
    }
}

bool Unfolding::check_bounds(const Affine& map, Span span) {
    const bool inside =
        is_finite(map) && largest_entry(map.linear) <= 1e50 && largest_entry(map.translation) <= 1e50;
    if (!inside) fail(span, "this grows beyond all bounds");
    return inside;
}
void Unfolding::place(const Element& element, const Surroundings& at, const Under& under) {
    const std::optional<ShapeValue> shape = evaluator_.shape(element, at);
    const std::optional<Change> own = shape ? evaluator_.change(element.modification, at) : std::nullopt;
    if (!own) return;
    colour_steps_ += under.change.colours.size();
    if (colour_steps_ > most_colour_steps)
        return fail(
            element.span,
            fmt::format("the loops of this grammar change colours more than {} times", most_colour_steps),
            fewer_shapes);
    Change change = under.change;
    change.add(*own);
    const auto found = grammar_.numbers.find(shape->name);
    const bool primitive_shape = found == grammar_.numbers.end();
    const bool fills = primitive_shape && primitive_named(shape->name).empty();
    if (is_unseen(change.map)) return;
    if (!check_bounds(change.map, element.span) ||
        !check_bounds(nodes_[under.node].world * change.map, element.span))
        return;
    Target target = nodes_[under.node].target;
    if (!ink_text(change.colours, target))
        return fail(element.span, "this changes a colour away from another");
    const Affine world = nodes_[under.node].world * change.map;
    Line line{.map = change.map, .colours = shortened(change.colours), .span = element.span};
    if (fills) { // all of the canvas, wherever the shape lies
        fills_ = true;
        line.master = primitive("SQUARE");
        line.fills = true;
        return add_line(under.node, std::move(line));
    }
    if (primitive_shape) {
        line.master = primitive(primitive_named(shape->name));
        add_line(under.node, std::move(line));
        for (const double x : {-0.5, 0.5})
            for (const double y : {-0.5, 0.5})
                see(world * Affine::translate({x, y, 0}));
        return;
    }
    const std::optional<std::size_t> node = node_for(*shape, target, under.node, world);
    if (!node) return;
    line.node = *node;
    add_line(under.node, std::move(line));
}

} // namespace graftal::cfdg
