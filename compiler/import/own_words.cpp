#include "compiler/import/own_words.h"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"

namespace graftal {

bool is_own_word(std::string_view word) {
    static const std::set<std::string_view, std::less<>> words = {"triangle",
                                                                  "sphere",
                                                                  "cube",
                                                                  "plane",
                                                                  "cylinder",
                                                                  "cone",
                                                                  "torus",
                                                                  "frustum",
                                                                  "superellipsoid",
                                                                  "polygon",
                                                                  "bicubic_patch",
                                                                  "sphere_sweep",
                                                                  "limb_sweep",
                                                                  "mesh",
                                                                  "union",
                                                                  "intersection",
                                                                  "difference",
                                                                  "instance",
                                                                  "terminal",
                                                                  "scatter",
                                                                  "below",
                                                                  "object",
                                                                  "canonical",
                                                                  "repeat",
                                                                  "hue",
                                                                  "ink",
                                                                  "when",
                                                                  "else",
                                                                  "nothing",
                                                                  "tint",
                                                                  "material",
                                                                  "chance",
                                                                  "scale",
                                                                  "rotate",
                                                                  "translate",
                                                                  "shear",
                                                                  "matrix",
                                                                  "projection",
                                                                  "use",
                                                                  "let",
                                                                  "inner",
                                                                  "camera",
                                                                  "light",
                                                                  "sky",
                                                                  "haze",
                                                                  "film",
                                                                  "background",
                                                                  "ground",
                                                                  "steps",
                                                                  "count",
                                                                  "over",
                                                                  "except",
                                                                  "by",
                                                                  "apart",
                                                                  "seed",
                                                                  "turn",
                                                                  "lean",
                                                                  "size",
                                                                  "weights",
                                                                  "weight",
                                                                  "x",
                                                                  "y",
                                                                  "z",
                                                                  "n",
                                                                  "pi",
                                                                  "rgb",
                                                                  "hsv",
                                                                  "to",
                                                                  "saturation",
                                                                  "value",
                                                                  "alpha",
                                                                  "sin",
                                                                  "cos",
                                                                  "tan",
                                                                  "asin",
                                                                  "acos",
                                                                  "atan",
                                                                  "atan2",
                                                                  "sqrt",
                                                                  "exp",
                                                                  "log",
                                                                  "floor",
                                                                  "ceil",
                                                                  "abs",
                                                                  "sign",
                                                                  "min",
                                                                  "max",
                                                                  "mod",
                                                                  "pow",
                                                                  "lerp",
                                                                  "smooth",
                                                                  "logistic",
                                                                  "random",
                                                                  "normal",
                                                                  "left"};
    return words.contains(word);
}

std::string free_own_name(std::string_view wanted, std::string_view suffix, std::set<std::string>& taken) {
    std::string name = plain_name(wanted);
    if (is_own_word(name)) name += suffix;
    std::string free = name;
    for (std::size_t i = 2; !taken.insert(free).second; ++i) {
        if (i == 50) i = std::max(i, taken.size()); // a file of one name only must not take long
        free = fmt::format("{}_{}", name, i);
    }
    return free;
}

} // namespace graftal
