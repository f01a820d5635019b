#include "compiler/syntax/transform.h"

#include <algorithm>
#include <iterator>
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

constexpr const char* points_hint =
    "two or three points of the plane, or four of space, each with its image: "
    "'points <0, 0>, <1, 0> -> <0, 0>, <1/2, 1/2>'";

/// `<0, 0>, <1, 0> -> <0, 0>, <1/2, 1/2>`.
bool parse_point_pairs(TokenStream& stream, TransformLine& line) {
    const Token first = stream.peek();
    std::size_t dimensions = 0;
    const std::size_t points = parse_points(stream, line.numbers, dimensions, points_hint);
    if (points == 0) return false;
    if (!stream.accept("->")) {
        stream.expected("'->' and the images of the points").with_hint(points_hint);
        return false;
    }
    const std::size_t images = parse_points(stream, line.numbers, dimensions, points_hint);
    if (images == 0) return false;
    const bool counts = dimensions == 2 ? points == 2 || points == 3 : points == 4;
    if (counts && images == points) return true;
    stream.diagnostics()
        .error(stream.span_from(first.span),
               counts ? fmt::format("{} points have {} images", points, images)
                      : fmt::format("{} points with {} coordinates make no map", points, dimensions))
        .with_hint(points_hint);
    return false;
}

bool parse_operands(TokenStream& stream, TransformLine& line, std::string_view keyword) {
    if (line.kind == LineKind::rotate) return parse_rotation(stream, line);
    if (line.kind == LineKind::shear) return parse_shear(stream, line);
    if (line.kind == LineKind::points) return parse_point_pairs(stream, line);
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

std::size_t parse_points(TokenStream& stream, std::vector<Expression>& numbers, std::size_t& dimensions,
                         const char* hint) {
    std::size_t count = 0;
    do {
        const Token open = stream.peek();
        if (!open.is("<")) {
            stream.expected("a point, which begins with '<'").with_hint(hint);
            return 0;
        }
        std::optional<std::vector<Expression>> point = parse_numbers(stream, 2, 3, "a point");
        if (!point) return 0;
        if (dimensions > 0 && point->size() != dimensions) {
            stream.diagnostics()
                .error(stream.span_from(open.span),
                       fmt::format("this point has {} coordinates, the first one has {}", point->size(),
                                   dimensions))
                .with_hint(hint);
            return 0;
        }
        dimensions = point->size();
        std::ranges::move(*point, std::back_inserter(numbers));
        ++count;
    } while (stream.accept(","));
    return count;
}

std::size_t point_dimensions(std::size_t numbers) {
    return numbers == 24 ? 3 : 2;
}

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
