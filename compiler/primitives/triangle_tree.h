#pragma once

#include <cstdint>
#include <vector>

#include "compiler/primitives/shape_parts.h"
#include "compiler/support/bounds.h"
#include "compiler/support/ray.h"

namespace graftal {

/// A tree of boxes over triangles, for shapes of many.
class TriangleTree {
  public:
    /// Requires at least one triangle, and finite corners.
    explicit TriangleTree(std::vector<Triangle> triangles);

    const std::vector<Triangle>& triangles() const { return triangles_; }

    /// The first triangle that a ray meets within the range, from either side; false if there is none (T.
    /// Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
    bool meet(const Ray& ray, const RayRange& range, double& t, std::uint32_t& triangle) const;

    /// A corner that is farthest along a direction.
    Vec3 farthest(Vec3 direction) const;

    /// The triangle that is nearest to a point.
    std::uint32_t nearest(Vec3 point) const;

    /// The numbers of the triangles in parts that lie together, at most so many parts.
    std::vector<std::vector<std::uint32_t>> parts(std::size_t most) const;

  private:
    struct Node {
        Box box;
        std::uint32_t first = 0; ///< of its triangles in order_, or its first child; the other follows that
        std::uint32_t count = 0; ///< 0: an inner node
    };

    void split(std::uint32_t node, std::uint32_t first, std::uint32_t end);

    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_; ///< the first is the root
};

} // namespace graftal
