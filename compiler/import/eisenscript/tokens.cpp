#include "compiler/import/eisenscript/tokens.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/number.h"
#include "compiler/support/small_letters.h"

namespace graftal::eisenscript {

namespace {

constexpr std::size_t most_characters = 1'000'000;      ///< after substitution
constexpr std::size_t most_search_work = 1'000'000'000; ///< characters that are searched for names
constexpr int most_substitutions = 100;                 ///< in one line, as in Structure Synth

/// A character of the text after substitution.
struct Character {
    char c = 0;
    std::uint32_t origin = 0;   ///< its place in the file, or that of the name it replaces
    std::int32_t constant = -1; ///< of the `#define` that gave it
};

struct Define {
    std::string name;
    std::string value;
    Span span;
    std::string remark;
};

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

/// `1/3` too.
std::optional<double> number_of(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) {
        if (text.ends_with('.')) text.remove_suffix(1);
        return parse_number(text);
    }
    const std::optional<double> above = parse_number(text.substr(0, slash));
    const std::optional<double> below = parse_number(text.substr(slash + 1));
    if (!above || !below || *below == 0) return std::nullopt;
    return *above / *below;
}

class Preprocessor {
  public:
    explicit Preprocessor(const ForeignFile& file) : file_(file) {}

    std::vector<Character> run() {
        const std::string_view text = file_.text();
        std::size_t begin = 0;
        while (begin < text.size() && good_) {
            const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
            if (text[begin] == '#')
                command(text.substr(begin, end - begin), begin);
            else
                substitute(text, begin, end);
            if (end < text.size()) out_.push_back({'\n', static_cast<std::uint32_t>(end)});
            begin = end + 1;
        }
        return std::move(out_);
    }

    const std::vector<Define>& defines() const { return defines_; }

  private:
    void command(std::string_view line, std::size_t begin) {
        const Span span = file_.span(begin, begin + line.size());
        if (!line.starts_with("#define") || line.size() < 9 || !is_blank(line[7])) {
            if (line.starts_with("#javascript"))
                file_.diagnostics.error(span, "a program in JavaScript around the script is not translated");
            else
                file_.diagnostics.warning(
                    span, fmt::format("'{}' is no '#define', and changes nothing here",
                                      comment_text(line.substr(0, line.find_first_of(" \t")))));
            return;
        }
        std::string_view rest = trimmed(line.substr(8));
        const std::size_t space = std::min(rest.find_first_of(" \t"), rest.size());
        Define define{std::string(rest.substr(0, space)), {}, span, {}};
        rest = trimmed(rest.substr(space));
        for (const std::string_view kind : {"(float:", "(int:"})
            if (const std::size_t range = rest.find(kind); range != std::string_view::npos) {
                define.remark = std::string(rest.substr(range));
                rest = trimmed(rest.substr(0, range));
            }
        if (const std::size_t comment = rest.find("//"); comment != std::string_view::npos) {
            define.remark += std::string(trimmed(rest.substr(comment + 2)));
            rest = trimmed(rest.substr(0, comment));
        }
        define.value = std::string(rest);
        if (define.value.find(define.name) != std::string::npos)
            fail(span, fmt::format("'{}' stands for itself", define.name), {});
        const auto known = names_.find(define.name);
        if (known != names_.end())
            defines_[known->second] = std::move(define);
        else {
            names_.emplace(define.name, defines_.size());
            defines_.push_back(std::move(define));
        }
    }

    void fail(Span span, std::string message, std::string hint) {
        if (good_) file_.diagnostics.error(span, std::move(message)).with_hint(std::move(hint));
        good_ = false;
    }

    void substitute(std::string_view text, std::size_t begin, std::size_t end) {
        std::vector<Character> line;
        for (std::size_t i = begin; i < end; ++i)
            line.push_back({text[i], static_cast<std::uint32_t>(i)});
        std::string plain(text.substr(begin, end - begin));
        int count = 0;
        for (auto name = names_.begin(); name != names_.end() && good_;) {
            searched_ += plain.size() + 20;
            if (searched_ > most_search_work) {
                fail(file_.span(begin, end), "the substitutions of the script take too long",
                     "the script has too many '#define's for its length: write numbers in their place");
                break;
            }
            if (plain.find(name->first) == std::string::npos) {
                ++name;
                continue;
            }
            if (++count > most_substitutions)
                fail(file_.span(begin, end), "this line has more than 100 substitutions",
                     "Structure Synth takes no more either: divide the line");
            replace(line, plain, name->first, name->second);
            name = names_.begin();
        }
        out_.insert(out_.end(), line.begin(), line.end());
    }

    void replace(std::vector<Character>& line, std::string& plain, const std::string& name,
                 std::size_t define) {
        const std::string& value = defines_[define].value;
        std::vector<Character> replaced;
        std::string text;
        std::size_t at = 0;
        while (good_) {
            const std::size_t found = std::min(plain.find(name, at), plain.size());
            replaced.insert(replaced.end(), line.begin() + static_cast<std::ptrdiff_t>(at),
                            line.begin() + static_cast<std::ptrdiff_t>(found));
            text.append(plain, at, found - at);
            if (found == plain.size()) break;
            for (const char c : value)
                replaced.push_back({c, line[found].origin, static_cast<std::int32_t>(define)});
            text += value;
            at = found + name.size();
            if (out_.size() + replaced.size() <= most_characters) continue;
            fail(defines_[define].span,
                 fmt::format("the substitutions make a text of more than {} characters", most_characters),
                 "shorten this text, or the lines that use it");
        }
        line = std::move(replaced);
        plain = std::move(text);
    }

    const ForeignFile& file_;
    std::map<std::string, std::size_t> names_; ///< in their order, as Structure Synth tries them
    std::vector<Define> defines_;
    std::vector<Character> out_;
    std::size_t searched_ = 0;
    bool good_ = true;
};

class Tokenizer {
  public:
    Tokenizer(const ForeignFile& file, std::vector<Character> text, const std::vector<Define>& defines)
        : file_(file), text_(std::move(text)), defines_(defines) {}

    Tokens run() {
        while (at_ < text_.size() && !file_.diagnostics.full())
            step();
        Token end{.kind = TokenKind::end, .text = "", .written = "the end of the file"};
        const std::size_t size = file_.text().size();
        end.span = file_.span(size, size);
        end.comments = std::move(comments_);
        tokens_.list.push_back(std::move(end));
        for (const Define& define : defines_)
            if (const std::optional<double> number = number_of(define.value))
                tokens_.constants.push_back({define.name, *number, define.span, define.remark});
        std::ranges::move(randoms_, std::back_inserter(tokens_.constants));
        return std::move(tokens_);
    }

  private:
    char peek(std::size_t ahead = 0) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead].c : '\0';
    }

    void step() {
        const char c = peek();
        if (is_blank(c)) {
            ++at_;
        } else if (c == '/' && peek(1) == '/') {
            take_comment("\n", 2);
        } else if (c == '/' && peek(1) == '*') {
            take_comment("*/", 2);
        } else if (c == '{' || c == '}' || c == '*' || c == '>') {
            const TokenKind kind = c == '{'   ? TokenKind::open
                                   : c == '}' ? TokenKind::close
                                   : c == '*' ? TokenKind::times
                                              : TokenKind::more;
            add(kind, at_, at_ + 1);
            ++at_;
        } else {
            take_word();
        }
    }

    void take_comment(std::string_view end, std::size_t skip) {
        at_ += skip;
        std::string words;
        const auto done = [&] {
            comments_.push_back(std::string(trimmed(words)));
            if (comments_.back().empty()) comments_.pop_back();
            words.clear();
        };
        while (at_ < text_.size()) {
            if (peek() == end[0] && (end.size() == 1 || peek(1) == end[1])) {
                at_ += end.size();
                break;
            }
            if (peek() == '\n' || peek() == '\r')
                done();
            else
                words += peek();
            ++at_;
        }
        done();
    }

    /// Takes a word, up to white space or a brace; brackets hold it together.
    void take_word() {
        const std::size_t begin = at_;
        bool inside = false;
        while (at_ < text_.size()) {
            const char c = peek();
            if (inside ? c == ']' : is_blank(c) || c == '{' || c == '}' || c == '*' || c == '>') break;
            if (!inside && c == '/' && (peek(1) == '/' || peek(1) == '*')) break;
            if (c == '[') inside = true;
            ++at_;
        }
        if (inside && peek() == ']') {
            ++at_;
        } else if (inside) {
            file_.diagnostics.error(origin(begin, begin + 1), "this '[' has no ']'");
        }
        add(TokenKind::word, begin, at_);
    }

    Span origin(std::size_t begin, std::size_t end) const {
        const std::uint32_t first = text_[begin].origin, last = text_[end - 1].origin;
        return file_.span(first, std::max(first, last) + 1);
    }

    void add(TokenKind kind, std::size_t begin, std::size_t end) {
        Token token{.kind = kind, .span = origin(begin, end)};
        for (std::size_t i = begin; i < end; ++i)
            if (!is_blank(text_[i].c) || token.written.find('[') != std::string::npos)
                token.written += text_[i].c;
        token.text = in_small_letters(token.written);
        token.comments = std::exchange(comments_, {});
        if (kind == TokenKind::word) read_number(token, begin, end);
        tokens_.list.push_back(std::move(token));
    }

    void read_number(Token& token, std::size_t begin, std::size_t end) {
        if (token.text.starts_with("random[")) return draw(token);
        const bool number = std::string_view("+-.0123456789").find(token.text[0]) != std::string_view::npos;
        if (!number || token.text == "+" || token.text == "-") return;
        const std::optional<double> value = number_of(token.text);
        if (!value || !(std::abs(*value) <= 1e100)) {
            file_.diagnostics.error(token.span, fmt::format("'{}' is not a number", token.written));
            return;
        }
        token.kind = TokenKind::number;
        token.number = *value;
        token.whole = *value == std::floor(*value) && std::abs(*value) <= 1e9;
        const std::int32_t constant = text_[begin].constant;
        for (std::size_t i = begin; i < end; ++i)
            if (text_[i].constant != constant) return;
        if (constant >= 0 && number_of(defines_[static_cast<std::size_t>(constant)].value) == value)
            token.constant = defines_[static_cast<std::size_t>(constant)].name;
    }

    /// `random[0,1]` is one number for the whole script.
    void draw(Token& token) {
        const std::size_t comma = token.text.find(',');
        const auto part = [&](std::size_t from, std::size_t to) {
            return number_of(token.text.substr(from, to - from));
        };
        const std::optional<double> least = comma < token.text.size() ? part(7, comma) : std::nullopt;
        const std::optional<double> most =
            comma < token.text.size() ? part(comma + 1, token.text.size() - 1) : std::nullopt;
        if (!least || !most) {
            file_.diagnostics.error(token.span, "a random number is written random[0,1]");
            return;
        }
        const std::uint64_t bits = CounterRandom::scrambled(randoms_.size() + 1);
        const double share = static_cast<double>(bits >> 11) * 0x1p-53;
        token.kind = TokenKind::number;
        token.number = std::round(1e4 * (*least + share * (*most - *least))) / 1e4;
        token.constant = fmt::format("random{}", randoms_.size() + 1);
        randoms_.push_back({token.constant, token.number, token.span, token.written});
    }

    const ForeignFile& file_;
    std::vector<Character> text_;
    const std::vector<Define>& defines_;
    std::size_t at_ = 0;
    std::vector<std::string> comments_;
    std::vector<Constant> randoms_;
    Tokens tokens_;
};

} // namespace

Tokens tokenize(const ForeignFile& file) {
    Preprocessor preprocessor(file);
    std::vector<Character> text = preprocessor.run();
    return Tokenizer(file, std::move(text), preprocessor.defines()).run();
}

} // namespace graftal::eisenscript
