#pragma once

namespace graftal {

/// The development of light into a picture: both engines give linear light, and one rule develops it
/// (runtime/image/develop.h).
struct Film {
    double exposure = 1;   ///< factor of all light
    double white_k = 6504; ///< colour temperature that is shown as white
    bool soft = false;     ///< highlights roll off in place of clipping at 1
    bool operator==(const Film&) const = default;

    /// Whether it leaves light up to 1 as it is.
    bool plain() const { return *this == Film(); }
};

} // namespace graftal
