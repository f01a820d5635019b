#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compiler/support/status.h"

namespace graftal {

/// Frames a second, in hundredths: what both PNG and video can say exactly.
struct FrameRate {
    int hundredths = 2500;

    double per_second() const { return hundredths / 100.0; }
};

/// The fastest that viewers of GIF show: quicker frames are slowed down by them.
inline constexpr FrameRate fastest_gif{5000};

/// Called before each frame is added; false gives up.
using OnFrame = std::function<bool(std::size_t frame)>;

// Both write pictures of one size and kind as one animation that repeats for ever, whole or not at all.
// Frames are PNG files. Giving up is a failure "interrupted".

/// Animated PNG: the frames' own compressed pixels, so that nothing is lost or changed.
Status write_animated_png(const std::string& path, const std::vector<std::string>& frames, FrameRate rate,
                          const OnFrame& on_frame);

/// GIF, by giflib: 255 colours for all frames (gif_palette.h). A frame lasts a whole number of hundredths of
/// a second.
Status write_gif(const std::string& path, const std::vector<std::string>& frames, FrameRate rate,
                 const OnFrame& on_frame);

} // namespace graftal
