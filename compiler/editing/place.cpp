#include "compiler/editing/place.h"

#include <algorithm>
#include <optional>
#include <string>

#include "compiler/lsys/parse/scanner.h"
#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

namespace {

using P = WordPlace;

bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The name around a place.
Span name_around(std::string_view text, std::uint32_t offset) {
    std::uint32_t begin = offset, end = offset;
    while (begin > 0 && is_name_character(text[begin - 1]))
        --begin;
    while (end < text.size() && is_name_character(text[end]))
        ++end;
    const bool number = begin < end && text[begin] >= '0' && text[begin] <= '9';
    return number ? Span{0, offset, offset} : Span{0, begin, end};
}

/// Whether a place lies in a comment or in quotes, which begin at or after `begin`.
bool is_silent(std::string_view text, std::size_t begin, std::size_t offset, bool slashes) {
    for (std::size_t at = begin; at < offset;) {
        std::size_t end = at + 1;
        if (text[at] == '#' || (slashes && text.substr(at, 2) == "//"))
            end = std::min(text.find('\n', at), text.size());
        else if (slashes && text.substr(at, 2) == "/*")
            end = text.find("*/", at + 2) == std::string_view::npos ? text.size() + 1
                                                                    : text.find("*/", at + 2) + 2;
        else if (text[at] == '"')
            end = std::min(text.find_first_of("\"\n", at + 1), text.size() - 1) + 1;
        else {
            at = end;
            continue;
        }
        if (offset > at && (offset < end || (offset == end && text[at] != '"' && text.substr(at, 2) != "/*")))
            return true;
        at = end;
    }
    return false;
}

/// The block that begins at a '{', by the word that came before it.
P block_after(P around, std::string_view word) {
    if (around == P::rifs_file || around == P::rifs_block) {
        if (word == "rifs" || word == "main") return P::rifs_block;
        if (word == "orbit") return P::orbit;
        if (word == "map") return P::rifs_map;
    }
    if (around == P::inst_file && (word == "object" || word == "canonical")) return P::inst_body;
    if (around == P::inst_body) return word == "ink" ? P::ink : P::inst_body;
    constexpr std::pair<std::string_view, P> scene[] = {
        {"camera", P::camera}, {"light", P::light},       {"background", P::background},
        {"ground", P::ground}, {"material", P::material}, {"sky", P::sky},
        {"film", P::film},     {"haze", P::haze}};
    const bool file = around == P::rifs_file || around == P::inst_file || around == P::lsys_file;
    for (const auto& [name, place] : scene)
        if (file && word == name) return place;
    return around == P::orbit ? P::orbit : P::value;
}

/// Follows braces and keywords through tokens, up to a place.
class TokenWalk {
  public:
    TokenWalk(const Document& document, P file, Span range) : file_(file) {
        Diagnostics ignored;
        tokens_ = lex_range(document.sources(), range, ignored);
    }

    /// The surroundings of the word [begin, end).
    Place at(Span word) {
        for (const Token& token : tokens_) {
            if (token.kind == TokenKind::end || token.span.begin >= word.begin) {
                first_on_line_ =
                    token.kind != TokenKind::end && token.span.begin == word.begin && token.first_on_line;
                break;
            }
            take(token);
        }
        Place place;
        place.word = word;
        place.after = after_;
        const P around = stack_.empty() ? file_ : stack_.back().place;
        if (part() && around != P::inst_body) place.where.push_back(P::rifs_part);
        place.where.push_back(around);
        place.value = is_value();
        place.begins = begins();
        return place;
    }

    /// Whether the word stands first on its line, as far as the tokens know it.
    void set_first_on_line(bool first) { first_on_line_ |= first; }

  private:
    struct Block {
        P place;
        std::string_view item; ///< the last word that began an item in it
    };

    void take(const Token& token) {
        if (token.is("{")) {
            stack_.push_back({block_after(stack_.empty() ? file_ : stack_.back().place, item()), {}});
        } else if (token.is("}")) {
            if (!stack_.empty()) stack_.pop_back();
            item() = {};
        } else if (token.kind == TokenKind::name && is_word(token.text)) {
            item() = token.text;
        }
        keyword_ = token.kind == TokenKind::name && item() == token.text;
        if (!token.is(":") || after_kind_ != TokenKind::name) {
            after_ = token.text;
            after_kind_ = token.kind;
            after_keyword_ = keyword_;
        }
    }

    bool is_word(std::string_view text) {
        const P around = stack_.empty() ? file_ : stack_.back().place;
        return word_in(around, text) || (part() && word_in(P::rifs_part, text));
    }

    bool part() { return item() == "condense" || item() == "terminal"; }

    std::string_view& item() { return stack_.empty() ? item_ : stack_.back().item; }

    bool is_value() const {
        if (after_kind_ == TokenKind::symbol) return after_ != "{" && after_ != "}" && after_ != ")";
        return after_keyword_ || after_kind_ == TokenKind::number;
    }

    bool begins() const {
        if (after_kind_ == TokenKind::end || first_on_line_) return true;
        if (after_kind_ == TokenKind::symbol)
            return after_ == "{" || after_ == "}" || after_ == ")" || after_ == ">";
        return !after_keyword_;
    }

    P file_;
    std::vector<Token> tokens_;
    std::vector<Block> stack_;
    std::string_view item_, after_;
    TokenKind after_kind_ = TokenKind::end;
    bool keyword_ = false, after_keyword_ = false, first_on_line_ = false;
};

bool first_on_line(std::string_view text, std::uint32_t offset) {
    while (offset > 0 && (text[offset - 1] == ' ' || text[offset - 1] == '\t'))
        --offset;
    return offset == 0 || text[offset - 1] == '\n';
}

Place among_tokens(const Document& document, P file, std::uint32_t begin, std::uint32_t end,
                   std::uint32_t offset) {
    const std::string_view text = document.text();
    if (is_silent(text, begin, offset, true)) return {{}, false, false, false, {}, {0, offset, offset}};
    const Span word = name_around(text, offset);
    TokenWalk walk(document, file, {0, begin, end});
    walk.set_first_on_line(first_on_line(text, word.begin));
    Place place = walk.at(word);
    place.begins |= first_on_line(text, word.begin);
    return place;
}

/// The symbol of a string at a place, or before it: of the turtle, a name that the block declares, or one
/// character.
Span symbol_around(const Document& document, const LsysBlock* block, std::uint32_t offset) {
    const std::string_view text = document.text();
    const auto longest = [&](std::uint32_t at) {
        std::size_t size = at < text.size() && text[at] != '\n' && text[at] != ' ' ? 1 : 0;
        for (const TurtleSymbol& symbol : turtle_symbols)
            if (text.substr(at).starts_with(symbol.text)) size = std::max(size, symbol.text.size());
        if (block)
            for (const Name& name : block->modules)
                if (text.substr(at).starts_with(name.text)) size = std::max(size, name.text.size());
        return static_cast<std::uint32_t>(size);
    };
    constexpr std::uint32_t most_back = max_lsys_symbol;
    for (std::uint32_t back = std::min(offset, most_back); back > 0; --back)
        if (const std::uint32_t size = longest(offset - back); size > back)
            return {0, offset - back, offset - back + size};
    if (const std::uint32_t size = longest(offset); size > 0) return {0, offset, offset + size};
    return {0, offset, offset};
}

Place in_statement(const Document& document, const LsysBlock* block, const LsysScanner& scanner,
                   const LsysStatement& statement, std::uint32_t offset) {
    const std::string_view text = document.text();
    const bool keyword = is_lsys_keyword(statement.word);
    const std::size_t word_end = statement.begin + statement.word.size();
    if (offset <= word_end && (keyword || statement.word.size() > 1))
        return {{P::lsys_block}, false, true, false, {}, name_around(text, offset)};
    const bool modules =
        !keyword || statement.word == "axiom" || statement.word == "ignore" || statement.word == "consider";
    int depth = 0;
    bool colon = false;
    for (std::size_t at = statement.begin; at < offset; ++at) {
        // In strings two slashes are turns.
        const bool slashes = !modules || depth > 0;
        if (text[at] == '#' || (slashes && text[at] == '/'))
            if (const std::size_t end = scanner.comment_end(at); end > at) {
                at = end - 1;
                continue;
            }
        depth += (text[at] == '(') - (text[at] == ')');
        colon = colon || text[at] == ':';
    }
    const std::optional<std::size_t> arrow = scanner.find_arrow(statement.begin, statement.end);
    const bool condition = arrow && offset < *arrow && colon;
    std::size_t tilde = offset;
    while (tilde > statement.begin && (is_name_character(text[tilde - 1]) || text[tilde - 1] == '.'))
        --tilde;
    const bool string = modules && depth == 0 && !condition;
    if (is_silent(text, statement.begin, offset, !string))
        return {{}, false, false, false, {}, {0, offset, offset}};
    if (string && tilde > statement.begin && text[tilde - 1] == '~')
        return {{P::primitive}, false, false, false, "~", name_around(text, offset)};
    if (string) return {{P::turtle}, true, false, false, {}, symbol_around(document, block, offset)};
    Place place{{P::value}, false, false, true, statement.word, name_around(text, offset)};
    if (statement.word == "environment") place.where = {P::environment, P::value};
    return place;
}

Place among_blocks(const Document& document, std::uint32_t offset) {
    Diagnostics ignored;
    const LsysScanner scanner(document.sources(), 0, ignored);
    const std::string_view text = document.text();
    std::size_t begin = 0;
    for (std::size_t number = 0;; ++number) {
        const auto header = scanner.find_block(begin);
        const std::size_t open = header ? text.find('{', header->begin) : std::string_view::npos;
        if (open == std::string_view::npos || offset <= open) {
            const std::size_t end = header ? std::max<std::size_t>(header->begin, offset) : text.size();
            return among_tokens(document, P::lsys_file, static_cast<std::uint32_t>(begin),
                                static_cast<std::uint32_t>(end), offset);
        }
        const LsysOutline outline = scanner.outline(open + 1);
        if (offset < outline.end || (!outline.closed && offset == outline.end)) {
            const LsysFile* const tree = document.lsys();
            const LsysBlock* const block =
                tree && number < tree->blocks.size() ? &tree->blocks[number] : nullptr;
            std::size_t between = open + 1;
            for (const LsysStatement& statement : outline.statements) {
                if (statement.begin <= offset && offset <= statement.end)
                    return in_statement(document, block, scanner, statement, offset);
                if (statement.end <= offset) between = std::max(between, statement.end);
            }
            if (is_silent(text, between, offset, true))
                return {{}, false, false, false, {}, {0, offset, offset}};
            return {{P::lsys_block}, false, true, false, {}, name_around(text, offset)};
        }
        begin = std::max(outline.end, open + 1);
    }
}

} // namespace

Place place_at(const Document& document, std::uint32_t offset) {
    const auto size = static_cast<std::uint32_t>(document.text().size());
    if (document.lsys()) return among_blocks(document, offset);
    if (document.rifs()) return among_tokens(document, P::rifs_file, 0, size, offset);
    if (document.inst()) return among_tokens(document, P::inst_file, 0, size, offset);
    return {{}, false, false, false, {}, {0, offset, offset}};
}

} // namespace graftal
