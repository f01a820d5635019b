#include "runtime/trace/model/specks.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/detail/least_width.h"
#include "compiler/primitives/primitive.h"
#include "compiler/support/stretch.h"
#include "runtime/trace/model/trace_model.h"

namespace graftal {

namespace {

constexpr int lanes = 4;

/// A map that widens what it places along the columns alone: a plane stays where it is.
bool keeps_plane(const Mat3& m) {
    constexpr double rounding = 1e-13; // less than what counts as a right angle when a leaf is widened
    for (int i = 0; i < 3; ++i) {
        const Vec3 &a = m[i], &b = m[(i + 1) % 3];
        if (!(std::abs(glm::dot(a, b)) <= rounding * glm::length(a) * glm::length(b))) return false;
    }
    return true;
}

/// Widening keeps the shape of a triangle whose sides are all as long.
bool is_even(const Mat3& m) {
    constexpr double rounding = 1e-13;
    const double x = glm::length(m[0]), y = glm::length(m[1]);
    return std::abs(x - y) <= rounding * x;
}

constexpr double half_sqrt3 = std::numbers::sqrt3 / 2;
const std::array<Vec3, 3> triangle_sides = {Vec3(0, -1, 0), Vec3(half_sqrt3, 0.5, 0),
                                            Vec3(-half_sqrt3, 0.5, 0)};

class SpeckBuilder {
  public:
    explicit SpeckBuilder(TraceModel& model) : model_(model) {}

    void add(TraceNode& node) {
        if (!node.faint || node.kind != TraceNode::Kind::parts) return;
        const auto first = static_cast<std::uint32_t>(model_.specks.size());
        lane_ = 0;
        const std::uint32_t first_edge = node.first_edge + node.edge_count;
        for (std::uint32_t i = 0; i < node.stop_edge_count; ++i) {
            const TraceEdge& edge = model_.edges[first_edge + i];
            const TraceNode& child = model_.nodes[edge.child];
            if (child.kind != TraceNode::Kind::primitive || is_endless(child)) {
                model_.specks.resize(first);
                return;
            }
            add(child.primitive, edge.parent_from_child.affine());
        }
        if (node.stop_edge_count == 0) add(PrimitiveKind::sphere, node.node_from_proxy.affine());
        node.first_speck = first;
        node.speck_count = static_cast<std::uint32_t>(model_.specks.size()) - first;
    }

  private:
    void add(const Primitive& primitive, const Affine& place) {
        if (lane_ % lanes == 0) model_.specks.push_back(empty());
        SpeckLanes& specks = model_.specks.back();
        const int i = lane_++ % lanes;
        const Ball ball = traits_of(primitive).ball(primitive);
        const Box box = traits_of(primitive).box(primitive);
        const bool flat = box.min.z == 0 && box.max.z == 0 && keeps_plane(place.linear);
        const Vec3 middle = place(ball.centre);
        const Vec3 normal = flat ? glm::normalize(glm::cross(place.linear[0], place.linear[1])) : Vec3(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            specks.middle[axis][i] = middle[axis];
            specks.normal[axis][i] = normal[axis];
        }
        specks.ball[i] = flat ? 0 : 1;
        specks.radius[i] = norm(place.linear) * ball.radius;
        if (flat && primitive == PrimitiveKind::triangle && is_even(place.linear))
            for (int side = 0; side < 3; ++side) {
                const Vec3 outwards = place.linear * triangle_sides[side];
                for (int axis = 0; axis < 3; ++axis)
                    specks.side[side][axis][i] = (outwards / glm::length(outwards))[axis];
            }
        specks.reach[i] = widened_reach(primitive) / model_.widest;
    }

    static SpeckLanes empty() {
        SpeckLanes specks{};
        for (Double4& middle : specks.middle)
            for (int i = 0; i < lanes; ++i)
                middle[i] = std::numeric_limits<double>::quiet_NaN();
        return specks;
    }

    TraceModel& model_;
    int lane_ = 0;
};

} // namespace

void add_specks(TraceModel& model) {
    if (!model.projection.culls()) return; // only then are they widened
    SpeckBuilder builder(model);
    for (TraceNode& node : model.nodes)
        builder.add(node);
}

} // namespace graftal
