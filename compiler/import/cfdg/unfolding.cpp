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

/// Most variants of a random shape: as many as .inst makes of a random object.
constexpr std::size_t most_variants = 64;
constexpr std::uint64_t most_trials = 20; ///< where chance draws nothing
/// Generations of recursion without end that have their turn by size, as all shapes; others are drawn where
/// these leave room.
constexpr int early_generations = 2000;
constexpr double farthest = 1e50, farthest_late = 1e9; ///< largest places and sizes, and those of others
/// Most colour steps of all shapes together: each turn of a loop may add one to those before it.
constexpr std::size_t most_unfolded_colour_steps = 4'000'000;
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

bool is_within(double bound, const Affine& map) {
    return is_finite(map) && largest_entry(map.linear) <= bound && largest_entry(map.translation) <= bound;
}

/// The turn of a shape among those that wait, before its size: 0, or less for one of a late generation.
int turn_of(int generation) {
    return generation > early_generations ? -generation : 0;
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
        if (full_) warn_of_rest(start.span);
        write_nodes(*first);
    }
    if (inks) write_start(master + moves_text(change->map), *inks);
    write_end();
    return std::move(out_);
}

/// Says which shapes the picture lacks.
void Unfolding::warn_of_rest(Span start) {
    const Node& last = *std::ranges::max_element(nodes_, {}, &Node::generation);
    if (last.generation > early_generations)
        file_.diagnostics.warning(grammar_.shapes[last.shape].span,
                                  fmt::format("'{}' calls itself without becoming smaller, as far as can be "
                                              "told; the picture has its first {} generations",
                                              last.value.name, last.generation));
    else
        file_.diagnostics.warning(
            start, fmt::format("the grammar makes more than {} shapes; the smallest are left out", lines_));
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
        const auto [turn, size, id] = open_.top();
        open_.pop();
        if (nodes_[id].done) continue;
        // A canvas of a size is as many pixels wide, if that is more than usual.
        if (!endless_ &&
            size < std::min(too_small * extent_, grammar_.size ? smallest_pixels : too_small * extent_))
            continue;
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
    const bool counts = !recursion_.shrinks(shape);
    const int generation =
        counts && from && recursion_.together(nodes_[*from].shape, shape) ? nodes_[*from].generation + 1 : 0;
    std::string key =
        key_of({.kind = Value::Kind::shape, .shape = std::make_shared<const ShapeValue>(value)});
    for (const double part : target)
        key += fmt::format("{:a},", part);
    if (counts) key += fmt::format("n{}", generation);
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
            open_.emplace(turn_of(node.generation), size, id);
        }
        return id;
    }
    if (nodes_.size() >= most_nodes) {
        full_ = true;
        if (known.empty()) return std::nullopt;
        return known.front();
    }
    Node node{.shape = shape,
              .value = value,
              .target = target,
              .generation = generation,
              .world = world,
              .size = size};
    node.seed = hash_of(key) + known.size() + 1000 * salt_ + evaluator_.seed;
    known.push_back(nodes_.size());
    // The first shape, and paths, are drawn whatever their size.
    const bool certain = !from || grammar_.shapes[shape].is_path;
    open_.emplace(turn_of(generation), certain ? 1e300 : node.size, nodes_.size());
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
    const bool inside = is_within(farthest, map);
    if (!inside) fail(span, "this grows beyond all bounds");
    return inside;
}

void Unfolding::place(const Element& element, const Surroundings& at, const Under& under) {
    const std::optional<ShapeValue> shape = evaluator_.shape(element, at);
    const std::optional<Change> own = shape ? evaluator_.change(element.modification, at) : std::nullopt;
    if (!own) return;
    colour_steps_ += under.change.colours.size();
    if (colour_steps_ > most_unfolded_colour_steps)
        return fail(element.span,
                    fmt::format("the loops of this grammar change colours more than {} times",
                                most_unfolded_colour_steps),
                    fewer_shapes);
    Change change = under.change;
    change.add(*own);
    const auto found = grammar_.numbers.find(shape->name);
    const bool primitive_shape = found == grammar_.numbers.end();
    const bool fills = primitive_shape && primitive_named(shape->name).empty();
    if (is_unseen(change.map)) return;
    const Affine world = nodes_[under.node].world * change.map;
    if (nodes_[under.node].generation > early_generations && !is_within(farthest_late, world)) {
        full_ = true;
        return;
    }
    if (!check_bounds(change.map, element.span) || !check_bounds(world, element.span)) return;
    Target target = nodes_[under.node].target;
    if (!ink_text(change.colours, target))
        return fail(element.span, "this changes a colour away from another");
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
