#include "compiler/session/frame_model.h"

#include <map>
#include <utility>

#include "compiler/graph/unfold.h"
#include "compiler/scene/framing.h"
#include "compiler/scene/outline.h"

namespace graftal {

namespace {

/// Visits the corners of all that is drawn of an unending model by its steps: a tree of a few levels may be a
/// small part of its limit set, and terminals may reach beyond it. False where there is too much to look at.
template<typename Visit> bool visit_corners(const AnalysedModel& model, unsigned steps, const Visit& visit) {
    constexpr std::uint64_t most_leaves = 200'000;
    constexpr unsigned most_steps = 200; // a leaf may lie that deep
    if (steps > most_steps) return false;
    std::map<ObjectId, std::vector<Vec3>> corners_of; // many leaves place one object
    return unfold(model.graph, model.components, steps, most_leaves, [&](const UnfoldedLeaf& leaf) {
        const auto [corners, is_new] = corners_of.try_emplace(leaf.object);
        if (is_new)
            corners->second = hull_points(model.graph.objects[leaf.object], model.bounds[leaf.object].box);
        for (const Vec3& corner : corners->second)
            visit(leaf.world_from_object(corner));
        return true;
    });
}

} // namespace

Sight sight_of(const AnalysedModel& model, std::optional<unsigned> steps) {
    if (steps && model.components.unending[model.graph.root]) {
        Box box;
        std::size_t count = 0;
        const auto include = [&](const Vec3& corner) {
            box.include(corner);
            ++count;
        };
        // There may be a million: whoever asks for them has the only copy.
        if (visit_corners(model, *steps, include) && count > 0)
            return {box, [&model, steps = *steps, count](const std::vector<Vec3>&) {
                        std::vector<Vec3> corners;
                        corners.reserve(count);
                        visit_corners(model, steps, [&](const Vec3& corner) { corners.push_back(corner); });
                        return corners;
                    }};
    }
    const Box& box = model.bounds[model.graph.root].box;
    const Box unit{Vec3(-1.0), Vec3(1.0)}; // stands in for nothing but planes
    return {box.empty() ? unit : box, [&model](const std::vector<Vec3>& directions) {
                return outline(model.graph, model.bounds, directions);
            }};
}

View frame_graph(const Graph& graph, const Sight& sight, const ViewOptions& options, CloudPictures* clouds) {
    ImageSize size = options.size;
    if (options.shaped && !options.zoom.active()) {
        const CameraSetting own = graph.settings.camera.value_or(CameraSetting{});
        size = shaped_size(merge(own, options.camera), sight.bounds, sight.outliner, size);
    }
    return frame(graph, sight.bounds, size, options.camera, sight.outliner, options.light, clouds);
}

View frame_model(const AnalysedModel& model, std::optional<unsigned> steps, const ViewOptions& options) {
    return frame_graph(model.graph, sight_of(model, steps), options, model.clouds.get());
}

} // namespace graftal
