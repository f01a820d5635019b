#include "compiler/syntax/everyday_words.h"

#include <algorithm>
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

} // namespace graftal
