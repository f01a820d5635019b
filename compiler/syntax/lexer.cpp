#include "compiler/syntax/lexer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/printable.h"
#include "compiler/support/srgb.h"
#include "compiler/syntax/lookalikes.h"

namespace graftal {

namespace {

constexpr std::string_view one_character_symbols = "{}()[]<>,:;=+-*/%^!~?";
constexpr std::array<std::string_view, 8> two_character_symbols = {
    "->", "==", "!=", "<=", ">=", "&&", "||", ".."};

/// A token takes about 40 bytes and its syntax tree about as much again.
constexpr std::size_t max_tokens = 16'000'000;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

bool is_in_name(char c) {
    return is_letter(c) || is_digit(c);
}

/// The size of `#rgb`, `#rrggbb` or `#rrggbbaa` at the beginning of a text, or 0.
std::size_t hex_colour_size(std::string_view text) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789abcdefABCDEF", 1), text.size());
    if (end != 4 && end != 7 && end != 9) return 0;
    return end < text.size() && is_letter(text[end]) ? 0 : end;
}

/// The colour of a text that hex_colour_size() accepts, in linear light.
std::array<double, 3> hex_colour(std::string_view text) {
    const Rgb encoded = srgb_from_hex(text.substr(1, text.size() == 4 ? 3 : 6)).value_or(Rgb(0.0));
    std::array<double, 3> rgb{};
    for (int i = 0; i < 3; ++i)
        rgb[static_cast<std::size_t>(i)] = std::round(linear_from_srgb(encoded[i]) * 1000) / 1000;
    return rgb;
}

class Lexer {
  public:
    Lexer(const SourceMap& sources, Span range, Diagnostics& diagnostics)
        : text_(sources.text(range.file).substr(0, range.end)), file_(range.file), begin_(range.begin),
          diagnostics_(diagnostics), at_(range.begin) {}

    std::vector<Token> run() {
        if (begin_ == 0 && text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) refuse_utf16();
        bool more = true;
        while ((more = skip_blanks()) && tokens_.size() < max_tokens && !diagnostics_.full())
            lex_token();
        if (more && tokens_.size() >= max_tokens)
            diagnostics_.error(span_from(at_), fmt::format("the model has more than {} words", max_tokens));
        const std::size_t end = tokens_.empty() ? begin_ : tokens_.back().span.end;
        at_ = end;
        add(TokenKind::end, end);
        return std::move(tokens_);
    }

  private:
    char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
    Span span_from(std::size_t begin) const {
        return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_)};
    }

    /// Adds the token from `begin` to here.
    Token& add(TokenKind kind, std::size_t begin) {
        Token token;
        token.kind = kind;
        token.first_on_line = first_on_line_;
        token.space_before = space_before_;
        token.span = span_from(begin);
        token.text = text_.substr(begin, at_ - begin);
        first_on_line_ = space_before_ = false;
        tokens_.push_back(token);
        return tokens_.back();
    }

    void refuse_utf16() {
        if (begin_ == 0)
            diagnostics_.error({file_, 0, 0}, "this text is in UTF-16")
                .with_hint("save the file in the encoding UTF-8");
        at_ = text_.size();
    }

    /// Skips white space and comments; false at the end of the text.
    bool skip_blanks() {
        for (; at_ < text_.size(); space_before_ = true) {
            if (is_blank(peek())) {
                first_on_line_ |= peek() == '\n';
                ++at_;
            } else if (at_hex_colour()) {
                return true;
            } else if (peek() == '#' || text_.substr(at_, 2) == "//") {
                skip_line_comment();
            } else if (text_.substr(at_, 2) == "/*") {
                skip_block_comment();
            } else {
                return true;
            }
        }
        return false;
    }

    /// Whether a '#' begins a colour, not a comment: it stands where a colour is asked for.
    bool at_hex_colour() const {
        if (peek() != '#' || first_on_line_ || tokens_.empty()) return false;
        const Token& before = tokens_.back();
        const bool asked = before.is(":") || before.is("rgb") || before.is("color") || before.is("tint") ||
                           before.is("background") || before.is("zenith") || before.is("horizon");
        return asked && hex_colour_size(text_.substr(at_)) > 0;
    }

    void skip_line_comment() {
        const std::size_t begin = at_;
        at_ = std::min(text_.find('\n', at_), text_.size());
        const std::string_view line = text_.substr(begin, at_ - begin);
        if (!first_on_line_ || (!line.starts_with("#define ") && !line.starts_with("#include "))) return;
        diagnostics_.warning(span_from(begin), "this line is a comment, because it begins with '#'")
            .with_hint(line[1] == 'd' ? "'let NAME = VALUE' names a number"
                                      : "write 'use NAME = \"FILE\"' to load another model");
    }

    void skip_block_comment() {
        const std::size_t begin = at_;
        const std::size_t close = text_.find("*/", at_ + 2);
        at_ = begin + 2;
        if (close == std::string_view::npos) {
            diagnostics_.error(span_from(begin), "this comment is not closed")
                .with_hint("close it with '*/'");
            at_ = text_.size();
            return;
        }
        first_on_line_ |= text_.substr(at_, close - at_).find('\n') != std::string_view::npos;
        at_ = close + 2;
    }

    void lex_token() {
        const std::size_t begin = at_;
        const char c = peek();
        if (is_letter(c)) return lex_name();
        if (is_digit(c) || (c == '.' && is_digit(peek(1)))) return lex_number();
        if (c == '"') return lex_string();
        if (c == '#') return lex_hex_colour();
        for (const std::string_view symbol : two_character_symbols)
            if (text_.substr(at_, 2) == symbol) {
                at_ += 2;
                add(TokenKind::symbol, begin);
                return;
            }
        if (c != '\0' && one_character_symbols.find(c) != std::string_view::npos) {
            ++at_;
            add(TokenKind::symbol, begin);
            return;
        }
        lex_stray();
    }

    void lex_name() {
        const std::size_t begin = at_;
        while (is_in_name(peek()) || (peek() == '.' && is_letter(peek(1))))
            ++at_;
        if ((peek() & 0x80) != 0 && is_foreign_letter(code_point(text_, at_).value))
            return lex_foreign(begin);
        add(TokenKind::name, begin);
    }

    /// A name with letters of other alphabets: reported, and then read as one name.
    void lex_foreign(std::size_t begin) {
        const std::size_t first = at_;
        while (at_ < text_.size()) {
            if (!is_in_name(peek()) && !is_foreign_letter(code_point(text_, at_).value)) break;
            at_ += code_point(text_, at_).size;
        }
        report_stray(first, code_point(text_, first).size);
        add(TokenKind::name, begin);
    }

    /// Reported, and then read as its three numbers.
    void lex_hex_colour() {
        const std::size_t begin = at_;
        at_ += hex_colour_size(text_.substr(at_));
        const std::array<double, 3> rgb = hex_colour(text_.substr(begin, at_ - begin));
        diagnostics_.error(span_from(begin), "a colour is three numbers, and '#' begins a comment")
            .with_hint(fmt::format("write linear red, green and blue from 0 to 1: {}, {}, {}",
                                   shortest(rgb[0]), shortest(rgb[1]), shortest(rgb[2])));
        const auto say = [&](double number) {
            Token& token = add(TokenKind::number, begin);
            token.number = number;
            token.space_before = true;
        };
        const std::size_t before = tokens_.size();
        const bool tint = tokens_[before - 1].is("tint") || (before > 1 && tokens_[before - 2].is("tint"));
        for (const double part : rgb)
            say(part);
        if (tint) say(1); // the alpha is another matter
    }

    void lex_number() {
        const std::size_t begin = at_;
        while (is_digit(peek()))
            ++at_;
        if (peek() == '.' && peek(1) != '.') ++at_; // `0..360` is a range
        while (is_digit(peek()))
            ++at_;
        const std::size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
        if ((peek() == 'e' || peek() == 'E') && is_digit(peek(1 + sign))) {
            at_ += 1 + sign;
            while (is_digit(peek()))
                ++at_;
        }
        Token& token = add(TokenKind::number, begin);
        const std::optional<double> number = parse_number(token.text);
        token.number = number.value_or(1); // so that nothing else is said about it
        if (!number) diagnostics_.error(token.span, "this number is too large");
    }

    void lex_string() {
        const std::size_t begin = at_++;
        const std::size_t close = text_.find_first_of("\"\n", at_);
        const bool closed = close != std::string_view::npos && text_[close] == '"';
        at_ = closed ? close + 1 : std::min(close, text_.size());
        if (!closed)
            diagnostics_.error(span_from(begin), "this string is not closed on its line")
                .with_hint("close it with '\"'");
        Token& token = add(TokenKind::string, begin);
        token.text = token.text.substr(1, token.text.size() - (closed ? 2 : 1));
    }

    /// A string in quotes that are none of ours, if it is closed on its line.
    bool lex_misquoted() {
        const std::size_t begin = at_, size = code_point(text_, at_).size;
        for (std::size_t at = begin + size; at < text_.size() && text_[at] != '\n';) {
            const CodePoint point = code_point(text_, at);
            const std::optional<Lookalike> look = lookalike(point.value);
            if (point.value == '"' || point.value == '\'' || (look && look->meant == "\"")) {
                at_ = at + point.size;
                report_stray(begin, size);
                add(TokenKind::string, begin).text = text_.substr(begin + size, at - begin - size);
                return true;
            }
            at += point.size;
        }
        return false;
    }

    /// One character that starts no token; a run of them is reported once. Its likely meaning is read, so
    /// that nothing else is reported for it.
    void lex_stray() {
        const std::size_t begin = at_;
        const CodePoint point = code_point(text_, at_);
        const std::optional<Lookalike> look = lookalike(point.value);
        const bool quote = point.value == '\'' || (look && look->meant == "\"");
        if (quote && lex_misquoted()) return;
        if (is_foreign_letter(point.value)) return lex_foreign(begin);
        at_ += point.size;
        report_stray(begin, point.size);
        space_before_ = true;
        if (!look || look->meant == " ") return;
        const char meant = look->meant[0];
        if (is_digit(meant)) {
            add(TokenKind::number, begin).number = meant - '0';
        } else if (look->meant.size() > 1 || one_character_symbols.find(meant) != std::string_view::npos) {
            add(TokenKind::symbol, begin).text = look->meant;
        }
    }

    /// Each character once, and a run of characters once.
    void report_stray(std::size_t begin, std::size_t size) {
        const bool goes_on = begin > 0 && last_stray_end_ == begin;
        last_stray_end_ = begin + size;
        const std::string_view character = text_.substr(begin, size);
        if (!strays_.insert(code_point(character, 0).value).second || goes_on) return;
        const Span span{file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(begin + size)};
        diagnostics_.error(span, unexpected_character(character)).with_hint(lookalike_hint(character));
    }

    std::string_view text_;
    FileId file_;
    std::size_t begin_;
    Diagnostics& diagnostics_;
    std::vector<Token> tokens_;
    std::size_t at_;
    std::size_t last_stray_end_ = 0;
    std::set<char32_t> strays_; ///< reported; bytes that are no UTF-8 count as one
    bool first_on_line_ = true;
    bool space_before_ = true;
};

} // namespace

std::vector<Token> lex(const SourceMap& sources, FileId file, Diagnostics& diagnostics) {
    const auto size = static_cast<std::uint32_t>(sources.text(file).size());
    return Lexer(sources, Span{file, 0, size}, diagnostics).run();
}

std::vector<Token> lex_range(const SourceMap& sources, Span range, Diagnostics& diagnostics) {
    return Lexer(sources, range, diagnostics).run();
}

std::vector<Token> lex_beginning(const SourceMap& sources, FileId file) {
    constexpr std::size_t most_bytes = 4096;
    Diagnostics ignored;
    const std::size_t size = std::min(sources.text(file).size(), most_bytes);
    return lex_range(sources, {file, 0, static_cast<std::uint32_t>(size)}, ignored);
}

} // namespace graftal
