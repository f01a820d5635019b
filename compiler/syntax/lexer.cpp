#include "compiler/syntax/lexer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include <fmt/format.h>

namespace graftal {

namespace {

constexpr std::string_view one_character_symbols = "{}()[]<>,:;=+-*/%^!~?";
constexpr std::array<std::string_view, 8> two_character_symbols = {"->", "==", "!=", "<=",
                                                                   ">=", "&&", "||", ".."};

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

/// True for a number text too small for a double, false for one too large: by the place of its first
/// digit that counts.
bool underflows(std::string_view text) {
    const std::size_t e = text.find_first_of("eE");
    const std::string_view mantissa = text.substr(0, e);
    if (e != std::string_view::npos && text.substr(e + 1).starts_with('-')) return true;
    const std::size_t dot = mantissa.find('.');
    return dot != std::string_view::npos && mantissa.find_first_of("123456789") > dot;
}

class Lexer {
  public:
    Lexer(const SourceMap& sources, Span range, Diagnostics& diagnostics)
        : text_(sources.text(range.file).substr(0, range.end)), file_(range.file), begin_(range.begin),
          diagnostics_(diagnostics), at_(range.begin) {}

    std::vector<Token> run() {
        if (begin_ == 0 && text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        while (skip_blanks() && tokens_.size() < max_tokens && !diagnostics_.full())
            lex_token();
        if (tokens_.size() >= max_tokens)
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

    /// Skips white space and comments; false at the end of the text.
    bool skip_blanks() {
        for (; at_ < text_.size(); space_before_ = true) {
            if (is_blank(peek())) {
                first_on_line_ |= peek() == '\n';
                ++at_;
            } else if (peek() == '#' || text_.substr(at_, 2) == "//") {
                at_ = std::min(text_.find('\n', at_), text_.size());
            } else if (text_.substr(at_, 2) == "/*") {
                skip_block_comment();
            } else {
                return true;
            }
        }
        return false;
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
        while (is_letter(peek()) || is_digit(peek()) || (peek() == '.' && is_letter(peek(1))))
            ++at_;
        add(TokenKind::name, begin);
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
        const char* last = token.text.data() + token.text.size();
        const std::from_chars_result result = std::from_chars(token.text.data(), last, token.number);
        if (result.ec != std::errc::result_out_of_range) return;
        token.number = 0;
        if (!underflows(token.text)) diagnostics_.error(token.span, "this number is too large");
    }

    void lex_string() {
        const std::size_t begin = at_++;
        const std::size_t close = text_.find_first_of("\"\n", at_);
        const bool closed = close != std::string_view::npos && text_[close] == '"';
        at_ = closed ? close + 1 : std::min(close, text_.size());
        if (!closed) diagnostics_.error(span_from(begin), "this string is not closed on its line");
        Token& token = add(TokenKind::string, begin);
        token.text = token.text.substr(1, token.text.size() - (closed ? 2 : 1));
    }

    /// One character, in UTF-8, that starts no token; a run of them is reported once.
    void lex_stray() {
        const std::size_t begin = at_++;
        while ((peek() & 0xC0) == 0x80)
            ++at_;
        space_before_ = true;
        if (last_stray_end_ == begin && begin > 0) {
            last_stray_end_ = at_;
            return;
        }
        last_stray_end_ = at_;
        const auto byte = static_cast<unsigned char>(text_[begin]);
        const bool visible = byte > 0x20 && byte < 0x7F;
        const bool utf8 = byte >= 0xC2 && at_ - begin >= 2 && at_ - begin <= 4;
        diagnostics_.error(span_from(begin), visible || utf8 ? fmt::format("unexpected character '{}'",
                                                                           text_.substr(begin, at_ - begin))
                                                             : fmt::format("unexpected byte 0x{:02X}", byte));
    }

    std::string_view text_;
    FileId file_;
    std::size_t begin_;
    Diagnostics& diagnostics_;
    std::vector<Token> tokens_;
    std::size_t at_;
    std::size_t last_stray_end_ = 0;
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

} // namespace graftal
