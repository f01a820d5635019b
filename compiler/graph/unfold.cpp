#include "compiler/graph/unfold.h"

#include <algorithm>
#include <vector>

#include "compiler/graph/path.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// The instances of an object that are drawn.
enum class Draw : std::uint8_t { all, ending, terminal };

struct Frame {
    PathState place;
    Draw draw = Draw::all;
    std::size_t next = 0;
};

class Unfolding {
  public:
    Unfolding(const Graph& graph, const Components& components, std::optional<unsigned> steps,
              std::uint64_t max_leaves, const std::function<bool(const UnfoldedLeaf&)>& visit)
        : graph_(graph), components_(components), steps_(steps), leaves_left_(max_leaves), visit_(visit) {}

    bool run() {
        if (!open(PathState{graph_.root, {}, {}, {}, 0})) return false;
        while (!stack_.empty()) {
            Frame& frame = stack_.back();
            const Instance* instance = next_instance(frame);
            if (!instance) {
                stack_.pop_back();
                continue;
            }
            if (!open(descend(frame.place, *instance, components_))) return false;
        }
        return true;
    }

  private:
    const Instance* next_instance(Frame& frame) const {
        const Object& object = graph_.objects[frame.place.object];
        if (frame.draw == Draw::terminal) return frame.next++ == 0 ? &*object.terminal : nullptr;
        while (frame.next < object.instances.size()) {
            const Instance& instance = object.instances[frame.next++];
            if (frame.draw == Draw::all || !components_.unending[instance.master]) return &instance;
        }
        return nullptr;
    }

    /// Draws the place if it is a leaf, else pushes it; false if the visitor has had enough.
    bool open(const PathState& place) {
        const Object& object = graph_.objects[place.object];
        if (object.primitive) return draw_leaf(place, object.primitive);
        if (object.packed) return draw_packed(place, object.packed);
        if (object.is_combined()) return draw_leaf(place, std::nullopt);
        if (!components_.unending[place.object] || !steps_ || place.levels < *steps_) {
            stack_.push_back({place, Draw::all});
        } else if (object.terminal) {
            stack_.push_back({place, Draw::terminal});
        } else if (has_ending_instance(object)) {
            stack_.push_back({place, Draw::ending});
        } else {
            return draw_leaf(place, std::nullopt);
        }
        return true;
    }

    bool draw_packed(const PathState& place, const PackedEdges& edges) {
        for (const PackedEdge& edge : edges) {
            PathState leaf = place;
            leaf.world_from_object = place.world_from_object * edge.parent_from_child;
            if (edge.material) leaf.material = edge.material;
            if (!draw_leaf(leaf, edge.primitive)) return false;
        }
        return true;
    }

    bool has_ending_instance(const Object& object) const {
        return std::any_of(object.instances.begin(), object.instances.end(),
                           [&](const Instance& instance) { return !components_.unending[instance.master]; });
    }

    bool draw_leaf(const PathState& place, const std::optional<Primitive>& primitive) {
        if (leaves_left_ == 0) return false;
        --leaves_left_;
        return visit_({primitive, place.object, place.world_from_object, place.tint, place.material});
    }

    const Graph& graph_;
    const Components& components_;
    const std::optional<unsigned> steps_;
    std::uint64_t leaves_left_;
    const std::function<bool(const UnfoldedLeaf&)>& visit_;
    std::vector<Frame> stack_;
};

} // namespace

bool unfold(const Graph& graph, const Components& components, std::optional<unsigned> steps,
            std::uint64_t max_leaves, const std::function<bool(const UnfoldedLeaf&)>& visit) {
    GRAFTAL_CHECK(steps || !components.unending[graph.root], "unfold: an unending graph without steps");
    return Unfolding(graph, components, steps, max_leaves, visit).run();
}

} // namespace graftal
