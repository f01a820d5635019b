#pragma once

#include <cstddef>
#include <cstdint>

#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// A node with the levels it has left and the detail of a unit of its frame: what is unfolded once, or baked
/// as one mesh. Details are counted in steps of 2^(1/256), or as whoever unfolds says. A unit and not the
/// node's diameter: where nothing is scaled on the way down, as in most L-systems, nothing is rounded then,
/// and a node makes one kind.
struct PieceKind {
    NodeId node = 0;
    std::uint32_t steps = unlimited_steps;
    std::int32_t unit_step = endless_detail;

    static constexpr std::int32_t endless_detail = INT32_MAX;
    static constexpr std::int32_t tiny = INT32_MIN; ///< small enough to be culled, with all that is in it
    static constexpr int steps_an_octave = 256;

    /// Steps of a detail, or of a factor.
    static double steps_of(double detail);
    /// The step of a detail, rounded up.
    static std::int32_t step_of(double detail);
    bool operator==(const PieceKind&) const = default;
};

struct PieceKindHash {
    std::size_t operator()(const PieceKind& kind) const;
};

/// The kind of all that differ from this one by nothing but levels, where the node is ending: it has no use
/// for them.
inline PieceKind without_idle_levels(const DetailGraph& cut, PieceKind kind) {
    if (!cut.nodes[kind.node].unending) kind.steps = unlimited_steps;
    return kind;
}

/// The detail from which down a cullable node is cut, 1 at least: more if its terminal takes its place before
/// it is culled. `error_px`: as Projection::error_px().
double cut_detail(const DetailNode& node, double error_px);

/// The rule that ends recursion: no level left, or too small.
bool is_cut(const DetailNode& node, std::uint32_t steps, double detail, double error_px);

/// The rule of is_cut(). `small`: enough to be cut for its size.
bool ends_by(const DetailNode& node, std::uint32_t steps, bool small);

} // namespace graftal
