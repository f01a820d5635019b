#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/block.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/lpy/lines.h"
#include "compiler/import/lpy/python.h"
#include "compiler/import/lpy/string.h"
#include "compiler/import/lpy/system.h"

namespace graftal {

namespace {

/// Text behind `word:`, with any blanks in the word; nothing for other lines.
std::optional<std::string_view> behind(std::string_view text, std::string_view word) {
    std::size_t at = 0;
    for (const char c : word) {
        if (at == text.size() || text[at] != c) return std::nullopt;
        ++at;
        while (c == ' ' && at < text.size() && text[at] == ' ')
            ++at;
    }
    at = std::min(text.find_first_not_of(' ', at), text.size());
    if (at == text.size() || text[at] != ':') return std::nullopt;
    return trimmed(text.substr(at + 1));
}

bool is_python(std::string_view word) {
    constexpr std::string_view all[] = {"if",    "else",   "elif",   "for",     "while",
                                        "class", "def",    "try",    "with",    "print",
                                        "from",  "import", "except", "finally", "global"};
    return std::ranges::find(all, word) != std::end(all);
}

class LpyReader {
  public:
    explicit LpyReader(const ForeignFile& file)
        : file_(file), python_([this](Span span, const std::string& message) { complain(span, message); }),
          strings_(python_, [this](Span span, const std::string& message) { complain(span, message); }) {}

    std::optional<LSystem> read() {
        const std::size_t errors = file_.diagnostics.error_count();
        std::vector<LpyLine> lines = lpy_lines(file_.text(), file_.file);
        CodeReader code(file_);
        for (LpyLine& line : lines)
            make_plain(line, code);
        read_scalars();
        for (const LpyLine& line : lines)
            read_python(line);
        for (const LpyLine& line : lines)
            read_moment(line);
        name_numbers();
        in_rules_ = ended_ = false;
        for (const LpyLine& line : lines) {
            if (file_.diagnostics.full()) break;
            read_statement(line);
        }
        if (system_.axiom.empty() && file_.diagnostics.error_count() == errors)
            file_.diagnostics.error(Span(), "the model has no axiom");
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return std::move(system_);
    }

  private:
    /// Says one thing of each place.
    void complain(Span span, const std::string& message) {
        if (quiet_) return void(*quiet_ = false);
        if (last_ != span.begin) file_.diagnostics.error(span, message);
        last_ = span.begin;
    }

    /// Typographic signs become those that they stand for, except in texts.
    static void make_plain(LpyLine& line, CodeReader& code) {
        const auto is_wide = [](char c) { return static_cast<unsigned char>(c) >= 0x80; };
        if (std::ranges::any_of(line.text, is_wide) && line.text.find_first_of("\"'") == std::string::npos)
            line.text = code.signs(line.text, line.span);
        for (LpyLine& below : line.below)
            make_plain(below, code);
    }

    /// Numbers that the editor appends to the file: `scalars = [('N', 'Integer', 10, 1, 30), ...]`
    void read_scalars() {
        const std::string_view text = file_.text();
        const std::size_t begin = text.rfind("scalars = [");
        if (begin == std::string_view::npos || text.rfind("INITIALISATION", begin) == std::string_view::npos)
            return;
        const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
        const Span span = file_.span(begin, begin + line.size());
        for (std::size_t at = line.find("('"); at != std::string_view::npos; at = line.find("('", at)) {
            const std::string name(cpfg_name_at(line, at + 2));
            at = std::min(line.find(',', at), line.size() - 1) + 1;
            std::string_view value = trimmed(line.substr(at));
            if (value.starts_with('\''))
                value.remove_prefix(std::min(value.find_first_of(",)"), value.size()));
            if (value.starts_with(')')) continue; // a heading
            if (value.starts_with(',')) value.remove_prefix(1);
            python_.name_value(name, trimmed(value.substr(0, value.find_first_of(",)"))), span);
        }
    }

    /// Whether the line turns the file from rules to Python, or back.
    bool turns(const LpyLine& line) {
        const std::string_view text = line.text;
        for (const std::string_view word : {"production", "homomorphism", "interpretation", "decomposition"})
            if (behind(text, word)) return in_rules_ = true;
        if (text != "endlsystem") return false;
        in_rules_ = false;
        return ended_ = true;
    }

    static bool is_statement(std::string_view text) {
        for (const std::string_view word :
             {"Axiom", "derivation length", "maximum depth", "consider", "ignore"})
            if (behind(text, word)) return true;
        return text == "endgroup" || text.starts_with("group ") || text.starts_with("module ");
    }

    static bool is_rule(std::string_view text) {
        if (is_python(cpfg_name_at(text))) return false;
        return text.find("-->") != std::string_view::npos ||
               (find_outside(text, ":") != std::string_view::npos && !assignments_of(text));
    }

    /// The names before each `=` of `a = b = 1` and `a, b = 1, 2`, and the values.
    using Assignments = std::vector<std::pair<std::string, std::string_view>>;
    static std::optional<Assignments> assignments_of(std::string_view text) {
        std::vector<std::string_view> parts;
        std::size_t from = 0;
        for (std::size_t at = find_outside(text, "="); at != std::string_view::npos;
             at = find_outside(text, "=", at + 1)) {
            if (text.substr(at).starts_with("==") ||
                (at > 0 && std::string_view("=<>!").find(text[at - 1]) != std::string_view::npos)) {
                if (parts.empty()) return std::nullopt;
                break;
            }
            parts.push_back(trimmed(text.substr(from, at - from)));
            from = at + 1;
        }
        if (parts.empty()) return std::nullopt;
        const std::string_view value = trimmed(text.substr(from));
        Assignments all;
        for (const std::string_view part : parts) {
            std::string_view names = part, values = value;
            const bool several = names.find(',') != std::string_view::npos;
            for (;;) {
                const std::size_t comma =
                    several ? std::min(find_outside(names, ","), names.size()) : names.size();
                const std::size_t stop =
                    several ? std::min(find_outside(values, ","), values.size()) : values.size();
                const std::string_view name = trimmed(names.substr(0, comma));
                if (name.empty() || cpfg_name_at(name) != name) return std::nullopt;
                all.emplace_back(name, trimmed(values.substr(0, stop)));
                if (comma == names.size()) break;
                names.remove_prefix(comma + 1);
                values.remove_prefix(std::min(stop + 1, values.size()));
            }
        }
        return all;
    }

    /// First reading: names, functions and modules, which rules before them may use.
    void read_python(const LpyLine& line) {
        const std::string_view text = line.text, word = cpfg_name_at(text);
        if (turns(line) || text.empty()) return;
        if (text.starts_with("module ")) return strings_.declare(text.substr(7));
        if (word == "import" || word == "from") return python_.add_import(text);
        if (word == "extern") return read_extern(line);
        if (text.starts_with("def ")) {
            if (!moment_of(text)) python_.add_function(line);
            return;
        }
        if (is_statement(text) || (in_rules_ && is_rule(text))) return;
        if (const std::optional<Assignments> all = assignments_of(text)) {
            for (const auto& [name, value] : *all)
                name_value(name, value, line);
            return;
        }
        if (text.starts_with("seed(") && text.ends_with(')')) {
            const std::string_view number = trimmed(text.substr(5, text.size() - 6));
            if (!number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos) {
                system_.seed = number;
                system_.seed_span = line.span;
            }
            return;
        }
        forget(line);
    }

    /// `name = lambda x: expression` is a function.
    void name_value(const std::string& name, std::string_view value, const LpyLine& line) {
        const std::size_t colon = std::min(find_outside(value, ":"), value.size());
        if (cpfg_name_at(value) != "lambda" || colon == value.size())
            return python_.name_value(name, value, line.span);
        LpyLine function = line;
        function.text = fmt::format("def {}({}): return {}", name, trimmed(value.substr(6, colon - 6)),
                                    trimmed(value.substr(colon + 1)));
        function.below.clear();
        python_.add_function(function);
    }

    /// Names that Python without a translation gives values.
    void forget(const LpyLine& line) {
        if (const std::optional<Assignments> all = assignments_of(line.text))
            for (const auto& [name, value] : *all)
                python_.name_unknown(name, line.span);
        const std::string_view text = line.text, word = cpfg_name_at(text),
                               rest = trimmed(text.substr(word.size()));
        if (rest.size() > 1 && rest[1] == '=') python_.name_unknown(std::string(word), line.span); // x += 1
        if (word == "class") python_.name_unknown(std::string(cpfg_name_at(rest)), line.span);
        for (const LpyLine& below : line.below)
            forget(below);
    }

    /// `extern(a = 1, b = 2)`
    void read_extern(const LpyLine& line) {
        const std::string_view text = line.text;
        const std::size_t open = text.find('(');
        if (open == std::string_view::npos || !text.ends_with(')')) return;
        for (const std::string_view one : split_outside(text.substr(open + 1, text.size() - open - 2)))
            if (const std::optional<Assignments> all = assignments_of(one))
                for (const auto& [name, value] : *all)
                    python_.name_value(name, value, line.span);
    }

    static std::optional<LSystemMoment> moment_of(std::string_view text) {
        constexpr std::pair<std::string_view, LSystemMoment> words[] = {
            {"Start", LSystemMoment::start},
            {"StartEach", LSystemMoment::start_each},
            {"EndEach", LSystemMoment::end_each},
            {"End", LSystemMoment::end}};
        const std::string_view name = text.starts_with("def ") ? cpfg_name_at(trimmed(text.substr(4))) : "";
        for (const auto& [word, moment] : words)
            if (name == word) return moment;
        return std::nullopt;
    }

    /// Statements of `Start`, `StartEach`, `EndEach` and `End` that give the file's numbers other values.
    void read_moment(const LpyLine& line) {
        const std::optional<LSystemMoment> moment = moment_of(line.text);
        if (!moment) return;
        std::set<std::string> globals;
        LpyValues values;
        bool good = true;
        quiet_ = &good;
        const std::optional<LSystemBlock> block = block_of(line.below, globals, values);
        quiet_ = nullptr;
        if (good && block) {
            moments_.push_back({*moment, *block, line.span});
            return;
        }
        if (*moment != LSystemMoment::end)
            for (const std::string& name : globals)
                python_.name_unknown(name, line.span);
        file_.diagnostics.warning(line.span, fmt::format("'{}' is Python that has no translation, and is "
                                                         "left out",
                                                         cpfg_name_at(trimmed(line.text.substr(4)))));
    }

    std::optional<LSystemBlock> block_of(const std::vector<LpyLine>& lines, std::set<std::string>& globals,
                                         LpyValues& values) {
        LSystemBlock block;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const LpyLine& line = lines[i];
            const std::string_view text = line.text, word = cpfg_name_at(text);
            if (text.starts_with('"') || text.starts_with('\'') || word == "pass" || word == "print")
                continue;
            if (word == "global") {
                std::string_view names = text.substr(6);
                while (!trimmed(names).empty()) {
                    const std::size_t comma = std::min(names.find(','), names.size());
                    globals.emplace(trimmed(names.substr(0, comma)));
                    names.remove_prefix(std::min(comma + 1, names.size()));
                }
            } else if (const std::optional<Assignments> all = assignments_of(text); all && all->size() == 1) {
                const auto& [name, value] = all->front();
                std::string own = python_.expression(value, line.span, values);
                if (globals.contains(name)) {
                    const std::string global = lpy_own_name(name);
                    // Locals are written out where they are read, which would read the new value.
                    for (const auto& [local, written] : values)
                        if (names_any(written, [&](std::string_view read) { return read == global; }))
                            return std::nullopt;
                    block.push_back({.name = global, .target = global, .value = std::move(own)});
                } else {
                    values.insert_or_assign(name, "(" + own + ")");
                }
            } else {
                return std::nullopt;
            }
        }
        return block;
    }

    void name_numbers() {
        LSystemBlock& start = system_.blocks[LSystemMoment::start];
        for (const LpyPython::Number& number : python_.numbers()) {
            start.push_back({.name = number.name, .target = number.name, .value = number.value});
            system_.block_spans.try_emplace(LSystemMoment::start, number.span);
        }
        for (const Moment& moment : moments_) {
            LSystemBlock& block = system_.blocks[moment.moment];
            block.insert(block.end(), moment.block.begin(), moment.block.end());
            system_.block_spans.insert_or_assign(moment.moment, moment.span);
        }
    }

    /// Second reading: what makes up the system.
    void read_statement(const LpyLine& line) {
        const std::string_view text = line.text;
        if (text.empty()) {
            if (!ended_) comments_.emplace_back(line.comment, line.span);
            return;
        }
        if (turns(line)) {
            if (behind(text, "production")) section_ = LSystemSection::productions;
            if (behind(text, "decomposition")) section_ = LSystemSection::decomposition;
            if (behind(text, "homomorphism") || behind(text, "interpretation"))
                section_ = LSystemSection::homomorphism;
            return;
        }
        if (const auto axiom = behind(text, "Axiom")) {
            system_.axiom = strings_.read(*axiom, line.span, {});
            system_.axiom_span = line.span;
            system_.head_comments = std::exchange(comments_, {});
        } else if (const auto length = behind(text, "derivation length")) {
            system_.length = python_.expression(*length, line.span, {});
            system_.length_span = line.span;
        } else if (const auto depth = behind(text, "maximum depth")) {
            system_.depth[section_] = std::string(*depth);
        } else if (const auto skipped = behind(text, "ignore")) {
            filter("ignore", *skipped, line.span);
        } else if (const auto seen = behind(text, "consider")) {
            filter("consider", *seen, line.span);
        } else if (text.starts_with("group ")) {
            if (trimmed(text.substr(6)) != "0:") complain(line.span, "groups of rules have no translation");
        } else if (in_rules_ && !is_statement(text) && is_rule(text)) {
            add_rule(line);
        }
    }

    void filter(const char* word, std::string_view symbols, Span span) {
        std::string names;
        LpyValues values;
        std::string condition, spaced(symbols);
        std::ranges::replace(spaced, ',', ' ');
        for (const LSystemModule& module : strings_.formals(spaced, span, values, condition))
            names += module.symbol + " ";
        if (!system_.filter.empty() && (system_.filter != word || system_.filter_symbols != names))
            complain(span, "'consider' and 'ignore' for some of the rules have no translation");
        system_.filter = word;
        system_.filter_symbols = names;
        system_.filter_span = span;
    }

    void add_rule(const LpyLine& line) {
        const std::string_view text = line.text;
        const std::size_t arrow = text.find("-->");
        const std::size_t end = arrow != std::string_view::npos ? arrow : find_outside(text, ":");
        std::string_view head = text.substr(0, end);
        LSystemProduction rule;
        rule.span = line.span;
        rule.comments = std::exchange(comments_, {});
        if (head.find("<<") != std::string_view::npos || head.find(">>") != std::string_view::npos ||
            find_outside(head, "=") != std::string_view::npos)
            return complain(line.span, "contexts by '<<', '>>' and '=]' have no translation");
        LpyValues values;
        if (const std::size_t less = find_outside(head, "<"); less != std::string_view::npos) {
            rule.left = strings_.formals(head.substr(0, less), line.span, values, rule.condition);
            head.remove_prefix(less + 1);
        }
        const std::size_t more = std::min(find_outside(head, ">"), head.size());
        rule.predecessor = strings_.formals(head.substr(0, more), line.span, values, rule.condition);
        if (more < head.size())
            rule.right = strings_.formals(head.substr(more + 1), line.span, values, rule.condition);
        if (rule.predecessor.empty()) return complain(line.span, "this rule rewrites nothing");
        if (section_ != LSystemSection::productions && (!rule.left.empty() || !rule.right.empty()))
            return complain(line.span,
                            "a context of an interpretation or a decomposition has no translation");
        if (arrow != std::string_view::npos) {
            rule.successor = strings_.read(text.substr(arrow + 3), line.span, values);
            system_.productions[section_].push_back(std::move(rule));
            return;
        }
        std::vector<LpyLine> lines;
        if (const std::string_view rest = trimmed(text.substr(end + 1)); !rest.empty())
            lines.push_back({std::string(rest), "", line.span, line.indent + 1, {}});
        lines.insert(lines.end(), line.below.begin(), line.below.end());
        for (LpyPath& way : python_.ways(lines, values)) {
            LSystemProduction& own = system_.productions[section_].emplace_back(rule);
            rule.comments.clear();
            own.span = way.spans.back();
            for (const std::string& condition : way.conditions)
                own.condition += (own.condition.empty() ? "" : " && ") + condition;
            own.probability = way.chance;
            for (std::size_t i = 0; i < way.produced.size(); ++i) {
                const LSystemString part = strings_.read(way.produced[i], way.spans[i], way.values);
                own.successor.insert(own.successor.end(), part.begin(), part.end());
            }
        }
    }

    struct Moment {
        LSystemMoment moment;
        LSystemBlock block;
        Span span;
    };

    const ForeignFile& file_;
    LpyPython python_;
    LpyStrings strings_;
    LSystem system_;
    LSystemComments comments_;
    std::vector<Moment> moments_;
    LSystemSection section_ = LSystemSection::productions;
    bool in_rules_ = false, ended_ = false;
    bool* quiet_ = nullptr;
    std::optional<std::size_t> last_; ///< place of the last complaint
};

} // namespace

std::optional<LSystem> read_lpy(const ForeignFile& file) {
    return LpyReader(file).read();
}

} // namespace graftal
