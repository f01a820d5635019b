#pragma once

#include <limits>
#include <string>
#include <vector>

#include "compiler/support/status.h"
#include "compiler/support/tint.h"
#include "runtime/image/distance_transform.h"

namespace graftal {

/// Which pixels of a picture are a target set.
struct TargetCriterion {
    /// A stored value: darker pixels belong to the set; in a picture with an alpha below 1 anywhere, pixels
    /// of at least this alpha.
    double threshold = 0.5;
    bool light = false; ///< the lighter pixels do
};

/// A picture as a set of cells: squares of pixels that hold a pixel of the set.
struct TargetPicture {
    int width = 0; ///< of the picture, in pixels
    int height = 0;
    int pixels_per_cell = 1; ///< along a side
    CellSet cells{0, 0};
    std::vector<Rgb> colours;  ///< sums of linear light over the pixels of the set in each cell
    std::vector<float> pixels; ///< and their numbers; both empty unless they were asked for
    bool by_alpha = false;

    bool empty() const;
};

/// Reads a picture row by row, into at most so many cells a side: memory goes with the cells. `in_colour`:
/// with the colours of the set.
Status read_target(const std::string& path, const TargetCriterion& criterion, TargetPicture& target,
                   int most_cells_a_side = std::numeric_limits<int>::max(), bool in_colour = false);

/// "lighter than 0.5", and so on.
std::string criterion_text(const TargetCriterion& criterion, bool by_alpha);
/// The message for a target without a pixel.
std::string empty_target_text(const std::string& path, const TargetCriterion& criterion, bool by_alpha);

} // namespace graftal
