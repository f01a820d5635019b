#include "runtime/inverse/lsystem/equal_parts.h"

#include <algorithm>
#include <utility>

#include "compiler/support/counter_random.h"

namespace graftal {

namespace {

constexpr unsigned most_spent = 4000; ///< on one growth; true ones took up to 1000
constexpr double seconds_of_part = 2e-8;
constexpr std::uint64_t most_tree_strokes = 100'000;
constexpr std::size_t most_tree_ways = 5; ///< at a place
constexpr std::uint64_t path_base = 0x9E3779B97F4A7C15ull;

} // namespace

EqualParts::EqualParts(const StrokeGraph& graph, WorkMeter& meter)
    : meter_(meter), directions_(graph.directions) {
    if (number_nodes(graph))
        add_shapes();
    else
        nodes_.clear();
}

/// False where the drawing is no tree.
bool EqualParts::number_nodes(const StrokeGraph& graph) {
    if (graph.places.size() != graph.strokes + 1 || graph.strokes > most_tree_strokes) return false;
    std::vector<bool> reached(graph.places.size());
    for (std::uint32_t place = 0; place < graph.places.size(); ++place)
        for (const StrokeWay& way : graph.ways(place)) {
            if (reached[way.to]) return false;
            reached[way.to] = true;
        }
    struct Visit {
        std::uint32_t place, parent, way;
    };
    const auto root = std::ranges::find(reached, false) - reached.begin();
    std::vector<Visit> visits = {{static_cast<std::uint32_t>(root), 0, 0}};
    while (!visits.empty()) {
        const Visit visit = visits.back();
        visits.pop_back();
        const auto number = static_cast<std::uint32_t>(nodes_.size());
        if (number > 0) nodes_[visit.parent].ways[visit.way].to = number;
        Node& node = nodes_.emplace_back(Node{{}, visit.parent, visit.way});
        for (const StrokeWay& way : graph.ways(visit.place)) {
            visits.push_back({way.to, number, static_cast<std::uint32_t>(node.ways.size())});
            node.ways.push_back({0, way.direction});
        }
        if (node.ways.size() > most_tree_ways) return false;
    }
    return nodes_.size() == graph.places.size();
}

std::uint64_t EqualParts::turned(std::int32_t turn, std::uint64_t shape) const {
    if (directions_ > 0) turn = (turn % directions_ + directions_) % directions_;
    return CounterRandom::scrambled(shape + path_base * (static_cast<std::uint64_t>(turn) + 1000));
}

/// A shape on a way of a node, by the turn from the way that leads to the node.
std::uint64_t EqualParts::turned(const Node& node, std::uint32_t way, std::uint64_t shape) const {
    return turned(node.ways[way].direction - nodes_[node.parent].ways[node.way].direction, shape);
}

void EqualParts::add_shapes() {
    for (auto i = static_cast<std::uint32_t>(nodes_.size()); i-- > 0;) {
        Node& node = nodes_[i];
        node.end = i + 1;
        for (Way& way : node.ways) {
            way.size = nodes_[way.to].end - way.to;
            way.shape = CounterRandom::scrambled(nodes_[way.to].shapes + 1);
            node.end = std::max(node.end, nodes_[way.to].end);
        }
        for (std::uint32_t way = 0; way < node.ways.size(); ++way)
            node.shapes += turned(node, way, node.ways[way].shape);
        for (std::uint32_t bits = 1; bits < 1u << node.ways.size(); ++bits) {
            Cursor cursor{i, bits, 0};
            for (std::size_t way = 0; way < node.ways.size(); ++way)
                cursor.left += bits >> way & 1 ? node.ways[way].size : 0;
            by_left_[cursor.left].push_back(cursor);
        }
    }
    runs_ = {0};
    runs_to_end_ = {0, CounterRandom::scrambled(0) + CounterRandom::scrambled(0)};
    powers_ = {1};
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        runs_.push_back(turned(0, CounterRandom::scrambled(i > 1 ? runs_.back() + 1 : 1)));
        runs_to_end_.push_back(runs_to_end_.back() + turned(0, 0) * powers_.back());
        powers_.push_back(powers_.back() * path_base);
        Node& node = nodes_[i];
        const Node& parent = nodes_[node.parent];
        const std::uint64_t ahead = turned(parent, node.way, parent.ways[node.way].shape);
        node.depth = parent.depth + 1;
        node.path = parent.path * path_base + turned(parent, node.way, parent.shapes - ahead);
    }
}

bool EqualParts::spend() {
    meter_.add(1, seconds_of_part);
    return ++spent_ <= most_spent;
}

/// The way of a cursor's node that leads to another. Requires one.
std::uint32_t EqualParts::way_to(const Cursor& from, std::uint32_t node) const {
    const std::vector<Way>& ways = nodes_[from.node].ways;
    const auto found = std::ranges::find_if(
        ways, [&](const Way& way) { return way.to <= node && node < nodes_[way.to].end; });
    return static_cast<std::uint32_t>(found - ways.begin());
}

/// Whether a part may begin at one cursor and end at the other.
bool EqualParts::leads_to(const Cursor& from, const Cursor& to) const {
    if (to.ways == 0) return true;
    if (from.node == to.node) return (to.ways & ~from.ways) == 0;
    if (to.node < from.node || to.node >= nodes_[from.node].end) return false;
    return (from.ways >> way_to(from, to.node) & 1) != 0;
}

/// Whether the turtle goes on after a part where it ends, and not where it begins.
bool EqualParts::goes_on(const Part& part) {
    return part.end.ways != 0 && part.end.node != part.begin.node;
}

/// The shape of ways, seen along one of them.
std::uint64_t EqualParts::sides(const Node& node, std::uint32_t bits, std::uint32_t ahead) const {
    std::uint64_t sum = 0;
    for (std::uint32_t way = 0; way < node.ways.size(); ++way)
        if (bits >> way & 1)
            sum += turned(node.ways[way].direction - node.ways[ahead].direction, node.ways[way].shape);
    return sum;
}

/// The shape of a part; if the turtle goes on after it, by what leaves the way to its end.
std::uint64_t EqualParts::shape(const Part& part) const {
    const Node &begin = nodes_[part.begin.node], &end = nodes_[part.end.node];
    if (goes_on(part)) {
        const std::uint32_t ahead = way_to(part.begin, part.end.node);
        const Node& from = nodes_[begin.ways[ahead].to];
        std::uint64_t drawn = end.shapes;
        for (std::uint32_t way = 0; way < end.ways.size(); ++way)
            if (part.end.ways >> way & 1) drawn -= turned(end, way, end.ways[way].shape);
        return CounterRandom::scrambled(sides(begin, part.begin.ways & ~(1u << ahead), ahead)) +
               CounterRandom::scrambled(drawn) + end.path - from.path * powers_[end.depth - from.depth];
    }
    // No way comes before the others: the one that gives the smallest hash is ahead.
    const std::uint32_t bits = part.begin.ways & ~part.end.ways;
    std::uint64_t least = UINT64_MAX;
    for (std::uint32_t ahead = 0; ahead < begin.ways.size(); ++ahead)
        if (bits >> ahead & 1) least = std::min(least, sides(begin, bits, ahead));
    return least;
}

/// Whether a part may be a letter's. Parts of which only one goes on are not compared.
bool EqualParts::fits(const Part& part) const {
    const std::uint64_t size = part.begin.left - part.end.left;
    if (growth_.straight > 0 && part.letter == 0)
        return shape(part) == (goes_on(part) ? runs_to_end_ : runs_)[size];
    const std::optional<Part>& first = first_[part.level][part.letter];
    return size < 2 || !first || goes_on(*first) != goes_on(part) || shape(*first) == shape(part);
}

bool EqualParts::find(const LsysGrowth& growth, const std::function<bool(const BareRules&)>& visit) {
    spent_ = 0;
    if (growth.axiom != 1) return false;
    growth_ = growth;
    visit_ = &visit;
    sizes_.assign(growth.steps + 1, {});
    first_.assign(growth.steps + 1, {});
    std::fill_n(sizes_[0].begin(), growth.drawn, 1);
    for (unsigned level = 1; level <= growth.steps; ++level)
        for (std::size_t rule = 0; rule < growth.letters; ++rule)
            for (std::size_t letter = 0; letter < growth.letters; ++letter)
                sizes_[level][rule] += growth.rules[rule][letter] * sizes_[level - 1][letter];
    const Cursor all{0, (1u << nodes_[0].ways.size()) - 1, nodes_.size() - 1};
    parts_ = {{static_cast<std::uint8_t>(growth.axiom_letter), growth.steps, all, {}}};
    return sizes_.back()[growth.axiom_letter] == all.left && check(0);
}

/// Whether the parts from one on may be equal where they must, and the visitor takes the rules. The first
/// part of each letter and level is made of the parts of the letters of its rule.
bool EqualParts::check(std::size_t at) {
    for (; at < parts_.size(); ++at) {
        const Part part = parts_[at];
        if (!spend() || !fits(part)) return false;
        std::optional<Part>& first = first_[part.level][part.letter];
        if (part.level == 0 || (growth_.straight > 0 && part.letter == 0) || first) continue;
        first = part;
        const std::size_t before = parts_.size();
        const bool found = lay({part, at, growth_.rules[part.letter]}, 0, part.begin);
        parts_.resize(before);
        first_[part.level][part.letter].reset();
        return found;
    }
    return (*visit_)(words_);
}

/// Lays the symbols of a part's rule along it: those that are known, or each that may come.
bool EqualParts::lay(const Layout& layout, std::size_t symbol, const Cursor& cursor) {
    if (!spend()) return false;
    const std::uint8_t rule = layout.part.letter;
    const BareWord& word = words_[rule];
    const bool at_end =
        known_[rule] ? symbol == word.size() : !layout.inside && layout.left == LsysGrowth::Counts{};
    if (at_end) {
        if (cursor.left != layout.part.end.left) return false;
        const bool before = std::exchange(known_[rule], true);
        const bool found = check(layout.at + 1);
        known_[rule] = before;
        return found;
    }
    if (known_[rule]) return lay_symbol(layout, symbol, cursor);
    for (std::size_t letter = 0; letter < growth_.letters; ++letter)
        if (layout.left[letter] > 0 && lay_new(layout, static_cast<std::int8_t>(letter), cursor)) return true;
    const bool branches = (cursor.ways & (cursor.ways - 1)) != 0;
    if (!layout.inside) return branches && lay_new(layout, bare_open, cursor);
    return word.back() != bare_open && lay_new(layout, bare_close, cursor);
}

bool EqualParts::lay_new(const Layout& layout, std::int8_t symbol, const Cursor& cursor) {
    Layout next = layout;
    if (symbol >= 0) --next.left[static_cast<std::size_t>(symbol)];
    BareWord& word = words_[layout.part.letter];
    word.push_back(symbol);
    const bool found = lay_symbol(next, word.size() - 1, cursor);
    word.pop_back();
    return found;
}

bool EqualParts::lay_symbol(const Layout& layout, std::size_t symbol, const Cursor& cursor) {
    const std::int8_t is = words_[layout.part.letter][symbol];
    if (is == bare_open) return lay_bracket(layout, symbol, cursor);
    if (is != bare_close) return lay_letter(layout, symbol, cursor);
    Layout outside = layout;
    outside.inside = false;
    return cursor.left == 0 && lay(outside, symbol + 1, layout.outer);
}

/// Tries each place where the part of a letter may end.
bool EqualParts::lay_letter(const Layout& layout, std::size_t symbol, const Cursor& cursor) {
    const auto letter = static_cast<std::uint8_t>(words_[layout.part.letter][symbol]);
    const unsigned level = layout.part.level - 1;
    const std::uint64_t size = sizes_[level][letter];
    if (size == 0) return lay(layout, symbol + 1, cursor);
    const auto end_at = [&](const Cursor& end) {
        const Part part{letter, level, cursor, end};
        if (!fits(part)) return false;
        parts_.push_back(part);
        const bool found = lay(layout, symbol + 1, end);
        parts_.pop_back();
        return found;
    };
    const Cursor last = layout.inside ? Cursor{} : layout.part.end;
    if (cursor.left < size + last.left) return false;
    if (cursor.left == size + last.left) return end_at(last);
    const auto found = by_left_.find(cursor.left - size);
    return found != by_left_.end() && std::ranges::any_of(found->second, [&](const Cursor& end) {
               return spend() && leads_to(cursor, end) && leads_to(end, last) && end_at(end);
           });
}

/// Tries each choice of ways for a bracket.
bool EqualParts::lay_bracket(const Layout& layout, std::size_t symbol, const Cursor& cursor) {
    Layout inside = layout;
    inside.inside = true;
    const std::vector<Way>& ways = nodes_[cursor.node].ways;
    for (std::uint32_t bits = known_[layout.part.letter] ? 0 : 1; bits < 1u << ways.size(); ++bits) {
        if ((bits & ~cursor.ways) != 0) continue;
        Cursor branch{cursor.node, bits, 0};
        for (std::uint32_t way = 0; way < ways.size(); ++way)
            branch.left += bits >> way & 1 ? ways[way].size : 0;
        inside.outer = {cursor.node, cursor.ways & ~bits, cursor.left - branch.left};
        if (leads_to(inside.outer, layout.part.end) && lay(inside, symbol + 1, branch)) return true;
    }
    return false;
}

} // namespace graftal
