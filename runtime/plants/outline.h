#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace graftal {

/// The convex hull of points in a plane, that come one after the other.
class Outline {
  public:
    void add(glm::dvec2 point);
    /// O(n log n) of the points since the last call.
    double area();

  private:
    void shrink();

    std::vector<glm::dvec2> points_; ///< the hull of those before, and newer ones
    std::size_t next_shrink_ = 1024;
};

} // namespace graftal
