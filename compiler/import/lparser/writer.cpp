#include "compiler/import/lparser/system.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/lparser/commands.h"

namespace graftal {

namespace {

/// The sixteen colours of a model that has none of its own: red, green and blue of a screen.
constexpr std::array<double, 48> usual = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.8,  0.4,  0.4,  0.8, 0.8, 0.4,
                                          0.4, 0.8, 0.4, 0.4, 0.8, 0.8, 0.4,  0.4,  0.8,  0.8, 0.4, 0.8,
                                          0.2, 0.5, 0.2, 0.2, 0.5, 0.5, 0.2,  0.2,  0.5,  0.5, 0.2, 0.5,
                                          0.6, 0.2, 0.2, 0.5, 0.5, 0.5, 0.75, 0.75, 0.75, 1,   1,   1};

class LparserWriter {
  public:
    LparserWriter(const ForeignFile& file, const ForeignModel& model, const LparserSystem& system)
        : file_(file), model_(model), system_(system) {}

    Translation write() {
        gather();
        check_digits();
        Translation out{"lsys", {}, {}};
        comments(out, system_.head, "");
        const int colours = write_materials(out);
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (const std::string names = declared(); !names.empty()) out.line("  modules " + names);
        write_settings(out, colours);
        out.line(fmt::format("  axiom {}{}{}{}", system_.switch_yz ? "@F" : "", ";(2)",
                             text_of(system_.axiom), remark_text(system_.axiom_comment)),
                 system_.axiom_span);
        for (const LparserRule& rule : system_.rules)
            write_rule(out, rule);
        comments(out, system_.tail, "  ");
        write_meanings(out);
        out.line("}");
        return out;
    }

  private:
    void gather() {
        for (const LparserRule& rule : system_.rules)
            ruled_.insert(rule.letter);
        look(system_.axiom);
        for (const LparserRule& rule : system_.rules)
            look(rule.successor);
        // A number behind a symbol stays behind the last symbol of its successor.
        for (bool grows = true; grows;) {
            grows = false;
            for (const LparserRule& rule : system_.rules) {
                if (!numbered_.contains(rule.letter) || rule.successor.empty()) continue;
                const LparserSymbol& last = rule.successor.back();
                if (!last.number) grows = numbered_.insert(last.letter).second || grows;
            }
        }
        find_plain();
    }

    /// Without the last symbol where a number of the symbol that becomes the string stands behind it.
    void look_for_plain(const LparserString& string, bool last_too) {
        for (std::size_t i = 0; i + (last_too ? 0 : 1) < string.size(); ++i)
            if (!string[i].number) plain_.insert(string[i].letter);
    }

    void find_plain() {
        look_for_plain(system_.axiom, true);
        std::size_t known = 0;
        do {
            known = plain_.size();
            for (const LparserRule& rule : system_.rules) {
                const bool plain = plain_.contains(rule.letter) || !numbered_.contains(rule.letter);
                look_for_plain(rule.successor, plain);
            }
        } while (plain_.size() > known);
    }

    void look(const LparserString& string) {
        for (const LparserSymbol& symbol : string) {
            used_.insert(symbol.letter);
            if (symbol.number) numbered_.insert(symbol.letter);
            if (symbol.number) digits_ += *symbol.number;
        }
    }

    /// The program rewrites the digits of numbers too.
    void check_digits() {
        for (const LparserRule& rule : system_.rules)
            if (digits_.find(rule.letter) != std::string::npos)
                file_.diagnostics
                    .error(rule.span, fmt::format("this rule would rewrite the '{}' of numbers", rule.letter))
                    .with_hint("give the symbol another letter");
    }

    bool has_rule(char letter) const { return ruled_.contains(letter); }

    static void comments(Translation& out, const std::vector<LparserLine>& lines, const char* indent) {
        for (const LparserLine& line : lines)
            out.line(fmt::format("{}# {}", indent, line.comment), line.span);
    }

    /// Writes the materials; gives their number.
    int write_materials(Translation& out) {
        std::map<int, const LparserColour*> own;
        int count = static_cast<int>(usual.size() / 3);
        for (const LparserColour& colour : system_.colours) {
            own[colour.index] = &colour;
            count = std::max(count, colour.index + 1);
        }
        for (int i = 0; i < count; ++i) {
            const auto known = own.find(i);
            std::array<double, 3> rgb{};
            for (std::size_t k = 0; k < 3; ++k)
                rgb[k] = known == own.end() ? usual[i < 16 ? 3 * static_cast<std::size_t>(i) + k : k]
                                            : known->second->rgb[k] / 255.0;
            out.line(fmt::format("material colour{} {{ color: {} }}", i, linear_text(rgb)),
                     known == own.end() ? Span() : known->second->span);
        }
        return count;
    }

    void write_settings(Translation& out, int colours) {
        std::string names = "colour0";
        for (int i = 1; i < colours; ++i)
            names += fmt::format(", colour{}", i);
        out.line("  colors " + names);
        const auto number = [&](const char* statement, const LparserNumber& of, double value,
                                const char* more = "") {
            out.line(fmt::format("  {} {}{}{}", statement, value, more, remark_text(of.comment)), of.span);
        };
        if (!(system_.recursion.value >= 0 && system_.recursion.value == std::floor(system_.recursion.value)))
            file_.diagnostics.error(system_.recursion.span,
                                    "a recursion depth that is no whole number has no "
                                    "translation");
        if (!(system_.thickness.value > 0))
            file_.diagnostics.error(system_.thickness.span, "a thickness must be above 0");
        number("steps", system_.recursion, system_.recursion.value);
        number("angle", system_.angle, system_.angle.value);
        number("thickness", system_.thickness, system_.thickness.value, "/100");
        if (system_.least_thickness && system_.least_thickness->value > 0)
            number("thinnest", *system_.least_thickness, system_.least_thickness->value, "/100");
        if (!system_.has_keywords) out.line("  step 100");
    }

    void write_rule(Translation& out, const LparserRule& rule) {
        comments(out, rule.before, "  ");
        if (std::string_view("[]()").find(rule.letter) != std::string_view::npos) {
            file_.diagnostics.error(rule.span,
                                    fmt::format("a rule for '{}' has no translation", rule.letter));
            return;
        }
        const std::string name = name_of(rule.letter);
        const std::string successor = text_of(rule.successor);
        const std::string said = remark_text(rule.comment);
        const bool plain = plain_.contains(rule.letter) || !numbered_.contains(rule.letter);
        if (plain)
            out.line(fmt::format("  {} -> {}{}", name, successor.empty() ? "*" : successor, said), rule.span);
        if (!numbered_.contains(rule.letter)) return;
        std::string numbered = successor;
        if (!rule.successor.empty() && !rule.successor.back().number) {
            LparserString string = rule.successor;
            string.back().number = "x";
            numbered = text_of(string);
        }
        out.line(fmt::format("  {}(x) -> {}{}", name, numbered.empty() ? "*" : numbered, plain ? "" : said),
                 rule.span);
    }

    void write_meanings(Translation& out) {
        std::vector<std::string> lines;
        if (draws_in_polygons()) { // a Z becomes an F
            if (plain_.contains('F') || plain_.contains('Z')) lines.emplace_back("F -> @E");
            if (numbered_.contains('F') || numbered_.contains('Z')) lines.emplace_back("F(l) -> @E(l)");
        }
        for (const auto& [symbol, plain, numbered] : lparser_meanings) {
            const bool becomes_number = symbol == '~' && used_.contains(symbol);
            if (plain_.contains(symbol)) lines.emplace_back(plain);
            if (numbered_.contains(symbol) || becomes_number) lines.emplace_back(numbered);
        }
        for (const char letter : ruled_) {
            const LparserCommand* const command = lparser_command(letter);
            if (!command || keeps_name(letter)) continue;
            if (plain_.contains(letter))
                lines.push_back(fmt::format("{} -> {}", name_of(letter), command->text));
            if (numbered_.contains(letter) && *command->with_number)
                lines.push_back(
                    fmt::format("{}(x) -> {}", name_of(letter), with_number(command->with_number, "x")));
        }
        if (lines.empty()) return;
        out.line("  interpret {");
        for (const std::string& line : lines)
            out.line("    " + line);
        out.line("  }");
    }

    /// Whether a block may be drawn between braces: there is more between them than moves and turns.
    bool draws_in_polygons() const {
        if (!used_.contains('F') && !used_.contains('Z')) return false;
        const auto draws = [&](const LparserString& string) {
            int depth = 0;
            for (const LparserSymbol& symbol : string) {
                depth += (symbol.letter == '{') - (symbol.letter == '}');
                if (symbol.letter == 'F' || symbol.letter == 'Z' ||
                    (has_rule(symbol.letter) && symbol.letter != 'f'))
                    if (depth > 0) return true;
            }
            return depth != 0;
        };
        return draws(system_.axiom) || std::ranges::any_of(system_.rules, [&](const LparserRule& rule) {
                   return draws(rule.successor);
               });
    }

    /// Whether a command is one module of ours, that may have productions.
    static bool keeps_name(char letter) {
        return std::string_view("FfgZzt+-&^|").find(letter) != std::string_view::npos;
    }

    std::string name_of(char letter) const {
        if (keeps_name(letter)) return std::string(1, letter);
        if (letter == 'G' || letter == 'T') return std::string(2, letter); // they are commands in our strings
        return symbol_name(letter);
    }

    std::string declared() const {
        std::string names;
        std::set<char> all = used_;
        all.insert(ruled_.begin(), ruled_.end());
        for (const char letter : all) {
            const LparserCommand* const command = lparser_command(letter);
            if (command && (!has_rule(letter) || keeps_name(letter)) &&
                std::string_view("Zzt").find(letter) == std::string_view::npos)
                continue;
            const std::string name = name_of(letter);
            if (name.size() > 1 || !has_rule(letter))
                names += fmt::format("{}{}", names.empty() ? "" : " ", name);
        }
        if (used_.contains('~')) names += std::string(names.empty() ? "" : " ") + "Shake";
        return names;
    }

    static std::string with_number(std::string_view pattern, std::string_view number) {
        std::string text(pattern);
        return text.replace(text.find('%'), 1, number);
    }

    std::string text_of(const LparserString& string) {
        std::string text;
        for (const LparserSymbol& symbol : string)
            text += text_of(symbol);
        return text;
    }

    std::string text_of(const LparserSymbol& symbol) {
        const LparserCommand* const command = lparser_command(symbol.letter);
        if (!command || (has_rule(symbol.letter) && !keeps_name(symbol.letter))) {
            const std::string name = name_of(symbol.letter);
            return symbol.number ? fmt::format("{}({})", name, number_of(symbol)) : name;
        }
        if (!symbol.number) return command->text;
        if (*command->with_number) return with_number(command->with_number, number_of(symbol));
        if (*symbol.number != "x")
            file_.diagnostics.warning(symbol.span,
                                      fmt::format("the number of '{}' means nothing", symbol.letter));
        return command->text;
    }

    /// The number as scanf reads it, without the text behind it; 0 without a number.
    std::string number_of(const LparserSymbol& symbol) {
        if (*symbol.number == "x") return "x";
        const std::string text = symbol.number->substr(0, 40);
        const auto [value, length] = leading_number(text);
        if (length == 0 || length != text.size() || !std::isfinite(value))
            file_.diagnostics.warning(symbol.span,
                                      fmt::format("'{}' is read as the number {}", comment_text(text),
                                                  std::isfinite(value) ? value : 0));
        return fmt::format("{}", std::isfinite(value) ? value : 0);
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    const LparserSystem& system_;
    std::set<char> used_;
    std::set<char> ruled_;
    std::set<char> plain_;    ///< may have no number behind them
    std::set<char> numbered_; ///< may have a number behind them
    std::string digits_;      ///< of all numbers
};

} // namespace

Translation write_lparser(const ForeignFile& file, const ForeignModel& model, const LparserSystem& system) {
    return LparserWriter(file, model, system).write();
}

} // namespace graftal
