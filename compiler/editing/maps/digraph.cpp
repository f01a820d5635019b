#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/editing/maps/maps.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

namespace {

using Kind = RifsFollow::Kind;
using Matrix = std::vector<std::vector<bool>>;

constexpr std::size_t most_maps = 1000; // of a matrix that is shown
constexpr std::size_t most_listed = 64; // maps whose edges are written one by one

std::string name_of(const RifsMap& map) {
    return map.name.text.empty() ? fmt::format("w{}", map.number) : std::string(map.name.text);
}

std::optional<std::size_t> place_of(const RifsBlock& block, std::string_view name) {
    for (std::size_t i = 0; i < block.maps.size(); ++i)
        if (name_of(block.maps[i]) == name) return i;
    return std::nullopt;
}

/// The edges as the text says them; of a map from another block, none lead to it.
Matrix edges_of(const RifsBlock& block) {
    const std::size_t count = block.maps.size();
    const Kind kind = block.follow ? block.follow->kind : Kind::all;
    const bool all = kind == Kind::all || kind == Kind::all_except_self || kind == Kind::all_except;
    Matrix edges(count, std::vector<bool>(count, all));
    if (kind == Kind::all_except_self)
        for (std::size_t i = 0; i < count; ++i)
            edges[i][i] = false;
    if (block.follow) {
        std::map<std::string, std::size_t, std::less<>> places; // the first map of a name has it
        for (std::size_t i = 0; i < count; ++i)
            places.try_emplace(name_of(block.maps[i]), i);
        for (const RifsEdge& edge : block.follow->edges) {
            const auto from = places.find(edge.from.text), to = places.find(edge.to.text);
            if (from != places.end() && to != places.end())
                edges[from->second][to->second] = kind == Kind::edges;
        }
        for (const RifsCell& cell : block.follow->cells)
            if (cell.row < count && cell.column < count) edges[cell.row][cell.column] = true;
    }
    for (std::size_t to = 0; to < count; ++to)
        for (std::size_t from = 0; all && block.maps[to].from && from < count; ++from)
            edges[from][to] = false;
    return edges;
}

/// Changes the list of edges of a `follow`, be it of what is allowed or of what is not.
class FollowText {
  public:
    FollowText(const Document& document, const RifsBlock& block)
        : document_(document), block_(block), follow_(block.follow) {}

    /// Nothing where the form cannot say it.
    std::optional<std::vector<TextEdit>> with(std::size_t from, std::size_t to, bool edge) {
        if (!follow_) {
            const std::uint32_t end = end_of_maps();
            return std::vector<TextEdit>{
                {end, end, fmt::format("\n  follow all except {}", arrow(from, to))}};
        }
        const std::uint32_t end = follow_->span.end;
        switch (follow_->kind) {
        case Kind::all:
            return std::vector<TextEdit>{{end, end, fmt::format(" except {}", arrow(from, to))}};
        case Kind::all_except_self:
            return instead(from, to, edge);
        case Kind::all_except:
            return edge ? without(from, to, true) : beside(from, to);
        case Kind::edges:
            return edge ? beside(from, to) : without(from, to, false);
        case Kind::matrix:
            return cell(from, to, edge);
        }
        return std::nullopt;
    }

  private:
    std::string arrow(std::size_t from, std::size_t to) const {
        return fmt::format("{} -> {}", name_of(block_.maps[from]), name_of(block_.maps[to]));
    }

    /// The first of this word or symbol in the `follow`, comments aside.
    std::optional<Span> place_of_word(std::string_view word) const {
        Diagnostics ignored;
        for (const Token& token : lex_range(document_.sources(), follow_->span, ignored))
            if (token.is(word)) return token.span;
        return std::nullopt;
    }

    /// Behind the last map, or the '}' of its `codes`.
    std::uint32_t end_of_maps() const {
        const RifsMap& last = block_.maps.back();
        if (last.form == RifsForm::transforms) return last.span.end;
        Diagnostics ignored;
        const Span rest{0, last.span.end, static_cast<std::uint32_t>(document_.text().size())};
        for (const Token& token : lex_range(document_.sources(), rest, ignored))
            if (token.is("}")) return token.span.end;
        return last.span.end;
    }

    /// The exceptions one by one in place of `self`.
    std::optional<std::vector<TextEdit>> instead(std::size_t from, std::size_t to, bool edge) const {
        if (block_.maps.size() > most_listed) return std::nullopt;
        std::vector<std::string> exceptions;
        for (std::size_t i = 0; i < block_.maps.size(); ++i)
            if (!(edge && i == from && from == to)) exceptions.push_back(arrow(i, i));
        if (!edge) exceptions.push_back(arrow(from, to));
        const std::optional<Span> self = place_of_word("self");
        if (!self || exceptions.empty()) return std::nullopt;
        return std::vector<TextEdit>{
            {self->begin, self->end, fmt::format("{{ {} }}", fmt::join(exceptions, "  "))}};
    }

    /// One more edge: behind the others from the same map, or as the last.
    std::optional<std::vector<TextEdit>> beside(std::size_t from, std::size_t to) const {
        const std::string source = name_of(block_.maps[from]), target = name_of(block_.maps[to]);
        const RifsEdge* last = nullptr;
        for (const RifsEdge& edge : follow_->edges)
            if (edge.from.text == source) last = &edge;
        if (last) return std::vector<TextEdit>{{last->to.span.end, last->to.span.end, ", " + target}};
        if (!follow_->edges.empty()) {
            const std::uint32_t end = follow_->edges.back().to.span.end;
            return std::vector<TextEdit>{{end, end, "  " + arrow(from, to)}};
        }
        const std::optional<Span> open = place_of_word("{"); // of an empty list
        if (!open) return std::nullopt;
        return std::vector<TextEdit>{{open->end, open->end, fmt::format(" {} ", arrow(from, to))}};
    }

    /// All mentions of an edge taken out, with what joins them to others.
    std::optional<std::vector<TextEdit>> without(std::size_t from, std::size_t to, bool exceptions) const {
        const std::string source = name_of(block_.maps[from]), target = name_of(block_.maps[to]);
        const std::vector<RifsEdge>& edges = follow_->edges;
        const auto is_it = [&](const RifsEdge& edge) {
            return edge.from.text == source && edge.to.text == target;
        };
        const auto kept = static_cast<std::size_t>(edges.size() - std::ranges::count_if(edges, is_it));
        const bool braces = document_.text(follow_->span).ends_with("}");
        if (kept == 0 && exceptions) {
            const std::optional<Span> except = place_of_word("except");
            if (!except) return std::nullopt;
            return std::vector<TextEdit>{{except->begin, follow_->span.end, ""}};
        }
        if (kept == 0 && !braces) return std::nullopt;
        Diagnostics ignored;
        const Span all{0, edges.front().from.span.begin, edges.back().to.span.end};
        const std::vector<Token> tokens = lex_range(document_.sources(), all, ignored);
        std::vector<TextEdit> out;
        for (std::size_t i = 0; i < edges.size();) {
            std::size_t end = i + 1; // of the edges that stand behind one arrow
            while (end < edges.size() && edges[end].from.span == edges[i].from.span)
                ++end;
            take_out(i, end, is_it, tokens, out);
            i = end;
        }
        return out;
    }

    /// `tokens`: of all edges.
    template<typename IsIt>
    void take_out(std::size_t begin, std::size_t end, const IsIt& is_it, const std::vector<Token>& tokens,
                  std::vector<TextEdit>& out) const {
        const std::vector<RifsEdge>& edges = follow_->edges;
        std::vector<std::string_view> targets;
        for (std::size_t i = begin; i < end; ++i)
            if (!is_it(edges[i])) targets.push_back(edges[i].to.text);
        if (targets.size() == end - begin) return;
        if (!targets.empty()) { // the list behind the arrow is written anew
            out.push_back({edges[begin].to.span.begin, edges[end - 1].to.span.end,
                           fmt::format("{}", fmt::join(targets, ", "))});
            return;
        }
        Span span{0, edges[begin].from.span.begin, edges[end - 1].to.span.end};
        const std::string_view text = document_.text();
        const auto begin_of = [](const Token& token) { return token.span.begin; };
        const auto first = std::ranges::lower_bound(tokens, span.begin, {}, begin_of);
        const auto behind = std::ranges::lower_bound(first, tokens.end(), span.end, {}, begin_of);
        const std::uint32_t gone = out.empty() ? 0 : out.back().end; // by the edits so far
        std::optional<Span> comma;
        if (first != tokens.begin() && std::prev(first)->is(",") && std::prev(first)->span.begin >= gone)
            comma = std::prev(first)->span;
        else if (behind != tokens.end() && behind->is(","))
            comma = behind->span;
        const auto blank = [&](std::uint32_t from, std::uint32_t to) {
            return text.substr(from, to - from).find_first_not_of(" \t\n") == std::string_view::npos;
        };
        if (comma && comma->begin < span.begin) {
            if (blank(comma->end, span.begin))
                span.begin = comma->begin;
            else // a comment between them stays
                out.push_back({comma->begin, comma->end, ""});
        } else if (comma && blank(span.end, comma->begin)) {
            span.end = comma->end;
        }
        // A line of its own: `follow a -> b`.
        const std::string_view ahead = text.substr(0, span.begin);
        const std::size_t word = ahead.find_last_not_of(" \t:");
        const bool alone =
            word != std::string_view::npos && word >= 5 && ahead.substr(word - 5, 6) == "follow";
        const bool more = end < edges.size() &&
                          text.substr(span.end, edges[end].from.span.begin - span.end).find("follow") ==
                              std::string_view::npos;
        if (alone && !more) span.begin = static_cast<std::uint32_t>(word - 5);
        out.push_back({span.begin, span.end, ""});
        if (comma && comma->begin >= span.end) out.push_back({comma->begin, comma->end, ""});
    }

    std::optional<std::vector<TextEdit>> cell(std::size_t from, std::size_t to, bool edge) const {
        const auto plain = [](const RifsCell& cell) {
            return cell.expression == RifsCell::literal && cell.number == 1;
        };
        if (!std::ranges::all_of(follow_->cells, plain) || from >= follow_->rows.size()) return std::nullopt;
        Diagnostics ignored;
        std::size_t column = 0;
        for (const Token& token : lex_range(document_.sources(), follow_->rows[from].span, ignored)) {
            if (token.kind != TokenKind::number) continue;
            if (column++ == to)
                return std::vector<TextEdit>{{token.span.begin, token.span.end, edge ? "1" : "0"}};
        }
        return std::nullopt;
    }

    const Document& document_;
    const RifsBlock& block_;
    const std::optional<RifsFollow>& follow_;
};

/// A block and two of its maps, by names with or without that of the block.
struct Ends {
    const RifsBlock* block = nullptr;
    std::size_t from = 0, to = 0;
};

std::optional<Ends> ends_of(const RifsFile& tree, std::string_view from, std::string_view to) {
    for (const RifsBlock& block : tree.blocks) {
        const auto own = [&](std::string_view name) {
            const std::string prefix = std::string(block.name.text) + ".";
            return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
        };
        const auto first = place_of(block, own(from)), second = place_of(block, own(to));
        if (first && second) return Ends{&block, *first, *second};
    }
    return std::nullopt;
}

} // namespace

std::vector<Digraph> digraphs_of(const Document& document) {
    std::vector<Digraph> digraphs;
    if (!document.rifs()) return digraphs;
    for (const RifsBlock& block : document.rifs()->blocks) {
        if (block.maps.size() > most_maps) continue;
        Digraph digraph{std::string(block.name.text), {}, edges_of(block)};
        for (const RifsMap& map : block.maps)
            digraph.maps.push_back(name_of(map));
        digraphs.push_back(std::move(digraph));
    }
    return digraphs;
}

MapChange set_edge(const Document& document, std::string_view from, std::string_view to, bool edge,
                   const EditContext& context) {
    const std::optional<Ends> ends = document.rifs() ? ends_of(*document.rifs(), from, to) : std::nullopt;
    if (!ends) return {{}, fmt::format("There are no maps '{}' and '{}' in one block.", from, to)};
    if (ends->block->maps.size() > most_maps)
        return {{}, fmt::format("The digraph has more than {} maps.", most_maps)};
    if (ends->block->broken) return {{}, "Mend the errors of the block first."};
    Matrix wanted = edges_of(*ends->block);
    MapChange change;
    if (wanted[ends->from][ends->to] != edge) {
        wanted[ends->from][ends->to] = edge;
        if (edge && ends->block->maps[ends->to].from)
            return {{}, fmt::format("'{}' takes the attractor of another block: no edge leads to it.", to)};
        const bool probabilities = ends->block->follow && ends->block->follow->kind == Kind::matrix;
        const auto edits = FollowText(document, *ends->block).with(ends->from, ends->to, edge);
        if (!edits)
            return {{},
                    probabilities ? "The entries of this matrix are probabilities: each row has its sum."
                                  : "No edge would be left, or there are too many to list."};
        change.edits = *edits;
    }
    const std::string text = applied(document.text(), change.edits);
    const Document after(document.name(), text);
    const auto index = static_cast<std::size_t>(ends->block - document.rifs()->blocks.data());
    if (after.findings().has_errors() || index >= after.rifs()->blocks.size() ||
        edges_of(after.rifs()->blocks[index]) != wanted)
        return {{}, "The text of this digraph is written in a way that cannot be changed so."};
    const ContractionCheck check = check_contraction(document.name(), text, context);
    change.contracts = check.contracts;
    change.why = check.why;
    return change;
}

} // namespace graftal
