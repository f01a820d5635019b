#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/import/own_words.h"
#include "compiler/import/spectral_radius.h"
#include "compiler/support/number.h"
#include "compiler/support/path_text.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace fractint_ifs {

constexpr std::size_t most_maps = 10'000;

struct Number {
    double value = 0;
    Span span;
};

struct Row {
    std::vector<Number> numbers; ///< without the probability
    std::optional<Number> probability;
    Affine map;
    std::vector<std::string> above; ///< comments on lines of their own
    std::string beside;             ///< a comment behind the row

    Span span() const { return join(numbers.front().span, numbers.back().span); }
};

struct System {
    bool in_space = false;
    std::vector<std::string> head; ///< comments
    std::vector<Row> rows;
    std::vector<std::string> tail;
};

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\x1a';
}

bool says_3d(std::string_view head) {
    return head.find("(3D)") != std::string_view::npos || head.find("(3d)") != std::string_view::npos;
}

/// A line without its comment, and the comment.
struct Line {
    std::string_view words;
    std::optional<std::string_view> comment;
    std::size_t begin = 0; ///< in the text
};

std::vector<Line> lines_of(std::string_view text, std::size_t begin, std::size_t end) {
    std::vector<Line> lines;
    while (begin < end) {
        const std::size_t stop = std::min(text.find_first_of("\r\n", begin), end);
        Line line{text.substr(begin, stop - begin), {}, begin};
        if (const std::size_t comment = line.words.find(';'); comment != std::string_view::npos) {
            line.comment = trimmed(line.words.substr(comment + 1));
            line.words = line.words.substr(0, comment);
        }
        lines.push_back(line);
        begin = stop + 1;
    }
    return lines;
}

/// Numbers on a line of nothing else; none: there is something else, or nothing.
std::size_t numbers_on(std::string_view words) {
    std::size_t count = 0;
    for (;; ++count) {
        words = words.substr(std::min(words.find_first_not_of(" \t\f\x1a,"), words.size()));
        if (words.empty()) return count;
        const LeadingNumber number = leading_number(words.starts_with('+') ? words.substr(1) : words);
        if (number.length == 0) return 0;
        words.remove_prefix(number.length + words.starts_with('+'));
        if (!words.empty() && std::string_view(" \t\f,").find(words.front()) == std::string_view::npos)
            return 0;
    }
}

/// Numbers of each row where a text is a table without a name and braces, as Fractint's first versions had
/// it: 6 or 7 in the plane, 12 or 13 in space. Nothing for other texts.
std::optional<std::size_t> bare_columns(std::string_view text) {
    std::optional<std::size_t> columns;
    for (const Line& line : lines_of(text, 0, text.size())) {
        if (trimmed(line.words).empty()) continue;
        const std::size_t count = numbers_on(line.words);
        if (count != columns.value_or(count)) return std::nullopt;
        columns = count;
    }
    const bool good = columns && (*columns == 6 || *columns == 7 || *columns == 12 || *columns == 13);
    return good ? columns : std::nullopt;
}

/// The name before a '{', without "(3D)".
std::string name_of(std::string_view head) {
    head = trimmed(head.substr(0, head.find('(')));
    return std::string(head);
}

std::vector<ForeignModel> models(const ForeignFile& file) {
    const std::string_view text = file.text();
    if (bare_columns(text))
        return {{std::string(stem_of(file.sources.name(file.file))), file.span(0, text.size())}};
    std::vector<ForeignModel> found;
    std::string head; // since the last entry, without comments
    std::optional<ForeignModel> open;
    std::size_t head_begin = 0;
    for (const Line& line : lines_of(text, 0, text.size())) {
        std::size_t at = 0;
        while (at < line.words.size()) {
            if (open) {
                const std::size_t close = line.words.find('}', at);
                if (close == std::string_view::npos) break;
                open->span.end = static_cast<std::uint32_t>(line.begin + close + 1);
                if (in_small_letters(open->name) != "comment") found.push_back(std::move(*open));
                open.reset();
                at = close + 1;
                continue;
            }
            const std::size_t brace = line.words.find('{', at);
            const std::string_view words = line.words.substr(at, brace - at);
            if (!trimmed(words).empty() && trimmed(head).empty()) head_begin = line.begin + at;
            head += words;
            head += ' ';
            if (brace == std::string_view::npos) break;
            open = ForeignModel{name_of(head), file.span(head_begin, line.begin + brace + 1)};
            if (open->name.empty()) {
                file.diagnostics
                    .error(file.span(line.begin + brace, line.begin + brace + 1), "this system has no name")
                    .with_hint("write its name before the brace: fern {");
                open->name = "unnamed";
            }
            head.clear();
            at = brace + 1;
        }
    }
    if (open) file.diagnostics.error(open->span, fmt::format("'{}' has no '}}' at its end", open->name));
    return found;
}

// Rows

class SystemReader {
  public:
    explicit SystemReader(const ForeignFile& file) : file_(file) {}

    std::optional<System> read(const ForeignModel& model) {
        const std::string_view text = file_.text();
        const std::size_t brace = text.find('{', model.span.begin);
        const auto bare = brace == std::string_view::npos ? bare_columns(text) : std::nullopt;
        const std::size_t begin = bare ? 0 : std::min<std::size_t>(brace + 1, model.span.end);
        const std::size_t end = bare ? text.size() : model.span.end - 1; // the '}'
        std::vector<Line> lines = lines_of(text, begin, end);
        system_.in_space =
            bare.value_or(0) > 7 || says_3d(text.substr(model.span.begin, begin - model.span.begin));
        if (!lines.empty() && says_3d(lines[0].words)) { // behind the brace, as some have it
            system_.in_space = true;
            const std::size_t close = lines[0].words.find(')') + 1;
            lines[0].begin += close;
            lines[0].words.remove_prefix(close);
        }
        for (const Line& line : lines)
            read_line(line);
        if (good_ && numbers_.empty()) fail(model.span, fmt::format("'{}' has no maps", model.name));
        if (good_) group();
        if (!good_) return std::nullopt;
        system_.tail = std::move(comments_);
        return std::move(system_);
    }

  private:
    struct LineNote {
        std::size_t number; ///< of the first number behind it
        std::vector<std::string> above;
        std::string beside;
        std::size_t count = 0; ///< of numbers on the line
    };

    void fail(Span span, std::string message, std::string hint = {}) {
        if (good_) file_.diagnostics.error(span, std::move(message)).with_hint(std::move(hint));
        good_ = false;
    }

    void read_line(const Line& line) {
        const std::size_t first = numbers_.size();
        std::size_t at = 0;
        while (good_) {
            while (at < line.words.size() && (is_space(line.words[at]) || line.words[at] == ','))
                ++at;
            if (at == line.words.size()) break;
            std::size_t end = at;
            while (end < line.words.size() && !is_space(line.words[end]) && line.words[end] != ',')
                ++end;
            read_number(line.words.substr(at, end - at), file_.span(line.begin + at, line.begin + end));
            at = end;
        }
        const std::size_t count = numbers_.size() - first;
        if (count == 0) {
            if (line.comment) comments_.emplace_back(*line.comment);
            return;
        }
        notes_.push_back({first, std::move(comments_), std::string(line.comment.value_or("")), count});
        comments_.clear();
    }

    void read_number(std::string_view word, Span span) {
        const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
        const std::optional<double> value = parse_number(digits);
        if (!value) return fail(span, fmt::format("'{}' is not a number", word));
        if (!(std::abs(*value) <= 1e100)) return fail(span, "numbers lie between -1e100 and 1e100");
        numbers_.push_back({*value, span});
        if (numbers_.size() > 13 * most_maps)
            fail(span, fmt::format("a system has at most {} maps", most_maps));
    }

    /// Into rows: Fractint counts numbers, whatever the lines. Other programs leave out the probability.
    void group() {
        const std::size_t plain = system_.in_space ? 12 : 6;
        const bool all_plain =
            std::ranges::all_of(notes_, [&](const LineNote& line) { return line.count == plain; });
        const std::size_t width = all_plain ? plain : plain + 1;
        if (numbers_.size() % width != 0)
            return fail(numbers_.back().span,
                        fmt::format("the last map has {} numbers", numbers_.size() % width),
                        fmt::format("a map has {} numbers and a probability; a heading with (3D) makes it 12",
                                    plain));
        std::size_t note = 0;
        for (std::size_t i = 0; i < numbers_.size(); i += width) {
            Row row;
            row.numbers.assign(numbers_.begin() + static_cast<std::ptrdiff_t>(i),
                               numbers_.begin() + static_cast<std::ptrdiff_t>(i + plain));
            if (!all_plain) row.probability = numbers_[i + plain];
            for (; note < notes_.size() && notes_[note].number < i + width; ++note) {
                row.above.insert(row.above.end(), notes_[note].above.begin(), notes_[note].above.end());
                if (!notes_[note].beside.empty())
                    row.beside += (row.beside.empty() ? "" : "; ") + notes_[note].beside;
            }
            row.map = map_of(row);
            system_.rows.push_back(std::move(row));
        }
        system_.head = std::exchange(system_.rows.front().above, {});
    }

    Affine map_of(const Row& row) const {
        Affine map;
        const auto n = [&](std::size_t i) { return row.numbers[i].value; };
        const int size = system_.in_space ? 3 : 2;
        for (int r = 0; r < size; ++r) {
            for (int c = 0; c < size; ++c)
                map.linear[c][r] = n(static_cast<std::size_t>(size) * static_cast<std::size_t>(r) +
                                     static_cast<std::size_t>(c));
            map.translation[r] = n(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) +
                                   static_cast<std::size_t>(r));
        }
        if (!system_.in_space) map.linear[2][2] = std::sqrt(std::abs(n(0) * n(3) - n(1) * n(2)));
        return map;
    }

    const ForeignFile& file_;
    System system_;
    std::vector<Number> numbers_;
    std::vector<LineNote> notes_;
    std::vector<std::string> comments_;
    bool good_ = true;
};

// Chances

/// Fractint adds the probabilities up until the sum passes a random number; the last map takes what is left.
/// So a negative one takes from those before it.
std::vector<double> chances(const System& system) {
    std::vector<double> result;
    double sum = 0, passed = 0;
    for (const Row& row : system.rows) {
        sum += row.probability ? row.probability->value : 0;
        const double reached = std::clamp(sum, passed, 1.0);
        result.push_back(reached - passed);
        passed = reached;
    }
    result.back() += 1 - passed;
    return result;
}

bool are_plain(const System& system) {
    double sum = 0;
    for (const Row& row : system.rows) {
        if (!row.probability || row.probability->value < 0 || row.probability->value > 1) return false;
        sum += row.probability->value;
    }
    return std::abs(sum - 1) <= 0.02;
}

// Text

class Writer {
  public:
    Writer(const ForeignFile& file, const ForeignModel& model, const System& system)
        : file_(file), model_(model), system_(system) {
        if (!system_.rows.front().probability) return;
        if (are_plain(system_))
            for (const Row& row : system_.rows)
                chances_.push_back(row.probability->value);
        else
            replace_chances();
    }

    Translation write() {
        comment(fmt::format("{}, a Fractint IFS", model_.name));
        for (const std::string& words : system_.head)
            comment(words);
        if (const Row* const row = growing())
            write_orbit(*row);
        else
            write_maps();
        for (const std::string& words : system_.tail)
            comment(words);
        return std::move(out_);
    }

  private:
    void replace_chances() {
        chances_ = chances(system_);
        file_.diagnostics
            .warning(system_.rows.back().probability->span,
                     "these probabilities do not add up to 1, or are negative")
            .with_hint(
                "Fractint gives the last map what is left, and takes a negative one from those before it: "
                "so does the model");
    }

    void comment(std::string_view words) { out_.line(trimmed(fmt::format("# {}", comment_text(words)))); }

    /// A map that keeps or grows the size of something, or two that do so together.
    const Row* growing() const {
        constexpr double limit = 1 - 1e-7;
        const std::vector<Row>& rows = system_.rows;
        for (const Row& row : rows)
            if (spectral_radius(row.map.linear) >= limit) return &row;
        if (rows.size() > 64) return nullptr;
        for (const Row& a : rows)
            for (const Row& b : rows)
                if (spectral_radius(a.map.linear * b.map.linear) >= limit) return &a;
        return nullptr;
    }

    void write_maps() {
        out_.line(fmt::format("rifs {} {{", own_name(model_.name, "_ifs")), model_.span);
        out_.line(fmt::format("  codes {} {{", system_.in_space ? "3d" : "2d"));
        for (std::size_t i = 0; i < system_.rows.size(); ++i) {
            const Row& row = system_.rows[i];
            for (const std::string& words : row.above)
                indented_comment(words);
            std::string text = "   ";
            for (const Number& number : row.numbers)
                text += fmt::format(" {:>9}", shortest(number.value));
            if (!chances_.empty()) text += fmt::format("  {:>9}", shortest(chances_[i]));
            if (!row.beside.empty()) text += fmt::format("   # {}", comment_text(row.beside));
            out_.line(text, row.span());
        }
        out_.line("  }");
        out_.line("}");
    }

    void indented_comment(std::string_view words) { out_.line(fmt::format("    # {}", comment_text(words))); }

    void write_orbit(const Row& growing) {
        file_.diagnostics
            .warning(growing.span(),
                     "this map does not shrink, alone or together with another, so the system has "
                     "no limit set")
            .with_hint("the model is an orbit: 'graftal points' draws it");
        out_.line(fmt::format("orbit {} {{", plain_name(model_.name)), model_.span);
        for (std::size_t i = 0; i < system_.rows.size(); ++i) {
            const Row& row = system_.rows[i];
            for (const std::string& words : row.above)
                indented_comment(words);
            out_.line("  map {", row.span());
            const int size = system_.in_space ? 3 : 2;
            for (int r = 0; r < size; ++r)
                out_.line(formula(row, r, size), row.span());
            if (!chances_.empty())
                out_.line(fmt::format("    probability {}", shortest(chances_[i])), row.span());
            out_.line(row.beside.empty() ? "  }" : fmt::format("  }} # {}", comment_text(row.beside)));
        }
        out_.line("}");
    }

    static std::string formula(const Row& row, int r, int size) {
        std::string text = fmt::format("    {} =", "xyz"[r]);
        for (int c = 0; c < size; ++c)
            text += fmt::format(" {}({}) * {}", c == 0 ? "" : "+ ", shortest(row.map.linear[c][r]), "xyz"[c]);
        return text + fmt::format(" + ({})", shortest(row.map.translation[r]));
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    const System& system_;
    std::vector<double> chances_;
    Translation out_{.extension = "rifs"};
};

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel& model) {
    const std::optional<System> system = SystemReader(file).read(model);
    if (!system) return std::nullopt;
    return Writer(file, model, *system).write();
}

/// A block that begins with six numbers, or a table.
bool recognises(std::string_view text) {
    if (bare_columns(text)) return true;
    constexpr std::size_t least = 6;
    std::optional<std::size_t> numbers; // of the block so far; nothing outside of one
    for (const Line& line : lines_of(text, 0, text.size())) {
        std::string_view words = line.words;
        if (const std::size_t open = words.find('{'); open != std::string_view::npos) {
            numbers = 0;
            words.remove_prefix(open + 1);
            if (says_3d(words)) words.remove_prefix(words.find(')') + 1);
        }
        while (numbers && !trimmed(words).empty()) {
            words = words.substr(std::min(words.find_first_not_of(" \t,"), words.size()));
            const LeadingNumber number = leading_number(words);
            if (number.length == 0) {
                numbers.reset();
            } else {
                if (++*numbers == least) return true;
                words.remove_prefix(number.length);
            }
        }
    }
    return false;
}

} // namespace fractint_ifs

Importer fractint_ifs_importer() {
    static constexpr std::string_view endings[] = {"ifs"};
    return {.format = "Fractint IFS",
            .endings = endings,
            .recognises = fractint_ifs::recognises,
            .sign = "a block 'name { .5 0 0 .5 0 0 1 ... }' of rows of numbers, or such rows alone",
            .models = fractint_ifs::models,
            .translation = fractint_ifs::translate};
}

} // namespace graftal
