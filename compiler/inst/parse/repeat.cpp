#include "compiler/inst/parse/repeat.h"

#include <algorithm>
#include <utility>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

/// `( ... ) * {` takes no longer count; `repeat COUNT {` does.
constexpr std::size_t max_count_tokens = 100;

constexpr const char* repeat_hint =
    "write what each copy adds in braces, and the objects after them: repeat 12 { rotate: y, 30 } leaf";

/// The number of tokens of the parentheses at which the stream is.
std::size_t parenthesis_end(const TokenStream& stream) {
    std::size_t depth = 0, at = 0;
    do {
        const Token& token = stream.peek(at++);
        if (token.kind == TokenKind::end) break;
        depth += token.is("(") ? 1 : 0;
        depth -= token.is(")") ? 1 : 0;
    } while (depth > 0 && at < max_count_tokens);
    return at;
}

std::optional<Expression> parse_count(TokenStream& stream) {
    if (stream.accept("repeat")) return parse_expression(stream);
    const std::size_t end = stream.at("(") ? parenthesis_end(stream) : 1;
    std::vector<Token> tokens;
    for (std::size_t i = 0; i < end; ++i)
        tokens.push_back(stream.next());
    const Span span = join(tokens.front().span, tokens.back().span);
    tokens.push_back({.kind = TokenKind::end, .span = {span.file, span.end, span.end}});
    stream.next(); // the '*'
    TokenStream alone(std::move(tokens), stream.diagnostics(), "the count");
    return parse_expression(alone);
}

/// The lines that each copy adds to the copy before. Requires that the '{' was just taken.
bool parse_repeat_block(TokenStream& stream, InstRepeat& repeat) {
    const Token open = stream.previous();
    while (!stream.accept("}")) {
        if (stream.accept(",")) continue;
        if (at_transform(stream)) {
            std::optional<TransformLine> line = parse_transform(stream);
            if (!line) return false;
            repeat.transforms.push_back(std::move(*line));
        } else if (stream.at("tint")) {
            std::optional<InstTint> tint = parse_inst_tint(stream);
            if (!tint) return false;
            if (!tint->until.empty()) return refuse_tint_range(tint->span, stream.diagnostics());
            repeat.tints.push_back(std::move(*tint));
        } else if (at_hue(stream)) {
            if (!parse_hue_value(stream, repeat.hue)) return false;
        } else if (at_ink(stream)) {
            if (!parse_inst_ink(stream, repeat.ink)) return false;
        } else {
            stream.expected("a transform, 'tint', 'hue', 'ink' or '}'")
                .with_hint(repeat_hint)
                .with_note(open.span, "this '{' begins the lines that each copy adds");
            return false;
        }
    }
    return true;
}

/// Skips the rest of a block in error, and its '}': one on the same line, or with objects behind it. Another
/// '}' may be that of the object.
void skip_broken_block(TokenStream& stream) {
    std::size_t depth = 1, at = 0;
    bool same_line = true;
    for (; stream.peek(at).kind != TokenKind::end; ++at) {
        const Token& token = stream.peek(at);
        same_line &= !token.first_on_line;
        depth += token.is("{") ? 1 : 0;
        if (token.is("}") && --depth == 0) break;
    }
    const Token& after = stream.peek(at + 1);
    const bool objects = after.kind == TokenKind::name && !after.first_on_line;
    if (depth == 0 && (same_line || objects)) stream.skip_block();
}

} // namespace

const std::vector<std::string>& body_keywords() {
    static const std::vector<std::string> keywords = [] {
        std::vector<std::string> words(transform_keywords.begin(), transform_keywords.end());
        for (const char* word : {"union", "intersection", "difference", "instance", "terminal", "scatter",
                                 "tint", "material", "chance", "below", "hue", "ink"})
            words.emplace_back(word);
        words.insert(words.end(), scatter_keywords().begin(), scatter_keywords().end());
        return words;
    }();
    return keywords;
}

bool is_body_keyword(const Token& token) {
    return token.kind == TokenKind::name &&
           std::find(body_keywords().begin(), body_keywords().end(), token.text) != body_keywords().end();
}

bool at_repeat(const TokenStream& stream) {
    const Token& token = stream.peek();
    const Token& after = stream.peek(1);
    if (token.is("repeat"))
        return !after.first_on_line && (after.kind == TokenKind::number || after.is("(") || after.is("-") ||
                                        (after.kind == TokenKind::name && !is_body_keyword(after)));
    if (!token.is("(") && token.kind != TokenKind::number && token.kind != TokenKind::name) return false;
    const std::size_t end = token.is("(") ? parenthesis_end(stream) : 1;
    return stream.peek(end).is("*") && stream.peek(end + 1).is("{");
}

std::optional<InstRepeat> parse_inst_repeat(TokenStream& stream) {
    InstRepeat repeat;
    const Token first = stream.peek();
    const std::size_t begin = stream.position();
    std::optional<Expression> count = parse_count(stream);
    if (!count) return std::nullopt;
    if (!stream.accept("{")) {
        stream.expected("'{' after the count").with_hint(repeat_hint);
        return std::nullopt;
    }
    repeat.count = std::move(*count);
    if (!parse_repeat_block(stream, repeat)) {
        skip_broken_block(stream);
        return std::nullopt;
    }
    repeat.span = stream.span_from(first.span);
    repeat.size = static_cast<std::uint32_t>(stream.position() - begin);
    return repeat;
}

std::optional<InstTint> parse_inst_tint(TokenStream& stream) {
    const Token keyword = stream.next();
    stream.accept(":");
    std::optional<std::vector<Expression>> values = parse_tint(stream, "'tint'");
    if (!values) return std::nullopt;
    std::vector<Expression> until;
    if (stream.accept("..")) {
        std::optional<std::vector<Expression>> end = parse_tint(stream, "'tint'");
        if (!end) return std::nullopt;
        until = std::move(*end);
    }
    return InstTint{std::move(*values), std::move(until), stream.span_from(keyword.span)};
}

bool refuse_tint_range(Span span, Diagnostics& diagnostics) {
    diagnostics.error(span, "a range of tints belongs to a scatter")
        .with_hint("open the group with 'scatter:', or give one tint");
    return false;
}

bool at_hue(const TokenStream& stream) {
    const Token& after = stream.peek(1);
    return stream.at("hue") && !after.first_on_line &&
           (after.is(":") || after.is("-") || after.is("(") || after.kind == TokenKind::number);
}

bool parse_hue_value(TokenStream& stream, std::optional<Expression>& hue) {
    const Token keyword = stream.next();
    stream.accept(":");
    std::optional<Expression> shift = parse_expression(stream);
    if (!shift) return false;
    if (hue)
        stream.diagnostics().error(keyword.span, "duplicate 'hue'").with_note(hue->span, "first given here");
    else
        hue = std::move(shift);
    return true;
}

} // namespace graftal
