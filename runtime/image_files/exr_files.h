#pragma once

#include <cstdint>
#include <string>

#include "runtime/image_files/image_files.h"

namespace graftal {

/// Writes OpenEXR files of 32-bit floats, in scan lines that ZIP compresses sixteen at a time, by OpenEXR's
/// core library; image.h is the interface to use. The bytes depend on the arguments only. Both return what
/// went wrong, in words, or "".
std::string write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata,
                      const MoreChannels* more);
/// write_exr() of rows that come one after the other: the same file.
std::string write_exr_rows(const std::string& path, const RowShape& shape, RowSource& rows,
                           const ImageMetadata& metadata);

/// Reads what POV-Ray leaves: scan lines of red, green and blue, alpha or not, not larger than
/// `most_samples`. False for all else, which read_image() of image.h may know. For files that a program of
/// ours made just now: a damaged one is better read by OpenEXR's larger library.
bool read_povray_exr(const std::string& path, std::uint64_t most_samples, Image& image);

} // namespace graftal
