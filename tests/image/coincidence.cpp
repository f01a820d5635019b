#include "tests/image/coincidence.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/primitives/intersect.h"

namespace graftal {

Coincidence::Coincidence(const Cut& cut) {
    for (const PlacementGroup& group : cut.groups)
        for (const Placement& placement : group.placements) {
            const auto* kind = std::get_if<Primitive>(&cut.bodies[placement.body].shape);
            const Affine& place = placement.world_from_body;
            if (!kind || *kind == PrimitiveKind::plane || is_singular(place, 1e-12)) continue;
            constexpr double reach = 2; // of every primitive
            parts_.push_back({*kind, inverse(place), place.translation, reach * norm(place.linear),
                              group.tint.over(cut.palettes[group.palette].front()), &group.material});
            size_ = std::max(size_, largest_entry(place.translation) + parts_.back().radius);
        }
}

bool Coincidence::at(const Ray& ray, double t) const {
    const double rounding = 1e-10 * (size_ + largest_entry(ray.origin));
    const Vec3 point = ray(t);
    const Part* first = nullptr;
    for (const Part& part : parts_) {
        if (glm::distance(part.centre, point) > part.radius + rounding) continue;
        const Mat3& linear = part.part_from_world.linear;
        Ray near{part.part_from_world(point), linear * ray.direction};
        const double speed = largest_entry(near.direction);
        near.direction /= speed;
        PrimitiveHit hit;
        if (!intersect(part.kind, near, {-rounding * speed, rounding * speed}, hit)) continue;
        if (first && (first->rgb != part.rgb || !(*first->material == *part.material))) return true;
        first = &part;
    }
    return false;
}

} // namespace graftal
