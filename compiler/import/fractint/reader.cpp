#include "compiler/import/fractint/system.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/support/printable.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// Symbols that the turtle knows, or that have another meaning.
constexpr std::string_view reserved = "+-/\\@|!c<>][";

/// Capital symbols that a number may follow.
constexpr std::string_view with_number = "/\\@C<>";

/// The symbol of a small letter: a capital, except for t, since T is another command in our strings.
std::string symbol_of(char letter) {
    const bool rises = letter >= 'a' && letter <= 'z' && letter != 't';
    return std::string(1, rises ? static_cast<char>(letter - 'a' + 'A') : letter);
}

/// Letters q and i, in any order, then digits and dots, as Fractint reads numbers.
std::string number_at(std::string_view text, std::size_t& at) {
    const std::size_t begin = at;
    for (int i = 0; i < 2 && at < text.size() && (text[at] == 'q' || text[at] == 'i'); ++i)
        ++at;
    while (at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) || text[at] == '.'))
        ++at;
    return std::string(text.substr(begin, at - begin));
}

/// Expression of ours for such a number.
std::string number_text(std::string_view digits) {
    bool root = false, inverse = false;
    for (; !digits.empty() && (digits[0] == 'q' || digits[0] == 'i'); digits.remove_prefix(1))
        (digits[0] == 'q' ? root : inverse) = true;
    const double value = leading_number(digits.substr(0, digits.find('.', digits.find('.') + 1))).value;
    std::string text = value > 0 ? fmt::format("{}", value) : "0";
    if (value > 0 && root) text = fmt::format("sqrt({})", text);
    if (value > 0 && inverse) text = "1/" + text;
    return text;
}

class FractintReader {
  public:
    FractintReader(const ForeignFile& file, const ForeignModel& model)
        : file_(file), code_(file), model_(model) {}

    std::optional<FractintSystem> read() {
        const std::size_t errors = file_.diagnostics.error_count();
        for (const TextLine& line : lines_of(file_.text(), model_.span.begin, model_.span.end)) {
            if (file_.diagnostics.full()) break;
            read_line(line);
        }
        if (file_.diagnostics.error_count() == errors) check();
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return std::move(fractint_);
    }

  private:
    LSystem& system() { return fractint_.system; }
    std::vector<LSystemProduction>& productions() {
        return system().productions[LSystemSection::productions];
    }

    /// A word of the line from `at` on, and where it stands.
    struct Word {
        std::string text; ///< in small letters
        Span span;
    };

    Word next_word(const TextLine& line, std::string_view statement, std::size_t& at,
                   std::string_view between) {
        at = std::min(statement.find_first_not_of(between, at), statement.size());
        const std::size_t begin = at;
        at = std::min(statement.find_first_of(between, at), statement.size());
        return {in_small_letters(statement.substr(begin, at - begin)),
                file_.span(line.begin + begin, line.begin + at)};
    }

    void read_line(const TextLine& line) {
        const std::size_t semicolon = std::min(line.text.find(';'), line.text.size());
        const std::string_view statement = line.text.substr(0, semicolon);
        const std::string comment =
            semicolon < line.text.size() ? comment_text(line.text.substr(semicolon + 1)) : std::string();
        std::size_t at = 0;
        const Word word = next_word(line, statement, at, " =\t");
        const Span whole = file_.span(line.begin, line.begin + statement.size());
        if (word.text.empty()) {
            if (!comment.empty()) system().head_comments.emplace_back(comment, whole);
            return;
        }
        if (word.text == "axiom") {
            const Word text = next_word(line, statement, at, " \t");
            system().axiom = string_of(text);
            system().axiom_span = text.span;
            system().axiom_remark = comment;
        } else if (word.text == "angle") {
            const Word number = next_word(line, statement, at, " \t=");
            fractint_.angle = std::atoi(code_.signs(number.text, number.span).substr(0, 6).c_str());
            fractint_.angle_span = number.span;
            fractint_.angle_remark = comment;
        } else if (is_symbol(word.text)) {
            add_rule(word, next_word(line, statement, at, " =\t"), comment);
        } else {
            file_.diagnostics
                .error(word.span, fmt::format("'{}' begins no statement of an L-system", word.text))
                .with_hint("a statement is 'Angle n', 'Axiom string' or 'letter=string', on its own line");
            return;
        }
        const Word extra = next_word(line, statement, at, " \t");
        if (!extra.text.empty())
            file_.diagnostics.warning(extra.span, "this text behind the statement has no meaning");
    }

    static bool is_symbol(std::string_view word) { return code_point(word, 0).size == word.size(); }

    void add_rule(const Word& word, const Word& successor, const std::string& comment) {
        const std::string signs = code_.signs(word.text, word.span);
        if (signs.size() != 1) return;
        const char letter = signs[0];
        if (reserved.find(letter) != std::string_view::npos) {
            file_.diagnostics.error(word.span,
                                    fmt::format("'{}' has a fixed meaning and takes no rule", letter));
            return;
        }
        LSystemString string = string_of(successor);
        const std::string symbol = symbol_of(letter);
        for (LSystemProduction& known : productions()) {
            if (known.predecessor[0].symbol != symbol) continue;
            // Fractint joins the texts, so that a number may go on in the next rule.
            known.successor.insert(known.successor.end(), string.begin(), string.end());
            if (!comment.empty()) known.remark += (known.remark.empty() ? "" : " ") + comment;
            return;
        }
        LSystemProduction& production = productions().emplace_back();
        production.predecessor.emplace_back().symbol = symbol;
        production.successor = std::move(string);
        production.span = join(word.span, successor.span);
        production.remark = comment;
    }

    LSystemString string_of(const Word& word) {
        LSystemString string;
        for (std::size_t at = 0; at < word.text.size();) {
            const std::size_t begin = at;
            const std::string signs = code_.next(word.text, at, word.span.begin);
            for (const char sign : signs)
                string.emplace_back().symbol = symbol_of(sign);
            if (!signs.empty() && with_number.find(string.back().symbol[0]) != std::string_view::npos)
                string.back().parameters.push_back(number_at(word.text, at));
            for (std::size_t i = string.size() - signs.size(); i < string.size(); ++i)
                string[i].span = file_.span(word.span.begin + begin, word.span.begin + at);
        }
        return string;
    }

    /// Each string is drawn by itself, so that its brackets pair up within it: what is open at its end is
    /// closed there, and a bracket that closes nothing ends it.
    void balance(LSystemString& string) {
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < string.size(); ++i) {
            if (string[i].symbol == "[") open.push_back(i);
            if (string[i].symbol != "]") continue;
            if (open.empty()) {
                file_.diagnostics.warning(string[i].span,
                                          "this bracket closes nothing: it ends the string, as in "
                                          "Fractint");
                string.resize(i);
                break;
            }
            open.pop_back();
        }
        if (open.empty()) return;
        file_.diagnostics.warning(string[open.back()].span,
                                  "this bracket is never closed: the string ends it");
        const Span end = string.back().span;
        for (std::size_t i = 0; i < open.size(); ++i)
            string.push_back({"]", {}, false, end});
    }

    /// Makes numbers expressions of ours. `odd_reversed`: the angle is odd, and '!' reverses turns.
    void take_numbers(LSystemString& string, bool odd_reversed) {
        for (LSystemModule& module : string) {
            if (module.symbol == "|" && odd_reversed)
                file_.diagnostics.error(module.span,
                                        "'|' with an odd angle in a model that reverses turns by '!' has no "
                                        "translation");
            if (module.parameters.empty()) continue;
            std::string& number = module.parameters[0];
            const bool colour = std::string_view("C<>").find(module.symbol) != std::string_view::npos;
            number = colour ? colour_text(module) : number_text(number);
            if (module.symbol == "@" && number == "0")
                file_.diagnostics.error(module.span, "'@' needs a number above 0: @0.5, @I2, @Q2, @IQ2");
        }
    }

    std::string colour_text(const LSystemModule& module) {
        const int number = std::min(std::atoi(module.parameters[0].substr(0, 6).c_str()), 255);
        if (module.symbol == "C" && number > 15)
            file_.diagnostics.warning(module.span, fmt::format("colour {} becomes colour {}: of Fractint's "
                                                               "palette the first 16 are known here",
                                                               number, number % 16));
        return std::to_string(number % 16);
    }

    void check() {
        std::vector<LSystemString*> strings = {&system().axiom};
        for (LSystemProduction& production : productions())
            strings.push_back(&production.successor);
        for (LSystemString* const string : strings)
            balance(*string);
        const bool odd_reversed = fractint_.angle % 2 != 0 && uses_any(system(), "!");
        for (LSystemString* const string : strings)
            take_numbers(*string, odd_reversed);
        const Span name = model_.span;
        const Span head{name.file, name.begin, std::min(name.begin + 1, name.end)};
        if (system().axiom.empty())
            file_.diagnostics.error(head, fmt::format("'{}' has no axiom", model_.name));
        if (fractint_.angle < 3 || fractint_.angle > 50)
            file_.diagnostics
                .error(fractint_.angle_span.known() ? fractint_.angle_span : head,
                       "the angle of an L-system is a whole number from 3 to 50: parts of a full turn")
                .with_hint("write 'Angle 6' for turns of 60 degrees");
    }

    const ForeignFile& file_;
    CodeReader code_;
    const ForeignModel& model_;
    FractintSystem fractint_;
};

} // namespace

bool uses_any(const LSystem& system, std::string_view symbols) {
    const auto in = [&](const LSystemString& string) {
        return std::ranges::any_of(string, [&](const LSystemModule& module) {
            return symbols.find(module.symbol) != std::string_view::npos;
        });
    };
    return in(system.axiom) || std::ranges::any_of(system.productions, [&](const auto& section) {
               return std::ranges::any_of(section.second, [&](const LSystemProduction& production) {
                   return in(production.predecessor) || in(production.successor);
               });
           });
}

std::optional<FractintSystem> read_fractint_system(const ForeignFile& file, const ForeignModel& model) {
    return FractintReader(file, model).read();
}

} // namespace graftal
