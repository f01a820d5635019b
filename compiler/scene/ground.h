#pragma once

#include "compiler/scene/scene.h"

namespace graftal {

/// Where a picture lies on the ground: x to the right and -z upwards, as from above, over squares of `around`
/// units. Takes the unit square of x and y to the one whose corner is at x = 0, z = 0.
inline Affine world_from_picture(const Ground& ground) {
    const double side = ground.material.around;
    return {Mat3(Vec3(side, 0, 0), Vec3(0, 0, -side), Vec3(0, side, 0)), Vec3(0.0)};
}

} // namespace graftal
