#include "compiler/lsys/parse/block.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/parse/commands.h"
#include "compiler/lsys/parse/productions.h"
#include "compiler/lsys/parse/surroundings.h"
#include "compiler/lsys/parse/tables.h"
#include "compiler/support/small_letters.h"
#include "compiler/syntax/expression_functions.h"
#include "compiler/syntax/expression_parser.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

constexpr std::string_view full_width_brace = "\xEF\xBD\x9B";

class BlockParser {
  public:
    BlockParser(LsysText& text, LsysFile& file)
        : text_(text), scanner_(text.scanner), diagnostics_(text.diagnostics), file_(file) {}

    std::size_t parse(const LsysHeader& header) {
        block_.is_main = header.is_main;
        const std::size_t errors = diagnostics_.error_count();
        std::size_t at = 0;
        const bool opened = parse_head(header, at);
        if (block_.name.text.empty() && !opened) return at;
        const LsysOutline outline = scanner_.outline(at);
        parse_statements(outline.statements);
        text_.check_polygons();
        connect_tables(block_, tables_);
        if (!outline.closed && opened && !text_.stray_brace_said) report_open(outline.end);
        if (opened && !axiom_said_)
            diagnostics_.error(block_.name.span, fmt::format("'lsys {}' has no axiom", block_.name.text))
                .with_hint("write axiom F for the string that the derivation begins with");
        block_.broken = diagnostics_.error_count() > errors;
        file_.blocks.push_back(std::move(block_));
        return outline.end;
    }

  private:
    /// `lsys NAME {`; a block without its '{' is read all the same.
    bool parse_head(const LsysHeader& header, std::size_t& at) {
        const Span keyword = scanner_.span(header.keyword);
        if (header.keyword != "lsys")
            diagnostics_.error(keyword, fmt::format("expected 'lsys', found '{}'", header.keyword))
                .with_hint("did you mean 'lsys'?");
        at = scanner_.skip_blanks(keyword.end);
        const std::size_t size = scanner_.text().size();
        const std::string_view name = lsys_name(scanner_.text().substr(at));
        block_.name = {name, name.empty() ? keyword : scanner_.span(name)};
        if (name.empty()) scanner_.expected("a name after 'lsys'", at, size, "the end of the file");
        at = scanner_.skip_blanks(at + name.size());
        const auto here = [&](std::string_view open) { return scanner_.text().substr(at).starts_with(open); };
        const bool stands_here = here("{");
        if (!stands_here && !name.empty()) report_no_brace(name, at);
        if (!stands_here && !find_brace(at)) return false;
        if (name.empty()) block_.name.text = header.keyword;
        open_ = scanner_.span(at, at + 1);
        at += here(full_width_brace) ? full_width_brace.size() : 1;
        return true;
    }

    void report_no_brace(std::string_view name, std::size_t at) {
        const std::size_t size = scanner_.text().size();
        const bool dash = at < size && scanner_.text()[at] == '-';
        Diagnostic& error =
            scanner_.expected(fmt::format("'{{' after '{}'", name), at, size, "the end of the file");
        if (dash) error.with_hint("a name consists of letters, digits and _");
    }

    /// `lsys my plant {`: reported; the block is read all the same if its '{' stands on the line.
    bool find_brace(std::size_t& at) const {
        const std::string_view text = scanner_.text();
        const std::string_view line = text.substr(at, text.find('\n', at) - at);
        const std::size_t brace = std::min(line.find('{'), line.find(full_width_brace));
        if (brace == std::string_view::npos) return false;
        at += brace;
        return true;
    }

    void report_open(std::size_t end) {
        const std::string what = fmt::format("'}}' at the end of 'lsys {}'", block_.name.text);
        scanner_.expected(what, end, scanner_.text().size(), "the end of the file")
            .with_note(open_, "to close this '{'");
    }

    /// The declared names first: they say how strings are read.
    void parse_statements(const std::vector<LsysStatement>& statements) {
        text_.symbols = {};
        text_.stray_brace_said = false;
        text_.open_polygon = text_.closed_polygon = std::nullopt;
        const auto declares = [](const LsysStatement& s) {
            return s.word == "modules" && s.section == LsysSection::block;
        };
        for (const LsysStatement& statement : statements)
            if (declares(statement)) parse_modules(statement);
        for (const LsysStatement& statement : statements)
            if (!declares(statement) && !diagnostics_.full()) parse_statement(statement);
    }

    void parse_statement(const LsysStatement& statement) {
        const std::string_view word = statement.word;
        if (statement.section != LsysSection::block && is_lsys_keyword(word))
            return report_section(statement);
        if (word == "let" || word == "inner") return parse_let(statement);
        if (word == "angle") return parse_value(statement, block_.angle);
        if (word == "step") return parse_value(statement, block_.step);
        if (word == "width") return parse_value(statement, block_.width);
        if (word == "thickness") return parse_value(statement, block_.thickness);
        if (word == "thinnest") return parse_value(statement, block_.thinnest);
        if (word == "taper") return parse_value(statement, block_.taper);
        if (word == "skin") return parse_value(statement, block_.skin);
        if (word == "seed") return parse_value(statement, block_.seed);
        if (word == "steps") return parse_steps(statement);
        if (word == "ignore" || word == "consider") return parse_filter(statement);
        if (word == "axiom") return parse_axiom(statement);
        if (word == "tropism" || word == "torque") return parse_tropism(statement);
        if (word == "bending") return parse_bending_of(statement);
        if (word == "environment") return parse_environment_of(statement);
        if (word == "colors") return parse_colors(statement);
        if (word == "table") return parse_table(statement);
        if (word == "precedence") return parse_precedence(statement);
        if (word == "variable" || word == "array") return parse_variables(statement);
        if (word == "start" || word == "end") return parse_step_block(statement);
        if (text_of(statement).find("->") == std::string_view::npos) return parse_other(statement);
        std::optional<LsysProduction> production = parse_lsys_production(statement, text_);
        if (production) productions(statement.section).push_back(std::move(*production));
    }

    std::vector<LsysProduction>& productions(LsysSection section) {
        return section == LsysSection::block       ? block_.productions
               : section == LsysSection::interpret ? block_.interpret
                                                   : block_.decompose;
    }

    std::string_view text_of(const LsysStatement& statement) const {
        return scanner_.text().substr(statement.begin, statement.end - statement.begin);
    }

    /// The tokens behind the statement's word and its colon.
    TokenStream values(const LsysStatement& statement) {
        TokenStream stream =
            text_.tokens(statement.begin + statement.word.size(), statement.end, lsys_line_end);
        stream.accept(":");
        return stream;
    }

    /// The modules behind the statement's word and its colon.
    LsysStringReader string(const LsysStatement& statement) {
        LsysStringReader reader(text_, statement.begin + statement.word.size(), statement.end);
        reader.accept(':');
        return reader;
    }

    template<typename Value>
    void set_once(const LsysStatement& statement, std::optional<Value>& known, Value value) {
        if (known)
            report_duplicate(statement, known->span);
        else
            known = std::move(value);
    }

    void report_duplicate(const LsysStatement& statement, Span first) {
        diagnostics_.error(scanner_.span(statement.word), fmt::format("duplicate '{}'", statement.word))
            .with_note(first, "first given here");
    }

    void parse_let(const LsysStatement& statement) {
        TokenStream stream = text_.tokens(statement.begin, statement.end, lsys_line_end);
        const std::size_t before = diagnostics_.error_count();
        if (at_scene_statement(stream))
            parse_scene_statement(stream, block_.lets);
        else // an `inner` without a name
            stream.next(), stream.expect_name("a name after 'inner'");
        if (diagnostics_.error_count() == before) text_.finish(stream);
    }

    void parse_value(const LsysStatement& statement, std::optional<LsysValue>& value) {
        TokenStream stream = values(statement);
        std::optional<Expression> expression = parse_expression(stream);
        if (!expression || !text_.finish(stream)) return;
        set_once(statement, value, {std::move(*expression), scanner_.span(statement.word)});
    }

    void parse_steps(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        LsysSteps steps{std::nullopt, scanner_.span(statement.word)};
        if (!stream.accept("infinite")) {
            steps.value = parse_expression(stream);
            if (!steps.value) return;
        }
        if (text_.finish(stream)) set_once(statement, block_.steps, std::move(steps));
    }

    void parse_variables(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        const bool good = statement.word == "array" ? parse_lsys_array(stream, block_.variables)
                                                    : parse_lsys_variables(stream, block_.variables);
        if (good) text_.finish(stream);
    }

    /// `start { ... }`, `start each { ... }` and the same of `end`.
    void parse_step_block(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        const bool each = stream.accept("each");
        stream.accept(":");
        if (!stream.at("{")) {
            stream.expected(fmt::format("'{{' after '{}{}'", statement.word, each ? " each" : ""));
            return;
        }
        std::optional<LsysCommands> commands = parse_lsys_commands(stream);
        if (!commands || !text_.finish(stream)) return;
        std::optional<LsysCommands>& known = statement.word == "start"
                                                 ? (each ? block_.start_each : block_.start)
                                                 : (each ? block_.end_each : block_.end);
        set_once(statement, known, std::move(*commands));
    }

    void parse_precedence(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        const bool by_text = stream.at("text");
        if (!by_text && !stream.at("contexts")) {
            stream.expected("'text' or 'contexts'");
            return;
        }
        stream.next();
        if (text_.finish(stream))
            set_once(statement, block_.precedence, {by_text, scanner_.span(statement.word)});
    }

    void parse_filter(const LsysStatement& statement) {
        LsysStringReader reader = string(statement);
        LsysContextFilter filter{statement.word == "consider", {}, scanner_.span(statement.word)};
        if (!reader.read_symbols(filter.symbols) || !finish_string(reader)) return;
        if (filter.symbols.empty()) {
            reader.expected(fmt::format("symbols after '{}'", statement.word));
        } else if (!block_.filter) {
            block_.filter = std::move(filter);
        } else if (block_.filter->consider == filter.consider) {
            report_duplicate(statement, block_.filter->span);
        } else {
            diagnostics_.error(filter.span, "a block has either 'ignore' or 'consider'")
                .with_note(block_.filter->span, "the other is given here");
        }
    }

    void parse_axiom(const LsysStatement& statement) {
        const bool again = std::exchange(axiom_said_, true);
        LsysStringReader reader = string(statement);
        LsysString axiom{{}, scanner_.span(statement.word)};
        if (!reader.read_modules(axiom.modules) || !finish_string(reader)) return;
        if (axiom.modules.empty())
            reader.expected("a module string after 'axiom'");
        else if (block_.axiom)
            report_duplicate(statement, block_.axiom->span);
        else if (!again)
            block_.axiom = std::move(axiom);
    }

    bool finish_string(LsysStringReader& reader) {
        if (reader.at_end()) return true;
        const bool arrow = reader.arrow_size() > 0;
        Diagnostic& error = reader.expected("a module or the end of the line");
        if (arrow) error.with_hint("write every statement and every production on its own line, without ';'");
        return false;
    }

    /// Parses a direction of three numbers, and a fourth for the angle with it.
    void parse_tropism(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        const bool twists = statement.word == "torque";
        auto numbers = parse_numbers(stream, 3, twists ? 3 : 4, fmt::format("'{}'", statement.word));
        if (!numbers) return;
        LsysDirection tropism{std::move(*numbers), scanner_.span(statement.word), std::nullopt, twists};
        if (tropism.direction.size() == 4) {
            tropism.angle = std::move(tropism.direction.back());
            tropism.direction.pop_back();
        }
        if (text_.finish(stream)) block_.tropisms.push_back(std::move(tropism));
    }

    void parse_bending_of(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        const std::optional<LsysBending> bending = parse_bending(stream, scanner_.span(statement.word));
        if (bending && text_.finish(stream)) set_once(statement, block_.bending, *bending);
    }

    void parse_environment_of(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        std::optional<LsysEnvironment> environment = parse_environment(stream);
        if (environment && text_.finish(stream)) block_.environment.push_back(std::move(*environment));
    }

    /// `table NAME = number, number, ...`
    void parse_table(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        const std::optional<Token> name = stream.expect_name("the name of a table");
        if (!name || !stream.expect("=", name->text)) return;
        auto table = std::make_shared<std::vector<double>>();
        do {
            const std::optional<Expression> number = parse_expression(stream);
            const std::optional<double> value = number ? evaluate(*number, {}, diagnostics_) : std::nullopt;
            if (!value) return;
            table->push_back(*value);
        } while (stream.accept(","));
        if (!text_.finish(stream)) return;
        if (expression_function(name->text) || chance_function(name->text))
            diagnostics_.error(name->span, fmt::format("the function '{}' already exists", name->text));
        else if (table->size() < 2)
            diagnostics_.error(name->span, "a table has two values or more");
        else if (!tables_.emplace(name->text, std::move(table)).second)
            diagnostics_.error(name->span, fmt::format("duplicate table '{}'", name->text));
        else
            block_.tables.push_back({name->text, name->span});
    }

    void parse_colors(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        std::vector<Name> names;
        do {
            const bool number = stream.peek().kind == TokenKind::number;
            if (number) {
                stream.expected("the name of a material")
                    .with_hint("define the colour as a material of the file: material petal { color: 0.7, "
                               "0.1, 0.3 }");
                return;
            }
            const std::optional<Token> name = stream.expect_name("the name of a material");
            if (!name) return;
            names.push_back({name->text, name->span});
        } while (stream.accept(",") || stream.at_name());
        if (!text_.finish(stream)) return;
        if (block_.colors.empty())
            block_.colors = std::move(names);
        else
            report_duplicate(statement, block_.colors.front().span);
    }

    void parse_modules(const LsysStatement& statement) {
        TokenStream stream = values(statement);
        do {
            const std::optional<Token> name =
                at_digit(stream) ? std::optional(stream.next()) : stream.expect_name("the name of a module");
            if (!name) return;
            declare({name->text, name->span});
        } while (stream.accept(",") || stream.at_name() || at_digit(stream));
        text_.finish(stream);
    }

    /// A single one is a module's name, like a letter.
    static bool at_digit(const TokenStream& stream) {
        const Token& token = stream.peek();
        return token.kind == TokenKind::number && token.text.size() == 1;
    }

    void declare(Name name) {
        if (!can_name_module(name.text)) {
            diagnostics_.error(
                name.span, fmt::format("'{}' is a word of the language and cannot name a module", name.text));
        } else if (name.text.find('.') != std::string_view::npos) {
            diagnostics_.error(name.span, "the name of a module has no dots");
        } else if (name.text.size() > max_lsys_symbol) {
            diagnostics_.error(name.span,
                               fmt::format("names of modules have at most {} characters", max_lsys_symbol));
        } else if (!text_.symbols.add(name.text)) {
            const auto first = std::ranges::find(block_.modules, name.text, &Name::text);
            diagnostics_.error(name.span, fmt::format("duplicate module '{}'", name.text))
                .with_note(first->span, "first declared here");
        } else {
            block_.modules.push_back(name);
        }
    }

    void report_section(const LsysStatement& statement) {
        const char* section = statement.section == LsysSection::interpret ? "interpret" : "decompose";
        diagnostics_
            .error(scanner_.span(statement.word),
                   fmt::format("'{}' may contain only productions, not '{}'", section, statement.word))
            .with_hint("close it with '}' first");
        axiom_said_ |= statement.word == "axiom";
    }

    /// A statement without arrow that is none of the block's.
    void parse_other(const LsysStatement& statement) {
        const std::string_view word = statement.word;
        const bool call = scanner_.text().substr(statement.begin + word.size(), 1) == "(";
        const bool of_file = word == "use" || std::ranges::count(scene_keywords(), word) > 0;
        TokenStream stream(
            !call && of_file
                ? lex_range(text_.sources, scanner_.span(statement.begin, statement.end), diagnostics_)
                : std::vector<Token>(1),
            diagnostics_, lsys_line_end);
        if (!stream.at_end()) return parse_misplaced(stream, word);
        if (report_joined_words(statement) || report_wrong_arrow(statement)) return;
        if (text_of(statement).ends_with('{')) ++text_.lost_braces;
        const std::string meant = closest_name(word, lsys_keywords());
        axiom_said_ |= meant == "axiom";
        if (statement.begin == statement.end && statement.section != LsysSection::block) {
            diagnostics_.error(scanner_.span(statement.begin, statement.end), "expected a production or '{'")
                .with_hint("write interpret A -> F, or interpret { with one production per line }");
        } else if (word.size() > 1) {
            diagnostics_.error(scanner_.span(word), fmt::format("unknown statement '{}'", word))
                .with_hint(statement_choices(word, meant));
        } else {
            report_no_statement(statement);
        }
    }

    /// All faults. The first of two words for one section is enough.
    static std::string statement_choices(std::string_view word, std::string_view meant) {
        std::vector<std::string> words = lsys_keywords();
        std::erase_if(words, [&](const std::string& known) {
            return known != meant && (known == "homomorphism" || known == "decomposition");
        });
        std::string list;
        for (const std::string& known : words)
            list += (list.empty() ? "" : ", ") + known;
        const std::string hint = did_you_mean(word, words);
        return hint + (hint.empty() ? "known here: " : " known here: ") + list;
    }

    void report_no_statement(const LsysStatement& statement) {
        const char first = text_of(statement).empty() ? ' ' : text_of(statement)[0];
        if ((first & 0x80) != 0)
            scanner_.expected("a statement or a production", statement.begin, statement.end, lsys_line_end);
        else
            diagnostics_
                .error(scanner_.span(statement.begin, statement.end),
                       "this is neither a statement nor a production")
                .with_hint("write a production with an arrow: A -> B");
    }

    /// The blocks of steps as cpfg calls them.
    bool report_joined_words(const LsysStatement& statement) {
        const std::string small = in_small_letters(statement.word);
        if (small != "starteach" && small != "endeach") return false;
        diagnostics_
            .error(scanner_.span(statement.word), fmt::format("unknown statement '{}'", statement.word))
            .with_hint(fmt::format("write {} each {{ ... }}", small == "endeach" ? "end" : "start"));
        return true;
    }

    /// `A = B`, `A => B`, and arrows of other characters.
    bool report_wrong_arrow(const LsysStatement& statement) {
        constexpr std::array<std::string_view, 10> arrows = {"=>",
                                                             ":=",
                                                             "- >",
                                                             "=",
                                                             "\xE2\x86\x92",
                                                             "\xE2\x87\x92",
                                                             "\xE2\x80\x93>",
                                                             "\xE2\x80\x94>",
                                                             "\xE2\x88\x92>",
                                                             "\xEF\xBC\x8D>"};
        const std::string_view text = text_of(statement);
        std::string_view found;
        for (const std::string_view arrow : arrows) {
            const std::size_t at = text.find(arrow);
            if (at != std::string_view::npos && (found.empty() || text.data() + at < found.data()))
                found = text.substr(at, arrow.size());
        }
        if (found.empty()) return false;
        diagnostics_.error(scanner_.span(found), fmt::format("expected '->', found '{}'", found))
            .with_hint(found == "=" || found == ":="
                           ? "write a production as A -> B, and a named number as 'let a = 3'"
                           : "write a production as A -> B");
        return true;
    }

    void parse_misplaced(TokenStream& stream, std::string_view word) {
        diagnostics_
            .error(stream.peek().span,
                   fmt::format("'{}' must be outside the braces of 'lsys {}'", word, block_.name.text))
            .with_hint("close the block with '}' before it");
        if (word != "use") return parse_scene_statement(stream, file_.statements);
        if (const auto use = parse_use(stream)) file_.uses.push_back(*use);
    }

    LsysText& text_;
    const LsysScanner& scanner_;
    Diagnostics& diagnostics_;
    LsysFile& file_;
    LsysBlock block_;
    Span open_;
    ExpressionTables tables_;
    bool axiom_said_ = false; ///< there, or reported
};

} // namespace

std::size_t parse_lsys_block(const LsysHeader& header, LsysText& text, LsysFile& file) {
    return BlockParser(text, file).parse(header);
}

} // namespace graftal
