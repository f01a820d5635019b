#pragma once

#include <optional>
#include <string>

#include "tests/image/drawing.h"

namespace graftal {

/// One model as a cut of two levels and as its absolute specification, where each part is spelled out in its
/// place (Hart 1992, section 2).
struct TwoWays {
    CompiledModel cut;
    CompiledModel flat;
};

/// What the pictures of both ways have to say.
struct Agreement {
    ImageDifference lit;     ///< 8 bit, in the model's own light
    ImageDifference pigment; ///< 16 bit, surfaces showing their pigments
    double covered = 0;      ///< share_covered()
};

/// Nothing, and a failed test, if one way has no scene, or if they are not two ways: the cut must share
/// meshes, the absolute specification none.
std::optional<TwoWays> two_ways_of_file(const std::string& path, const StageOptions& options);
std::optional<TwoWays> two_ways_of_text(const std::string& name, const std::string& text,
                                        const StageOptions& options);

/// Draws both ways, in both looks.
Agreement agreement_of(TwoWays ways);

/// Draws both ways; the pigments alone.
ImageDifference pigment_agreement_of(TwoWays ways, double* covered = nullptr);

/// The last bit of a 16-bit sample: where tints are composed in another order, or read from another palette,
/// the same colour may round to either side.
inline constexpr double last_bit = 1.001 / 65535;

} // namespace graftal
