#include "compiler/import/fractint_lsystem.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/importers.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// A model's order is not in its file. The translation has the largest that draws no more lines than this.
constexpr double most_lines = 8000;
constexpr int most_steps = 14;
constexpr std::size_t most_bytes = 1'000'000; ///< of a model: its strings have fewer modules than ours may

constexpr std::string_view reserved = "+-/\\@|!c<>][";

/// One symbol of a string, with the number that belongs to it as it is written.
struct FractintSymbol {
    char letter = 0; ///< a small one
    std::string number;
    Span span;
};

using FractintString = std::vector<FractintSymbol>;

struct FractintRule {
    char letter = 0;
    FractintString successor; ///< of all rules for the letter, one after the other
    Span span;
    std::string comment;
};

struct FractintSystem {
    int angle = 0;
    Span angle_span;
    std::string angle_comment;
    FractintString axiom;
    Span axiom_span;
    std::string axiom_comment;
    std::vector<FractintRule> rules;                   ///< in the order of their first lines
    std::vector<std::pair<std::string, Span>> remarks; ///< comments before the first statement
};

bool takes_number(char letter) {
    return std::string_view("/\\@c<>").find(letter) != std::string_view::npos;
}

// ------------------------------------------------------------------------------------------------- reading

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
    FractintReader(const ForeignFile& file, const ForeignModel& model) : file_(file), model_(model) {}

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
            system_.angle = std::atoi(number.text.substr(0, 6).c_str());
            system_.angle_span = number.span;
            system_.angle_comment = comment;
        } else if (word.text.size() == 1) {
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

    void add_rule(const Word& word, const Word& successor, const std::string& comment) {
        const char letter = word.text[0];
        if (reserved.find(letter) != std::string_view::npos) {
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
            FractintSymbol symbol{word.text[at++], {}, {}};
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
    const ForeignModel& model_;
    FractintSystem system_;
};

// ------------------------------------------------------------------------------------------------- writing

struct EgaColour {
    const char* name;
    const char* rgb;
};

/// The first sixteen of Fractint's palette, as linear light.
constexpr std::array<EgaColour, 16> ega_colours = {{{"black", "0, 0, 0"},
                                                    {"blue", "0, 0, 0.4"},
                                                    {"green", "0, 0.4, 0"},
                                                    {"cyan", "0, 0.4, 0.4"},
                                                    {"red", "0.4, 0, 0"},
                                                    {"magenta", "0.4, 0, 0.4"},
                                                    {"brown", "0.4, 0.09, 0"},
                                                    {"light_grey", "0.4, 0.4, 0.4"},
                                                    {"dark_grey", "0.09, 0.09, 0.09"},
                                                    {"light_blue", "0.09, 0.09, 1"},
                                                    {"light_green", "0.09, 1, 0.09"},
                                                    {"light_cyan", "0.09, 1, 1"},
                                                    {"light_red", "1, 0.09, 0.09"},
                                                    {"light_magenta", "1, 0.09, 1"},
                                                    {"yellow", "1, 1, 0.09"},
                                                    {"white", "1, 1, 1"}}};

class FractintWriter {
  public:
    FractintWriter(const ForeignFile& file, const ForeignModel& model, const FractintSystem& system)
        : file_(file), model_(model), system_(system) {}

    std::optional<Translation> write() {
        gather();
        Translation out{"lsys", {}, {}};
        out.line(fmt::format("# {}: an L-system of Fractint", comment_text(model_.name)), model_.span);
        for (const auto& [remark, span] : system_.remarks)
            out.line("# " + remark, span);
        if (uses("c<>")) {
            out.line("background: 0, 0, 0");
            for (const EgaColour& colour : ega_colours)
                out.line(fmt::format("material {} {{ color: {}  ambient: 1  diffuse: 0 }}", colour.name,
                                     colour.rgb));
        }
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (const std::string names = declared(); !names.empty()) out.line("  modules " + names);
        if (uses("c<>")) out.line("  colors " + colour_names());
        out.line(fmt::format("  angle 360/{}{}", system_.angle, remark(system_.angle_comment)),
                 system_.angle_span);
        const auto [steps, lines] = steps_to_draw();
        out.line(
            fmt::format("  steps {}{}", steps,
                        remark(fmt::format("Fractint's order; with this it draws {:.0f} lines", lines))));
        out.line(
            fmt::format("  axiom {}{}{}", beginning(), text_of(system_.axiom), remark(system_.axiom_comment)),
            system_.axiom_span);
        for (const FractintRule& rule : system_.rules) {
            const std::string successor = text_of(rule.successor);
            out.line(fmt::format("  {} -> {}{}", name_of(rule.letter), successor.empty() ? "*" : successor,
                                 remark(rule.comment)),
                     rule.span);
        }
        if (two_headings_) {
            if (used_['d']) out.line("  interpret D -> @XF@X   # along the second heading");
            if (used_['m']) out.line("  interpret M -> @Xf@X");
        }
        out.line("}");
        return out;
    }

  private:
    void gather() {
        const auto look = [&](const FractintString& string) {
            for (const FractintSymbol& symbol : string)
                used_[static_cast<unsigned char>(symbol.letter)] = true;
        };
        look(system_.axiom);
        for (const FractintRule& rule : system_.rules) {
            look(rule.successor);
            used_[static_cast<unsigned char>(rule.letter)] = true;
        }
        two_headings_ = uses("dm\\/") && uses("fg+-|");
    }

    bool uses(std::string_view letters) const {
        return std::ranges::any_of(letters, [&](char c) { return used_[static_cast<unsigned char>(c)]; });
    }

    bool has_rule(char letter) const {
        return std::ranges::find(system_.rules, letter, &FractintRule::letter) != system_.rules.end();
    }

    static std::string remark(const std::string& comment) {
        return comment.empty() ? std::string() : "   # " + comment;
    }

    std::string colour_names() const {
        std::string names;
        for (const EgaColour& colour : ega_colours)
            names += fmt::format("{}{}", names.empty() ? "" : ", ", colour.name);
        return names;
    }

    /// Fractint's turtle heads to the right at first, and its colour is the last of sixteen.
    std::string beginning() const {
        std::string text = two_headings_ ? "-(90)@X-(90)@X " : "-(90)";
        if (uses("c<>")) text += ";(15)";
        return text;
    }

    std::string name_of(char letter) const {
        if (letter == 'g') return "f";
        if (!two_headings_ && letter == 'd') return "F";
        if (!two_headings_ && letter == 'm') return "f";
        if (letter == 't') return "t"; // T is another command in our strings
        const std::string name = symbol_name(letter);
        return name.size() > 1 ? name : std::string(1, static_cast<char>(std::toupper(name[0])));
    }

    /// Names that stand for a module, in our language, only where they are declared.
    std::string declared() const {
        std::string names;
        const auto add = [&](const std::string& name) {
            names += fmt::format("{}{}", names.empty() ? "" : " ", name);
        };
        for (int c = 0; c < 256; ++c) {
            const auto letter = static_cast<char>(c);
            if (!used_[static_cast<std::size_t>(c)] || reserved.find(letter) != std::string_view::npos)
                continue;
            if (std::string_view("fgdm").find(letter) != std::string_view::npos) continue;
            const std::string name = name_of(letter);
            if (name.size() > 1 || !has_rule(letter)) add(name);
        }
        return names;
    }

    std::string number_of(const FractintSymbol& symbol) const {
        std::string_view digits = symbol.number;
        bool root = false, inverse = false;
        for (; !digits.empty() && (digits[0] == 'q' || digits[0] == 'i'); digits.remove_prefix(1))
            (digits[0] == 'q' ? root : inverse) = true;
        const double value = std::strtod(
            std::string(digits.substr(0, digits.find('.', digits.find('.') + 1))).c_str(), nullptr);
        std::string text = value > 0 ? fmt::format("{}", value) : "0";
        if (value > 0 && root) text = fmt::format("sqrt({})", text);
        if (value > 0 && inverse) text = "1/" + text;
        return text;
    }

    std::string text_of(const FractintString& string) {
        std::string text;
        for (const FractintSymbol& symbol : string)
            text += text_of(symbol);
        return text;
    }

    std::string turn(char sign, const std::string& degrees) const {
        return two_headings_ ? fmt::format("@X{}({})@X", sign, degrees)
                             : fmt::format("{}({})", sign, degrees);
    }

    std::string text_of(const FractintSymbol& symbol) {
        switch (symbol.letter) {
        case '+':
        case '-':
        case '[':
        case ']':
            return std::string(1, symbol.letter);
        case '\\':
            return turn('+', number_of(symbol));
        case '/':
            return turn('-', number_of(symbol));
        case '|':
            return half_turn(symbol.span);
        case '!':
            return "@F";
        case '@':
            return scaling(symbol);
        case 'c':
        case '<':
        case '>':
            return colour(symbol);
        default:
            return name_of(symbol.letter);
        }
    }

    /// The largest turn of at most 180 degrees; Fractint turns it to the right, reversed or not.
    std::string half_turn(Span span) {
        if (system_.angle % 2 == 0) return "|";
        if (uses("!"))
            file_.diagnostics.error(span,
                                    "'|' with an odd angle in a model that reverses turns by '!' has no "
                                    "translation");
        return fmt::format("-({}*360/{})", system_.angle / 2, system_.angle);
    }

    std::string scaling(const FractintSymbol& symbol) {
        const std::string factor = number_of(symbol);
        if (factor == "0")
            file_.diagnostics.error(symbol.span, "'@' needs a number above 0: @0.5, @I2, @Q2, @IQ2");
        return fmt::format("@S({})", factor);
    }

    std::string colour(const FractintSymbol& symbol) {
        const int number = std::min(std::atoi(symbol.number.substr(0, 6).c_str()), 255);
        if (symbol.letter == 'c') {
            if (number > 15)
                file_.diagnostics.warning(symbol.span,
                                          fmt::format("colour {} becomes colour {}: of Fractint's "
                                                      "palette the first 16 are known here",
                                                      number, number % 16));
            return fmt::format(";({})", number % 16);
        }
        return std::string(static_cast<std::size_t>(number % 16), symbol.letter == '<' ? ';' : ',');
    }

    /// Counts symbols, order by order.
    std::pair<int, double> steps_to_draw() const {
        std::array<double, 256> counts{};
        const auto count = [](const FractintString& string, double times, std::array<double, 256>& into) {
            for (const FractintSymbol& symbol : string)
                into[static_cast<unsigned char>(symbol.letter)] += times;
        };
        const auto lines = [](const std::array<double, 256>& of) { return of['f'] + of['d']; };
        count(system_.axiom, 1, counts);
        int steps = 0;
        double drawn = lines(counts), all = 0;
        for (int next = 1; next <= most_steps; ++next) {
            std::array<double, 256> after = counts;
            for (const FractintRule& rule : system_.rules)
                after[static_cast<unsigned char>(rule.letter)] = 0;
            for (const FractintRule& rule : system_.rules)
                count(rule.successor, counts[static_cast<unsigned char>(rule.letter)], after);
            all = 0;
            for (const double number : after)
                all += number;
            if (next > 2 && (lines(after) > most_lines || all > 100 * most_lines)) break;
            counts = after;
            steps = next;
            drawn = lines(counts);
        }
        return {steps, drawn};
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    const FractintSystem& system_;
    std::array<bool, 256> used_{};
    bool two_headings_ = false;
};

// ------------------------------------------------------------------------------------------------ the row

/// Calls `see(name_begin, name_end, body_begin, body_end)` for each block; false where one never ends.
template<typename See> bool each_block(std::string_view text, const See& see) {
    std::size_t name_begin = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == ';') {
            at = std::min(text.find('\n', at), text.size());
            name_begin = at + 1;
        } else if (text[at] == '\n') {
            // A name may stand on the line before the brace.
            const std::size_t next = text.find_first_not_of(" \t\r\n", at);
            const bool blank = trimmed(text.substr(name_begin, at - name_begin)).empty();
            if (blank || next == std::string_view::npos || text[next] != '{') name_begin = at + 1;
        } else if (text[at] == '{') {
            std::size_t end = at + 1;
            while (end < text.size() && text[end] != '}')
                end = text[end] == ';' ? std::min(text.find('\n', end), text.size()) : end + 1;
            see(name_begin, at, at + 1, std::min(end, text.size()));
            if (end >= text.size()) return false;
            at = end;
            name_begin = end + 1;
        }
    }
    return true;
}

std::vector<ForeignModel> fractint_models(const ForeignFile& file) {
    std::vector<ForeignModel> models;
    std::set<std::string> names;
    const std::string_view text = file.text();
    const bool whole = each_block(
        text, [&](std::size_t name_begin, std::size_t name_end, std::size_t begin, std::size_t end) {
            std::string_view name = trimmed(text.substr(name_begin, name_end - name_begin));
            name = trimmed(name.substr(0, name.find_first_of("( \t\r\n")));
            if (name.empty() || in_small_letters(name) == "comment") return;
            if (names.insert(in_small_letters(name)).second)
                models.push_back({std::string(name), file.span(begin, end)});
            else
                file.diagnostics.warning(file.span(name_begin, name_end),
                                         fmt::format("a second '{}': only the first can be named", name));
        });
    if (!whole)
        file.diagnostics.warning(file.span(text.size(), text.size()),
                                 "the last block of the file has no '}'");
    return models;
}

/// A block that has an axiom or an angle, and no colon behind the word, as those of cpfg have.
bool is_fractint_lsystem(std::string_view text) {
    if (is_binary(text)) return false;
    bool found = false;
    each_block(text, [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
        if (found) return;
        for (const TextLine& line : lines_of(text, begin, end)) {
            const std::string small = in_small_letters(trimmed(line.text));
            const bool statement = small.starts_with("axiom") || small.starts_with("angle");
            found = found ||
                    (statement && small.size() > 5 && std::isspace(static_cast<unsigned char>(small[5])));
        }
    });
    return found;
}

std::optional<Translation> translate_fractint(const ForeignFile& file, const ForeignModel& model) {
    if (model.span.end - model.span.begin > most_bytes) {
        file.diagnostics.error(file.span(model.span.begin, model.span.begin),
                               fmt::format("a model has more than {} characters", most_bytes));
        return std::nullopt;
    }
    const std::optional<FractintSystem> system = FractintReader(file, model).read();
    if (!system) return std::nullopt;
    return FractintWriter(file, model, *system).write();
}

constexpr std::string_view fractint_lsystem_endings[] = {"l"};

} // namespace

Importer fractint_lsystem_importer() {
    return {"Fractint L-system", fractint_lsystem_endings, is_fractint_lsystem, fractint_models,
            translate_fractint};
}

} // namespace graftal
