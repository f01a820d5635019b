#include "compiler/import/lpy/string.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

/// Names of the turtle's modules, and the symbols that say the same.
constexpr std::pair<std::string_view, std::string_view> turtle_names[] = {
    {"Left", "+"},       {"Right", "-"},        {"Up", "^"},        {"Down", "&"},
    {"RollL", "/"},      {"RollR", "\\"},       {"iRollL", "/"},    {"iRollR", "\\"},
    {"TurnAround", "|"}, {"SB", "["},           {"EB", "]"},        {"BP", "{"},
    {"EP", "}"},         {"PP", "."},           {"IncWidth", "_"},  {"SetWidth", "_"},
    {"DecWidth", "!"},   {"IncColor", ";"},     {"SetColor", ";"},  {"DecColor", ","},
    {"Sphere", "@O"},    {"Circle", "@o"},      {"@c", "@o"},       {"Box", "@B"},
    {"Quad", "@b"},      {"MoveTo", "@M"},      {"SetHead", "@R"},  {"MultScale", "@Di"},
    {"DivScale", "@Dd"}, {"StartGC", "@Gc"},    {"EndGC", "@Ge"},   {"RollToVert", "@v"},
    {"@Gs", "@Gc"},      {"Elasticity", "@Ts"}, {"Tropism", "@Tp"}, {"Label", "@L"},
    {"PglShape", "@g"},  {"Cut", "%"},          {"GetPos", "?P"},   {"GetHead", "?H"},
    {"GetUp", "?U"},     {"GetLeft", "?L"},     {"SetScale", "@D"}, {"RollToHorizontal", "@h"},
    {"surface", "~"}};

/// Modules of the turtle that have no short symbol.
constexpr std::string_view long_names =
    "nF Sweep Frame Arrow SetContour SectionResolution SetGuide EndGuide PositionOnGuide InterpolateColors "
    "LineTo OLineTo LineRel OLineRel MoveRel Pinpoint PinpointRel EulerAngles LeftReflection UpReflection "
    "HeadingReflection TextureBaseColor InterpolateTextureBaseColors TextureScale TextureUScale "
    "TextureVScale TextureTranslation TextureRotation TextureTransformation";

constexpr std::string_view directives =
    "@2D @3D @Di @Dd @Gc @Gs @Ge @Ts @Tp @D @O @o @c @B @b @M @R @v @h @L @g";

/// The longest of these words that the text goes on with at `at`; "" for none.
std::string_view longest_at(std::string_view words, std::string_view text, std::size_t at) {
    std::string_view found;
    for (std::size_t begin = 0, end = 0; begin < words.size(); begin = end + 1) {
        end = std::min(words.find(' ', begin), words.size());
        const std::string_view word = words.substr(begin, end - begin);
        if (word.size() > found.size() && text.substr(at).starts_with(word)) found = word;
    }
    return found;
}

/// Parameters that no number is: they name a surface, a curve or a text.
bool takes_objects(std::string_view symbol) {
    constexpr std::string_view all[] = {"@L",         "@g",       "~",
                                        "SetContour", "SetGuide", "InterpolateColors",
                                        "Frame",      "Arrow",    "SectionResolution"};
    return std::ranges::find(all, symbol) != std::end(all) || symbol.starts_with("Texture");
}

/// Queries of L-Py have the axes x, y, z, which are our z, x, y.
void finish(LSystemModule& module) {
    if (module.symbol[0] == '?' && module.parameters.size() == 3)
        std::ranges::rotate(module.parameters, module.parameters.begin() + 1);
    module.has_parentheses = !module.parameters.empty();
}

} // namespace

void LpyStrings::declare(std::string_view text) {
    for (const std::string_view one : split_outside(text.substr(0, find_outside(text, ":"))))
        if (const std::string_view name = cpfg_name_at(one); !name.empty()) declared_.emplace(name);
}

std::string LpyStrings::symbol_at(std::string_view text, std::size_t& at) const {
    std::string_view known;
    // Names are the first letters of a declared word; only words that are long are looked up.
    const std::size_t end = at + cpfg_name_at(text, at).size();
    for (std::size_t stop = std::min(end, at + 40); known.empty() && stop > at + 1; --stop)
        if (declared_.contains(text.substr(at, stop - at))) known = text.substr(at, stop - at);
    if (!known.empty()) {
        at += known.size();
        return std::string(known);
    }
    std::string_view named;
    for (const auto& [name, symbol] : turtle_names)
        if (name[0] != '@' && name.size() > known.size() && text.substr(at).starts_with(name)) {
            known = name;
            named = symbol;
        }
    const std::string_view longer = longest_at(long_names, text, at);
    if (longer.size() > known.size()) known = named = longer;
    if (known.empty()) known = named = longest_at(directives, text, at);
    const bool queries = known.empty() && text[at] == '?' && at + 1 < text.size() &&
                         std::isupper(static_cast<unsigned char>(text[at + 1]));
    if (queries) known = named = text.substr(at, 2);
    const bool surface = known.empty() && text[at] == '~' && at + 1 < text.size() &&
                         std::isalpha(static_cast<unsigned char>(text[at + 1]));
    if (surface) known = named = text.substr(at, 2);
    if (known.empty()) known = named = text.substr(at, 1);
    for (const auto& [name, symbol] : turtle_names)
        if (name == named) named = symbol;
    at += known.size();
    return std::string(named);
}

std::vector<LpyStrings::Written> LpyStrings::modules_of(std::string_view text, Span span) const {
    std::vector<Written> modules;
    text = trimmed(text);
    // `produce (A B)` holds several lines together.
    if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
    for (std::size_t i = 0; i < text.size();) {
        if (std::isspace(static_cast<unsigned char>(text[i]))) {
            ++i;
            continue;
        }
        if (text[i] == '(' || text[i] == ')') {
            complain_(span, "parentheses close the parameters of one module");
            return modules;
        }
        Written& module = modules.emplace_back();
        module.symbol = symbol_at(text, i);
        const std::size_t open = std::min(text.find_first_not_of(" ", i), text.size());
        if (open == text.size() || text[open] != '(') continue;
        i = end_of_parentheses(text, open);
        if (i == std::string_view::npos) {
            complain_(span, "a '(' is not closed");
            return modules;
        }
        module.parameters = split_outside(text.substr(open + 1, i - open - 2), true);
    }
    return modules;
}

LSystemString LpyStrings::read(std::string_view text, Span span, const LpyValues& values) {
    LSystemString string;
    if (trimmed(text) == "*") return string;
    for (const Written& written : modules_of(text, span)) {
        if (written.symbol == "*" || written.symbol == "$") {
            complain_(span, fmt::format("'{}' among modules has no translation", written.symbol));
            break;
        }
        LSystemModule& module = string.emplace_back();
        module.symbol = written.symbol;
        std::size_t first = written.symbol == "Sweep" ? 2 : 0;      // a path and a section
        if (written.symbol == "~" && !written.parameters.empty()) { // ~('l', 2)
            const std::string_view name = written.parameters[0];
            if (name == "'l'" || name == "\"l\"") module.symbol = "~l";
            first = 1;
        }
        const bool objects = takes_objects(module.symbol);
        const std::size_t most = written.symbol == "Sweep" ? 5 : written.symbol == "nF" ? 3 : 100;
        for (std::size_t i = first; i < std::min(written.parameters.size(), most) && !objects; ++i)
            module.parameters.push_back(python_.expression(written.parameters[i], span, values));
        finish(module);
    }
    return string;
}

LSystemString LpyStrings::formals(std::string_view text, Span span, LpyValues& values,
                                  std::string& condition) {
    LSystemString string;
    for (const Written& written : modules_of(text, span)) {
        if (std::string_view("*$").find(written.symbol) != std::string_view::npos) {
            complain_(span, fmt::format("'{}' in what a rule looks for has no translation", written.symbol));
            break;
        }
        LSystemModule& module = string.emplace_back();
        module.symbol = written.symbol;
        for (const std::string_view parameter : written.parameters) {
            const bool is_name = is_cpfg_parameter(parameter);
            std::string own = is_name ? std::string(parameter) : fmt::format("p{}", values.size() + 1);
            if (python_.is_global(own)) own += "_own";
            if (is_name && values.contains(parameter)) {
                complain_(span, fmt::format("'{}' is a parameter twice", parameter));
            } else if (!is_name) {
                if (parameter.find_first_of("*=<>!") != std::string_view::npos ||
                    parameter.find(" if ") != std::string_view::npos)
                    complain_(span, fmt::format("'{}' in what a rule looks for has no translation",
                                                comment_text(parameter.substr(0, 30))));
                const std::string asked = python_.expression(parameter, span, {});
                condition += fmt::format("{}{} == {}", condition.empty() ? "" : " && ", own, asked);
            }
            values[is_name ? std::string(parameter) : own] = own;
            module.parameters.push_back(std::move(own));
        }
        finish(module);
    }
    return string;
}

} // namespace graftal
