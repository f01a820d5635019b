#pragma once

#include <glm/geometric.hpp>

#include "compiler/support/affine.h"
#include "compiler/support/ray.h"
#include "runtime/trace/model/lanes.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

/// Takes a ray into the frame of a run's body, where its direction's largest component is 1; it was
/// `largest`. False if that is no map. Requires that the body's axes are at right angles.
inline bool take_into_body(const Affine& run_from_body, const Ray& ray, Ray& inner, double& largest) {
    // Dividing by the squares of the axes' lengths turns the map round.
    const Mat3& m = run_from_body.linear;
    const Vec3 squares(glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2]));
    const Vec3 from_base = ray.origin - run_from_body.translation;
    inner.origin = from_base * m / squares;
    const Vec3 direction = ray.direction * m / squares;
    largest = largest_component(lanes_of(direction));
    if (!(largest > 0 && largest < 1 / least_scale)) return false;
    inner.direction = direction / largest;
    return true;
}

} // namespace graftal
