#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "compiler/detail/bake.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/weights.h"
#include "compiler/povray/cut/calibrate.h"

namespace graftal {

namespace {

constexpr double fewest_leaves = 300;
constexpr double most_leaves = 6000;
constexpr std::size_t most_samples = 16;
constexpr std::size_t max_sample_triangles = 200'000;
/// Where maps shear, many times the leaves may be unfolded that were expected, one upon another.
constexpr std::uint64_t most_visits = 50 * static_cast<std::uint64_t>(most_leaves);

/// A kind of the node with about the right number of leaves, by levels if the model is cut by levels.
bool find_sample(Weights& weights, const DetailGraph& cut, NodeId node, bool by_levels, PieceKind& sample) {
    const std::int32_t whole = PieceKind::step_of(0.5 / cut.nodes[node].ball.radius);
    for (std::int32_t depth = 1; depth < 64; ++depth) {
        sample = {node, unlimited_steps, whole + depth * PieceKind::steps_an_octave / 2};
        if (by_levels) sample = {node, static_cast<std::uint32_t>(depth), PieceKind::endless_detail};
        const double leaves = weights.of(sample).leaves;
        if (leaves > most_leaves) return false;
        if (leaves >= fewest_leaves) return true;
    }
    return false;
}

} // namespace

double visible_cube_triangles(const DetailGraph& cut, const Symmetry& symmetry, std::uint32_t steps,
                              std::uint64_t* visits) {
    constexpr double whole_cube = 12;
    const bool cubes = std::any_of(cut.nodes.begin(), cut.nodes.end(), [](const DetailNode& node) {
        return node.primitive == PrimitiveKind::cube;
    });
    if (!cubes) return whole_cube;
    Weights weights(cut);
    std::set<NodeId> tried;
    for (const DetailEdge& edge : cut.nodes[cut.root].edges) {
        const NodeId node = symmetry.representative[edge.child];
        if (tried.size() >= most_samples) break;
        if (!tried.insert(node).second) continue;
        PieceKind sample;
        if (!cut.nodes[node].unending || cut.nodes[node].unbounded ||
            !find_sample(weights, cut, node, steps != unlimited_steps, sample))
            continue;
        BakeRequest request;
        request.representative = node;
        request.steps = sample.steps;
        request.detail_per_unit =
            sample.unit_step == PieceKind::endless_detail
                ? std::numeric_limits<double>::infinity()
                : std::exp2(static_cast<double>(sample.unit_step) / PieceKind::steps_an_octave);
        request.most_visits = most_visits;
        request.painters = {{symmetry.pair[node], Rgb(0.0)}};
        // Half widths by the usual error of half a pixel, which is the least half width, too.
        if (cut.nodes[node].widens && std::isfinite(request.detail_per_unit))
            request.half_widths_from_unit = Mat3(request.detail_per_unit);
        const Baked baked = bake(cut, symmetry, request, max_sample_triangles);
        if (visits != nullptr) *visits += baked.visits;
        const double nominal = weights.of(sample).triangles;
        if (baked.complete && nominal > 0)
            return whole_cube * std::min(1.0, static_cast<double>(baked.triangles) / nominal);
    }
    return whole_cube;
}

} // namespace graftal
