#include "compiler/inst/parse/parser.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/inst/parse/body.h"
#include "compiler/syntax/everyday_words.h"
#include "compiler/syntax/expression_parser.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

namespace {

constexpr std::size_t max_parameters = 100;

/// The words that begin lines, apart from those that all languages share.
std::span<const std::string_view> line_words() {
    static const std::vector<std::string_view> words = [] {
        std::vector<std::string_view> own = {"union",   "intersection", "difference", "instance", "terminal",
                                             "scatter", "below",        "object",     "repeat",   "hue",
                                             "ink",     "when",         "nothing"};
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
        if (stream_.at("{")) {
            stream_.expected("the name of the object").with_hint("give it one: object ball { sphere }");
            return false;
        }
        const std::optional<Token> name = stream_.expect_name("the name of the object");
        if (!name) return false;
        definition.name = name->text;
        if (stream_.accept("(") && !parse_parameters(definition)) return false;
        definition.span = stream_.span_from(name->span);
        if (stream_.accept("weight") && !(definition.weight = parse_expression(stream_))) return false;
        stream_.accept(":");
        if (!stream_.expect("{", stream_.previous().text)) return false;
        open_objects_ += parse_inst_body(stream_, definition, scatters_) ? 0 : 1;
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
                --open_objects_; // an object that was left too early
            else
                diagnostics_.error(token.span, "this '}' closes nothing");
            return;
        }
        const std::string foreign = foreign_word_hint(foreign_, token.text);
        const bool name = token.kind == TokenKind::name;
        const bool assigns = name && stream_.peek(1).is("=");
        const bool braced = name && stream_.peek(1).is("{") && is_braced_word(token.text);
        stream_.expected("an object or a scene statement")
            .with_hint(!foreign.empty() ? foreign
                       : assigns        ? fmt::format("'let {} = ...' names a number", token.text)
                       : braced         ? braced_word_hint(token.text, "object NAME { ... }")
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
