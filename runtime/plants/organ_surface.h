#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "compiler/lower/plant.h"

namespace graftal {

/// The surface of an organ that light falls on: of segments and balls the outside, without the ends of
/// segments; of blades and discs both sides.
class OrganSurface {
  public:
    /// The organ of a module; `blade`: its triangles, or null. Has no area where the module draws none.
    OrganSurface(const Plant& plant, std::uint32_t module, const PlantBlade* blade);

    /// One side of what is flat.
    double area() const { return area_; }
    bool is_flat() const { return flat_; }
    /// Distance from the surface within which lies all that the organ is drawn as. A taper is rounded to
    /// 1/128 of the width, and a disc is a thousandth as thick as it is wide (lsys/turtle/bodies.h).
    double thickness() const { return thickness_; }

    struct Place {
        Vec3 point{0.0};
        Vec3 normal{0, 1, 0}; ///< unit vector: outwards, or to either side
    };
    /// A point by numbers in [0, 1)^2, each as likely as its share of the area. Requires an area.
    Place at(glm::dvec2 uv) const;

  private:
    Place on_segment(glm::dvec2 uv) const;
    Place on_ball(glm::dvec2 uv) const;
    Place on_disc(glm::dvec2 uv) const;
    Place on_blade(glm::dvec2 uv) const;

    const PlantModule& module_;
    double area_ = 0, thickness_ = 0;
    bool flat_ = false;
    std::vector<PlantTriangle> triangles_;
    std::vector<double> area_up_to_; ///< each triangle
};

} // namespace graftal
