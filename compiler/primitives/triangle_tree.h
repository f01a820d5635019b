#pragma once

#include <cstdint>
#include <vector>

#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/triangle_ray.h"
#include "compiler/support/bounds.h"
#include "compiler/support/ray.h"

namespace graftal {

/// A tree of boxes over triangles, for shapes of many. A box may be much wider than its triangles, as about
/// a needle askew or a fan of needles: slabs across then cut it (J. Klosowski et al., "Efficient Collision
/// Detection Using Bounding Volume Hierarchies of k-DOPs", 1998, has fixed ones).
class TriangleTree {
  public:
    /// Requires at least one triangle, and finite corners.
    explicit TriangleTree(std::vector<Triangle> triangles);

    const std::vector<Triangle>& triangles() const { return triangles_; }

    /// The first triangle that a ray meets within the range, from either side; false if there is none. Any
    /// of triangles no farther apart than `one_depth` may be the first. Adds to `steps` the nodes that the
    /// ray came to and the triangles that it was held against, each twice where the tree is larger than the
    /// caches of a processor. It ends after `most_steps` of these: the first
    /// triangle is then the first one met so far. If none was met, the box that the ray came to last is met
    /// as a whole.
    bool meet(const Ray& ray, const RayRange& range, TriangleHit& hit, std::uint32_t& triangle,
              std::uint64_t& steps, std::uint64_t most_steps = UINT64_MAX) const;

    /// A corner that is farthest along a direction.
    Vec3 farthest(Vec3 direction) const;
    /// An upper bound, and a near one, of the reach along the direction: of the boxes of a few parts.
    double reach(Vec3 direction) const;

    /// The triangle that is nearest to a point.
    std::uint32_t nearest(Vec3 point) const;

    /// The numbers of the triangles in parts that lie together, at most `most` parts.
    std::vector<std::vector<std::uint32_t>> parts(std::size_t most) const;

    /// A share of the largest coordinate.
    static constexpr double one_depth = 1e-10;

  private:
    /// The points between two places along a unit vector.
    struct Slab {
        Vec3 across;
        double least = 0, most = 0;
    };
    struct Node {
        Box box;
        std::uint32_t first = 0; ///< of its triangles in order_, or its first child; the other follows that
        std::uint32_t count = 0; ///< 0: an inner node
        std::uint32_t slabs = no_slabs; ///< the first of two
    };
    static constexpr std::uint32_t no_slabs = UINT32_MAX;
    /// The spread of the corners of a number of triangles.
    struct Spread;

    Spread split(std::uint32_t node, std::uint32_t first, std::uint32_t end);
    void add_slabs(std::uint32_t node, std::uint32_t first, std::uint32_t end, const Spread& spread);
    RayRange within(const Node& node, const Ray& ray, double slack, RayRange range) const;
    std::uint32_t first_below(const Node& node) const;
    double distance2(const Node& node, Vec3 point) const;
    double reach(const Node& node, Vec3 direction, int levels) const;

    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_; ///< the first is the root
    std::vector<Slab> slabs_;
    double extent_ = 0; ///< the largest coordinate
    std::uint64_t step_weight_ = 1;
};

} // namespace graftal
