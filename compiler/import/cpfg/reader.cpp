#include "compiler/import/cpfg/reader.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/block.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/cpfg/string.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

bool is_letter(const LSystemModule& module) {
    return module.symbol.size() == 1 && std::isalnum(static_cast<unsigned char>(module.symbol[0]));
}

bool alike(const LSystemModule& a, const LSystemModule& b) {
    return a.symbol == b.symbol && a.parameters.size() == b.parameters.size();
}

/// Several letters, of which the last may have parameters.
bool is_name(const LSystemString& string) {
    return string.size() > 1 && std::ranges::all_of(string, is_letter) &&
           std::all_of(string.begin(), string.end() - 1,
                       [](const LSystemModule& module) { return module.parameters.empty(); });
}

bool begins_with(const LSystemString& string, std::size_t at, const LSystemString& name) {
    return at + name.size() <= string.size() &&
           std::equal(name.begin(), name.end(), string.begin() + static_cast<std::ptrdiff_t>(at), alike);
}

void each_string(LSystem& system, const std::function<void(LSystemString&)>& take) {
    take(system.axiom);
    for (auto& [section, productions] : system.productions)
        for (LSystemProduction& production : productions)
            for (LSystemString* string :
                 {&production.left, &production.predecessor, &production.right, &production.successor})
                take(*string);
}

LSystemModule joined(const LSystemString& string, std::size_t at, std::size_t count) {
    LSystemModule module = string[at + count - 1];
    module.symbol.clear();
    for (std::size_t i = 0; i < count; ++i)
        module.symbol += string[at + i].symbol;
    return module;
}

/// cpfg has modules of one letter only, but its decompositions and homomorphisms may be for several that
/// stand side by side: `Sl --> ...`. Where these modules are one name in all that they do, each such sequence
/// becomes a module of that name.
class NameJoiner {
  public:
    explicit NameJoiner(LSystem& system) : system_(system) {
        for (auto& [section, productions] : system.productions)
            for (const LSystemProduction& production : productions) {
                if (production.predecessor.size() == 1)
                    rewritten_.insert(
                        {production.predecessor[0].symbol, production.predecessor[0].parameters.size()});
                if (section != LSystemSection::productions && is_name(production.predecessor) &&
                    !knows(production.predecessor))
                    names_.push_back(production.predecessor);
            }
        std::ranges::stable_sort(names_, std::greater<>(), &LSystemString::size);
    }

    void join() {
        // A letter that stands nowhere else keeps the sequence of its name from coming about by chance.
        each_string(system_, [&](LSystemString& string) { note_letters(string); });
        std::erase_if(names_, [&](const LSystemString& name) { return !is_closed(name); });
        if (names_.empty()) return;
        each_string(system_, [&](LSystemString& string) { join(string); });
    }

  private:
    bool knows(const LSystemString& name) const {
        return std::ranges::any_of(names_, [&](const LSystemString& known) {
            return known.size() == name.size() && begins_with(known, 0, name);
        });
    }

    /// Number of modules of the name that begins here; 0 if none does.
    std::size_t name_at(const LSystemString& string, std::size_t at) const {
        for (const LSystemString& name : names_)
            if (begins_with(string, at, name)) return name.size();
        return 0;
    }

    void note_letters(const LSystemString& string) {
        for (std::size_t i = 0; i < string.size();) {
            const std::size_t count = name_at(string, i);
            if (count == 0) single_.insert({string[i].symbol, string[i].parameters.size()});
            i += std::max<std::size_t>(count, 1);
        }
    }

    bool is_closed(const LSystemString& name) const {
        // Read from the left, a name is rewritten as a whole before what is in it.
        const bool falls_apart = rewritten_.contains({name[0].symbol, name[0].parameters.size()}) ||
                                 !name.back().parameters.empty();
        if (falls_apart && std::ranges::any_of(name, [&](const LSystemModule& module) {
                return rewritten_.contains({module.symbol, module.parameters.size()});
            }))
            return false;
        return std::ranges::any_of(name, [&](const LSystemModule& module) {
            return !single_.contains({module.symbol, module.parameters.size()});
        });
    }

    void join(LSystemString& string) const {
        LSystemString result;
        for (std::size_t i = 0; i < string.size();) {
            const std::size_t count = name_at(string, i);
            result.push_back(count == 0 ? string[i] : joined(string, i, count));
            i += std::max<std::size_t>(count, 1);
        }
        string = std::move(result);
    }

    LSystem& system_;
    std::vector<LSystemString> names_;                                 ///< the longest first
    std::set<std::pair<std::string, std::size_t>> single_, rewritten_; ///< modules beside and in names
};

class SystemReader {
  public:
    explicit SystemReader(CpfgNames& names) : names_(names) {}

    std::optional<LSystem> read() {
        Diagnostics& diagnostics = names_.file().diagnostics;
        const std::size_t errors = diagnostics.error_count();
        for (const CpfgStatement& statement : names_.source().statements) {
            if (ended_ || diagnostics.full()) break;
            read(statement);
        }
        NameJoiner(system_).join();
        if (system_.axiom.empty() && diagnostics.error_count() == errors)
            names_.error(Span(), "the model has no axiom");
        if (diagnostics.error_count() > errors) return std::nullopt;
        return std::move(system_);
    }

  private:
    static Span span_of(const CpfgStatement& statement, const ForeignFile& file) {
        const std::size_t first = statement.text.find_first_not_of(' ');
        const std::size_t last = statement.text.find_last_not_of(' ');
        const std::uint32_t begin = statement.places[first], end = statement.places[last];
        return file.span(begin, end < begin ? begin : end + 1);
    }

    void read(const CpfgStatement& statement) {
        const Span span = span_of(statement, names_.file());
        const std::string_view text = trimmed(statement.text);
        const std::string small = in_small_letters(text.substr(0, 24));
        const auto value = [&] { return trimmed(text.substr(std::min(text.find(':') + 1, text.size()))); };
        const auto is = [&](std::string_view word) { return small.starts_with(word); };
        if (is("lsystem:")) {
            if (++systems_ > 1) {
                names_.error(span, "sub-L-systems have no translation: a model has one L-system");
                ended_ = true;
            }
            system_.head_comments = statement.comments;
        } else if (is("seed:") && section_ == LSystemSection::productions) {
            system_.seed = names_.expression(value(), span);
            system_.seed_span = span;
        } else if (is("seed:")) {
            names_.warn_once(span, "a seed of the homomorphism is left out: one seed decides all");
        } else if (is("derivation length:") || is("derivationlength:")) {
            system_.length = names_.expression(value(), span);
            system_.length_span = span;
        } else if (is("maximum depth:")) {
            system_.depth[section_] = names_.expanded(value(), span, true);
        } else if (is("ignore:") || is("consider:")) {
            system_.filter = is("ignore:") ? "ignore" : "consider";
            system_.filter_symbols = value();
            system_.filter_span = span;
        } else if (is("axiom:")) {
            system_.axiom = read_cpfg_string(value(), names_, span);
            system_.axiom_span = span;
            system_.axiom_comments = statement.comments;
        } else if (const auto moment = moment_of(small)) {
            take_block(*moment, value(), span);
        } else if (is("define:")) {
            take_arrays(value(), span);
        } else if (is("ring ")) {
            names_.error(span, "a ring L-system has no translation");
        } else if (is("homomorphism")) {
            section_ = LSystemSection::homomorphism;
        } else if (is("decomposition")) {
            section_ = LSystemSection::decomposition;
        } else if (is("endlsystem")) {
            ended_ = false;
        } else if (statement.text.find("-->") != std::string::npos) {
            add_production(statement, span);
        } else if (statement.text.find("-o>") != std::string::npos) {
            names_.error(span, "productions of objects (-o>) have no translation");
        } else {
            names_.error(span, "this is no statement of cpfg");
        }
    }

    static std::optional<LSystemMoment> moment_of(std::string_view small) {
        constexpr std::pair<std::string_view, LSystemMoment> words[] = {
            {"start:", LSystemMoment::start},           {"starteach:", LSystemMoment::start_each},
            {"start each:", LSystemMoment::start_each}, {"endeach:", LSystemMoment::end_each},
            {"end each:", LSystemMoment::end_each},     {"end:", LSystemMoment::end}};
        for (const auto& [word, moment] : words)
            if (small.starts_with(word)) return moment;
        return std::nullopt;
    }

    void take_block(LSystemMoment moment, std::string_view text, Span span) {
        std::optional<LSystemBlock> block = read_cpfg_block(text, span, names_);
        if (!block) return;
        LSystemBlock& known = system_.blocks[moment];
        known.insert(known.end(), block->begin(), block->end());
        system_.block_spans.try_emplace(moment, span);
    }

    /// `{ array a[2][3] = {1, 2, 3, 4, 5, 6}; array b[2]; }`
    void take_arrays(std::string_view text, Span span) {
        text = trimmed(text);
        if (text.starts_with('{')) text.remove_prefix(1);
        if (text.ends_with('}')) text.remove_suffix(1);
        for (; !trimmed(text).empty(); text = trimmed(text)) {
            const std::size_t end = std::min(text.find(';'), text.size());
            std::string_view statement = trimmed(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
            if (statement.empty() || statement == "}") continue;
            if (!statement.starts_with("array ")) {
                names_.error(span, fmt::format("'{}' has no translation here",
                                               comment_text(statement.substr(0, statement.find(' ')))));
                return;
            }
            // Several may follow, after commas outside of braces.
            for (statement.remove_prefix(6); !trimmed(statement).empty();) {
                statement = trimmed(statement);
                int depth = 0;
                std::size_t comma = 0;
                for (; comma < statement.size() && !(statement[comma] == ',' && depth == 0); ++comma)
                    depth += (statement[comma] == '{') - (statement[comma] == '}');
                take_array(statement.substr(0, comma), span);
                statement.remove_prefix(std::min(comma + 1, statement.size()));
            }
        }
    }

    void take_array(std::string_view text, Span span) {
        LSystemArray array;
        array.span = span;
        const std::size_t equal = std::min(text.find('='), text.size());
        const std::string_view head = trimmed(text.substr(0, equal));
        const std::size_t open = std::min(head.find('['), head.size());
        array.name = names_.own_name(trimmed(head.substr(0, open)));
        for (std::size_t at = open; at < head.size();) {
            const std::size_t close = std::min(head.find(']', at), head.size());
            array.sizes += "[" + names_.expression(head.substr(at + 1, close - at - 1), span) + "]";
            at = std::min(head.find('[', close), head.size());
        }
        std::string_view values = trimmed(text.substr(std::min(equal + 1, text.size())));
        if (values.starts_with('{')) values.remove_prefix(1);
        if (values.ends_with('}')) values.remove_suffix(1);
        for (const std::string_view one : split_outside(values))
            if (!one.empty())
                array.values += (array.values.empty() ? "" : ", ") + names_.expression(one, span);
        if (array.name.empty() || array.sizes.empty())
            names_.error(span, "an array is a name and its sizes");
        else
            system_.arrays.push_back(std::move(array));
    }

    void add_production(const CpfgStatement& statement, Span span) {
        LSystemProduction production;
        production.span = span;
        production.comments = statement.comments;
        const std::string_view text = trimmed(statement.text);
        const std::size_t arrow = text.find("-->");
        const std::string_view head = text.substr(0, arrow), tail = text.substr(arrow + 3);
        const std::size_t colon = find_outside(head, ":");
        read_left_side(head.substr(0, colon), production);
        if (colon != std::string_view::npos && !read_condition(head.substr(colon + 1), production)) return;
        const std::size_t chance = find_outside(tail, ":");
        if (trimmed(tail.substr(0, chance)) != "*")
            production.successor = read_cpfg_string(tail.substr(0, chance), names_, span);
        if (chance != std::string_view::npos) {
            if (system_.seed_span.known())
                production.probability = names_.expression(tail.substr(chance + 1), span);
            else
                names_.warn_once(
                    span, "without a seed cpfg passes over probabilities: the first production counts");
        }
        system_.productions[section_].push_back(std::move(production));
    }

    void read_left_side(std::string_view text, LSystemProduction& production) {
        const std::size_t less = find_outside(text, "<");
        if (less != std::string_view::npos) {
            if (trimmed(text.substr(0, less)) != "*")
                production.left = read_cpfg_string(text.substr(0, less), names_, production.span);
            text.remove_prefix(less + 1);
        }
        const std::size_t more = find_outside(text, ">");
        if (more != std::string_view::npos) {
            const std::string_view right = trimmed(text.substr(more + 1));
            if (right != "*") production.right = read_cpfg_string(right, names_, production.span);
        }
        production.predecessor = read_cpfg_string(text.substr(0, more), names_, production.span);
        check_right(production);
        if (production.predecessor.empty())
            names_.error(production.span, "this production has no predecessor");
    }

    /// `=` says that the branch may go on, which is so without it in ours; where a branch has to end, ours
    /// cannot say so.
    void check_right(LSystemProduction& production) {
        int depth = 0;
        bool leaves = false, ends = false;
        for (std::size_t i = 0; i < production.right.size(); ++i) {
            const std::string& symbol = production.right[i].symbol;
            depth += (symbol == "[") - (symbol == "]");
            leaves = leaves || depth < 0;
            ends = ends || (symbol == "]" && i > 0 && production.right[i - 1].symbol != "=");
        }
        std::erase_if(production.right, [](const LSystemModule& module) { return module.symbol == "="; });
        if (section_ == LSystemSection::homomorphism) {
            if (!production.left.empty() || !production.right.empty())
                names_.warn_once(production.span, "contexts of the homomorphism are left out, as in cpfg");
            production.left = production.right = {};
            return;
        }
        if (leaves)
            names_.error(production.span, "a right context that leaves its branch has no translation");
        else if (ends)
            names_.error(production.span,
                         "a branch of a right context that must end (without '=') has no translation");
    }

    /// `{ before } condition { after }`
    bool read_condition(std::string_view text, LSystemProduction& production) {
        text = trimmed(text);
        if (text.starts_with('{')) {
            const std::size_t end = end_of_braces(text);
            if (!read_block(text.substr(0, end), production.span, production.before)) return false;
            text = trimmed(text.substr(end));
        }
        const std::size_t open = std::min(text.find('{'), text.size());
        const std::string_view condition = trimmed(text.substr(0, open));
        if (condition != "*" && !condition.empty())
            production.condition = names_.expression(condition, production.span);
        return open == text.size() || read_block(text.substr(open), production.span, production.after);
    }

    static std::size_t end_of_braces(std::string_view text) {
        std::size_t end = 0;
        int depth = 0;
        do
            depth += (text[end] == '{') - (text[end] == '}');
        while (++end < text.size() && depth > 0);
        return end;
    }

    bool read_block(std::string_view text, Span span, LSystemBlock& block) {
        std::optional<LSystemBlock> known = read_cpfg_block(text, span, names_);
        if (!known) return false;
        block = std::move(*known);
        return true;
    }

    CpfgNames& names_;
    LSystem system_;
    int systems_ = 0;
    bool ended_ = false;
    LSystemSection section_ = LSystemSection::productions;
};

} // namespace

std::optional<LSystem> read_cpfg_system(CpfgNames& names) {
    return SystemReader(names).read();
}

} // namespace graftal
