#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/povray/cut.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// Receives text piece by piece, so that a scene of gigabytes never lies in memory; returns false to stop.
using TextSink = std::function<bool(std::string_view)>;

/// A picture that the scene refers to: the palette of a mesh with more colours than a colour_map holds, or
/// the texture of a material.
struct PaletteImage {
    std::string file_name; ///< beside the scene; PNG, 16 bit, linear
    int width = 0;
    int height = 0;
    std::span<const Rgb> pixels; ///< row by row, top first, of a palette of the cut; may end early
    std::string texture = {};    ///< Material::texture: then no palette; RGBA, 8 bit, alpha 0 or 1
};

struct PovrayOptions {
    std::string scene_name; ///< of the model, for comments and file names; any text (it is made harmless)
    bool include = false;   ///< `.inc`: declares the object in model coordinates, and draws nothing
    std::string file_name;  ///< of the `.inc`, for the comment that says how to use it, and its pictures
    bool progress = false;  ///< emits `#debug` marks that the driver reads as parse progress
    /// What the `.inc` declares, and what all its names begin with; "": by the model's name. Requires an
    /// is_model_identifier().
    std::string identifier = {};
};

/// What `--name` may be: letters, digits and '_', a capital first, since POV-Ray's own words have none; at
/// most 24.
bool is_model_identifier(std::string_view text);

/// Writes the scene as POV-Ray 3.7 SDL (research: povray.md): literal placements of shared meshes, grouped by
/// texture; the whole scaled so that it is about 1000 units large. Returns false if the sink stopped it.
/// `palettes` receives the pictures to write beside it, all before the sink gets its first piece.
/// Deterministic.
bool emit_povray(const Cut& cut, const View& view, const PovrayOptions& options, const TextSink& sink,
                 std::vector<PaletteImage>& palettes);

} // namespace graftal
