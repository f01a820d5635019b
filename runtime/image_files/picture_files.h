#pragma once

#include <string>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/row_sink.h"

namespace graftal {

/// Reads pictures in files other than PNG (png_files.h) by OpenImageIO; image_files.h is the interface to
/// use. The code lies in a module that image_files.cpp loads. The function returns what went wrong, in words,
/// or "".
struct PictureFiles {
    std::string (*read)(const std::string& path, RowSink& sink);
};

/// The name under which the module exports its `const PictureFiles*`-returning function.
inline constexpr const char* picture_files_symbol = "graftal_picture_files";

} // namespace graftal
