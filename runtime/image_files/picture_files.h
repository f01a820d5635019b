#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/row_sink.h"

namespace graftal {

/// Reads pictures in files other than PNG (png_files.h), and writes GIF, by OpenImageIO; image.h is the
/// interface to use. The code lies in a module that image.cpp loads. Each function returns what went wrong,
/// in words, or "".
struct PictureFiles {
    std::string (*read)(const std::string& path, RowSink& sink);
    /// Pictures of one size as an animated GIF. `on_frame` is called before each; false gives up, with
    /// "interrupted".
    std::string (*write_gif)(const std::string& path, const std::vector<std::string>& frames,
                             int delay_hundredths, const std::function<bool(std::size_t)>& on_frame);
};

/// The name under which the module exports its `const PictureFiles*`-returning function.
inline constexpr const char* picture_files_symbol = "graftal_picture_files";

} // namespace graftal
