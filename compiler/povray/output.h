#pragma once

// POV-Ray's text, where it goes, and the files beside it.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/light/sky_picture.h"
#include "compiler/scene/light_list.h"
#include "compiler/support/tint.h"

namespace graftal {

/// Receives text piece by piece, so that a scene of gigabytes never lies in memory; returns false to stop.
using TextSink = std::function<bool(std::string_view)>;

/// A picture that the scene refers to: the palette of a mesh with more colours than a colour_map holds, the
/// texture of a material, or the sky.
struct PaletteImage {
    std::string file_name; ///< beside the scene; a palette: PNG, 16 bit, linear
    int width = 0;
    int height = 0;
    std::span<const Rgb> pixels; ///< row by row, top first, of a palette of the cut; may end early
    std::string texture = {};    ///< Material::texture: then no palette; RGBA, 8 bit, alpha 0 or 1
    std::shared_ptr<const SkyPicture> sky = {}; ///< then no palette either; EXR, times sky_brightness
    double sky_brightness = 1;
};

struct PovrayOptions {
    std::string scene_name; ///< of the model, for comments and file names; any text (it is made harmless)
    bool include = false;   ///< `.inc`: declares the object in model coordinates, and draws nothing
    std::string file_name;  ///< of the `.inc`, for the comment that says how to use it, and its pictures
    bool progress = false;  ///< emits `#debug` marks that the driver reads as parse progress
    /// Name that the `.inc` declares, with which all its names begin; "": by the model's name. Requires an
    /// is_model_identifier().
    std::string identifier = {};
    std::optional<LightListSize> lights = {}; ///< of soft light; nothing: by the view's quality
};

} // namespace graftal
