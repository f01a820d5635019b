#include "compiler/rifs/tables.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/rifs/parts.h"
#include "compiler/support/affine.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

struct CodeColumns {
    RifsForm form;
    std::string_view keyword;
    std::size_t count; ///< without the probability
    std::string_view names;
};

constexpr CodeColumns codes_2d = {RifsForm::codes_2d, "2d", 6, "a b c d e f [p]"};
constexpr CodeColumns codes_polar = {RifsForm::codes_polar, "polar", 6, "r q theta phi e f [p]"};
/// Columns for three control points in the plane; the four of space make 16.
constexpr CodeColumns codes_barycentric = {RifsForm::codes_barycentric, "barycentric", 9,
                                           "the weights of the control points in the image of each, [p]"};
constexpr std::size_t weights_in_space = 16;
constexpr CodeColumns codes_3d = {RifsForm::codes_3d, "3d", 12, "a b c d e f g h i tx ty tz [p]"};

/// `2d` is a number and a name to the lexer.
const CodeColumns* parse_code_form(TokenStream& stream) {
    if (stream.accept("polar")) return &codes_polar;
    if (stream.accept("barycentric")) return &codes_barycentric;
    const Token digit = stream.peek();
    const Token letter = stream.peek(1);
    const bool dimension = letter.is("d") || letter.is("D");
    if (digit.kind == TokenKind::number && dimension && !letter.space_before &&
        (digit.text == "2" || digit.text == "3")) {
        stream.next();
        stream.next();
        return digit.text == "2" ? &codes_2d : &codes_3d;
    }
    stream.expected("'2d', 'polar', '3d' or 'barycentric' after 'codes'");
    return nullptr;
}

bool at_row_end(const TokenStream& stream) {
    return stream.at_end() || stream.at("}") || stream.peek().first_on_line;
}

/// The numbers of a row, whose first token the stream is at.
bool parse_row_numbers(TokenStream& stream, const CodeColumns& columns, RifsMap& map) {
    std::size_t count = 0;
    const std::size_t most = columns.form == RifsForm::codes_barycentric ? weights_in_space : columns.count;
    const Token first = stream.peek();
    const bool bracket = first.is("[") || first.is("(");
    if (bracket && (first.is("[") || stream.peek(2).kind == TokenKind::number)) {
        stream.expected("a number").with_hint("write the numbers of a row without brackets");
        return false;
    }
    for (bool begins = true; begins || (!at_row_end(stream) && !at_rifs_look(stream)); begins = false) {
        std::optional<Expression> number = parse_row_expression(stream);
        if (!number) return false;
        if (count++ <= most) map.codes.push_back(std::move(*number));
        stream.accept(",");
    }
    for (const std::size_t whole : {columns.count, most}) {
        if (count == whole) return true;
        if (count != whole + 1) continue;
        map.probability = std::move(map.codes.back());
        map.codes.pop_back();
        return true;
    }
    stream.diagnostics().error(
        stream.span_from(first.span),
        fmt::format("a row of 'codes {}' takes {} or {}{} numbers ({}), not {}", columns.keyword,
                    columns.count, columns.count + 1,
                    most == columns.count ? "" : fmt::format(", in space {} or {},", most, most + 1),
                    columns.names, count));
    return false;
}

/// `[label:] numbers [tint ...] [material ...]`.
bool parse_row(TokenStream& stream, const CodeColumns& columns, RifsMap& map) {
    if (!map.name.text.empty() && at_row_end(stream)) {
        stream.expected(fmt::format("the numbers of '{}'", map.name.text));
        return false;
    }
    if (!parse_row_numbers(stream, columns, map)) return false;
    while (!at_row_end(stream)) {
        if (!at_rifs_look(stream)) {
            stream.expected("'tint', 'material' or the end of the row");
            return false;
        }
        if (!parse_rifs_look(stream, map.look)) return false;
    }
    return true;
}

/// A row, good or broken; takes at least one token.
RifsMap parse_code_row(TokenStream& stream, const CodeColumns& columns, bool label) {
    const Token first = stream.peek();
    const std::size_t before = stream.position();
    RifsMap map;
    map.form = columns.form;
    map.name.span = first.span;
    if (label) {
        map.name.text = stream.next().text;
        stream.next();
    }
    map.broken = !parse_row(stream, columns, map);
    if (map.broken) {
        if (stream.position() == before && stream.next().is("{")) stream.skip_block();
        stream.skip_line();
    }
    map.span = stream.span_from(first.span);
    if (!label) map.name.span = map.span;
    return map;
}

/// `a -> b, c`; a name after a comma that an arrow follows begins the next edges.
bool parse_edges_from(TokenStream& stream, RifsFollow& follow) {
    const std::optional<Name> from = parse_rifs_name(stream, "the name of a map");
    if (!from) return false;
    if (!stream.accept("->")) {
        stream.expected(fmt::format("'->' after '{}'", from->text))
            .with_hint(fmt::format("'{} -> b, c' lets the maps b and c follow {}", from->text, from->text));
        return false;
    }
    do {
        const std::optional<Name> to = parse_rifs_name(stream, "the name of a map after '->'");
        if (!to) return false;
        if (follow.edges.size() == max_rifs_edges) {
            stream.diagnostics().error(to->span, fmt::format("more than {} edges", max_rifs_edges));
            return false;
        }
        follow.edges.push_back({*from, *to});
    } while (stream.accept(",") && !stream.peek(1).is("->"));
    return true;
}

/// `{ edges }`, or edges to the end of the line.
bool parse_edges(TokenStream& stream, RifsFollow& follow) {
    const Token open = stream.peek();
    if (!stream.accept("{")) {
        do {
            if (!parse_edges_from(stream, follow)) return false;
        } while (stream.at_name() && !stream.peek().first_on_line && stream.peek(1).is("->"));
        return true;
    }
    while (!stream.accept("}")) {
        if (stream.at_end()) {
            stream.expected("'}' at the end of 'follow'").with_note(open.span, "to close this '{'");
            return false;
        }
        if (!parse_edges_from(stream, follow)) {
            stream.skip_block();
            return true; // reported, and the stream stands after the block
        }
    }
    return true;
}

bool parse_cell(TokenStream& stream, RifsFollow& follow) {
    RifsMatrixRow& row = follow.rows.back();
    std::optional<Expression> value = parse_row_expression(stream);
    if (!value) return false;
    const bool literal = value->kind == Expression::Kind::number;
    RifsCell cell;
    cell.row = static_cast<std::uint32_t>(follow.rows.size() - 1);
    cell.column = row.columns++;
    cell.span = value->span;
    if (literal && value->number == 0) return true;
    if (follow.cells.size() == max_rifs_edges) {
        stream.diagnostics().error(cell.span,
                                   fmt::format("more than {} entries that are not 0", max_rifs_edges));
        return false;
    }
    if (literal) {
        cell.number = value->number;
    } else {
        cell.expression = static_cast<std::uint32_t>(follow.expressions.size());
        follow.expressions.push_back(std::move(*value));
    }
    follow.cells.push_back(cell);
    return true;
}

bool parse_matrix(TokenStream& stream, RifsFollow& follow) {
    const Token open = stream.peek();
    if (!stream.expect("{", "matrix")) return false;
    for (bool new_row = true; !stream.accept("}"); new_row = stream.peek().first_on_line) {
        if (stream.at_end()) {
            stream.expected("'}' at the end of 'follow matrix'").with_note(open.span, "to close this '{'");
            return false;
        }
        if (new_row) follow.rows.push_back({0, stream.peek().span});
        if (!parse_cell(stream, follow)) {
            stream.skip_block();
            return true; // as above
        }
        stream.accept(",");
        follow.rows.back().span = stream.span_from(follow.rows.back().span);
    }
    return true;
}

bool parse_all(TokenStream& stream, RifsFollow& follow) {
    if (!stream.at("except") && stream.at_name() && !stream.peek().first_on_line && !at_rifs_item(stream)) {
        stream.expected("'except' or the end of the line after 'all'")
            .with_hint("'follow all except self', or edges: 'follow all except a -> b, c'");
        while (!stream.at_end() && !stream.at("}") && !stream.peek().first_on_line)
            stream.next();
        return false;
    }
    if (!stream.accept("except")) return true;
    follow.kind = RifsFollow::Kind::all_except_self;
    if (stream.accept("self")) return true;
    follow.kind = RifsFollow::Kind::all_except;
    if (stream.at("{") || stream.at_name()) return parse_edges(stream, follow);
    stream.expected("'self' or edges after 'all except'");
    return false;
}

/// The number of an expression that is one, with a sign or none.
std::optional<double> literal(const Expression& expression) {
    if (expression.kind == Expression::Kind::number) return expression.number;
    if (expression.kind != Expression::Kind::unary || expression.text != "-") return std::nullopt;
    const std::optional<double> value = literal(expression.operands.front());
    return value ? std::optional(-*value) : std::nullopt;
}

/// Where a row of literal numbers maps everything to; nothing if it leaves more than a point.
std::optional<Vec3> point_of(const RifsMap& row) {
    if (row.broken || row.form == RifsForm::transforms || row.form == RifsForm::codes_barycentric)
        return std::nullopt;
    std::vector<double> numbers;
    for (const Expression& code : row.codes) {
        const std::optional<double> number = literal(code);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    const std::size_t shift = row.form == RifsForm::codes_3d ? 9 : 4;
    const std::size_t linear = row.form == RifsForm::codes_polar ? 2 : shift; // the others are angles
    for (std::size_t i = 0; i < linear; ++i)
        if (numbers[i] != 0) return std::nullopt;
    return Vec3(numbers[shift], numbers[shift + 1], row.form == RifsForm::codes_3d ? numbers[shift + 2] : 0);
}

constexpr const char* control_hint = "three points of the plane or four of space: "
                                     "'control <0, 0>, <1, 0>, <1/2, 1>'";

/// A row of barycentric weights gets the points that they are of.
void add_control(RifsMap& map, const RifsBlock& block, Diagnostics& diagnostics) {
    if (map.form != RifsForm::codes_barycentric || map.broken) return;
    const std::size_t coordinates = map.codes.size() == weights_in_space ? 12 : 6;
    map.broken = block.control.size() != coordinates;
    if (!map.broken) {
        map.codes.insert(map.codes.end(), block.control.begin(), block.control.end());
    } else if (block.control.empty()) {
        diagnostics
            .error(map.span, fmt::format("'rifs {}' has no control points for this row", block.name.text))
            .with_hint(control_hint);
    } else {
        diagnostics
            .error(map.span, fmt::format("this row has {} weights, which the control points do not take",
                                         map.codes.size()))
            .with_note(block.control_span, "the control points are here")
            .with_hint("9 weights a row for three points, 16 for four");
    }
}

Expression number_at(double value, Span span) {
    Expression number;
    number.number = value;
    number.span = span;
    return number;
}

/// A ball that is small beside its distance from the origin.
RifsPart speck(const RifsMap& row, Vec3 at) {
    RifsPart part;
    part.master = {"sphere", row.span};
    const double size = 1e-3 * std::max(1e-3, largest_entry(at));
    part.transforms = {{TransformLine::Kind::scale, {number_at(size, row.span)}, {}, row.span},
                       {TransformLine::Kind::translate,
                        {number_at(at.x, row.span), number_at(at.y, row.span), number_at(at.z, row.span)},
                        {},
                        row.span}};
    part.look = row.look;
    part.probability = row.probability;
    part.span = row.span;
    return part;
}

} // namespace

bool parse_rifs_control(TokenStream& stream, RifsBlock& block) {
    const Token keyword = stream.next();
    stream.accept(":");
    if (!block.control.empty()) {
        stream.diagnostics()
            .error(keyword.span, "duplicate 'control'")
            .with_note(block.control_span, "first given here");
        return false;
    }
    std::size_t dimensions = 0;
    const std::size_t count = parse_points(stream, block.control, dimensions, control_hint);
    block.control_span = stream.span_from(keyword.span);
    if (count == 0) return false;
    if (count == dimensions + 1) return true;
    stream.diagnostics()
        .error(block.control_span, fmt::format("{} control points with {} coordinates", count, dimensions))
        .with_hint(control_hint);
    return false;
}

void settle_rifs_rows(RifsBlock& block, Diagnostics& diagnostics) {
    std::uint32_t number = 0;
    for (RifsMap& map : block.maps) {
        map.number = ++number;
        add_control(map, block, diagnostics);
    }
    if (block.follow || !block.start.empty()) return;
    const auto is_point = [](const RifsMap& map) { return point_of(map).has_value(); };
    if (std::ranges::all_of(block.maps, is_point)) return;
    for (const RifsMap& map : block.maps) {
        const std::optional<Vec3> at = point_of(map);
        if (!at) continue;
        diagnostics.warning(map.span, "this row maps everything to one point; a small ball stands for it");
        block.condense.push_back(speck(map, *at));
    }
    std::erase_if(block.maps, is_point);
}

bool parse_rifs_codes(TokenStream& stream, std::vector<RifsMap>& maps, std::size_t& map_room) {
    stream.next();
    const CodeColumns* columns = parse_code_form(stream);
    const Token open = stream.peek();
    if (!columns) {
        while (!stream.at_end() && !stream.at("{") && !stream.peek().first_on_line)
            stream.next();
        if (stream.accept("{")) stream.skip_block();
        return false;
    }
    if (!stream.accept("{")) {
        stream.expected(fmt::format("'{{' after 'codes {}'", columns->keyword));
        while (!stream.at_end() && !stream.at("}") && !at_rifs_item(stream))
            stream.next(); // its rows
        return false;
    }
    while (!stream.accept("}")) {
        const bool label = stream.at_name() && stream.peek(1).is(":");
        if (stream.at_end() || (at_rifs_item(stream) && !label)) {
            stream.expected("'}' at the end of 'codes'").with_note(open.span, "to close this '{'");
            return true; // the stream stands at the next item already
        }
        if (stream.diagnostics().full() || !take_rifs_map(stream, map_room)) {
            stream.skip_block();
            return true;
        }
        maps.push_back(parse_code_row(stream, *columns, label));
    }
    return true;
}

std::optional<RifsFollow> parse_rifs_follow(TokenStream& stream) {
    const Token keyword = stream.next();
    RifsFollow follow;
    stream.accept(":");
    bool good = false;
    if (stream.at("all") && !stream.peek(1).is("->")) {
        stream.next();
        good = parse_all(stream, follow);
    } else if (stream.at("matrix") && !stream.peek(1).is("->")) {
        stream.next();
        follow.kind = RifsFollow::Kind::matrix;
        good = parse_matrix(stream, follow);
    } else if (stream.at("{") || stream.at_name()) {
        follow.kind = RifsFollow::Kind::edges;
        good = parse_edges(stream, follow);
    } else {
        stream.expected("'all', 'matrix' or edges after 'follow'");
    }
    follow.span = stream.span_from(keyword.span);
    if (!good) return std::nullopt;
    return follow;
}

} // namespace graftal
