#include "compiler/import/fractint/system.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/support/printable.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// Letters q and i, in any order, then digits and dots, as Fractint reads numbers.
std::string number_at(std::string_view text, std::size_t& at) {
    const std::size_t begin = at;
    for (int i = 0; i < 2 && at < text.size() && (text[at] == 'q' || text[at] == 'i'); ++i)
        ++at;
    while (at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) || text[at] == '.'))
        ++at;
    return std::string(text.substr(begin, at - begin));
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
        return std::move(system_);
    }

  private:
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
            if (!comment.empty()) system_.remarks.emplace_back(comment, whole);
            return;
        }
        if (word.text == "axiom") {
            const Word text = next_word(line, statement, at, " \t");
            system_.axiom = string_of(text);
            system_.axiom_span = text.span;
            system_.axiom_comment = comment;
        } else if (word.text == "angle") {
            const Word number = next_word(line, statement, at, " \t=");
            system_.angle = std::atoi(code_.signs(number.text, number.span).substr(0, 6).c_str());
            system_.angle_span = number.span;
            system_.angle_comment = comment;
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
        if (fractint_reserved.find(letter) != std::string_view::npos) {
            file_.diagnostics.error(word.span,
                                    fmt::format("'{}' has a fixed meaning and takes no rule", letter));
            return;
        }
        FractintString string = string_of(successor);
        const auto known = std::ranges::find(system_.rules, letter, &FractintRule::letter);
        if (known == system_.rules.end()) {
            system_.rules.push_back({letter, std::move(string), join(word.span, successor.span), comment});
            return;
        }
        // Fractint joins the texts, so that a number may go on in the next rule; only brackets are its own.
        known->successor.insert(known->successor.end(), string.begin(), string.end());
        if (!comment.empty()) known->comment += (known->comment.empty() ? "" : " ") + comment;
    }

    FractintString string_of(const Word& word) {
        FractintString string;
        for (std::size_t at = 0; at < word.text.size();) {
            const std::size_t begin = at;
            const std::string signs = code_.next(word.text, at, word.span.begin);
            for (std::size_t i = 0; i + 1 < signs.size(); ++i)
                string.push_back({signs[i], {}, file_.span(word.span.begin + begin, word.span.begin + at)});
            if (signs.empty()) continue;
            FractintSymbol symbol{signs.back(), {}, {}};
            if (takes_number(symbol.letter)) symbol.number = number_at(word.text, at);
            symbol.span = file_.span(word.span.begin + begin, word.span.begin + at);
            string.push_back(std::move(symbol));
        }
        return string;
    }

    /// Each string is drawn by itself, so that its brackets pair up within it: what is open at its end is
    /// closed there, and a bracket that closes nothing ends it.
    void balance(FractintString& string) {
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < string.size(); ++i) {
            if (string[i].letter == '[') open.push_back(i);
            if (string[i].letter != ']') continue;
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
            string.push_back({']', {}, end});
    }

    void check() {
        balance(system_.axiom);
        for (FractintRule& rule : system_.rules)
            balance(rule.successor);
        const Span name = model_.span;
        const Span head{name.file, name.begin, std::min(name.begin + 1, name.end)};
        if (system_.axiom.empty())
            file_.diagnostics.error(head, fmt::format("'{}' has no axiom", model_.name));
        if (system_.angle < 3 || system_.angle > 50)
            file_.diagnostics
                .error(system_.angle_span.known() ? system_.angle_span : head,
                       "the angle of an L-system is a whole number from 3 to 50: parts of a full turn")
                .with_hint("write 'Angle 6' for turns of 60 degrees");
    }

    const ForeignFile& file_;
    CodeReader code_;
    const ForeignModel& model_;
    FractintSystem system_;
};

} // namespace

bool takes_number(char letter) {
    return std::string_view("/\\@c<>").find(letter) != std::string_view::npos;
}

std::optional<FractintSystem> read_fractint_system(const ForeignFile& file, const ForeignModel& model) {
    return FractintReader(file, model).read();
}

} // namespace graftal
