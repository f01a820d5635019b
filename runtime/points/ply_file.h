#pragma once

#include <cstdint>
#include <string>

#include "compiler/support/status.h"
#include "runtime/image_files/image_files.h"
#include "runtime/points/point_source.h"

namespace graftal {

/// A point as a cloud has it.
struct CloudPoint {
    float place[3];
    std::uint8_t rgb[3]; ///< sRGB
};

/// `rgb`: linear.
CloudPoint cloud_point(Vec3 place, Rgb rgb);

/// Writes points as `.ply`: binary, little-endian, x y z as 32-bit floats and red green blue as bytes (sRGB),
/// 15 bytes a point, whole or not at all. Fails before the first point if the disk has no room for all.
/// `coloured` gives a point's colour, linear. "interrupted" if the work is cancelled.
Status write_ply(const std::string& path, const PointSource& source, const PointWork& work,
                 const ImageMetadata& metadata, const std::function<Rgb(const ChaosPoint&)>& coloured);

} // namespace graftal
