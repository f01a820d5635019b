#include "compiler/syntax/expression_parser.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace graftal {

namespace {

/// Where an expression stands: in angle brackets '<' and '>' are no comparisons, in a row nor do signs that
/// stand off from what is before them go on.
struct Mode {
    bool angle_brackets = false;
    bool row = false;
    bool list =
        false; ///< of several numbers, commas or not: a sign that begins a line begins what comes next
};

constexpr const char* vector_hint = "write a vector as x, y, z or <x, y, z>";

/// The precedence of a binary operator; 0 for other tokens. The power binds tighter than signs and is parsed
/// apart.
int precedence(std::string_view op) {
    if (op == "||") return 1;
    if (op == "&&") return 2;
    if (op == "==" || op == "!=" || op == "<" || op == "<=" || op == ">" || op == ">=") return 3;
    if (op == "+" || op == "-") return 4;
    if (op == "*" || op == "/" || op == "%") return 5;
    return 0;
}

constexpr std::size_t most_indices = 2;

constexpr int comparison = 3;
constexpr int addition = 4;

/// Precedence climbing. Recursion is bounded by depth_, the height of the tree by size_.
class ExpressionParser {
  public:
    ExpressionParser(TokenStream& stream, Mode mode) : stream_(stream), mode_(mode) {}

    std::optional<Expression> parse(int lowest = 1) {
        std::optional<Expression> left = parse_signed();
        while (left) {
            const int level = binary_level();
            if (level < lowest) break;
            const Token op = stream_.next();
            if (op.is("%") && !begins_operand()) return refuse_percent(op);
            std::optional<Expression> right = parse(level + 1);
            if (!right || !count(op)) return std::nullopt;
            left = binary(op, std::move(*left), std::move(*right));
        }
        return left;
    }

  private:
    /// The precedence of the next token, in this mode; 0 if it does not go on with the expression.
    int binary_level() const {
        const Token& op = stream_.peek();
        if (op.kind != TokenKind::symbol) return 0;
        const int level = precedence(op.text);
        const bool bracket = op.text != "==" && op.text != "!=";
        if (level == comparison && (mode_.row || mode_.angle_brackets) && bracket) return 0;
        const bool apart = mode_.row ? op.space_before : mode_.list && op.first_on_line;
        if (level == addition && apart && !stream_.peek(1).space_before) return 0;
        return level;
    }

    bool begins_operand() const {
        const Token& token = stream_.peek();
        if (token.first_on_line) return false;
        return token.kind == TokenKind::number || token.kind == TokenKind::name || token.is("(") ||
               token.is("-") || token.is("+") || token.is("!");
    }

    std::nullopt_t refuse_percent(const Token& op) {
        stream_.diagnostics()
            .error(op.span, "'%' is the remainder of a division, and its right side is missing")
            .with_hint("write a share as a number from 0 to 1: 0.5 instead of 50%");
        return std::nullopt;
    }

    std::optional<Expression> parse_signed() {
        if (!stream_.at("-") && !stream_.at("+") && !stream_.at("!")) return parse_power();
        const Token op = stream_.next();
        const Nested nested(*this);
        if (!nested.ok || !count(op)) return std::nullopt;
        std::optional<Expression> operand = parse_signed();
        if (!operand || op.is("+")) return operand;
        Expression result = node(Expression::Kind::unary, op, join(op.span, operand->span));
        result.operands.push_back(std::move(*operand));
        return result;
    }

    std::optional<Expression> parse_power() {
        std::optional<Expression> base = parse_primary();
        if (!base || !stream_.at("^")) return base;
        const Token op = stream_.next();
        const Nested nested(*this);
        if (!nested.ok || !count(op)) return std::nullopt;
        std::optional<Expression> exponent = parse_signed();
        if (!exponent) return std::nullopt;
        return binary(op, std::move(*base), std::move(*exponent));
    }

    std::optional<Expression> parse_primary() {
        if (stream_.at("(")) return parse_parenthesis();
        const TokenKind kind = stream_.peek().kind;
        if (kind != TokenKind::number && (kind != TokenKind::name || at_keyword())) {
            const bool equals = stream_.at("=");
            Diagnostic& error = stream_.expected("a number");
            if (equals) error.with_hint("write values after their word without '='");
            return std::nullopt;
        }
        const Token token = stream_.next();
        if (!count(token)) return std::nullopt;
        if (kind == TokenKind::number) {
            Expression result = node(Expression::Kind::number, token, token.span);
            result.text.clear();
            result.number = token.number;
            return result;
        }
        if (stream_.at("(")) return parse_call(token);
        if (stream_.at("[") && !stream_.peek().space_before) return parse_element(token);
        return node(Expression::Kind::name, token, token.span);
    }

    /// `scale:`, or on a line of its own `object NAME`, `camera {`: no value.
    bool at_keyword() const {
        const Token& after = stream_.peek(1);
        if (after.is(":")) return true;
        return !mode_.row && stream_.peek().first_on_line && !after.first_on_line &&
               (after.kind == TokenKind::name || after.is("{"));
    }

    std::optional<Expression> parse_parenthesis() {
        const Token open = stream_.next();
        const Nested nested(*this);
        if (!nested.ok) return std::nullopt;
        std::optional<Expression> inner = parse();
        if (inner && stream_.at(",")) {
            stream_.expected("')'").with_hint(vector_hint).with_note(open.span, "to close this '('");
            return std::nullopt;
        }
        if (!inner || !close(open)) return std::nullopt;
        inner->span = stream_.span_from(open.span);
        return inner;
    }

    std::optional<Expression> parse_call(const Token& name) {
        const Token open = stream_.next();
        const Nested nested(*this);
        if (!nested.ok) return std::nullopt;
        Expression result = node(Expression::Kind::call, name, name.span);
        if (!stream_.at(")")) do {
                std::optional<Expression> argument = parse();
                if (!argument) return std::nullopt;
                result.operands.push_back(std::move(*argument));
            } while (stream_.accept(","));
        if (!close(open)) return std::nullopt;
        result.span = stream_.span_from(name.span);
        return result;
    }

    /// `a[i]`, `a[i][j]`
    std::optional<Expression> parse_element(const Token& name) {
        Expression result = node(Expression::Kind::element, name, name.span);
        while (stream_.at("[") && !stream_.peek().space_before) {
            const Token open = stream_.next();
            if (result.operands.size() == most_indices) {
                stream_.diagnostics().error(open.span, "an array has one or two indices");
                return std::nullopt;
            }
            const Nested nested(*this);
            if (!nested.ok) return std::nullopt;
            std::optional<Expression> index = parse();
            if (!index || !close(open, "]")) return std::nullopt;
            result.operands.push_back(std::move(*index));
        }
        result.span = stream_.span_from(name.span);
        return result;
    }

    bool close(const Token& open, std::string_view by = ")") {
        if (stream_.accept(by)) return true;
        stream_.expected(fmt::format("'{}'", by))
            .with_note(open.span, fmt::format("to close this '{}'", open.text));
        return false;
    }

    /// One level of recursion, in which all operators are allowed again.
    struct Nested {
        explicit Nested(ExpressionParser& parser)
            : ok(parser.enter()), parser_(parser), outer_(parser.mode_) {
            if (parser.stream_.previous().is("(") || parser.stream_.previous().is("[")) parser.mode_ = Mode();
        }
        ~Nested() {
            --parser_.depth_;
            parser_.mode_ = outer_;
        }
        Nested(const Nested&) = delete;
        Nested& operator=(const Nested&) = delete;
        bool ok;

      private:
        ExpressionParser& parser_;
        Mode outer_;
    };

    bool enter() {
        if (++depth_ <= TokenStream::max_nesting) return true;
        stream_.diagnostics().error(stream_.previous().span, fmt::format("expressions nest more than {} deep",
                                                                         TokenStream::max_nesting));
        return false;
    }

    bool count(const Token& token) {
        if (++size_ <= max_expression_size) return true;
        stream_.diagnostics().error(
            token.span, fmt::format("this expression has more than {} terms", max_expression_size));
        return false;
    }

    static Expression node(Expression::Kind kind, const Token& token, Span span) {
        Expression result;
        result.kind = kind;
        result.text = token.text;
        result.span = span;
        return result;
    }

    static Expression binary(const Token& op, Expression left, Expression right) {
        Expression result = node(Expression::Kind::binary, op, join(left.span, right.span));
        result.operands.reserve(2);
        result.operands.push_back(std::move(left));
        result.operands.push_back(std::move(right));
        return result;
    }

    TokenStream& stream_;
    Mode mode_;
    std::size_t depth_ = 0;
    std::size_t size_ = 0;
};

std::string count_words(std::size_t min, std::size_t max) {
    if (min == max) return fmt::format("{} number{}", min, min == 1 ? "" : "s");
    return fmt::format("{} {} {} numbers", min, max == min + 1 ? "or" : "to", max);
}

/// Whether a comma before this token goes on with a list of numbers.
bool begins_number(const Token& token, const Token& after) {
    if (token.kind == TokenKind::number) return true;
    if (token.kind == TokenKind::name) return !after.is(":");
    return token.is("(") || token.is("-") || token.is("+") || token.is("!");
}

/// Words that begin something else where numbers stand without commas: those that all languages share.
bool is_shared_keyword(const Token& token) {
    static constexpr std::array<std::string_view, 30> words = {
        "scale",        "rotate",     "translate",  "shear",     "matrix",  "projection",
        "tint",         "material",   "location",   "look_at",   "up",      "angle",
        "width",        "sun",        "color",      "zenith",    "horizon", "height",
        "area",         "ambient",    "diffuse",    "specular",  "texture", "around",
        "orthographic", "shadowless", "reflection", "roughness", "members", "rgb"};
    return token.kind == TokenKind::name && std::find(words.begin(), words.end(), token.text) != words.end();
}

/// A list of numbers under way.
class NumberList {
  public:
    NumberList(TokenStream& stream, std::size_t min, std::size_t max)
        : stream_(stream), first_(stream.peek()), min_(min), max_(max) {
        mode_.list = max > 1;
        mode_.angle_brackets = stream.accept("<");
    }

    /// Nothing after an error, which has been reported; the count is not checked.
    bool parse() {
        if (stream_.at("[")) {
            stream_.expected("a number").with_hint(vector_hint);
            return false;
        }
        const std::size_t begin = stream_.position();
        do {
            std::optional<Expression> number = ExpressionParser(stream_, mode_).parse();
            if (!number) return false;
            const bool row = max_ > 1 && !mode_.row && numbers_.empty() && !stream_.at(",");
            if (row) { // read again, now with the signs of a row
                mode_.row = true;
                stream_.go_back(begin);
                number = ExpressionParser(stream_, mode_).parse();
                if (!number) return false;
            }
            numbers_.push_back(std::move(*number));
        } while (stream_.at(",") ? take_comma() : max_ > 1 && number_follows());
        return true;
    }

    std::vector<Expression> numbers() && { return std::move(numbers_); }
    std::size_t count() const { return numbers_.size(); }
    const Token& first() const { return first_; }
    bool angle_brackets() const { return mode_.angle_brackets; }
    /// Whether the last number is a name too many, with its own lines: `translate: 0, 1, 0, tip scale: 0.5`.
    bool took_instance() const {
        return count() > max_ && numbers_.back().kind == Expression::Kind::name && is_keyword(stream_.peek());
    }

  private:
    bool take_comma() {
        const bool goes_on = mode_.angle_brackets || begins_number(stream_.peek(1), stream_.peek(2));
        return max_ > 1 && goes_on && count() <= max_ && stream_.accept(",");
    }

    bool is_keyword(const Token& token) const {
        return is_shared_keyword(token) || stream_.is_line_word(token);
    }

    /// Without a comma; in a list with commas only where one is missed.
    bool number_follows() const {
        const Token& token = stream_.peek();
        const bool needed = count() < min_;
        if (mode_.angle_brackets) return !token.is(">") && begins_number(token, stream_.peek(1));
        if (count() >= max_ || (!needed && (!mode_.row || token.first_on_line))) return false;
        if (token.kind == TokenKind::name && (token.first_on_line || !needed || is_keyword(token)))
            return false;
        return !token.is("!") && begins_number(token, stream_.peek(1));
    }

    TokenStream& stream_;
    const Token first_;
    std::size_t min_, max_;
    Mode mode_;
    std::vector<Expression> numbers_;
};

constexpr std::string_view colour_hint =
    "write a colour as red, green and blue from 0 to 1: 1, 0.5, 0 is orange";
constexpr std::string_view tint_hint = "write a tint as a colour and an alpha: r, g, b, a or rgb <r, g, b> a";

/// Names that people try, and what they are here.
std::string_view named_colour(std::string_view name) {
    static constexpr std::pair<std::string_view, std::string_view> colours[] = {
        {"red", "1, 0, 0"},        {"green", "0, 1, 0"},    {"blue", "0, 0, 1"},
        {"white", "1, 1, 1"},      {"black", "0, 0, 0"},    {"yellow", "1, 1, 0"},
        {"cyan", "0, 1, 1"},       {"magenta", "1, 0, 1"},  {"gray", "0.2, 0.2, 0.2"},
        {"grey", "0.2, 0.2, 0.2"}, {"orange", "1, 0.4, 0"}, {"brown", "0.2, 0.08, 0.03"}};
    for (const auto& [known, numbers] : colours)
        if (known == name) return numbers;
    return {};
}

/// `color: red`, where no list of numbers begins. Reported.
bool refuse_named_colour(TokenStream& stream) {
    const Token& token = stream.peek();
    const Token& after = stream.peek(1);
    const std::string_view numbers = token.kind == TokenKind::name ? named_colour(token.text) : "";
    const bool list = after.is(",") || after.kind == TokenKind::number ||
                      (after.kind == TokenKind::name && !after.first_on_line && !is_shared_keyword(after) &&
                       !stream.is_line_word(after));
    if (numbers.empty() || list) return false;
    stream.diagnostics()
        .error(token.span, fmt::format("'{}' is not a number, and colours have no names here", token.text))
        .with_hint(fmt::format("{} is {}", token.text, numbers));
    return true;
}

/// `hsv(h, s, v)`, and `nothing` after an error.
std::optional<Expression> parse_hsv(TokenStream& stream) {
    Expression call{.kind = Expression::Kind::call, .text = "hsv"};
    const Token name = stream.next();
    stream.next(); // the '('
    if (!parse_arguments(stream, call.operands)) return std::nullopt;
    call.span = stream.span_from(name.span);
    if (call.operands.size() == 3) return call;
    stream.diagnostics()
        .error(call.span, fmt::format("'hsv' takes 3 arguments, not {}", call.operands.size()))
        .with_hint("write hsv(hue, saturation, value), with the hue in degrees");
    return std::nullopt;
}

bool at_hsv(const TokenStream& stream) {
    return stream.at("hsv") && stream.peek(1).is("(");
}

/// The alpha after a colour, with or without a comma.
std::optional<Expression> parse_alpha(TokenStream& stream) {
    stream.accept(",");
    if (begins_number(stream.peek(), stream.peek(1))) return parse_row_expression(stream);
    stream.expected("an alpha").with_hint(std::string(tint_hint));
    return std::nullopt;
}

} // namespace

std::optional<Expression> parse_expression(TokenStream& stream) {
    return ExpressionParser(stream, Mode()).parse();
}

std::optional<Expression> parse_row_expression(TokenStream& stream) {
    return ExpressionParser(stream, Mode{.row = true}).parse();
}

std::optional<std::vector<Expression>> parse_numbers(TokenStream& stream, std::size_t min, std::size_t max,
                                                     std::string_view what, std::string_view hint) {
    NumberList list(stream, min, max);
    if (!list.parse()) return std::nullopt;
    if (list.count() < min || list.count() > max) {
        const std::string found = list.count() > max ? "more" : std::to_string(list.count());
        stream.diagnostics()
            .error(stream.span_from(list.first().span),
                   fmt::format("{} takes {}, not {}", what, count_words(min, max), found))
            .with_hint(list.took_instance() ? fmt::format("begin a new line before '{}', without the comma",
                                                          std::move(list).numbers().back().text)
                                            : std::string(hint));
        return std::nullopt;
    }
    if (list.angle_brackets() && !stream.accept(">")) {
        stream.expected("'>'").with_note(list.first().span, "to close this '<'");
        return std::nullopt;
    }
    return std::move(list).numbers();
}

bool parse_arguments(TokenStream& stream, std::vector<Expression>& arguments) {
    const Token open = stream.previous();
    do {
        std::optional<Expression> argument = parse_expression(stream);
        if (!argument) return false;
        arguments.push_back(std::move(*argument));
    } while (stream.accept(","));
    if (stream.accept(")")) return true;
    const bool number = begins_number(stream.peek(), stream.peek(1)) && !stream.peek().first_on_line;
    Diagnostic& error = stream.expected(number ? "',' or ')'" : "')'");
    error.with_note(open.span, "to close this '('");
    return false;
}

std::optional<std::vector<Expression>> parse_vector(TokenStream& stream, std::string_view what) {
    return parse_numbers(stream, 3, 3, what);
}

std::optional<std::vector<Expression>> parse_color(TokenStream& stream, std::string_view what) {
    std::vector<Expression> colour;
    if (at_hsv(stream)) {
        std::optional<Expression> call = parse_hsv(stream);
        if (!call) return std::nullopt;
        colour.push_back(std::move(*call));
        return colour;
    }
    stream.accept("rgb");
    if (refuse_named_colour(stream)) return std::nullopt;
    return parse_numbers(stream, 3, 3, what, colour_hint);
}

std::optional<std::vector<Expression>> parse_tint(TokenStream& stream, std::string_view what) {
    const bool hsv = at_hsv(stream);
    if (!hsv) stream.accept("rgb");
    if (!hsv && refuse_named_colour(stream)) return std::nullopt;
    if (!hsv && !stream.at("<")) return parse_numbers(stream, 4, 4, what, tint_hint);
    std::optional<std::vector<Expression>> tint =
        hsv ? parse_color(stream, what) : parse_numbers(stream, 3, 3, what, colour_hint);
    if (!tint) return std::nullopt;
    std::optional<Expression> alpha = parse_alpha(stream);
    if (!alpha) return std::nullopt;
    tint->push_back(std::move(*alpha));
    return tint;
}

} // namespace graftal
