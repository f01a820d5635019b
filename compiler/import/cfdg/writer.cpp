#include "compiler/import/cfdg/writer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/paths/path.h"
#include "compiler/import/cfdg/text.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/own_words.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

constexpr std::size_t most_parts = 20'000;

} // namespace

Writer::Writer(const ForeignFile& file, const Grammar& grammar)
    : SceneWriter(file, grammar), expressions_(file, grammar), recursion_(grammar, expressions_) {
    for (const Shape& shape : grammar_.shapes)
        object_names_.push_back(free_name(shape.name));
    for (const Definition* const constant : expressions_.constants()) {
        const std::string name = plain_name(constant->name);
        if (name == constant->name && !is_own_word(name) && name != "n") constants_[constant->name] = name;
    }
    find_widths();
}

Translation Writer::write() {
    comment("from a grammar of Context Free");
    if (deep_ || unit_ == 0) fail(file_.span(0, 0), "the heights of these shapes have no words in .inst");
    check_definitions();
    write_scene();
    write_constants();
    for (std::size_t shape = 0; shape < grammar_.shapes.size() && !file_.diagnostics.full(); ++shape) {
        write_shape(shape);
        write_parts();
    }
    write_start_shape();
    write_end();
    return std::move(out_);
}

bool Writer::shows_more() const {
    const std::optional<std::size_t> first =
        grammar_.start ? recursion_.index(grammar_.start->name) : std::nullopt;
    return first && recursion_.fades_slowly(*first);
}

void Writer::write_constants() {
    for (const Definition* const constant : expressions_.constants()) {
        if (!constants_.contains(constant->name)) continue;
        for (const std::string& words : constant->comments)
            comment(words);
        line(fmt::format("let {} = {}", constants_.at(constant->name),
                         shortest(*expressions_.number(constant->value))),
             constant->span);
    }
}

void Writer::write_start_shape() {
    if (!grammar_.start) return fail_without_start();
    const Element& start = *grammar_.start;
    const std::string master = reference(start, nullptr, constants_);
    if (const std::optional<Lines> lines = lines_of(start.modification, constants_, {.lifts = true}))
        write_start(master + lines->moves, lines->inks);
}

// Shapes

void Writer::write_shape(std::size_t index) {
    const Shape& shape = grammar_.shapes[index];
    line("");
    for (const std::string& words : shape.comments)
        comment(words);
    for (const Parameter& parameter : shape.parameters)
        if (parameter.type != "number" && parameter.type != "natural")
            return fail(parameter.span, fmt::format("the parameter '{}' of type '{}' is not translated",
                                                    parameter.name, parameter.type));
    if (shape.is_path) {
        if (!shape.parameters.empty())
            return fail(shape.span,
                        fmt::format("the path '{}' has parameters, which are not translated", shape.name));
        return write_path(shape, object_names_[index]);
    }
    if (shape.rules.empty()) return fail(shape.span, fmt::format("'{}' has no rule", shape.name));
    double percents = 0, weights = 0;
    for (const Rule& rule : shape.rules)
        (rule.percent ? percents : weights) += rule.weight.value_or(1);
    for (const Rule& rule : shape.rules) {
        double weight = rule.weight.value_or(1);
        if (percents > 0 && !rule.percent) weight *= std::max(0.0, 100 - percents) / weights;
        write_rule(index, rule, shape.rules.size() > 1 ? fmt::format(" weight {}", shortest(weight)) : "");
    }
}

void Writer::write_rule(std::size_t index, const Rule& rule, const std::string& weight) {
    const Shape& shape = grammar_.shapes[index];
    Place place{index, constants_, {}, 0};
    const std::optional<int> limit = recursion_.limit(index);
    if (limit) place.parameters.emplace_back("n");
    for (const Parameter& parameter : shape.parameters) {
        std::string name = plain_name(parameter.name);
        while (is_own_word(name) || std::ranges::find(place.parameters, name) != place.parameters.end())
            name += "_";
        place.parameters.push_back(name);
        place.scope[parameter.name] = name;
    }
    for (const std::string& words : rule.comments)
        comment(words);
    line(fmt::format("canonical object {}{}{} {{", object_names_[index], parameter_list(place.parameters),
                     weight),
         rule.span);
    ++depth_;
    if (limit) {
        if (!recursion_.shrinks(index))
            file_.diagnostics.note(shape.span,
                                   fmt::format("'{}' calls itself without becoming smaller, as far as can be "
                                               "told; it is drawn to {} generations",
                                               shape.name, *limit));
        line("when n > 0 {");
        ++depth_;
    }
    const std::size_t before = out_.text.size();
    write_elements(rule.body, 0, place);
    if (out_.text.size() == before) line("nothing");
    if (limit) --depth_, line("}");
    --depth_;
    line("}");
}

void Writer::write_path(const Shape& shape, const std::string& name) {
    const std::optional<std::vector<PathPart>> parts = follow(shape, {}, {}, file_, grammar_, evaluator_);
    if (!parts) return;
    if (evaluator_.draws.drawn() > 0) return fail(shape.span, "this path draws random numbers");
    for (const PathPart& part : *parts)
        if (part.of_world) return fail(part.span, "the width of this stroke has no words in .inst");
    line(fmt::format("canonical object {} {{", name), shape.span);
    ++depth_;
    // All of them below what lies in front of the path.
    const double step = unit_ / static_cast<double>(parts->size() + 1);
    std::size_t order = 0;
    for (const PathPart& part : *parts) {
        Target target = first_target;
        const std::optional<std::string> inks = ink_text(part.change.colours, target);
        if (!inks) return fail(part.span, "this changes a colour away from another");
        Affine map = part.change.map;
        map.translation.z += step * static_cast<double>(order++);
        for (const Polygon& polygon : part.polygons)
            line(fmt::format("{}{}  material: flat{}", polygon_text(polygon), moves_text(map), *inks),
                 part.span);
    }
    if (parts->empty()) line("nothing");
    --depth_;
    line("}");
}

/// Objects of their own for what transforms, loops and local numbers hold.
void Writer::write_parts() {
    for (; written_parts_ < parts_.size() && !file_.diagnostics.full(); ++written_parts_) {
        Part next = parts_[written_parts_];
        line("");
        line(fmt::format("canonical object {}{} {{", next.name, parameter_list(next.place.parameters)),
             next.span);
        ++depth_;
        const std::size_t before = out_.text.size();
        write_elements(*next.elements, next.first, next.place);
        if (out_.text.size() == before) line("nothing");
        --depth_;
        line("}");
    }
}

std::string Writer::part(const Elements& elements, std::size_t first, Place place, Span span,
                         const std::vector<std::string>& more) {
    std::string name = free_name(fmt::format("{}_part", object_names_[place.shape]));
    std::vector<std::string> arguments = place.parameters;
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (parts_.size() >= most_parts || out_.text.size() > longest_output)
        fail(span, "the grammar makes too many objects");
    else
        parts_.push_back({name, &elements, first, std::move(place), span});
    return name;
}

std::string Writer::parameter_list(const std::vector<std::string>& names) const {
    return names.empty() ? "" : fmt::format("({})", fmt::join(names, ", "));
}

std::string Writer::reference(const Element& element, const Place* from, const Scope& scope) {
    const std::optional<std::size_t> to = recursion_.index(element.name);
    if (!to) {
        if (const std::string_view kind = primitive_named(element.name); !kind.empty())
            return primitive(kind);
        std::vector<std::string> names = {"CIRCLE", "SQUARE", "TRIANGLE"};
        for (const Shape& shape : grammar_.shapes)
            names.push_back(shape.name);
        fail(element.span, fmt::format("unknown shape '{}'", element.name),
             did_you_mean(element.name, names));
        return element.name;
    }
    const Shape& shape = grammar_.shapes[*to];
    std::vector<std::string> arguments;
    if (const std::optional<int> limit = recursion_.limit(*to))
        arguments.push_back(from && recursion_.together(from->shape, *to) ? "n - 1" : std::to_string(*limit));
    if (element.reuses_arguments) {
        if (!from || grammar_.shapes[from->shape].parameters.size() != shape.parameters.size())
            fail(element.span, "'(=)' needs a shape with the same parameters");
        else
            for (const Parameter& parameter : grammar_.shapes[from->shape].parameters)
                if (const auto known = scope.find(parameter.name); known != scope.end())
                    arguments.push_back(known->second);
    } else {
        for (const Expr& argument : element.arguments)
            if (std::optional<std::string> words = text(argument, scope))
                arguments.push_back(std::move(*words));
        if (element.arguments.size() != shape.parameters.size())
            fail(element.span, fmt::format("'{}' takes {} parameters, not {}", element.name,
                                           shape.parameters.size(), element.arguments.size()));
    }
    return object_names_[*to] + parameter_list(arguments);
}

} // namespace graftal::cfdg
