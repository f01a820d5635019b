#pragma once

namespace graftal {

/// Work is counted, not timed, so that a picture does not depend on the machine or on what else it does.
/// These many steps stand for a second of one processor of 2024.
struct WorkRates {
    static constexpr double ray_parts = 1.2e7;  ///< parts that rays go into, shading included
    static constexpr double shell_points = 6e6; ///< points of shells moved (shell_points.h)
    static constexpr double leaves = 4e6;       ///< leaves unfolded into meshes and placements
};

} // namespace graftal
