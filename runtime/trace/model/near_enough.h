#pragma once

#include <cstdint>

#include "compiler/support/ray.h"

namespace graftal {

struct PreparedGraph;
struct TraceBasis;
struct TraceModel;

/// Parts of a set without thickness after which a ray's best hit is near enough. No hit may be nearer by
/// more than this share of the half width of the parts: thousands may lie in each other.
inline constexpr std::uint64_t most_patience = 256;
inline constexpr double near_enough_share = 0.25;
/// A hit so near is near enough at once: flat tops of parts in one plane are all as near.
inline constexpr double plenty_share = 1e-4;

/// How far what is drawn reaches out of a set without end that lies in a plane across an axis, and is drawn
/// in parts wider than they are.
struct NearEnough {
    int axis = -1;             ///< across the plane; -1: there is none, and no hit is near enough
    double middle = 0;         ///< the plane's place there
    double widened_reach = 1;  ///< of widened parts out of it, in half widths
    double terminal_reach = 0; ///< of terminals from the middle of what they stand for, in errors

    NearEnough() = default;
    /// `most_half_width`: TraceModel's. `error_px`: Projection::error_px().
    NearEnough(const PreparedGraph& prepared, const TraceBasis& basis, double most_half_width,
               double error_px);

    /// Distance up to which a hit is near enough, if none can be nearer by more than this share of the half
    /// width; before all where the model is no such set. `model`: that it is of.
    double distance(const TraceModel& model, const Ray& ray, double share) const;
};

} // namespace graftal
