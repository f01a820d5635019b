#include "compiler/syntax/everyday_words.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

constexpr std::string_view flat_cylinder = "'cylinder', and flatten it: 'scale: 1, 0.05, 1'";
constexpr std::string_view flat_cube = "'cube', and flatten it: 'scale: 1, 1, 0.05'";
constexpr std::string_view thin_cylinder = "'cylinder', and make it thin: 'scale: 0.1, 1, 0.1'";
constexpr std::string_view file_of_mesh = "'mesh \"FILE.obj\"'";
constexpr std::string_view swept = "'sphere_sweep(...)': a ball along points";

constexpr EverydayWord shapes[] = {
    {"box", "cube", "'cube'"},
    {"block", "cube", "'cube'"},
    {"brick", "cube", "'cube'"},
    {"cuboid", "cube", "'cube'"},
    {"ball", "sphere", "'sphere'"},
    {"globe", "sphere", "'sphere'"},
    {"bubble", "sphere", "'sphere'"},
    {"ellipsoid", "sphere", "'sphere', and stretch it by 'scale: 1, 2, 1'"},
    {"tube", "cylinder", "'cylinder'"},
    {"pipe", "cylinder", "'cylinder'"},
    {"column", "cylinder", "'cylinder'"},
    {"rod", "cylinder", thin_cylinder},
    {"stick", "cylinder", thin_cylinder},
    {"pole", "cylinder", thin_cylinder},
    {"line", "cylinder", thin_cylinder},
    {"disk", "cylinder", flat_cylinder},
    {"disc", "cylinder", flat_cylinder},
    {"circle", "cylinder", flat_cylinder},
    {"plate", "cylinder", flat_cylinder},
    {"coin", "cylinder", flat_cylinder},
    {"square", "cube", flat_cube},
    {"rectangle", "cube", flat_cube},
    {"rect", "cube", flat_cube},
    {"quad", "cube", flat_cube},
    {"tile", "cube", flat_cube},
    {"spike", "cone", "'cone'"},
    {"ring", "torus", "'torus'"},
    {"donut", "torus", "'torus'"},
    {"doughnut", "torus", "'torus'"},
    {"floor", "plane", "'plane'"},
    {"capsule", "sphere_sweep", swept},
    {"spline", "sphere_sweep", swept},
    {"curve", "sphere_sweep", swept},
    {"obj", "mesh", file_of_mesh},
    {"model", "mesh", file_of_mesh},
};

constexpr std::string_view move = "'translate: 1, 0, 0'";
constexpr std::string_view resize = "'scale: 2', or 'scale: 1, 2, 1' for each axis";
constexpr std::string_view turn = "'rotate: y, 30': an axis, then the degrees";

constexpr EverydayWord lines[] = {
    {"move", "translate", move},
    {"moveto", "translate", move},
    {"shift", "translate", move},
    {"offset", "translate", move},
    {"place", "translate", move},
    {"pos", "translate", move},
    {"position", "translate", move},
    {"location", "translate", move},
    {"translation", "translate", move},
    {"size", "scale", resize},
    {"resize", "scale", resize},
    {"grow", "scale", resize},
    {"shrink", "scale", resize},
    {"stretch", "scale", resize},
    {"scaling", "scale", resize},
    {"turn", "rotate", turn},
    {"spin", "rotate", turn},
    {"roll", "rotate", turn},
    {"rotation", "rotate", turn},
    {"rotatex", "rotate", "'rotate: x, 30': an axis, then the degrees"},
    {"rotatey", "rotate", turn},
    {"rotatez", "rotate", "'rotate: z, 30': an axis, then the degrees"},
    {"color", "tint", "'tint: r, g, b, alpha' or 'material: NAME'"},
    {"colour", "tint", "'tint: r, g, b, alpha' or 'material: NAME'"},
};

std::string hint_of(std::span<const EverydayWord> words, std::string_view word) {
    const auto found = std::ranges::find(words, in_small_letters(word), &EverydayWord::word);
    return found == words.end() ? std::string() : fmt::format("write {}", found->how);
}

} // namespace

std::span<const EverydayWord> everyday_shape_words() {
    return shapes;
}

std::span<const EverydayWord> everyday_line_words() {
    return lines;
}

std::string shape_word_hint(std::string_view word) {
    return hint_of(shapes, word);
}

std::string line_word_hint(std::string_view word) {
    return hint_of(lines, word);
}

} // namespace graftal
