#pragma once

#include <array>
#include <cstdint>

#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/support/affine.h"

// The world that the turtle of some models knows beside its own frame.

namespace graftal {

/// A direction that segments bend towards, the more the larger the elasticity.
struct Tropism {
    Vec3 direction{0.0}; ///< unit vector
    double elasticity = 0;
};

/// The world as seen from a frame.
struct TurtleFrame {
    Mat3 axes{1.0};   ///< of the world, by columns; a mirror image if the turtle is one
    Vec3 origin{0.0}; ///< of the world
    double unit = 1;  ///< how long a length of 1 of the world is
    std::array<Tropism, most_other_tropisms> tropisms; ///< all beside the first
};

/// The frame as seen by a turtle that stands here, in a frame where all is `scale` times as long.
TurtleFrame seen_from(const TurtleFrame& frame, const Affine& start_from_turtle, double scale);

/// A hash with one number more, bit by bit.
std::uint64_t mixed_number(std::uint64_t hash, double number);
std::uint64_t mixed_vector(std::uint64_t hash, const Vec3& v);

/// Elasticities, with the directions of those that are not 0.
bool equal_tropisms(const TurtleFrame& a, const TurtleFrame& b);
std::uint64_t hash_of_tropisms(std::uint64_t hash, const TurtleFrame& frame);
std::uint64_t hash_of_axes(std::uint64_t hash, const TurtleFrame& frame);
/// Where the world is, and how large.
bool equal_places(const TurtleFrame& a, const TurtleFrame& b);
std::uint64_t hash_of_origin(std::uint64_t hash, const TurtleFrame& frame);

} // namespace graftal
