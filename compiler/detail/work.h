#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace graftal {

/// Work is counted, not timed, so that a picture does not depend on the machine or on what else it does.
/// These many steps stand for a second of one processor of 2024.
struct WorkRates {
    static constexpr double ray_steps = 1.1e8;      ///< of rays, shading included (RayWork)
    static constexpr double samples = 1.2e7;        ///< of pixels, whatever their rays meet
    static constexpr double shell_points = 6e6;     ///< points of shells moved (shell/points.h)
    static constexpr double mesh_triangles = 1.5e6; ///< triangles of meshes sorted into boxes for rays
    static constexpr double leaves = 4e6;           ///< leaves unfolded into placements
    static constexpr double visits = 1.5e7;         ///< parts visited to make a mesh of a node (LeafWalk)
    static constexpr double baked_triangles = 4e6;  ///< triangles of such meshes
    static constexpr double kinds = 4.5e6;          ///< edges of kinds followed to weigh them (Weights)
    static constexpr double trace_edges = 2e5; ///< edges of a prepared graph made ready for rays (TraceModel)
    static constexpr double parts_gone_by = 1e7;   ///< by the rays of SelfShadows
    static constexpr double denoised_pixels = 7e5; ///< pixels of a picture whose noise is taken out
    static constexpr double pieces = 3e6;          ///< pieces looked at to choose among them (choose_cut())
};

/// Slowness of steps through a graph, as a factor: a small one is in the processor's caches, a large one is
/// waited for. Measured on graphs of 1.1 and 1.8 million instances.
inline double slowness_of_graph(std::uint64_t instances) {
    constexpr double at_home = 2e5, a_doubling = 0.4;
    return 1 + a_doubling * std::max(0.0, std::log2(static_cast<double>(instances) / at_home));
}

/// Work allowed for a picture, less that of the stages before: half in any case, for their prices are high.
inline double work_after_stages(double work_seconds, double spent_seconds) {
    return std::max(work_seconds - spent_seconds, 0.5 * work_seconds);
}

/// Steps that rays take, each about as long as others: what a part takes depends on how it is placed.
struct RayWork {
    static constexpr std::uint64_t part = 8;      ///< gone into
    static constexpr std::uint64_t stretched = 4; ///< more, for one that a map other than a similarity places
    static constexpr std::uint64_t doubted = 3;   ///< more, for one that may be crushed: its map is looked at
    static constexpr std::uint64_t widened = 24;  ///< a leaf that is drawn larger than it is
    static constexpr std::uint64_t crushed = 12;  ///< looked at in the world: no ray is taken into its frame
    static constexpr std::uint64_t image = 44; ///< the plane or line that a crushed part is in, and its size
    static constexpr std::uint64_t leaf_in_world = 4; ///< a leaf there, held against the ray as a ball
    static constexpr std::uint64_t asked = 10; ///< an operand of a combination, for one place of the ray
    static constexpr std::uint64_t boxes = 1;  ///< boxes of one node, held against a ray
    static constexpr std::uint64_t boxes_of_packet = 3; ///< against all rays of a packet
    static constexpr std::uint64_t mesh_step = 4;       ///< a node or a triangle of a mesh's tree
    static constexpr std::uint64_t shaded = 4;          ///< a level of the path to what is seen
    static constexpr std::uint64_t pattern_wave = 1;    ///< of a solid pattern (SolidPattern::waves())
    static constexpr std::uint64_t lamp = 4;            ///< a sharp light on what is seen, besides its ray
    static constexpr std::uint64_t soft_lamp = 12;      ///< one that is sampled
    static constexpr std::uint64_t sky = 16;            ///< the sky likewise
    static constexpr std::uint64_t bright_sky = 48;     ///< a picture of one, with bright parts
};

} // namespace graftal
