#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/row_sink.h"

namespace graftal {

// PNG files, by libpng; image.h is the interface to use. Readers and writers return what went wrong, in
// words, or "".
//
// OpenImageIO could write them too, but to load it costs more than a small picture: `render pound_sign.rifs
// --engine native --steps 2 --size 64x36 --threads 1` took 0.035 s of the processor and 9 MiB by libpng, and
// 0.40 s and 135 MiB with an EXR by OpenImageIO (the median of three).

/// Whether the file begins as a PNG does, whatever its name; nothing, with errno, where it cannot be read.
std::optional<bool> is_png_file(const std::string& path);

/// Reads a PNG of any kind. An interlaced one is held whole on the way and must have less than 256 MiB.
std::string read_png(const std::string& path, RowSink& sink);

/// Samples are clamped to [0, 1] and rounded to the nearest level, halves up; NaN becomes 0. Requires one to
/// four channels.
std::string write_png(const std::string& path, const Image& image, SampleFormat format,
                      const ImageMetadata& metadata);

/// Writes a PNG of rows that come one after the other.
std::string write_png_rows(const std::string& path, const RowShape& shape, RowSource& rows,
                           SampleFormat format, const ImageMetadata& metadata);

/// 16-bit RGB of linear values, not compressed: as quick to write as it can be. Requires the levels of all
/// pixels.
std::string write_png_levels(const std::string& path, int width, int height,
                             std::span<const std::uint16_t> levels);

} // namespace graftal
