#include "compiler/povray/emit/patterns.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr int digits = 12;

std::string text_of(double value) {
    std::string text;
    append_number(text, value, digits);
    return value < 0 ? "(" + text + ")" : text;
}

const PatternWave& wave_of(int level, int number) {
    const int of_table = ((level % pattern_levels) + pattern_levels) % pattern_levels;
    return pattern_table()[static_cast<std::size_t>(of_table)][static_cast<std::size_t>(number)];
}

double frequency_of(int level) {
    return 2 * std::numbers::pi * std::exp2(level);
}

/// The angle of a wave at x, y and z, times a factor.
std::string angle(int level, int number, double factor = 1) {
    const PatternWave& wave = wave_of(level, number);
    const Vec3 f = factor * frequency_of(level) * wave.direction;
    return fmt::format("{}*x+{}*y+{}*z+{}", text_of(f.x), text_of(f.y), text_of(f.z),
                       text_of(factor * wave.phase));
}

/// Waves of a level from `first` on, added up and scaled.
std::string waves(int level, int first, int count, double scale) {
    std::string sum;
    for (int i = first; i < first + count; ++i)
        sum += fmt::format("{}cos({})", i > first ? "+" : "", angle(level, i));
    return fmt::format("{}*({})", text_of(scale), sum);
}

std::string octave(PatternKind kind, int level) {
    const double root2 = std::numbers::sqrt2;
    switch (kind) {
    case PatternKind::noise:
        return waves(level, 0, pattern_noise_waves, 0.5);
    case PatternKind::ridges:
        return fmt::format("1.6*(0.8-abs({}))", waves(level, 0, pattern_noise_waves, 0.5));
    case PatternKind::cells: {
        std::string nearest;
        for (int i = 0; i < 4; ++i)
            nearest += fmt::format("{}abs(sin({}))", i > 0 ? "," : "", angle(level, i, 0.5));
        return fmt::format("3*(0.45-0.2/(0.2+min({})))", nearest);
    }
    case PatternKind::bands:
        return fmt::format("{}*cos({}*y)", text_of(root2), text_of(frequency_of(level)));
    case PatternKind::rings:
        return fmt::format("{}*cos({}*sqrt(x*x+z*z))", text_of(root2), text_of(frequency_of(level)));
    }
    return {};
}

/// The level before the longest wave, and how much of it is left.
std::pair<int, double> first_level(double wavelength) {
    const double exact = -std::log2(wavelength), whole = std::floor(exact);
    return {static_cast<int>(whole), 1 - (exact - whole)};
}

} // namespace

std::string PovrayPatterns::declared(const std::string& body) {
    std::string& name = names_[body];
    if (!name.empty()) return name;
    name = fmt::format("{}W_{}", prefix_, names_.size());
    declarations_ += fmt::format("#declare {} = function(x,y,z) {{ {} }}\n", name, body);
    return name;
}

std::string PovrayPatterns::layer(const PatternLayer& layer, double wavelength) {
    const auto [first, left] = first_level(wavelength);
    std::string sum;
    double power = 0;
    for (int i = 0; i <= static_cast<int>(layer.octaves); ++i) {
        const double depth = i - (1 - left);
        double weight = depth < 0 ? left : std::exp2(-depth);
        if (i == static_cast<int>(layer.octaves)) weight *= 1 - left;
        power += weight * weight;
        if (!(weight > 0)) continue;
        sum += fmt::format("{}{}*{}(x,y,z)", sum.empty() ? "" : "+", text_of(weight),
                           declared(octave(layer.kind, first + i)));
    }
    std::string at = declared(fmt::format("{}*({})", text_of(1 / std::sqrt(power)), sum));
    if (layer.warp > 0) {
        const auto [before, share] = first_level(2 * wavelength);
        const double reach = 0.4 * layer.warp * wavelength;
        std::string moved;
        for (int axis = 0; axis < 3; ++axis) {
            std::string coordinate = axis == 0 ? "x" : axis == 1 ? "y" : "z";
            for (int i = 0; i < 2; ++i)
                coordinate += "+" + waves(before + i, pattern_noise_waves + 3 * axis, 3,
                                          reach * (i == 0 ? share : 1 - share));
            moved += (axis > 0 ? "," : "") + declared(coordinate) + "(x,y,z)";
        }
        at = declared(fmt::format("{}({})", at, moved));
    }
    const std::string squashed = declared("0.5+0.5*x/sqrt(1+x*x)");
    return declared(fmt::format("{}({}(x/{},y/{},z/{}),0,0)", squashed, at, text_of(layer.stretch.x),
                                text_of(layer.stretch.y), text_of(layer.stretch.z)));
}

std::string PovrayPatterns::at_place(const std::string& name) const {
    const double scale = 1 / units_.scale;
    return fmt::format("{}({}*x+{},{}*y+{},{}*z+{})", name, text_of(scale), text_of(units_.origin.x),
                       text_of(scale), text_of(units_.origin.y), text_of(scale), text_of(units_.origin.z));
}

std::string PovrayPatterns::value(const SolidPattern& pattern, double size) {
    std::string sum;
    for (const PatternLayer& of : pattern.layers) {
        const std::string own = layer(of, wavelength_of(of, size)) + "(x,y,z)";
        sum = sum.empty() ? own
                          : fmt::format("{}*({})+{}*{}", text_of(1 - of.share), sum, text_of(of.share), own);
    }
    return at_place(declared(sum));
}

std::string PovrayPatterns::relief(const SolidPattern& pattern, double size) {
    if (pattern.bump == 0) return {};
    // A function between 0 and 1, as POV-Ray wants it, of the heights of all layers.
    double deepest = 0, finest = INFINITY;
    for (const PatternLayer& of : pattern.layers) {
        const double wavelength = wavelength_of(of, size);
        deepest = std::max(deepest, wavelength);
        const double shrink = std::min({of.stretch.x, of.stretch.y, of.stretch.z});
        finest = std::min(finest, shrink * wavelength * std::exp2(-static_cast<double>(of.octaves)));
    }
    std::string sum;
    for (const PatternLayer& of : pattern.layers) {
        const double wavelength = wavelength_of(of, size);
        const std::string own =
            fmt::format("{}*{}(x,y,z)", text_of(wavelength / deepest), layer(of, wavelength));
        sum = sum.empty() ? own
                          : fmt::format("{}*({})+{}*{}", text_of(1 - of.share), sum, text_of(of.share), own);
    }
    // POV-Ray's normal is n - (4/3) 0.1 amount * gradient (normal.cpp: Perturb_Normal), in its own units.
    const double amount = pattern.bump * relief_depth * deepest * units_.scale / (0.1 * 4 / 3);
    return fmt::format(" normal {{ function {{ {} }} {} accuracy {} }}", at_place(declared(sum)),
                       text_of(amount), text_of(finest * units_.scale / 16));
}

} // namespace graftal
