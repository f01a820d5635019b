#include "compiler/syntax/area.h"

#include <string>
#include <utility>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

/// `r`, `r, x, z` or `r x z`. The second of two numbers in a row is the count of the scatter: `disc 5 200`.
std::optional<std::vector<Expression>> parse_disc(TokenStream& stream) {
    const std::size_t begin = stream.position();
    const bool brackets = stream.at("<");
    std::optional<std::vector<Expression>> numbers = parse_numbers(stream, 1, 3, "'disc'");
    if (!numbers || numbers->size() != 2 || brackets) return numbers;
    const std::size_t end = stream.position();
    stream.go_back(begin);
    std::optional<Expression> radius = parse_row_expression(stream);
    if (!radius) return std::nullopt;
    if (stream.at(",")) { // written with commas, it is a mistake
        stream.go_back(end);
        return numbers;
    }
    std::vector<Expression> only;
    only.push_back(std::move(*radius));
    return only;
}

} // namespace

std::optional<AreaText> parse_area(TokenStream& stream, std::string_view what, bool may_be_ground) {
    AreaText area;
    const Token first = stream.peek();
    if (may_be_ground && stream.accept("ground")) {
        area.kind = AreaText::Kind::ground;
        area.span = first.span;
        return area;
    }
    std::optional<std::vector<Expression>> numbers;
    const Token& after = stream.peek(1);
    if (stream.at_name() && (after.kind == TokenKind::number || after.is(":")) && !stream.at("disc")) {
        const std::vector<std::string> shapes = {"disc", "ground"};
        const std::string meant = closest_name(stream.peek().text, shapes);
        if (!meant.empty()) {
            stream.expected("four numbers, 'disc' or 'ground'")
                .with_hint(did_you_mean(stream.peek().text, shapes));
            return std::nullopt;
        }
    }
    if (stream.accept("disc")) {
        area.kind = AreaText::Kind::disc;
        stream.accept(":");
        numbers = parse_disc(stream);
        if (numbers && numbers->size() == 2) {
            stream.diagnostics()
                .error(stream.span_from(first.span), "'disc' takes a radius, or a radius and its centre")
                .with_hint("write 'disc r' or 'disc r, x, z'");
            return std::nullopt;
        }
    } else {
        numbers = parse_numbers(stream, 4, 4, what, "x0, z0, x1, z1 of a rectangle; or write 'disc r'");
    }
    if (!numbers) return std::nullopt;
    area.numbers = std::move(*numbers);
    area.span = stream.span_from(first.span);
    return area;
}

} // namespace graftal
