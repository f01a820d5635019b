#include "compiler/import/lparser/system.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/lparser/commands.h"

namespace graftal {

namespace {

constexpr std::string_view lparser_keywords[] = {
    "recursion", "mutation",   "angle", "thickness", "min_thickness", "switch_yz", "trace",
    "no_wait",   "poly_limit", "shape", "color",     "axiom",         "rule"};

} // namespace

bool is_lparser_keyword(std::string_view word) {
    return std::ranges::find(lparser_keywords, word) != std::end(lparser_keywords);
}

namespace {

class LparserReader {
  public:
    LparserReader(const ForeignFile& file) : file_(file), code_(file) {}

    std::optional<LparserSystem> read() {
        const std::size_t errors = file_.diagnostics.error_count();
        for (const TextLine& line : lines_of(file_.text(), 0, file_.text().size())) {
            if (ended_ || file_.diagnostics.full()) break;
            read_line(line);
        }
        const Span end = file_.span(0, 0);
        if (file_.diagnostics.error_count() == errors && system().axiom.empty())
            file_.diagnostics.error(end, "the file has no axiom")
                .with_hint("its lines are: recursion depth, angle, thickness, axiom, rules, and '@'");
        system().tail_comments = std::move(comments_);
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return std::move(lparser_);
    }

  private:
    LSystem& system() { return lparser_.system; }

    void read_line(const TextLine& line) {
        const std::size_t hash = std::min(line.text.find('#'), line.text.size());
        const std::string_view statement = line.text.substr(0, hash);
        comment_ = hash < line.text.size() ? comment_text(line.text.substr(hash + 1)) : "";
        const std::size_t first = statement.find_first_not_of(" \t");
        span_ = file_.span(line.begin + std::min(first, statement.size()), line.begin + statement.size());
        if (first == std::string_view::npos) {
            if (comment_.find_first_not_of("-=*#_ ") != std::string::npos)
                comments_.emplace_back(comment_, span_);
            return;
        }
        const std::size_t end = std::min(statement.find_first_of(" \t", first), statement.size());
        const std::string_view word = statement.substr(first, end - first);
        if (number_ == 0 && is_lparser_keyword(word)) lparser_.has_keywords = true;
        if (lparser_.has_keywords)
            read_keyword(word, statement.substr(end), line.begin + end);
        else
            read_in_order(word, statement, line.begin + first);
    }

    void read_in_order(std::string_view word, std::string_view statement, std::size_t begin) {
        switch (number_++) {
        case 0:
            return set(lparser_.recursion, word);
        case 1:
            return set(lparser_.angle, word);
        case 2:
            return set(lparser_.thickness, word);
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
        if (keyword == "recursion") return set(lparser_.recursion, value);
        if (keyword == "angle") return set(lparser_.angle, value);
        if (keyword == "thickness") return set(lparser_.thickness, value);
        if (keyword == "min_thickness") return set(lparser_.least_thickness.emplace(), value);
        if (keyword == "switch_yz") return void(lparser_.switch_yz = value == "1");
        if (keyword == "color") return add_colour(value);
        if (keyword == "axiom") return set_axiom(rest, begin);
        if (keyword == "rule") return add_rule(rest, begin);
        if (keyword == "mutation" && value != "0")
            file_.diagnostics.warning(span_, "mutations are left out: they are different ones at each run");
        else if (keyword == "poly_limit")
            file_.diagnostics.warning(span_,
                                      "a limit of polygons is left out: graftal draws the whole model");
        else if (!is_lparser_keyword(keyword))
            file_.diagnostics.error(span_, fmt::format("'{}' is no keyword of L-Parser", keyword));
    }

    void set(LparserNumber& number, std::string_view text) {
        number.span = span_;
        number.remark = comment_;
        const LeadingNumber read = leading_number(code_.signs(text.substr(0, 60), span_));
        number.value = read.value;
        take_comments(system().head_comments);
        if (read.length == 0 || !std::isfinite(number.value))
            file_.diagnostics.error(span_, fmt::format("expected a number, found '{}'", comment_text(text)))
                .with_hint(
                    "a file of L-Parser begins with lines of recursion depth, angle, thickness, axiom");
    }

    void take_comments(LSystemComments& lines) {
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
        take_comments(system().head_comments);
        lparser_.colours.push_back(colour);
    }

    void set_axiom(std::string_view text, std::size_t begin) {
        if (!system().axiom.empty()) file_.diagnostics.warning(span_, "a second axiom: this one counts");
        take_comments(system().head_comments);
        system().axiom = string_of(text, begin);
        system().axiom_span = span_;
        system().axiom_remark = comment_;
    }

    void add_rule(std::string_view text, std::size_t begin) {
        const std::size_t first = text.find_first_not_of(" \t");
        const std::size_t equal = text.find('=', std::min(first, text.size() - 1) + 1);
        if (first == std::string_view::npos || equal == std::string_view::npos) {
            file_.diagnostics.error(span_, "a rule is written letter=string");
            return;
        }
        const std::string left = code_.signs(trimmed(text.substr(0, equal)), span_);
        if (left.empty()) return;
        LSystemProduction rule;
        rule.predecessor.emplace_back().symbol = left[0];
        rule.span = span_;
        rule.remark = comment_;
        if (left.size() > 1)
            file_.diagnostics.warning(span_,
                                      "a rule is for one symbol: of the left side the first one counts");
        rule.successor = string_of(text.substr(equal + 1), begin + equal + 1);
        take_comments(rule.comments);
        std::vector<LSystemProduction>& rules = system().productions[LSystemSection::productions];
        const auto same = std::ranges::find_if(
            rules, [&](const LSystemProduction& known) { return known.predecessor[0].symbol[0] == left[0]; });
        if (same == rules.end())
            rules.push_back(std::move(rule));
        else
            file_.diagnostics.warning(span_, fmt::format("a second rule for '{}': the first counts", left[0]))
                .with_note(same->span, "the first is here");
    }

    /// Spaces do not count. A number in parentheses belongs to the symbol before it.
    LSystemString string_of(std::string_view text, std::size_t begin) {
        LSystemString string;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t from = at;
            const std::string signs = code_.next(text, at, begin);
            for (std::size_t i = 0; i + 1 < signs.size(); ++i)
                string.push_back({{signs[i]}, {}, false, file_.span(begin + from, begin + at)});
            if (signs.empty()) continue;
            const char c = signs.back();
            if (std::isspace(static_cast<unsigned char>(c))) continue;
            LSystemModule symbol{{c}, {}, false, {}};
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
                symbol.parameters.push_back(code_.signs(text.substr(at + 1, close - at - 1),
                                                        file_.span(begin + at + 1, begin + close)));
                at = close + 1;
            }
            symbol.span = file_.span(begin + from, begin + at);
            string.push_back(std::move(symbol));
        }
        return string;
    }

    const ForeignFile& file_;
    CodeReader code_;
    LparserSystem lparser_;
    Span span_; ///< of the statement
    std::string comment_;
    LSystemComments comments_; ///< since the last statement
    int number_ = 0;           ///< of statements
    bool ended_ = false;
};

} // namespace

std::optional<LparserSystem> read_lparser(const ForeignFile& file) {
    return LparserReader(file).read();
}

} // namespace graftal
