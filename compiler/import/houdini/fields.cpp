#include "compiler/import/houdini/fields.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "compiler/import/foreign_text.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

constexpr std::string_view line_marks = " \t-*>`_|"; // of lists, emphasis, quotes and code in Markdown

/// Longer words come first.
constexpr std::pair<std::string_view, HoudiniField> field_words[] = {
    {"premise", HoudiniField::premise},
    {"rule", HoudiniField::rule},
    {"generations", HoudiniField::generations},
    {"generation", HoudiniField::generations},
    {"iterations", HoudiniField::generations},
    {"angle scale", HoudiniField::angle_scale},
    {"angle", HoudiniField::angle},
    {"step size scale", HoudiniField::step_scale},
    {"step scale", HoudiniField::step_scale},
    {"step size", HoudiniField::step},
    {"thickness scale", HoudiniField::thickness_scale},
    {"thickness", HoudiniField::thickness},
    {"gravity", HoudiniField::gravity},
    {"variable b", HoudiniField::value_b},
    {"variable c", HoudiniField::value_c},
    {"variable d", HoudiniField::value_d},
    {"b", HoudiniField::value_b},
    {"c", HoudiniField::value_c},
    {"d", HoudiniField::value_d},
    {"context ignore", HoudiniField::ignore},
    {"random seed", HoudiniField::seed},
    {"seed", HoudiniField::seed},
    {"random scale", HoudiniField::other},
    {"uv increment", HoudiniField::other},
};

struct Reading {
    HoudiniField field;
    std::size_t value;    ///< its place in the line
    bool several = false; ///< `Rules:`, which may have a remark behind it
};

/// The place behind `1. `, as lists of Markdown have it.
std::size_t behind_number(std::string_view line, std::size_t at) {
    std::size_t end = at;
    while (end < line.size() && std::isdigit(static_cast<unsigned char>(line[end])))
        ++end;
    return end > at && line.substr(end).starts_with(". ") ? line.find_first_not_of(line_marks, end + 1) : at;
}

bool has_arrow(std::string_view text) {
    return text.find('=') != std::string_view::npos || text.find("->") != std::string_view::npos;
}

/// A line `word: value` or `word = value`; `rule` has a number, which is enough before a production.
Reading field_of(std::string_view line) {
    std::size_t first = std::min(line.find_first_not_of(line_marks), line.size());
    first = std::min(behind_number(line, first), line.size());
    const std::string small = in_small_letters(line.substr(first, 40));
    for (const auto& [word, field] : field_words) {
        if (!small.starts_with(word)) continue;
        std::size_t at = first + word.size();
        bool numbered = false;
        while (field == HoudiniField::rule && at < line.size() &&
               (std::isdigit(static_cast<unsigned char>(line[at])) || line[at] == ' ' || line[at] == '#'))
            numbered = std::isdigit(static_cast<unsigned char>(line[at++])) || numbered;
        const bool several = field == HoudiniField::rule && small.starts_with("rules");
        if (several) ++at;
        // `b = F` with one letter is a production: only a number is a value.
        while (at < line.size() && (line[at] == ' ' || line[at] == '*'))
            ++at;
        const bool divided = at < line.size() && (line[at] == ':' || line[at] == '=' || line[at] == '\t');
        if (divided) ++at;
        if (!divided && !(numbered && has_arrow(line.substr(at)))) continue;
        const std::string_view value = trimmed(line.substr(at));
        if (word.size() == 1 && (value.empty() || leading_number(value).length != value.size())) continue;
        return {field, at, several && !has_arrow(value)};
    }
    return {HoudiniField::remark, 0};
}

/// A line that is a production without a word before it: one symbol, and what may stand behind it.
bool is_production(std::string_view text) {
    if (text.empty() || text[0] == '=' || !has_arrow(text)) return false;
    const std::string_view rest = trimmed(text.substr(1));
    return rest.starts_with("->") ||
           (!rest.empty() && std::string_view("=(:<>").find(rest[0]) != std::string_view::npos);
}

/// The text without the backquotes around it, and without Markdown's signs for emphasis and a new line.
std::string_view without_quotes(std::string_view text) {
    while (text.starts_with("**"))
        text = trimmed(text.substr(2));
    while (text.ends_with("**") || text.ends_with(" \\") || text.ends_with("`\\"))
        text = trimmed(text.substr(0, text.size() - (text.ends_with("**") ? 2 : 1)));
    const std::size_t tail = text.size() > 1 && text[0] == '`' ? text.rfind('`') : 0;
    return tail > 0 ? trimmed(text.substr(1, tail - 1)) : text;
}

} // namespace

std::vector<HoudiniLine> houdini_lines(std::string_view text, std::size_t begin, std::size_t end) {
    std::vector<HoudiniLine> lines;
    HoudiniField open = HoudiniField::remark; // a field whose value is on the next line
    std::size_t opened = 0;                   // its place
    for (const TextLine& line : lines_of(text, begin, end)) {
        Reading reading = field_of(line.text);
        const bool free = reading.field == HoudiniField::remark;
        const bool continues = free && !trimmed(line.text).empty() && open != HoudiniField::remark;
        const std::size_t words = std::min(behind_number(line.text, 0), line.text.size());
        if (continues)
            reading = {open, words};
        else if (free && is_production(without_quotes(trimmed(line.text.substr(words)))))
            reading = {HoudiniField::rule, words};
        std::string_view value = trimmed(line.text.substr(reading.value));
        if (reading.field != HoudiniField::remark) value = without_quotes(value);
        const bool begins = reading.several || (value.empty() && (reading.field == HoudiniField::premise ||
                                                                  reading.field == HoudiniField::rule));
        if (reading.several) value = {};
        if (!value.empty()) open = HoudiniField::remark;
        if (begins) open = reading.field;
        if (begins) opened = line.begin;
        if (!value.empty())
            lines.push_back({reading.field, value, static_cast<std::size_t>(value.data() - text.data()),
                             continues ? opened : line.begin});
    }
    return lines;
}

} // namespace graftal
