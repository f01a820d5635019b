#include "compiler/lsys/parse/strings.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

constexpr std::string_view turtle_brackets = "[]{}";
/// The directives of cpfg that have two letters; all others have one.
constexpr std::array<std::string_view, 9> long_directives = {"@Gs", "@Gc", "@Ge", "@Gr", "@Gt",
                                                             "@PS", "@PD", "@Di", "@Dd"};

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

constexpr const char* probability_hint = "write a probability after the successor: A -> B : 0.5";

} // namespace

std::string_view LsysSymbols::first_of(std::string_view text) const {
    std::string_view name = text.substr(0, 1);
    if (names_.empty()) return name;
    const auto is_inside = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
    std::size_t size = 0;
    while (size < std::min(text.size(), max_lsys_symbol) && is_inside(text[size]))
        ++size;
    for (; size > 1; --size)
        if (names_.count(text.substr(0, size)) > 0) return text.substr(0, size);
    return name;
}

void LsysText::check_polygons() {
    if (closed_polygon && !open_polygon) {
        diagnostics.error(*closed_polygon, "'}' without '{'").with_hint("the '}' of a block begins a line");
        stray_brace_said = true;
    }
    if (open_polygon && !closed_polygon) diagnostics.error(*open_polygon, "this '{' is not closed");
    open_polygon = closed_polygon = std::nullopt;
}

TokenStream LsysText::tokens(std::size_t begin, std::size_t end, std::string_view end_name) {
    std::vector<Token> tokens = lex_range(sources, scanner.span(begin, end), diagnostics);
    if (tokens.size() > words_left) {
        if (words_left > 0)
            diagnostics.error(tokens.front().span,
                              fmt::format("expressions have more than {} words in all", max_lsys_words));
        tokens.erase(tokens.begin(), tokens.end() - 1);
        words_left = 0;
    } else {
        words_left -= tokens.size() - 1;
    }
    return {std::move(tokens), diagnostics, end_name};
}

bool LsysText::finish(TokenStream& stream) {
    if (stream.at_end()) return true;
    const Token& found = stream.peek();
    stray_brace_said |= found.is("}");
    const bool unit =
        found.kind == TokenKind::name && found.text.find_first_not_of("degrainsv") == std::string_view::npos;
    std::string hint = "every statement stands on its own line";
    if (found.is("}")) hint = "the '}' of a block begins a line";
    if (found.is(";")) hint = "a statement ends with its line, without ';'";
    if (found.is(",")) hint = "this statement has as many numbers as it takes already";
    if (unit) hint = "angles are in degrees, and numbers have no units";
    stream.expected(lsys_line_end).with_hint(std::move(hint));
    return false;
}

std::size_t LsysStringReader::position() {
    for (; at_ < end_; ++at_) {
        if (scanner_.text()[at_] == '#') at_ = std::min(scanner_.text().find('\n', at_), end_);
        if (at_ < end_ && !is_blank(scanner_.text()[at_])) break;
    }
    at_ = std::min(at_, end_);
    return at_;
}

std::size_t LsysStringReader::arrow_size() {
    position();
    return lsys_arrow_size(rest());
}

bool LsysStringReader::accept(char c) {
    if (at_end() || scanner_.text()[at_] != c) return false;
    ++at_;
    return true;
}

Diagnostic& LsysStringReader::expected(std::string_view what) {
    return scanner_.expected(what, position(), end_, lsys_line_end);
}

bool LsysStringReader::more() {
    return !at_end() && arrow_size() == 0 &&
           std::string_view("<>:*").find(scanner_.text()[at_]) == std::string_view::npos;
}

bool LsysStringReader::take(Raw& raw) {
    const std::size_t begin = position();
    raw = {};
    if (!take_symbol(raw)) return false;
    raw.span = scanner_.span(begin, at_);
    const bool bracket = turtle_brackets.find(raw.symbol) != std::string_view::npos;
    if (!bracket && !at_end() && scanner_.text()[at_] == '(') {
        if (!take_parameters(raw)) return false;
        raw.span = scanner_.span(begin, at_);
    }
    return take_room(raw);
}

bool LsysStringReader::take_symbol(Raw& raw) {
    const std::string_view text = rest();
    const char c = text[0];
    if (c == '~') return take_model(raw);
    if (is_letter(c) || is_digit(c) || c == '_') {
        raw.symbol = text_.symbols.first_of(text);
    } else if (c == '@' && text.size() > 1 && is_letter(text[1])) {
        const bool two_letters = std::find(long_directives.begin(), long_directives.end(),
                                           text.substr(0, 3)) != long_directives.end();
        raw.symbol = text.substr(0, two_letters ? 3 : 2);
    } else if (c == '?' && turtle_command(text.substr(0, 2)) != TurtleCommand::none) {
        raw.symbol = text.substr(0, 2);
    } else if (c == '"' || turtle_command(text.substr(0, 1)) != TurtleCommand::none) {
        if (c == '/') warn_of_comment();
        raw.symbol = text.substr(0, 1);
    } else {
        return stray();
    }
    at_ += raw.symbol.size();
    return true;
}

/// `~NAME`; dots between names belong to it, as everywhere.
bool LsysStringReader::take_model(Raw& raw) {
    const std::string_view text = rest();
    std::size_t size = 1 + lsys_name(text.substr(1)).size();
    while (size > 1 && size < text.size() && text[size] == '.' && !lsys_name(text.substr(size + 1)).empty())
        size += 1 + lsys_name(text.substr(size + 1)).size();
    raw.symbol = text.substr(0, 1);
    raw.model = text.substr(1, size - 1);
    at_ += size;
    if (size > 1) return true;
    expected("the name of a model after '~'")
        .with_hint("use leaf = \"leaf.rifs\" names a model, ~leaf places it");
    return false;
}

bool LsysStringReader::take_parameters(Raw& raw) {
    const std::size_t open = at_;
    const std::optional<std::size_t> close = scanner_.bracket_end(open, end_);
    if (!close) {
        text_.diagnostics.error(scanner_.span(open, open + 1), "this '(' is not closed");
        at_ = end_;
        return false;
    }
    raw.parameters = scanner_.span(open, *close);
    at_ = *close;
    return true;
}

bool LsysStringReader::take_room(const Raw& raw) {
    if (text_.modules_left > 0) {
        if (--text_.modules_left > 0) return true;
        text_.diagnostics.error(
            raw.span, fmt::format("the strings have more than {} modules in all", max_lsys_modules));
    }
    at_ = end_;
    return false;
}

/// Reports a character that is no symbol, and steps over it so that the rest is read too.
bool LsysStringReader::stray() {
    const char c = scanner_.text()[at_];
    if (c == ')') {
        expected("a module").with_hint("this ')' closes nothing");
        ++at_;
        return false;
    }
    Diagnostic& error = expected("a module");
    if (c == '@') error.with_hint("write a directive as '@' and a letter: @o");
    if (c == '=') error.with_hint("write an arrow as ->, and no '=' after the word of a statement");
    if (c != '(') {
        do
            ++at_;
        while (at_ < end_ && (scanner_.text()[at_] & 0x80) != 0);
        // Parameters behind a stray name are no mistake of their own.
        if (at_ < end_ && scanner_.text()[at_] == '(') at_ = scanner_.bracket_end(at_, end_).value_or(end_);
        return false;
    }
    error.with_hint(at_ > 0 && scanner_.text()[at_ - 1] == '>' ? probability_hint
                                                               : "write parameters after their module: F(1)");
    at_ = scanner_.bracket_end(at_, end_).value_or(end_);
    return false;
}

/// A remark behind a string would be drawn, letter by letter.
void LsysStringReader::warn_of_comment() {
    if (warned_ || !rest().starts_with("// ") || at_ == 0 || !is_blank(scanner_.text()[at_ - 1])) return;
    warned_ = true;
    text_.diagnostics.warning(scanner_.span(at_, at_ + 2), "in a string '//' is two turns, no comment")
        .with_hint("begin comments in strings with '#', or write the turns without spaces around them");
}

template<class Take> bool LsysStringReader::read(Take take_module) {
    bool good = true;
    while (more() && !text_.diagnostics.full()) {
        Raw raw;
        good = take(raw) && take_module(raw) && good;
    }
    return good;
}

bool LsysStringReader::read_modules(std::vector<LsysModule>& modules, bool balanced) {
    bool good = read([&](const Raw& raw) {
        modules.push_back({raw.symbol, {}, raw.model, raw.span});
        return !raw.parameters || read_parameters(raw, modules.back().parameters);
    });
    return check_lsys_brackets(modules, text_, balanced) && good;
}

bool LsysStringReader::read_formals(std::vector<LsysFormal>& modules) {
    return read([&](const Raw& raw) {
        modules.push_back({raw.symbol, {}, raw.span});
        if (raw.symbol == "~") {
            text_.diagnostics.error(raw.span, "only a successor may contain a model")
                .with_hint("rewrite a module, and let its successor place the model");
            return false;
        }
        return !raw.parameters || read_names(raw, modules.back().parameters);
    });
}

bool LsysStringReader::read_symbols(std::vector<Name>& symbols) {
    bool good = true;
    std::map<std::string_view, Span> listed;
    while (more() && !text_.diagnostics.full()) {
        Raw raw;
        if (scanner_.text()[at_] == '~') { // of all models
            raw.symbol = rest().substr(0, 1);
            raw.span = scanner_.span(at_, at_ + 1);
            ++at_;
        } else if (!take(raw)) {
            good = false;
            continue;
        }
        const bool bracket = turtle_brackets.find(raw.symbol) != std::string_view::npos;
        if (raw.parameters || bracket) {
            text_.diagnostics.error(raw.parameters.value_or(raw.span),
                                    bracket ? "contexts cannot ignore or consider brackets"
                                            : "list symbols without parameters");
        } else if (const auto [twin, fresh] = listed.try_emplace(raw.symbol, raw.span); !fresh) {
            text_.diagnostics.error(raw.span, fmt::format("'{}' is listed twice", raw.symbol))
                .with_note(twin->second, "first listed here");
        } else {
            symbols.push_back({raw.symbol, raw.span});
            continue;
        }
        good = false;
    }
    return good;
}

/// `F()`. Reported.
bool LsysStringReader::refuse_empty(TokenStream& stream, const Raw& raw) {
    if (!stream.at(")")) return false;
    text_.diagnostics.error(*raw.parameters, "these parentheses contain no parameter")
        .with_hint(fmt::format("write a module without parameters as '{}'", raw.symbol));
    return true;
}

bool LsysStringReader::read_parameters(const Raw& raw, std::vector<Expression>& parameters) {
    TokenStream stream = text_.tokens(raw.parameters->begin, raw.parameters->end, lsys_line_end);
    if (stream.at_end()) return false; // said by check of limits
    stream.next();
    if (refuse_empty(stream, raw)) return false;
    do {
        std::optional<Expression> parameter = parse_expression(stream);
        if (!parameter) return false;
        parameters.push_back(std::move(*parameter));
        if (parameters.size() > max_lsys_parameters) {
            text_.diagnostics.error(parameters.back().span,
                                    fmt::format("a module has at most {} parameters", max_lsys_parameters));
            return false;
        }
    } while (stream.accept(","));
    if (stream.accept(")")) return true;
    stream.expected("',' or ')'");
    return false;
}

bool LsysStringReader::read_names(const Raw& raw, std::vector<Name>& names) {
    TokenStream stream = text_.tokens(raw.parameters->begin, raw.parameters->end, lsys_line_end);
    if (stream.at_end()) return false;
    stream.next();
    if (refuse_empty(stream, raw)) return false;
    do {
        const bool number = stream.peek().kind == TokenKind::number;
        if (number) {
            const bool probability = raw.symbol == "-" && arrow_size() > 0;
            stream.expected("the name of a parameter")
                .with_hint(
                    probability
                        ? probability_hint
                        : fmt::format("use a condition to distinguish values: {0}(n) : n == {1} -> ...",
                                      raw.symbol, stream.peek().text));
            return false;
        }
        const std::optional<Token> name = stream.expect_name("the name of a parameter");
        if (!name) return false;
        names.push_back({name->text, name->span});
    } while (stream.accept(","));
    if (stream.accept(")")) return true;
    stream.expected("',' or ')'");
    return false;
}

std::optional<Expression> LsysStringReader::read_expression(std::size_t end, std::string_view end_name) {
    TokenStream stream = text_.tokens(at_, end, end_name);
    at_ = end;
    std::optional<Expression> result = parse_expression(stream);
    if (!result || stream.at_end()) return result;
    if (stream.at("}"))
        text_.finish(stream);
    else if (stream.at("="))
        stream.expected(end_name).with_hint("write equality as ==");
    else
        stream.expected(end_name);
    return std::nullopt;
}

template<class Module>
bool check_lsys_brackets(const std::vector<Module>& modules, LsysText& text, bool balanced) {
    std::vector<const Module*> branches, polygons;
    for (const Module& module : modules) {
        const bool opens = module.symbol == "[" || module.symbol == "{";
        if (!opens && module.symbol != "]" && module.symbol != "}") continue;
        const bool is_branch = module.symbol == "[" || module.symbol == "]";
        std::vector<const Module*>& open = is_branch ? branches : polygons;
        if (opens) {
            open.push_back(&module);
            if (open.size() <= max_lsys_nesting) continue;
            text.diagnostics.error(module.span,
                                   fmt::format("brackets nest more than {} deep", max_lsys_nesting));
            return false;
        }
        if (!open.empty()) {
            open.pop_back();
        } else if (is_branch) {
            if (!balanced) continue;
            text.diagnostics.error(module.span, "']' without '['");
            return false;
        } else if (!text.closed_polygon) {
            text.closed_polygon = module.span;
        }
    }
    if (!polygons.empty() && !text.open_polygon) text.open_polygon = polygons.back()->span;
    if (branches.empty() || !balanced) return true;
    text.diagnostics.error(branches.back()->span, "this '[' is not closed");
    return false;
}

template bool check_lsys_brackets(const std::vector<LsysModule>& modules, LsysText& text, bool balanced);
template bool check_lsys_brackets(const std::vector<LsysFormal>& modules, LsysText& text, bool balanced);

void LsysBrackets::add(std::string_view symbol) {
    if (symbol == "[") ++open;
    if (symbol != "]") return;
    if (open > 0)
        --open;
    else
        ++closed;
}

} // namespace graftal
