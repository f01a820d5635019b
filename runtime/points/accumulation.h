#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "compiler/scene/scene.h"

namespace graftal {

/// Number of points in each pixel, and the sums of their colours. All are whole numbers, so that the order
/// in which points come makes no difference. Colours lie in [0, 1] and are kept to 1/65535.
class Accumulation {
  public:
    struct Cell {
        std::uint64_t count = 0;
        std::uint64_t rgb[3] = {0, 0, 0};
    };

    explicit Accumulation(ImageSize size)
        : size_(size), cells_(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)) {}

    void add(std::size_t pixel, const float rgb[3]) {
        Cell& cell = cells_[pixel];
        ++cell.count;
        for (int c = 0; c < 3; ++c)
            cell.rgb[c] += level(rgb[c]);
    }

    /// Adds many points at once; `rgb`: the sums of their colours.
    void add(std::size_t pixel, std::uint64_t count, const double rgb[3]) {
        Cell& cell = cells_[pixel];
        cell.count += count;
        for (int c = 0; c < 3; ++c)
            cell.rgb[c] += static_cast<std::uint64_t>(std::max(0.0, 65535 * rgb[c] + 0.5));
    }

    void prefetch(std::size_t pixel) const { __builtin_prefetch(&cells_[pixel], 1); }

    /// add() where several threads add to one picture.
    void add_shared(std::size_t pixel, const float rgb[3]) {
        Cell& cell = cells_[pixel];
        std::atomic_ref(cell.count).fetch_add(1, std::memory_order_relaxed);
        for (int c = 0; c < 3; ++c)
            std::atomic_ref(cell.rgb[c]).fetch_add(level(rgb[c]), std::memory_order_relaxed);
    }

    void add(const Accumulation& other) {
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            cells_[i].count += other.cells_[i].count;
            for (int c = 0; c < 3; ++c)
                cells_[i].rgb[c] += other.cells_[i].rgb[c];
        }
    }

    ImageSize size() const { return size_; }
    const std::vector<Cell>& cells() const { return cells_; }
    Rgb mean_colour(const Cell& cell) const {
        const double points = 65535.0 * static_cast<double>(cell.count);
        return {static_cast<double>(cell.rgb[0]) / points, static_cast<double>(cell.rgb[1]) / points,
                static_cast<double>(cell.rgb[2]) / points};
    }

  private:
    static std::uint64_t level(float value) {
        const float clamped = std::min(std::max(0.0f, value), 1.0f); // NaN gives 0
        return static_cast<std::uint64_t>(static_cast<std::int32_t>(65535 * clamped + 0.5f));
    }

    ImageSize size_;
    std::vector<Cell> cells_;
};

} // namespace graftal
