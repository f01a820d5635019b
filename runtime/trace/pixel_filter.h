#pragma once

#include <array>

namespace graftal {

/// Blackman and Harris's window over three pixels, as a distribution: samples drawn by it count alike, and
/// each belongs to one pixel alone (Ernst, Stamminger and Greiner, "Filter importance sampling", 2006).
class PixelFilter {
  public:
    static constexpr double radius_px = 1.5;

    PixelFilter();

    /// Offset from the pixel's middle along one axis, in pixels, for u in [0, 1).
    double offset(double u) const;

    /// The window's value at an offset along one axis, 1 in its middle.
    static double weight(double offset);

    static constexpr int steps = 256;
    /// Offsets for u = 0, 1 / steps, ... 1, between which others are interpolated.
    const std::array<double, steps + 1>& offsets() const { return offset_of_; }

  private:
    std::array<double, steps + 1> offset_of_{};
};

} // namespace graftal
