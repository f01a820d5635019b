#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "compiler/import/bourke/bourke.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/support/printable.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// The text without the blanks before it.
std::string_view from_word(std::string_view text) {
    return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
}

/// The names of parameters, as the notes have them, and as people write them.
constexpr std::pair<std::string_view, BourkeParameter> parameter_names[] = {
    {"angle", BourkeParameter::angle},
    {"turning angle", BourkeParameter::angle},
    {"theta", BourkeParameter::angle},
    {"angle increment", BourkeParameter::angle_increment},
    {"turning angle increment", BourkeParameter::angle_increment},
    {"length", BourkeParameter::length},
    {"line length", BourkeParameter::length},
    {"length factor", BourkeParameter::length_factor},
    {"length growth factor", BourkeParameter::length_factor},
    {"length scale factor", BourkeParameter::length_factor},
    {"line length scale factor", BourkeParameter::length_factor},
    {"scale length", BourkeParameter::length_factor},
    {"width", BourkeParameter::width},
    {"line width", BourkeParameter::width},
    {"width increment", BourkeParameter::width_increment},
    {"line width increment", BourkeParameter::width_increment},
    {"iterations", BourkeParameter::steps},
    {"iteration", BourkeParameter::steps},
    {"generations", BourkeParameter::steps},
    {"depth", BourkeParameter::steps},
};

/// The parameter of this name, whatever its capitals and blanks are.
BourkeParameter parameter_of(std::string_view text) {
    std::string name;
    for (const char c : in_small_letters(text))
        if (const bool blank = c == ' ' || c == '\t'; !blank || !name.ends_with(' ')) name += blank ? ' ' : c;
    for (const auto& [known, parameter] : parameter_names)
        if (known == name) return parameter;
    return BourkeParameter::unknown;
}

bool is_words(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) {
        return c == ' ' || c == '\t' || std::isalpha(static_cast<unsigned char>(c));
    });
}

/// `words`: without blanks at the ends, and not empty.
BourkeLine line_of(std::string_view words) {
    const std::size_t symbol = code_point(words, 0).size;
    const std::string_view behind = from_word(words.substr(symbol));
    for (const std::string_view arrow : {"->", "\u2192"})
        if (behind.starts_with(arrow))
            return {BourkeLineKind::rule, from_word(behind.substr(arrow.size())), words.substr(0, symbol)};
    constexpr std::string_view axiom = "axiom";
    if (in_small_letters(words.substr(0, axiom.size())) == axiom) {
        const std::string_view rest = from_word(words.substr(axiom.size()));
        if (rest.starts_with('=') || rest.starts_with(':'))
            return {BourkeLineKind::axiom, from_word(rest.substr(1))};
        if (words.size() - axiom.size() > rest.size() && rest.find_first_of(" \t") == std::string_view::npos)
            return {BourkeLineKind::axiom, rest};
    }
    // Behind the name of a parameter stands a sign, or at once a number.
    const std::size_t end = std::min(words.find_first_of("=:.0123456789+-"), words.size());
    const std::string_view name = trimmed(words.substr(0, end)), rest = words.substr(end);
    const bool equals = rest.starts_with('='), divided = equals || rest.starts_with(':');
    const std::string_view value = divided ? from_word(rest.substr(1)) : rest;
    const BourkeParameter parameter = parameter_of(name);
    const bool known = parameter != BourkeParameter::unknown &&
                       (divided || (!value.empty() && leading_number(value).length == value.size()));
    if (known || (equals && is_words(name))) return {BourkeLineKind::parameter, value, name, parameter};
    return {BourkeLineKind::remark, words};
}

/// A model has an axiom, and begins at the remarks before it; the first has what stands before them, too.
std::vector<ForeignModel> bourke_models(const ForeignFile& file) {
    const std::string_view text = file.text();
    std::vector<std::size_t> begins;
    std::optional<std::size_t> remarks; // where those behind the last statement begin
    for (const BourkeLine& line : bourke_lines(text, 0, text.size())) {
        if (line.kind == BourkeLineKind::axiom)
            begins.push_back(begins.empty() ? 0 : remarks.value_or(line.begin));
        if (line.kind != BourkeLineKind::remark)
            remarks.reset();
        else if (!remarks)
            remarks = line.begin;
    }
    return models_at(file, begins);
}

} // namespace

std::vector<BourkeLine> bourke_lines(std::string_view text, std::size_t begin, std::size_t end) {
    std::vector<BourkeLine> lines;
    for (const TextLine& line : lines_of(text, begin, end)) {
        const std::string_view words = trimmed(line.text);
        if (words.empty()) continue;
        BourkeLine& read = lines.emplace_back(line_of(words));
        read.begin = static_cast<std::size_t>(words.data() - text.data());
        read.value_begin = static_cast<std::size_t>(read.value.data() - text.data());
    }
    return lines;
}

bool is_bourke(std::string_view text) {
    bool axiom = false, rule = false;
    for (const BourkeLine& line : bourke_lines(text, 0, text.size())) {
        axiom = axiom || line.kind == BourkeLineKind::axiom;
        rule = rule || line.kind == BourkeLineKind::rule;
        // `lsys name {`, as ours; Fractint's blocks are others, too.
        if (line.kind == BourkeLineKind::remark && (line.value.ends_with('{') || line.value == "}"))
            return false;
    }
    return axiom && rule;
}

Importer bourke_importer() {
    return {.format = "Bourke L-system",
            .endings = {},
            .recognises = is_bourke,
            .sign = "lines 'axiom = F', 'F -> F+F' and 'angle = 60'",
            .models = bourke_models,
            .translation = translate_bourke,
            .most_bytes = 1'000'000}; // its strings have fewer modules than ours may
}

} // namespace graftal
