#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "compiler/support/flat_area.h"

namespace graftal {

/// Numbered points of the plane in square cells, where they are looked up.
class PlaceGrid {
  public:
    /// `cell`: the width of a cell, and the farthest that is looked.
    explicit PlaceGrid(double cell) : cell_(cell) {}

    void add(Vec2 point, std::uint32_t number) {
        numbers_.emplace(key(along(point.x), along(point.y)), number);
    }

    /// Calls `visit(number)` for all points that are no farther away than a cell is wide, and for some
    /// others.
    template<typename Visit> void near(Vec2 point, const Visit& visit) const {
        const std::int64_t x = along(point.x), y = along(point.y);
        for (std::int64_t v = y - 1; v <= y + 1; ++v)
            for (std::int64_t u = x - 1; u <= x + 1; ++u) {
                const auto [first, last] = numbers_.equal_range(key(u, v));
                for (auto at = first; at != last; ++at)
                    visit(at->second);
            }
    }

  private:
    std::int64_t along(double x) const {
        return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_), -1e18, 1e18));
    }
    static std::uint64_t key(std::int64_t x, std::int64_t y) {
        return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ull ^
               static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Full;
    }

    double cell_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> numbers_;
};

} // namespace graftal
