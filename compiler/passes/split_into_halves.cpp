#include "compiler/passes/split_into_halves.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>

#include "compiler/graph/components.h"
#include "compiler/graph/path.h"
#include "compiler/passes/congruent_pairs.h"

namespace graftal {

namespace {

constexpr std::size_t max_checks = 20'000;
/// Least instances of an object to be split: with fewer a half would be a single one.
constexpr std::size_t least_instances = 4;

/// Fills the box, one axis for each of the box's.
Affine ellipsoid_in(const Box& box) {
    if (box.empty()) return {};
    return Affine::translate(box.centre()) * Affine::scale(0.5 * box.size());
}

/// The graph as CongruentPairs knows it.
class GraphShape {
  public:
    struct Edge {
        ObjectId child;
        const Affine& node_from_child;
        std::uint32_t levels;
        std::optional<MaterialId> material;
        double stretch;
    };

    class Edges {
      public:
        Edges(std::span<const Instance> instances, const double* stretches, const Components& components)
            : instances_(instances), stretches_(stretches), components_(components) {}

        std::size_t size() const { return instances_.size(); }
        Edge operator[](std::size_t i) const {
            const Instance& instance = instances_[i];
            return {instance.master, instance.parent_from_child, levels_of(instance, components_),
                    instance.material, stretches_[i]};
        }

      private:
        std::span<const Instance> instances_;
        const double* stretches_;
        const Components& components_;
    };

    GraphShape(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds)
        : graph_(graph), components_(components), bounds_(bounds) {
        for (const Object& object : graph.objects) {
            first_.push_back(stretches_.size());
            for (const Instance& instance : object.instances)
                stretches_.push_back(norm(instance.parent_from_child.linear));
            if (object.terminal) stretches_.push_back(norm(object.terminal->parent_from_child.linear));
            proxies_.push_back(ellipsoid_in(bounds[proxies_.size()].box));
        }
    }

    std::size_t size() const { return graph_.objects.size(); }
    const std::optional<Primitive>& primitive(ObjectId id) const { return graph_.objects[id].primitive; }
    Edges edges(ObjectId id) const {
        return {graph_.objects[id].instances, stretches_.data() + first_[id], components_};
    }
    Edges stop_edges(ObjectId id) const {
        const Object& object = graph_.objects[id];
        if (!object.terminal) return {{}, nullptr, components_};
        return {
            {&*object.terminal, 1}, stretches_.data() + first_[id] + object.instances.size(), components_};
    }

    bool alike(ObjectId a, ObjectId b) const {
        const Object &x = graph_.objects[a], &y = graph_.objects[b];
        return x.primitive == y.primitive && x.combination == y.combination && x.packed.run == y.packed.run &&
               x.terminal_px == y.terminal_px && components_.unending[a] == components_.unending[b] &&
               bounds_[a].unbounded == bounds_[b].unbounded;
    }

    /// True for packed edges, which are no instances, and for operands, which take parts.
    bool fixed(ObjectId id) const { return graph_.objects[id].packed || graph_.objects[id].is_combined(); }
    double radius(ObjectId id) const { return std::max(bounds_[id].ball.radius, 0.0); }
    const Affine* proxy(ObjectId id) const {
        return components_.unending[id] && !graph_.objects[id].terminal ? &proxies_[id] : nullptr;
    }

  private:
    const Graph& graph_;
    const Components& components_;
    const std::vector<ObjectBounds>& bounds_;
    std::vector<std::size_t> first_; ///< by object, in stretches_
    std::vector<double> stretches_;  ///< by object, of its instances and its terminal
    std::vector<Affine> proxies_;    ///< by object
};

/// True, by instance of an object, for those of the first half; empty if the object has no halves.
using Halves = std::vector<bool>;

class Halving {
  public:
    Halving(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds)
        : graph_(graph), shape_(graph, components, bounds), pairs_(shape_) {}

    Halves halves(ObjectId id) {
        const std::size_t count = graph_.objects[id].instances.size();
        for (const Mat3& linear : cube_symmetries()) {
            const bool half_turn = linear * linear == Mat3(1.0) && linear != Mat3(1.0);
            if (!half_turn || checks_ >= max_checks || pairs_.out_of_comparisons()) continue;
            ++checks_;
            const std::size_t before = pairs_.pairs().size();
            const std::uint32_t pair = pairs_.congruent(id, id, pairs_.moved(linear, id, id));
            Halves first(count, true);
            bool found = pair != pairs_.no_pair;
            for (std::uint32_t i = 0; found && i < count; ++i) {
                const std::uint32_t twin = pairs_.pairs()[pair].edge[i];
                found = twin != i && pairs_.pairs()[pair].edge[twin] == i;
                if (twin < i) first[i] = false;
            }
            pairs_.forget(before);
            if (found) return first;
        }
        return {};
    }

  private:
    const Graph& graph_;
    const GraphShape shape_;
    CongruentPairs<GraphShape> pairs_;
    std::size_t checks_ = 0;
};

/// Unending, of enough instances, and not taken apart yet.
std::vector<ObjectId> candidates(const Graph& graph, const Components& components) {
    std::vector<bool> is_part_of_another(graph.objects.size(), false);
    for (const Object& object : graph.objects)
        for (const Instance& instance : object.instances)
            if (is_part(instance, components)) is_part_of_another[instance.master] = true;
    std::vector<ObjectId> all;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const std::vector<Instance>& instances = graph.objects[id].instances;
        const auto unending = std::ranges::count_if(
            instances, [&](const Instance& instance) { return components.unending[instance.master]; });
        const bool whole = std::ranges::none_of(
            instances, [&](const Instance& instance) { return is_part(instance, components); });
        if (whole && !graph.objects[id].is_combined() && !is_part_of_another[id] &&
            instances.size() % 2 == 0 && static_cast<std::size_t>(unending) >= least_instances)
            all.push_back(id);
    }
    return all;
}

/// Names that no object has: of `tip(3)` the part `tip.half(3)`.
class PartNames {
  public:
    explicit PartNames(const Graph& graph) {
        for (const Object& object : graph.objects)
            taken_.insert(object.name);
    }

    std::string of(const std::string& whole) {
        const std::size_t end = std::min(whole.find('('), whole.size());
        const std::string base = whole.substr(0, end) + ".half", arguments = whole.substr(end);
        std::string name = base + arguments;
        for (int i = 2; !taken_.insert(name).second; ++i)
            name = base + std::to_string(i) + arguments;
        return name;
    }

  private:
    std::unordered_set<std::string> taken_;
};

} // namespace

Rewritten split_into_halves(Graph graph, const std::vector<ObjectBounds>& bounds) {
    Renumbering renumbering = Renumbering::identity(graph.objects.size());
    const Components components = strong_components(graph);
    const std::vector<ObjectId> wholes = candidates(graph, components);
    if (wholes.empty()) return {std::move(graph), std::move(renumbering)};
    std::vector<Halves> halves;
    {
        Halving halving(graph, components, bounds);
        for (const ObjectId id : wholes)
            halves.push_back(halving.halves(id));
    }
    PartNames names(graph);
    for (std::size_t i = 0; i < wholes.size(); ++i) {
        if (halves[i].empty()) continue;
        const std::vector<Instance> all = std::exchange(graph.objects[wholes[i]].instances, {});
        std::vector<Instance> left;
        for (const bool first : {true, false}) {
            Object half;
            half.name = names.of(graph.objects[wholes[i]].name);
            half.span = graph.objects[wholes[i]].span;
            for (std::size_t k = 0; k < all.size(); ++k)
                if (components.unending[all[k].master] && halves[i][k] == first)
                    half.instances.push_back(all[k]);
            Instance part;
            part.span = half.span;
            part.levels = 0;
            part.master = graph.add(std::move(half));
            left.push_back(part);
            renumbering.origin.push_back(wholes[i]);
        }
        std::ranges::copy_if(all, std::back_inserter(left),
                             [&](const Instance& instance) { return !components.unending[instance.master]; });
        graph.objects[wholes[i]].instances = std::move(left);
    }
    return {std::move(graph), std::move(renumbering)};
}

} // namespace graftal
