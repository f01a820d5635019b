#include "compiler/lower/check_graph.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "compiler/graph/components.h"
#include "compiler/graph/planes.h"
#include "compiler/primitives/solid.h"

namespace graftal {

namespace {

/// Combined objects that may lie in each other's operands: rays go through them one within the other.
constexpr std::uint32_t deepest_combination = 32;

std::string_view word_of(const Object& object) {
    return object.combination == Combination::intersect ? "intersection" : "difference";
}

/// Reasons that keep objects from being operands.
class Operands {
  public:
    Operands(const Graph& graph, const Components& components)
        : graph_(graph), components_(components), hollow_(graph.objects.size(), nothing),
          depth_(graph.objects.size(), 0) {
        const Components joined = strong_components(with_terminals());
        for (std::size_t component = 0; component < joined.members.size(); ++component)
            look_at(joined.members[component], joined.cyclic[component]);
    }

    /// False after an error.
    bool check(ObjectId id, const std::vector<bool>& holds_plane, Diagnostics& diagnostics) const {
        const Object& object = graph_.objects[id];
        const std::string_view word = word_of(object);
        if (components_.cyclic[components_.component_of[id]]) {
            diagnostics
                .error(object.span,
                       fmt::format("'{}' leads back to itself by a part of its {}", object.name, word))
                .with_hint(
                    "let the recursion go through unions: the parts of a difference or an intersection "
                    "may be recursive themselves");
            return false;
        }
        if (holds_plane[id]) {
            diagnostics.error(object.span, fmt::format("the {} '{}' has no bounds", word, object.name))
                .with_hint(object.combination == Combination::subtract
                               ? "the first part of a difference may hold no plane"
                               : "one part of an intersection may hold no plane");
            return false;
        }
        if (depth_[id] > deepest_combination) {
            diagnostics
                .error(object.span, fmt::format("'{}' nests differences and intersections more than {} deep",
                                                object.name, deepest_combination))
                .with_hint("a difference takes away any number of parts at once");
            return false;
        }
        for (const Instance& instance : object.instances)
            if (!check(object, instance, diagnostics)) return false;
        return true;
    }

  private:
    static constexpr ObjectId nothing = UINT32_MAX;

    bool check(const Object& object, const Instance& instance, Diagnostics& diagnostics) const {
        const ObjectId culprit =
            is_singular(instance.parent_from_child) ? instance.master : hollow_[instance.master];
        if (culprit == nothing) return true;
        const Object& part = graph_.objects[culprit];
        const std::string& name = graph_.objects[instance.master].name;
        const std::string within = culprit == instance.master ? fmt::format("'{}'", name)
                                                              : fmt::format("'{}' in '{}'", part.name, name);
        Diagnostic& error = diagnostics.error(
            instance.span, part.primitive && !encloses_volume(*part.primitive)
                               ? fmt::format("{} encloses no volume, so it cannot be a part of the {} '{}'",
                                             within, word_of(object), object.name)
                               : fmt::format("a map flattens {}, which is a part of the {} '{}'", within,
                                             word_of(object), object.name));
        if (part.primitive == PrimitiveKind::mesh)
            error.with_hint("each side of a triangle of the mesh has to be a side of another");
        else if (part.primitive && !encloses_volume(*part.primitive))
            error.with_hint(
                "parts are made of spheres, cubes, cylinders, cones, frusta, tori, superellipsoids, "
                "sphere and limb sweeps, closed meshes, and planes as half spaces");
        else
            error.with_hint("scale it by more than 0 in all directions");
        return false;
    }

    /// The graph's edges, and those of terminals.
    Graph with_terminals() const {
        Graph edges;
        for (const Object& object : graph_.objects) {
            Object& copy = edges.objects.emplace_back();
            for (const Instance& instance : object.instances)
                copy.instances.emplace_back().master = instance.master;
            if (object.terminal) copy.instances.emplace_back().master = object.terminal->master;
        }
        return edges;
    }

    /// Members of a cycle contain each other, so what one of them holds is in all of them. No depth is
    /// counted along a cycle: where it leads through a combined object, by a terminal too, it is an error of
    /// its own.
    void look_at(const std::vector<ObjectId>& members, bool cyclic) {
        ObjectId hollow = nothing;
        std::uint32_t depth = 0;
        for (const ObjectId id : members) {
            look_at(id, cyclic);
            if (hollow == nothing) hollow = hollow_[id];
            depth = std::max(depth, depth_[id]);
        }
        for (const ObjectId id : members) {
            if (hollow_[id] == nothing) hollow_[id] = hollow;
            depth_[id] = depth;
        }
    }

    void look_at(ObjectId id, bool cyclic) {
        const Object& object = graph_.objects[id];
        if (object.primitive && !encloses_volume(*object.primitive)) hollow_[id] = id;
        const std::uint32_t own = object.is_combined() && !cyclic ? 1 : 0;
        const auto look_through = [&](const Instance& instance) {
            if (hollow_[id] == nothing)
                hollow_[id] =
                    is_singular(instance.parent_from_child) ? instance.master : hollow_[instance.master];
            depth_[id] = std::max(depth_[id], depth_[instance.master] + own);
        };
        for (const Instance& instance : object.instances)
            look_through(instance);
        if (object.terminal) look_through(*object.terminal);
    }

    const Graph& graph_;
    const Components& components_;
    std::vector<ObjectId> hollow_;     ///< by object: what in it is no solid
    std::vector<std::uint32_t> depth_; ///< by object: of combined objects in it, itself among them
};

} // namespace

bool check_graph(const Graph& graph, Diagnostics& diagnostics) {
    const Components components = strong_components(graph);
    const std::vector<bool> holds_plane = plane_holders(graph, components);
    const std::vector<bool> returns = terminals_that_return(graph, components);
    std::vector<bool> reported(components.members.size(), false);
    const ObjectId combined = first_combined(graph);
    std::optional<Operands> operands;
    if (combined < graph.objects.size()) operands.emplace(graph, components);
    bool good = true;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const Object& object = graph.objects[id];
        const std::uint32_t component = components.component_of[id];
        if (object.terminal && components.unending[object.terminal->master]) {
            diagnostics
                .error(object.terminal->span,
                       fmt::format("the terminal of '{}' does not end: '{}' contains itself", object.name,
                                   graph.objects[object.terminal->master].name))
                .with_hint("a terminal is what is drawn where recursion stops");
            good = false;
        }
        if (returns[id]) {
            diagnostics
                .error(object.terminal->span,
                       fmt::format("the terminal of '{}' leads back to it", object.name))
                .with_hint("a terminal is drawn in place of its object where that is too small to see");
            good = false;
        }
        if (object.is_combined() && !operands->check(id, holds_plane, diagnostics)) good = false;
        const bool plane = holds_plane[id] || (object.terminal && holds_plane[object.terminal->master]);
        if (!plane || !components.cyclic[component] || reported[component]) continue;
        reported[component] = true;
        diagnostics.error(object.span, fmt::format("'{}' contains itself and a plane", object.name))
            .with_hint("a plane has no bounds; place it outside of the recursion");
        good = false;
    }
    return good;
}

} // namespace graftal
