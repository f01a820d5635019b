#include "compiler/syntax/lookalikes.h"

#include <array>

#include <fmt/format.h>

#include "compiler/support/printable.h"

namespace graftal {

namespace {

struct Row {
    char32_t first, last;
    Lookalike look;
};

constexpr std::array rows = {
    Row{0x00A0, 0x00A0, {" ", "a no-break space"}},
    Row{0x2000, 0x200D, {" ", "a space of another width"}},
    Row{0x2028, 0x2029, {" ", "a separator of lines"}},
    Row{0x202F, 0x202F, {" ", "a no-break space"}},
    Row{0x205F, 0x2060, {" ", "a space of another width"}},
    Row{0x3000, 0x3000, {" ", "a full-width space"}},
    Row{0xFEFF, 0xFEFF, {" ", "a byte order mark"}},
    Row{0x00AB, 0x00AB, {"\"", "a typographic quote"}},
    Row{0x00BB, 0x00BB, {"\"", "a typographic quote"}},
    Row{0x2018, 0x201F, {"\"", "a typographic quote"}},
    Row{0x2032, 0x2036, {"\"", "a prime"}},
    Row{0x2010, 0x2015, {"-", "a dash"}},
    Row{0x2212, 0x2212, {"-", "a minus sign"}},
    Row{0x2190, 0x2190, {"<-", "an arrow"}},
    Row{0x2192, 0x2192, {"->", "an arrow"}},
    Row{0x21D2, 0x21D2, {"->", "an arrow"}},
    Row{0x27F6, 0x27F6, {"->", "an arrow"}},
    Row{0x00D7, 0x00D7, {"*", "a multiplication sign"}},
    Row{0x00B7, 0x00B7, {"*", "a multiplication sign"}},
    Row{0x00F7, 0x00F7, {"/", "a division sign"}},
    Row{0x2044, 0x2044, {"/", "a fraction slash"}},
    Row{0x2215, 0x2215, {"/", "a division slash"}},
    Row{0x2260, 0x2260, {"!=", "a sign of inequality"}},
    Row{0x2264, 0x2264, {"<=", "a sign of inequality"}},
    Row{0x2265, 0x2265, {">=", "a sign of inequality"}},
    Row{0x2026, 0x2026, {"..", "an ellipsis"}},
    Row{0x2223, 0x2223, {"|", "a vertical bar"}},
};

constexpr char32_t full_width_first = 0xFF01, full_width_last = 0xFF5E;
constexpr char32_t degree = 0x00B0;

constexpr std::string_view ascii = " !\"#$%&'()*+,-./0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`"
                                   "abcdefghijklmnopqrstuvwxyz{|}~";

} // namespace

std::optional<Lookalike> lookalike(char32_t character) {
    if (character >= full_width_first && character <= full_width_last)
        return Lookalike{ascii.substr(character - full_width_first + 1, 1), "a full-width character"};
    for (const Row& row : rows)
        if (character >= row.first && character <= row.last) return row.look;
    return std::nullopt;
}

bool is_foreign_letter(char32_t character) {
    if (character < 0xC0 || character == CodePoint::invalid || lookalike(character)) return false;
    const bool sign =
        (character >= 0x2000 && character < 0x2C00) || (character >= 0x3000 && character < 0x3040);
    return !sign && character < 0xD800;
}

std::string unexpected_character(std::string_view character) {
    const CodePoint point = code_point(character, 0);
    if (point.value == CodePoint::invalid || point.value < 0x20)
        return fmt::format("unexpected byte 0x{:02X}", static_cast<unsigned char>(character[0]));
    const std::optional<Lookalike> look = lookalike(point.value);
    if (is_control(point) || (look && look->meant == " "))
        return fmt::format("unexpected character U+{:04X}", static_cast<unsigned>(point.value));
    return fmt::format("unexpected character '{}'", character);
}

std::string lookalike_hint(std::string_view character) {
    const CodePoint point = code_point(character, 0);
    if (point.value == degree) return "angles are in degrees and need no sign";
    if (point.value == '\'') return "write strings in double quotes: \"leaf.rifs\"";
    const std::optional<Lookalike> look = lookalike(point.value);
    if (look && look->meant == " ") return fmt::format("it is {}; write a space", look->name);
    if (look) return fmt::format("it is {}; write {}", look->name, look->meant);
    return is_foreign_letter(point.value) ? "write names with the letters a to z and A to Z, digits and _"
                                          : "";
}

} // namespace graftal
