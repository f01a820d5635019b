#include "compiler/analysis/volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "compiler/primitives/intersect.h"
#include "compiler/primitives/solid.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_steps_taken = 40'000'000; // less than a second
constexpr std::size_t most_parts_compared = 1000;      // each is held against each

constexpr double infinity = std::numeric_limits<double>::infinity();
const Box everywhere{Vec3(-infinity), Vec3(infinity)};

bool is_finite(const Box& box) {
    return std::isfinite(box.min.x);
}

/// Zero times anything is zero.
double times(double a, double b) {
    return a == 0 || b == 0 ? 0 : a * b;
}

/// The volume of the image of a set of volume 1.
double growth(const Affine& map) {
    return std::abs(glm::determinant(map.linear));
}

double volume_of(const Box& box) {
    if (box.empty()) return 0;
    const Vec3 size = box.size();
    return times(times(size.x, size.y), size.z);
}

double volume_of(const Ball& ball) {
    return ball.empty() ? 0 : 4 * std::numbers::pi / 3 * ball.radius * ball.radius * ball.radius;
}

/// Whether the insides of both have no point in common, rounding aside.
bool lie_apart(const Box& a, const Box& b) {
    constexpr double rounding = 1e-9;
    for (int axis = 0; axis < 3; ++axis) {
        const double slack = rounding * std::min(a.size()[axis], b.size()[axis]);
        if (!(a.max[axis] > b.min[axis] + slack && b.max[axis] > a.min[axis] + slack)) return true;
    }
    return false;
}

/// Whether the outer box holds the inner one, rounding aside.
bool holds(const Box& outer, const Box& inner) {
    if (inner.empty()) return true;
    const double slack = 1e-9 * glm::length(outer.size());
    return glm::all(glm::greaterThanEqual(inner.min, outer.min - slack)) &&
           glm::all(glm::lessThanEqual(inner.max, outer.max + slack));
}

bool holds(const Ball& outer, const Ball& inner) {
    const double reach = glm::length(inner.centre - outer.centre) + inner.radius;
    return inner.empty() || reach <= (1 + 1e-9) * outer.radius;
}

bool is_convex(const Primitive& primitive) {
    switch (primitive.kind()) {
    case PrimitiveKind::sphere:
    case PrimitiveKind::cube:
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
    case PrimitiveKind::superellipsoid:
        return true;
    default:
        return false;
    }
}

bool holds(const Primitive& convex, Vec3 point) {
    if (!(glm::length(point) < 2)) return false; // the corners of the cube are farthest out
    const Ray ray{point, {1, 0.31, 0.17}};
    PrimitiveHit hit;
    return intersect(convex, ray, {0, 8}, hit) && leaves_solid(convex, ray, hit);
}

/// An instance: its master's volume counts so many times.
struct Part {
    ObjectId master = 0;
    double scale = 1;
    std::uint32_t group = 0; ///< parts of two groups lie apart
    bool reaches = true;     ///< of a difference: whether it may have points of the first part
    bool within = false;     ///< whether it lies in the first part, and of an intersection in all others
};

class VolumeAnalysis {
  public:
    VolumeAnalysis(const Graph& graph, const Components& components, std::span<const ObjectBounds> bounds,
                   std::optional<unsigned> levels)
        : graph_(graph), components_(components), bounds_(bounds), levels_(levels),
          ball_holds_(graph.objects.size(), true), ranges_(graph.objects.size()) {}

    std::optional<VolumeRange> of_root() {
        for (const std::vector<ObjectId>& members : components_.members)
            for (const ObjectId id : members)
                if (!components_.unending[id])
                    ranges_[id] = combined(id, parts_of(id), false);
                else
                    unending_.push_back({id, {}});
        if (components_.unending[graph_.root] && !unfold()) return std::nullopt;
        const VolumeRange root = ranges_[graph_.root];
        return std::isfinite(root.most) ? std::optional(root) : std::nullopt;
    }

  private:
    struct Unending {
        ObjectId id = 0;
        std::vector<Part> parts;
    };

    /// A box about all that is drawn of an object.
    Box box_of(ObjectId id) const {
        const bool reaches_out = components_.unending[id] && levels_ && !boxes_hold_levels_;
        return bounds_[id].unbounded || reaches_out ? everywhere : bounds_[id].box;
    }

    /// Whether the box or ball of a limit set holds what is drawn where levels end, too, if those of its
    /// parts do: it holds the object's terminal, and those of its parts.
    template<typename Bound> bool holds_levels(ObjectId id, Bound ObjectBounds::*bound) const {
        const Object& object = graph_.objects[id];
        const auto is_held = [&](const Instance& part) {
            return graftal::holds(bounds_[id].*bound,
                                  transformed(part.parent_from_child, bounds_[part.master].*bound));
        };
        // Objects in no cycle are passed before levels end, if there are more levels than such objects.
        const bool may_be_cut =
            components_.cyclic[components_.component_of[id]] || *levels_ < unending_.size();
        return !(may_be_cut && is_proxy(object)) && (!object.terminal || is_held(*object.terminal)) &&
               std::all_of(object.instances.begin(), object.instances.end(), is_held);
    }

    bool boxes_hold_levels() const {
        return std::all_of(unending_.begin(), unending_.end(), [&](const Unending& object) {
            return holds_levels(object.id, &ObjectBounds::box);
        });
    }

    /// Masters come first, and members of a cycle hold what all of them do.
    void find_balls_that_hold() {
        for (const std::vector<ObjectId>& members : components_.members) {
            const bool hold = std::all_of(members.begin(), members.end(), [&](ObjectId id) {
                const std::vector<Instance>& parts = graph_.objects[id].instances;
                return !components_.unending[id] ||
                       (holds_levels(id, &ObjectBounds::ball) &&
                        std::all_of(parts.begin(), parts.end(),
                                    [&](const Instance& part) { return ball_holds_[part.master]; }));
            });
            for (const ObjectId id : members)
                ball_holds_[id] = hold;
        }
    }

    bool lie_apart(const Instance& a, const Instance& b) const {
        const Box box_a = box_of(a.master), box_b = box_of(b.master);
        if (!is_finite(box_a) || !is_finite(box_b)) return box_a.empty() || box_b.empty();
        if (graftal::lie_apart(transformed(a.parent_from_child, box_a),
                               transformed(b.parent_from_child, box_b)))
            return true;
        if (!ball_holds_[a.master] || !ball_holds_[b.master]) return false;
        const Ball ball_a = transformed(a.parent_from_child, bounds_[a.master].ball);
        const Ball ball_b = transformed(b.parent_from_child, bounds_[b.master].ball);
        return glm::length(ball_a.centre - ball_b.centre) >= ball_a.radius + ball_b.radius;
    }

    /// Whether `outer` is a convex primitive that holds all of `inner`.
    bool holds(const Instance& outer, const Instance& inner) const {
        const std::optional<Primitive>& primitive = graph_.objects[outer.master].primitive;
        const Box box = box_of(inner.master);
        if (!primitive || !is_convex(*primitive) || !is_finite(box) ||
            is_singular(outer.parent_from_child, 1e-9))
            return false;
        const Affine outer_from_inner = inverse(outer.parent_from_child) * inner.parent_from_child;
        const auto corners = box.corners();
        return std::all_of(corners.begin(), corners.end(),
                           [&](Vec3 corner) { return graftal::holds(*primitive, outer_from_inner(corner)); });
    }

    /// Gives parts one group where they may overlap, directly or by way of others.
    void group(std::span<const Instance> instances, std::span<Part> parts) {
        if (parts.size() > most_parts_compared || !take_steps(parts.size() * parts.size() / 2)) return;
        for (std::uint32_t i = 0; i < parts.size(); ++i) {
            parts[i].group = i;
            for (std::uint32_t j = 0; j < i; ++j) {
                if (parts[j].group == parts[i].group || lie_apart(instances[i], instances[j])) continue;
                for (std::uint32_t k = 0, old = parts[j].group; k < i; ++k)
                    if (parts[k].group == old) parts[k].group = parts[i].group;
            }
        }
    }

    std::vector<Part> parts_of(ObjectId id) {
        const Object& object = graph_.objects[id];
        const std::span<const Instance> instances(object.instances);
        std::vector<Part> parts;
        for (const Instance& instance : instances)
            parts.push_back({instance.master, growth(instance.parent_from_child)});
        const std::size_t united = object.combination == Combination::subtract ? 1 : 0; // and all that follow
        group(instances.subspan(united), std::span(parts).subspan(united));
        const std::size_t others = object.combination == Combination::subtract ? 1 : parts.size();
        constexpr std::size_t corners = 8; // are looked for in each of the others
        const bool compares = object.is_combined() && others <= most_parts_compared &&
                              take_steps(corners * parts.size() * others);
        for (std::size_t i = 0; object.is_combined() && i < parts.size(); ++i) {
            parts[i].reaches = i == 0 || !lie_apart(instances[0], instances[i]);
            parts[i].within = compares;
            for (std::size_t j = 0; parts[i].within && j < others; ++j)
                parts[i].within = i == j || holds(instances[j], instances[i]);
        }
        return parts;
    }

    VolumeRange range_of(const Part& part) const {
        const VolumeRange master = ranges_[part.master];
        return {times(part.scale, master.least), times(part.scale, master.most)};
    }

    /// The largest of each group of counted parts for certain, and all of them at most.
    template<typename Counts> VolumeRange united(std::span<const Part> parts, const Counts& counts) {
        VolumeRange all;
        group_least_.assign(parts.size(), 0);
        for (const Part& part : parts) {
            if (!counts(part)) continue;
            const VolumeRange range = range_of(part);
            all.most += range.most;
            group_least_[part.group] = std::max(group_least_[part.group], range.least);
        }
        for (const double least : group_least_)
            all.least += least;
        return all;
    }

    /// The object's volume from those of its parts, without unending ones where levels end.
    VolumeRange combined(ObjectId id, std::span<const Part> parts, bool no_level) {
        const Object& object = graph_.objects[id];
        const auto counts = [&](const Part& part) { return !no_level || !components_.unending[part.master]; };
        const double box = volume_of(box_of(id));
        if (object.primitive) {
            const std::optional<double> known = graftal::volume_of(*object.primitive);
            return known ? VolumeRange{*known, *known} : VolumeRange{0, box};
        }
        VolumeRange range;
        if (object.combination == Combination::unite) {
            range = united(parts, counts);
        } else if (object.combination == Combination::intersect) {
            range.most = infinity;
            for (const Part& part : parts) {
                if (!counts(part)) continue;
                range.most = std::min(range.most, range_of(part).most);
                if (part.within) range.least = range_of(part).least;
            }
        } else {
            const std::span<const Part> others = parts.subspan(1);
            const VolumeRange first = range_of(parts.front());
            range.least = first.least -
                          united(others, [&](const Part& part) { return counts(part) && part.reaches; }).most;
            range.most = first.most -
                         united(others, [&](const Part& part) { return counts(part) && part.within; }).least;
        }
        if (object.packed && !take_steps(object.packed.size())) {
            range.most = infinity;
        } else if (object.packed) {
            for (const PackedEdge& edge : object.packed) {
                const double volume =
                    growth(edge.parent_from_child) * graftal::volume_of(edge.primitive).value_or(0);
                range = {std::max(range.least, volume), range.most + volume};
            }
        }
        // The last of the numbers below 1e-300 would never become 0.
        const double most = std::min(range.most, box);
        return {std::max(range.least, 0.0), most > 1e-300 ? most : 0.0};
    }

    /// Whether a proxy is drawn where no level is left (graph.h, "Levels").
    bool is_proxy(const Object& object) const {
        if (object.terminal) return false;
        const auto needed = object.combination == Combination::subtract ? object.instances.begin() + 1
                                                                        : object.instances.end();
        return std::all_of(object.instances.begin(), needed,
                           [&](const Instance& part) { return components_.unending[part.master]; });
    }

    /// Where no level is left.
    VolumeRange cut(const Unending& object) {
        if (is_proxy(graph_.objects[object.id])) return {0, volume_of(bounds_[object.id].ball)};
        const std::optional<Instance>& terminal = graph_.objects[object.id].terminal;
        if (!terminal) return combined(object.id, object.parts, true);
        return range_of({terminal->master, growth(terminal->parent_from_child)});
    }

    /// Volumes of unending objects, level by level. Those of the limit come nearer from both sides, so they
    /// are right wherever the levels end.
    bool unfold() {
        constexpr unsigned limit_levels = 40'000; // 0.98 to this power is no number any more
        std::vector<VolumeRange> deeper;
        std::size_t edges = 0;
        boxes_hold_levels_ = levels_ && boxes_hold_levels();
        if (levels_) find_balls_that_hold();
        for (Unending& object : unending_) {
            object.parts = parts_of(object.id);
            edges += object.parts.size() + 1;
        }
        for (const Unending& object : unending_)
            deeper.push_back(levels_ ? cut(object) : VolumeRange{0, volume_of(box_of(object.id))});
        for (unsigned level = 0;; ++level) {
            bool changes = false;
            for (std::size_t i = 0; i < unending_.size(); ++i) {
                VolumeRange& range = ranges_[unending_[i].id];
                changes = changes || range.least != deeper[i].least || range.most != deeper[i].most;
                range = deeper[i];
            }
            if (level == levels_.value_or(limit_levels) || (level > 0 && !changes)) return true;
            if (!take_steps(edges)) return !levels_;
            for (std::size_t i = 0; i < unending_.size(); ++i)
                deeper[i] = combined(unending_[i].id, unending_[i].parts, false);
        }
    }

    bool take_steps(std::uint64_t steps) {
        steps_taken_ += steps;
        return steps_taken_ <= most_steps_taken;
    }

    const Graph& graph_;
    const Components& components_;
    const std::span<const ObjectBounds> bounds_;
    const std::optional<unsigned> levels_;
    bool boxes_hold_levels_ = false;
    std::vector<bool> ball_holds_;    ///< by object: all that is drawn of it
    std::vector<VolumeRange> ranges_; ///< by object
    std::vector<Unending> unending_;
    std::vector<double> group_least_;
    std::uint64_t steps_taken_ = 0;
};

} // namespace

std::optional<VolumeRange> volume_range(const Graph& graph, const Components& components,
                                        std::span<const ObjectBounds> bounds, std::optional<unsigned> steps) {
    return VolumeAnalysis(graph, components, bounds, steps).of_root();
}

} // namespace graftal
