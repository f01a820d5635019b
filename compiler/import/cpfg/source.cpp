#include "compiler/import/cpfg/source.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cpfg/condition.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr std::size_t most_source_bytes =
    1'000'000; ///< of all files of a model, and of what a statement becomes
constexpr std::size_t most_expansions = 100'000;
constexpr int most_nested = 64; ///< macros in macros, and files in files

bool begins_name(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}

/// A character of the text without comments, with its place.
struct Placed {
    char c;
    std::uint32_t place;
};

class SourceReader {
  public:
    SourceReader(const ForeignFile& file) : file_(file), code_(file) {}

    std::optional<CpfgSource> read() {
        const std::size_t errors = file_.diagnostics.error_count();
        read_file(file_.text(), std::nullopt, 0);
        end_statement();
        if (!conditions_.empty() && file_.diagnostics.error_count() == errors)
            file_.diagnostics.error(conditions_.back().span, "this condition is never ended by #endif");
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return std::move(source_);
    }

  private:
    struct Condition {
        bool holds;
        bool was_true; ///< some branch was
        Span span;
    };

    Span at(std::size_t begin, std::size_t end) const { return file_.span(begin, end); }

    /// `whole`: the place of all that an included file says.
    void read_file(std::string_view text, std::optional<std::uint32_t> whole, int depth) {
        bytes_ += text.size();
        if (depth > most_nested || bytes_ > most_source_bytes) {
            file_.diagnostics.error(
                at(whole.value_or(0), whole.value_or(0)),
                fmt::format("a model of cpfg has at most {} characters, with all files that it "
                            "includes",
                            most_source_bytes));
            return;
        }
        std::vector<Placed> line;
        bool in_comment = false;
        for (std::size_t i = 0; i <= text.size(); ++i) {
            const auto place = whole.value_or(static_cast<std::uint32_t>(i));
            if (i == text.size() || text[i] == '\n') {
                if (in_comment && i < text.size()) {
                    line.push_back({' ', place});
                    continue;
                }
                if (continues(line)) continue;
                take_line(line, depth);
                if (file_.diagnostics.full()) return;
                line.clear();
            } else if (in_comment) {
                in_comment = !text.substr(i).starts_with("*/");
                if (!in_comment) add_comment(text, comment_begin_, i, whole);
                i += in_comment ? 0 : 1;
            } else if (text.substr(i).starts_with("/*")) {
                in_comment = true;
                comment_begin_ = ++i + 1;
            } else if (text.substr(i).starts_with("//") && begins_comment(line)) {
                const std::size_t end = std::min(text.find('\n', i), text.size());
                add_comment(text, i + 2, end, whole);
                i = end - 1;
            } else if (const auto byte = static_cast<unsigned char>(text[i]); byte < 0x80) {
                line.push_back({text[i], place});
            } else {
                std::size_t next = i;
                for (const char sign : code_.next(text, next, 0, whole))
                    line.push_back({sign, place});
                i = next - 1;
            }
        }
    }

    /// Two slashes are turns in a string: only at the beginning of a line, or behind a space, they begin a
    /// comment.
    static bool begins_comment(const std::vector<Placed>& line) {
        return line.empty() || line.back().c == ' ' || line.back().c == '\t' || line.back().c == ';';
    }

    void add_comment(std::string_view text, std::size_t begin, std::size_t end,
                     std::optional<std::uint32_t> whole) {
        if (whole) return;
        for (const TextLine& line : lines_of(text, begin, end)) {
            const std::string words = comment_text(line.text);
            if (words.find_first_not_of("-=*# ") != std::string::npos)
                comments_.emplace_back(words, at(line.begin, line.begin + line.text.size()));
        }
    }

    /// A backslash at its end joins a line with the next, in directives; so do two.
    static bool continues(std::vector<Placed>& line) {
        const auto first =
            std::ranges::find_if(line, [](const Placed& p) { return p.c != ' ' && p.c != '\t'; });
        if (first == line.end() || first->c != '#' || line.back().c != '\\') return false;
        while (!line.empty() && line.back().c == '\\')
            line.pop_back();
        line.push_back({' ', line.empty() ? 0 : line.back().place});
        return true;
    }

    void take_line(const std::vector<Placed>& line, int depth) {
        std::string text;
        for (const Placed& p : line)
            text += p.c;
        const std::string_view words = trimmed(text);
        if (words.starts_with('#') &&
            (words.size() == 1 ||
             begins_name(trimmed(words.substr(1)).empty() ? '#' : trimmed(words.substr(1))[0])))
            return directive(trimmed(words.substr(1)), line, depth);
        if (!active()) return comments_.clear();
        const bool goes_on =
            !statement_.text.empty() && (text.starts_with('\t') || depth_of(statement_.text) > 0);
        if (!goes_on) end_statement();
        if (words.empty()) return;
        if (statement_.text.empty()) statement_.comments = std::exchange(comments_, {});
        for (const Placed& p : line) {
            statement_.text += p.c == '\t' ? ' ' : p.c;
            statement_.places.push_back(p.place);
        }
        statement_.text += ' ';
        statement_.places.push_back(line.back().place);
    }

    /// The depth of braces that hold statements: they begin behind a colon, or behind a condition.
    static int depth_of(std::string_view text) {
        const std::size_t colon = text.find(':');
        if (colon == std::string_view::npos) return 0;
        int depth = 0;
        const std::size_t arrow = std::min(text.find("-->", colon), text.size());
        for (const char c : text.substr(colon, arrow - colon))
            depth += (c == '{') - (c == '}');
        return depth;
    }

    void end_statement() {
        if (!trimmed(statement_.text).empty()) source_.statements.push_back(std::move(statement_));
        statement_ = {};
    }

    bool active() const {
        return std::ranges::all_of(conditions_, [](const Condition& condition) { return condition.holds; });
    }

    void directive(std::string_view words, const std::vector<Placed>& line, int depth) {
        const Span span = at(line.front().place, line.back().place + 1);
        const std::string_view name = cpfg_name_at(words), rest = trimmed(words.substr(name.size()));
        if (name == "ifdef" || name == "ifndef" || name == "if") return begin_condition(name, rest, span);
        if (name == "else" || name == "elif" || name == "endif") return next_condition(name, rest, span);
        if (!active()) return;
        if (name == "define") return define(rest, span);
        if (name == "undef") {
            std::erase_if(source_.macros, [&](const CpfgMacro& macro) { return macro.name == rest; });
        } else if (name == "include") {
            include(rest, span, depth);
        } else if (name != "line" && name != "pragma") {
            file_.diagnostics.error(span, fmt::format("the directive '#{}' has no translation", name));
        }
    }

    void begin_condition(std::string_view name, std::string_view rest, Span span) {
        const bool holds = name == "if" ? value(rest, span) : is_defined(rest) == (name == "ifdef");
        conditions_.push_back({holds, holds, span});
    }

    void next_condition(std::string_view name, std::string_view rest, Span span) {
        if (conditions_.empty()) {
            file_.diagnostics.error(span, fmt::format("'#{}' without '#if'", name));
            return;
        }
        Condition& condition = conditions_.back();
        if (name == "endif") {
            conditions_.pop_back();
            return;
        }
        condition.holds = !condition.was_true && (name == "else" || value(rest, span));
        condition.was_true = condition.was_true || condition.holds;
    }

    bool is_defined(std::string_view name) const {
        return std::ranges::find(source_.macros, trimmed(name), &CpfgMacro::name) != source_.macros.end();
    }

    bool value(std::string_view text, Span span) {
        const std::optional<std::string> written =
            expand_cpfg_macros(without_defined(text), source_.macros, [](const CpfgMacro&) { return true; });
        const std::optional<double> known = written ? cpfg_condition(*written) : std::nullopt;
        if (known) return *known != 0;
        file_.diagnostics.error(span, "this condition has no translation");
        return false;
    }

    /// The text with 1 or 0 for `defined(NAME)` and `defined NAME`.
    std::string without_defined(std::string_view text) const {
        constexpr std::string_view word = "defined";
        std::string out;
        for (std::size_t i = 0; i < text.size();) {
            const std::size_t found = std::min(text.find(word, i), text.size());
            out += text.substr(i, found - i);
            if (found == text.size()) break;
            const std::size_t begin =
                std::min(text.find_first_not_of(" (", found + word.size()), text.size());
            const std::string_view name = cpfg_name_at(text, begin);
            const std::size_t end = begin + name.size();
            out += is_defined(name) ? "1" : "0";
            const bool closes = text.substr(found, begin - found).find('(') != std::string_view::npos;
            i = closes ? std::min(text.find(')', end), text.size() - 1) + 1 : end;
        }
        return out;
    }

    void define(std::string_view rest, Span span) {
        CpfgMacro macro{.span = span};
        macro.name = cpfg_name_at(rest);
        std::size_t end = macro.name.size();
        if (macro.name.empty()) {
            file_.diagnostics.error(span, "expected a name after '#define'");
            return;
        }
        if (end < rest.size() && rest[end] == '(') {
            const std::size_t close = rest.find(')', end);
            if (close == std::string_view::npos) {
                file_.diagnostics.error(span, "the parameters of this macro are not closed by ')'");
                return;
            }
            std::vector<std::string>& parameters = macro.parameters.emplace();
            std::string_view names = rest.substr(end + 1, close - end - 1);
            while (!trimmed(names).empty()) {
                const std::size_t comma = std::min(names.find(','), names.size());
                parameters.emplace_back(trimmed(names.substr(0, comma)));
                names.remove_prefix(std::min(comma + 1, names.size()));
            }
            end = close + 1;
        }
        macro.body = trimmed(rest.substr(end));
        std::erase_if(source_.macros, [&](const CpfgMacro& known) { return known.name == macro.name; });
        source_.macros.push_back(std::move(macro));
    }

    void include(std::string_view rest, Span span, int depth) {
        if (rest.size() < 3 || rest[0] != '"' || rest.find('"', 1) == std::string_view::npos) {
            file_.diagnostics.error(span, "a file that is included is named in double quotes");
            return;
        }
        const std::string name(rest.substr(1, rest.find('"', 1) - 1));
        const std::optional<FileId> file = file_.read_beside(name);
        if (!file) {
            file_.diagnostics.error(span, fmt::format("there is no file '{}' beside this one", name));
            return;
        }
        end_statement();
        read_file(file_.sources.text(*file), span.begin, depth + 1);
        end_statement();
    }

    const ForeignFile& file_;
    CodeReader code_;
    CpfgSource source_;
    CpfgStatement statement_; ///< statement being read
    std::vector<std::pair<std::string, Span>> comments_;
    std::vector<Condition> conditions_;
    std::size_t comment_begin_ = 0;
    std::size_t bytes_ = 0;
};

class MacroWriter {
  public:
    MacroWriter(const std::vector<CpfgMacro>& macros, const std::function<bool(const CpfgMacro&)>& chosen)
        : macros_(macros), chosen_(chosen) {}

    std::optional<std::string> write(std::string_view text) {
        std::string out = expanded(text, {});
        if (failed_) return std::nullopt;
        return out;
    }

  private:
    using Names = std::vector<std::string_view>;

    /// `under_way`: macros that are being written out, and are not again, as in C.
    std::string expanded(std::string_view text, const Names& under_way) {
        std::string out;
        for (std::size_t i = 0; i < text.size() && !failed_;) {
            if (!begins_name(text[i])) {
                const bool number = std::isdigit(static_cast<unsigned char>(text[i]));
                do
                    out += text[i++];
                while (number && i < text.size() && (is_cpfg_name(text[i]) || text[i] == '.'));
                continue;
            }
            const std::string_view name = cpfg_name_at(text, i);
            const auto macro = std::ranges::find(macros_, name, &CpfgMacro::name);
            const bool free = std::ranges::find(under_way, name) == under_way.end();
            i += name.size();
            if (macro == macros_.end() || !free || !chosen_(*macro) ||
                !append(*macro, text, i, under_way, out))
                out += name;
            failed_ = failed_ || out.size() > most_source_bytes || under_way.size() > most_nested;
        }
        return out;
    }

    /// False for a macro with parameters that has no arguments here.
    bool append(const CpfgMacro& macro, std::string_view text, std::size_t& i, const Names& under_way,
                std::string& out) {
        failed_ = failed_ || ++count_ > most_expansions;
        if (failed_) return true;
        Names inside = under_way;
        inside.push_back(macro.name);
        if (!macro.parameters) {
            out += expanded(macro.body, inside);
            return true;
        }
        std::size_t at = i;
        while (at < text.size() && text[at] == ' ')
            ++at;
        if (at == text.size() || text[at] != '(') return false;
        std::vector<std::string> arguments(1);
        int depth = 0;
        for (; at < text.size(); ++at) {
            const char c = text[at];
            depth += (c == '(') - (c == ')');
            if (depth == 0) break;
            if (c == '(' && depth == 1) continue;
            if (c == ',' && depth == 1)
                arguments.emplace_back();
            else
                arguments.back() += c;
        }
        if (at == text.size()) return false;
        i = at + 1;
        std::string body;
        for (std::size_t b = 0; b < macro.body.size();) {
            if (!begins_name(macro.body[b])) {
                body += macro.body[b++];
                continue;
            }
            const std::string_view name = cpfg_name_at(macro.body, b);
            const auto parameter = std::ranges::find(*macro.parameters, name);
            const auto place = static_cast<std::size_t>(parameter - macro.parameters->begin());
            if (parameter == macro.parameters->end())
                body += name;
            else if (place < arguments.size())
                body += expanded(trimmed(arguments[place]), under_way);
            failed_ = failed_ || body.size() > most_source_bytes;
            if (failed_) return true;
            b += name.size();
        }
        out += expanded(body, inside);
        return true;
    }

    const std::vector<CpfgMacro>& macros_;
    const std::function<bool(const CpfgMacro&)>& chosen_;
    std::size_t count_ = 0;
    bool failed_ = false;
};

} // namespace

std::optional<CpfgSource> read_cpfg_source(const ForeignFile& file) {
    return SourceReader(file).read();
}

std::optional<std::string> expand_cpfg_macros(std::string_view text, const std::vector<CpfgMacro>& macros,
                                              const std::function<bool(const CpfgMacro&)>& chosen) {
    return MacroWriter(macros, chosen).write(text);
}

} // namespace graftal
