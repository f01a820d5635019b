#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/projection.h"
#include "compiler/support/ray.h"

namespace graftal {

/// Where a ray meets what is drawn.
struct PartHit {
    static constexpr NodeId none = UINT32_MAX;

    double t = 0;
    Vec3 normal{0, 1, 0}; ///< of unit length, to either side
    Rgb rgb{0.8};
    std::optional<MaterialId> material; ///< whose finish it shows
    /// The first node on the way that is no larger than the size watched for, and that may be culled.
    NodeId part = none;
    double part_px = 0; ///< its diameter
};

/// Takes single rays through a cut graph as simply as can be: for a measurement, some thousands of them.
/// All is opaque, and pictures on materials do not count. What a singular map crushes is left out.
class PartRays {
  public:
    /// Keeps references. `root_steps`: levels that the root has. `watched_px`: PartHit::part. Requires a
    /// projection that culls by pixels. `limit_normals`: whether proxies show them (mesh/limit_normal.h).
    PartRays(const DetailGraph& cut, const Projection& projection, std::uint32_t root_steps,
             double watched_px, bool limit_normals);

    /// The nearest hit beyond `least`; of unit length the direction. False if there is none, or if the ray
    /// went by too many parts.
    bool closest(const Ray& ray, double least, PartHit& hit);
    /// Whether anything is met beyond `least` and before `most`. True, too, after too many parts.
    bool meets_any(const Ray& ray, RayRange range);

    /// Parts that rays went by so far.
    std::uint64_t work() const { return work_; }

  private:
    /// A node on the way.
    struct At : Look {
        NodeId node = 0;
        Affine world_from_node;
        double scale = 1; ///< norm of it
        std::uint32_t steps = 0;
        bool faint = false;
        NodeId part = PartHit::none;
        double part_px = 0;
        std::uint32_t depth = 0;  ///< edges from the root
        std::uint32_t levels = 0; ///< balls of unending nodes above
    };
    struct Waiting {
        double t = 0;
        const DetailEdge* edge = nullptr;
    };

    bool run(const Ray& ray, RayRange range, bool any);
    void enter(At at);
    void go_below(const At& at, bool cut);
    void follow(const At& parent, const DetailEdge& edge, bool parent_is_cut);
    void meet(const At& at, const Primitive& primitive, const Affine& world_from_leaf, bool proxy);
    Ball ball_of(const At& at) const;
    bool done() const { return (any_ && found_) || work_ > work_limit_; }

    const DetailGraph& cut_;
    const Projection& projection_;
    std::uint32_t root_steps_;
    double watched_px_;
    bool limit_normals_;
    Ray ray_;
    double least_ = 0;
    bool any_ = false, found_ = false;
    PartHit best_;
    std::vector<Ball> balls_;                   ///< in the world, of the unending nodes on the way
    std::vector<std::vector<Waiting>> waiting_; ///< by depth, kept for their memory
    std::uint64_t work_ = 0, work_limit_ = 0;
};

} // namespace graftal
