#include "compiler/import/foreign_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/path_text.h"
#include "compiler/support/printable.h"
#include "compiler/support/srgb.h"
#include "compiler/syntax/lookalikes.h"

namespace graftal {

std::vector<TextLine> lines_of(std::string_view text, std::size_t begin, std::size_t end) {
    std::vector<TextLine> lines;
    while (begin < end) {
        const std::size_t line_end = std::min(text.find('\n', begin), end);
        std::string_view line = text.substr(begin, line_end - begin);
        while (line.ends_with('\r'))
            line.remove_suffix(1);
        lines.push_back({begin, line});
        begin = line_end + 1;
    }
    return lines;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blank = " \t\r\n\f\v";
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string comment_text(std::string_view text) {
    text = trimmed(text);
    std::string plain;
    for (std::size_t at = 0; at < text.size();) {
        const CodePoint point = code_point(text, at);
        const bool seen = point.value >= 0x20 && point.value < 0x7f;
        plain += seen ? static_cast<char>(point.value) : point.value == '\t' ? ' ' : '?';
        at += point.size;
    }
    return plain;
}

std::string symbol_name(char symbol) {
    constexpr std::pair<char, const char*> names[] = {
        {'$', "Dollar"},    {'%', "Percent"}, {'&', "And"},    {'^', "Caret"}, {'\'', "Quote"},
        {',', "Comma"},     {'.', "Dot"},     {'#', "Hash"},   {':', "Colon"}, {';', "Semi"},
        {'?', "Query"},     {'*', "Star"},    {'(', "Open"},   {')', "Shut"},  {'{', "Brace"},
        {'}', "Shutbrace"}, {'~', "Tilde"},   {'"', "Mark"},   {'`', "Back"},  {'_', "Under"},
        {'!', "Bang"},      {'/', "Slash"},   {'\\', "Slope"}, {'|', "Bar"},   {'<', "Less"},
        {'>', "More"},      {'=', "Equal"},   {'+', "Plus"},   {'-', "Minus"}, {'@', "At"}};
    for (const auto& [known, name] : names)
        if (known == symbol) return name;
    const auto byte = static_cast<unsigned char>(symbol);
    if (byte < 0x80 && std::isalnum(byte)) return std::string(1, symbol);
    return "Byte" + std::to_string(byte);
}

namespace {

bool is_hex_digit(char c) {
    return std::isxdigit(static_cast<unsigned char>(c));
}

} // namespace

std::string plain_name(std::string_view name) {
    std::string plain;
    for (const char c : name)
        plain += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    const bool letter_first = !plain.empty() && std::isalpha(static_cast<unsigned char>(plain[0]));
    return letter_first ? plain : "m_" + plain;
}

std::string block_name(std::string_view name) {
    std::string block = plain_name(name);
    block[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(block[0])));
    return block;
}

LeadingNumber leading_number(std::string_view text) {
    std::string_view rest = text.substr(std::min(text.find_first_not_of(" \t\r\n\f\v"), text.size()));
    const bool negative = rest.starts_with('-');
    if (negative || rest.starts_with('+')) rest.remove_prefix(1);
    if (rest.starts_with('-')) return {};
    const std::string_view digits = rest.substr(std::min<std::size_t>(2, rest.size()));
    const bool hexadecimal = (rest.starts_with("0x") || rest.starts_with("0X")) && !digits.empty() &&
                             is_hex_digit(digits[digits.size() > 1 && digits[0] == '.' ? 1 : 0]);
    if (hexadecimal) rest.remove_prefix(2);
    LeadingNumber number;
    const auto [end, error] =
        std::from_chars(rest.data(), rest.data() + rest.size(), number.value,
                        hexadecimal ? std::chars_format::hex : std::chars_format::general);
    if (error == std::errc::invalid_argument) return {};
    const auto length = static_cast<std::size_t>(end - rest.data());
    if (error == std::errc::result_out_of_range) // too small for a number, or too large
        number.value = parse_number(rest.substr(0, length)).value_or(std::numeric_limits<double>::infinity());
    if (negative) number.value = -number.value;
    number.length = static_cast<std::size_t>(end - text.data());
    return number;
}

std::string linear_text(const std::array<double, 3>& rgb) {
    return fmt::format("{}, {}, {}", shortest(linear_from_srgb(rgb[0])), shortest(linear_from_srgb(rgb[1])),
                       shortest(linear_from_srgb(rgb[2])));
}

std::string remark_text(std::string_view comment) {
    return comment.empty() ? std::string() : fmt::format("   # {}", comment);
}

std::vector<ForeignModel> one_model(const ForeignFile& file) {
    return {{std::string(stem_of(file.sources.name(file.file))),
             file.span(0, std::min(file.text().find('\n'), file.text().size()))}};
}

std::vector<ForeignModel> models_at(const ForeignFile& file, const std::vector<std::size_t>& begins) {
    const std::string name(stem_of(file.sources.name(file.file)));
    std::vector<ForeignModel> models;
    for (std::size_t i = 0; i < begins.size(); ++i)
        models.push_back({begins.size() == 1 ? name : fmt::format("{}_{}", name, i + 1),
                          file.span(begins[i], i + 1 < begins.size() ? begins[i + 1] : file.text().size())});
    return models;
}

std::vector<ForeignModel> one_scene(const ForeignFile& file) {
    return {{"scene", file.span(0, file.text().size())}};
}

std::string CodeReader::next(std::string_view text, std::size_t& at, std::size_t begin,
                             std::optional<std::uint32_t> whole) {
    const std::size_t from = at;
    at += code_point(text, at).size;
    return signs_of(text.substr(from, at - from),
                    whole ? file_.span(*whole, *whole) : file_.span(begin + from, begin + at));
}

std::string CodeReader::signs(std::string_view text, Span span) {
    std::string all;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t size = code_point(text, at).size;
        all += signs_of(text.substr(at, size), span);
        at += size;
    }
    return all;
}

std::string CodeReader::signs_of(std::string_view character, Span span) {
    const char32_t value = code_point(character, 0).value;
    if (value < 0x80) return std::string(character);
    if (const std::optional<Lookalike> look = lookalike(value)) {
        if (warned_.emplace(character).second)
            file_.diagnostics.warning(
                span, look->meant == " "
                          ? fmt::format("U+{:04X} is {}: it is read as a space", static_cast<unsigned>(value),
                                        look->name)
                          : fmt::format("'{}' is {}: it is read as {}", character, look->name, look->meant));
        return std::string(look->meant);
    }
    if (value <= 0xFF) return std::string(1, static_cast<char>(value));
    if (value == CodePoint::invalid) return std::string(character);
    file_.diagnostics.error(span, unexpected_character(character)).with_hint(lookalike_hint(character));
    return {};
}

bool is_binary(std::string_view text) {
    return text.find('\0') != std::string_view::npos;
}

} // namespace graftal
