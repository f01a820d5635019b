#include "compiler/inst/parse/scatter.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

constexpr std::array<std::string_view, 4> orders = {"poisson", "uniform", "jitter", "spiral"};
constexpr std::size_t most_weights = 1'000'000;

/// One line at its keyword.
class LineParser {
  public:
    LineParser(TokenStream& stream, InstScatter& scatter) : stream_(stream), scatter_(scatter) {}

    bool parse() {
        if (!stream_.at_name()) return parse_number(scatter_.count, stream_.peek().span, "count");
        const Token keyword = stream_.next();
        stream_.accept(":");
        if (keyword.is("count")) return parse_number(scatter_.count, keyword.span, "count");
        if (keyword.is("seed")) return parse_number(scatter_.seed, keyword.span, "seed");
        if (keyword.is("apart")) return parse_number(scatter_.apart, keyword.span, "apart");
        if (keyword.is("over")) return parse_over(keyword);
        if (keyword.is("except")) return parse_except();
        if (keyword.is("by")) return parse_by(keyword);
        if (keyword.is("turn")) return parse_turn(keyword);
        if (keyword.is("lean")) return parse_range(scatter_.lean, keyword);
        if (keyword.is("size")) return parse_range(scatter_.size, keyword);
        return parse_weights(keyword);
    }

  private:
    /// Reports the second of two lines that may stand once.
    void refuse_twice(bool given, Span span, std::string_view keyword) {
        if (given)
            stream_.diagnostics().error(span, fmt::format("this scatter already has its '{}'", keyword));
    }

    bool parse_number(std::optional<Expression>& target, Span span, std::string_view keyword) {
        refuse_twice(target.has_value(), span, keyword);
        std::optional<Expression> value = parse_expression(stream_);
        if (!value) return false;
        target = std::move(value);
        return true;
    }

    bool parse_over(const Token& keyword) {
        refuse_twice(scatter_.over.has_value(), keyword.span, "over");
        std::optional<AreaText> area = parse_area(stream_, "'over'", true);
        if (!area) return false;
        scatter_.over = std::move(area);
        return true;
    }

    bool parse_except() {
        std::optional<AreaText> area = parse_area(stream_, "'except'", false);
        if (!area) return false;
        scatter_.except.push_back(std::move(*area));
        return true;
    }

    bool parse_by(const Token& keyword) {
        refuse_twice(scatter_.by.has_value(), keyword.span, "by");
        const auto order = std::find(orders.begin(), orders.end(), stream_.peek().text);
        if (!stream_.at_name() || order == orders.end()) {
            const Token word = stream_.peek();
            stream_.expected("poisson, uniform, jitter or spiral after 'by'")
                .with_hint(did_you_mean(word.text, {orders.begin(), orders.end()}));
            return false;
        }
        stream_.next();
        scatter_.by = static_cast<ScatterOrder>(order - orders.begin());
        return true;
    }

    /// `turn: y, 0..360`; what is left out is the vertical and the whole turn.
    bool parse_turn(const Token& keyword) {
        const Token axis = stream_.peek();
        const bool named = axis.is("x") || axis.is("y") || axis.is("z");
        bool has_comma = false;
        if (named) {
            stream_.next();
            scatter_.turn_axis = axis.text[0] - 'x';
            has_comma = stream_.accept(",");
        }
        if (!named || has_comma || begins_value()) return parse_range(scatter_.turn, keyword);
        refuse_twice(scatter_.turn.has_value(), keyword.span, "turn");
        scatter_.turn.emplace().span = stream_.span_from(keyword.span);
        scatter_.turn->to.emplace().number = 360;
        return true;
    }

    /// Whether a value follows `turn: y`: another line may follow instead, and a number alone is the count.
    bool begins_value() const {
        const Token& token = stream_.peek();
        if (token.first_on_line) return false;
        if (token.kind == TokenKind::number || token.is("-") || token.is("+") || token.is("(")) return true;
        if (token.kind != TokenKind::name) return false;
        return !at_scatter_line(stream_) && !stream_.peek(1).is(":");
    }

    bool parse_range(std::optional<InstRange>& target, const Token& keyword) {
        refuse_twice(target.has_value(), keyword.span, keyword.text);
        InstRange range;
        std::optional<Expression> from = parse_expression(stream_);
        if (!from) return false;
        range.from = std::move(*from);
        if (stream_.accept("..") && !(range.to = parse_expression(stream_))) return false;
        range.span = stream_.span_from(keyword.span);
        target = std::move(range);
        return true;
    }

    bool parse_weights(const Token& keyword) {
        refuse_twice(!scatter_.weights.empty(), keyword.span, "weights");
        std::optional<std::vector<Expression>> weights = parse_numbers(stream_, 1, most_weights, "'weights'");
        if (!weights) return false;
        scatter_.weights = std::move(*weights);
        scatter_.weights_span = stream_.span_from(keyword.span);
        return true;
    }

    TokenStream& stream_;
    InstScatter& scatter_;
};

} // namespace

const std::vector<std::string_view>& scatter_keywords() {
    static const std::vector<std::string_view> keywords = {"count", "over", "except", "by",   "apart",
                                                           "seed",  "turn", "lean",   "size", "weights"};
    return keywords;
}

bool at_scatter_line(const TokenStream& stream) {
    const Token& token = stream.peek();
    if (token.kind != TokenKind::name) return token.kind == TokenKind::number || token.is("-");
    const std::vector<std::string_view>& keywords = scatter_keywords();
    return std::find(keywords.begin(), keywords.end(), token.text) != keywords.end();
}

bool parse_scatter_line(TokenStream& stream, InstScatter& scatter) {
    return LineParser(stream, scatter).parse();
}

} // namespace graftal
