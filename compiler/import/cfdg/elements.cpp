// The lines of elements: references, loops, conditions and choices.

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/writer.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/own_words.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

constexpr std::size_t most_turns = 1000; ///< of a loop that is written turn by turn

} // namespace

void Writer::write_elements(const Elements& elements, std::size_t first, Place& place) {
    for (std::size_t i = first; i < elements.size() && !file_.diagnostics.full(); ++i) {
        const Element& element = elements[i];
        for (const std::string& words : element.comments)
            comment(words);
        if (element.kind != Element::Kind::define) {
            write_element(element, place);
            place.order += width_of(element, place.shape);
            continue;
        }
        if (element.arguments[0].kind == Expr::Kind::modification) {
            fail(element.span, fmt::format("'{}': an adjustment as a value is not translated", element.name));
            continue;
        }
        const std::optional<std::string> value = text(element.arguments[0], place.scope);
        if (!value) continue;
        if (!is_random(*value)) {
            place.scope[element.name] = fmt::format("({})", *value);
            continue;
        }
        // The rest of the rule knows one number by its name.
        Place rest = place;
        std::string name = plain_name(element.name);
        while (is_own_word(name) || std::ranges::find(rest.parameters, name) != rest.parameters.end())
            name += "_";
        const std::vector<std::string> own = place.parameters;
        rest.parameters.push_back(name);
        rest.scope[element.name] = name;
        const std::string object = part(elements, i + 1, rest, element.span);
        std::vector<std::string> arguments = own;
        arguments.push_back(*value);
        line(fmt::format("instance: {}({})", object, fmt::join(arguments, ", ")), element.span);
        return;
    }
}

void Writer::write_element(const Element& element, Place& place) {
    switch (element.kind) {
    case Element::Kind::shape: {
        if (element.computed) return fail(element.span, "a shape that is chosen has no words in .inst");
        if (element.name == "FILL" && !recursion_.index("FILL"))
            return fail(element.span, "'FILL' has no words in .inst");
        const std::string master = reference(element, &place, place.scope);
        const bool rules = draws_rules(element);
        const std::optional<Lines> lines = lines_of(element.modification, place.scope,
                                                    {.order = place.order, .lifts = rules, .calls = rules});
        if (lines) line(fmt::format("instance: {}{}{}", master, lines->moves, lines->inks), element.span);
        break;
    }
    case Element::Kind::loop:
        write_loop(element, place);
        break;
    case Element::Kind::condition:
        write_condition(element, place);
        break;
    case Element::Kind::choice:
        write_choice(element, place);
        break;
    case Element::Kind::transform: {
        Place inner = place;
        inner.order = 0;
        const std::string object =
            part(element.body, 0, inner, element.span) + parameter_list(place.parameters);
        if (element.clones) return fail(element.span, "'clone' has no words in .inst");
        double order = place.order;
        for (const Expr& change : element.arguments) {
            if (change.kind != Expr::Kind::modification)
                return fail(change.span, "this transform has no words in .inst");
            const bool lifted = lifts(*change.change, {&element.body}, element.span);
            if (const std::optional<Lines> lines =
                    lines_of(*change.change, place.scope, {.order = order, .lifts = lifted, .block = true}))
                line(fmt::format("instance: {}{}{}", object, lines->moves, lines->inks), element.span);
            order += width_of(element.body, place.shape);
        }
        break;
    }
    case Element::Kind::path_operation:
        fail(element.span, fmt::format("'{}' belongs to a path", element.name));
        break;
    case Element::Kind::define:
        break;
    }
}

void Writer::write_condition(const Element& element, Place& place) {
    const std::optional<std::string> test = text(element.arguments[0], place.scope);
    if (!test) return;
    if (is_random(*test))
        return fail(element.arguments[0].span, "a random condition is not translated",
                    "use two rules with weights");
    line(fmt::format("when {} {{", *test), element.span);
    ++depth_;
    Place inner = place;
    write_elements(element.body, 0, inner);
    --depth_;
    if (!element.other.empty()) {
        line("} else {");
        ++depth_;
        inner = place;
        write_elements(element.other, 0, inner);
        --depth_;
    }
    line("}");
}

void Writer::write_choice(const Element& element, Place& place) {
    const std::optional<std::string> value = text(element.arguments[0], place.scope);
    if (!value) return;
    if (is_random(*value))
        return fail(element.arguments[0].span, "a random choice is not translated", "use rules with weights");
    const Case* otherwise = nullptr;
    bool open = false;
    for (const Case& one : element.cases) {
        if (one.values.empty()) {
            otherwise = &one;
            continue;
        }
        std::string test;
        for (const Expr& label : one.values)
            if (const std::optional<std::string> words = text(label, place.scope))
                test += fmt::format("{}floor({}) == floor({})", test.empty() ? "" : " || ", *value, *words);
        if (test.empty()) return;
        line(fmt::format("{}when {} {{", open ? "} else " : "", test), element.span);
        open = true;
        ++depth_;
        Place inner = place;
        write_elements(one.body, 0, inner);
        --depth_;
    }
    if (otherwise && open) line("} else {"), ++depth_;
    if (otherwise) {
        Place inner = place;
        write_elements(otherwise->body, 0, inner);
    }
    if (otherwise && open) --depth_;
    if (open) line("}");
}

bool Writer::draws_rules(const Element& element) const {
    const std::optional<std::size_t> shape = recursion_.index(element.name);
    return shape && !grammar_.shapes[*shape].is_path;
}

void Writer::look_into(const Elements& elements, bool& shapes, bool& others) const {
    for (const Element& element : elements) {
        if (element.kind == Element::Kind::shape) (draws_rules(element) ? shapes : others) = true;
        look_into(element.body, shapes, others);
        look_into(element.other, shapes, others);
        for (const Case& one : element.cases)
            look_into(one.body, shapes, others);
    }
}

bool Writer::lifts(const Modification& modification, std::initializer_list<const Elements*> held,
                   Span place) {
    bool shapes = false, others = false;
    for (const Elements* const elements : held)
        look_into(*elements, shapes, others);
    const bool resizes = std::ranges::any_of(modification.adjustments, [](const Adjustment& adjustment) {
        return adjustment.word == "s" || adjustment.word == "skew" || adjustment.word == "trans";
    });
    if (shapes && others && resizes)
        fail(place, "what resizes shapes and primitives together has no words in .inst");
    return shapes;
}

void Writer::write_loop(const Element& element, Place& place) {
    const auto uses_index = [&](const auto& self, const Elements& elements) -> bool {
        return std::ranges::any_of(elements, [&](const Element& inner) {
            const auto in = [&](const Expr& value) { return Expressions::mentions(value, element.name); };
            const auto modifies = [&](const Modification& modification) {
                return std::ranges::any_of(modification.adjustments, [&](const Adjustment& adjustment) {
                    return std::ranges::any_of(adjustment.values, in);
                });
            };
            return std::ranges::any_of(inner.arguments, in) || modifies(inner.modification) ||
                   self(self, inner.body) || self(self, inner.other) ||
                   std::ranges::any_of(inner.cases, [&](const Case& one) {
                       return std::ranges::any_of(one.values, in) || self(self, one.body);
                   });
        });
    };
    Element probe = {};
    probe.modification = element.modification;
    const bool indexed =
        !element.name.empty() && (uses_index(uses_index, element.body) || uses_index(uses_index, {probe}) ||
                                  uses_index(uses_index, element.other));
    if (indexed || !element.other.empty() || element.arguments.size() > 2)
        return write_indexed_loop(element, place);
    std::optional<std::string> count = text(element.arguments.back(), place.scope);
    const std::optional<std::string> begin =
        element.arguments.size() == 2 ? text(element.arguments.front(), place.scope) : std::nullopt;
    const bool lifted = lifts(element.modification, {&element.body}, element.span);
    if (!count) return;
    const bool random = is_random(*count) || (begin && is_random(*begin));
    if (begin) count = fmt::format("({} - ({}))", *count, *begin);
    const double turn = width_of(element.body, place.shape);
    const std::optional<double> turns = turns_of(element);
    const std::optional<Lines> lines = lines_of(element.modification, place.scope,
                                                {.order = turns ? turn : 0,
                                                 .lifts = lifted,
                                                 .block = true,
                                                 .width = turns ? 0 : width_of(element, place.shape),
                                                 .each_of = turns ? "" : fmt::format("max(1, {})", *count)});
    if (!lines) return;
    if (random) return fail(element.span, "a loop of a random number of turns has no words in .inst");
    const std::optional<double> known =
        element.arguments.size() == 1 ? expressions_.number(element.arguments[0]) : std::nullopt;
    if (known && !(*known > 0)) return;
    if (!known) line(fmt::format("when {} > 0 {{", *count)), ++depth_;
    line(fmt::format("repeat {} {{{}{} }} {{",
                     known ? shortest(std::ceil(*known)) : fmt::format("ceil({})", *count), lines->moves,
                     lines->inks),
         element.span);
    ++depth_;
    Place inner = place;
    write_elements(element.body, 0, inner);
    --depth_;
    line("}");
    if (!known) --depth_, line("}");
}

/// Turn by turn: the index is a parameter of an object, and each turn moves by one more line.
void Writer::write_indexed_loop(const Element& element, Place& place) {
    std::vector<double> bounds;
    for (const Expr& bound : element.arguments) {
        const std::optional<double> value = expressions_.number(bound);
        if (!value) return fail(bound.span, "the bounds of a loop whose index is used must be known numbers");
        bounds.push_back(*value);
    }
    const double begin = bounds.size() > 1 ? bounds[0] : 0, end = bounds.size() > 1 ? bounds[1] : bounds[0];
    const double step = bounds.size() > 2 ? bounds[2] : 1;
    if (step == 0 || !((end - begin) / step <= static_cast<double>(most_turns)))
        return fail(element.span, fmt::format("a loop whose index is used has at most {} turns", most_turns));
    Place inner = place;
    std::string index = plain_name(element.name.empty() ? "i" : element.name);
    while (is_own_word(index) || std::ranges::find(inner.parameters, index) != inner.parameters.end())
        index += "_";
    inner.parameters.push_back(index);
    if (!element.name.empty()) inner.scope[element.name] = index;
    const std::string object = part(element.body, 0, inner, element.span);
    const bool lifted = lifts(element.modification, {&element.body, &element.other}, element.span);
    const double width = width_of(element.body, place.shape);
    std::string moves, inks;
    Affine moved;
    bool numbers = true;
    double turns = 0;
    Numbers known;
    double at = begin;
    for (; step > 0 ? at < end - 1e-9 : at > end + 1e-9; at += step) {
        std::vector<std::string> arguments = place.parameters;
        arguments.push_back(shortest(at));
        line(fmt::format("instance: {}({}){}{}", object, fmt::join(arguments, ", "), moves, inks),
             element.span);
        Scope scope = place.scope;
        scope[element.name] = shortest(at);
        known[element.name] = at;
        const std::optional<Lines> turn =
            lines_of(element.modification, scope, {.order = width, .lifts = lifted, .block = true});
        if (!turn || out_.text.size() > longest_output) return;
        if (is_random(turn->moves) || is_random(turn->inks)) // later copies stand on those before them
            return fail(element.span, "a random loop whose index is used has no words in .inst");
        const std::optional<Affine> map = affine_of(element.modification, expressions_, known);
        numbers = numbers && map;
        if (numbers) {
            moved = moved * *map;
            // Lines of one turn telescope to this.
            const double shrunk = lifted ? lift * (1 - std::abs(moved.linear[2][2])) : 0;
            Affine written = moved;
            if (!lifted) written.linear[2][2] = 1;
            const Vec3 lies(moved.translation.x, moved.translation.y, unit_ * width * ++turns + shrunk);
            moves = "  matrix:";
            for (int row = 0; row < 3; ++row) {
                moves += fmt::format(" {}, {}, {}, {}{}", shortest(written.linear[0][row]),
                                     shortest(written.linear[1][row]), shortest(written.linear[2][row]),
                                     shortest(lies[row]), row < 2 ? "," : "");
            }
        } else {
            moves.insert(0, turn->moves);
        }
        inks += turn->inks;
        if (inks.size() > 20'000) return fail(element.span, "this loop changes the colour in too many steps");
    }
    if (element.other.empty()) return;
    inner.scope[element.name] = index;
    const std::string last = part(element.other, 0, inner, element.span);
    std::vector<std::string> arguments = place.parameters;
    arguments.push_back(shortest(at));
    line(fmt::format("instance: {}({}){}{}", last, fmt::join(arguments, ", "), moves, inks), element.span);
}

} // namespace graftal::cfdg
