#include "compiler/import/lpy/lines.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr std::size_t most_indented = 100; ///< statements below each other; deeper ones count as that deep

class LineReader {
  public:
    LineReader(std::string_view text, FileId file) : text_(text), file_(file) {}

    /// The statements in the order of the text.
    std::vector<LpyLine> read() {
        std::vector<LpyLine> lines;
        while (at_ < text_.size()) {
            LpyLine line;
            read_line(line);
            if (line.comment.starts_with("##") && line.comment.find("INITIALISATION") != std::string::npos)
                break;
            if (!line.text.empty() || !line.comment.empty()) lines.push_back(std::move(line));
        }
        return lines;
    }

  private:
    void read_line(LpyLine& line) {
        for (; at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t'); ++at_)
            line.indent = text_[at_] == '\t' ? (line.indent / 8 + 1) * 8 : line.indent + 1;
        const std::size_t begin = at_;
        std::size_t end = begin;
        int depth = 0;
        std::optional<bool> modules; // whether the line holds a string of them
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '\n') {
                if (depth <= 0) break;
                line.text += ' ';
            } else if (c == '#') {
                const std::size_t stop = std::min(text_.find('\n', at_), text_.size());
                if (line.comment.empty()) line.comment = comment_text(text_.substr(at_ + 1, stop - at_ - 1));
                at_ = stop - 1;
            } else if (c == '\\' &&
                       (text_.substr(at_).starts_with("\\\n") || text_.substr(at_).starts_with("\\\r\n"))) {
                at_ = text_.find('\n', at_);
                line.text += ' ';
            } else if (c == '"' || c == '\'') {
                read_quoted(c, line.text);
                end = at_ + 1;
            } else {
                depth += (c == '(') - (c == ')');
                if (c == '[' || c == '{' || c == ']' || c == '}') {
                    // Brackets of Python; in strings they are branches.
                    if (!modules) modules = in_string_of_modules(trimmed(line.text));
                    if (!*modules) depth += (c == '[' || c == '{') ? 1 : -1;
                }
                line.text += c == '\t' || c == '\r' ? ' ' : c;
                if (c != ' ' && c != '\t' && c != '\r') end = at_ + 1;
            }
        }
        at_ = std::min(at_ + 1, text_.size());
        line.text = std::string(trimmed(line.text));
        line.span = {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    }

    static bool in_string_of_modules(std::string_view text) {
        return !text.starts_with("def ") &&
               (text.starts_with("Axiom") || text.find("produce") != std::string_view::npos ||
                text.find("-->") != std::string_view::npos || !assigns(text));
    }

    /// A statement that gives a name a value, or calls something: brackets hold its lines together.
    static bool assigns(std::string_view text) {
        const std::size_t end = text.find_first_of("=(");
        return end != std::string_view::npos &&
               text.substr(0, end).find_first_of("<>[]+-/&^\\") == std::string_view::npos && text[end] == '=';
    }

    /// At a quote, to the end of its text. A text that nobody closes ends with its line.
    void read_quoted(char quote, std::string& out) {
        const std::string three(3, quote);
        const bool is_long = text_.substr(at_).starts_with(three);
        std::size_t stop = at_ + (is_long ? 3 : 1);
        for (; stop < text_.size(); ++stop) {
            if (text_[stop] == '\\') {
                ++stop;
                continue;
            }
            if (is_long ? text_.substr(stop).starts_with(three) : text_[stop] == quote) break;
            if (!is_long && text_[stop] == '\n') {
                out += quote; // an apostrophe
                return;
            }
        }
        out += is_long ? "\"...\"" : std::string(text_.substr(at_, stop + 1 - at_));
        at_ = std::min(stop + (is_long ? 2 : 0), text_.size() - 1);
    }

    std::string_view text_;
    FileId file_;
    std::size_t at_ = 0;
};

/// Hangs the lines from `at` on that stand deeper than `indent` below those before them.
std::vector<LpyLine> nested(std::vector<LpyLine>& lines, std::size_t& at, std::size_t indent,
                            std::size_t depth) {
    std::vector<LpyLine> out;
    while (at < lines.size() && lines[at].indent >= indent) {
        out.push_back(std::move(lines[at++]));
        if (at < lines.size() && lines[at].indent > out.back().indent && depth < most_indented)
            out.back().below = nested(lines, at, out.back().indent + 1, depth + 1);
    }
    return out;
}

} // namespace

std::vector<LpyLine> lpy_lines(std::string_view text, FileId file) {
    std::vector<LpyLine> flat = LineReader(text, file).read();
    // A remark within a rule belongs to nothing.
    std::erase_if(flat, [](const LpyLine& line) { return line.text.empty() && line.indent > 0; });
    std::size_t at = 0;
    return nested(flat, at, 0, 0);
}

} // namespace graftal
