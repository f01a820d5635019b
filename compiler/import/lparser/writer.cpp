#include "compiler/import/lparser/system.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/write/writer.h"
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
    LparserWriter(const ForeignFile& file, const ForeignModel& model, LparserSystem lparser)
        : file_(file), model_(model), lparser_(std::move(lparser)) {}

    Translation write() {
        gather();
        CpfgDialect dialect;
        dialect.same = [](const std::string& symbol) {
            return std::string_view("Ffg+-&^|").find(symbol) == std::string_view::npos ? "" : symbol;
        };
        dialect.told = [&](const LSystemModule& module, Span) { return told(module); };
        dialect.start = lparser_.switch_yz ? "@F;(2)" : ";(2)";
        write_settings(dialect.settings, write_materials(dialect.head));
        write_meanings(dialect.ending);
        for (LSystemProduction& rule : std::exchange(rules(), {}))
            add_rule(std::move(rule));
        name_turns(lparser_.system.axiom);
        for (LSystemProduction& rule : rules()) {
            name_turns(rule.predecessor);
            name_turns(rule.successor);
        }
        return write_dialect(file_, std::move(lparser_.system), model_, dialect);
    }

  private:
    std::vector<LSystemProduction>& rules() {
        return lparser_.system.productions[LSystemSection::productions];
    }
    const std::vector<LSystemProduction>& rules() const {
        return lparser_.system.productions.at(LSystemSection::productions);
    }
    static char letter_of(const LSystemProduction& rule) { return rule.predecessor[0].symbol[0]; }

    void gather() {
        for (const LSystemProduction& rule : rules())
            ruled_.insert(letter_of(rule));
        std::vector<LSystemString*> strings = {&lparser_.system.axiom};
        for (LSystemProduction& rule : rules())
            strings.push_back(&rule.successor);
        check_digits(strings);
        for (LSystemString* const string : strings)
            for (LSystemModule& module : *string) {
                take_number(module);
                if (used_.insert(module.symbol[0]).second) warn_of_no_meaning(module);
                if (module.has_parentheses) numbered_.insert(module.symbol[0]);
            }
        // A number behind a symbol stays behind the last symbol of its successor.
        for (bool grows = true; grows;) {
            grows = false;
            for (const LSystemProduction& rule : rules()) {
                if (!numbered_.contains(letter_of(rule)) || rule.successor.empty()) continue;
                const LSystemModule& last = rule.successor.back();
                if (!last.has_parentheses && takes_number(last.symbol[0]))
                    grows = numbered_.insert(last.symbol[0]).second || grows;
            }
        }
        find_plain();
    }

    /// Letters may be states of the rules; a sign without a rule is meant to be a command.
    void warn_of_no_meaning(const LSystemModule& module) {
        const char sign = module.symbol[0];
        if (std::isalnum(static_cast<unsigned char>(sign)) || lparser_command(sign) || has_rule(sign)) return;
        file_.diagnostics
            .warning(module.span, fmt::format("'{}' means nothing to the L-Parser, and draws nothing", sign))
            .with_hint("its turtle rolls by '<' and '>'");
    }

    /// The program rewrites the digits of numbers too.
    void check_digits(const std::vector<LSystemString*>& strings) {
        std::set<char> digits;
        for (const LSystemString* const string : strings)
            for (const LSystemModule& module : *string)
                for (const std::string& number : module.parameters)
                    digits.insert(number.begin(), number.end());
        for (const LSystemProduction& rule : rules())
            if (digits.contains(letter_of(rule)))
                file_.diagnostics
                    .error(rule.span,
                           fmt::format("this rule would rewrite the '{}' of numbers", letter_of(rule)))
                    .with_hint("give the symbol another letter");
    }

    /// Whether a number behind the symbol has a meaning.
    bool takes_number(char letter) const {
        const LparserCommand* const command = lparser_command(letter);
        return !command || *command->with_number || (has_rule(letter) && !keeps_name(letter));
    }

    /// The number as scanf reads it, without the text behind it; 0 without a number.
    void take_number(LSystemModule& module) {
        if (module.parameters.empty()) return;
        module.has_parentheses = takes_number(module.symbol[0]);
        if (!module.has_parentheses) {
            file_.diagnostics.warning(module.span,
                                      fmt::format("the number of '{}' means nothing", module.symbol));
            return module.parameters.clear();
        }
        const std::string text = module.parameters[0].substr(0, 40);
        const auto [read, length] = leading_number(text);
        const double value = std::isfinite(read) ? read : 0;
        if (length == 0 || length != text.size() || !std::isfinite(read))
            file_.diagnostics.warning(
                module.span, fmt::format("'{}' is read as the number {}", comment_text(text), value));
        module.parameters[0] = fmt::format("{}", value);
    }

    /// Without the last symbol where a number of the symbol that becomes the string stands behind it.
    void look_for_plain(const LSystemString& string, bool last_too) {
        for (std::size_t i = 0; i + (last_too ? 0 : 1) < string.size(); ++i)
            if (!string[i].has_parentheses) plain_.insert(string[i].symbol[0]);
    }

    /// Whether the symbol may stand without a number.
    bool is_plain(char letter) const { return plain_.contains(letter) || !numbered_.contains(letter); }

    void find_plain() {
        look_for_plain(lparser_.system.axiom, true);
        std::size_t known = 0;
        do {
            known = plain_.size();
            for (const LSystemProduction& rule : rules())
                look_for_plain(rule.successor, is_plain(letter_of(rule)));
        } while (plain_.size() > known);
    }

    bool has_rule(char letter) const { return ruled_.contains(letter); }

    /// Writes the materials; gives their number.
    int write_materials(Translation& out) {
        std::map<int, const LparserColour*> own;
        int count = static_cast<int>(usual.size() / 3);
        for (const LparserColour& colour : lparser_.colours) {
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
            out.line(fmt::format("  {} {}{}{}", statement, value, more, remark_text(of.remark)), of.span);
        };
        if (!(lparser_.recursion.value >= 0 &&
              lparser_.recursion.value == std::floor(lparser_.recursion.value)))
            file_.diagnostics.error(lparser_.recursion.span,
                                    "a recursion depth that is no whole number has no "
                                    "translation");
        if (!(lparser_.thickness.value > 0))
            file_.diagnostics.error(lparser_.thickness.span, "a thickness must be above 0");
        number("steps", lparser_.recursion, lparser_.recursion.value);
        number("angle", lparser_.angle, lparser_.angle.value);
        number("thickness", lparser_.thickness, lparser_.thickness.value, "/100");
        if (lparser_.least_thickness && lparser_.least_thickness->value > 0)
            number("thinnest", *lparser_.least_thickness, lparser_.least_thickness->value, "/100");
        if (!lparser_.has_keywords) out.line("  step 100");
    }

    /// A symbol with a number is another module than the symbol alone.
    void add_rule(LSystemProduction rule) {
        const char letter = letter_of(rule);
        if (std::string_view("[]()").find(letter) != std::string_view::npos)
            file_.diagnostics.error(rule.span, fmt::format("a rule for '{}' has no translation", letter));
        if (is_plain(letter)) {
            rules().push_back(rule);
            rule.comments.clear();
            rule.remark.clear();
        }
        if (!numbered_.contains(letter)) return;
        const auto give_number = [](LSystemModule& module) {
            module.parameters = {"x"};
            module.has_parentheses = true;
        };
        give_number(rule.predecessor[0]);
        if (!rule.successor.empty()) {
            LSystemModule& last = rule.successor.back();
            if (!last.has_parentheses && takes_number(last.symbol[0])) give_number(last);
        }
        rules().push_back(std::move(rule));
    }

    static void name_turns(LSystemString& string) {
        for (LSystemModule& module : string)
            if (module.symbol == "~") module.symbol = "Shake";
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
                lines.push_back(fmt::format("{} -> {}", symbol_name(letter), command->text));
            if (numbered_.contains(letter) && *command->with_number)
                lines.push_back(
                    fmt::format("{}(x) -> {}", symbol_name(letter), with_number(command->with_number, "x")));
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
        const auto draws = [&](const LSystemString& string) {
            int depth = 0;
            for (const LSystemModule& module : string) {
                const char letter = module.symbol[0];
                depth += (letter == '{') - (letter == '}');
                if (depth > 0 && (letter == 'F' || letter == 'Z' || (has_rule(letter) && letter != 'f')))
                    return true;
            }
            return depth != 0;
        };
        return draws(lparser_.system.axiom) ||
               std::ranges::any_of(rules(),
                                   [&](const LSystemProduction& rule) { return draws(rule.successor); });
    }

    /// Whether a command is one module of ours, that may have productions.
    static bool keeps_name(char letter) {
        return std::string_view("FfgZzt+-&^|~").find(letter) != std::string_view::npos;
    }

    static std::string with_number(std::string_view pattern, std::string_view number) {
        std::string text(pattern);
        return text.replace(text.find('%'), 1, number);
    }

    /// Nothing for a symbol that is one module of the model's, or one of ours with the same parameters.
    std::optional<std::string> told(const LSystemModule& module) const {
        const LparserCommand* const command = lparser_command(module.symbol[0]);
        if (!command || keeps_name(module.symbol[0]) || has_rule(module.symbol[0])) return std::nullopt;
        return module.has_parentheses ? with_number(command->with_number, module.parameters[0])
                                      : command->text;
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    LparserSystem lparser_;
    std::set<char> used_; ///< in strings
    std::set<char> ruled_;
    std::set<char> plain_;    ///< may have no number behind them
    std::set<char> numbered_; ///< may have a number behind them
};

} // namespace

Translation write_lparser(const ForeignFile& file, const ForeignModel& model, LparserSystem lparser) {
    return LparserWriter(file, model, std::move(lparser)).write();
}

} // namespace graftal
