#include "tests/fuzz/syntax_tree.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace graftal::fuzz {

namespace {

struct Piece {
    Part part = Part::mark;
    std::size_t begin = 0;
    std::size_t end = 0;
    bool first_on_line = false;
    bool space_before = false;
};

bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}

bool is_digit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Words that begin a line where lines are written one after the other: `scale 1/2  translate <0, 1, 0>`.
bool begins_line(std::string_view word) {
    static constexpr auto words = std::to_array<std::string_view>(
        {"ambient",   "angle",    "around",     "axiom",        "background", "below",    "by",
         "camera",    "chance",   "codes",      "color",        "colors",     "condense", "count",
         "decompose", "diffuse",  "difference", "follow",       "ground",     "height",   "horizon",
         "inner",     "instance", "interpret",  "intersection", "lean",       "let",      "light",
         "location",  "look_at",  "map",        "material",     "matrix",     "over",     "rotate",
         "roughness", "scale",    "scatter",    "seed",         "shear",      "size",     "specular",
         "start",     "step",     "steps",      "sun",          "terminal",   "texture",  "tint",
         "translate", "tropism",  "turn",       "union",        "up",         "use",      "width",
         "zenith"});
    return std::binary_search(words.begin(), words.end(), word);
}

/// Cuts a text into words, numbers, strings and marks. A comment belongs to the white space.
class Cutter {
  public:
    explicit Cutter(std::string_view text) : text_(text) {}

    std::vector<Piece> run() {
        std::vector<Piece> pieces;
        bool first = true;
        for (;;) {
            const std::size_t before = at_;
            first |= skip_blanks();
            if (at_ >= text_.size()) return pieces;
            const std::size_t begin = at_;
            const Part part = take();
            pieces.push_back({part, begin, at_, first, begin > before});
            first = false;
        }
    }

  private:
    char at(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }

    /// Returns whether a line has ended.
    bool skip_blanks() {
        bool line_ended = false;
        while (at_ < text_.size()) {
            if (text_[at_] == '#')
                at_ = std::min(text_.find('\n', at_), text_.size());
            else if (std::isspace(static_cast<unsigned char>(text_[at_])))
                line_ended |= text_[at_++] == '\n';
            else
                break;
        }
        return line_ended;
    }

    Part take() {
        const char c = text_[at_];
        if (is_letter(c)) {
            while (is_letter(at(at_)) || is_digit(at(at_)))
                ++at_;
            return Part::word;
        }
        if (is_digit(c) || (c == '.' && is_digit(at(at_ + 1)))) return take_number();
        if (c == '"') {
            const std::size_t close = text_.find_first_of("\"\n", at_ + 1);
            at_ = std::min(close, text_.size() - 1) + 1;
            return Part::string;
        }
        ++at_;
        return Part::mark;
    }

    Part take_number() {
        const auto digits = [this] {
            while (is_digit(at(at_)))
                ++at_;
        };
        digits();
        if (at(at_) == '.' && at(at_ + 1) != '.') {
            ++at_;
            digits();
        }
        const std::size_t sign = at(at_ + 1) == '-' || at(at_ + 1) == '+' ? 1 : 0;
        if ((at(at_) == 'e' || at(at_) == 'E') && is_digit(at(at_ + 1 + sign))) {
            at_ += 1 + sign;
            digits();
        }
        return Part::number;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

/// Makes the tree of the pieces.
class Reader {
  public:
    Reader(std::string_view text, std::vector<Piece> pieces) : text_(text), pieces_(std::move(pieces)) {}

    std::optional<std::vector<SyntaxNode>> run() {
        nodes_.push_back({Part::text, 0, text_.size(), {}, {}});
        statements('\0', 0);
        if (!matched_ || at_ < pieces_.size()) return std::nullopt;
        return std::move(nodes_);
    }

  private:
    static constexpr int deepest = 64;

    bool more() const { return at_ < pieces_.size(); }
    std::string_view text_of(const Piece& piece) const {
        return text_.substr(piece.begin, piece.end - piece.begin);
    }
    char mark() const { return more() && pieces_[at_].part == Part::mark ? text_[pieces_[at_].begin] : '\0'; }
    bool at_close() const {
        const char c = mark();
        return c == ')' || c == ']' || c == '}' || (c == '>' && in_vector_);
    }

    /// `<` of a vector, and not of a comparison or a context: behind a keyword, a colon or a comma.
    bool at_vector() const {
        if (mark() != '<' || at_ == 0 || in_vector_) return false;
        const std::string_view before = text_of(pieces_[at_ - 1]);
        return before == ":" || before == "," || before == "rgb" || begins_line(before);
    }

    std::size_t open(Part part, std::string_view key = {}) {
        nodes_.push_back({part, pieces_[at_].begin, pieces_[at_].end, key, within_});
        return nodes_.size() - 1;
    }
    void close(std::size_t node) {
        if (at_ > 0) nodes_[node].end = std::max(nodes_[node].begin, pieces_[at_ - 1].end);
    }

    /// What stands between braces, or in the file.
    void statements(char closer, int depth) {
        while (matched_ && more() && !at_close()) {
            const std::size_t node = open(Part::statement, text_of(pieces_[at_]));
            const std::string_view around = std::exchange(within_, nodes_[node].key);
            parts(depth, true);
            within_ = around;
            close(node);
        }
        if (more() != (closer != '\0') || (more() && mark() != closer)) matched_ = false;
    }

    /// The parts of a statement, or of what stands in brackets, those between commas as items.
    void parts(int depth, bool of_statement) {
        const std::size_t first = at_;
        std::size_t item = SIZE_MAX;
        while (matched_ && more() && !at_close()) {
            if (of_statement && at_ > first && begins_statement(first)) break;
            if (mark() == ',') {
                if (item != SIZE_MAX) close(item);
                ++at_;
                item = more() && !at_close() ? open(Part::item) : SIZE_MAX;
                continue;
            }
            if (!of_statement && at_ == first) item = open(Part::item);
            part(depth);
        }
        if (item != SIZE_MAX) close(item);
    }

    bool begins_statement(std::size_t first) const {
        const Piece& piece = pieces_[at_];
        const std::string_view before = text_of(pieces_[at_ - 1]);
        if (before == "," || before == "=" || before == ">") return false;
        if (piece.first_on_line) return true;
        return piece.part == Part::word && at_ > first + 1 && before != ":" && begins_line(text_of(piece));
    }

    void part(int depth) {
        const Piece& piece = pieces_[at_];
        const char c = mark();
        const bool bracket = c == '(' || c == '[' || c == '{' || at_vector();
        const bool calls = !bracket && at_ + 1 < pieces_.size() && text_[pieces_[at_ + 1].begin] == '(' &&
                           !pieces_[at_ + 1].space_before;
        if (calls) {
            const std::size_t call = open(Part::call, text_of(piece));
            leaf();
            brackets(depth);
            close(call);
        } else if (bracket) {
            brackets(depth);
        } else {
            leaf();
        }
    }

    void leaf() {
        open(pieces_[at_].part, text_of(pieces_[at_]));
        ++at_;
    }

    void brackets(int depth) {
        if (depth >= deepest) matched_ = false;
        if (!matched_) return;
        const char opener = mark();
        const char closer = opener == '(' ? ')' : opener == '[' ? ']' : opener == '{' ? '}' : '>';
        const std::size_t node = open(opener == '['   ? Part::branch
                                      : opener == '{' ? Part::block
                                                      : Part::list);
        ++at_;
        const bool around = std::exchange(in_vector_, opener == '<');
        if (opener == '{')
            statements(closer, depth + 1);
        else
            parts(depth + 1, false);
        if (mark() != closer) matched_ = false;
        in_vector_ = around;
        if (!matched_) return;
        ++at_;
        close(node);
    }

    std::string_view text_;
    std::vector<Piece> pieces_;
    std::vector<SyntaxNode> nodes_;
    std::size_t at_ = 0;
    bool matched_ = true;
    bool in_vector_ = false;
    std::string_view within_;
};

} // namespace

std::optional<std::vector<SyntaxNode>> read_syntax(std::string_view text) {
    return Reader(text, Cutter(text).run()).run();
}

} // namespace graftal::fuzz
