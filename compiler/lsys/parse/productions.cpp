#include "compiler/lsys/parse/productions.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/parse/commands.h"
#include "compiler/syntax/expression_parser.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

using Formals = std::vector<LsysFormal>;

bool is_bracket(std::string_view symbol) {
    return symbol == "[" || symbol == "]" || symbol == "{" || symbol == "}";
}

/// `p1`, `rule_12`: small letters, then digits. A longer name without digits is more often a module that was
/// not declared than a label.
bool is_label(std::string_view word) {
    const std::size_t digits = word.find_first_of("0123456789");
    if (digits == std::string_view::npos || word[0] < 'a' || word[0] > 'z') return false;
    return word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == digits &&
           word.find_first_not_of("0123456789", digits) == std::string_view::npos;
}

/// Expressions are evaluated by recursion.
constexpr std::size_t most_written_depth = 1000;
constexpr std::size_t most_written_words = 10'000;

class ProductionParser {
  public:
    ProductionParser(const LsysStatement& statement, LsysText& text)
        : statement_(statement), text_(text), diagnostics_(text.diagnostics),
          reader_(text, statement.begin, statement.end) {}

    std::optional<LsysProduction> parse() {
        parse_label();
        bool good = parse_left_side() && parse_condition() && parse_arrow();
        if (good) good = parse_successor(); // its errors are independent of those of the parameters
        if (good && !locals_.empty()) good = write_out_locals();
        // A block before the condition can as well come after it, if the production does not compete.
        if (lone_block_ && !production_.probability) std::swap(production_.before, production_.after);
        return good && check_parameters() ? std::optional(std::move(production_)) : std::nullopt;
    }

  private:
    void parse_label() {
        const std::string_view word = statement_.word;
        const std::size_t colon = statement_.begin + word.size();
        if (!is_label(word) || text_.symbols.first_of(word) == word) return;
        reader_.move_to(colon);
        if (reader_.accept(':'))
            production_.label = {word, text_.scanner.span(word)};
        else
            reader_.move_to(statement_.begin);
    }

    /// `left < predecessor > right`, up to the condition or arrow.
    bool parse_left_side() {
        const std::size_t begin = reader_.position();
        Formals modules;
        bool good = read_context(modules);
        bool has_left = false;
        if (reader_.accept('<')) {
            has_left = true;
            production_.left = std::move(modules);
            modules.clear();
            good = reader_.read_formals(modules) && good;
        }
        const std::size_t sign = reader_.position();
        const bool has_right = reader_.accept('>');
        if (has_right) good = read_context(production_.right) && good;
        if (!good) return false;
        if (has_left || has_right) good = check_contexts(begin, sign);
        return take_predecessor(modules, has_left) && good;
    }

    /// `*` says that there is none.
    bool read_context(Formals& modules) { return reader_.accept('*') || reader_.read_formals(modules); }

    bool check_contexts(std::size_t begin, std::size_t end) {
        if (statement_.section != LsysSection::block) {
            diagnostics_.error(text_.scanner.span(begin, end + 1),
                               "productions of 'interpret' and 'decompose' have no context");
            return false;
        }
        for (const LsysFormal& module : production_.left)
            if (is_bracket(module.symbol)) {
                diagnostics_.error(module.span, "a left context has no brackets")
                    .with_hint("graftal matches it along the way to the root, past all side branches");
                return false;
            }
        return check_lsys_brackets(production_.right, text_);
    }

    bool take_predecessor(Formals& modules, bool has_left) {
        if (modules.empty()) {
            reader_.move_to(has_left ? reader_.position() : first_character());
            reader_.expected("the module that is rewritten").with_hint("write a production as A -> B");
            return false;
        }
        if (modules.size() > 1 && !check_several(modules)) return false;
        for (const LsysFormal& module : modules)
            if (!check_rewritten(module)) return false;
        brackets_ = unmatched_brackets(modules);
        production_.predecessor = std::move(modules[0]);
        production_.following.assign(std::make_move_iterator(modules.begin() + 1),
                                     std::make_move_iterator(modules.end()));
        return true;
    }

    bool check_rewritten(const LsysFormal& module) {
        if (module.symbol == "{" || module.symbol == "}") {
            diagnostics_.error(module.span, "a brace cannot be rewritten");
            return false;
        }
        const bool bracket = is_bracket(module.symbol);
        if (bracket && statement_.section != LsysSection::block) {
            diagnostics_.error(module.span, "only a derivation step can rewrite a bracket");
            return false;
        }
        if (module.symbol != "%") return true;
        diagnostics_.error(module.span, "a cut cannot be rewritten")
            .with_hint("it has already removed the rest of its branch before a production could apply");
        return false;
    }

    std::size_t first_character() const {
        return production_.label.text.empty() ? statement_.begin : production_.label.span.end + 1;
    }

    /// Guesses the statement that was meant: a name that is not declared, an arrow of three signs.
    bool check_several(const Formals& modules) {
        const Span span = join(modules.front().span, modules.back().span);
        const std::string_view text = text_.scanner.text().substr(span.begin, span.end - span.begin);
        const std::string_view word = lsys_name(text);
        const bool can_be_declared =
            word.size() > 1 && word.size() <= max_lsys_symbol && can_name_module(word);
        const std::string declare = fmt::format("declare longer names: modules {}", word);
        if (statement_.section != LsysSection::block) {
            diagnostics_
                .error(span,
                       fmt::format("a production of 'interpret' or 'decompose' rewrites one module, not {}",
                                   modules.size()))
                .with_hint(can_be_declared ? declare
                                           : "rewrite several modules at once in a derivation step");
            return false;
        }
        if (modules.back().symbol == "-" && reader_.arrow_size() > 0 && reader_.position() == span.end) {
            diagnostics_.error(span, "this arrow has too many signs")
                .with_hint("write a blank between the module '-' and the arrow");
            return false;
        }
        if (text_.symbols.first_of(word).size() >= word.size() || word.size() < 2) return true;
        diagnostics_
            .error(text_.scanner.span(word),
                   fmt::format("'{}' is read letter by letter, as modules side by side", word))
            .with_hint(
                fmt::format("{}write blanks between the modules", can_be_declared ? declare + "; or " : ""));
        return false;
    }

    bool parse_condition() {
        if (!reader_.accept(':')) return true;
        const std::size_t end =
            text_.scanner.find_arrow(reader_.position(), statement_.end).value_or(statement_.end);
        if (!parse_commands(production_.before, end)) return false;
        if (const auto word = find_outside("with", reader_.position(), end)) {
            if (!production_.before) return parse_locals(*word, end);
            return refuse_with(*word);
        }
        const std::optional<std::size_t> brace = find_outside("{", reader_.position(), end);
        const bool always = reader_.accept('*');
        skip_comments(end);
        const bool asked = always || !production_.before || reader_.position() < brace.value_or(end);
        if (asked && !always) {
            production_.condition = reader_.read_expression(brace.value_or(end), brace ? "'{'" : "'->'");
            if (!production_.condition) return false;
        }
        if (!parse_commands(production_.after, end)) return false;
        // Without a condition there is nothing to be before.
        if (production_.before && !asked && !production_.after) lone_block_ = true;
        return true;
    }

    void skip_comments(std::size_t end) {
        reader_.move_to(std::min(text_.scanner.skip_blanks(reader_.position()), end));
    }

    /// `{ ... }`, if there is one here.
    bool parse_commands(std::optional<LsysCommands>& commands, std::size_t end) {
        skip_comments(end);
        const std::size_t open = reader_.position();
        if (open >= end || text_.scanner.text()[open] != '{') return true;
        const std::optional<std::size_t> close = text_.scanner.bracket_end(open, end);
        if (!close) {
            diagnostics_.error(text_.scanner.span(open, open + 1), "this '{' is not closed");
            return false;
        }
        TokenStream stream = text_.tokens(open, *close, "the end of the block");
        if (stream.at_end()) return false; // said by check of limits
        commands = parse_lsys_commands(stream);
        reader_.move_to(*close);
        skip_comments(end);
        return commands.has_value();
    }

    bool refuse_with(std::size_t word) {
        diagnostics_
            .error(text_.scanner.span(word, word + 4),
                   "a production has either 'with' or blocks for local values")
            .with_hint("assign the values in the block");
        return false;
    }

    /// A word, or a brace, between these places, if it stands outside of parentheses and braces.
    std::optional<std::size_t> find_outside(std::string_view word, std::size_t begin, std::size_t end) const {
        const std::string_view text = text_.scanner.text();
        const auto is_inside = [&](std::size_t at) {
            return at < end && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_');
        };
        int depth = 0;
        for (std::size_t at = begin; at < end; ++at) {
            at = text_.scanner.comment_end(at);
            if (at >= end) break;
            if (depth == 0 && text.substr(at, word.size()) == word &&
                (word == "{" || (!is_inside(at + word.size()) && (at == begin || !is_inside(at - 1)))))
                return at;
            depth += (text[at] == '(' || text[at] == '{') - (text[at] == ')' || text[at] == '}');
        }
        return std::nullopt;
    }

    /// `condition with NAME = number, ...`
    bool parse_locals(std::size_t word, std::size_t end) {
        if (!reader_.accept('*') && reader_.position() < word) {
            production_.condition = reader_.read_expression(word, "'with'");
            if (!production_.condition) return false;
        }
        TokenStream stream = text_.tokens(word + 4, end, "'->'");
        reader_.move_to(end);
        do {
            const std::optional<Token> name = stream.expect_name("the name of a local value");
            if (!name || !stream.expect("=", name->text)) return false;
            std::optional<Expression> value = parse_expression(stream);
            if (!value) return false;
            locals_.push_back({{name->text, name->span}, std::move(*value)});
        } while (stream.accept(","));
        if (stream.at_end()) return true;
        stream.expected("'->'");
        return false;
    }

    /// Each local value in place of its name; one may use those before it.
    bool write_out_locals() {
        ExpressionNames values;
        production_.locals = locals_;
        for (auto& [name, value] : locals_) {
            if (calls_chance(value)) {
                diagnostics_
                    .error(name.span, fmt::format("the local value '{}' must not be random", name.text))
                    .with_hint(
                        "give the random number to a module: A -> B(random(0, 1))  decompose B(r) -> ...");
                return false;
            }
            if (!has_room(value, values, name.span)) return false;
            write_out(value, values);
            values.insert_or_assign(std::string(name.text), value);
        }
        const auto write = [&](Expression& expression) {
            if (!has_room(expression, values, expression.span)) return false;
            write_out(expression, values);
            return true;
        };
        if (production_.condition && !write(*production_.condition)) return false;
        if (production_.probability && !write(*production_.probability)) return false;
        for (LsysModule& module : production_.successor.modules)
            for (Expression& parameter : module.parameters)
                if (!write(parameter)) return false;
        return true;
    }

    bool has_room(const Expression& expression, const ExpressionNames& values, Span span) {
        const ExpressionExtent extent = extent_of(expression, values);
        text_.words_left -= std::min(text_.words_left, extent.words);
        if (extent.depth <= most_written_depth && extent.words <= most_written_words && text_.words_left > 0)
            return true;
        diagnostics_.error(span, "the local values make too long an expression");
        return false;
    }

    bool parse_arrow() {
        const std::size_t size = reader_.arrow_size();
        if (size == 0) {
            Diagnostic& error = reader_.expected("'->'");
            if (reader_.accept('<'))
                error.with_hint("write the left context first, and only once: A < B > C -> ...");
            return false;
        }
        const std::size_t begin = reader_.position();
        reader_.move_to(begin + size);
        production_.span = text_.scanner.span(statement_.begin, begin + size);
        production_.successor.span = text_.scanner.span(begin, begin + size);
        return true;
    }

    bool parse_successor() {
        const bool balanced = brackets_.closed + brackets_.open == 0;
        bool good = reader_.accept('*') || reader_.read_modules(production_.successor.modules, balanced);
        good = (balanced || check_brackets()) && good;
        if (reader_.accept(':')) {
            production_.probability = reader_.read_expression(statement_.end, lsys_line_end);
            return production_.probability && good;
        }
        if (!good || reader_.at_end()) return good;
        Diagnostic& error = reader_.expected("a module or the end of the line");
        if (reader_.arrow_size() > 0)
            error.with_hint("write every production on its own line");
        else if (reader_.accept('*'))
            error.with_hint("write '*' alone, for the empty string");
        else
            error.with_hint("write contexts before the arrow: A < B > C -> ...");
        return false;
    }

    /// The successor must keep any word balanced in place of the predecessor.
    bool check_brackets() {
        const LsysBrackets now = unmatched_brackets(production_.successor.modules);
        if (now.closed <= brackets_.closed && now.open + brackets_.closed == brackets_.open + now.closed)
            return true;
        const auto told = [](const LsysBrackets& brackets) {
            return fmt::format("closes {} and opens {}", brackets.closed, brackets.open);
        };
        diagnostics_
            .error(production_.successor.span,
                   fmt::format("this successor {} of the word's branches", told(now)))
            .with_hint(fmt::format("the predecessor {}, and the word must stay balanced", told(brackets_)));
        return false;
    }

    bool check_parameters() {
        std::vector<const Name*> names;
        for (const Formals* part : {&production_.following, &production_.left, &production_.right})
            for (const LsysFormal& module : *part)
                add(module, names);
        add(production_.predecessor, names);
        if (names.size() > max_lsys_parameters) {
            diagnostics_.error(
                production_.predecessor.span,
                fmt::format("a production and its contexts have at most {} parameters", max_lsys_parameters));
            return false;
        }
        std::stable_sort(names.begin(), names.end(), [](const Name* a, const Name* b) {
            return std::pair(a->text, a->span.begin) < std::pair(b->text, b->span.begin);
        });
        const auto twin = std::adjacent_find(names.begin(), names.end(),
                                             [](const Name* a, const Name* b) { return a->text == b->text; });
        if (twin == names.end()) return true;
        const Name& second = **(twin + 1);
        diagnostics_.error(second.span, fmt::format("duplicate parameter '{}'", second.text))
            .with_note((*twin)->span, "first named here");
        return false;
    }

    static void add(const LsysFormal& module, std::vector<const Name*>& names) {
        for (const Name& name : module.parameters)
            names.push_back(&name);
    }

    const LsysStatement& statement_;
    LsysText& text_;
    Diagnostics& diagnostics_;
    LsysStringReader reader_;
    LsysProduction production_;
    LsysBrackets brackets_; ///< of the predecessor
    bool lone_block_ = false;
    std::vector<std::pair<Name, Expression>> locals_;
};

} // namespace

std::optional<LsysProduction> parse_lsys_production(const LsysStatement& statement, LsysText& text) {
    return ProductionParser(statement, text).parse();
}

} // namespace graftal
