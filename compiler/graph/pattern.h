#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/tint.h"

namespace graftal {

/// Kinds of solid patterns, in the order of trace/shade/patterns.glsl.
enum class PatternKind : std::uint8_t {
    noise,  ///< soft hills
    ridges, ///< noise, folded to crests
    cells,  ///< plates between cracks
    bands,  ///< layers across the y axis
    rings,  ///< cylinders about the y axis
};

/// Words of the kinds in models, by number.
std::span<const std::string_view> pattern_words();

/// One pattern of a solid: octaves of waves whose lengths are whole powers of two.
struct PatternLayer {
    PatternKind kind = PatternKind::noise;
    double scale = 0.5; ///< longest wave; of the part's size, or of the world
    bool of_world = false;
    Vec3 stretch{1.0}; ///< factors of the lengths along x, y and z
    unsigned octaves = 4;
    double warp = 0;  ///< how far places are moved before they are looked up, in halves of the scale
    double share = 1; ///< those before it have the rest; of the first 1
    bool operator==(const PatternLayer&) const = default;
};

/// A solid pattern, which runs through space: what it makes of a material's colour and relief. Its value lies
/// in [0, 1], and is 1/2 on the whole, where the material shows its own colour.
struct SolidPattern {
    std::vector<PatternLayer> layers; ///< none: no pattern
    Rgb low{0.0}, high{0.0};          ///< colours of 0 and of 1
    double bump = 0;                  ///< steepness of the relief
    bool operator==(const SolidPattern&) const = default;

    /// Waves of all layers, about: the cost of a look at it.
    unsigned waves() const;
    explicit operator bool() const { return !layers.empty(); }
    static constexpr unsigned most_octaves = 10;
    static constexpr std::size_t most_layers = 4;
};

/// Waves of one level, whose lengths are about 2^-level: wave vectors in that unit, and phases. Those of the
/// noise come first, then those that warp, of unit length. Levels 16 apart have the same.
struct PatternWave {
    Vec3 direction;
    double phase;
};
inline constexpr int pattern_levels = 16, pattern_noise_waves = 8, pattern_waves = pattern_noise_waves + 9;
const std::array<std::array<PatternWave, pattern_waves>, pattern_levels>& pattern_table();

/// A part's size (primitives/part_size.h) rounded to half powers of two, so that few parts of a branch
/// differ.
double pattern_size(double part_size);

/// The longest wave of a layer on a part of that size.
double wavelength_of(const PatternLayer& layer, double size);

/// The colour that a value has; `rgb` is that of 1/2.
Rgb pattern_colour(const SolidPattern& pattern, Rgb rgb, double value);

/// Depth of a relief of bump 1, as a share of its longest wave.
inline constexpr double relief_depth = 0.06;

} // namespace graftal
