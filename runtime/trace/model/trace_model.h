#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/graph/ending.h"
#include "compiler/detail/prepare.h"
#include "compiler/detail/projection.h"
#include "compiler/detail/self_shadow.h"
#include "compiler/detail/shell/sizes.h"
#include "compiler/scene/scene.h"
#include "compiler/support/control.h"
#include "compiler/support/ray.h"
#include "compiler/unfolded/drawn_bounds.h"
#include "compiler/unfolded/layers.h"
#include "runtime/image/texture.h"
#include "runtime/trace/model/box_tree.h"
#include "runtime/trace/model/even_parts.h"
#include "runtime/trace/model/lanes.h"
#include "runtime/trace/model/leaf_group.h"
#include "runtime/trace/model/mesh_store.h"
#include "runtime/trace/model/near_enough.h"
#include "runtime/trace/model/specks.h"

namespace graftal {

inline constexpr std::uint32_t no_edge = UINT32_MAX;
/// Marks an edge of a path that starts at a cut node.
inline constexpr std::uint32_t from_cut = 1u << 31;

/// An instance as rays go through it. Frames are not those of the graph: each node that is a union has one of
/// its own, in which all that it draws fills the cube [-1, 1]^3 or nearly so. Single precision then suffices
/// to test boxes, wherever and however large the model is. What a ray asks of every one comes first, in few
/// lines of the processor's caches: in a large model it waits for them.
struct alignas(64) TraceEdge {
    double stretch = 1;  ///< norm of the linear part of parent_from_child
    double growth = 1;   ///< 1 / stretch
    double flatness = 1; ///< the least stretch, as a share of the largest; child_from_parent is only used if
                         ///< it is not too little
    std::uint32_t child = 0;
    unsigned levels = 0;
    bool similarity = false;   ///< then a path's norm is the product of its stretches
    bool upright = false;      ///< only scales evenly and moves: rays keep their directions
    bool to_primitive = false; ///< leads to one
    LaneMap parent_from_child;
    LaneMap child_from_parent;
    Box box;          ///< holds the child's drawing, in the parent's frame
    double turns = 1; ///< of a primitive: length_in_turns() of the graph's instance

    void find_upright();
};

/// Data of an edge for the look of a hit below it, in one line of the processor's caches.
struct alignas(64) TraceLook {
    PathTint tint;
    std::optional<MaterialId> material;
    /// The last node on the way through the edge that is no primitive, as the graph numbers it; none: the one
    /// before.
    std::uint32_t node = none;
    std::uint32_t child = 0;
    unsigned levels = 0;
    /// Parts of the way, for an unrolling's edge that leads several levels down: one of its edges or the
    /// node's, and one of that child's. `last` may be marked as one from a cut node.
    std::uint32_t before = no_edge, last = no_edge;
    std::uint16_t length = 1;    ///< of the way, in edges
    bool as_one = true;          ///< its tint, material and node are those of the whole way
    bool child_has_mean = false; ///< marked edges from the child have the colours below it in front of them

    static constexpr std::uint32_t none = UINT32_MAX;
};
static_assert(sizeof(TraceLook) == 64);

/// The parts some levels below a node, as if they were its own: boxes are faster to test than frames to
/// enter. They may take the place of the node's edges where none of the nodes passed over would be cut or
/// baked.
struct Unrolling {
    std::uint32_t tree = no_tree;
    std::uint32_t least_steps = 0; ///< levels that must be left
    /// Least diameter of a node passed over that may be culled, in the node's frame, by its cut_detail.
    double least_size = std::numeric_limits<double>::infinity();
    double flattest_edge = 1; ///< the least flatness on the ways
    /// Tree of primitives: the drawing of its parts if each is cut that can be. None where some primitives
    /// are not only scaled evenly and moved, or there are too many.
    std::uint32_t leaf_tree = no_tree;
    double most_size = -1; ///< the largest diameter of such a part, likewise; negative if there is none
    /// The largest diameter of a part that is a speck where it is cut, over the detail below which it is
    /// one; infinite if some part is none.
    double most_speck_size = std::numeric_limits<double>::infinity();
    /// Levels that are left where no such part has any left; no_steps: never.
    std::uint32_t last_steps = no_steps;

    static constexpr std::uint32_t no_steps = std::numeric_limits<std::uint32_t>::max() - 1;
};

struct alignas(64) TraceNode {
    enum class Kind : std::uint8_t {
        primitive,
        parts,     ///< a union
        unbounded, ///< a union that holds planes, which no box holds
        run,       ///< a range of a run
        combined,  ///< an intersection or a difference of its edges (traverse/combined.cpp)
        crushed,   ///< leads through a singular map (DetailNode::sealed): its edges are met in the world
                   ///< (traverse/flat_walk.cpp)
    };

    Double4 ball_centre{}; ///< this first, as in TraceEdge
    double ball_radius = 0;
    double reach = 0; ///< from ball_centre; the balls of all nodes that unrollings pass over or lead to are
                      ///< within it
    double cut_detail = 1; ///< the largest detail at which a cullable node is cut
    Kind kind = Kind::parts;
    bool unending = false;
    bool cullable = true;
    bool faint = false;                ///< of no area (DetailNode::shadowless)
    bool widens = false;               ///< DetailNode::widens
    std::uint32_t tree = no_tree;      ///< of its edges, or its items of the run
    std::uint32_t stop_tree = no_tree; ///< tree of its drawing where it is cut; none: its proxy
    std::uint32_t first_edge = 0;      ///< of its edges, which follow each other
    std::uint32_t edge_count = 0;
    std::uint32_t endless_count = 0;   ///< of an unbounded union: the first of its edges, which `tree` lacks
    std::uint32_t stop_edge_count = 0; ///< which follow those
    Combination combination = Combination::unite; ///< of its edges
    bool stops_combined = false;                  ///< its stop edges are operands too, no terminal
    bool has_endless_operands = false;            ///< some operand is unbounded
    std::uint32_t first_unrolling = 0;            ///< the deepest first
    std::uint32_t unrolling_count = 0;
    std::uint32_t run = 0;         ///< of TraceModel::runs
    std::uint32_t first_speck = 0; ///< of TraceModel::specks: of what is drawn where it is cut and faint
    std::uint32_t speck_count = 0;
    ShellSizes shell;
    Primitive primitive = PrimitiveKind::sphere;
    double flattest_edge = 1; ///< least flatness of its edges
    double drawn_radius = 0;  ///< about the frame's origin; of what it draws, except for widening
    LaneMap node_from_proxy;  ///< places the unit sphere
    LaneMap proxy_from_node;
};

/// A run as rays meet it. An edge for each look of its parts has its material; where a part lies says the
/// run.
struct TraceRun {
    struct Look {
        RunShape shape;
        std::uint16_t colour;
        std::uint32_t edge;
    };

    const Run* run = nullptr;
    std::vector<Look> looks;
    bool pictured =
        false; ///< some part of it has a texture, so that it matters how it is turned about its axis

    std::uint32_t edge_of(RunShape shape, std::uint16_t colour) const;
};

/// The pictures that a model's materials name, read.
struct ModelTextures {
    std::vector<std::shared_ptr<const Texture>> of_material; ///< null where there is none; empty: nowhere
    std::shared_ptr<const Texture> of_ground;                ///< or null
};

/// Parts that models of one graph and view have in common, whatever their error.
struct TraceBasis {
    /// `work_seconds`: allowed for the picture. The flag ends it by Cancelled.
    TraceBasis(const PreparedGraph& prepared, double work_seconds, const CancelFlag& cancel = {});

    LayeredGraph layers; ///< of prepared.cut
    DrawnBounds bounds;  ///< of the layers
    /// Sizes by node of the cut, of the first model; empty where rays come through everywhere. Found for each
    /// model where they depend on the error.
    std::optional<std::vector<ShellSizes>> shell_sizes;
    SelfShadowStore self_shadows;
};

/// A prepared graph made ready for rays, for one view. It is read by many threads.
struct TraceModel {
    std::shared_ptr<const PreparedGraph> shared; ///< never null; may be that of other views too
    const PreparedGraph& prepared;               ///< *shared
    std::shared_ptr<TraceBasis> basis;           ///< never null; models of other errors share it
    const LayeredGraph& layers;                  ///< the basis'
    View view;
    DetailOptions options;
    Projection projection;
    double least_detail_per_unit = 0; ///< of Projection, anywhere on the model
    double most_half_width = 0;       ///< likewise, where something is drawn wider than it is
    double widest = 1;                ///< of all primitives: widened_reach()
    NearEnough near_enough;           ///< hits on a set in a plane

    std::vector<TraceNode> nodes; ///< by number of layers.cut.nodes
    std::vector<TraceEdge> edges; ///< the first leads to the root, from world space
    std::vector<TraceLook> looks; ///< by edge
    /// Number of the instance among those of its node, by edge without those of unrollings. Primitives of a
    /// group that is spelt out have one.
    std::vector<std::uint32_t> places;
    std::vector<BoxNode> boxes;
    std::vector<PackedNode> packed_boxes; ///< of runs
    std::vector<Unrolling> unrollings;
    std::vector<SpeckLanes> specks;
    std::vector<TraceRun> runs;
    std::vector<Affine> graph_from_frame; ///< by node
    mutable MeshStore meshes;             ///< of shells
    ModelTextures textures;               ///< of_material has all materials
    /// Nodes and primitives that one ray may go into. Sound models need some tens or hundreds; where
    /// thousands of parts coincide, a ray would not come to an end.
    std::uint64_t most_visits = usual_visits;
    static constexpr std::uint64_t usual_visits = 1 << 17;
    /// More of them, for a ray that was given up before it met anything: it looks into no more parts that may
    /// be culled, so that few are left.
    std::uint64_t more_visits() const { return std::clamp<std::uint64_t>(most_visits, 32, 256); }
    bool has_shells = false;   ///< some node may be drawn as one; never beside combined nodes
    std::uint64_t weighed = 0; ///< edges of kinds followed to find where (Weights)
    bool clear_texels = false; ///< some texture has them
    /// True if all is bounded, of no run, drawn no wider than it is, opaque, and only scaled evenly and moved
    /// down to the primitives: rays go through it faster (traverse/even.h).
    bool even = false;
    std::vector<EvenPart> even_parts; ///< by edge, if it is
    std::vector<EvenOffset> even_offsets;
    std::vector<EvenTriangles> even_triangles; ///< of groups

    /// Shadows of the view's lights; measured when they are first asked for: the flag ends that
    /// by Cancelled.
    const SelfShadows& self_shadows(const CancelFlag& cancel = {}) const;

    /// The node as the cut has it.
    const DetailNode& source(std::uint32_t node) const { return prepared.cut.nodes[layers.source[node]]; }

    /// Materials without a texture of theirs show their colour. `basis`: of the same graph and view, or
    /// null. The flag ends it by Cancelled.
    TraceModel(std::shared_ptr<const PreparedGraph> prepared, const View& view, const DetailOptions& options,
               ModelTextures textures = {}, std::shared_ptr<TraceBasis> basis = nullptr,
               const CancelFlag& cancel = {});
    TraceModel(const TraceModel&) = delete;
    TraceModel& operator=(const TraceModel&) = delete;
};

/// Planes, and what holds them, have no bounds.
inline bool is_endless(const TraceNode& node) {
    return node.kind == TraceNode::Kind::unbounded ||
           (node.kind == TraceNode::Kind::primitive && node.primitive == PrimitiveKind::plane);
}

/// The rule of the cut. `detail`: of the part's diameter.
inline bool is_cut(const TraceNode& node, std::uint32_t steps, double detail) {
    if (node.kind == TraceNode::Kind::unbounded || node.kind == TraceNode::Kind::crushed) return false;
    return ends_recursion(node, steps, detail <= node.cut_detail);
}

} // namespace graftal
