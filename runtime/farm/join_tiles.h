#pragma once

#include <functional>

#include "compiler/support/control.h"
#include "runtime/farm/job.h"
#include "runtime/image_files/image_files.h"

namespace graftal {

/// Bytes of memory for a row of tiles while it is joined.
std::uint64_t band_bytes(ImageSize size, int tile_height);

/// The most that band_bytes() may be of a job.
inline constexpr std::uint64_t most_band_bytes = 192u << 20;

/// Joins the parts of a job of tiles: the bytes of the file that one run would have written. Holds one row of
/// tiles at a time, whatever the picture's size. `on_rows` hears how many rows of pixels are done. A raised
/// flag ends it: "interrupted".
Status join_tiles(const JobFolder& folder, const Job& job, SampleFormat format, const ImageMetadata& metadata,
                  const CancelFlag& cancel, const std::function<void(int rows)>& on_rows = {});

} // namespace graftal
