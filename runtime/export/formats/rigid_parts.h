#pragma once

// An affine map as formats have it that move, turn and scale only.

#include <array>
#include <optional>

#include <glm/gtc/quaternion.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// First scales along the axes, then turns, then moves.
struct MoveTurnScale {
    Vec3 move{0.0};
    glm::dquat turn{1, 0, 0, 0};
    Vec3 scale{1.0};
};

/// The map as one such, if its axes stay at right angles (to 1e-5).
std::optional<MoveTurnScale> move_turn_scale(const Affine& map);

/// The map as two such, the outer first: every linear map is a turn, a scaling and a turn (its singular value
/// decomposition).
std::array<MoveTurnScale, 2> two_moves(const Affine& map);

} // namespace graftal
