#include "compiler/inst/inst_parser.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/syntax/expression_parser.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

namespace {

constexpr std::size_t max_parameters = 100;

/// The keywords of the lines of an object.
const std::vector<std::string>& body_keywords() {
    static const std::vector<std::string> keywords = [] {
        std::vector<std::string> words(transform_keywords.begin(), transform_keywords.end());
        for (const char* word :
             {"union", "instance", "terminal", "scatter", "tint", "material", "chance", "below"})
            words.emplace_back(word);
        words.insert(words.end(), scatter_keywords().begin(), scatter_keywords().end());
        return words;
    }();
    return keywords;
}

/// The words that begin lines, apart from those that all languages share.
std::span<const std::string_view> line_words() {
    static const std::vector<std::string_view> words = [] {
        std::vector<std::string_view> own = {"union", "instance", "terminal", "scatter", "below", "object"};
        own.insert(own.end(), scatter_keywords().begin(), scatter_keywords().end());
        return own;
    }();
    return words;
}

std::vector<std::string> file_keywords() {
    std::vector<std::string> words(inst_keywords.begin(), inst_keywords.end());
    words.insert(words.end(), scene_keywords().begin(), scene_keywords().end());
    return words;
}

/// The lines of one object, from its '{' to its '}'.
class BodyParser {
  public:
    /// `scatters`: how many there are in the file so far.
    BodyParser(TokenStream& stream, InstDefinition& definition, std::size_t& scatters)
        : stream_(stream), diagnostics_(stream.diagnostics()), definition_(definition), scatters_(scatters) {}

    /// Requires that the '{' was just taken.
    void parse() {
        const Token open = stream_.previous();
        while (!diagnostics_.full() && !stream_.accept("}")) {
            if (stream_.at_end() || begins_statement()) {
                const bool material = stream_.at("material");
                Diagnostic& error =
                    stream_.expected(fmt::format("'}}' at the end of object '{}'", definition_.name));
                if (material)
                    error.with_hint("define materials outside of objects; inside, write the material's name: "
                                    "'material: NAME'");
                error.with_note(open.span, "to close this '{'");
                closed_ = false;
                return;
            }
            if (!stream_.accept(",") && !parse_line()) {
                failed_ = true;
                stream_.skip_line();
            }
        }
        check_not_empty();
    }

    /// Its '}' was there.
    bool closed() const { return closed_; }

  private:
    /// The next token begins a statement of the file: the '}' of this object is missing.
    bool begins_statement() const {
        const Token& word = stream_.peek();
        const Token& after = stream_.peek(1);
        const Token& third = stream_.peek(2);
        const bool name_next = after.kind == TokenKind::name;
        if (word.is("canonical") || word.is("object")) return name_next;
        if (word.is("let") || word.is("inner") || word.is("use")) return name_next && third.is("=");
        if (word.is("material")) return name_next && third.is("{");
        if (word.is("camera") || word.is("light") || word.is("ground")) return after.is("{");
        if (word.is("background")) return after.is("{") || after.is(":");
        return word.is("steps") && (after.is(":") || after.kind == TokenKind::number);
    }

    bool parse_line() {
        if (at_transform(stream_)) return parse_transform_line();
        if (stream_.at("tint")) return parse_tint_line();
        if (stream_.at("material")) return parse_material();
        if (at_chance()) return parse_chance();
        if (at_below()) return parse_below();
        if (stream_.at("union") || stream_.at("instance") || stream_.at("terminal")) return parse_group();
        if (at_scatter()) return parse_group();
        if (in_scatter() && at_scatter_line(stream_)) return parse_line_of_scatter();
        if (stream_.at_name()) return parse_bare_group();
        const bool open = stream_.at("{"), number = stream_.peek().kind == TokenKind::number;
        Diagnostic& error = stream_.expected("a line of an object");
        error.with_hint(number ? "is it one number too many?" : choices("", body_lines()));
        stream_.next();
        if (open) stream_.skip_block();
        return false;
    }

    /// The keywords of lines that any object may have.
    static std::vector<std::string> body_lines() {
        const std::vector<std::string>& all = body_keywords();
        return {all.begin(), all.end() - static_cast<std::ptrdiff_t>(scatter_keywords().size())};
    }

    /// `scatter: tree` or `scatter tree`, and not an object of that name.
    bool at_scatter() const {
        const Token& after = stream_.peek(1);
        return stream_.at("scatter") &&
               (after.is(":") || (after.kind == TokenKind::name && !after.first_on_line));
    }

    bool in_scatter() const {
        return !lost_group_ && !definition_.groups.empty() && definition_.groups.back().scatter;
    }

    bool parse_line_of_scatter() {
        InstScatter& scatter = *definition_.groups.back().scatter;
        const bool good = parse_scatter_line(stream_, scatter);
        scatter.complete = scatter.complete && good;
        return good;
    }

    bool parse_group() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        InstGroup group;
        group.terminal = keyword.is("terminal");
        if (keyword.is("scatter")) {
            group.scatter = std::make_unique<InstScatter>();
            group.scatter->ordinal = scatters_++;
        }
        lost_group_ = !parse_masters(group, keyword.text);
        if (lost_group_) return false;
        group.span = stream_.span_from(keyword.span);
        return group.terminal ? add_terminal(std::move(group)) : add(std::move(group));
    }

    /// `triangle` alone. Other names are more likely a slip: a misspelt keyword or a missing comma.
    bool parse_bare_group() {
        const Token name = stream_.peek();
        const bool begins_line = name.first_on_line || stream_.previous().is("{");
        if (stream_.peek(1).is(":")) {
            const bool scattered = at_scatter_line(stream_);
            stream_.next();
            if (scattered && lost_group_) return false; // its scatter is in error
            if (scattered) {
                diagnostics_.error(name.span, fmt::format("'{}' belongs to a scatter", name.text))
                    .with_hint("open the group with 'scatter:'");
                return false;
            }
            diagnostics_.error(name.span, fmt::format("unknown keyword '{}'", name.text))
                .with_hint(keyword_hint(name));
            return false;
        }
        if (!begins_line) {
            stream_.next();
            const bool value = stream_.peek().kind == TokenKind::number || stream_.at("<");
            const std::string hint = value ? keyword_hint(name) : did_you_mean(name.text, body_keywords());
            diagnostics_
                .error(name.span, value ? fmt::format("unknown keyword '{}'", name.text)
                                        : fmt::format("expected ',' or a new line before '{}'", name.text))
                .with_hint(hint);
            return false;
        }
        InstGroup group;
        if (!parse_masters(group, {})) return false;
        group.span = stream_.span_from(name.span);
        return add(std::move(group));
    }

    static std::string keyword_hint(const Token& word) {
        const bool colour = word.is("color") || word.is("colour");
        if (colour) return "an instance has a 'tint: r, g, b, alpha' or a 'material: NAME'";
        const std::string meant = did_you_mean(word.text, body_keywords());
        return meant.empty() ? choices(word.text, body_lines()) : meant;
    }

    bool parse_masters(InstGroup& group, std::string_view keyword) {
        do {
            const bool keyword_next = stream_.peek(1).is(":") && is_keyword(stream_.peek());
            if (!stream_.at_name() || keyword_next) {
                const std::string after(group.masters.empty() ? keyword : stream_.previous().text);
                const bool block = stream_.at("{");
                Diagnostic& error = stream_.expected(fmt::format("the name of an object after '{}'", after));
                if (block)
                    error.with_hint(fmt::format("write names without braces: '{}: sphere, cube'", after));
                return false;
            }
            InstReference reference;
            const Token name = stream_.next();
            reference.name = name.text;
            if (!parse_arguments_of(reference)) return false;
            reference.span = stream_.span_from(name.span);
            group.masters.push_back(std::move(reference));
        } while (goes_on() && stream_.accept(","));
        return true;
    }

    /// Numbers in parentheses, or the name of a file in quotes, with or without them; or nothing.
    bool parse_arguments_of(InstReference& reference) {
        const bool open = stream_.at("(");
        if (stream_.peek(open ? 1 : 0).kind != TokenKind::string)
            return !stream_.accept("(") || parse_arguments(stream_, reference.arguments);
        stream_.accept("(");
        const Token path = stream_.next();
        reference.path = path.text;
        reference.path_span = path.span;
        return !open || stream_.expect(")", path.text);
    }

    /// A comma may also end a line.
    bool goes_on() const {
        const Token& after = stream_.peek(1);
        return stream_.at(",") && after.kind == TokenKind::name &&
               !(is_keyword(after) && stream_.peek(2).is(":"));
    }

    static bool is_keyword(const Token& token) {
        return token.kind == TokenKind::name &&
               std::find(body_keywords().begin(), body_keywords().end(), token.text) != body_keywords().end();
    }

    bool add(InstGroup group) {
        lost_group_ = false;
        definition_.groups.push_back(std::move(group));
        return true;
    }

    bool add_terminal(InstGroup group) {
        const auto other = std::find_if(definition_.groups.begin(), definition_.groups.end(),
                                        [](const InstGroup& g) { return g.terminal; });
        if (other != definition_.groups.end())
            diagnostics_
                .error(group.span, fmt::format("object '{}' already has a terminal", definition_.name))
                .with_note(other->span, "first given here");
        if (group.masters.size() > 1)
            diagnostics_.error(group.masters[1].span, "'terminal' names one object only");
        return add(std::move(group));
    }

    /// The group that a line belongs to, or nothing after an error. After a group in error its lines are
    /// silent.
    InstGroup* current(const Token& keyword) {
        if (!definition_.groups.empty()) return &definition_.groups.back();
        if (!failed_)
            diagnostics_.error(keyword.span, fmt::format("'{}' has no object to apply to", keyword.text))
                .with_hint("name the objects first, with 'union:' or 'instance:'");
        failed_ = true;
        return nullptr;
    }

    bool parse_transform_line() {
        const Token keyword = stream_.peek();
        std::optional<TransformLine> line = parse_transform(stream_);
        if (!line) return false;
        if (InstGroup* group = current(keyword)) group->transforms.push_back(std::move(*line));
        return true;
    }

    bool parse_tint_line() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        std::optional<std::vector<Expression>> values = parse_tint(stream_, "'tint'");
        if (!values) return false;
        std::vector<Expression> until;
        if (stream_.accept("..")) {
            std::optional<std::vector<Expression>> end = parse_tint(stream_, "'tint'");
            if (!end) return false;
            until = std::move(*end);
        }
        const Span span = stream_.span_from(keyword.span);
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (!until.empty() && !group->scatter)
            diagnostics_.error(span, "a range of tints belongs to a scatter")
                .with_hint("open the group with 'scatter:', or give one tint");
        group->tints.push_back({std::move(*values), std::move(until), span});
        return true;
    }

    bool parse_material() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        const std::optional<Token> name = stream_.expect_name("a name after 'material'");
        if (!name) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (group->material)
            diagnostics_.error(name->span, "these objects already have a material")
                .with_note(group->material_span, "first given here");
        group->material = name->text;
        group->material_span = name->span;
        return true;
    }

    /// `chance: 0.8` or `chance 0.8`; else an object may have that name.
    bool at_chance() const {
        const Token& after = stream_.peek(1);
        return stream_.at("chance") && (after.is(":") || after.kind == TokenKind::number);
    }

    bool parse_chance() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        std::optional<Expression> chance = parse_expression(stream_);
        if (!chance) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (group->terminal) {
            diagnostics_.error(keyword.span, "a terminal has no chance")
                .with_hint("a terminal stands for the whole object wherever graftal cuts it");
        } else if (group->chance) {
            diagnostics_.error(keyword.span, "duplicate 'chance'")
                .with_note(group->chance->span, "first given here");
        }
        group->chance = std::move(chance);
        return true;
    }

    /// `below: 12`, or after a terminal `below 12`; else an object may have that name.
    bool at_below() const {
        const bool after_terminal = !definition_.groups.empty() && definition_.groups.back().terminal;
        return stream_.at("below") && (after_terminal || stream_.peek(1).is(":"));
    }

    bool parse_below() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        std::optional<Expression> size_px = parse_expression(stream_);
        if (!size_px) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (!group->terminal) {
            diagnostics_.error(keyword.span, "'below' belongs to a terminal")
                .with_hint("it sets the size in pixels below which the terminal replaces the object");
        } else if (group->below) {
            diagnostics_.error(keyword.span, "duplicate 'below'")
                .with_note(group->below->span, "first given here");
        }
        group->below = std::move(size_px);
        return true;
    }

    void check_not_empty() {
        const bool drawn = std::any_of(definition_.groups.begin(), definition_.groups.end(),
                                       [](const InstGroup& group) { return !group.terminal; });
        if (drawn || failed_ || diagnostics_.full()) return;
        diagnostics_.error(definition_.span, fmt::format("object '{}' is empty", definition_.name))
            .with_hint("give it a 'union:' or an 'instance:'");
    }

    TokenStream& stream_;
    Diagnostics& diagnostics_;
    InstDefinition& definition_;
    std::size_t& scatters_;
    bool failed_ = false;
    bool closed_ = true;
    bool lost_group_ = false; ///< the last group was in error
};

class FileParser {
  public:
    FileParser(TokenStream& stream, const ForeignWords& foreign)
        : stream_(stream), diagnostics_(stream.diagnostics()), foreign_(foreign) {}

    InstModule parse() {
        while (!stream_.at_end() && !diagnostics_.full()) {
            if (stream_.at("object") || stream_.at("canonical")) {
                if (!parse_definition()) skip_to_statement();
            } else if (stream_.at("use")) {
                if (const auto use = parse_use(stream_))
                    module_.uses.push_back(*use);
                else
                    skip_to_statement();
            } else if (at_scene_statement(stream_)) {
                parse_scene_statement(stream_, module_.scene);
            } else {
                report_stray();
                skip_to_statement();
            }
        }
        module_.end = stream_.peek().span;
        module_.complete = module_.complete && !diagnostics_.full();
        return std::move(module_);
    }

  private:
    bool parse_definition() {
        const std::size_t begin = stream_.position();
        InstDefinition definition;
        definition.rendered = !stream_.accept("canonical");
        if (!stream_.expect("object", definition.rendered ? "" : "canonical")) return false;
        const std::optional<Token> name = stream_.expect_name("the name of the object");
        if (!name) return false;
        definition.name = name->text;
        if (stream_.accept("(") && !parse_parameters(definition)) return false;
        definition.span = stream_.span_from(name->span);
        stream_.accept(":");
        if (!stream_.expect("{", stream_.previous().text)) return false;
        BodyParser body(stream_, definition, scatters_);
        body.parse();
        open_objects_ += body.closed() ? 0 : 1;
        definition.size = stream_.position() - begin;
        module_.definitions.push_back(std::move(definition));
        return true;
    }

    /// Requires that the '(' was just taken.
    bool parse_parameters(InstDefinition& definition) {
        const Token open = stream_.previous();
        do {
            InstParameter parameter;
            const Token first = stream_.peek();
            const bool minus = stream_.accept("-");
            if (stream_.peek().kind == TokenKind::number) {
                const double number = stream_.next().number;
                parameter.number = minus && number != 0 ? -number : number;
            } else if (stream_.at_name() && !minus) {
                parameter.name = stream_.next().text;
            } else {
                stream_.expected("a number or the name of a parameter");
                return false;
            }
            parameter.span = stream_.span_from(first.span);
            if (definition.parameters.size() == max_parameters) {
                diagnostics_.error(parameter.span,
                                   fmt::format("an object has at most {} parameters", max_parameters));
                return false;
            }
            add_parameter(definition, std::move(parameter));
        } while (stream_.accept(","));
        if (stream_.accept(")")) return true;
        stream_.expected("')'").with_note(open.span, "to close this '('");
        return false;
    }

    /// Requires few parameters, and parse_parameters() sees to that.
    void add_parameter(InstDefinition& definition, InstParameter parameter) {
        for (const InstParameter& other : definition.parameters)
            if (!parameter.is_number() && other.name == parameter.name) {
                diagnostics_.error(parameter.span, fmt::format("duplicate parameter '{}'", parameter.name))
                    .with_note(other.span, "first given here");
                break;
            }
        definition.parameters.push_back(std::move(parameter));
    }

    void report_stray() {
        const Token token = stream_.peek();
        if (token.is("}")) {
            if (open_objects_ > 0)
                --open_objects_; // that of an object that was left too early
            else
                diagnostics_.error(token.span, "this '}' closes nothing");
            return;
        }
        const std::string foreign = foreign_word_hint(foreign_, token.text);
        const bool assigns = token.kind == TokenKind::name && stream_.peek(1).is("=");
        stream_.expected("an object or a scene statement")
            .with_hint(!foreign.empty() ? foreign
                       : assigns        ? fmt::format("'let {} = ...' names a number", token.text)
                                        : choices(token.text, file_keywords()));
    }

    /// Skips to a token that begins a line and a statement, outside of braces.
    void skip_to_statement() {
        module_.complete = false;
        do {
            if (stream_.next().is("{")) stream_.skip_block();
        } while (!stream_.at_end() && !at_statement());
    }

    bool at_statement() const {
        return stream_.peek().first_on_line && (stream_.at("object") || stream_.at("canonical") ||
                                                stream_.at("use") || at_scene_statement(stream_));
    }

    TokenStream& stream_;
    Diagnostics& diagnostics_;
    const ForeignWords& foreign_;
    InstModule module_;
    std::size_t scatters_ = 0;
    std::size_t open_objects_ = 0; ///< whose '}' was missed
};

} // namespace

InstModule parse_inst(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                      const ForeignWords& foreign) {
    TokenStream stream(lex(sources, file, diagnostics), diagnostics);
    stream.set_words(inst_keywords, line_words());
    stream.drop_semicolons();
    const bool nested_too_deep = stream.at_end() && diagnostics.has_errors();
    InstModule module = FileParser(stream, foreign).parse();
    if (nested_too_deep) module.complete = false;
    return module;
}

} // namespace graftal
