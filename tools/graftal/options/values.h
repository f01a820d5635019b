#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/scene/scene.h"
#include "compiler/zoom/magnification.h"
#include "runtime/trace/tile.h"

namespace graftal {

// Meaning of the command line's values. Each returns nothing for a text that is malformed or out of range.

/// "1280x720"; each side 1..32768, at most 2^28 pixels.
std::optional<ImageSize> parse_size(std::string_view text);
/// The size of a picture that is drawn in parts: each side 1..131072.
std::optional<ImageSize> parse_large_size(std::string_view text);
/// Whether parse_size() takes it.
bool is_drawn_at_once(ImageSize size);

/// "X,Y,WxH": a part of a picture, the place of its top left pixel and its size, which parse_size() takes.
std::optional<Tile> parse_tile(std::string_view text);

/// "2G", "500M", "64K" (powers of 1024) or a plain number of bytes.
std::optional<std::uint64_t> parse_bytes(std::string_view text);

/// "0.5": a finite number, at least `least`.
std::optional<double> parse_at_least(std::string_view text, double least);

/// A number in [0, 1].
std::optional<double> parse_share(std::string_view text);

/// A whole number in [least, most].
std::optional<std::uint64_t> parse_whole(std::string_view text, std::uint64_t least, std::uint64_t most);

/// A depth: whole steps, or a time between two.
struct StepsValue {
    std::optional<std::uint64_t> whole; ///< if it is a whole number
    double time = 0;
};

/// "7" or "7.3", from 0 to `most`.
std::optional<StepsValue> parse_steps(std::string_view text, std::uint64_t most);

/// "X,Y,Z": three finite numbers.
std::optional<Vec3> parse_vector(std::string_view text);

/// Magnification::parse() of values no smaller than a model may be.
std::optional<Magnification> parse_zoom(std::string_view text);
/// The values that parse_zoom() takes, in words.
inline constexpr const char* zoom_values = "a number of at least 1e-100, such as 1e100 or 2^330";

/// "NAME=VALUE" with a finite number.
std::optional<std::pair<std::string, double>> parse_setting(std::string_view text);

/// The first setting of the text, which loses it; nothing if only blanks are left. Settings stand apart by
/// blanks, or by a comma before a name.
std::optional<std::string_view> take_setting(std::string_view& text);

/// Adds words such as "location=1,2,3 look_at=0,0,0 up=0,1,0 angle=40 orthographic width=3" to the camera;
/// returns what is wrong with them, or "".
std::string parse_camera(std::string_view text, CameraOverride& camera);

} // namespace graftal
