#include "compiler/syntax/transform.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

using LineKind = TransformLine::Kind;

bool is_axis(char c) {
    return c == 'x' || c == 'y' || c == 'z';
}
bool is_axis(std::string_view name) {
    return name.size() == 1 && is_axis(name[0]);
}
bool is_axis_pair(std::string_view name) {
    return name.size() == 2 && is_axis(name[0]) && is_axis(name[1]) && name[0] != name[1];
}

/// The number behind the axes; at a keyword or the end of a block it was left out.
std::optional<Expression> parse_last(TokenStream& stream, std::string_view what, const char* hint) {
    stream.accept(",");
    if (!stream.at("}") && !stream.at(":") && !stream.at_end()) return parse_expression(stream);
    stream.expected(what).with_hint(hint);
    return std::nullopt;
}

/// `x, 30` or `<1, 1, 0>, 30`.
bool parse_rotation(TokenStream& stream, TransformLine& line) {
    if (stream.at_name() && is_axis(stream.peek().text)) {
        line.axes = stream.next().text;
    } else if (stream.at("<")) {
        std::optional<std::vector<Expression>> axis = parse_vector(stream, "the axis of 'rotate'");
        if (!axis) return false;
        line.numbers = std::move(*axis);
    } else {
        stream.expected("an axis after 'rotate'")
            .with_hint(
                "write x, y, z or <x, y, z>, then the degrees: 'rotate: z, 30' turns in the plane of the "
                "picture, 'rotate: y, 30' about the upright axis");
        return false;
    }
    std::optional<Expression> degrees =
        parse_last(stream, "the degrees",
                   "write an axis, then the angle: 'rotate: y, 30'; write several turns as several lines");
    if (!degrees) return false;
    line.numbers.push_back(std::move(*degrees));
    return true;
}

/// `xy, 0.5`.
bool parse_shear(TokenStream& stream, TransformLine& line) {
    if (!stream.at_name() || !is_axis_pair(stream.peek().text)) {
        stream.expected("two axes after 'shear'").with_hint("'shear: xy, 0.5' adds 0.5 y to x");
        return false;
    }
    line.axes = stream.next().text;
    std::optional<Expression> factor = parse_last(stream, "a factor", "'shear: xy, 0.5' adds 0.5 y to x");
    if (!factor) return false;
    line.numbers.push_back(std::move(*factor));
    return true;
}

bool parse_operands(TokenStream& stream, TransformLine& line, std::string_view keyword) {
    if (line.kind == LineKind::rotate) return parse_rotation(stream, line);
    if (line.kind == LineKind::shear) return parse_shear(stream, line);
    const std::size_t min = line.kind == LineKind::scale ? 1 : line.kind == LineKind::translate ? 2 : 12;
    const std::size_t max = std::max<std::size_t>(min, 3);
    const std::string_view hint = min == 12 ? "three rows: m00, m01, m02, tx, and so on" : "";
    std::optional<std::vector<Expression>> numbers =
        parse_numbers(stream, min, max, fmt::format("'{}'", keyword), hint);
    if (!numbers) return false;
    line.numbers = std::move(*numbers);
    return true;
}

} // namespace

bool at_transform(const TokenStream& stream) {
    return stream.at_name() && std::find(transform_keywords.begin(), transform_keywords.end(),
                                         stream.peek().text) != transform_keywords.end();
}

std::optional<TransformLine> parse_transform(TokenStream& stream) {
    const Token keyword = stream.next();
    const auto place = std::find(transform_keywords.begin(), transform_keywords.end(), keyword.text);
    TransformLine line;
    line.kind = static_cast<LineKind>(place - transform_keywords.begin());
    stream.accept(":");
    if (!parse_operands(stream, line, keyword.text)) return std::nullopt;
    line.span = stream.span_from(keyword.span);
    return line;
}

} // namespace graftal
