#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "compiler/session/stage_options.h"

namespace graftal {

/// A page's model and view: the message `state` (docs/studio.md), understood.
struct StudioState {
    std::uint32_t number = 0;
    std::string name;                ///< of the model's file
    std::optional<std::string> text; ///< nothing: the one before
    /// Texts of files that came with a link, by their normalised paths: they lie over those of the home.
    std::map<std::string, std::string> files;
    StageOptions stages;
    std::string engine = "native"; ///< "": of files that nobody draws
    int threads = 0;
    std::string at, zoom;                 ///< as they were written; "" for none
    std::optional<nlohmann::json> camera; ///< likewise
    std::optional<nlohmann::json> film;   ///< whose view it has
};

/// Pixels that a picture of the page may have, and along a side.
inline constexpr std::int64_t most_page_pixels = std::int64_t{1} << 23;
inline constexpr int most_page_side = 16384;
/// Steps of a state, and of a film.
inline constexpr std::uint64_t most_steps = 4'000'000'000;

/// Reads the fields `camera`, `at` and `zoom`. Throw BadMessage.
CameraOverride read_camera(const nlohmann::json& camera);
ZoomRequest read_zoom(const std::string& at, const std::string& factor);

/// Reads a message. `has_number`: it is no thumbnail's. Throws BadMessage.
StudioState read_state(const nlohmann::json& message, bool has_number);

} // namespace graftal
