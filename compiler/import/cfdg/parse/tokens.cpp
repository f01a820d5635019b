#include "compiler/import/cfdg/parse/tokens.h"

#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

/// Longer ones first.
constexpr std::array<std::string_view, 12> long_signs = {"+/-", "..", "<=", ">=", "==", "<>",
                                                         "&&",  "||", "^^", "--", "::", "*/"};

/// Signs of Unicode and what they stand for.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> other_signs = {
    {{"\u2026", ".."},
     {"\u00b1", "+/-"},
     {"\u2264", "<="},
     {"\u2265", ">="},
     {"\u2260", "<>"},
     {"\u221e", "infinity"}}};

bool begins_word(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

class Tokenizer {
  public:
    explicit Tokenizer(const ForeignFile& file) : file_(file), text_(file.text()) {}

    std::vector<Token> run() {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
        while (at_ < text_.size() && !file_.diagnostics.full())
            step();
        add(TokenKind::end, text_.size(), "the end of the file");
        return std::move(tokens_);
    }

  private:
    char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    void step() {
        const char c = peek();
        if (c == ' ' || (c >= '\t' && c <= '\r')) {
            ++at_;
        } else if (c == '#' || (c == '/' && peek(1) == '/')) {
            comment(c == '#' ? 1 : 2, text_.find_first_of("\r\n", at_), 0);
        } else if (c == '/' && peek(1) == '*') {
            comment(2, text_.find("*/", at_ + 2), 2);
        } else if (c == '"') {
            const std::size_t end = std::min(text_.find('"', at_ + 1), text_.size());
            if (end == text_.size())
                file_.diagnostics.error(file_.span(at_, at_ + 1), "this '\"' has no other");
            const std::string words(text_.substr(at_ + 1, end - at_ - 1));
            at_ = std::min(end + 1, text_.size());
            add(TokenKind::text, at_, words);
        } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
            number();
        } else if (unicode()) {
        } else if (begins_word(c)) {
            word(0);
        } else if (c == '|' && peek(1) != '|' && begins_word(peek(1)) && !targets_before()) {
            word(1);
        } else {
            sign();
        }
    }

    /// `b 0.1|hue 3`: the bar behind a number belongs to it.
    bool targets_before() const {
        if (tokens_.empty() || tokens_.back().span.end != at_) return false;
        return tokens_.back().kind == TokenKind::number || tokens_.back().is(")");
    }

    void comment(std::size_t skip, std::size_t end, std::size_t close) {
        end = std::min(end, text_.size());
        std::string_view rest = text_.substr(at_ + skip, end - at_ - skip);
        while (!rest.empty()) {
            const std::size_t stop = std::min(rest.find_first_of("\r\n"), rest.size());
            std::string_view line = rest.substr(0, stop);
            while (!line.empty() && (line.front() == ' ' || line.front() == '\t' || line.front() == '*' ||
                                     line.front() == '/'))
                line.remove_prefix(1);
            if (!line.empty()) comments_.emplace_back(line);
            rest.remove_prefix(std::min(stop + 1, rest.size()));
        }
        at_ = std::min(end + close, text_.size());
    }

    bool unicode() {
        for (const auto& [written, meant] : other_signs)
            if (text_.substr(at_).starts_with(written)) {
                at_ += written.size();
                add(meant == "infinity" ? TokenKind::word : TokenKind::sign, at_, std::string(meant),
                    written.size());
                return true;
            }
        return false;
    }

    bool at_unicode_sign(std::size_t place) const {
        for (const auto& row : other_signs)
            if (text_.substr(place).starts_with(row.first)) return true;
        return false;
    }

    void word(std::size_t bar) {
        const std::size_t begin = at_;
        at_ += bar;
        while (at_ < text_.size() &&
               (begins_word(peek()) || is_digit(peek()) || (peek() == ':' && peek(1) == ':'))) {
            if (at_unicode_sign(at_)) break;
            at_ += peek() == ':' ? 2 : 1;
        }
        add(TokenKind::word, at_, std::string(text_.substr(begin, at_ - begin)), at_ - begin);
    }

    void number() {
        const std::size_t begin = at_;
        while (is_digit(peek()))
            ++at_;
        if (peek() == '.' && peek(1) != '.') {
            ++at_;
            while (is_digit(peek()))
                ++at_;
        }
        if ((peek() == 'e' || peek() == 'E') &&
            (is_digit(peek(1)) || ((peek(1) == '-' || peek(1) == '+') && is_digit(peek(2))))) {
            at_ += 2;
            while (is_digit(peek()))
                ++at_;
        }
        std::string digits(text_.substr(begin, at_ - begin));
        if (digits.ends_with('.')) digits.pop_back();
        const std::optional<double> value = parse_number(digits);
        if (!value || *value > 1e100)
            file_.diagnostics.error(file_.span(begin, at_), fmt::format("'{}' is not a number", digits));
        const bool percent = peek() == '%';
        if (percent) ++at_;
        add(TokenKind::number, at_, digits, at_ - begin);
        tokens_.back().number = value.value_or(0) / (percent ? 100 : 1);
        tokens_.back().percent = percent;
    }

    void sign() {
        for (const std::string_view known : long_signs)
            if (text_.substr(at_).starts_with(known)) {
                at_ += known.size();
                return add(TokenKind::sign, at_, std::string(known), known.size());
            }
        const char c = peek();
        ++at_;
        // A dot stands in the names of files only, which the parser reads as a whole.
        if (std::string_view("{}[]()*,+-/^<>=!|;:@_.").find(c) != std::string_view::npos)
            return add(TokenKind::sign, at_, std::string(1, c), 1);
        file_.diagnostics.error(file_.span(at_ - 1, at_), "no word or sign begins like this");
    }

    void add(TokenKind kind, std::size_t end, std::string words, std::size_t size = 0) {
        Token token{.kind = kind, .text = std::move(words), .span = file_.span(end - size, end)};
        token.comments = std::exchange(comments_, {});
        tokens_.push_back(std::move(token));
    }

    const ForeignFile& file_;
    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<Token> tokens_;
    std::vector<std::string> comments_;
};

} // namespace

std::vector<Token> tokenize(const ForeignFile& file) {
    return Tokenizer(file).run();
}

} // namespace graftal::cfdg
