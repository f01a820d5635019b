#include "compiler/detail/graph/congruence.h"

#include <algorithm>
#include <cmath>

namespace graftal {

namespace {

/// Coverage is a mean over them (shadow/coverage.h), which more do not change.
constexpr std::size_t most_symmetries = 96;

bool agree(const Affine& a, const Affine& b, double size) {
    return largest_entry(a.linear - b.linear) < 1e-7 &&
           largest_entry(a.translation - b.translation) < 1e-7 * size;
}

} // namespace

Congruence find_congruence(const DetailGraph& cut, const Symmetry& symmetry) {
    const auto count = static_cast<NodeId>(cut.nodes.size());
    std::vector<std::vector<std::uint32_t>> pairs_of(count);
    for (std::uint32_t p = 0; p < symmetry.pairs.size(); ++p) {
        const NodePair& pair = symmetry.pairs[p];
        if (pair.a == pair.b && pair.b_from_a == Affine()) continue;
        pairs_of[pair.a].push_back(p);
        if (pair.b != pair.a) pairs_of[pair.b].push_back(p);
    }
    Congruence result;
    result.root.assign(count, UINT32_MAX);
    result.node_from_root.resize(count);
    result.symmetries.resize(count);
    std::vector<bool> met(symmetry.pairs.size(), false);
    for (NodeId first = 0; first < count; ++first) {
        if (result.root[first] != UINT32_MAX) continue;
        result.root[first] = first;
        std::vector<NodeId> queue = {first};
        for (std::size_t next = 0; next < queue.size(); ++next) {
            for (const std::uint32_t p : pairs_of[queue[next]]) {
                if (met[p]) continue;
                met[p] = true;
                const NodePair& pair = symmetry.pairs[p];
                const bool forward = pair.a == queue[next];
                const NodeId other = forward ? pair.b : pair.a;
                const Affine other_from_root =
                    (forward ? pair.b_from_a : inverse(pair.b_from_a)) * result.node_from_root[queue[next]];
                if (result.root[other] == UINT32_MAX) {
                    result.root[other] = first;
                    result.node_from_root[other] = other_from_root;
                    result.order.push_back(p);
                    queue.push_back(other);
                    continue;
                }
                const Affine own = inverse(result.node_from_root[other]) * other_from_root;
                auto& known = result.symmetries[first];
                const double size = std::max(cut.nodes[first].ball.radius, 1e-280);
                const auto same = [&](const Affine& a) { return agree(a, own, size); };
                if (known.size() < most_symmetries && !same(Affine()) &&
                    std::none_of(known.begin(), known.end(), same))
                    known.push_back(own);
            }
        }
    }
    return result;
}

} // namespace graftal
