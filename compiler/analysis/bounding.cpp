#include "compiler/analysis/bounding.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/analysis/cycle_graph.h"
#include "compiler/analysis/invariant.h"
#include "compiler/analysis/outer.h"
#include "compiler/analysis/run_bounds.h"
#include "compiler/analysis/support_query.h"
#include "compiler/analysis/tight_ball.h"
#include "compiler/graph/planes.h"
#include "compiler/primitives/primitive.h"
#include "compiler/support/check.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Tolerances of box faces, relative to the size. A cycle's boxes are found in passes: each makes the next
/// one fast, as what is known of all objects decides how many pieces of one must be looked at.
constexpr double exact = 1e-12;
constexpr std::array<double, 7> passes_of_cycle = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001, exact};
constexpr std::uint64_t faces = 6;
/// Pieces after which the control is asked: some milliseconds.
constexpr std::uint64_t pieces_a_look = 10'000;

/// Pieces to spend on support functions, dealt out so that all objects get some and what one leaves over
/// the next may use.
class Effort {
  public:
    Effort(std::uint64_t pieces, std::uint64_t queries) : left_(pieces), queries_left_(queries) {}

    std::uint64_t allowance() const {
        return std::clamp<std::uint64_t>(8 * left_ / std::max<std::uint64_t>(queries_left_, 1), 16, 400'000);
    }
    std::uint64_t spent() const { return spent_; }
    void spend(std::uint64_t pieces) {
        spent_ += pieces;
        left_ -= std::min(left_, pieces);
        if (queries_left_ > 0) --queries_left_;
    }

  private:
    std::uint64_t left_, spent_ = 0;
    std::uint64_t queries_left_;
};

/// The box about what a half space leaves of a box; empty if that is nothing.
Box clipped(const Box& box, const HalfSpace& half_space) {
    const std::array<Vec3, 8> corners = box.corners();
    std::array<double, 8> above{};
    // Faces that lie in the plane stay within.
    const double slack =
        4e-12 * glm::length(box.size()) + 4e-15 * std::max(glm::length(box.min), glm::length(box.max));
    for (std::size_t i = 0; i < corners.size(); ++i)
        above[i] = glm::dot(half_space.up, corners[i]) - half_space.height - slack;
    Box left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!(above[i] > 0)) left.include(corners[i]);
        for (const std::size_t side : {1, 2, 4}) {
            const std::size_t j = i ^ side; // the other end of an edge
            if (above[i] < 0 && above[j] > 0)
                left.include(corners[i] + above[i] / (above[i] - above[j]) * (corners[j] - corners[i]));
        }
    }
    return {glm::max(left.min, box.min), glm::min(left.max, box.max)};
}

/// The faces that will be looked for, with `weight` of each object.
template<typename Weight>
std::uint64_t queries(const Graph& graph, const Components& components, const Weight& weight) {
    std::uint64_t count = 0;
    for (ObjectId id = 0; id < graph.objects.size(); ++id)
        if (!graph.objects[id].primitive)
            count += faces * (components.cyclic[components.component_of[id]] ? passes_of_cycle.size() : 1) *
                     weight(graph.objects[id]);
    return count;
}

std::uint64_t queries(const Graph& graph, const Components& components) {
    return queries(graph, components, [](const Object&) { return std::uint64_t{1}; });
}

class Bounder {
  public:
    Bounder(const Graph& graph, const Components& components, const Contraction& contraction,
            const Control& control, std::uint64_t pieces = most_pieces)
        : graph_(graph), components_(components), contraction_(contraction), outers_(graph.objects.size()),
          unbounded_(plane_holders(graph, components)), search_(graph, outers_),
          effort_(pieces, queries(graph, components)), cancel_(control.cancel),
          meter_(control, "bounding", pieces_a_look, StagePrice::piece),
          pieces_of_ball_(std::clamp<std::size_t>(400'000 / graph.objects.size(), 4, 400)),
          wants_ball_(graph.objects.size(), true) {}

    void leave_out_last_balls() {
        wants_ball_.assign(graph_.objects.size(), false);
        for (const Object& object : graph_.objects)
            for (const Instance& instance : object.instances)
                wants_ball_[instance.master] = true;
    }

    std::vector<ObjectBounds> run() {
        const std::vector<std::uint32_t> places = places_in_components(components_);
        for (std::uint32_t c = 0; c < components_.members.size(); ++c) {
            if (components_.cyclic[c])
                bound_component(cycle_graph(graph_, components_, places, c));
            else
                bound_object(components_.members[c].front());
        }
        std::vector<ObjectBounds> result;
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            result.push_back(bounds_of(id));
        return result;
    }

    std::uint64_t pieces() const { return effort_.spent(); }

  private:
    void bound_component(const CycleGraph& cycle) {
        meter_.add(cycle.edges.size(), StagePrice::cycle_edge);
        bound_cycle(cycle, components_, contraction_.certificate, outers_);
        for (const double tolerance : passes_of_cycle)
            for (const ObjectId id : cycle.objects)
                find_box(id, tolerance);
        for (const ObjectId id : cycle.objects)
            find_ball(id);
    }

    void bound_object(ObjectId id) {
        const Object& object = graph_.objects[id];
        if (object.primitive) {
            bound_primitive(id, *object.primitive);
            return;
        }
        if (object.packed) return bound_packed(id, object.packed);
        Outer& outer = outers_[id];
        if (object.combination == Combination::intersect) return bound_intersection(id);
        for (const Instance& instance : bounding_instances(object)) {
            const Outer& part = outers_[instance.master];
            if (part.empty) continue;
            outer.box.include(transformed(instance.parent_from_child, part.box));
            outer.empty = false;
        }
        if (outer.empty) return;
        keep_in_range(outer.box);
        outer.set_ball(circumball(outer.box));
        find_box(id, exact);
        find_ball(id);
    }

    void bound_primitive(ObjectId id, const Primitive& primitive) {
        const ObjectBounds bounds = primitive_bounds(primitive);
        if (bounds.unbounded) return;
        Outer& outer = outers_[id];
        outer.box = bounds.box;
        outer.set_ball(bounds.ball);
        outer.empty = false;
        const auto support_point = traits_of(primitive).support_point;
        for (int i = 0; i < 3; ++i) {
            Vec3 axis(0.0);
            axis[i] = 1;
            for (const Vec3 direction : {axis, -axis})
                outer.points[static_cast<std::size_t>(outer.point_count++)] =
                    support_point(primitive, direction);
        }
    }

    /// Bounds by the boxes of the operands that have some, and by half spaces that leave something of them.
    /// Boxes apart leave a point of nothing between them.
    void bound_intersection(ObjectId id) {
        Outer& outer = outers_[id];
        std::optional<Box> common;
        for (const Instance& instance : graph_.objects[id].instances) {
            if (unbounded_[instance.master]) continue;
            const Box box = transformed(instance.parent_from_child, outers_[instance.master].box);
            if (!common)
                common = box;
            else
                common = Box{glm::max(common->min, box.min), glm::min(common->max, box.max)};
        }
        if (!common) return;
        for (int i = 0; i < 3; ++i)
            if (common->min[i] > common->max[i])
                common->min[i] = common->max[i] = 0.5 * common->min[i] + 0.5 * common->max[i];
        keep_in_range(*common);
        for (const Instance& instance : graph_.objects[id].instances)
            if (const std::optional<HalfSpace> half_space = half_space_of(graph_, instance))
                if (const Box left = clipped(*common, *half_space); !left.empty()) common = left;
        outer.box = *common;
        outer.set_ball(circumball(outer.box));
        outer.empty = false;
        for (const Vec3& corner : {outer.box.min, outer.box.max})
            outer.points[static_cast<std::size_t>(outer.point_count++)] = corner;
    }

    void bound_packed(ObjectId id, const PackedEdges& edges) {
        Outer& outer = outers_[id];
        meter_.add(edges.item_count());
        outer.run = std::make_shared<const RunBounds>(edges.run);
        outer.box = outer.run->box();
        outer.set_ball(outer.run->ball());
        outer.empty = false;
        for (int i = 0; i < 3; ++i) {
            Vec3 axis(0.0);
            axis[i] = 1;
            outer.points[static_cast<std::size_t>(outer.point_count++)] = outer.run->support_point(axis);
            outer.points[static_cast<std::size_t>(outer.point_count++)] = outer.run->support_point(-axis);
        }
    }

    /// Narrows the box by support functions along the axes; keeps the points that its faces touch.
    void find_box(ObjectId id, double relative_tolerance) {
        Outer& outer = outers_[id];
        Box box = outer.box;
        std::array<Vec3, 6> points;
        const double size = glm::length(outer.box.max - outer.box.min);
        const double position = std::max(glm::length(outer.box.max), glm::length(outer.box.min));
        const double tolerance = relative_tolerance * size + 1e-15 * position;
        for (int i = 0; i < 6; ++i) {
            const int axis = i / 2;
            Vec3 direction(0.0);
            direction[axis] = i % 2 == 0 ? 1 : -1;
            const Support found = search_.run(id, direction, tolerance, effort_.allowance());
            effort_.spend(search_.pieces());
            meter_.add(search_.pieces() + 1);
            const double face = within_range(found.upper + 4e-12 * size + 4e-15 * position);
            if (i % 2 == 0)
                box.max[axis] = std::min(box.max[axis], face);
            else
                box.min[axis] = std::max(box.min[axis], -face);
            points[static_cast<std::size_t>(i)] = found.point;
        }
        outer.box = box;
        std::copy(points.begin(), points.end(), outer.points.begin());
        outer.point_count = 6;
        const Ball about = circumball(box);
        if (about.radius < outer.ball().radius) outer.set_ball(about);
    }

    void find_ball(ObjectId id) {
        if (!wants_ball_[id] || graph_.objects[id].combination == Combination::intersect) return;
        meter_.add(graph_.objects[id].instances.size() + pieces_of_ball_);
        Ball ball = tight_ball(graph_, outers_, id, pieces_of_ball_, cancel_);
        ball.radius = within_range(ball.radius * (1 + 4e-12) + 4e-15 * glm::length(ball.centre));
        if (ball.radius < outers_[id].ball().radius) outers_[id].set_ball(ball);
    }

    static void keep_in_range(Box& box) {
        for (int i = 0; i < 3; ++i) {
            box.min[i] = std::isnan(box.min[i]) ? -largest_length : within_range(box.min[i]);
            box.max[i] = within_range(box.max[i]);
        }
    }

    ObjectBounds bounds_of(ObjectId id) const {
        const Outer& outer = outers_[id];
        ObjectBounds bounds;
        bounds.unbounded = unbounded_[id];
        if (outer.empty) return bounds;
        bounds.box = outer.box;
        bounds.ball = outer.ball();
        bounds.run = outer.run;
        return bounds;
    }

    const Graph& graph_;
    const Components& components_;
    const Contraction& contraction_;
    Outers outers_;
    const std::vector<bool> unbounded_;
    SupportSearch search_;
    Effort effort_;
    const CancelFlag& cancel_;
    WorkMeter meter_;
    std::size_t pieces_of_ball_;
    std::vector<bool> wants_ball_; ///< by object
};

void require_proof(const Contraction& contraction) {
    GRAFTAL_CHECK(contraction.verdict == Verdict::proved || contraction.verdict == Verdict::acyclic,
                  "bound_objects: needs a contraction that is proved or acyclic");
}

} // namespace

ObjectBounds primitive_bounds(const Primitive& primitive) {
    const PrimitiveTraits& traits = traits_of(primitive);
    return {traits.box(primitive), traits.ball(primitive), !traits.bounded, nullptr};
}

std::uint64_t fewest_pieces(const Graph& graph, const Components& components) {
    return queries(graph, components, [](const Object& object) { return object.instances.size(); });
}

std::vector<ObjectBounds> bound_objects(const Graph& graph, const Components& components,
                                        const Contraction& contraction, const Control& control,
                                        std::uint64_t* pieces) {
    require_proof(contraction);
    Bounder bounder(graph, components, contraction, control);
    std::vector<ObjectBounds> bounds = bounder.run();
    if (pieces != nullptr) *pieces = bounder.pieces();
    return bounds;
}

std::vector<Box> bound_boxes(const Graph& graph, const Components& components, const Contraction& contraction,
                             std::uint64_t most, std::uint64_t& pieces, const Control& control) {
    require_proof(contraction);
    Bounder bounder(graph, components, contraction, control, most);
    bounder.leave_out_last_balls();
    std::vector<Box> boxes;
    for (const ObjectBounds& bounds : bounder.run())
        boxes.push_back(bounds.box);
    pieces = bounder.pieces();
    return boxes;
}

} // namespace graftal
