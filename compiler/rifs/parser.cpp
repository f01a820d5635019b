#include "compiler/rifs/parser.h"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/rifs/orbit_parser.h"
#include "compiler/rifs/parts.h"
#include "compiler/rifs/tables.h"
#include "compiler/syntax/everyday_words.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

/// The words that begin lines, apart from those that all languages share.
constexpr std::array<std::string_view, 9> line_words = {
    "terminal", "below", "probability", "map", "codes", "follow", "start", "control", "condense"};

class RifsParser {
  public:
    RifsParser(TokenStream& stream, const ForeignWords& foreign, RifsFile& file)
        : stream_(stream), diagnostics_(stream.diagnostics()), foreign_(foreign), file_(file) {}

    void parse() {
        while (!stream_.at_end() && !diagnostics_.full())
            parse_statement();
    }

  private:
    void parse_statement() {
        if (at_scene_statement(stream_)) {
            lost_ = false;
            return parse_scene_statement(stream_, file_.statements);
        }
        if (!parse_definition()) stream_.skip_line();
    }

    bool parse_definition() {
        if (at_block() || stream_.at("use") || stream_.at("orbit")) lost_ = false;
        if (at_block()) return parse_block();
        if (stream_.at("use")) return add_use();
        if (stream_.at("orbit")) return parse_orbit(stream_, file_.orbits);
        return unknown_statement();
    }

    bool add_use() {
        const std::optional<UseStatement> use = parse_use(stream_);
        if (use) file_.uses.push_back(*use);
        return use.has_value();
    }

    bool at_block() const { return stream_.at("rifs") || (stream_.at("main") && stream_.peek(1).is("rifs")); }

    bool unknown_statement() {
        std::vector<std::string> words = scene_keywords();
        words.insert(words.end(), rifs_keywords.begin(), rifs_keywords.end());
        const Token& word = stream_.peek();
        const bool item = at_rifs_item(stream_);
        if (!lost_ || (word.kind == TokenKind::name && !item))
            stream_.expected("'rifs', 'use' or a scene statement").with_hint(hint_outside(word, words));
        lost_ = true;
        if (stream_.next().is("{")) stream_.skip_block();
        return false;
    }

    std::string hint_outside(const Token& word, const std::vector<std::string>& words) const {
        if (std::string hint = foreign_word_hint(foreign_, word.text); !hint.empty()) return hint;
        if (at_rifs_item(stream_))
            return fmt::format("write '{}' in a block: rifs NAME {{ ... }}", word.text);
        if (stream_.peek(1).is("=")) return fmt::format("'let {} = ...' names a number", word.text);
        return choices(word.kind == TokenKind::name ? word.text : "", words);
    }

    bool parse_block() {
        RifsBlock block;
        block.is_main = stream_.accept("main");
        stream_.next();
        const Token keyword = stream_.previous();
        const std::size_t errors = diagnostics_.error_count();
        const std::optional<Name> name = parse_rifs_name(stream_, "a name after 'rifs'");
        block.name = name.value_or(Name{keyword.text, keyword.span}); // its maps are read all the same
        const Token open = stream_.peek();
        if (!stream_.accept("{")) {
            if (name) stream_.expect("{", name->text);
            while (!stream_.at_end() && !stream_.at("{") && !stream_.peek().first_on_line)
                stream_.next(); // `rifs my plant {`
            if (!stream_.accept("{") && !at_rifs_item(stream_)) return false;
        }
        parse_items(block, open);
        settle_rifs_rows(block, diagnostics_);
        block.broken = diagnostics_.error_count() > errors;
        file_.blocks.push_back(std::move(block));
        return true;
    }

    void parse_items(RifsBlock& block, const Token& open) {
        while (!stream_.accept("}")) {
            if (diagnostics_.full()) return stream_.skip_block();
            if (stream_.at_end() || at_block()) {
                if (open.is("{")) // else that has been reported
                    stream_.expected(fmt::format("'}}' at the end of 'rifs {}'", block.name.text))
                        .with_note(open.span, "to close this '{'");
                return;
            }
            if (!parse_item(block)) stream_.skip_line();
        }
    }

    bool parse_item(RifsBlock& block) {
        if (stream_.at("inner") && at_scene_statement(stream_)) {
            parse_scene_statement(stream_, file_.statements);
            return true;
        }
        if (at_rifs_item(stream_)) lost_ = false;
        if (stream_.at("map")) return parse_map(block);
        if (stream_.at("codes")) return parse_rifs_codes(stream_, block.maps, map_room_);
        if (stream_.at("follow")) return parse_follow(block);
        if (stream_.at("start")) return parse_start(block);
        if (stream_.at("control")) return parse_rifs_control(stream_, block);
        if (stream_.at("terminal")) return parse_terminal(block.terminal);
        if (stream_.at("condense")) {
            std::optional<RifsPart> part = parse_rifs_part(stream_);
            if (!part) return false;
            block.condense.push_back(std::move(*part));
            return !stream_.at("probability") || parse_probability(block.condense.back().probability);
        }
        return unknown_item(block);
    }

    bool unknown_item(const RifsBlock& block) {
        const Token word = stream_.peek();
        if (at_scene_statement(stream_) || word.is("use")) {
            diagnostics_
                .error(word.span, fmt::format("'{}' must be outside the braces of 'rifs {}'", word.text,
                                              block.name.text))
                .with_hint("close the block with '}' before it");
            if (word.is("use")) return add_use();
            parse_scene_statement(stream_, file_.statements);
            return true;
        }
        if (word.kind == TokenKind::name || !lost_)
            stream_.expected("'map', 'codes', 'follow', 'start', 'control', 'condense', 'terminal' or '}'")
                .with_hint(hint_inside(word));
        lost_ = true;
        if (stream_.next().is("{")) stream_.skip_block();
        return false;
    }

    std::string hint_inside(const Token& word) const {
        if (word.kind == TokenKind::number) return "write rows of numbers in 'codes 2d { ... }'";
        if (word.kind != TokenKind::name) return {};
        if (stream_.peek(1).is("=")) return fmt::format("write 'let {} = ...' before the block", word.text);
        return did_you_mean(word.text,
                            {"map", "codes", "follow", "start", "control", "condense", "terminal"});
    }

    /// `map NAME [from BLOCK] { ... }`.
    bool parse_map(RifsBlock& block) {
        const Token keyword = stream_.next();
        const std::optional<Name> name = parse_rifs_name(stream_, "a name after 'map'");
        if (!name) return false;
        if (!take_rifs_map(stream_, map_room_)) return false;
        RifsMap map;
        map.name = *name;
        if (stream_.accept("from")) {
            map.from = parse_rifs_name(stream_, "the name of a 'rifs' block after 'from'");
            map.broken = !map.from;
        }
        const Token open = stream_.peek();
        const bool opened = !map.broken && stream_.expect("{", stream_.previous().text);
        map.broken = !opened || !parse_map_items(map, open);
        map.span = stream_.span_from(keyword.span);
        block.maps.push_back(std::move(map));
        return opened;
    }

    /// False after an error; the stream then stands after the map, as far as its end can be told.
    bool parse_map_items(RifsMap& map, const Token& open) {
        bool good = true;
        while (!stream_.accept("}")) {
            const bool next_item =
                stream_.peek().first_on_line && at_rifs_item(stream_) && !stream_.at("terminal");
            if (stream_.at_end() || next_item) {
                stream_.expected(fmt::format("'}}' at the end of 'map {}'", map.name.text))
                    .with_note(open.span, "to close this '{'");
                return false;
            }
            if (good) {
                good = parse_map_item(map);
            } else if (stream_.next().is("{")) { // recovering: to the end of the map
                stream_.skip_block();
            }
        }
        return good;
    }

    bool parse_map_item(RifsMap& map) {
        if (at_rifs_look(stream_)) return parse_rifs_look(stream_, map.look);
        if (stream_.at("terminal")) return parse_terminal(map.terminal);
        if (stream_.at("probability")) return parse_probability(map.probability);
        if (at_transform(stream_)) {
            std::optional<TransformLine> line = parse_transform(stream_);
            if (line) map.transforms.push_back(std::move(*line));
            return line.has_value();
        }
        std::vector<std::string> words(transform_keywords.begin(), transform_keywords.end());
        words.insert(words.end(), rifs_map_words.begin(), rifs_map_words.end());
        const Token& word = stream_.peek();
        Diagnostic& error =
            stream_.expected("a transform, 'tint', 'material', 'probability', 'terminal' or '}'");
        const std::string everyday = line_word_hint(word.text);
        if (word.kind == TokenKind::name)
            error.with_hint(everyday.empty() ? did_you_mean(word.text, words) : everyday);
        return false;
    }

    bool parse_probability(std::optional<Expression>& probability) {
        const Token keyword = stream_.next();
        stream_.accept(":");
        if (probability) return duplicate(keyword, probability->span);
        probability = parse_row_expression(stream_);
        return probability.has_value();
    }

    bool parse_terminal(std::optional<RifsPart>& terminal) {
        const Token keyword = stream_.peek();
        std::optional<RifsPart> part = parse_rifs_part(stream_);
        if (!part) return false;
        if (terminal) return duplicate(keyword, terminal->span);
        terminal = std::move(part);
        return true;
    }

    /// Lines of edges add up; anything else is said once.
    bool parse_follow(RifsBlock& block) {
        const Token keyword = stream_.peek();
        std::optional<RifsFollow> follow = parse_rifs_follow(stream_);
        if (!follow) return false;
        if (!block.follow) {
            block.follow = std::move(follow);
            return true;
        }
        const auto is_edges = [](const RifsFollow& f) { return f.kind == RifsFollow::Kind::edges; };
        if (!is_edges(*block.follow) || !is_edges(*follow)) return duplicate(keyword, block.follow->span);
        block.follow->edges.insert(block.follow->edges.end(), follow->edges.begin(), follow->edges.end());
        return true;
    }

    bool parse_start(RifsBlock& block) {
        const Token keyword = stream_.next();
        stream_.accept(":");
        if (!block.start.empty()) return duplicate(keyword, block.start.front().span);
        do {
            const std::optional<Name> name = parse_rifs_name(stream_, "the name of a map");
            if (!name) return false;
            block.start.push_back(*name);
        } while (stream_.accept(","));
        return true;
    }

    bool duplicate(const Token& keyword, Span first) {
        diagnostics_.error(keyword.span, fmt::format("duplicate '{}'", keyword.text))
            .with_note(first, "first given here");
        return false;
    }

    TokenStream& stream_;
    Diagnostics& diagnostics_;
    const ForeignWords& foreign_;
    RifsFile& file_;
    std::size_t map_room_ = max_rifs_maps;
    bool lost_ = false; ///< a run of words that are no statement has been reported
};

} // namespace

RifsFile parse_rifs(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                    const ForeignWords& foreign) {
    TokenStream stream(lex(sources, file, diagnostics), diagnostics);
    stream.set_words(rifs_keywords, line_words);
    stream.drop_semicolons();
    RifsFile tree;
    tree.file = file;
    RifsParser(stream, foreign, tree).parse();
    return tree;
}

} // namespace graftal
