#include "runtime/gpu/flat_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// Small cells stay in the caches of a card.
constexpr std::size_t most_parts = 512, most_deep_parts = 1024, most_new_edges = 65'536;
constexpr int most_levels = 6;

bool is_endless(const FlatEdge& edge) {
    return !(edge.box[3] < flat_endless);
}

Box common(const Box& a, const Box& b) {
    const Vec3 min = glm::max(a.min, b.min), max = glm::min(a.max, b.max);
    return {glm::min(min, max), glm::max(min, max)}; // by rounding, of what is flat
}

/// Boxes that hold together all that a node draws, in its frame. A part that is turned is held closer by the
/// boxes of many small pieces than by that of its one box.
class Covers {
  public:
    explicit Covers(const FlatGraph& graph) : graph_(graph), covers_(graph.nodes.size()) {}

    const std::vector<Box>& of(std::uint32_t id) {
        if (covers_[id].empty()) covers_[id] = cover(id);
        return covers_[id];
    }

  private:
    static constexpr std::size_t most_pieces = 64;
    static constexpr int most_splits = 64;

    struct Piece {
        Box box;
        Affine place;
        std::uint32_t node = flat_none; ///< that may be split
        double size() const { return node == flat_none ? 0 : glm::length(box.size()); }
    };

    /// Puts those of a node's parts into the heap.
    void split(const Piece& whole, std::vector<Piece>& pieces) const {
        const FlatNode& node = graph_.nodes[whole.node];
        const auto add = [&](const Box& box, const Affine& place, std::uint32_t child) {
            pieces.push_back({common(transformed(whole.place, box), whole.box), place, child});
            std::ranges::push_heap(pieces, {}, &Piece::size);
        };
        for (std::uint32_t i = 0; i < node.edge_count + node.stop_edge_count; ++i) {
            const FlatEdge& edge = graph_.edges[node.first_edge + i];
            const bool splits = graph_.nodes[edge.child].primitive == flat_none;
            add(box_of(edge), whole.place * parent_from_child(edge), splits ? edge.child : flat_none);
        }
        if (node.stop_edge_count > 0 || !(node.unending || node.cut_detail > 0)) return;
        add(transformed(frame_from_proxy(node), {Vec3(-1), Vec3(1)}), {}, flat_none);
    }

    std::vector<Box> cover(std::uint32_t id) const {
        std::vector<Piece> pieces;
        constexpr double far = flat_endless;
        split({{Vec3(-far), Vec3(far)}, {}, id}, pieces);
        for (int i = 0; i < most_splits && pieces.size() < most_pieces; ++i) {
            if (!(pieces.front().size() > 0)) break;
            std::ranges::pop_heap(pieces, {}, &Piece::size);
            const Piece largest = pieces.back();
            pieces.pop_back();
            split(largest, pieces);
        }
        std::vector<Box> boxes;
        boxes.reserve(pieces.size());
        for (const Piece& piece : pieces)
            boxes.push_back(piece.box);
        return boxes;
    }

    const FlatGraph& graph_;
    std::vector<std::vector<Box>> covers_;
};

class Cells {
  public:
    explicit Cells(const FlatGraph& graph) : graph_(graph) {}

    FlatCells run() {
        for (const FlatEdge& edge : graph_.edges) {
            cells_.edges.push_back({edge});
            if (!is_endless(edge))
                cells_.edges.back().edge.box = floats_of(held(edge, parent_from_child(edge), box_of(edge)));
        }
        cells_.deep.resize(graph_.nodes.size());
        for (const FlatNode& node : graph_.nodes) {
            std::vector<std::uint32_t>& own = cells_.shallow.emplace_back(node.edge_count);
            std::iota(own.begin(), own.end(), node.first_edge);
        }
        for (std::uint32_t id = 0; id < graph_.nodes.size(); ++id) {
            FlatCell cell = shallow_cell(id);
            while (expand(graph_.nodes[id], cell, most_new_edges,
                          [&](const FlatEdge& edge) { return is_group(edge, cell); })) {
            }
            cells_.shallow[id] = std::move(cell.edges);
        }
        add_levels();
        return std::move(cells_);
    }

  private:
    static bool is_union(const FlatNode& node) { return node.primitive == flat_none && node.edge_count > 0; }

    FlatCell shallow_cell(std::uint32_t id) const {
        return {cells_.shallow[id], std::numeric_limits<float>::infinity(), 0,
                graph_.nodes[id].unending ? 1u : 0u};
    }

    /// A union that is never cut where the parts passed over are not.
    bool is_group(const FlatEdge& edge, const FlatCell& cell) const {
        const FlatNode& child = graph_.nodes[edge.child];
        return is_union(child) && child.cut_detail == 0 && !edge.crushes &&
               (!child.unending || edge.levels < cell.least_steps);
    }

    /// Makes all cells deeper, level by level, as long as there is room.
    void add_levels() {
        std::vector<FlatCell> cells;
        for (std::uint32_t id = 0; id < graph_.nodes.size(); ++id)
            cells.push_back(shallow_cell(id));
        const auto is_passed = [&](const FlatEdge& edge) {
            return is_union(graph_.nodes[edge.child]) && !is_endless(edge) && is_similarity(edge);
        };
        std::vector<bool> is_entered(graph_.nodes.size());
        is_entered[graph_.root] = true;
        for (const auto& shallow : cells_.shallow)
            for (const std::uint32_t number : shallow)
                is_entered[cells_.edges[number].edge.child] = true;
        for (int level = 0; level < most_levels; ++level) {
            std::size_t parts = 0;
            for (std::size_t id = 0; id < graph_.nodes.size(); ++id) {
                if (!is_entered[id] || !is_union(graph_.nodes[id])) continue;
                if (parts < most_deep_parts && expand(graph_.nodes[id], cells[id], most_parts, is_passed))
                    cells_.deep[id].push_back(cells[id]);
                if (!cells_.deep[id].empty()) parts += cells_.deep[id].back().edges.size();
            }
            if (parts >= most_deep_parts / 2) break;
        }
    }

    /// Puts parts of those edges that `holds` names in their places; false if there are none, or too many.
    template<typename Holds>
    bool expand(const FlatNode& node, FlatCell& cell, std::size_t most, const Holds& holds) {
        std::vector<bool> passed;
        std::size_t count = 0, added = 0;
        for (const std::uint32_t number : cell.edges) {
            const FlatEdge& edge = cells_.edges[number].edge;
            passed.push_back(holds(edge));
            const std::size_t parts = passed.back() ? cells_.shallow[edge.child].size() : 0;
            added += parts;
            count += std::max<std::size_t>(parts, 1);
        }
        if (added == 0 || count > most || added_ + added > most_new_edges) return false;
        added_ += added;
        FlatCell deeper = cell;
        deeper.edges.clear();
        for (std::size_t i = 0; i < cell.edges.size(); ++i) {
            const std::uint32_t number = cell.edges[i];
            if (!passed[i]) {
                deeper.edges.push_back(number);
                continue;
            }
            const FlatEdge edge = cells_.edges[number].edge;
            pass_over(node, edge, deeper);
            for (const std::uint32_t last : cells_.shallow[edge.child])
                deeper.edges.push_back(join(number, last));
        }
        cell = std::move(deeper);
        return true;
    }

    /// Notes what must hold for a node to be gone through.
    void pass_over(const FlatNode& node, const FlatEdge& edge, FlatCell& cell) const {
        const FlatNode& child = graph_.nodes[edge.child];
        if (child.unending) cell.least_steps = std::max(cell.least_steps, edge.levels + 1);
        if (child.cut_detail == 0) return;
        cell.least_size = std::min(cell.least_size, child.diameter * edge.stretch / child.cut_detail);
        const auto at = [](const std::array<float, 3>& v) { return Vec3(v[0], v[1], v[2]); };
        const Vec3 centre = parent_from_child(edge)(at(child.centre));
        cell.reach =
            std::max(cell.reach, static_cast<float>(glm::distance(centre, at(node.centre)) * (1 + 1e-6)));
    }

    /// One edge for two after each other. The last of them is always the graph's own, so that a way is taken
    /// apart from its end.
    std::uint32_t join(std::uint32_t before, std::uint32_t last) {
        const PassedEdge& passed = cells_.edges[last];
        if (passed.before != flat_none) {
            const std::uint32_t own = passed.last;
            const auto [place, is_new] = joined_.try_emplace({before, passed.before}, 0);
            if (is_new) place->second = join(before, passed.before);
            return join(place->second, own);
        }
        const FlatEdge first = cells_.edges[before].edge, second = cells_.edges[last].edge;
        const Affine parent_from_middle = parent_from_child(first);
        const Affine whole = parent_from_middle * parent_from_child(second);
        const Mat3 linear = second.crushes ? whole.linear : linear_of(second) * linear_of(first);
        FlatEdge edge = second;
        edge.levels = first.levels + second.levels;
        if (second.material == flat_none) edge.material = first.material;
        edge.stretch = is_similarity(first) && is_similarity(second)
                           ? first.stretch * second.stretch
                           : static_cast<float>(largest_stretch(whole.linear));
        edge.tint = second.tint.under(first.tint);
        for (std::size_t i = 0; i < 9; ++i)
            edge.linear[i] = FloatPair(linear[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
        for (std::size_t i = 0; i < 3; ++i)
            edge.origin[i] = FloatPair(whole.translation[static_cast<int>(i)]);
        if (!is_endless(second))
            edge.box = floats_of(
                held(second, whole, common(box_of(first), transformed(parent_from_middle, box_of(second)))));
        cells_.edges.push_back({edge, before, last});
        return static_cast<std::uint32_t>(cells_.edges.size() - 1);
    }

    /// The part of a box about what an edge draws that the pieces of that leave.
    Box held(const FlatEdge& edge, const Affine& place, const Box& box) {
        if (box.empty() || graph_.nodes[edge.child].primitive != flat_none) return box;
        Box within;
        for (const Box& piece : covers_.of(edge.child))
            within.include(transformed(place, piece));
        return within.empty() ? box : common(box, within);
    }

    const FlatGraph& graph_;
    Covers covers_{graph_};
    FlatCells cells_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> joined_; ///< with what is several edges
    std::size_t added_ = 0;
};

} // namespace

bool is_similarity(const FlatEdge& edge) {
    if (edge.crushes) return false;
    const Mat3 linear = double(edge.stretch) * linear_of(edge), squares = glm::transpose(linear) * linear;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k <= i; ++k)
            if (!(std::abs(squares[i][k] - (i == k ? 1 : 0)) < 1e-6)) return false;
    return true;
}

FlatCells flat_cells(const FlatGraph& graph) {
    return Cells(graph).run();
}

} // namespace graftal
