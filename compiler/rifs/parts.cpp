#include "compiler/rifs/parts.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

bool parse_below(TokenStream& stream, std::optional<Expression>& below) {
    const Token keyword = stream.next();
    stream.accept(":");
    if (below) {
        stream.diagnostics()
            .error(keyword.span, "duplicate 'below'")
            .with_note(below->span, "first given here");
        return false;
    }
    below = parse_row_expression(stream);
    return below.has_value();
}

} // namespace

bool at_rifs_item(const TokenStream& stream) {
    return stream.at_name() && std::find(rifs_item_words.begin(), rifs_item_words.end(),
                                         stream.peek().text) != rifs_item_words.end();
}

bool take_rifs_map(TokenStream& stream, std::size_t& map_room) {
    if (map_room > 0) return --map_room, true;
    stream.diagnostics().error(stream.peek().span, fmt::format("more than {} maps", max_rifs_maps));
    return false;
}

std::optional<Name> parse_rifs_name(TokenStream& stream, std::string_view what) {
    if (stream.peek().first_on_line && at_rifs_item(stream) && !stream.peek(1).is("->")) {
        stream.expected(what);
        return std::nullopt;
    }
    return parse_name(stream, what);
}

bool at_rifs_look(const TokenStream& stream) {
    return stream.at("tint") || stream.at("material");
}

bool parse_rifs_look(TokenStream& stream, RifsLook& look) {
    const Token keyword = stream.next();
    const bool is_tint = keyword.is("tint");
    stream.accept(":");
    if (is_tint ? !look.tint.empty() : look.material.has_value()) {
        stream.diagnostics()
            .error(keyword.span, fmt::format("duplicate '{}'", keyword.text))
            .with_note(is_tint ? look.tint.front().span : look.material->span, "first given here");
        return false;
    }
    if (!is_tint) {
        look.material = parse_rifs_name(stream, "a name after 'material'");
        return look.material.has_value();
    }
    std::optional<std::vector<Expression>> tint = parse_tint(stream, "'tint'");
    if (tint) look.tint = std::move(*tint);
    return tint.has_value();
}

std::optional<RifsPart> parse_rifs_part(TokenStream& stream) {
    const Token keyword = stream.next();
    stream.accept(":");
    const std::optional<Name> master =
        parse_rifs_name(stream, fmt::format("a primitive or a used model after '{}'", keyword.text));
    if (!master) return std::nullopt;
    RifsPart part;
    part.master = *master;
    if (stream.accept("(") && !parse_arguments(stream, part.arguments)) return std::nullopt;
    const auto at_below = [&] { return keyword.is("terminal") && stream.at("below"); };
    while (at_transform(stream) || at_rifs_look(stream) || at_below()) {
        if (at_below()) {
            if (!parse_below(stream, part.below)) return std::nullopt;
            continue;
        }
        if (at_rifs_look(stream)) {
            if (!parse_rifs_look(stream, part.look)) return std::nullopt;
            continue;
        }
        std::optional<TransformLine> line = parse_transform(stream);
        if (!line) return std::nullopt;
        part.transforms.push_back(std::move(*line));
    }
    part.span = stream.span_from(keyword.span);
    return part;
}

} // namespace graftal
