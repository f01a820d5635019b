#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "compiler/support/control.h"
#include "compiler/support/status.h"
#include "runtime/image_files/animation.h"
#include "runtime/render/frame_store.h"

namespace graftal {

/// Fails, with advice, if the program that makes videos is not installed.
Status video_available();

/// Frames -> `.mp4` (H.264) or `.webm` (VP9), whole or not at all, by the program ffmpeg. Requires frames of
/// even width and height, which is what both formats have. A raised flag ends it: "interrupted". `on_done`
/// hears of how many frames are done, now and then.
Status write_video(const std::string& path, const FrameStore& frames, FrameRate rate,
                   const CancelFlag& cancel = {}, const std::function<void(std::size_t done)>& on_done = {});

} // namespace graftal
