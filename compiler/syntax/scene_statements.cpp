#include "compiler/syntax/scene_statements.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/syntax/area.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

using Kind = SceneStatement::Kind;

enum class Shape { flag, number, pair, vector, color, name, text, area };

struct FieldRule {
    std::string_view keyword;
    Shape shape;
};

/// The fields of a statement in braces; empty for the others.
const std::vector<FieldRule>& rules(Kind kind) {
    static const std::vector<FieldRule> camera = {
        {"location", Shape::vector}, {"look_at", Shape::vector},    {"up", Shape::vector},
        {"angle", Shape::number},    {"orthographic", Shape::flag}, {"width", Shape::number},
        {"height", Shape::number},   {"aperture", Shape::number},   {"focus", Shape::vector},
        {"direction", Shape::vector}};
    static const std::vector<FieldRule> haze = {{"distance", Shape::number},
                                                {"color", Shape::color},
                                                {"base", Shape::number},
                                                {"height", Shape::number},
                                                {"sun", Shape::number}};
    static const std::vector<FieldRule> light = {
        {"location", Shape::vector},    {"sun", Shape::vector},        {"color", Shape::color},
        {"temperature", Shape::number}, {"brightness", Shape::number}, {"angle", Shape::number},
        {"shadowless", Shape::flag},    {"size", Shape::pair},         {"radius", Shape::number},
        {"look_at", Shape::vector}};
    static const std::vector<FieldRule> sky = {
        {"zenith", Shape::color}, {"horizon", Shape::color},     {"below", Shape::color},
        {"clear", Shape::number}, {"clouds", Shape::number},     {"environment", Shape::text},
        {"turn", Shape::number},  {"brightness", Shape::number}, {"bounces", Shape::number}};
    static const std::vector<FieldRule> film = {
        {"exposure", Shape::number}, {"white", Shape::number}, {"soft", Shape::flag}, {"hard", Shape::flag}};
    static const std::vector<FieldRule> background = {{"zenith", Shape::color}, {"horizon", Shape::color}};
    static const std::vector<FieldRule> ground = {
        {"height", Shape::number}, {"color", Shape::color}, {"material", Shape::name}, {"area", Shape::area}};
    static const std::vector<FieldRule> material = {
        {"color", Shape::color},         {"ambient", Shape::number},    {"diffuse", Shape::number},
        {"specular", Shape::number},     {"roughness", Shape::number},  {"reflection", Shape::number},
        {"translucency", Shape::number}, {"emission", Shape::number},   {"texture", Shape::text},
        {"around", Shape::number},       {"metallic", Shape::number},   {"transparency", Shape::number},
        {"ior", Shape::number},          {"absorption", Shape::number}, {"from", Shape::name},
        {"blur", Shape::number},         {"filter", Shape::number},     {"pattern", Shape::name},
        {"scale", Shape::number},        {"octaves", Shape::number},    {"stretch", Shape::vector},
        {"warp", Shape::number},         {"space", Shape::name},        {"plus", Shape::name},
        {"share", Shape::number},        {"low", Shape::color},         {"high", Shape::color},
        {"bump", Shape::number}};
    static const std::vector<FieldRule> none;
    switch (kind) {
    case Kind::camera:
        return camera;
    case Kind::light:
        return light;
    case Kind::background:
        return background;
    case Kind::ground:
        return ground;
    case Kind::material:
        return material;
    case Kind::sky:
        return sky;
    case Kind::film:
        return film;
    case Kind::haze:
        return haze;
    default:
        return none;
    }
}

bool is_layer_field(std::string_view keyword) {
    static constexpr std::string_view words[] = {"plus", "scale", "octaves", "stretch",
                                                 "warp", "space", "share"};
    return std::ranges::find(words, keyword) != std::end(words);
}

bool belongs_to_pattern(std::string_view keyword) {
    return is_layer_field(keyword) || keyword == "low" || keyword == "high" || keyword == "bump";
}

std::optional<Kind> kind_of(const Token& token) {
    const std::vector<std::string>& keywords = scene_keywords();
    const auto found = std::find(keywords.begin(), keywords.end(), token.text);
    if (token.kind != TokenKind::name || found == keywords.end()) return std::nullopt;
    return static_cast<Kind>(found - keywords.begin());
}

class StatementParser {
  public:
    StatementParser(TokenStream& stream, SceneStatement& statement)
        : stream_(stream), statement_(statement) {}

    bool parse() {
        const Token keyword = stream_.next();
        statement_.span = keyword.span;
        switch (statement_.kind) {
        case Kind::let:
        case Kind::inner:
            return parse_lets(keyword.text);
        case Kind::steps:
            stream_.accept(":");
            return parse_value("steps", keyword.span, Shape::number, "steps");
        case Kind::material:
            return parse_name(keyword) && parse_block(keyword);
        case Kind::preset:
            return parse_name(keyword) && parse_preset();
        case Kind::background:
            stream_.accept(":");
            if (!stream_.at("{")) return parse_value("zenith", keyword.span, Shape::color, "background");
            return parse_block(keyword);
        default:
            return parse_block(keyword);
        }
    }

  private:
    bool parse_name(const Token& keyword) {
        const std::optional<Token> name = stream_.expect_name(fmt::format("a name after '{}'", keyword.text));
        if (!name) return false;
        statement_.name = name->text;
        statement_.span = name->span;
        return true;
    }

    bool parse_lets(std::string_view keyword) {
        do {
            const std::optional<Token> name = stream_.expect_name(fmt::format("a name after '{}'", keyword));
            if (!name) return false;
            if (!stream_.expect("=", name->text) ||
                !parse_value(name->text, name->span, Shape::number, name->text) || !parse_members()) {
                add_placeholder(*name);
                statement_.complete = false;
                while (!stream_.at_end() && !stream_.peek().first_on_line && !stream_.at(","))
                    stream_.next();
            }
        } while (stream_.accept(","));
        return true;
    }

    /// `{ angle = 30, ratio = 0.7 }`.
    bool parse_preset() {
        const Token open = stream_.peek();
        if (!stream_.expect("{", statement_.name)) return false;
        while (!stream_.accept("}")) {
            if (stream_.accept(",")) continue;
            if (stream_.at_end() || (stream_.peek().first_on_line && begins_other_statement())) {
                stream_.expected(fmt::format("'}}' at the end of 'preset {}'", statement_.name))
                    .with_note(open.span, "to close this '{'");
                return false;
            }
            const std::optional<Token> name = stream_.expect_name("a name to set or '}'");
            if (name && (stream_.accept(":") || stream_.expect("=", name->text)) &&
                parse_value(name->text, name->span, Shape::number, name->text))
                continue;
            statement_.complete = false;
            stream_.skip_block();
            return true;
        }
        return true;
    }

    /// `members N` after the value of an inner parameter.
    bool parse_members() {
        if (statement_.kind != Kind::inner || !stream_.accept("members")) return true;
        std::optional<std::vector<Expression>> members = parse_numbers(stream_, 1, 1, "'members'");
        if (members) statement_.fields.back().values.push_back(std::move(members->front()));
        return members.has_value();
    }

    void add_placeholder(const Token& name) {
        if (!statement_.fields.empty() && statement_.fields.back().span.begin == name.span.begin) return;
        SceneField field;
        field.keyword = name.text;
        field.span = name.span;
        field.values.emplace_back();
        field.values.back().number = 1;
        statement_.fields.push_back(std::move(field));
    }

    bool parse_block(const Token& keyword) {
        const std::string_view after = stream_.previous().text;
        stream_.accept(":");
        const Token open = stream_.peek();
        if (!stream_.at("{")) {
            stream_.expected(fmt::format("'{{' after '{}'", after)).with_hint(example());
            return false;
        }
        stream_.next();
        while (!stream_.accept("}")) {
            if (stream_.at_end() || (stream_.peek().first_on_line && begins_other_statement())) {
                stream_.expected(fmt::format("'}}' at the end of '{}'", keyword.text))
                    .with_note(open.span, "to close this '{'");
                return true; // the stream stands at the next statement already
            }
            if (stream_.accept(",")) continue;
            if (!parse_field(keyword.text)) {
                statement_.complete = false;
                skip_value();
            }
        }
        return true;
    }

    /// The statement with some of its fields.
    const char* example() const {
        switch (statement_.kind) {
        case Kind::camera:
            return "camera { location: 3, 2, 5  look_at: 0, 0, 0 }";
        case Kind::light:
            return "light { sun: 1, 2, 3 } or light { location: 10, 20, 30 }";
        case Kind::sky:
            return "sky { zenith: 0.3, 0.5, 0.9  horizon: 0.9, 0.9, 1 } or sky { clear: 3 }";
        case Kind::haze:
            return "haze { distance: 300  color: 0.7, 0.8, 0.9 }";
        case Kind::film:
            return "film { exposure: 1.2 }";
        case Kind::preset:
            return "preset oak { angle = 30  ratio = 0.7 }";
        case Kind::ground:
            return "ground { height: 0  color: 0.3, 0.3, 0.25 }";
        default:
            return "material stone { color: 0.5, 0.5, 0.5 }";
        }
    }

    /// `ground { material: stone` goes on, `ground {` and then `material stone {` does not.
    bool begins_other_statement() const {
        const Token& word = stream_.peek();
        if (stream_.is_statement_word(word)) return true;
        return at_scene_statement(stream_) && !is_field(word.text);
    }

    bool is_field(std::string_view word) const {
        if (word == "material" && stream_.peek(2).is("{")) return false;
        const std::vector<FieldRule>& known = rules(statement_.kind);
        return std::any_of(known.begin(), known.end(),
                           [&](const FieldRule& rule) { return rule.keyword == word; });
    }

    bool parse_field(std::string_view statement) {
        const std::vector<FieldRule>& known = rules(statement_.kind);
        const Token keyword = stream_.peek();
        for (const FieldRule& rule : known)
            if (keyword.is(rule.keyword)) {
                if (defines_material()) return false;
                stream_.next();
                stream_.accept(":");
                return parse_value(keyword.text, keyword.span, rule.shape, keyword.text);
            }
        return report_unknown(statement);
    }

    bool report_unknown(std::string_view statement) {
        const Token word = stream_.peek();
        std::vector<std::string> candidates;
        const bool patterned =
            std::ranges::find(statement_.fields, "pattern", &SceneField::keyword) != statement_.fields.end();
        for (const FieldRule& rule : rules(statement_.kind))
            if (patterned || !belongs_to_pattern(rule.keyword)) candidates.emplace_back(rule.keyword);
        if (word.kind != TokenKind::name) {
            Diagnostic& error = stream_.expected(fmt::format("a field of '{}' or '}}'", statement));
            error.with_hint(choices("", candidates));
        } else {
            stream_.diagnostics()
                .error(word.span, fmt::format("'{}' has no field '{}'", statement, word.text))
                .with_hint(choices(word.text, candidates));
        }
        if (stream_.next().is("{")) stream_.skip_block();
        skip_value();
        return false;
    }

    /// The value of an unknown field, so that the fields behind it on its line are read.
    void skip_value() {
        while (!stream_.at_end() && !stream_.at("}") && !stream_.peek().first_on_line &&
               !is_field(stream_.peek().text))
            if (stream_.next().is("{")) stream_.skip_block();
    }

    /// `ground { material stone { ... } }`. Reported and skipped.
    bool defines_material() {
        if (!stream_.at("material") || !stream_.peek(2).is("{")) return false;
        stream_.diagnostics()
            .error(stream_.peek().span, "define materials outside of other statements")
            .with_hint(fmt::format("here, write the material's name: 'material: {}'", stream_.peek(1).text));
        for (int i = 0; i < 3; ++i)
            stream_.next();
        stream_.skip_block();
        return true;
    }

    /// `written`: what the text has in place of the keyword.
    bool parse_value(std::string_view keyword, Span span, Shape shape, std::string_view written) {
        SceneField field;
        if (keyword == "plus" && statement_.kind == Kind::material) ++layer_;
        field.keyword = layer_ > 0 && is_layer_field(keyword) ? layer_field(keyword, layer_) : keyword;
        field.span = span;
        const std::string what = fmt::format("'{}'", written);
        std::optional<std::vector<Expression>> values(std::in_place);
        switch (shape) {
        case Shape::flag:
            break;
        case Shape::number:
            values = parse_numbers(stream_, 1, 1, what);
            break;
        case Shape::pair:
            values = parse_numbers(stream_, 2, 2, what);
            break;
        case Shape::vector:
            values = parse_vector(stream_, what);
            break;
        case Shape::color:
            values = parse_color(stream_, what);
            break;
        case Shape::name: {
            const std::optional<Token> name = stream_.expect_name("a name after " + what);
            if (!name) return false;
            field.name = name->text;
            field.name_span = name->span;
            break;
        }
        case Shape::text: {
            const std::optional<Token> text = stream_.expect_string("a file name in quotes after " + what);
            if (!text) return false;
            field.name = text->text;
            field.name_span = text->span;
            break;
        }
        case Shape::area: {
            std::optional<AreaText> area = parse_area(stream_, what, false);
            if (!area) return false;
            if (area->kind == AreaText::Kind::disc) field.name = "disc";
            values = std::move(area->numbers);
            break;
        }
        }
        if (!values) return false;
        field.values = std::move(*values);
        statement_.fields.push_back(std::move(field));
        return true;
    }

    TokenStream& stream_;
    SceneStatement& statement_;
    std::size_t layer_ = 0; ///< of a material's pattern
};

} // namespace

std::string layer_field(std::string_view keyword, std::size_t layer) {
    return layer == 0 ? std::string(keyword) : fmt::format("{} {}", keyword, layer);
}

const std::vector<std::string>& scene_keywords() {
    static const std::vector<std::string> keywords = {"camera",   "light", "background", "ground",
                                                      "material", "steps", "let",        "inner",
                                                      "sky",      "film",  "haze",       "preset"};
    return keywords;
}

std::vector<std::string_view> scene_fields(SceneStatement::Kind kind) {
    std::vector<std::string_view> keywords;
    for (const FieldRule& rule : rules(kind))
        keywords.push_back(rule.keyword);
    return keywords;
}

bool at_scene_statement(const TokenStream& stream) {
    // Younger than the languages: the name of a part, too, unless a name follows.
    if (stream.at("inner")) return stream.peek(1).kind == TokenKind::name && !stream.peek(1).first_on_line;
    if (stream.at("sky") || stream.at("film") || stream.at("haze"))
        return stream.peek(1).is("{") || stream.peek(1).is(":");
    if (stream.at("preset")) return stream.peek(1).kind == TokenKind::name && stream.peek(2).is("{");
    return kind_of(stream.peek()).has_value();
}

void parse_scene_statement(TokenStream& stream, std::vector<SceneStatement>& statements) {
    SceneStatement statement;
    statement.kind = *kind_of(stream.peek());
    if (!StatementParser(stream, statement).parse()) {
        statement.complete = false;
        stream.skip_line();
    }
    statements.push_back(std::move(statement));
}

} // namespace graftal
