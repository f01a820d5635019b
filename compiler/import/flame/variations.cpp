#include "compiler/import/flame/variations.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "compiler/import/flame/parametric.h"
#include "compiler/support/number.h"

namespace graftal::flame {

namespace {

// Angles are in degrees in our functions: 57.29577951308232 of them are one radian.
const char* const degrees = "57.29577951308232";

std::string sine(const std::string& radians) {
    return fmt::format("sin({} * ({}))", degrees, radians);
}
std::string cosine(const std::string& radians) {
    return fmt::format("cos({} * ({}))", degrees, radians);
}

using Maker = std::vector<Formula> (*)(const Affine&);

const std::map<std::string_view, Maker, std::less<>>& formula_table() {
    static const std::map<std::string_view, Maker, std::less<>> table = {
        {"linear",
         [](const Affine&) {
             return std::vector<Formula>{{"u", "v"}};
         }},
        {"linear3D",
         [](const Affine&) {
             return std::vector<Formula>{{"u", "v"}};
         }},
        {"sinusoidal",
         [](const Affine&) {
             return std::vector<Formula>{{sine("u"), sine("v")}};
         }},
        {"spherical",
         [](const Affine&) {
             return std::vector<Formula>{{"u / (r2 + 1e-10)", "v / (r2 + 1e-10)"}};
         }},
        {"swirl",
         [](const Affine&) {
             return std::vector<Formula>{{fmt::format("u * {} - v * {}", sine("r2"), cosine("r2")),
                                          fmt::format("u * {} + v * {}", cosine("r2"), sine("r2"))}};
         }},
        {"horseshoe",
         [](const Affine&) {
             return std::vector<Formula>{{"(u - v) * (u + v) / (r + 1e-10)", "2 * u * v / (r + 1e-10)"}};
         }},
        {"polar",
         [](const Affine&) {
             return std::vector<Formula>{{"theta / pi", "r - 1"}};
         }},
        {"handkerchief",
         [](const Affine&) {
             return std::vector<Formula>{{"r * " + sine("theta + r"), "r * " + cosine("theta - r")}};
         }},
        {"heart",
         [](const Affine&) {
             return std::vector<Formula>{{"r * " + sine("theta * r"), "-r * " + cosine("theta * r")}};
         }},
        {"disc",
         [](const Affine&) {
             return std::vector<Formula>{
                 {"theta / pi * " + sine("pi * r"), "theta / pi * " + cosine("pi * r")}};
         }},
        {"spiral",
         [](const Affine&) {
             return std::vector<Formula>{
                 {fmt::format("({} + {}) / (r + 1e-10)", cosine("theta"), sine("r")),
                  fmt::format("({} - {}) / (r + 1e-10)", sine("theta"), cosine("r"))}};
         }},
        {"hyperbolic",
         [](const Affine&) {
             return std::vector<Formula>{{sine("theta") + " / (r + 1e-10)", "r * " + cosine("theta")}};
         }},
        {"diamond",
         [](const Affine&) {
             return std::vector<Formula>{
                 {sine("theta") + " * " + cosine("r"), cosine("theta") + " * " + sine("r")}};
         }},
        {"ex",
         [](const Affine&) {
             const std::string a = sine("theta + r") + "^3", b = cosine("theta - r") + "^3";
             return std::vector<Formula>{
                 {fmt::format("r * ({} + {})", a, b), fmt::format("r * ({} - {})", a, b)}};
         }},
        {"julia",
         [](const Affine&) {
             const std::string c = cosine("theta / 2"), s = sine("theta / 2");
             return std::vector<Formula>{{"sqrt(r) * " + c, "sqrt(r) * " + s},
                                         {"-sqrt(r) * " + c, "-sqrt(r) * " + s}};
         }},
        {"bent",
         [](const Affine&) {
             return std::vector<Formula>{
                 {"(u >= 0) * u + (u < 0) * 2 * u", "(v >= 0) * v + (v < 0) * v / 2"}};
         }},
        {"waves",
         [](const Affine& pre) {
             const std::string b = shortest(pre.linear[1][0]), e = shortest(pre.linear[1][1]);
             const std::string c2 = shortest(pre.translation.x * pre.translation.x + 1e-10);
             const std::string f2 = shortest(pre.translation.y * pre.translation.y + 1e-10);
             return std::vector<Formula>{{fmt::format("u + ({}) * {}", b, sine("v / " + c2)),
                                          fmt::format("v + ({}) * {}", e, sine("u / " + f2))}};
         }},
        {"fisheye",
         [](const Affine&) {
             return std::vector<Formula>{{"2 * v / (r + 1)", "2 * u / (r + 1)"}};
         }},
        {"popcorn",
         [](const Affine& pre) {
             const std::string c = shortest(pre.translation.x), f = shortest(pre.translation.y);
             const auto tangent = [](const char* of) { return fmt::format("tan({} * 3 * {})", degrees, of); };
             return std::vector<Formula>{{fmt::format("u + ({}) * {}", c, sine(tangent("v"))),
                                          fmt::format("v + ({}) * {}", f, sine(tangent("u")))}};
         }},
        {"exponential",
         [](const Affine&) {
             return std::vector<Formula>{
                 {"exp(u - 1) * " + cosine("pi * v"), "exp(u - 1) * " + sine("pi * v")}};
         }},
        {"power",
         [](const Affine&) {
             const std::string power = fmt::format("(r + 1e-10)^{}", sine("theta"));
             return std::vector<Formula>{{power + " * " + cosine("theta"), power + " * " + sine("theta")}};
         }},
        {"cosine",
         [](const Affine&) {
             return std::vector<Formula>{{cosine("pi * u") + " * (exp(v) + exp(-v)) / 2",
                                          "-" + sine("pi * u") + " * (exp(v) - exp(-v)) / 2"}};
         }},
        {"eyefish",
         [](const Affine&) {
             return std::vector<Formula>{{"2 * u / (r + 1)", "2 * v / (r + 1)"}};
         }},
        {"bubble",
         [](const Affine&) {
             return std::vector<Formula>{{"4 * u / (r2 + 4)", "4 * v / (r2 + 4)"}};
         }},
        {"cylinder",
         [](const Affine&) {
             return std::vector<Formula>{{sine("u"), "v"}};
         }},
        {"tangent",
         [](const Affine&) {
             return std::vector<Formula>{
                 {sine("u") + " / " + cosine("v"), fmt::format("tan({} * v)", degrees)}};
         }},
        {"hemisphere",
         [](const Affine&) {
             return std::vector<Formula>{{"u / sqrt(r2 + 1)", "v / sqrt(r2 + 1)"}};
         }},
        {"cross",
         [](const Affine&) {
             return std::vector<Formula>{{"u / (abs(u*u - v*v) + 1e-10)", "v / (abs(u*u - v*v) + 1e-10)"}};
         }},
    };
    return table;
}

} // namespace

std::vector<Formula> formulas_of(std::string_view variation, const Setting& setting) {
    const auto found = formula_table().find(variation);
    return found == formula_table().end() ? parametric_formulas(variation, setting)
                                          : found->second(setting.pre);
}

bool comes_first(std::string_view variation) {
    return variation == "pre_blur" || variation == "pre_gaussian_blur";
}

bool leaves_the_plane(std::string_view name) {
    static constexpr std::array<std::string_view, 8> names = {
        "flatten", "pre_flatten", "post_flatten", "zscale", "zcone", "ztranslate", "zblur", "pre_zscale"};
    return std::ranges::find(names, name) != names.end();
}

bool is_variation(std::string_view name) {
    return formula_table().contains(name) || is_parametric(name);
}

} // namespace graftal::flame
