#pragma once

#include <cstdint>
#include <span>

#include "runtime/trace/model/trace_model.h"

namespace graftal {

/// The normal of the image of a surface, of unit length.
Vec3 transformed_normal(const LaneMap& map, Vec3 normal);

/// The limit's normal (compiler/detail/mesh/limit_normal.h) in world space, where a ray meets the proxy of
/// `node` at this point of the unit sphere. `path`: edges from the root to the node, those from cut nodes
/// marked. Frame by frame upwards, so that no depth costs digits.
Vec3 limit_normal(const TraceModel& model, std::span<const std::uint32_t> path, std::uint32_t node,
                  Vec3 point);

/// The limit's normal for a proxy that is met in the world, at this point, and has this normal there.
Vec3 limit_normal_in_world(const TraceModel& model, std::span<const std::uint32_t> path, Vec3 normal,
                           Vec3 point);

} // namespace graftal
