#include "compiler/import/eisenscript/parser.h"

#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/colour_names.h"

namespace graftal::eisenscript {

namespace {

constexpr int most_copies = 1'000'000;
constexpr std::size_t most_loops = 16;

struct OperatorRow {
    Operator::Kind kind;
    int least; ///< numbers
    int most;
};

const std::map<std::string_view, OperatorRow>& operator_table() {
    using enum Operator::Kind;
    static const std::map<std::string_view, OperatorRow> table = {
        {"x", {x, 1, 1}},
        {"y", {y, 1, 1}},
        {"z", {z, 1, 1}},
        {"rx", {rx, 1, 1}},
        {"ry", {ry, 1, 1}},
        {"rz", {rz, 1, 1}},
        {"s", {size, 1, 3}},
        {"fx", {size, 0, 0}},
        {"fy", {size, 0, 0}},
        {"fz", {size, 0, 0}},
        {"matrix", {matrix, 9, 9}},
        {"reflect", {reflect, 3, 3}},
        {"h", {hue, 1, 1}},
        {"hue", {hue, 1, 1}},
        {"sat", {saturation, 1, 1}},
        {"b", {brightness, 1, 1}},
        {"brightness", {brightness, 1, 1}},
        {"v", {brightness, 1, 1}},
        {"a", {alpha, 1, 1}},
        {"alpha", {alpha, 1, 1}},
        {"c", {colour, 0, 0}},
        {"color", {colour, 0, 0}},
        {"blend", {blend, 1, 1}},
    };
    return table;
}

class Parser {
  public:
    explicit Parser(const ForeignFile& file) : file_(file), tokens_(tokenize(file)) {}

    Script run() {
        script_.rules.emplace_back();
        script_.constants = std::move(tokens_.constants);
        while (peek().kind != TokenKind::end && !file_.diagnostics.full()) {
            if (peek().is("rule")) {
                if (!parse_rule()) skip_to_rule();
            } else if (!parse_line(script_.rules.front())) {
                skip_to_rule();
            }
        }
        next();
        script_.tail = std::move(comments_);
        return std::move(script_);
    }

  private:
    const Token& peek() const { return tokens_.list[at_]; }

    const Token& next() {
        const Token& token = tokens_.list[at_];
        comments_.insert(comments_.end(), token.comments.begin(), token.comments.end());
        if (token.kind != TokenKind::end) ++at_;
        return token;
    }

    bool accept(TokenKind kind) {
        if (peek().kind != kind) return false;
        next();
        return true;
    }

    bool expected(std::string_view what) {
        file_.diagnostics.error(peek().span, fmt::format("expected {}, found {}", what,
                                                         peek().kind == TokenKind::end
                                                             ? peek().written
                                                             : fmt::format("'{}'", peek().written)));
        return false;
    }

    void skip_to_rule() {
        while (peek().kind != TokenKind::end && !peek().is("rule"))
            next();
    }

    std::optional<Value> number(std::string_view after) {
        if (peek().kind != TokenKind::number) {
            expected(fmt::format("a number after '{}'", after));
            return std::nullopt;
        }
        const Token& token = next();
        return Value{token.number, token.constant};
    }

    /// `2 * 0.5 + 1`, as other implementations read it within braces; products come first.
    std::optional<Value> sum(std::string_view after) {
        std::optional<Value> value = product(after);
        while (value && (peek().is("+") || peek().is("-"))) {
            const double sign = next().text == "+" ? 1 : -1;
            const std::optional<Value> more = product(after);
            if (!more) return std::nullopt;
            value = Value{value->number + sign * more->number, {}};
        }
        return value;
    }

    std::optional<Value> product(std::string_view after) {
        std::optional<Value> value = number(after);
        while (value && (peek().kind == TokenKind::times || peek().is("/"))) {
            const Token sign = next();
            const std::optional<Value> more = number(after);
            if (!more) return std::nullopt;
            const double result =
                sign.kind == TokenKind::times ? value->number * more->number : value->number / more->number;
            if (!(std::abs(result) <= 1e100)) {
                file_.diagnostics.error(sign.span, "this has no value");
                return std::nullopt;
            }
            value = Value{result, {}};
        }
        return value;
    }

    bool parse_rule() {
        Rule rule;
        next();
        if (peek().kind != TokenKind::word) return expected("the name of the rule");
        rule.name = next();
        while (peek().is("md") || peek().is("maxdepth") || peek().is("w") || peek().is("weight"))
            if (!parse_modifier(rule)) return false;
        if (!accept(TokenKind::open)) return expected("'{', 'maxdepth' or 'weight'");
        rule.comments = std::exchange(comments_, {});
        while (peek().kind != TokenKind::close) {
            if (peek().kind == TokenKind::end || peek().is("rule"))
                return expected("'}' at the end of the rule");
            if (!parse_line(rule)) return false;
        }
        next();
        rule.tail = std::exchange(comments_, {});
        script_.rules.push_back(std::move(rule));
        return true;
    }

    bool parse_modifier(Rule& rule) {
        const Token keyword = next();
        const bool whole = peek().whole;
        const std::optional<Value> value = number(keyword.written);
        if (!value) return false;
        if (keyword.text[0] == 'w') {
            if (value->number < 0 || value->number > 1e100) {
                file_.diagnostics.error(keyword.span, "a weight must not be negative");
                return false;
            }
            rule.weight = *value;
            return true;
        }
        if (!whole || value->number < 0) {
            file_.diagnostics.error(keyword.span, "a depth is a whole number, and not negative");
            return false;
        }
        rule.depth = static_cast<int>(value->number);
        if (!accept(TokenKind::more)) return true;
        if (peek().kind != TokenKind::word) return expected("the rule that follows");
        rule.fallback = next();
        return true;
    }

    bool parse_line(Rule& rule) {
        if (!peek().is("set")) return parse_action(rule);
        const Span begin = next().span;
        if (peek().kind != TokenKind::word) return expected("the name of a setting");
        const Token key = next();
        if (peek().kind == TokenKind::end) return expected("the value of the setting");
        const Token value = next();
        rule.settings.push_back({key.text, value.written, join(begin, value.span)});
        return true;
    }

    bool parse_action(Rule& rule) {
        Action action;
        const Span begin = peek().span;
        while (peek().kind == TokenKind::number || peek().kind == TokenKind::open) {
            if (action.loops.size() == most_loops) return expected("the name of a rule");
            std::optional<Loop> loop = parse_loop();
            if (!loop) return false;
            action.loops.push_back(std::move(*loop));
        }
        if (peek().kind != TokenKind::word) return expected("the name of a rule");
        action.target = next();
        action.comments = std::exchange(comments_, {});
        action.span = join(begin, action.target.span);
        rule.actions.push_back(std::move(action));
        return true;
    }

    std::optional<Loop> parse_loop() {
        Loop loop;
        loop.span = peek().span;
        if (peek().kind == TokenKind::number) {
            const Token count = next();
            if (!count.whole || count.number > most_copies) {
                file_.diagnostics.error(count.span,
                                        fmt::format("a count is a whole number up to {}", most_copies));
                return std::nullopt;
            }
            loop.count = {count.number, count.constant};
            if (!accept(TokenKind::times)) {
                expected("'*'");
                return std::nullopt;
            }
        }
        if (!accept(TokenKind::open)) {
            expected("'{'");
            return std::nullopt;
        }
        while (peek().kind != TokenKind::close) {
            std::optional<Operator> op = parse_operator();
            if (!op) return std::nullopt;
            loop.operators.push_back(std::move(*op));
        }
        loop.span = join(loop.span, next().span);
        return loop;
    }

    std::optional<Operator> parse_operator() {
        const auto row = operator_table().find(peek().text);
        if (peek().kind != TokenKind::word || row == operator_table().end()) {
            expected("a transformation, such as x, rz, s or hue, or '}'");
            return std::nullopt;
        }
        const Token word = next();
        Operator op{.kind = row->second.kind, .span = word.span};
        if (word.text[0] == 'f')
            for (const char axis : {'x', 'y', 'z'})
                op.numbers.push_back({word.text[1] == axis ? -1.0 : 1.0, {}});
        if ((op.kind == Operator::Kind::colour || op.kind == Operator::Kind::blend) && !parse_colour(op))
            return std::nullopt;
        for (int i = 0; i < row->second.most; ++i) {
            if (i >= row->second.least && peek().kind != TokenKind::number) break;
            const std::optional<Value> value = sum(word.written);
            if (!value) return std::nullopt;
            op.numbers.push_back(*value);
        }
        if (op.kind == Operator::Kind::size && op.numbers.size() == 2) {
            expected("a third size");
            return std::nullopt;
        }
        op.span = join(op.span, tokens_.list[at_ - 1].span);
        return op;
    }

    bool parse_colour(Operator& op) {
        const Token name = next();
        op.colour = colour_named(name.text);
        if (op.colour || (op.kind == Operator::Kind::colour && name.is("random"))) return true;
        file_.diagnostics.error(name.span, fmt::format("'{}' is not a colour", name.written))
            .with_hint("a colour is a name of the web, such as orange, or #f80");
        return false;
    }

    const ForeignFile& file_;
    Tokens tokens_;
    std::size_t at_ = 0;
    std::vector<std::string> comments_; ///< of tokens that were taken, not given to anything yet
    Script script_;
};

} // namespace

Script parse(const ForeignFile& file) {
    return Parser(file).run();
}

} // namespace graftal::eisenscript
