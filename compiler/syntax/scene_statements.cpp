#include "compiler/syntax/scene_statements.h"

#include <algorithm>
#include <optional>
#include <span>
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

struct StatementRule {
    std::string_view keyword;
    std::span<const FieldRule> fields; ///< in its braces
    const char* example;               ///< the statement with some of its fields
};

/// The statements, in the order of their kinds.
std::span<const StatementRule> statement_rules() {
    using enum Shape;
    static constexpr FieldRule camera[] = {{"location", vector}, {"look_at", vector},    {"up", vector},
                                           {"angle", number},    {"orthographic", flag}, {"width", number},
                                           {"height", number},   {"aperture", number},   {"focus", vector},
                                           {"direction", vector}};
    static constexpr FieldRule light[] = {{"location", vector},    {"sun", vector},        {"color", color},
                                          {"temperature", number}, {"brightness", number}, {"angle", number},
                                          {"shadowless", flag},    {"size", pair},         {"radius", number},
                                          {"look_at", vector}};
    static constexpr FieldRule background[] = {{"zenith", color}, {"horizon", color}};
    static constexpr FieldRule ground[] = {
        {"height", number}, {"color", color}, {"material", name}, {"area", area}};
    static constexpr FieldRule material[] = {
        {"color", color},      {"ambient", number},    {"diffuse", number},      {"specular", number},
        {"roughness", number}, {"reflection", number}, {"translucency", number}, {"emission", number},
        {"texture", text},     {"around", number},     {"metallic", number},     {"transparency", number},
        {"ior", number},       {"absorption", number}, {"from", name},           {"blur", number},
        {"filter", number},    {"pattern", name},      {"scale", number},        {"octaves", number},
        {"stretch", vector},   {"warp", number},       {"space", name},          {"plus", name},
        {"share", number},     {"low", color},         {"high", color},          {"bump", number}};
    static constexpr FieldRule sky[] = {{"zenith", color}, {"horizon", color},     {"below", color},
                                        {"clear", number}, {"clouds", number},     {"environment", text},
                                        {"turn", number},  {"brightness", number}, {"bounces", number}};
    static constexpr FieldRule film[] = {
        {"exposure", number}, {"white", number}, {"soft", flag}, {"hard", flag}};
    static constexpr FieldRule haze[] = {
        {"distance", number}, {"color", color}, {"base", number}, {"height", number}, {"sun", number}};
    static constexpr StatementRule rules[] = {
        {"camera", camera, "camera { location: 3, 2, 5  look_at: 0, 0, 0 }"},
        {"light", light, "light { sun: 1, 2, 3 } or light { location: 10, 20, 30 }"},
        {"background", background, ""},
        {"ground", ground, "ground { height: 0  color: 0.3, 0.3, 0.25 }"},
        {"material", material, "material stone { color: 0.5, 0.5, 0.5 }"},
        {"steps", {}, ""},
        {"let", {}, ""},
        {"inner", {}, ""},
        {"sky", sky, "sky { zenith: 0.3, 0.5, 0.9  horizon: 0.9, 0.9, 1 } or sky { clear: 3 }"},
        {"film", film, "film { exposure: 1.2 }"},
        {"haze", haze, "haze { distance: 300  color: 0.7, 0.8, 0.9 }"},
        {"preset", {}, ""}};
    return rules;
}

const StatementRule& rule_of(Kind kind) {
    return statement_rules()[static_cast<std::size_t>(kind)];
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
            return parse_value(keyword, Shape::number);
        case Kind::material:
            return parse_name(keyword) && parse_block(keyword);
        case Kind::preset:
            return parse_name(keyword) && parse_preset();
        case Kind::background:
            stream_.accept(":");
            if (stream_.at("{")) return parse_block(keyword);
            if (!parse_value(keyword, Shape::color)) return false;
            statement_.fields.back().keyword = "zenith";
            return true;
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
            if (!stream_.expect("=", name->text) || !parse_value(*name, Shape::number) || !parse_members()) {
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
                parse_value(*name, Shape::number))
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
            stream_.expected(fmt::format("'{{' after '{}'", after))
                .with_hint(rule_of(statement_.kind).example);
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

    /// `ground { material: stone` goes on, `ground {` and then `material stone {` does not.
    bool begins_other_statement() const {
        return stream_.is_statement_word(stream_.peek()) || (at_scene_statement(stream_) && !at_field());
    }

    bool at_material_definition() const { return stream_.at("material") && stream_.peek(2).is("{"); }

    /// The field that the next token begins; null if it is none of this statement.
    const FieldRule* next_field() const {
        const std::span<const FieldRule> known = rule_of(statement_.kind).fields;
        const auto found =
            std::ranges::find_if(known, [&](const FieldRule& rule) { return stream_.at(rule.keyword); });
        return found == known.end() ? nullptr : &*found;
    }

    bool at_field() const { return next_field() && !at_material_definition(); }

    bool parse_field(std::string_view statement) {
        const Token keyword = stream_.peek();
        const FieldRule* const rule = next_field();
        if (!rule) return report_unknown(statement);
        if (defines_material()) return false;
        stream_.next();
        stream_.accept(":");
        return parse_value(keyword, rule->shape);
    }

    bool report_unknown(std::string_view statement) {
        const Token word = stream_.peek();
        std::vector<std::string> candidates;
        const bool patterned =
            std::ranges::find(statement_.fields, "pattern", &SceneField::keyword) != statement_.fields.end();
        for (const FieldRule& rule : rule_of(statement_.kind).fields)
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
        while (!stream_.at_end() && !stream_.at("}") && !stream_.peek().first_on_line && !at_field())
            if (stream_.next().is("{")) stream_.skip_block();
    }

    /// `ground { material stone { ... } }`. Reported and skipped.
    bool defines_material() {
        if (!at_material_definition()) return false;
        stream_.diagnostics()
            .error(stream_.peek().span, "define materials outside of other statements")
            .with_hint(fmt::format("here, write the material's name: 'material: {}'", stream_.peek(1).text));
        for (int i = 0; i < 3; ++i)
            stream_.next();
        stream_.skip_block();
        return true;
    }

    bool parse_value(const Token& keyword, Shape shape) {
        SceneField field;
        if (keyword.text == "plus" && statement_.kind == Kind::material) ++layer_;
        field.keyword = layer_field(keyword.text, is_layer_field(keyword.text) ? layer_ : 0);
        field.span = keyword.span;
        const std::string what = fmt::format("'{}'", keyword.text);
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
        case Shape::name:
        case Shape::text: {
            const std::optional<Token> word =
                shape == Shape::name ? stream_.expect_name("a name after " + what)
                                     : stream_.expect_string("a file name in quotes after " + what);
            if (!word) return false;
            field.name = word->text;
            field.name_span = word->span;
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
    static const std::vector<std::string> keywords = [] {
        std::vector<std::string> words;
        for (const StatementRule& rule : statement_rules())
            words.emplace_back(rule.keyword);
        return words;
    }();
    return keywords;
}

std::vector<std::string_view> scene_fields(SceneStatement::Kind kind) {
    std::vector<std::string_view> keywords;
    for (const FieldRule& rule : rule_of(kind).fields)
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
