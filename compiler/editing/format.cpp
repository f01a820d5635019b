#include "compiler/editing/format.h"

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/lsys/parse/scanner.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/// Blanks in front of a line are kept if they are this many more than it needs: somebody lined it up.
constexpr std::size_t lined_up = 4;

/// A line of the text, and its indentation.
struct Line {
    std::uint32_t begin = 0;
    std::uint32_t text = 0; ///< its first character that is no blank, or its end
    std::uint32_t end = 0;  ///< of its last character that is no blank
    std::uint32_t stop = 0; ///< the place of its '\n', or the end of the text

    bool empty() const { return text == stop; }
    std::size_t indent() const { return text - begin; }
};

std::vector<Line> lines_of(std::string_view text) {
    std::vector<Line> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t stop = std::min(text.find('\n', begin), text.size());
        std::size_t first = begin, end = stop;
        while (first < stop && is_blank(text[first]))
            ++first;
        while (end > first && is_blank(text[end - 1]))
            --end;
        lines.push_back({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(first),
                         static_cast<std::uint32_t>(end), static_cast<std::uint32_t>(stop)});
        begin = stop + 1;
    }
    return lines;
}

/// How the lines of a part of the text are laid out.
enum class Layout : std::uint8_t {
    block,   ///< by the depth of its block
    goes_on, ///< as far from where its statement begins as before
    kept,    ///< in a comment: untouched
};

struct LinePlan {
    Layout layout = Layout::block;
    int depth = 0;
    std::size_t statement = 0; ///< of a line that goes on: the line where that begins
};

class Formatter {
  public:
    explicit Formatter(const Document& document)
        : document_(document), text_(document.text()), lines_(lines_of(text_)), plans_(lines_.size()),
          unit_(document.inst() ? 4 : 2) {}

    std::vector<TextEdit> run() && {
        if (lines_.empty()) return {};
        if (document_.lsys())
            plan_lsys();
        else
            plan_tokens({0, 0, static_cast<std::uint32_t>(text_.size())});
        lay_out_lines();
        std::ranges::stable_sort(edits_, {}, &TextEdit::begin);
        return std::move(edits_);
    }

  private:
    std::size_t line_at(std::size_t place) const {
        const auto next =
            std::ranges::upper_bound(lines_, static_cast<std::uint32_t>(place), {}, &Line::begin);
        return static_cast<std::size_t>(next - lines_.begin()) - 1;
    }

    void set(std::size_t begin, std::size_t end, std::string put) {
        if (text_.substr(begin, end - begin) == put) return;
        edits_.push_back(
            {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), std::move(put)});
    }

    // Tokens

    /// Plans the lines of a range whose words are tokens, and lays out what is between these.
    void plan_tokens(Span range) {
        Diagnostics ignored;
        const std::vector<Token> tokens = lex_range(document_.sources(), range, ignored);
        std::size_t next_line = line_at(range.begin);
        int depth = 0;
        std::size_t before = range.begin; // the end of the token before
        for (std::size_t i = 0; i < tokens.size(); ++i) {
            const Token& token = tokens[i];
            const bool last = token.kind == TokenKind::end;
            const std::size_t begin = last ? range.end : token.span.begin;
            keep_comments(before, begin);
            if (i > 0 && !last) lay_out_gap(tokens[i - 1], token);
            const bool closes = token.is("}");
            // All lines up to the one where the token stands begin at this depth.
            for (; next_line < lines_.size() && lines_[next_line].begin <= begin; ++next_line) {
                const bool leads = closes && lines_[next_line].text == token.span.begin;
                plan_block(next_line, depth - (leads ? 1 : 0));
            }
            depth = std::max(0, depth + (token.is("{") ? 1 : 0) - (closes ? 1 : 0));
            before = token.span.end;
        }
    }

    void plan_block(std::size_t line, int depth) {
        if (plans_[line].layout == Layout::block) plans_[line].depth = std::max(0, depth);
    }

    /// Lines that begin inside of a comment, between two tokens.
    void keep_comments(std::size_t begin, std::size_t end) {
        for (std::size_t at = begin; at < end; ++at) {
            const bool line_comment = text_[at] == '#' || text_.substr(at, 2) == "//";
            if (line_comment) at = std::min(text_.find('\n', at), end);
            if (text_.substr(at, 2) != "/*") continue;
            const std::size_t close = std::min(text_.find("*/", at + 2), end);
            for (std::size_t line = line_at(at) + 1; line < lines_.size() && lines_[line].begin <= close;
                 ++line)
                plans_[line].layout = Layout::kept;
            at = close;
        }
    }

    /// The white space between two tokens of one line.
    void lay_out_gap(const Token& left, const Token& right) {
        const std::string_view gap = text_.substr(left.span.end, right.span.begin - left.span.end);
        if (right.first_on_line || !std::ranges::all_of(gap, is_blank)) return;
        std::string put(gap);
        if (gap.find_first_not_of(' ') != std::string_view::npos) put = " "; // tabs
        if (right.is(",") || right.is(":"))
            put.clear();
        else if (gap.empty() && needs_blank(left, right))
            put = " ";
        set(left.span.end, right.span.begin, std::move(put));
    }

    static bool needs_blank(const Token& left, const Token& right) {
        if (left.is("{")) return !right.is("}");
        return left.is(",") || left.is(":") || left.is("->") || right.is("->") || right.is("{") ||
               right.is("}") || left.is("}");
    }

    // `.lsys`

    void plan_lsys() {
        Diagnostics ignored;
        const LsysScanner scanner(document_.sources(), 0, ignored);
        std::size_t begin = 0;
        while (const auto header = scanner.find_block(begin)) {
            const std::size_t open = text_.find('{', header->begin);
            if (open == std::string_view::npos) break;
            plan_tokens({0, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(open + 1)});
            const LsysOutline outline = scanner.outline(open + 1);
            plan_outline(scanner, outline, open + 1);
            begin = outline.end;
        }
        plan_tokens({0, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(text_.size())});
        for (const LsysBlock& block : document_.lsys()->blocks)
            for (const auto* productions : {&block.productions, &block.interpret, &block.decompose})
                for (const LsysProduction& production : *productions)
                    lay_out_arrow(production.successor.span);
    }

    void plan_outline(const LsysScanner& scanner, const LsysOutline& outline, std::size_t begin) {
        std::size_t at = begin;
        int depth = 1; // 2 in braces behind `interpret`
        for (const LsysStatement& statement : outline.statements) {
            plan_between(scanner, at, statement.begin, depth);
            plan_statement(statement, depth);
            at = std::max(at, statement.end);
        }
        plan_between(scanner, at, outline.end, depth);
    }

    /// Comments, and the braces of sections.
    void plan_between(const LsysScanner& scanner, std::size_t begin, std::size_t end, int& depth) {
        std::size_t line = line_at(begin) + 1;
        const auto plan_to = [&](std::size_t place, int lines_depth) {
            for (; line < lines_.size() && lines_[line].begin <= place; ++line)
                plan_block(line, lines_depth);
        };
        for (std::size_t at = begin; at < end; ++at) {
            if (const std::size_t close = std::min(scanner.comment_end(at), end); close > at) {
                keep_comments(at, close);
                at = close;
                if (at == end) break;
            }
            if (text_[at] == '{') {
                plan_to(at, depth);
                ++depth;
            } else if (text_[at] == '}') {
                plan_to(at, depth - (lines_[line_at(at)].text == at ? 1 : 0));
                --depth;
            }
        }
        plan_to(end, depth);
    }

    void plan_statement(const LsysStatement& statement, int depth) {
        const std::size_t first = line_at(statement.begin);
        if (lines_[first].text == statement.begin) plan_block(first, depth);
        for (std::size_t line = first + 1; line < lines_.size() && lines_[line].begin < statement.end; ++line)
            plans_[line] = {Layout::goes_on, depth, first};
    }

    void lay_out_arrow(Span arrow) {
        if (arrow.begin > 0 && !is_blank(text_[arrow.begin - 1]) && text_[arrow.begin - 1] != '\n')
            set(arrow.begin, arrow.begin, " ");
        if (arrow.end < text_.size() && !is_blank(text_[arrow.end]) && text_[arrow.end] != '\n')
            set(arrow.end, arrow.end, " ");
    }

    // Lines

    void lay_out_lines() {
        std::vector<std::size_t> indents(lines_.size());
        bool after_blank = true; // at the beginning of the text
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const Line& line = lines_[i];
            const LinePlan& plan = plans_[i];
            indents[i] = line.indent();
            if (plan.layout == Layout::kept) {
                after_blank = false;
                continue;
            }
            if (line.empty() && plan.layout == Layout::block) {
                if (after_blank || closes_next(i) || i + 1 == lines_.size())
                    set(line.begin, std::min<std::size_t>(line.stop + 1, text_.size()), "");
                else
                    set(line.begin, line.stop, "");
                after_blank = true;
                continue;
            }
            if (!line.empty()) indents[i] = indent_of(i, plan, indents);
            // Trailing blanks, and in an empty line all.
            if (line.empty()) {
                set(line.begin, line.stop, "");
            } else {
                set(line.begin, line.text, std::string(indents[i], ' '));
                if (!inside_kept(i + 1)) set(line.end, line.stop, "");
            }
            after_blank = !line.empty() && text_[line.end - 1] == '{' && plan.layout == Layout::block;
        }
        if (!text_.empty() && text_.back() != '\n' && !lines_.empty() && !lines_.back().empty())
            set(text_.size(), text_.size(), "\n");
    }

    bool inside_kept(std::size_t line) const {
        return line < plans_.size() && plans_[line].layout == Layout::kept;
    }

    /// Whether only empty lines stand between this line and a '}' or the end of the text.
    bool closes_next(std::size_t line) const {
        while (line < lines_.size() && lines_[line].empty())
            ++line;
        return line == lines_.size() ||
               (text_[lines_[line].text] == '}' && plans_[line].layout == Layout::block);
    }

    std::size_t indent_of(std::size_t i, const LinePlan& plan,
                          const std::vector<std::size_t>& indents) const {
        const Line& line = lines_[i];
        if (plan.layout == Layout::goes_on) {
            const std::size_t before = lines_[plan.statement].indent(), now = indents[plan.statement];
            return line.indent() + now >= before ? line.indent() + now - before : 0;
        }
        const std::size_t wanted = unit_ * static_cast<std::size_t>(plan.depth);
        const bool tabs = text_.substr(line.begin, line.indent()).find('\t') != std::string_view::npos;
        if (tabs || line.indent() <= wanted || plan.depth == 0) return wanted;
        // Numbers in columns begin with their signs.
        const char first = text_[line.text];
        const bool number = (first >= '0' && first <= '9') || first == '.' || first == '-';
        const bool column = number && line.indent() < wanted + unit_;
        return column || (line.indent() >= wanted + lined_up && !is_brace(first)) ? line.indent() : wanted;
    }

    static bool is_brace(char c) { return c == '{' || c == '}'; }

    const Document& document_;
    std::string_view text_;
    std::vector<Line> lines_;
    std::vector<LinePlan> plans_;
    std::size_t unit_;
    std::vector<TextEdit> edits_;
};

/// Whether a value may end with the token: a sign behind it may go on with that value.
bool may_end_value(const Token& token) {
    return token.kind != TokenKind::symbol || token.is(")") || token.is("]") || token.is(">");
}

/// The words of a text, with the white space that counts: that between a value and a sign.
std::string meaning_of(const Document& document) {
    std::string words;
    const std::string_view text = document.text();
    if (document.lsys()) {
        Diagnostics ignored;
        const LsysScanner scanner(document.sources(), 0, ignored);
        for (std::size_t begin = 0; const auto header = scanner.find_block(begin);) {
            const std::size_t open = text.find('{', header->begin);
            if (open == std::string_view::npos) break;
            const LsysOutline outline = scanner.outline(open + 1);
            for (const LsysStatement& statement : outline.statements)
                words += std::string(text.substr(statement.begin, statement.end - statement.begin)) + "\x01";
            begin = outline.end;
        }
        std::erase_if(words, [](char c) { return is_blank(c) || c == '\n'; });
        return words;
    }
    Diagnostics ignored;
    bool after_value = false;
    for (const Token& token :
         lex_range(document.sources(), {0, 0, static_cast<std::uint32_t>(text.size())}, ignored)) {
        if (token.kind == TokenKind::end) break;
        const bool sign = token.is("-") || token.is("+") || token.is("<") || token.is("[");
        words += token.first_on_line ? '\n' : sign && after_value && token.space_before ? ' ' : '\x01';
        words += token.text;
        after_value = may_end_value(token);
    }
    return words;
}

} // namespace

std::vector<TextEdit> format(const Document& document) {
    if (!document.language() || document.findings().has_errors()) return {};
    std::vector<TextEdit> edits = Formatter(document).run();
    const Document after(document.name(), applied(document.text(), edits));
    if (after.findings().has_errors() || meaning_of(after) != meaning_of(document)) return {};
    return edits;
}

} // namespace graftal
