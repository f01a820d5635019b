#include "compiler/analysis/model_range.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

/// How far the object's ball reaches from the origin, or the largest coordinate of any part's move if that is
/// more: an object that gathers at one point has no ball to speak of.
double reach(const Object& object, const ObjectBounds& bounds) {
    double farthest = bounds.ball.empty() ? 0 : glm::length(bounds.ball.centre) + bounds.ball.radius;
    for (const Instance& instance : object.instances)
        farthest = std::max(farthest, largest_entry(instance.parent_from_child.translation));
    return farthest;
}

bool check_size(const Graph& graph, ObjectId id, const ObjectBounds& bounds, Diagnostics& diagnostics) {
    if (bounds.box.empty()) return true;
    const std::string fault = range_fault(bounds.box.min, bounds.box.max);
    if (fault.empty()) return true;
    const Object& object = graph.objects[id];
    const std::string name = id == graph.root ? "the model" : fmt::format("'{}'", object.name);
    diagnostics.error(object.span, fmt::format("{} {}", name, fault)).with_hint(range_hint);
    return false;
}

bool check_terminal(const Object& object, const ObjectBounds& bounds, const ObjectBounds& master,
                    Diagnostics& diagnostics) {
    const double own = reach(object, bounds);
    if (own == 0 || master.ball.empty()) return true;
    const Ball ball = transformed(object.terminal->parent_from_child, master.ball);
    const double times = (glm::length(ball.centre) + ball.radius) / own;
    if (times <= farthest_terminal) return true;
    std::string how_far;
    append_number(how_far, times, 3);
    diagnostics
        .error(object.terminal->span, fmt::format("the terminal of '{}' reaches {} times as far as '{}'",
                                                  object.name, how_far, object.name))
        .with_hint("graftal draws a terminal in place of an object that is too small to see; make it about "
                   "as large");
    return false;
}

} // namespace

bool check_range(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds,
                 Diagnostics& diagnostics) {
    // Masters come first, and one fault is said: what holds such an object has it too.
    for (const std::vector<ObjectId>& members : components.members)
        for (const ObjectId id : members) {
            const Object& object = graph.objects[id];
            if (!object.primitive && !check_size(graph, id, bounds[id], diagnostics)) return false;
            if (object.terminal &&
                !check_terminal(object, bounds[id], bounds[object.terminal->master], diagnostics))
                return false;
        }
    return true;
}

} // namespace graftal
