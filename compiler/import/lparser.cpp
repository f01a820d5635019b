#include "compiler/import/lparser.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/importers.h"

namespace graftal {

namespace {

constexpr std::size_t most_file_bytes =
    1'000'000; ///< of a file: its strings have fewer modules than ours may

constexpr std::string_view lparser_keywords[] = {
    "recursion", "mutation",   "angle", "thickness", "min_thickness", "switch_yz", "trace",
    "no_wait",   "poly_limit", "shape", "color",     "axiom",         "rule"};

/// What a symbol is in our strings, without and with its number `%` in parentheses; "" for none.
struct LparserCommand {
    char symbol;
    const char* text;
    const char* with_number;
};

// The turtle's axes are those of ABOP, as ours; the program calls the axis opposite to up its up.
constexpr LparserCommand lparser_commands[] = {
    {'F', "F", "F(%)"},
    {'f', "f", "f(%)"},
    {'g', "g", "g(%)"},
    {'Z', "Z", "Z(%)"},
    {'z', "z", "z(%)"},
    {'+', "+", "+(%)"},
    {'-', "-", "-(%)"},
    {'&', "&", "&(%)"},
    {'^', "^", "^(%)"},
    {'<', "\\", "\\(%)"},
    {'>', "/", "/(%)"},
    {'|', "|", ""},
    {'%', "/(180)", ""},
    {'$', "$@N(1)", ""}, // its axes are left-handed from then on
    {'t', "t", "t(%)"},
    {'~', "Shake", "Shake(%)"},
    {'!', "@W(0.7)", "@W(%)"},
    {'?', "@W(1/0.7)", "@W(%)"},
    {':', "@A(0.9)", "@A(%)"},
    {';', "@A(1/0.9)", "@A(%)"},
    {'\'', "@S(0.9)", "@S(%)"},
    {'"', "@S(1/0.9)", "@S(%)"},
    {'[', "[", ""},
    {']', "]", ""},
    {'{', "{", ""},
    {'}', "}", ""},
    {'.', ".", ""},
    {'c', ";", ";(%)"},
};

/// Modules of the translation that need an interpretation.
struct LparserMeaning {
    const char* name;
    const char* production;
};

constexpr LparserMeaning lparser_meanings[] = {
    {"Z", "Z -> @S(1/2)F@S(2)"},
    {"Z", "Z(l) -> F(l)"},
    {"z", "z -> @S(1/2)f@S(2)"},
    {"z", "z(l) -> f(l)"},
    {"t", "t -> @B(0.2)"},
    {"t", "t(e) -> @B(e)"},
    {"Shake", "Shake -> Shake(343.77)"}, // 6 radians, where it means degrees
    {"Shake", "Shake(a) -> +(random(-a, a))&(random(-a, a))/(random(-a, a))"},
};

const LparserCommand* lparser_command(char symbol) {
    const auto* const found = std::ranges::find(lparser_commands, symbol, &LparserCommand::symbol);
    return found == std::end(lparser_commands) ? nullptr : found;
}

struct LparserSymbol {
    char letter = 0;
    std::optional<std::string> number; ///< as it is written
    Span span;
};

using LparserString = std::vector<LparserSymbol>;

struct LparserLine {
    std::string comment; ///< without a statement: a line of its own
    Span span;
};

struct LparserRule {
    char letter = 0;
    LparserString successor;
    Span span;
    std::string comment;
    std::vector<LparserLine> before; ///< lines of comments
};

struct LparserColour {
    int index = 0;
    std::array<int, 3> rgb{};
    Span span;
};

struct LparserNumber {
    double value = 0;
    Span span;
    std::string comment;
};

struct LparserSystem {
    bool has_keywords = false;
    LparserNumber recursion{1, {}, {}}, angle{45, {}, {}}, thickness{100, {}, {}};
    std::optional<LparserNumber> least_thickness;
    bool switch_yz = false;
    LparserString axiom;
    Span axiom_span;
    std::string axiom_comment;
    std::vector<LparserRule> rules; ///< each letter once
    std::vector<LparserColour> colours;
    std::vector<LparserLine> head; ///< comments before the axiom
    std::vector<LparserLine> tail;
};

// ------------------------------------------------------------------------------------------------- reading

class LparserReader {
  public:
    LparserReader(const ForeignFile& file) : file_(file) {}

    std::optional<LparserSystem> read() {
        const std::size_t errors = file_.diagnostics.error_count();
        for (const TextLine& line : lines_of(file_.text(), 0, file_.text().size())) {
            if (ended_ || file_.diagnostics.full()) break;
            read_line(line);
        }
        const Span end = file_.span(0, 0);
        if (file_.diagnostics.error_count() == errors && system_.axiom.empty())
            file_.diagnostics.error(end, "the file has no axiom")
                .with_hint("its lines are: recursion depth, angle, thickness, axiom, rules, and '@'");
        system_.tail = std::move(comments_);
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return std::move(system_);
    }

  private:
    void read_line(const TextLine& line) {
        const std::size_t hash = std::min(line.text.find('#'), line.text.size());
        const std::string_view statement = line.text.substr(0, hash);
        comment_ = hash < line.text.size() ? comment_text(line.text.substr(hash + 1)) : "";
        const std::size_t first = statement.find_first_not_of(" \t");
        span_ = file_.span(line.begin + std::min(first, statement.size()), line.begin + statement.size());
        if (first == std::string_view::npos) {
            if (comment_.find_first_not_of("-=*#_ ") != std::string::npos)
                comments_.push_back({comment_, span_});
            return;
        }
        const std::size_t end = std::min(statement.find_first_of(" \t", first), statement.size());
        const std::string_view word = statement.substr(first, end - first);
        if (number_ == 0 && std::ranges::find(lparser_keywords, word) != std::end(lparser_keywords))
            system_.has_keywords = true;
        if (system_.has_keywords)
            read_keyword(word, statement.substr(end), line.begin + end);
        else
            read_in_order(word, statement, line.begin + first);
    }

    void read_in_order(std::string_view word, std::string_view statement, std::size_t begin) {
        switch (number_++) {
        case 0:
            return set(system_.recursion, word);
        case 1:
            return set(system_.angle, word);
        case 2:
            return set(system_.thickness, word);
        case 3:
            return set_axiom(word, begin);
        default:
            if (word[0] == '@') {
                ended_ = true;
                return;
            }
            add_rule(word, begin);
            break;
        }
        const std::string_view rest = trimmed(statement.substr(statement.find(word) + word.size()));
        if (!rest.empty())
            file_.diagnostics.warning(span_, "text behind a space belongs to no rule")
                .with_hint("a rule has no spaces");
    }

    void read_keyword(std::string_view keyword, std::string_view rest, std::size_t begin) {
        ++number_;
        const std::string_view value = trimmed(rest);
        if (keyword == "recursion") return set(system_.recursion, value);
        if (keyword == "angle") return set(system_.angle, value);
        if (keyword == "thickness") return set(system_.thickness, value);
        if (keyword == "min_thickness") return set(system_.least_thickness.emplace(), value);
        if (keyword == "switch_yz") return void(system_.switch_yz = value == "1");
        if (keyword == "color") return add_colour(value);
        if (keyword == "axiom") return set_axiom(rest, begin);
        if (keyword == "rule") return add_rule(rest, begin);
        if (keyword == "mutation" && value != "0")
            file_.diagnostics.warning(span_, "mutations are left out: they are different ones at each run");
        else if (keyword == "poly_limit")
            file_.diagnostics.warning(span_,
                                      "a limit of polygons is left out: graftal draws the whole model");
        else if (std::ranges::find(lparser_keywords, keyword) == std::end(lparser_keywords))
            file_.diagnostics.error(span_, fmt::format("'{}' is no keyword of L-Parser", keyword));
    }

    void set(LparserNumber& number, std::string_view text) {
        number.span = span_;
        number.comment = comment_;
        const std::string copy(text.substr(0, 40));
        char* end = nullptr;
        number.value = std::strtod(copy.c_str(), &end);
        take_comments(system_.head);
        if (end == copy.c_str() || !std::isfinite(number.value))
            file_.diagnostics.error(span_, fmt::format("expected a number, found '{}'", comment_text(text)));
    }

    void take_comments(std::vector<LparserLine>& lines) {
        lines.insert(lines.end(), comments_.begin(), comments_.end());
        comments_.clear();
    }

    void add_colour(std::string_view text) {
        LparserColour colour{.span = span_};
        std::array<int, 4> numbers{};
        const char* at = text.data();
        const char* const end = text.data() + text.size();
        for (int& number : numbers) {
            while (at != end && (*at == ' ' || *at == '\t'))
                ++at;
            const auto [next, error] = std::from_chars(at, end, number);
            if (error != std::errc() || number < 0 || number > 255) {
                file_.diagnostics.error(span_, "a colour is an index and red, green and blue from 0 to 255");
                return;
            }
            at = next;
        }
        colour.index = numbers[0];
        colour.rgb = {numbers[1], numbers[2], numbers[3]};
        take_comments(system_.head);
        system_.colours.push_back(colour);
    }

    void set_axiom(std::string_view text, std::size_t begin) {
        if (!system_.axiom.empty()) file_.diagnostics.warning(span_, "a second axiom: this one counts");
        take_comments(system_.head);
        system_.axiom = string_of(text, begin);
        system_.axiom_span = span_;
        system_.axiom_comment = comment_;
    }

    void add_rule(std::string_view text, std::size_t begin) {
        const std::size_t first = text.find_first_not_of(" \t");
        const std::size_t equal = text.find('=', std::min(first, text.size() - 1) + 1);
        if (first == std::string_view::npos || equal == std::string_view::npos) {
            file_.diagnostics.error(span_, "a rule is written letter=string");
            return;
        }
        LparserRule rule{.letter = text[first], .span = span_, .comment = comment_};
        if (trimmed(text.substr(0, equal)).size() > 1)
            file_.diagnostics.warning(span_,
                                      "a rule is for one symbol: of the left side the first one counts");
        rule.successor = string_of(text.substr(equal + 1), begin + equal + 1);
        take_comments(rule.before);
        const auto same = std::ranges::find(system_.rules, rule.letter, &LparserRule::letter);
        if (same == system_.rules.end())
            system_.rules.push_back(std::move(rule));
        else
            file_.diagnostics
                .warning(span_, fmt::format("a second rule for '{}': the first counts", rule.letter))
                .with_note(same->span, "the first is here");
    }

    /// Spaces do not count. A number in parentheses belongs to the symbol before it.
    LparserString string_of(std::string_view text, std::size_t begin) {
        LparserString string;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t from = at;
            const char c = text[at++];
            if (std::isspace(static_cast<unsigned char>(c))) continue;
            LparserSymbol symbol{c, std::nullopt, {}};
            if (c == '(' && string.empty()) {
                file_.diagnostics.error(file_.span(begin + from, begin + at),
                                        "a string that begins with a number for the symbol before it has no "
                                        "translation");
                return string;
            }
            if (c == '(' || c == ')') {
                file_.diagnostics.warning(
                    file_.span(begin + from, begin + at),
                    fmt::format("this '{}' belongs to no symbol, and means nothing", c));
                continue;
            }
            if (at < text.size() && text[at] == '(') {
                const std::size_t close = text.find(')', at);
                if (close == std::string_view::npos) {
                    file_.diagnostics.error(file_.span(begin + at, begin + at + 1), "this '(' is not closed");
                    return string;
                }
                symbol.number = std::string(text.substr(at + 1, close - at - 1));
                at = close + 1;
            }
            symbol.span = file_.span(begin + from, begin + at);
            string.push_back(std::move(symbol));
        }
        return string;
    }

    const ForeignFile& file_;
    LparserSystem system_;
    Span span_; ///< of the statement
    std::string comment_;
    std::vector<LparserLine> comments_; ///< since the last statement
    int number_ = 0;                    ///< of statements
    bool ended_ = false;
};

// ------------------------------------------------------------------------------------------------- writing

class LparserWriter {
  public:
    LparserWriter(const ForeignFile& file, const ForeignModel& model, const LparserSystem& system)
        : file_(file), model_(model), system_(system) {}

    std::optional<Translation> write() {
        const std::size_t errors = file_.diagnostics.error_count();
        gather();
        check_digits();
        Translation out{"lsys", {}, {}};
        comments(out, system_.head, "");
        const int colours = write_materials(out);
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (const std::string names = declared(); !names.empty()) out.line("  modules " + names);
        write_settings(out, colours);
        out.line(fmt::format("  axiom {}{}{}{}", system_.switch_yz ? "@F" : "", ";(2)",
                             text_of(system_.axiom), remark(system_.axiom_comment)),
                 system_.axiom_span);
        for (const LparserRule& rule : system_.rules)
            write_rule(out, rule);
        comments(out, system_.tail, "  ");
        write_meanings(out);
        out.line("}");
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return out;
    }

  private:
    void gather() {
        for (const LparserRule& rule : system_.rules)
            ruled_.insert(rule.letter);
        look(system_.axiom);
        for (const LparserRule& rule : system_.rules)
            look(rule.successor);
        // What is written behind a symbol stays behind what the symbol becomes.
        for (bool grows = true; grows;) {
            grows = false;
            for (const LparserRule& rule : system_.rules) {
                if (!numbered_.contains(rule.letter) || rule.successor.empty()) continue;
                const LparserSymbol& last = rule.successor.back();
                if (!last.number) grows = numbered_.insert(last.letter).second || grows;
            }
        }
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

    static std::string remark(const std::string& comment) {
        return comment.empty() ? std::string() : "   # " + comment;
    }

    static void comments(Translation& out, const std::vector<LparserLine>& lines, const char* indent) {
        for (const LparserLine& line : lines)
            out.line(fmt::format("{}# {}", indent, line.comment), line.span);
    }

    /// Colours are those of a screen.
    static std::string linear(double r, double g, double b) {
        const auto light = [](double x) {
            return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
        };
        return fmt::format("{:.3g}, {:.3g}, {:.3g}", light(r), light(g), light(b));
    }

    /// How many there are.
    int write_materials(Translation& out) {
        constexpr std::array<std::array<double, 3>, 16> usual = {{{0.5, 0.5, 0.5},
                                                                  {0.5, 0.5, 0.5},
                                                                  {0.8, 0.4, 0.4},
                                                                  {0.8, 0.8, 0.4},
                                                                  {0.4, 0.8, 0.4},
                                                                  {0.4, 0.8, 0.8},
                                                                  {0.4, 0.4, 0.8},
                                                                  {0.8, 0.4, 0.8},
                                                                  {0.2, 0.5, 0.2},
                                                                  {0.2, 0.5, 0.5},
                                                                  {0.2, 0.2, 0.5},
                                                                  {0.5, 0.2, 0.5},
                                                                  {0.6, 0.2, 0.2},
                                                                  {0.5, 0.5, 0.5},
                                                                  {0.75, 0.75, 0.75},
                                                                  {1, 1, 1}}};
        std::map<int, const LparserColour*> own;
        int count = static_cast<int>(usual.size());
        for (const LparserColour& colour : system_.colours) {
            own[colour.index] = &colour;
            count = std::max(count, colour.index + 1);
        }
        for (int i = 0; i < count; ++i) {
            const auto known = own.find(i);
            std::array<double, 3> rgb = i < 16 ? usual[static_cast<std::size_t>(i)] : usual[0];
            if (known != own.end())
                for (std::size_t k = 0; k < 3; ++k)
                    rgb[k] = known->second->rgb[k] / 255.0;
            out.line(fmt::format("material colour{} {{ color: {} }}", i, linear(rgb[0], rgb[1], rgb[2])),
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
            out.line(fmt::format("  {} {}{}{}", statement, value, more, remark(of.comment)), of.span);
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
        out.line(fmt::format("  {} -> {}{}", name, successor.empty() ? "*" : successor, remark(rule.comment)),
                 rule.span);
        if (!numbered_.contains(rule.letter)) return;
        std::string numbered = successor;
        if (!rule.successor.empty() && !rule.successor.back().number) {
            LparserString string = rule.successor;
            string.back().number = "x";
            numbered = text_of(string);
        }
        out.line(fmt::format("  {}(x) -> {}", name, numbered.empty() ? "*" : numbered), rule.span);
    }

    void write_meanings(Translation& out) {
        std::vector<std::string> lines;
        if (draws_in_polygons()) lines.insert(lines.end(), {"F -> @E", "F(l) -> @E(l)"}); // and so do Z
        for (const LparserMeaning& meaning : lparser_meanings)
            if (uses_name(meaning.name)) lines.emplace_back(meaning.production);
        for (const char letter : ruled_) {
            const LparserCommand* const command = lparser_command(letter);
            if (!command || keeps_name(letter)) continue;
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

    bool uses_name(std::string_view name) const {
        return std::ranges::any_of(used_, [&](char c) {
            const LparserCommand* const command = lparser_command(c);
            return command && name == command->text;
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

    /// As scanf reads it: what follows a number is passed over, and without a number it is 0.
    std::string number_of(const LparserSymbol& symbol) {
        if (*symbol.number == "x") return "x";
        const std::string text = symbol.number->substr(0, 40);
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        if (end == text.c_str() || *end != '\0' || !std::isfinite(value))
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
    std::set<char> numbered_; ///< that may have a number behind them
    std::string digits_;      ///< of all numbers
};

// ------------------------------------------------------------------------------------------------ the row

std::vector<ForeignModel> lparser_models(const ForeignFile& file) {
    const std::string name = std::filesystem::path(file.sources.name(file.file)).stem().string();
    return {{name, file.span(0, std::min<std::size_t>(file.text().find('\n'), file.text().size()))}};
}

/// No other format ends in .ls.
bool is_lparser(std::string_view text) {
    return !is_binary(text);
}

std::optional<Translation> translate_lparser(const ForeignFile& file, const ForeignModel& model) {
    if (file.text().size() > most_file_bytes) {
        file.diagnostics.error(file.span(0, 0),
                               fmt::format("a file of L-Parser has at most {} characters", most_file_bytes));
        return std::nullopt;
    }
    const std::optional<LparserSystem> system = LparserReader(file).read();
    if (!system) return std::nullopt;
    return LparserWriter(file, model, *system).write();
}

constexpr std::string_view lparser_endings[] = {"ls"};

} // namespace

Importer lparser_importer() {
    return {"L-Parser", lparser_endings, is_lparser, lparser_models, translate_lparser};
}

} // namespace graftal
