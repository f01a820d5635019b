#include "compiler/import/fractint/system.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/foreign_text.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

/// A model's order is not in its file. The translation has the largest that draws no more lines than this.
constexpr double most_lines = 8000;
constexpr int most_steps = 14;

/// The first sixteen of Fractint's palette.
constexpr std::array<std::string_view, 16> ega_names = {
    "black",     "blue",          "green",     "cyan",       "red",         "magenta",
    "brown",     "light_grey",    "dark_grey", "light_blue", "light_green", "light_cyan",
    "light_red", "light_magenta", "yellow",    "white"};

/// The linear light of such a colour, whose bits are blue, green, red and intensity. Brown has less green.
std::string ega_colour(std::size_t number) {
    const bool light = number > 7;
    const auto part = [&](std::size_t bit) {
        return (number & bit) != 0 ? (light ? 1 : 0.4) : (light ? 0.09 : 0);
    };
    return fmt::format("{}, {}, {}", part(4), number == 6 ? 0.09 : part(2), part(1));
}

class FractintWriter {
  public:
    FractintWriter(const ForeignFile& file, const ForeignModel& model, const FractintSystem& system)
        : file_(file), model_(model), system_(system) {}

    Translation write() {
        gather();
        Translation out{"lsys", {}, {}};
        out.line(fmt::format("# {}: an L-system of Fractint", comment_text(model_.name)), model_.span);
        for (const auto& [remark, span] : system_.remarks)
            out.line("# " + remark, span);
        if (uses("c<>")) {
            out.line("background: 0, 0, 0");
            for (std::size_t i = 0; i < ega_names.size(); ++i)
                out.line(fmt::format("material {} {{ color: {}  ambient: 1  diffuse: 0 }}", ega_names[i],
                                     ega_colour(i)));
        }
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (const std::string names = declared(); !names.empty()) out.line("  modules " + names);
        if (uses("c<>")) out.line(fmt::format("  colors {}", fmt::join(ega_names, ", ")));
        out.line(fmt::format("  angle 360/{}{}", system_.angle, remark_text(system_.angle_comment)),
                 system_.angle_span);
        const auto [steps, lines] = steps_to_draw();
        out.line(fmt::format(
            "  steps {}{}", steps,
            remark_text(fmt::format("Fractint's order; with this it draws {:.0f} lines", lines))));
        out.line(fmt::format("  axiom {}{}{}", beginning(), text_of(system_.axiom),
                             remark_text(system_.axiom_comment)),
                 system_.axiom_span);
        for (const FractintRule& rule : system_.rules) {
            const std::string successor = text_of(rule.successor);
            out.line(fmt::format("  {} -> {}{}", name_of(rule.letter), successor.empty() ? "*" : successor,
                                 remark_text(rule.comment)),
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
            if (!used_[static_cast<std::size_t>(c)] ||
                fractint_reserved.find(letter) != std::string_view::npos)
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
        const double value = leading_number(digits.substr(0, digits.find('.', digits.find('.') + 1))).value;
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

} // namespace

Translation write_fractint_system(const ForeignFile& file, const ForeignModel& model,
                                  const FractintSystem& system) {
    return FractintWriter(file, model, system).write();
}

} // namespace graftal
