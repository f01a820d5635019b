#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/support/control.h"
#include "runtime/inverse/lsystem/growth.h"
#include "runtime/inverse/lsystem/stroke_graph.h"

namespace graftal {

/// Looks for the order of letters in the rules of a growth, in a drawing that is a tree. The growth says how
/// many strokes a letter draws, so where its part of the tree may end. A letter draws equal parts wherever
/// it stands with as many steps to go. Shapes of parts are compared by hashes, made from the tips down (Aho,
/// Hopcroft and Ullman 1974, section 3.2, isomorphism of trees).
class EqualParts {
  public:
    /// The meter counts comparisons, and must outlive this.
    EqualParts(const StrokeGraph& graph, WorkMeter& meter);

    /// Whether each place except one is reached by one stroke, and the other leads to all. Larger drawings
    /// than limits allow are no trees here.
    bool is_tree() const { return !nodes_.empty(); }

    /// Calls `visit` with rules under which equal letters have equal parts, until it returns true, or too
    /// many orders were tried. Whether it returned true. Requires a tree, and numbers by letter. Turns are
    /// not compared except within parts, so the rules need not draw the tree. Axioms of one letter are tried,
    /// and brackets without brackets in them.
    bool find(const LsysGrowth& growth, const std::function<bool(const BareRules&)>& visit);
    /// Comparisons of the last search.
    std::uint64_t spent() const { return spent_; }

  private:
    struct Way {
        std::uint32_t to = 0; ///< node
        std::int32_t direction = 0;
        std::uint64_t size = 0, shape = 0; ///< strokes from here on, and what grows from its end
    };
    /// Places, each before those that grow from it.
    struct Node {
        std::vector<Way> ways;
        std::uint32_t parent = 0, way = 0; ///< that leads here
        std::uint32_t end = 0;             ///< the first node after it that does not grow from it
        std::uint64_t shapes = 0;          ///< sum of its ways
        std::uint64_t path = 0;            ///< hash of what leaves the way from the first node
        std::size_t depth = 0;
    };
    /// The place where a part begins or ends: some ways of a node are yet to be drawn. None: all is drawn.
    struct Cursor {
        std::uint32_t node = 0, ways = 0; ///< bits
        std::uint64_t left = 0;           ///< strokes
    };
    struct Part {
        std::uint8_t letter = 0;
        unsigned level = 0; ///< steps to go
        Cursor begin, end;
    };
    /// A part along which the symbols of its rule are laid.
    struct Layout {
        Part part;
        std::size_t at = 0; ///< of the part
        LsysGrowth::Counts left{};
        bool inside = false; ///< a bracket
        Cursor outer;        ///< after the bracket
    };

    bool number_nodes(const StrokeGraph& graph);
    void add_shapes();
    std::uint64_t turned(std::int32_t turn, std::uint64_t shape) const;
    std::uint64_t turned(const Node& node, std::uint32_t way, std::uint64_t shape) const;
    std::uint32_t way_to(const Cursor& from, std::uint32_t node) const;
    bool leads_to(const Cursor& from, const Cursor& to) const;
    static bool goes_on(const Part& part);
    std::uint64_t sides(const Node& node, std::uint32_t bits, std::uint32_t ahead) const;
    std::uint64_t shape(const Part& part) const;
    bool fits(const Part& part) const;
    bool spend();
    bool check(std::size_t at);
    bool lay(const Layout& layout, std::size_t symbol, const Cursor& cursor);
    bool lay_symbol(const Layout& layout, std::size_t symbol, const Cursor& cursor);
    bool lay_new(const Layout& layout, std::int8_t symbol, const Cursor& cursor);
    bool lay_letter(const Layout& layout, std::size_t symbol, const Cursor& cursor);
    bool lay_bracket(const Layout& layout, std::size_t symbol, const Cursor& cursor);

    template<typename Value> using ByLetter = std::array<Value, LsysGrowth::most_letters>;
    WorkMeter& meter_;
    std::int32_t directions_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::uint64_t> powers_;             ///< of the base of paths
    std::vector<std::uint64_t> runs_, runs_to_end_; ///< shapes of so many strokes straight ahead
    std::unordered_map<std::uint64_t, std::vector<Cursor>> by_left_;
    LsysGrowth growth_;
    const std::function<bool(const BareRules&)>* visit_ = nullptr;
    std::vector<ByLetter<std::uint64_t>> sizes_;       ///< by level: strokes
    std::vector<ByLetter<std::optional<Part>>> first_; ///< by level
    BareRules words_;
    ByLetter<bool> known_{};
    std::vector<Part> parts_;
    unsigned spent_ = 0;
};

} // namespace graftal
