#pragma once

#include <cstdint>
#include <string>

#include "compiler/light/sky_picture.h"
#include "compiler/support/status.h"
#include "runtime/system/file.h"

namespace graftal {

/// Reads the sky in a picture's file, reduced to `most_texels` at most, and most_sky_columns across and
/// down. Samples of EXR and HDR files are linear, all others sRGB; alpha does not count. Samples that are no
/// light are mended and counted: negative ones and those that are no numbers become 0, larger ones
/// most_radiance. Requires most_texels > 0.
Status read_sky_picture(const std::string& path, std::uint64_t most_texels, LoadedSkyPicture& loaded);

/// Writes it times a factor as POV-Ray is to read it: EXR, which POV-Ray takes in half precision, so that no
/// light is above 65504. A low picture is written with more rows, and the same light between them: POV-Ray
/// mixes the two poles within half a row. Does not commit.
Status write_sky_picture(const PendingFile& pending, const SkyPicture& picture, double factor);

} // namespace graftal
