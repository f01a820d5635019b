#pragma once

#include <optional>
#include <vector>

#include "compiler/rifs/system.h"

namespace graftal {

/// Chances of instances (graph.h) for random iteration on a recurrent IFS by its probabilities (Barnsley,
/// Elton and Hardin 1989). They are those of the walk that takes the maps in the opposite order, from the
/// last to the first.
///
/// After w_i comes w_j, of those that the control digraph allows. Its chance is in proportion to the
/// probability of w_j and to the entry (i, j) of the matrix, if there is one. With condensation sets, one of
/// them begins anew with its own probability.
struct RifsChances {
    std::vector<double> share;              ///< by node: of the points, those that w_j is applied to last
    std::vector<double> weight;             ///< by node: what its probability is, or is taken for
    std::vector<double> row;                ///< by node: what the weights of all that may follow sum up to
    std::vector<double> block_row;          ///< by block: the same of its condensation sets
    std::vector<double> block_share;        ///< by block: of the points, those in condensation sets
    std::vector<double> block_anew;         ///< by block: the chance to begin with these sets anew
    std::vector<std::vector<double>> parts; ///< by block, by condensation set: its share of those

    /// The chances of one node's object: relative to each other, by the place of the master or set.
    struct OfNode {
        std::vector<double> masters;
        std::vector<double> condensations;
    };
    OfNode of(const RifsSystem& system, const RifsNode& node) const;
    double condensation(std::uint32_t block, std::size_t i) const {
        return block_share[block] * parts[block][i];
    }
};

/// Nothing if no probabilities are stated. `condensations`: by block, by set, as stated. Maps without one
/// share what the others of their block, and its sets, leave by their sizes, at least a hundredth each. A
/// system of which some part is never left, or never entered again, begins anew at a random map once in
/// twenty times. Requires resolved digraphs and marks of the empty nodes.
std::optional<RifsChances> rifs_chances(const RifsSystem& system,
                                        const std::vector<std::vector<std::optional<double>>>& condensations);

} // namespace graftal
