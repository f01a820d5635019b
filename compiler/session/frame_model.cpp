#include "compiler/session/frame_model.h"

#include <map>
#include <utility>

#include "compiler/graph/unfold.h"
#include "compiler/scene/framing.h"
#include "compiler/scene/outline.h"

namespace graftal {

namespace {

/// The corners of all that is drawn of an unending model by its steps: a tree of a few levels may be a small
/// part of its limit set, and terminals may reach beyond it. Nothing where there is too much to look at.
std::vector<Vec3> corners_of_levels(const AnalysedModel& model, unsigned steps) {
    constexpr std::uint64_t most_leaves = 200'000;
    constexpr unsigned most_steps = 200; // a leaf may lie that deep
    if (steps > most_steps) return {};
    std::vector<Vec3> points;
    std::map<ObjectId, std::vector<Vec3>> corners_of; // many leaves place one object
    const auto add = [&](const UnfoldedLeaf& leaf) {
        const auto [corners, is_new] = corners_of.try_emplace(leaf.object);
        if (is_new)
            corners->second = hull_points(model.graph.objects[leaf.object], model.bounds[leaf.object].box);
        for (const Vec3& corner : corners->second)
            points.push_back(leaf.world_from_object(corner));
        return true;
    };
    if (!unfold(model.graph, model.components, steps, most_leaves, add)) return {};
    return points;
}

Box box_of(const std::vector<Vec3>& points) {
    Box box;
    for (const Vec3& point : points)
        box.include(point);
    return box;
}

} // namespace

Sight sight_of(const AnalysedModel& model, std::optional<unsigned> steps) {
    if (steps && model.components.unending[model.graph.root]) {
        std::vector<Vec3> points = corners_of_levels(model, *steps);
        if (!points.empty()) {
            const Box box = box_of(points);
            return {box, [points = std::move(points)](const auto&) { return points; }};
        }
    }
    const Box& box = model.bounds[model.graph.root].box;
    const Box unit{Vec3(-1.0), Vec3(1.0)}; // stands in for nothing but planes
    return {box.empty() ? unit : box, [&model](const std::vector<Vec3>& directions) {
                return outline(model.graph, model.bounds, directions);
            }};
}

View frame_graph(const Graph& graph, const Sight& sight, const ViewOptions& options) {
    ImageSize size = options.size;
    if (options.shaped && !options.zoom.active()) {
        const CameraSetting own = graph.settings.camera.value_or(CameraSetting{});
        size = shaped_size(merge(own, options.camera), sight.bounds, sight.outliner, size);
    }
    return frame(graph, sight.bounds, size, options.camera, sight.outliner, options.light);
}

View frame_model(const AnalysedModel& model, std::optional<unsigned> steps, const ViewOptions& options) {
    return frame_graph(model.graph, sight_of(model, steps), options);
}

} // namespace graftal
