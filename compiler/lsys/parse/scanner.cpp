#include "compiler/lsys/parse/scanner.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/printable.h"
#include "compiler/syntax/lookalikes.h"

namespace graftal {

namespace {

constexpr std::string_view spaces = " \t\r\f\v";

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
bool is_space(char c) {
    return c != '\0' && spaces.find(c) != std::string_view::npos;
}

std::optional<LsysSection> section_named(std::string_view word) {
    if (word == "interpret" || word == "homomorphism") return LsysSection::interpret;
    if (word == "decompose" || word == "decomposition") return LsysSection::decompose;
    return std::nullopt;
}

/// Statements that are made of the words of all languages, with their comments and strings.
bool has_values(std::string_view word) {
    static const std::vector<std::string_view> words = {
        "let",       "inner",    "angle",      "step",   "width",       "steps", "seed",       "tropism",
        "thickness", "thinnest", "bending",    "torque", "environment", "table", "colors",     "modules",
        "camera",    "light",    "background", "ground", "material",    "use",   "precedence", "variable",
        "array",     "start",    "end",        "taper",  "skin"};
    return std::find(words.begin(), words.end(), word) != words.end();
}

} // namespace

const std::vector<std::string>& lsys_keywords() {
    static const std::vector<std::string> keywords = {
        "let",      "inner",   "angle",       "step",         "width",      "steps",        "seed",  "ignore",
        "consider", "tropism", "colors",      "modules",      "thickness",  "thinnest",     "taper", "skin",
        "bending",  "torque",  "environment", "table",        "precedence", "variable",     "array", "start",
        "end",      "axiom",   "interpret",   "homomorphism", "decompose",  "decomposition"};
    return keywords;
}

bool is_lsys_keyword(std::string_view word) {
    const std::vector<std::string>& keywords = lsys_keywords();
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

bool can_name_module(std::string_view text) {
    const bool begins_with_digit = !text.empty() && text.front() >= '0' && text.front() <= '9';
    return !is_lsys_keyword(text) && text != "lsys" && text != "main" &&
           (text.size() == 1 || !begins_with_digit);
}

std::size_t lsys_arrow_size(std::string_view text) {
    return text.starts_with("->") ? 2 : text.starts_with("-->") ? 3 : 0;
}

std::string_view lsys_name(std::string_view text) {
    if (text.empty() || (text[0] >= '0' && text[0] <= '9')) return text.substr(0, 0);
    const auto end = std::find_if_not(text.begin(), text.end(), is_name_character);
    return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

/// The end of a statement: that of its line, unless a bracket is open, or the line ends with the arrow, or,
/// among values, with a comma. A line does not go on with a statement if it begins with a statement's word,
/// or has an arrow after another line had one. So a bracket left open spoils one statement only.
class LsysStatementEnd {
  public:
    /// `closes_before`: a '}' that nothing opened ends the statement if it stands before this place.
    LsysStatementEnd(const LsysScanner& scanner, std::size_t begin, std::string_view word,
                     std::size_t closes_before)
        : scanner_(scanner), at_(begin), closes_before_(closes_before), values_(has_values(word)),
          production_(!is_lsys_keyword(word) && !values_), blocks_(word == "start" || word == "end"),
          lists_names_(word == "let" || word == "inner" || word == "colors" || word == "modules" ||
                       word == "variable") {}

    std::size_t find() {
        while (at_ < scanner_.text_.size() && !ends_here())
            take();
        return std::min(at_, scanner_.text_.size());
    }

  private:
    bool ends_here() const {
        const char c = scanner_.at(at_);
        if (c == '}') return parentheses_ + braces_ == 0 && at_ < closes_before_;
        if (c == '\n') return !goes_on();
        const std::string_view next = second_statement();
        if (!next.empty()) scanner_.report_second_statement(next);
        return !next.empty();
    }

    /// The word of a statement that begins on the same line: `axiom A; steps 3`, `angle 30 steps 3`. No
    /// module may have such a name.
    std::string_view second_statement() const {
        const bool semicolon = scanner_.at(at_) == ';';
        if (parentheses_ > 0 || in_block() || (!semicolon && (!is_space(scanner_.at(at_)) || lists_names_)))
            return {};
        const std::size_t begin = scanner_.skip_spaces(at_ + 1);
        const std::string_view word = lsys_name(scanner_.text_.substr(begin));
        const std::size_t end = begin + word.size();
        if (!is_lsys_keyword(word) || (!is_space(scanner_.at(end)) && scanner_.at(end) != ':')) return {};
        if (semicolon) return word;
        // In `width step * 2` the word is a value.
        const char before = scanner_.at(at_ - 1), after = scanner_.at(scanner_.skip_spaces(end));
        const bool ended = is_name_character(before) || before == ')' || before == ']';
        const bool is_value = values_ && !is_name_character(after) && after != ':';
        const bool is_first = lsys_name(scanner_.text_.substr(begin_)).size() == at_ - begin_;
        return ended && !is_value && !is_first ? word : std::string_view();
    }

    /// Whether it stands in the braces of a block that assigns values.
    bool in_block() const { return braces_ > 0 && (blocks_ || (production_ && !arrow_)); }

    bool goes_on() const {
        const bool open = parentheses_ + squares_ + braces_ > 0;
        const std::size_t next = scanner_.skip_spaces(at_ + 1);
        if (next >= scanner_.text_.size()) return false;
        if (in_block()) return !at_other_statement(next);
        const bool waits = production_ && colon_ && !arrow_;
        if ((waits || (blocks_ && last_ != '}')) && scanner_.at(next) == '{') return true;
        if (waits && last_ == '}' && scanner_.at(next) != '}') return !at_other_statement(next);
        if (braces_closed_ && !arrow_ && lsys_arrow_size(scanner_.text_.substr(next)) > 0) return true;
        if (!open && !trailing_) return false;
        if (values_ && braces_ > 0) return !scanner_.at_block(next);
        if (scanner_.at(next) == '\n') return open;
        // Alone on its line it closes the block: polygons may end in another string.
        if (scanner_.at(next) == '}')
            return braces_ > 0 && (squares_ > 0 || scanner_.at(scanner_.skip_spaces(next + 1)) != '\n');
        if (is_lsys_keyword(lsys_name(scanner_.text_.substr(next))) || scanner_.at_block(next)) return false;
        return (production_ && !arrow_) || !scanner_.has_arrow(next);
    }

    /// The word of a statement is none where it is assigned.
    bool at_other_statement(std::size_t place) const {
        if (scanner_.at_block(place)) return true;
        const std::string_view word = lsys_name(scanner_.text_.substr(place));
        const char after = scanner_.at(scanner_.skip_spaces(place + word.size()));
        return is_lsys_keyword(word) && after != '=' && after != '[';
    }

    void take() {
        const std::size_t comment = comment_end();
        if (comment > at_) {
            at_ = comment;
            return;
        }
        const char c = scanner_.at(at_);
        const std::size_t arrow = values_ || in_block() ? 0 : lsys_arrow_size(scanner_.text_.substr(at_));
        if (arrow > 0) return take_arrow(arrow);
        count(c);
        if (c != '\n' && !is_space(c)) {
            trailing_ = values_ && c == ',';
            last_ = c;
        }
        // A run of spaces at once: each asks what follows it.
        at_ = is_space(c) ? scanner_.skip_spaces(at_) : at_ + 1;
    }

    /// Parameters have the comments of all languages.
    std::size_t comment_end() const {
        if (values_ && scanner_.at(at_) == '"') {
            const std::size_t close = scanner_.text_.find_first_of("\"\n", at_ + 1);
            return close == std::string_view::npos ? scanner_.text_.size()
                                                   : close + (scanner_.at(close) == '"' ? 1 : 0);
        }
        if (values_ || parentheses_ > 0 || in_block()) return scanner_.comment_end(at_);
        return scanner_.at(at_) == '#' ? scanner_.line_end(at_) : at_;
    }

    void take_arrow(std::size_t size) {
        at_ += size;
        arrow_ = true;
        trailing_ = parentheses_ == 0;
    }

    /// Brackets are matched where strings are read; here it is enough to count them.
    void count(char c) {
        const auto change = [c](char open, char close, std::size_t& depth) {
            if (c == open) ++depth;
            if (c == close && depth > 0) --depth;
        };
        change('(', ')', parentheses_);
        if (parentheses_ > 0 || (production_ && !arrow_ && !colon_ && c != ':')) return;
        colon_ = colon_ || c == ':';
        const bool in_braces = braces_ > 0;
        change('[', ']', squares_);
        change('{', '}', braces_);
        braces_closed_ = in_braces ? braces_ == 0 : braces_closed_;
    }

    const LsysScanner& scanner_;
    std::size_t at_;
    std::size_t begin_ = at_;
    std::size_t closes_before_;
    bool values_;
    bool production_;
    bool blocks_;      ///< a statement that is a word and a block
    bool lists_names_; ///< names, which may be those of statements
    char last_ = '\0'; ///< before this place, of those that count
    bool colon_ = false;
    bool arrow_ = false;
    bool braces_closed_ = false; ///< of the block before this place
    bool trailing_ = false;      ///< the last character that counts asks for more
    std::size_t parentheses_ = 0;
    std::size_t squares_ = 0;
    std::size_t braces_ = 0;
};

void LsysScanner::report_second_statement(std::string_view word) const {
    if (std::exchange(second_statement_said_, true)) return;
    diagnostics_.error(span(word), fmt::format("'{}' follows another statement on the same line", word))
        .with_hint("every statement stands on its own line, and ends without ';'");
}

std::size_t LsysScanner::line_end(std::size_t place) const {
    return std::min(text_.find('\n', place), text_.size());
}

std::size_t LsysScanner::skip_spaces(std::size_t place) const {
    return std::min(text_.find_first_not_of(spaces, place), text_.size());
}

std::size_t LsysScanner::comment_end(std::size_t place) const {
    if (at(place) == '#' || text_.substr(place, 2) == "//") return line_end(place);
    if (text_.substr(place, 2) != "/*") return place;
    const std::size_t close = text_.find("*/", place + 2);
    return close == std::string_view::npos ? text_.size() : close + 2;
}

std::size_t LsysScanner::skip_blanks(std::size_t place) const {
    while (place < text_.size()) {
        const std::size_t begin = place;
        place = std::min(text_.find_first_not_of(" \t\r\f\v\n", place), text_.size());
        const std::size_t comment = place;
        if (place < text_.size()) place = comment_end(place);
        if (place == text_.size() && text_.substr(comment, 2) == "/*" && !text_.ends_with("*/"))
            diagnostics_.error(span(comment, comment + 2), "this comment is not closed")
                .with_hint("close it with '*/'");
        if (place == begin) break;
    }
    return place;
}

/// `lsys NAME` or `main lsys`, which begin no statement of a block.
bool LsysScanner::at_block(std::size_t place) const {
    const std::string_view word = lsys_name(text_.substr(place));
    if (word != "lsys" && word != "main") return false;
    const std::string_view next = lsys_name(text_.substr(skip_spaces(place + word.size())));
    return word == "main" ? next == "lsys" : !next.empty();
}

/// A word at the beginning of a line that looks like `lsys`, and before NAME and '{'.
bool LsysScanner::at_misspelt_block(std::string_view word) const {
    if (closest_name(word, {"lsys"}).empty()) return false;
    const std::size_t name = skip_spaces(static_cast<std::size_t>(word.data() - text_.data()) + word.size());
    const std::size_t size = lsys_name(text_.substr(name)).size();
    return size > 0 && at(skip_spaces(name + size)) == '{';
}

std::optional<LsysHeader> LsysScanner::find_block(std::size_t place) const {
    bool first_on_line = true;
    std::string_view last;
    while (place < text_.size()) {
        const std::size_t comment = comment_end(place);
        const std::string_view word = lsys_name(text_.substr(place));
        if (!word.empty()) {
            const bool here = word == "lsys" && (first_on_line || last == "main" || at_block(place));
            if (here || (first_on_line && at_misspelt_block(word))) {
                const bool is_main = last == "main";
                const std::string_view first = is_main ? last : word;
                return LsysHeader{static_cast<std::size_t>(first.data() - text_.data()), word, is_main};
            }
            last = word;
            place += word.size();
            first_on_line = false;
        } else if (comment > place) {
            place = comment;
        } else if (at(place) == '"') {
            place = std::min(text_.find_first_of("\"\n", place + 1), text_.size() - 1);
            place += at(place) == '"' ? 1 : 0;
            last = {};
        } else {
            if (at(place) == '\n')
                first_on_line = true;
            else if (!is_space(at(place)))
                first_on_line = false, last = {};
            ++place;
        }
    }
    return std::nullopt;
}

/// Whether the line has an arrow, in a comment or not: enough to tell that it is a production of its own.
bool LsysScanner::has_arrow(std::size_t place) const {
    const std::string_view line = text_.substr(place, line_end(place) - place);
    return line.substr(0, line.find('#')).find("->") != std::string_view::npos;
}

/// The place behind the '{' after `interpret`, or 0 if a production follows.
std::size_t LsysScanner::enter_section(std::size_t place) const {
    place = skip_blanks(place);
    if (at(place) == ':') place = skip_blanks(place + 1);
    return at(place) == '{' ? place + 1 : 0;
}

LsysOutline LsysScanner::outline(std::size_t begin) const {
    LsysOutline result;
    LsysSection section = LsysSection::block;
    std::size_t closes_before = line_end(begin);
    std::size_t place = skip_blanks(begin);
    for (; place < text_.size() && !at_block(place); place = skip_blanks(place)) {
        if (at(place) == '}') {
            ++place;
            result.closed = section == LsysSection::block;
            if (result.closed) break;
            section = LsysSection::block;
            continue;
        }
        LsysStatement statement{section, lsys_name(text_.substr(place)), place, place};
        const std::optional<LsysSection> named = section_named(statement.word);
        if (named && section == LsysSection::block) {
            place += statement.word.size();
            if (const std::size_t inside = enter_section(place)) {
                section = *named;
                place = inside;
                closes_before = line_end(inside);
                continue;
            }
            place = skip_spaces(place);
            if (at(place) == ':') place = skip_spaces(place + 1);
            statement = {*named, lsys_name(text_.substr(place)), place, place};
        }
        place = LsysStatementEnd(*this, place, statement.word, closes_before).find();
        statement.end = place;
        if (at(place) == ';') ++place; // a sign that another statement follows
        result.statements.push_back(statement);
    }
    result.end = place;
    return result;
}

std::optional<std::size_t> LsysScanner::bracket_end(std::size_t open, std::size_t end) const {
    const char opening = at(open), closing = opening == '(' ? ')' : '}';
    std::size_t depth = 0;
    for (std::size_t place = open; place < end;) {
        const std::size_t comment = comment_end(place);
        if (comment > place) {
            place = comment;
            continue;
        }
        if (at(place) == opening) ++depth;
        if (at(place) == closing && --depth == 0) return place + 1;
        ++place;
    }
    return std::nullopt;
}

std::optional<std::size_t> LsysScanner::find_arrow(std::size_t place, std::size_t end) const {
    std::optional<std::size_t> inside;
    for (std::size_t depth = 0; place < end; ++place) {
        place = comment_end(place);
        const char c = at(place);
        if (c == '(' || c == '{') ++depth;
        if ((c == ')' || c == '}') && depth > 0) --depth;
        if (place >= end || lsys_arrow_size(text_.substr(place, end - place)) == 0) continue;
        if (depth == 0) return place;
        if (!inside) inside = place;
    }
    return inside;
}

Diagnostic& LsysScanner::expected(std::string_view what, std::size_t place, std::size_t end,
                                  std::string_view end_name) const {
    if (place >= end) {
        // Where the last thing ended, as lex() places its end.
        const std::size_t last = text_.find_last_not_of(" \t\r\f\v\n", end == 0 ? 0 : end - 1);
        const std::size_t after = last == std::string_view::npos ? 0 : last + 1;
        return diagnostics_.error(span(after, after), fmt::format("expected {}, found {}", what, end_name));
    }
    std::size_t size = lsys_arrow_size(text_.substr(place));
    if (size == 0) size = std::max<std::size_t>(lsys_name(text_.substr(place, 40)).size(), 1);
    while ((at(place + size) & 0xC0) == 0x80)
        ++size;
    const std::string_view found = text_.substr(place, size);
    const bool foreign = lookalike(code_point(found, 0).value).has_value();
    Diagnostic& error = diagnostics_.error(span(place, place + size),
                                           foreign ? unexpected_character(found)
                                                   : fmt::format("expected {}, found '{}'", what, found));
    if (foreign) error.with_hint(lookalike_hint(found));
    return error;
}

} // namespace graftal
