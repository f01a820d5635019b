#include "compiler/passes/renumbering.h"

#include <algorithm>
#include <numeric>

#include <glm/geometric.hpp>

#include "compiler/support/check.h"

namespace graftal {

namespace {

/// About the middle of the box, as small as the box and the balls allow.
Ball enclosing_ball(const Box& box, const std::vector<ObjectId>& held,
                    const std::vector<ObjectBounds>& bounds) {
    if (box.empty()) return {};
    Ball best{box.centre(), 0.5 * glm::length(box.size())};
    double reach = 0;
    for (const ObjectId object : held) {
        const Ball& ball = bounds[object].ball;
        if (!ball.empty()) reach = std::max(reach, glm::distance(best.centre, ball.centre) + ball.radius);
    }
    best.radius = std::min(best.radius, reach);
    return best;
}

} // namespace

Renumbering Renumbering::identity(std::size_t objects) {
    Renumbering same;
    same.now.resize(objects);
    std::iota(same.now.begin(), same.now.end(), 0u);
    same.origin = same.now;
    return same;
}

GraphStep followed(const Renumbering& renumbering, const GraphStep& step, const Object& before,
                   const Graph& after) {
    const Instance& old = before.instances[step.instance];
    const auto places_alike = [&](const Instance& instance) {
        return instance.parent_from_child == old.parent_from_child && instance.tint == old.tint;
    };
    // Instances that are alike keep their order: equal objects may have theirs in different orders.
    std::size_t alike_before = 0;
    for (std::uint32_t i = 0; i < step.instance; ++i)
        alike_before += places_alike(before.instances[i]) &&
                        renumbering.now[before.instances[i].master] == renumbering.now[old.master];
    const ObjectId object = renumbering.now[step.object];
    const std::vector<Instance>& instances = after.objects[object].instances;
    for (std::uint32_t i = 0; i < instances.size(); ++i)
        if (places_alike(instances[i]) && instances[i].master == renumbering.now[old.master] &&
            alike_before-- == 0)
            return {object, i};
    GRAFTAL_CHECK(false, "a pass has lost an instance of " + before.name);
    return {};
}

std::vector<ObjectBounds> carried_over(const Renumbering& renumbering,
                                       const std::vector<ObjectBounds>& bounds) {
    std::vector<ObjectBounds> carried;
    carried.reserve(renumbering.origin.size());
    for (const ObjectId origin : renumbering.origin)
        carried.push_back(bounds[origin]);
    for (const auto& [object, held] : renumbering.united) {
        Box box;
        for (const ObjectId old : held)
            box.include(bounds[old].box);
        carried[object].box = box;
        carried[object].ball = enclosing_ball(box, held, bounds);
    }
    return carried;
}

} // namespace graftal
