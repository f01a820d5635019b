#include "compiler/chaos/unroll.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace graftal {

namespace {

class Unrolling {
  public:
    Unrolling(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds,
              std::size_t max_instances)
        : graph_(graph), components_(components), bounds_(bounds), room_(max_instances) {}

    std::optional<Graph> run(unsigned steps) {
        result_.materials = graph_.materials;
        result_.settings = graph_.settings;
        result_.objects = graph_.objects; // ending objects stay as they are, under their numbers
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (components_.unending[id]) result_.objects[id] = Object();
        sphere_ = result_.primitive(PrimitiveKind::sphere);
        result_.root = copy_of(graph_.root, steps);
        while (!queue_.empty()) {
            const auto [id, levels, copy] = queue_.back();
            queue_.pop_back();
            if (!fill(id, levels, copy)) return std::nullopt;
        }
        return std::move(result_);
    }

  private:
    struct Task {
        ObjectId object;
        unsigned levels;
        ObjectId copy;
    };

    ObjectId copy_of(ObjectId id, unsigned levels) {
        if (!components_.unending[id]) return id;
        const auto [known, fresh] = copies_.try_emplace({id, levels}, 0);
        if (!fresh) return known->second;
        known->second = result_.add(Object());
        queue_.push_back({id, levels, known->second});
        return known->second;
    }

    bool fill(ObjectId id, unsigned levels, ObjectId copy) {
        const Object& object = graph_.objects[id];
        std::vector<Instance> instances;
        if (levels == 0 && object.terminal)
            instances.push_back(*object.terminal);
        else
            for (Instance instance : object.instances) {
                const bool unending = components_.unending[instance.master];
                if (unending && levels == 0) continue;
                if (unending) instance.master = copy_of(instance.master, levels - 1);
                instances.push_back(instance);
            }
        if (instances.empty()) instances.push_back(ball_of(id));
        if (room_ < instances.size()) return false;
        room_ -= instances.size();
        result_.objects[copy].instances = std::move(instances);
        return true;
    }

    Instance ball_of(ObjectId id) const {
        const Ball& ball = bounds_[id].ball;
        const double radius = ball.radius > 0 ? ball.radius : 1e-12;
        return {sphere_, Affine::translate(ball.centre) * Affine::scale(Vec3(radius)), {}, {}, {}};
    }

    const Graph& graph_;
    const Components& components_;
    const std::vector<ObjectBounds>& bounds_;
    std::size_t room_;
    Graph result_;
    ObjectId sphere_ = 0;
    std::map<std::pair<ObjectId, unsigned>, ObjectId> copies_;
    std::vector<Task> queue_;
};

} // namespace

std::optional<Graph> unrolled(const Graph& graph, const Components& components,
                              const std::vector<ObjectBounds>& bounds, unsigned steps,
                              std::size_t max_instances) {
    return Unrolling(graph, components, bounds, max_instances).run(steps);
}

} // namespace graftal
