#include "compiler/passes/hoist_placements.h"

#include <utility>
#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/path.h"

namespace graftal {

namespace {

/// An instance of what is placed in its master. The master is ending, or is only made smaller: its levels are
/// those of the parent.
Instance composed(const Instance& parent, const Instance& child) {
    return {child.master,
            parent.parent_from_child * child.parent_from_child,
            straight(PathTint(parent.tint) * PathTint(child.tint)),
            child.material ? child.material : parent.material,
            parent.span,
            parent.levels};
}

bool share_placement(const Instance& a, const Instance& b) {
    return a.parent_from_child == b.parent_from_child && a.tint == b.tint && a.material == b.material;
}

bool can_give(const Object& object) {
    // The set that operands make together is bounded otherwise than what is united (Renumbering::united).
    if (object.primitive || object.packed || object.is_combined()) return false;
    const Instance& first = object.instances.front();
    if (is_singular(first.parent_from_child)) return false;
    for (const Instance& instance : object.instances)
        if (!share_placement(instance, first)) return false;
    return !object.terminal ||
           (object.terminal->tint == first.tint && object.terminal->material == first.material);
}

/// Splits objects into what they give and what is left, in place.
class Hoisting {
  public:
    explicit Hoisting(Graph graph) : graph_(std::move(graph)) {}

    Rewritten run() && {
        const Components components = strong_components(graph_);
        renumbering_ = Renumbering::identity(graph_.objects.size());
        given_.resize(graph_.objects.size());
        // Masters first, so that chains of single instances collapse in one sweep.
        for (const std::vector<ObjectId>& members : components.members)
            for (const ObjectId id : members)
                take_out(id, components.unending[id]);
        for (Object& object : graph_.objects) {
            for (Instance& instance : object.instances)
                instance = composed(instance, given_[instance.master]);
            if (object.terminal)
                *object.terminal = composed(*object.terminal, given_[object.terminal->master]);
        }
        renumbering_.taken.reserve(given_.size());
        for (ObjectId id = 0; id < given_.size(); ++id) {
            const Instance& given = given_[id];
            renumbering_.now[id] = given.master;
            renumbering_.taken.push_back({given.parent_from_child, given.tint, given.material});
        }
        return {std::move(graph_), std::move(renumbering_)};
    }

  private:
    void take_out(ObjectId id, bool unending) {
        Object& object = graph_.objects[id];
        Instance& given = given_[id];
        given.master = id;
        if (id == graph_.root || !can_give(object)) return;
        const Instance first = object.instances.front();
        if (object.instances.size() == 1 && !unending && !object.terminal) {
            given = composed(first, given_[first.master]);
            return;
        }
        given.parent_from_child = first.parent_from_child;
        given.tint = first.tint;
        given.material = first.material;
        std::vector<ObjectId>& held = renumbering_.united[id];
        for (Instance& instance : object.instances) {
            held.push_back(instance.master);
            instance.parent_from_child = {};
            instance.tint = {};
            instance.material = {};
        }
        if (object.terminal) {
            object.terminal->parent_from_child =
                inverse(first.parent_from_child) * object.terminal->parent_from_child;
            object.terminal->tint = {};
            object.terminal->material = {};
        }
    }

    Graph graph_;
    std::vector<Instance> given_; ///< by object: where what is left of it lies in what it was
    Renumbering renumbering_;
};

} // namespace

Rewritten hoist_placements(Graph graph) {
    return Hoisting(std::move(graph)).run();
}

} // namespace graftal
