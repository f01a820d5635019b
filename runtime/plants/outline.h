#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace graftal {

/// The convex hull of points and ellipses in a plane, that come one after the other.
class Outline {
  public:
    void add(glm::dvec2 point);
    /// The ellipse centre + cos(t) a + sin(t) b, as a polygon of the same area whose edge lies within 0.1 %
    /// of its own.
    void add_ellipse(glm::dvec2 centre, glm::dvec2 a, glm::dvec2 b);
    /// O(n log n) of the points since the last call.
    double area();

  private:
    void shrink();
    bool surrounds(glm::dvec2 point) const;

    std::vector<glm::dvec2> points_; ///< the hull of those before, to the left around it, and newer ones
    std::size_t hull_size_ = 0;      ///< of the points; 0: no hull yet
    std::size_t next_shrink_ = 1024;
};

} // namespace graftal
