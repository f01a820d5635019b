#include "compiler/syntax/everyday_words.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// A word of everyday English, or of another program, for what the languages call differently.
struct EverydayWord {
    std::string_view word; ///< in small letters
    std::string_view how;  ///< text to write instead
};

constexpr std::string_view flat_cylinder = "'cylinder', and flatten it: 'scale: 1, 0.05, 1'";
constexpr std::string_view flat_cube = "'cube', and flatten it: 'scale: 1, 1, 0.05'";
constexpr std::string_view thin_cylinder = "'cylinder', and make it thin: 'scale: 0.1, 1, 0.1'";
constexpr std::string_view file_of_mesh = "'mesh \"FILE.obj\"'";
constexpr std::string_view swept = "'sphere_sweep(...)': a ball along points";

constexpr EverydayWord shapes[] = {
    {"box", "'cube'"},        {"block", "'cube'"},
    {"brick", "'cube'"},      {"cuboid", "'cube'"},
    {"ball", "'sphere'"},     {"globe", "'sphere'"},
    {"bubble", "'sphere'"},   {"ellipsoid", "'sphere', and stretch it by 'scale: 1, 2, 1'"},
    {"tube", "'cylinder'"},   {"pipe", "'cylinder'"},
    {"column", "'cylinder'"}, {"rod", thin_cylinder},
    {"stick", thin_cylinder}, {"pole", thin_cylinder},
    {"line", thin_cylinder},  {"disk", flat_cylinder},
    {"disc", flat_cylinder},  {"circle", flat_cylinder},
    {"plate", flat_cylinder}, {"coin", flat_cylinder},
    {"square", flat_cube},    {"rectangle", flat_cube},
    {"rect", flat_cube},      {"quad", flat_cube},
    {"tile", flat_cube},      {"spike", "'cone'"},
    {"ring", "'torus'"},      {"donut", "'torus'"},
    {"doughnut", "'torus'"},  {"floor", "'plane'"},
    {"capsule", swept},       {"spline", swept},
    {"curve", swept},         {"obj", file_of_mesh},
    {"model", file_of_mesh},
};

constexpr std::string_view move = "'translate: 1, 0, 0'";
constexpr std::string_view resize = "'scale: 2', or 'scale: 1, 2, 1' for each axis";
constexpr std::string_view turn = "'rotate: y, 30': an axis, then the degrees";

constexpr EverydayWord lines[] = {
    {"move", move},
    {"moveto", move},
    {"shift", move},
    {"offset", move},
    {"place", move},
    {"pos", move},
    {"position", move},
    {"location", move},
    {"translation", move},
    {"size", resize},
    {"resize", resize},
    {"grow", resize},
    {"shrink", resize},
    {"stretch", resize},
    {"scaling", resize},
    {"turn", turn},
    {"spin", turn},
    {"roll", turn},
    {"rotation", turn},
    {"rotatex", "'rotate: x, 30': an axis, then the degrees"},
    {"rotatey", turn},
    {"rotatez", "'rotate: z, 30': an axis, then the degrees"},
    {"color", "'tint: r, g, b, alpha' or 'material: NAME'"},
    {"colour", "'tint: r, g, b, alpha' or 'material: NAME'"},
};

/// A word that POV-Ray writes before braces, and the size that ours has.
struct BracedWord {
    std::string_view word;
    std::string_view ours;
    std::string_view size; ///< "" of combinations
};

constexpr BracedWord braced_words[] = {
    {"sphere", "sphere", "radius 1 about the origin"},
    {"cube", "cube", "edges from -1 to 1 on each axis"},
    {"box", "cube", "edges from -1 to 1 on each axis"},
    {"cylinder", "cylinder", "radius 1 about the y axis, from y = 0 to y = 1"},
    {"cone", "cone", "radius 1 at y = 0, and its tip at y = 1"},
    {"torus", "torus", "radii 1 and 1/4 about the y axis"},
    {"union", "union", ""},
    {"merge", "union", ""},
    {"intersection", "intersection", ""},
    {"difference", "difference", ""},
};

std::string hint_of(std::span<const EverydayWord> words, std::string_view word) {
    const auto found = std::ranges::find(words, in_small_letters(word), &EverydayWord::word);
    return found == words.end() ? std::string() : fmt::format("write {}", found->how);
}

} // namespace

std::string shape_word_hint(std::string_view word) {
    return hint_of(shapes, word);
}

std::string line_word_hint(std::string_view word) {
    return hint_of(lines, word);
}

bool is_braced_word(std::string_view word) {
    return std::ranges::find(braced_words, word, &BracedWord::word) != std::end(braced_words);
}

std::string braced_word_hint(std::string_view word, std::string_view around) {
    const auto known = std::ranges::find(braced_words, word, &BracedWord::word);
    const BracedWord braced = known == std::end(braced_words) ? BracedWord{word, word, ""} : *known;
    const bool combines = known != std::end(braced_words) && braced.size.empty();
    const std::string object = combines ? fmt::format("{}: sphere, cube", braced.ours)
                                        : fmt::format("{}  scale: 1  translate: 0, 0, 0", braced.ours);
    std::string text(around);
    text.replace(text.find("..."), 3, object);
    if (braced.size.empty()) return fmt::format("write '{}'", text);
    return fmt::format("'{}' has {}: write '{}'", braced.ours, braced.size, text);
}

std::string lost_product_hint(const Token& before, const Token& token) {
    constexpr std::array<std::string_view, 7> units = {"deg", "degrees", "rad", "px", "cm", "mm", "in"};
    constexpr std::size_t longest_shown = 40;
    if (before.kind != TokenKind::number || token.space_before || token.first_on_line) return {};
    if (std::max(before.text.size(), token.text.size()) > longest_shown) return {};
    if (token.is("(")) return fmt::format("write {}*(...)", before.text);
    if (token.kind != TokenKind::name) return {};
    if (std::ranges::find(units, token.text) != units.end())
        return fmt::format("write the number without a unit: {}", before.text);
    return fmt::format("write {}*{}", before.text, token.text);
}

} // namespace graftal
