#include "compiler/import/cfdg_writer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/cfdg_affine.h"
#include "compiler/import/cfdg_path.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/importers.h"
#include "compiler/import/own_words.h"
#include "compiler/support/hue.h"
#include "compiler/support/number.h"
#include "compiler/support/srgb.h"

namespace graftal::cfdg {

namespace {

constexpr std::size_t most_parts = 20'000;

bool is_colour(const Adjustment& adjustment) {
    return adjustment.word == "h" || adjustment.word == "sat" || adjustment.word == "b" ||
           adjustment.word == "a";
}

/// Signs of Unicode are names of them too.
std::string_view primitive_named(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 12> table = {
        {{"CIRCLE", "CIRCLE"},
         {"SQUARE", "SQUARE"},
         {"TRIANGLE", "TRIANGLE"},
         {"\u25cf", "CIRCLE"},
         {"\u26ab", "CIRCLE"},
         {"\u2b24", "CIRCLE"},
         {"\u25a0", "SQUARE"},
         {"\u25fc", "SQUARE"},
         {"\u2b1b", "SQUARE"},
         {"\uffed", "SQUARE"},
         {"\u25b2", "TRIANGLE"},
         {"\u25b4", "TRIANGLE"}}};
    for (const auto& [written, meant] : table)
        if (name == written) return meant;
    return {};
}

} // namespace

Writer::Writer(const ForeignFile& file, const Grammar& grammar)
    : file_(file), grammar_(grammar), expressions_(file, grammar), recursion_(grammar, expressions_) {
    for (const char* const taken : {"flat", "scene", "n"})
        names_.insert(taken);
    for (const Shape& shape : grammar_.shapes)
        object_names_.push_back(free_name(shape.name));
    for (const Definition* const constant : expressions_.constants()) {
        const std::string name = plain_name(constant->name);
        if (name == constant->name && !is_own_word(name) && name != "n") constants_[constant->name] = name;
    }
}

Translation Writer::write() {
    comment("from a grammar of Context Free");
    check_definitions();
    write_scene();
    for (std::size_t shape = 0; shape < grammar_.shapes.size() && !file_.diagnostics.full(); ++shape) {
        write_shape(shape);
        write_parts();
    }
    write_start();
    write_primitives();
    for (const std::string& words : grammar_.tail)
        comment(words);
    return std::move(out_);
}

void Writer::fail(Span span, std::string message, std::string hint) {
    file_.diagnostics.error(span, std::move(message)).with_hint(std::move(hint));
}

// The scene

void Writer::check_definitions() {
    static const std::set<std::string, std::less<>> harmless = {
        "CF::Impure",      "CF::MinimumSize",  "CF::MaxNatural", "CF::MaxShapes", "CF::BorderDynamic",
        "CF::BorderFixed", "CF::Color",        "CF::ColorDepth", "CF::Time",      "CF::Frame",
        "CF::FrameTime",   "CF::AllowOverlap", "CF::Alpha"};
    for (const Definition& definition : grammar_.definitions) {
        if (!definition.name.starts_with("CF::")) continue;
        if (harmless.contains(definition.name))
            file_.diagnostics.note(definition.span,
                                   fmt::format("'{}' changes nothing here", definition.name));
        else if (definition.name != "CF::Symmetry" || !read_symmetry(definition))
            fail(definition.span, fmt::format("this '{}' is not translated", definition.name));
    }
    if (grammar_.tile)
        file_.diagnostics.warning(grammar_.tile->span, "'tile': one tile is drawn, without its neighbours");
}

/// `CF::Symmetry = CF::Cyclic, 5` or `CF::Dihedral, 5`, about the origin.
bool Writer::read_symmetry(const Definition& definition) {
    const Expr& value = definition.value;
    if (value.kind != Expr::Kind::list || value.operands.size() != 2) return false;
    const std::string& kind = value.operands[0].text;
    const std::optional<double> turns = expressions_.number(value.operands[1]);
    if ((kind != "CF::Cyclic" && kind != "CF::Dihedral") || !turns || *turns < 1 || *turns > 1000)
        return false;
    turns_ = static_cast<int>(*turns);
    mirrors_ = kind == "CF::Dihedral";
    return true;
}

std::array<double, 3> Writer::colour_from(const Modification& modification, std::array<double, 3> hsv) {
    for (const Adjustment& adjustment : modification.adjustments) {
        if (!is_colour(adjustment) || adjustment.word == "a") continue;
        const std::optional<double> by = expressions_.number(adjustment.values[0]);
        if (!by) {
            fail(adjustment.span, "the numbers of this colour must be known");
            continue;
        }
        double& part = hsv[adjustment.word == "h" ? 0 : adjustment.word == "sat" ? 1 : 2];
        part = adjustment.word == "h"
                   ? part + *by
                   : std::clamp(*by > 0 ? part + *by * (1 - part) : part * (1 + *by), 0.0, 1.0);
    }
    return hsv;
}

void Writer::write_scene() {
    const std::array<double, 3> hsv =
        grammar_.background ? colour_from(*grammar_.background, {0, 0, 1}) : std::array{0.0, 0.0, 1.0};
    const Rgb screen = rgb_from_hsv(hsv[0], hsv[1], hsv[2]);
    line(fmt::format("background: {}, {}, {}", rounded(linear_from_srgb(screen.r)),
                     rounded(linear_from_srgb(screen.g)), rounded(linear_from_srgb(screen.b))));
    write_camera();
    line("light { sun: 0,0,1  color: 0,0,0 }   # colours are as they are");
    line("material flat { color: 1,1,1  ambient: 1  diffuse: 0  specular: 0 }");
    for (const Definition* const constant : expressions_.constants()) {
        if (!constants_.contains(constant->name)) continue;
        for (const std::string& words : constant->comments)
            comment(words);
        line(fmt::format("let {} = {}", constants_.at(constant->name),
                         shortest(*expressions_.number(constant->value))),
             constant->span);
    }
}

void Writer::write_camera() {
    const std::optional<Modification>& given = grammar_.size ? grammar_.size : grammar_.tile;
    const std::optional<Affine> map = given ? affine_of(*given, expressions_) : std::nullopt;
    if (given && !map) fail(given->span, "the numbers of the size must be known");
    if (!map) return line("camera { orthographic  location: 0,0,10  look_at: 0,0,0 }");
    const Vec3 at = map->translation;
    line(fmt::format("camera {{ orthographic  location: {0},{1},10  look_at: {0},{1},0  width: {2} }}",
                     rounded(at.x), rounded(at.y), rounded(glm::length(map->linear[0]))),
         given->span);
}

void Writer::write_start() {
    line("");
    line("object scene {");
    ++depth_;
    if (!grammar_.start) {
        fail(file_.span(0, 0), "the grammar has no 'startshape'");
    } else {
        const Element& start = *grammar_.start;
        const std::string master = reference(start, nullptr, constants_);
        const std::optional<Lines> lines = lines_of(start.modification, constants_, 0);
        if (lines)
            for (const char* const mirror : {"", "  scale: 1, -1, 1"}) {
                if (*mirror && !mirrors_) break;
                const std::string copies = turns_ > 1
                                               ? fmt::format("{} * {{ rotate: z, 360/{} }} ", turns_, turns_)
                                               : std::string("instance: ");
                line(fmt::format("{}{}{}{}  ink: hsv(0, 0, 0){}", copies, master, lines->moves, mirror,
                                 lines->inks),
                     start.span);
            }
    }
    --depth_;
    line("}");
}

void Writer::write_primitives() {
    for (const auto& [key, name] : primitives_) {
        line("");
        line(fmt::format("canonical object {} {{", name));
        if (key == "CIRCLE")
            line("    instance: cylinder  rotate: x, 90  scale: 0.5, 0.5, 0.0001  material: flat");
        else if (key == "SQUARE")
            line("    instance: polygon(-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5)  material: flat");
        else
            line("    instance: polygon(0, 0.57735, -0.5, -0.288675, 0.5, -0.288675)  material: flat");
        line("}");
    }
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
        write_rule(index, rule, shape.rules.size() > 1 ? fmt::format(" weight {}", rounded(weight)) : "");
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
    const std::optional<std::vector<PathPart>> parts = follow(shape, file_, expressions_);
    if (!parts) return;
    line(fmt::format("canonical object {} {{", name), shape.span);
    ++depth_;
    std::size_t order = 0, lines = 0;
    for (const PathPart& part : *parts) {
        std::optional<Lines> own =
            part.modification ? lines_of(*part.modification, constants_, order) : Lines();
        if (!own) continue;
        for (const std::string& words : part.lines)
            line(fmt::format("{}  material: flat{}{}", words, own->moves, own->inks), shape.span), ++lines;
        ++order;
    }
    if (lines == 0) line("nothing");
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
        if (const std::string_view primitive = primitive_named(element.name); !primitive.empty()) {
            auto [known, fresh] = primitives_.try_emplace(std::string(primitive));
            if (fresh) known->second = free_name(primitive);
            return known->second;
        }
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

std::string Writer::free_name(std::string_view wanted) {
    return free_own_name(wanted, "_shape", names_);
}

void Writer::comment(const std::string& words) {
    line("# " + comment_text(words));
}

void Writer::line(const std::string& words, Span origin) {
    out_.line(words.empty() ? words : std::string(static_cast<std::size_t>(4 * depth_), ' ') + words,
              origin.file == file_.file ? origin : Span());
}

} // namespace graftal::cfdg
