#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal {

/// The kind of thing that a module is drawn as.
enum class Organ : std::uint8_t { none, segment, ball, disc, polygon, model };

/// "segment"; "" of none.
inline std::string_view name_of(Organ organ) {
    constexpr std::string_view names[] = {"", "segment", "ball", "disc", "polygon", "model"};
    return names[static_cast<std::size_t>(organ)];
}

/// A part of a plant: a module of a derived word that is a letter of the model's own or draws something, or
/// something that is drawn in the place of one.
struct PlantModule {
    static constexpr std::uint32_t none = UINT32_MAX;
    static constexpr std::uint16_t no_name = UINT16_MAX;

    std::uint16_t name = 0; ///< among Plant::names
    std::vector<double> parameters;
    std::uint32_t parent = none;    ///< the module that bears it; none of the first
    std::uint32_t part_of = none;   ///< the module of the word in whose place it is drawn
    std::uint32_t last_part = none; ///< the last of its parts on its own axis, from which that goes on
    bool branches = false;          ///< it begins a branch of its parent; else it follows it on the same axis
    std::uint32_t order = 0;        ///< of its axis: 0 of the main one, 1 of its branches
    std::uint32_t rank = 0;         ///< place on its axis, from 0 on
    Vec3 start{0.0}, end{0.0};      ///< where the turtle stands before and after it, in the model's units
    Vec3 heading{0.0}, left{0.0}, up{0.0}; ///< unit vectors, before it
    Organ organ = Organ::none;
    std::uint16_t material = no_name; ///< among Plant::materials
    // Sums over its parts, where it has some:
    double length = 0; ///< of segments
    double area = 0;   ///< of the surface, ends of segments left out; of flat organs one side
    double volume = 0;
    bool is_measured = true; ///< or area and volume lack those of models
    double width = 0;        ///< diameter of what it draws; of others, of segments after it
    double base_width = 0;   ///< of a segment, where it begins
    double age = -1;         ///< steps since it came into being; -1: not known
};

/// Whether a module or a body is drawn as a segment that has a length.
template<typename Drawn> bool is_segment(const Drawn& drawn) {
    return drawn.organ == Organ::segment && drawn.length > 0;
}

/// Whether it is drawn as a blade: a polygon, a disc, or a flat model (lsys/turtle/flat_model.h).
template<typename Drawn> bool is_blade(const Drawn& drawn) {
    return drawn.organ == Organ::polygon || drawn.organ == Organ::disc ||
           (drawn.organ == Organ::model && drawn.is_measured);
}

using PlantTriangle = std::array<Vec3, 3>;

/// One side of a polygon, or of a model that is flat (lsys/turtle/flat_model.h).
struct PlantBlade {
    std::uint32_t module = 0; ///< among Plant::modules
    std::uint32_t shape = 0;  ///< among Plant::shapes
    Affine world_from_shape;
    double half_thickness = 0; ///< distance from the triangles to what is drawn, in the world, at most
};

/// The structure of a plant: modules in the order of the word, so that parents come before what they bear.
struct Plant {
    std::vector<std::string> names;
    std::vector<std::string> materials;
    std::vector<PlantModule> modules;
    std::vector<std::vector<PlantTriangle>> shapes; ///< each in a frame of its own
    std::vector<PlantBlade> blades;                 ///< in the order of the modules
    double steps = 0;                               ///< of the derivation
};

} // namespace graftal
