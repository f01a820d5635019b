#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/ext/quaternion_double.hpp>

#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/support/affine.h"
#include "compiler/support/id_table.h"

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

using Quat = glm::dquat;

/// The state of the turtle that comes in: all that a part of a model may depend on besides its place.
/// Directions are given in the frame that the part starts in.
struct TurtleState {
    double width = 0;
    std::uint8_t tapers = 0; ///< of its branch and those that this leaves, at most most_tapers
    int colour = 0;          ///< a place in the palette: what is counted goes around it
    double elasticity = 0;   ///< of tropism
    Vec3 tropism{0.0};       ///< unit vector that segments bend towards
    Vec3 vertical{0.0};      ///< unit vector that `$` looks at
    std::uint32_t open_polygons = 0;
    bool in_cylinder = false; ///< a generalised one
    Vec3 control_point{0.0};  ///< its last, in the frame of the start
    double control_width = 0;
    double limb_radius = 0;    ///< of the limb that comes to here, where limbs get a skin; 0: none does
    std::uint32_t variant = 0; ///< of what is random (compose/composer.h)
    std::uint32_t birth = 0;   ///< the step in which the module came into being
    double unit = 1;           ///< how long a length of 1 is that the model writes (compose/composer.h)
    double ruler = 1;          ///< length of 1 that does not go with the step, where the step varies
    bool turns_reversed = false;
    double angle_factor = 1;                  ///< of turns without a parameter
    Quat second = Quat(1, 0, 0, 0);           ///< the second axes, from those of the turtle
    std::shared_ptr<const TurtleFrame> frame; ///< the world; null where no symbol asks for it
};

/// Number of times that branches of branches become finer: after these they are too fine for one to see a
/// difference, and parts of a long derivation would come in too many widths.
inline constexpr std::uint8_t most_tapers = 12;

/// The members of a TurtleState, as a set.
using TurtleStateMask = std::uint32_t;
enum TurtleStateBit : TurtleStateMask {
    reads_width = 1,
    reads_colour = 2,
    reads_elasticity = 4,
    reads_tropism = 8,
    reads_vertical = 16,
    reads_polygons = 32, ///< whether some are open
    reads_variant = 64,
    reads_cylinder = 128, ///< whether there is one
    reads_birth = 256,
    reads_control = 512, ///< its last control point, with the width there
    reads_unit = 1024,
    reads_polygon_count = 2048, ///< how many are open
    reads_angle = 4096,         ///< its factor
    reads_second = 8192,
    reads_ruler = 16384,
    reads_reversal = 32768,
    reads_tropisms = 65536, ///< all but the first
    reads_axes = 131072,    ///< of the world
    reads_origin = 262144,  ///< and its unit
    reads_tapers = 524288,
    reads_limb = 1048576, ///< the radius of the one that comes to here
};

/// The state in a frame in which all is this many times as long.
TurtleState scaled(TurtleState state, double factor);

/// True if the members of `mask` are equal.
bool equal(const TurtleState& a, const TurtleState& b, TurtleStateMask mask);
/// A hash of the members of `mask`.
std::uint64_t hash(const TurtleState& state, TurtleStateMask mask);

/// Directions that differ by rounding only, or by a small angle, made equal: the first that came stands for
/// all within the tolerance.
class DirectionTable {
  public:
    static constexpr double rounding = 1e-11;

    /// `tolerance`: a distance between unit vectors, at most 1.
    explicit DirectionTable(double tolerance = rounding) : tolerance_(tolerance) {}

    /// Requires a vector no longer than 1, up to rounding.
    Vec3 representative(Vec3 direction);

  private:
    double tolerance_;
    std::vector<Vec3> known_;
    IdTable ids_; ///< by cells of four tolerances
};

/// Rotations that differ by rounding only, made equal. Without this the errors of a rotation that is
/// composed of seven like itself, level by level, would grow sevenfold a level.
class RotationTable {
  public:
    RotationTable() { representative(Mat3(1.0)); } // exactly, for what comes near it

    /// Requires a rotation, up to rounding, and gives one.
    Mat3 representative(const Mat3& rotation);
    /// The quaternion that stands for one; for equal rotations its numbers are equal.
    Quat representative(const Quat& rotation);

  private:
    std::vector<Mat3> known_;
    IdTable ids_;
};

} // namespace graftal
