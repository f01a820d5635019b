#pragma once

#include <cstddef>

#include "runtime/image/distance_transform.h"
#include "runtime/inverse/plane_map.h"

namespace graftal {

inline constexpr int most_read_cells_a_side = 1024;   ///< of the whole picture
inline constexpr std::size_t least_target_cells = 24; ///< that tell anything of maps

/// A picture's set of cells, its sizes in pixels.
struct PictureCells {
    int width = 0;
    int height = 0;
    int pixels_per_cell = 1; ///< along a side
};

/// The box around a set, in cells of `size` cells each.
struct Crop {
    CellSet set{0, 0};
    int left = 0, top = 0, size = 1;
};

/// The crop of at most 256 cells a side. Requires a set that is not empty.
Crop cropped(const CellSet& whole);

/// The frame of found models: the picture is one unit wide, its lower left corner is <0, 0>, and y points up.
/// model = scale * cell + origin, for the cells of a target's grid.
class TargetFrame {
  public:
    /// `room`: of the target of the crop (Target::room()).
    TargetFrame(const PictureCells& picture, const Crop& crop, int room);

    double scale() const { return scale_; } ///< of a cell, in units of the model
    PlaneMap in_model(const PlaneMap& map) const;
    PlaneMap in_cells(const PlaneMap& map) const;

  private:
    double scale_ = 1;
    Vec2 origin_{0.0};
};

} // namespace graftal
