#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "compiler/inst/parse/repeat.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

constexpr std::array<std::string_view, ink_channels> channel_words = {"hue", "saturation", "value", "alpha"};

/// Takes the words `to`, and for a hue `up to` or `down to`.
InstInkStep::Kind kind_at(TokenStream& stream, InkChannel channel) {
    using Kind = InstInkStep::Kind;
    if (stream.accept("to")) return Kind::toward;
    const bool up = stream.at("up"), down = stream.at("down");
    if (channel != InkChannel::hue || !(up || down) || !stream.peek(1).is("to")) return Kind::change;
    stream.next();
    stream.next();
    return up ? Kind::upward : Kind::downward;
}

/// `hue 10`, `value to 1 by 0.2` or `hue up to 90 by 0.5`.
bool parse_change(TokenStream& stream, std::vector<InstInkStep>& steps) {
    const Token word = stream.peek();
    const auto channel = std::ranges::find(channel_words, word.text);
    if (channel == channel_words.end()) {
        stream.expected("'hue', 'saturation', 'value', 'alpha' or '}'")
            .with_hint("write 'ink { hue 10  value to 1 by 0.2 }', or 'ink: hsv(30, 1, 1)' for a new ink");
        return false;
    }
    stream.next();
    stream.accept(":");
    InstInkStep step;
    step.channel = static_cast<InkChannel>(channel - channel_words.begin());
    step.kind = kind_at(stream, step.channel);
    std::optional<Expression> number = parse_expression(stream);
    if (!number) return false;
    step.values.push_back(std::move(*number));
    if (step.kind != InstInkStep::Kind::change) {
        if (!stream.expect("by", "the target")) return false;
        std::optional<Expression> share = parse_expression(stream);
        if (!share) return false;
        step.values.push_back(std::move(*share));
    }
    step.span = stream.span_from(word.span);
    steps.push_back(std::move(step));
    return true;
}

} // namespace

bool at_ink(const TokenStream& stream) {
    return stream.at("ink") && (stream.peek(1).is(":") || stream.peek(1).is("{"));
}

bool parse_inst_ink(TokenStream& stream, std::vector<InstInkStep>& steps) {
    const Token keyword = stream.next();
    if (stream.accept(":")) {
        std::optional<std::vector<Expression>> colour = parse_color(stream, "'ink'");
        if (!colour) return false;
        steps.push_back({.values = std::move(*colour), .span = stream.span_from(keyword.span)});
        return true;
    }
    stream.next(); // the '{'
    while (!stream.accept("}"))
        if (!stream.accept(",") && !parse_change(stream, steps)) return false;
    return true;
}

} // namespace graftal
