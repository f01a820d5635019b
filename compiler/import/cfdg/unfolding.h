#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "compiler/import/cfdg/evaluate/chance.h"
#include "compiler/import/cfdg/evaluate/expression.h"
#include "compiler/import/cfdg/paint_order.h"
#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/cfdg/recursion.h"
#include "compiler/import/cfdg/scene.h"
#include "compiler/import/cfdg/text.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

/// The `.inst` of a grammar whose numbers are known: an object for each shape with each of its arguments, and
/// up to 64 objects where chance decides. Recursion that draws the same at all sizes has no end: its objects
/// hold themselves. In other grammars, largest shapes come first, and shapes that no picture shows are left
/// out, as Context Free does.
class Unfolding : private SceneWriter {
  public:
    Unfolding(const ForeignFile& file, const Grammar& grammar);

    Translation write();

  private:
    static constexpr const char* fewer_shapes =
        "ask for less: fewer turns of its loops, such as a coarser grid";
    static constexpr std::size_t most_nodes = 60'000;
    static constexpr std::size_t most_unfolded_lines = 600'000;
    static constexpr std::size_t most_loop_turns = 2'000'000;

    struct Line {
        std::string master; ///< a primitive or a polygon; "" of a node
        std::size_t node = 0;
        Affine map;
        std::vector<ColourStep> colours;
        Span span;
        bool fills = false;  ///< all of the canvas
        bool beside = false; ///< it does not cover the line before it
    };

    /// A shape with its arguments.
    struct Node {
        std::size_t shape = 0;
        ShapeValue value;
        Target target = first_target;
        int generation = 0; ///< of recursion without end
        std::uint64_t seed = 0;
        Affine world; ///< of the largest that is known
        double size = 0;
        std::string name; ///< of its object, if it becomes one
        std::vector<Line> lines;
        bool done = false;
        bool part = false; ///< turns of a loop of the shape's rule, and no shape
    };

    /// The context of the lines of a rule.
    struct Under {
        std::size_t node = 0;
        Change change;
    };

    /// The node for a shape, which may be new; nothing where there is no room for it.
    std::optional<std::size_t> node_for(const ShapeValue& value, const Target& target,
                                        std::optional<std::size_t> from, const Affine& world);
    std::optional<std::size_t> unfold_from(const ShapeValue& shape, const Target& target,
                                           const Affine& world);
    std::optional<std::size_t> unfold_once(const ShapeValue& shape, const Target& target,
                                           const Affine& world);
    void warn_of_rest(Span start);
    void unfold(std::size_t id);
    void unfold_path(std::size_t id, const Surroundings& at);
    void expand(const Elements& elements, Surroundings at, const Under& under);
    void expand_loop(const Element& element, Surroundings at, Under under);
    bool is_even(const Element& loop, const std::string& space) const;
    Change expand_even(const Element& loop, const Surroundings& at, const Under& under, Change step,
                       double turns);
    std::size_t part_of(std::size_t id, const Change& change);
    /// Whether nothing is seen of a part: its thickness of 1 is so much larger than it that the language
    /// would call its map flat.
    static bool is_unseen(const Affine& map);
    bool check_bounds(const Affine& map, Span span);
    bool is_call(const Line& line) const;
    void expand_transform(const Element& element, const Surroundings& at, const Under& under);
    void place(const Element& element, const Surroundings& at, const Under& under);
    void add_line(std::size_t id, Line line);
    void see(const Affine& world);

    /// A line of an object to be written: one of its own, or of what it holds the only instance of.
    struct Written {
        const Line* line = nullptr;
        std::size_t node = 0; ///< whose line it is
        Affine map;
        std::vector<ColourStep> colours;
    };

    bool is_drawn(const Line& line) const { return !line.master.empty() || nodes_[line.node].done; }
    const std::string& name_of(std::size_t id);
    void find_order(std::size_t first);
    void write_nodes(std::size_t first);
    void write_node(std::size_t id, std::vector<std::size_t>& needed);
    void write_line(std::size_t id, const Written& one, std::vector<std::size_t>& needed);
    bool is_held(const Written& one) const;

    Chance chance_;
    Expressions expressions_;
    Recursion recursion_;
    std::vector<bool> random_; ///< by shape: whether chance decides in it or below it
    std::vector<Node> nodes_;
    std::map<std::string, std::vector<std::size_t>> known_;          ///< nodes by shape, arguments and target
    std::map<std::string, std::size_t> uses_;                        ///< of random ones
    std::vector<std::size_t> named_;                                 ///< objects of each shape
    std::priority_queue<std::tuple<int, double, std::size_t>> open_; ///< by turn and size
    Vec3 least_{1e300}, most_{-1e300};                               ///< of what is drawn
    double extent_ = 0;
    std::size_t lines_ = 0, turns_ = 0, colour_steps_ = 0;
    bool full_ = false, fills_ = false, drawn_ = false;
    bool stretches_ = false; ///< some path depends on how its place stretches
    bool even_ = true;       ///< turns of loops that draw the same may be parts
    bool endless_ = false;   ///< all recursion has no end: its shapes hold themselves
    std::uint64_t salt_ = 0; ///< of all random numbers
    std::optional<PaintOrder> order_;
    std::vector<std::uint32_t> instances_; ///< of each node, in others
    std::set<std::size_t> commented_;      ///< shapes whose comments are written
};

} // namespace graftal::cfdg
