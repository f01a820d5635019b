#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/lower/lowering.h"
#include "compiler/rifs/ast.h"

// A `.rifs` file between its tree and the graph: names looked up, numbers evaluated, digraphs spelled out.

namespace graftal {

/// One map w_j of one block.
struct RifsNode {
    const RifsMap* source = nullptr;
    std::uint32_t block = 0;
    std::string name; ///< `w3` for the third map of its block, if it has no label
    Affine map;
    Tint tint;
    std::optional<MaterialId> material;
    std::optional<std::uint32_t> from;  ///< the block whose attractor it takes
    std::vector<std::uint32_t> masters; ///< nodes that w_j may follow, ascending
    std::vector<double> weights;        ///< of the masters, from a matrix of probabilities; empty: all alike
    std::optional<double> probability;  ///< probability of w_j, for random iteration
    bool empty = false;                 ///< A_j is the empty set
};

struct RifsSubsystem {
    const RifsBlock* source = nullptr;
    std::uint32_t first = 0; ///< its nodes are [first, end)
    std::uint32_t end = 0;
    std::vector<std::uint32_t> start; ///< nodes that the attractor unions, ascending
};

struct RifsSystem {
    std::vector<RifsNode> nodes; ///< of all blocks, in the order of the text
    std::vector<RifsSubsystem> blocks;
    std::uint32_t main = 0; ///< the block to draw

    /// The block whose condensation and terminal w_j is applied to.
    std::uint32_t block_under(const RifsNode& node) const { return node.from.value_or(node.block); }
};

/// A probability of random iteration; nothing if it is not stated. Errors are reported and give nothing;
/// their hint says what to do. `row`: of `codes` that it stands in, counted from 1; 0: in none.
std::optional<double> evaluate_probability(const std::optional<Expression>& probability,
                                           const Environment& lets, Diagnostics& diagnostics,
                                           std::size_t row = 0);

/// Evaluates the tints and materials that the tree names. Errors are reported and give the neutral ones.
class RifsLooks {
  public:
    /// `materials`: of the graph that is being made, which takes up those that every model knows as they are
    /// named. All must outlive this.
    RifsLooks(const Environment& lets, std::vector<Material>& materials, Diagnostics& diagnostics);

    Tint tint(const RifsLook& look) const;
    std::optional<MaterialId> material(const RifsLook& look);

  private:
    const Environment& lets_;
    std::vector<Material>& materials_;
    Diagnostics& diagnostics_;
    std::unordered_map<std::string, MaterialId> ids_;
};

/// Numbers the blocks and maps, and evaluates the maps' transforms, looks and probabilities. Errors are
/// reported; the nodes are there in any case.
RifsSystem evaluate_rifs(const RifsFile& file, const Environment& lets, RifsLooks& looks,
                         Diagnostics& diagnostics);

/// The map of a row of codes (docs/language.md): 2-D forms scale z by sqrt|det|. `numbers`: as many as
/// `form` has.
Affine map_from_codes(RifsForm form, const std::vector<double>& numbers);

/// Control points of a row of `codes barycentric` with so many numbers: three of the plane or four of space.
inline std::size_t control_points(std::size_t codes) {
    return codes == 28 ? 4 : 3;
}
/// Control points of such a row: they follow the weights.
std::vector<Vec3> control_of(const std::vector<double>& codes);

/// Looks up `from`, `start` and `follow` and fills the masters. Errors are reported; false if the digraphs
/// are larger than the options allow.
bool resolve_digraphs(RifsSystem& system, const Environment& lets, Lowering& lowering);

/// Marks the nodes whose sets are empty: those from which no chain of masters reaches a cycle or a block
/// with a condensation set. Warns of each; an empty main block is an error. O(nodes + edges).
void mark_empty(RifsSystem& system, Diagnostics& diagnostics);

} // namespace graftal
