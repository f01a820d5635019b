#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/povray/cut/compile.h"
#include "runtime/image/image.h"

namespace graftal {

/// What an engine shows of a model through the middle of each pixel.
struct Shown {
    std::vector<bool> hit;     ///< the model, the ground left out
    std::vector<double> depth; ///< of it, along the camera's axis, in scene units; where nothing is hit, 0
    Image lit;                 ///< linear light, as the file of 16 bits has it: ground, sky and all
};

/// Pixels on which two engines disagree.
struct Disagreement {
    std::size_t pixels = 0;
    /// Those of them that one engine holds to be within or outside with all eight neighbours.
    std::size_t away = 0;
    /// Those that are no ties: the native engine does not say what POV-Ray says anywhere within a thousandth
    /// of a pixel.
    std::size_t untied = 0;
    /// Those of these where parts of several colours lie one in the other.
    std::size_t coinciding = 0;
    std::vector<std::array<int, 2>> examples = {}; ///< the first that are left
};

/// How POV-Ray's picture and the native engine's differ. Colours are compared as sRGB encodes them.
struct OracleReport {
    double error_px = 0;          ///< of both; coarser than asked for where POV-Ray's memory does not suffice
    double error_world = 0;       ///< in place of error_px, where that stays 0
    std::uint64_t placements = 0; ///< in POV-Ray
    std::uint64_t triangles = 0;  ///< of meshes
    std::size_t pixels = 0;
    std::size_t hits = 0; ///< by POV-Ray
    Disagreement mask;    ///< hit by one of the two
    Disagreement depth;   ///< hit by both, and farther apart than POV-Ray's picture of depths resolves
    Disagreement colour;  ///< hit or missed by both, some channel more than one 255th apart
    std::size_t horizon =
        0; ///< others, where POV-Ray's ground ends earlier or later (ShaderLimits::farthest)
    double mean = 0, max = 0; ///< of the colours' differences but those, in 255ths
    Shown povray, native;
};

/// What is asked.
struct OracleOptions {
    bool flatten = true;                     ///< else POV-Ray draws meshes, which come near the parts only
    bool lit = true;                         ///< compare colours too
    std::uint64_t memory_bytes = 1ull << 30; ///< for POV-Ray
    int threads = 0;
};

/// A model that is looked at, with the detail that both engines draw.
struct DetailedModel {
    std::shared_ptr<const ViewedModel> viewed;
    DetailOptions detail; ///< resolved() for the view
};

/// The model in a file as it is to be drawn; nothing viewed if it cannot be, why is in the compilation.
DetailedModel look_at_file(const std::string& path, const StageOptions& options, Compilation& compilation);

/// What POV-Ray shows of `theirs` against what the native engine shows of `ours`, of one size. Nothing if an
/// engine failed.
std::optional<OracleReport> ask_oracle(const CompiledModel& theirs, const DetailedModel& ours,
                                       const OracleOptions& options, Status& status);

/// Draws a model by both engines. Where POV-Ray's memory asks for a coarser error, both draw with that.
/// Nothing if the model cannot be compared; why is in `compilation`.
std::optional<OracleReport> ask_oracle(DetailedModel model, const OracleOptions& options,
                                       Compilation& compilation);

/// ask_oracle() of a model file.
std::optional<OracleReport> ask_oracle(const std::string& path, const StageOptions& compile,
                                       const OracleOptions& options, Compilation& compilation);

/// One line for people: the counts of the report.
std::string summary(const OracleReport& report);

} // namespace graftal
