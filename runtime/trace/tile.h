#pragma once

#include <algorithm>
#include <cstdint>

#include "compiler/scene/scene.h"

namespace graftal {

/// A rectangle of pixels.
struct Tile {
    int x = 0, y = 0, width = 0, height = 0;

    std::uint64_t pixels() const {
        return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    }
    bool lies_in(ImageSize size) const {
        return x >= 0 && y >= 0 && width > 0 && height > 0 && x <= size.width - width &&
               y <= size.height - height;
    }
    bool operator==(const Tile&) const = default;
};

inline Tile whole_of(ImageSize size) {
    return {0, 0, size.width, size.height};
}

/// The pixels of both tiles; no pixels where there are none.
inline Tile common(const Tile& a, const Tile& b) {
    const int left = std::max(a.x, b.x), top = std::max(a.y, b.y);
    return {left, top, std::max(0, std::min(a.x + a.width, b.x + b.width) - left),
            std::max(0, std::min(a.y + a.height, b.y + b.height) - top)};
}

} // namespace graftal
