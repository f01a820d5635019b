#include "compiler/syntax/expression_parser.h"

#include <utility>

#include <fmt/format.h>

namespace graftal {

namespace {

enum class Mode { plain, row, angle_brackets };

/// How tightly a binary operator binds; 0 for other tokens. The power binds tighter than signs and is
/// parsed apart.
int precedence(std::string_view op) {
    if (op == "||") return 1;
    if (op == "&&") return 2;
    if (op == "==" || op == "!=" || op == "<" || op == "<=" || op == ">" || op == ">=") return 3;
    if (op == "+" || op == "-") return 4;
    if (op == "*" || op == "/" || op == "%") return 5;
    return 0;
}

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
            std::optional<Expression> right = parse(level + 1);
            if (!right || !count(op)) return std::nullopt;
            left = binary(op, std::move(*left), std::move(*right));
        }
        return left;
    }

  private:
    /// Of the next token, in this mode; 0 if it does not go on with the expression.
    int binary_level() const {
        const Token& op = stream_.peek();
        if (op.kind != TokenKind::symbol) return 0;
        const int level = precedence(op.text);
        if (level == comparison && mode_ != Mode::plain && op.text != "==" && op.text != "!=") return 0;
        if (level == addition && mode_ == Mode::row && op.space_before && !stream_.peek(1).space_before)
            return 0;
        return level;
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
        const bool next_line = stream_.peek(1).is(":"); // a keyword, no value
        if (kind != TokenKind::number && (kind != TokenKind::name || next_line)) {
            stream_.expected("a number");
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
        return node(Expression::Kind::name, token, token.span);
    }

    std::optional<Expression> parse_parenthesis() {
        const Token open = stream_.next();
        const Nested nested(*this);
        if (!nested.ok) return std::nullopt;
        std::optional<Expression> inner = parse();
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

    bool close(const Token& open) {
        if (stream_.accept(")")) return true;
        stream_.expected("')'").with_note(open.span, "to close this '('");
        return false;
    }

    /// One level of recursion, in which all operators are allowed again.
    struct Nested {
        explicit Nested(ExpressionParser& parser)
            : ok(parser.enter()), parser_(parser), outer_(parser.mode_) {
            if (parser.stream_.previous().is("(")) parser.mode_ = Mode::plain;
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
        stream_.diagnostics().error(
            stream_.previous().span,
            fmt::format("expressions are nested more than {} deep", TokenStream::max_nesting));
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

} // namespace

std::optional<Expression> parse_expression(TokenStream& stream) {
    return ExpressionParser(stream, Mode::plain).parse();
}

std::optional<Expression> parse_row_expression(TokenStream& stream) {
    return ExpressionParser(stream, Mode::row).parse();
}

std::optional<std::vector<Expression>> parse_numbers(TokenStream& stream, std::size_t min, std::size_t max,
                                                     std::string_view what) {
    const Token first = stream.peek();
    const bool angle = stream.accept("<");
    std::vector<Expression> numbers;
    do {
        std::optional<Expression> number =
            ExpressionParser(stream, angle ? Mode::angle_brackets : Mode::plain).parse();
        if (!number) return std::nullopt;
        numbers.push_back(std::move(*number));
    } while (max > 1 && stream.at(",") && (angle || begins_number(stream.peek(1), stream.peek(2))) &&
             numbers.size() <= max && stream.accept(","));
    if (numbers.size() < min || numbers.size() > max) {
        const std::string found = numbers.size() > max ? "more" : std::to_string(numbers.size());
        stream.diagnostics().error(stream.span_from(first.span),
                                   fmt::format("{} takes {}, not {}", what, count_words(min, max), found));
        return std::nullopt;
    }
    if (angle && !stream.accept(">")) {
        stream.expected("'>'").with_note(first.span, "to close this '<'");
        return std::nullopt;
    }
    return numbers;
}

bool parse_arguments(TokenStream& stream, std::vector<Expression>& arguments) {
    const Token open = stream.previous();
    do {
        std::optional<Expression> argument = parse_expression(stream);
        if (!argument) return false;
        arguments.push_back(std::move(*argument));
    } while (stream.accept(","));
    if (stream.accept(")")) return true;
    stream.expected("')'").with_note(open.span, "to close this '('");
    return false;
}

std::optional<std::vector<Expression>> parse_vector(TokenStream& stream, std::string_view what) {
    return parse_numbers(stream, 3, 3, what);
}

std::optional<std::vector<Expression>> parse_color(TokenStream& stream, std::string_view what) {
    stream.accept("rgb");
    return parse_vector(stream, what);
}

std::optional<std::vector<Expression>> parse_tint(TokenStream& stream, std::string_view what) {
    stream.accept("rgb");
    if (!stream.at("<")) return parse_numbers(stream, 4, 4, what);
    std::optional<std::vector<Expression>> tint = parse_vector(stream, what);
    if (!tint) return std::nullopt;
    stream.accept(",");
    std::optional<Expression> alpha = parse_expression(stream);
    if (!alpha) return std::nullopt;
    tint->push_back(std::move(*alpha));
    return tint;
}

} // namespace graftal
