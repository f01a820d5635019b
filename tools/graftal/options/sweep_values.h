#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/image_files/animation.h"
#include "runtime/render/sweep.h"

namespace graftal {

// Values of `animate` besides values.h: they run from one to another, "A..B".

/// The two sides of "A..B"; nothing where there is no "..".
std::optional<std::pair<std::string, std::string>> parse_range(std::string_view text);

/// "1..12": the depth, in whole numbers up to `most`.
std::optional<Sweep> parse_steps_sweep(std::string_view text, std::uint64_t most);
std::optional<Sweep> parse_seed_sweep(std::string_view text);

/// "NAME=A..B": the value of a `let`; "NAME=A..B:STEP" runs in steps, each for an equal time.
/// "NAME=A..B@0.3..C" runs from one to the next, and has come to B after that share of the time; without it
/// they lie evenly.
std::optional<Sweep> parse_setting_sweep(std::string_view text);

/// "1..1e30": a zoom by equal factors in equal times.
std::optional<Sweep> parse_zoom_sweep(std::string_view text);

/// The camera's words as parse_camera takes them, any number or vector of which may be "A..B". A width, which
/// is a magnification, runs by equal factors, all else by equal steps. Returns what is wrong, or "".
std::string parse_camera_sweeps(std::string_view text, CameraOverride& camera, std::vector<Sweep>& sweeps);

/// "25", "29.97": frames a second, 0.01 to 240.
std::optional<FrameRate> parse_frame_rate(std::string_view text);

/// An angle in degrees, at most a hundred turns either way.
std::optional<double> parse_turn(std::string_view text);

} // namespace graftal
