#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "compiler/rifs/system.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Beyond this a suggestion for a misspelt name would take longer than it is worth.
constexpr std::size_t most_candidates = 1000;
constexpr double row_slack = 0.02;

class DigraphResolver {
  public:
    DigraphResolver(RifsSystem& system, const Environment& lets, Lowering& lowering)
        : system_(system), lets_(lets), lowering_(lowering), diagnostics_(lowering.diagnostics) {}

    bool resolve() && {
        for (std::uint32_t b = 0; b < system_.blocks.size(); ++b)
            block_ids_.try_emplace(system_.blocks[b].source->name.text, b);
        for (RifsSubsystem& block : system_.blocks)
            if (!resolve_block(block)) return false;
        return resolve_sources() && count_rest(); // these need the starts of all blocks
    }

  private:
    struct Edge {
        std::uint32_t from;
        std::uint32_t to;
        Span span;
        double weight = 1;
    };

    bool resolve_block(RifsSubsystem& block) {
        block_ = &block;
        node_ids_.clear();
        for (std::uint32_t i = block.first; i < block.end; ++i) {
            node_ids_.try_emplace(system_.nodes[i].name, i);
            resolve_from(system_.nodes[i]);
        }
        resolve_start();
        const RifsFollow& follow = block.source->follow ? *block.source->follow : follow_all_;
        const Span span = follow.span.known() ? follow.span : block.source->name.span;
        switch (follow.kind) {
        case RifsFollow::Kind::matrix:
            return connect(matrix_edges(follow), span);
        case RifsFollow::Kind::edges:
            return connect(listed_edges(follow), span);
        default:
            return connect_all(follow, span);
        }
    }

    void resolve_from(RifsNode& node) {
        const std::optional<Name>& from = node.source->from;
        if (!from) return;
        const auto found = block_ids_.find(from->text);
        if (found != block_ids_.end()) {
            node.from = found->second;
            return;
        }
        node.from = node.block;
        if (diagnostics_.full()) return;
        std::vector<std::string> known;
        for (const RifsSubsystem& block : system_.blocks)
            if (known.size() < most_candidates) known.emplace_back(block.source->name.text);
        diagnostics_.error(from->span, fmt::format("unknown rifs '{}'", from->text))
            .with_hint(choices(from->text, known));
    }

    void resolve_start() {
        std::vector<Edge> named; // the node in `to`, so that duplicates are found alike
        for (const Name& name : block_->source->start)
            if (const auto id = node_named(name)) named.push_back({0, *id, name.span});
        sort_unique(named, [&](const Edge& again, const Edge& first) {
            diagnostics_.warning(again.span, fmt::format("'{}' starts twice", system_.nodes[again.to].name))
                .with_note(first.span, "first given here");
        });
        for (const Edge& start : named)
            block_->start.push_back(start.to);
        if (!block_->source->start.empty()) return;
        for (std::uint32_t i = block_->first; i < block_->end; ++i)
            block_->start.push_back(i);
    }

    std::optional<std::uint32_t> node_named(const Name& name) {
        const auto found = node_ids_.find(name.text);
        if (found != node_ids_.end()) return found->second;
        if (diagnostics_.full()) return std::nullopt;
        std::vector<std::string> known;
        for (std::uint32_t i = block_->first; i < block_->end && known.size() < most_candidates; ++i)
            known.push_back(system_.nodes[i].name);
        diagnostics_
            .error(name.span, fmt::format("'rifs {}' has no map '{}'", block_->source->name.text, name.text))
            .with_hint(choices(name.text, known));
        return std::nullopt;
    }

    std::vector<Edge> listed_edges(const RifsFollow& follow) {
        std::vector<Edge> edges;
        for (const RifsEdge& edge : follow.edges) {
            const auto from = node_named(edge.from);
            const auto to = node_named(edge.to);
            if (!from || !to || diagnostics_.full()) continue;
            edges.push_back({*from, *to, edge.to.span});
        }
        return edges;
    }

    std::vector<Edge> matrix_edges(const RifsFollow& follow) {
        const std::size_t size = block_->end - block_->first;
        const std::string_view name = block_->source->name.text;
        if (follow.rows.size() != size)
            diagnostics_.error(follow.span,
                               fmt::format("the matrix has {} row{}, but 'rifs {}' has {} map{}",
                                           follow.rows.size(), follow.rows.size() == 1 ? "" : "s", name, size,
                                           size == 1 ? "" : "s"));
        bool good = follow.rows.size() == size;
        for (std::size_t row = 0; row < follow.rows.size() && !diagnostics_.full(); ++row) {
            if (follow.rows[row].columns == size) continue;
            good = false;
            diagnostics_.error(follow.rows[row].span,
                               fmt::format("row {} of the matrix has {} entr{}, but 'rifs {}' has {} map{}",
                                           row + 1, follow.rows[row].columns,
                                           follow.rows[row].columns == 1 ? "y" : "ies", name, size,
                                           size == 1 ? "" : "s"));
        }
        if (!good) return {};
        return cell_edges(follow);
    }

    std::vector<Edge> cell_edges(const RifsFollow& follow) {
        std::vector<Edge> edges;
        std::vector<double> sums(follow.rows.size(), 0);
        bool weights = false;
        bool in_range = true;
        for (const RifsCell& cell : follow.cells) {
            double value = cell.number;
            if (cell.expression != RifsCell::literal)
                value = evaluate(follow.expressions[cell.expression], lets_, diagnostics_).value_or(0);
            in_range &= value >= 0 && value <= 1;
            if (value < 0 || value > 1)
                diagnostics_.error(cell.span,
                                   fmt::format("an entry must lie between 0 and 1, not {}", shortest(value)));
            weights |= value != 0 && value != 1;
            sums[cell.row] += value;
            if (value != 0)
                edges.push_back({block_->first + cell.row, block_->first + cell.column, cell.span, value});
        }
        for (std::size_t row = 0; weights && in_range && row < sums.size(); ++row)
            if (std::abs(sums[row] - 1) > row_slack)
                diagnostics_.warning(follow.rows[row].span,
                                     fmt::format("the probabilities of row {} do not add up to 1", row + 1));
        return edges;
    }

    /// All edges but those into maps that take another block, and those that `follow` excepts.
    bool connect_all(const RifsFollow& follow, Span span) {
        const bool not_self = follow.kind == RifsFollow::Kind::all_except_self;
        std::vector<Edge> excepted = listed_edges(follow);
        sort_unique(excepted, [](const Edge&, const Edge&) {});
        const std::size_t size = block_->end - block_->first;
        if (!add_instances(size * size, span)) return false;
        auto next_excepted = excepted.begin();
        for (std::uint32_t j = block_->first; j < block_->end; ++j)
            for (std::uint32_t i = block_->first; i < block_->end; ++i) {
                const bool skip =
                    next_excepted != excepted.end() && next_excepted->to == j && next_excepted->from == i;
                if (skip) ++next_excepted;
                if (!skip && !(not_self && i == j) && !system_.nodes[j].from)
                    system_.nodes[j].masters.push_back(i);
            }
        return true;
    }

    bool connect(std::vector<Edge> edges, Span span) {
        if (!add_instances(edges.size(), span)) return false;
        sort_unique(edges, [&](const Edge& again, const Edge& first) {
            diagnostics_
                .warning(again.span,
                         fmt::format("the edge '{} -> {}' is given twice", system_.nodes[again.from].name,
                                     system_.nodes[again.to].name))
                .with_note(first.span, "first given here");
        });
        for (const Edge& edge : edges) {
            RifsNode& node = system_.nodes[edge.to];
            if (!node.from) {
                node.masters.push_back(edge.from);
                node.weights.push_back(edge.weight);
                continue;
            }
            diagnostics_
                .error(edge.span, fmt::format("'{}' takes 'rifs {}', so no map of its own block leads to it",
                                              node.name, node.source->from->text))
                .with_note(node.source->from->span, "given here");
            if (diagnostics_.full()) break;
        }
        return true;
    }

    bool resolve_sources() {
        for (RifsNode& node : system_.nodes) {
            if (!node.from) continue;
            const std::vector<std::uint32_t>& start = system_.blocks[*node.from].start;
            if (!add_instances(start.size(), node.source->span)) return false;
            node.masters = start;
        }
        return true;
    }

    /// The instances that are no edges: condensation sets, and those of the root.
    bool count_rest() {
        for (const RifsNode& node : system_.nodes)
            instances_ += system_.blocks[system_.block_under(node)].source->condense.size();
        if (system_.blocks.empty()) return true;
        const RifsSubsystem& main = system_.blocks[system_.main];
        return add_instances(main.start.size() + main.source->condense.size(), main.source->name.span);
    }

    /// Sorts by `to`, then `from`; equal ones by their place in the text, of which the first stays.
    template<typename Report> void sort_unique(std::vector<Edge>& edges, const Report& report) {
        const auto key = [](const Edge& e) { return std::tuple(e.to, e.from, e.span.begin); };
        std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
        const auto equal = [&](const Edge& first, const Edge& again) {
            if (first.to != again.to || first.from != again.from) return false;
            report(again, first);
            return true;
        };
        edges.erase(std::unique(edges.begin(), edges.end(), equal), edges.end());
    }

    bool add_instances(std::size_t count, Span span) {
        instances_ += count;
        return within_limits(system_.nodes.size() + 1, instances_, span, lowering_);
    }

    RifsSystem& system_;
    const Environment& lets_;
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    const RifsFollow follow_all_;
    std::unordered_map<std::string_view, std::uint32_t> block_ids_;
    std::unordered_map<std::string_view, std::uint32_t> node_ids_;
    RifsSubsystem* block_ = nullptr;
    std::size_t instances_ = 0;
};

/// The nodes that have each node as a master: the masters' lists turned round, in one array.
struct Users {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> users;

    explicit Users(const std::vector<RifsNode>& nodes) : first(nodes.size() + 1, 0) {
        for (const RifsNode& node : nodes)
            for (const std::uint32_t master : node.masters)
                ++first[master + 1];
        for (std::size_t i = 1; i < first.size(); ++i)
            first[i] += first[i - 1];
        users.resize(first.back());
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::uint32_t i = 0; i < nodes.size(); ++i)
            for (const std::uint32_t master : nodes[i].masters)
                users[next[master]++] = i;
    }
};

void warn_empty(const RifsNode& node, Diagnostics& diagnostics) {
    if (node.masters.empty())
        diagnostics
            .warning(node.source->name.span,
                     fmt::format("map '{}' draws nothing: no map leads to it", node.name))
            .with_hint(fmt::format("write an edge 'x -> {}' to let it follow x", node.name));
    else
        diagnostics.warning(
            node.source->name.span,
            fmt::format("map '{}' draws nothing: only maps that draw nothing lead to it", node.name));
}

} // namespace

bool resolve_digraphs(RifsSystem& system, const Environment& lets, Lowering& lowering) {
    return DigraphResolver(system, lets, lowering).resolve();
}

void mark_empty(RifsSystem& system, Diagnostics& diagnostics) {
    std::vector<RifsNode>& nodes = system.nodes;
    const Users users(nodes);
    const auto has_condensation = [&](const RifsNode& node) {
        return !system.blocks[system.block_under(node)].source->condense.empty();
    };
    std::vector<std::size_t> masters_left;
    std::vector<std::uint32_t> queue;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        masters_left.push_back(nodes[i].masters.size());
        if (masters_left[i] == 0 && !has_condensation(nodes[i])) queue.push_back(i);
    }
    while (!queue.empty()) {
        const std::uint32_t dead = queue.back();
        queue.pop_back();
        nodes[dead].empty = true;
        for (std::size_t u = users.first[dead]; u < users.first[dead + 1]; ++u) {
            const std::uint32_t user = users.users[u];
            if (--masters_left[user] == 0 && !has_condensation(nodes[user])) queue.push_back(user);
        }
    }
    for (const RifsNode& node : nodes)
        if (node.empty) warn_empty(node, diagnostics);

    const RifsSubsystem& main = system.blocks[system.main];
    const bool nothing = std::all_of(main.start.begin(), main.start.end(),
                                     [&](std::uint32_t node) { return nodes[node].empty; });
    if (nothing && main.source->condense.empty())
        diagnostics
            .error(
                main.source->name.span,
                fmt::format("'rifs {}' is empty: no sequence of its maps is endless", main.source->name.text))
            .with_hint("add edges so that the start reaches a cycle, or add a 'condense'");
}

} // namespace graftal
