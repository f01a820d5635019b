#include "compiler/rifs/orbit_parser.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/rifs/parts.h"
#include "compiler/rifs/tables.h"
#include "compiler/syntax/expression_functions.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

constexpr std::size_t most_maps = 1000;
constexpr std::size_t most_definitions = 1000;

class OrbitParser {
  public:
    OrbitParser(TokenStream& stream, OrbitBlock& block)
        : stream_(stream), diagnostics_(stream.diagnostics()), block_(block) {}

    bool parse() {
        const Token keyword = stream_.next();
        const std::optional<Name> name = parse_rifs_name(stream_, "a name after 'orbit'");
        if (!name) return false;
        block_.name = *name;
        block_.span = stream_.span_from(keyword.span);
        const Token open = stream_.peek();
        if (!stream_.expect("{", name->text)) return false;
        parse_items(fmt::format("'orbit {}'", name->text), open, [&] { return parse_item(); });
        return true;
    }

  private:
    /// Parses items up to the '}', going on with the next line after an error.
    template<typename Item> void parse_items(const std::string& what, const Token& open, const Item& item) {
        while (!stream_.accept("}")) {
            if (diagnostics_.full()) return stream_.skip_block();
            if (stream_.at_end()) {
                stream_.expected(fmt::format("'}}' at the end of {}", what))
                    .with_note(open.span, "to close this '{'");
                return;
            }
            if (!item()) stream_.skip_line();
        }
    }

    bool parse_item() {
        if (stream_.at("start")) return parse_start();
        if (stream_.at("skip")) return parse_number(block_.skip);
        if (stream_.at("restart")) return parse_number(block_.restart);
        if (stream_.at("map")) return parse_map();
        if (stream_.at("final") && !stream_.peek(1).is("(")) return parse_final();
        if (stream_.at("follow") && !stream_.peek(1).is("(")) return parse_follow();
        if (stream_.at("let")) return parse_lets(block_.lets);
        if (stream_.at_name() && stream_.peek(1).is("(")) return parse_function();
        if (at_map_item()) return parse_map_item(sole_map());
        return unknown("'map', 'x =', 'y =', 'final', 'follow', 'start', 'skip', 'restart', 'let', NAME(x) = "
                       "or '}'",
                       {orbit_words.begin(), orbit_words.end()});
    }

    bool unknown(const char* expected, const std::vector<std::string>& words) {
        const Token word = stream_.peek();
        const bool assigns = stream_.peek(1).is(":") && stream_.peek(2).is("=");
        Diagnostic& error = stream_.expected(expected);
        if (assigns)
            error.with_hint(fmt::format("write a formula as {} = ...", word.text));
        else if (word.kind == TokenKind::name)
            error.with_hint(did_you_mean(word.text, words));
        if (stream_.next().is("{")) stream_.skip_block();
        return false;
    }

    bool parse_start() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        if (!block_.start.empty()) return duplicate(keyword, block_.start.front().span);
        std::optional<std::vector<Expression>> values = parse_numbers(stream_, 2, 3, "'start'");
        if (values) block_.start = std::move(*values);
        return values.has_value();
    }

    bool parse_number(std::optional<Expression>& number) {
        const Token keyword = stream_.next();
        stream_.accept(":");
        if (number) return duplicate(keyword, number->span);
        number = parse_row_expression(stream_);
        return number.has_value();
    }

    bool parse_lets(std::vector<OrbitLet>& lets) {
        stream_.next();
        do {
            const std::optional<Name> name = parse_rifs_name(stream_, "a name after 'let'");
            if (!name || !stream_.expect("=", name->text)) return false;
            std::optional<Expression> value = parse_expression(stream_);
            if (!value) return false;
            if (is_coordinate(name->text))
                diagnostics_.error(name->span, fmt::format("'{}' is a coordinate of the point", name->text))
                    .with_hint(
                        fmt::format("give the new coordinate as '{} = ...', without 'let'", name->text));
            const auto same = [&](const OrbitLet& let) { return let.name.text == name->text; };
            if (const auto first = std::find_if(lets.begin(), lets.end(), same); first != lets.end())
                diagnostics_.error(name->span, fmt::format("duplicate let '{}'", name->text))
                    .with_note(first->name.span, "first defined here");
            if (!room(lets.size(), name->span)) return false;
            lets.push_back({*name, std::move(*value)});
        } while (stream_.accept(","));
        return true;
    }

    bool room(std::size_t count, Span span) {
        if (count < most_definitions) return true;
        diagnostics_.error(span, fmt::format("more than {} definitions", most_definitions));
        return false;
    }

    bool parse_function() {
        OrbitFunction function;
        const Token name = stream_.next();
        function.name = {name.text, name.span};
        stream_.next();
        do {
            const std::optional<Name> parameter = parse_rifs_name(stream_, "the name of a parameter");
            if (!parameter) return false;
            for (const Name& other : function.parameters)
                if (other.text == parameter->text)
                    diagnostics_.error(parameter->span,
                                       fmt::format("'{}' has two parameters '{}'", name.text, other.text));
            function.parameters.push_back(*parameter);
        } while (stream_.accept(","));
        if (!stream_.expect(")", function.parameters.back().text) || !stream_.expect("=", ")")) return false;
        std::optional<Expression> body = parse_expression(stream_);
        if (!body) return false;
        function.body = std::move(*body);
        return add_function(std::move(function));
    }

    bool add_function(OrbitFunction function) {
        const Name& name = function.name;
        if (expression_function(name.text))
            diagnostics_.error(name.span, fmt::format("the function '{}' already exists", name.text));
        const auto same = [&](const OrbitFunction& other) { return other.name.text == name.text; };
        const auto first = std::find_if(block_.functions.begin(), block_.functions.end(), same);
        if (first != block_.functions.end())
            diagnostics_.error(name.span, fmt::format("duplicate function '{}'", name.text))
                .with_note(first->name.span, "first defined here");
        if (!room(block_.functions.size(), name.span)) return false;
        block_.functions.push_back(std::move(function));
        return true;
    }

    static bool is_coordinate(std::string_view name) { return name == "x" || name == "y" || name == "z"; }

    bool at_map_item() const {
        return (is_coordinate(stream_.peek().text) && stream_.peek(1).is("=")) || at_rifs_look(stream_) ||
               stream_.at("probability");
    }

    /// The map that the block's own formulas make.
    OrbitMap& sole_map() {
        if (!sole_) {
            sole_ = block_.maps.size();
            OrbitMap map;
            map.name = {"", stream_.peek().span};
            map.span = stream_.peek().span;
            block_.maps.push_back(std::move(map));
        }
        return block_.maps[*sole_];
    }

    bool parse_map() {
        const Token keyword = stream_.next();
        OrbitMap map;
        map.name = {"", keyword.span};
        if (!stream_.at("{")) {
            const std::optional<Name> name = parse_rifs_name(stream_, "a name or '{' after 'map'");
            if (!name) return false;
            map.name = *name;
        }
        map.span = stream_.span_from(keyword.span);
        if (block_.maps.size() >= most_maps) {
            diagnostics_.error(map.span, fmt::format("more than {} maps", most_maps));
            return false;
        }
        if (!parse_formulas(map, "'map'")) return false;
        block_.maps.push_back(std::move(map));
        return true;
    }

    bool parse_formulas(OrbitMap& map, const char* what) {
        const Token open = stream_.peek();
        if (!stream_.expect("{", stream_.previous().text)) return false;
        parse_items(what, open, [&] {
            if (stream_.at("let")) return parse_lets(map.lets);
            if (at_map_item()) return parse_map_item(map);
            return unknown("'x =', 'y =', 'let', 'probability', 'tint', 'material' or '}'",
                           {"x", "y", "z", "let", "probability", "tint", "material"});
        });
        return true;
    }

    bool parse_final() {
        const Token keyword = stream_.next();
        OrbitMap last;
        last.name = {keyword.text, keyword.span};
        last.span = keyword.span;
        if (block_.last) return duplicate(keyword, block_.last->span);
        if (!parse_formulas(last, "'final'")) return false;
        if (last.probability)
            diagnostics_.error(last.probability->span, "'final' maps every point: it has no probability");
        block_.last = std::move(last);
        return true;
    }

    bool parse_follow() {
        const Token keyword = stream_.peek();
        if (block_.follow) {
            stream_.next();
            return duplicate(keyword, block_.follow->span);
        }
        block_.follow = parse_rifs_follow(stream_);
        if (!block_.follow) return false;
        if (block_.follow->kind != RifsFollow::Kind::matrix)
            diagnostics_.error(block_.follow->span, "an orbit takes 'follow matrix { ... }'")
                .with_hint("write a row for each map: the factors of the probabilities of those after it");
        return true;
    }

    bool parse_map_item(OrbitMap& map) {
        if (at_rifs_look(stream_)) return parse_rifs_look(stream_, map.look);
        if (stream_.at("probability")) return parse_number(map.probability);
        const Token name = stream_.next();
        stream_.next(); // =
        std::optional<Expression>& coordinate = map.coordinates[name.text.front() - 'x'];
        if (coordinate) return duplicate(name, coordinate->span);
        coordinate = parse_expression(stream_);
        return coordinate.has_value();
    }

    bool duplicate(const Token& keyword, Span first) {
        diagnostics_.error(keyword.span, fmt::format("duplicate '{}'", keyword.text))
            .with_note(first, "first given here");
        return false;
    }

    TokenStream& stream_;
    Diagnostics& diagnostics_;
    OrbitBlock& block_;
    std::optional<std::size_t> sole_;
};

} // namespace

bool parse_orbit(TokenStream& stream, std::vector<OrbitBlock>& orbits) {
    OrbitBlock block;
    const bool good = OrbitParser(stream, block).parse();
    orbits.push_back(std::move(block));
    return good;
}

} // namespace graftal
