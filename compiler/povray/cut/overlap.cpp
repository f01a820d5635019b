#include "compiler/povray/cut/overlap.h"

#include <variant>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/projection.h"
#include "compiler/support/bounds.h"

namespace graftal {

namespace {

/// In the body's own frame.
Box box_of(const Body& body) {
    const auto* const mesh = std::get_if<Mesh>(&body.shape);
    return mesh ? box_of(*mesh) : primitive_bounds(std::get<Primitive>(body.shape)).box;
}

} // namespace

double mean_overlap(const Cut& cut, const View& view) {
    DetailOptions options;
    options.visible_only = true;
    constexpr double near_share = 1e-9; // of the model: what is nearer covers the picture anyhow
    const Projection projection(view, options, 1, near_share * glm::length(cut.bounds.size()));
    std::vector<Box> boxes;
    for (const Body& body : cut.bodies)
        boxes.push_back(box_of(body));

    const double picture = static_cast<double>(view.size.width) * view.size.height;
    double covered_px = 0;
    for (const PlacementGroup& group : cut.groups)
        for_each_placement(group, [&](const Placement& placement) {
            if (boxes[placement.body].empty()) {
                covered_px += picture; // a plane
                return;
            }
            const Box box = transformed(placement.world_from_body, boxes[placement.body]);
            const Vec3 size = box.size();
            const Ball ball{box.centre(), 0.5 * glm::length(size)};
            if (!projection.sees(ball)) return;
            // The faces of a convex body measure four times what it covers, on average (Cauchy).
            const double area = 0.5 * (size.x * size.y + size.y * size.z + size.z * size.x);
            const double px = projection.pixels_per_unit(ball);
            const double covered = area * px * px;
            covered_px += covered < picture ? covered : picture; // the eye may lie in a box
        });
    return covered_px / picture;
}

} // namespace graftal
