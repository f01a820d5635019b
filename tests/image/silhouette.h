#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/povray/cut/compile.h"
#include "runtime/image/image.h"

namespace graftal {

/// Which pixels of a picture show anything of the model.
struct Silhouette {
    int width = 0;
    int height = 0;
    std::vector<bool> hit;

    bool at(int x, int y) const {
        return hit[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x)];
    }
};

/// Draws the model as it was cut, `magnification` times as large each way: the whole picture, or what a
/// window of so many pixels shows of its middle.
Silhouette silhouette_of(CompiledModel model, int magnification, std::optional<ImageSize> window = {});

struct SilhouetteDifference {
    std::size_t differing = 0; ///< pixels hit in one of the two
    std::size_t hit = 0;       ///< in the first
    double distance = 0;       ///< Hausdorff distance of the two, in pixels
};

/// Requires equal sizes. A distance of `reach` stands for all that are larger.
SilhouetteDifference compare_silhouettes(const Silhouette& a, const Silhouette& b, int reach = 24);

} // namespace graftal
