#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/graph/primitive.h"
#include "compiler/support/affine.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// The area of the unit sphere's image under the map, projected along a unit direction.
double projected_area(const Affine& place, Vec3 direction);

/// The shadow that bodies cast along a direction, sampled on a square grid. They are drawn nearest first, so
/// that what each adds is what is seen of it.
class Shadow {
  public:
    /// The part of the grid that one body covers.
    struct Cover {
        double area = 0;      ///< of its shadow, exact or nearly so; in squares of the grid
        double samples = 0;   ///< in its shadow
        double uncovered = 0; ///< of those, not covered before
    };

    /// `size` rows of as many samples; a multiple of 64.
    explicit Shadow(int size);

    /// Wipes the grid and lays it over the ball's shadow. The direction is of unit length.
    void start(Vec3 direction, const Ball& ball);

    /// Draws the image of the unit sphere.
    Cover draw_sphere(const Affine& place);
    /// Draws the image of a primitive. Not for planes.
    Cover draw(const Primitive& primitive, const Affine& place);

    /// Depth of a point from the eye: those with a smaller depth hide others.
    double depth(Vec3 point) const;

    /// Number of bodies that a primitive is drawn as; 1 for most.
    static std::size_t bodies_of(const Primitive& primitive);

    /// Cost of drawing so far.
    std::uint64_t bodies_drawn() const { return bodies_drawn_; }

  private:
    struct Point {
        double x = 0;
        double y = 0;
    };

    Point project(Vec3 point) const;
    Cover draw_hull(std::span<const Vec3> corners, std::size_t ring, const Affine& place);
    bool join_rings(std::size_t count);
    std::size_t start_at_lowest();
    std::size_t wrap_points();
    void fill_hull(std::size_t top, Cover& cover);
    void cover_row(int row, double from, double to, Cover& cover);
    int first_row(double y) const;
    static bool is_near(const Point& point);

    int size_;
    std::vector<std::uint64_t> covered_; ///< row by row
    std::vector<double> offset_;         ///< of a row's samples, in [0, 1): they are not to line up
    Vec3 direction_{0.0}, right_{0.0}, up_{0.0};
    Vec3 centre_{0.0};
    double unit_ = 1; ///< samples a scene unit
    std::uint64_t bodies_drawn_ = 0;
    std::vector<Point> points_, hull_; ///< kept for their memory
};

} // namespace graftal
