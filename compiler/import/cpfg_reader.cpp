#include "compiler/import/cpfg_reader.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg_expression.h"
#include "compiler/import/cpfg_string.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

class SystemReader {
  public:
    explicit SystemReader(CpfgNames& names) : names_(names) {}

    std::optional<CpfgSystem> read() {
        Diagnostics& diagnostics = names_.file().diagnostics;
        const std::size_t errors = diagnostics.error_count();
        for (const CpfgStatement& statement : names_.source().statements) {
            if (ended_ || diagnostics.full()) break;
            read(statement);
        }
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
        } else if (is("seed:") && section_ == CpfgSection::productions) {
            system_.seed = names_.expression(value(), span);
            system_.seed_span = span;
            system_.stochastic = true;
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
        } else if (is("start:")) {
            take_start(value(), span);
        } else if (is("starteach:") || is("start each:") || is("endeach:") || is("end each:") || is("end:")) {
            take_blocks(value(), span);
        } else if (is("define:")) {
            names_.error(span, "arrays and other definitions have no translation");
        } else if (is("ring ")) {
            names_.error(span, "a ring L-system has no translation");
        } else if (is("homomorphism")) {
            section_ = CpfgSection::homomorphism;
        } else if (is("decomposition")) {
            section_ = CpfgSection::decomposition;
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

    /// `{ a = 1; b = a/2; }`: names and values; false after an error. What prints is left out.
    bool assignments(std::string_view block, Span span,
                     std::vector<std::pair<std::string, std::string>>& out) {
        block = trimmed(block);
        if (block.starts_with('{')) block.remove_prefix(1);
        if (block.ends_with('}')) block.remove_suffix(1);
        while (!trimmed(block).empty()) {
            const std::size_t end = std::min(find_outside(block, ";"), block.size());
            const std::string_view statement = trimmed(block.substr(0, end));
            block.remove_prefix(std::min(end + 1, block.size()));
            if (statement.empty()) continue;
            std::size_t name_end = 0;
            while (name_end < statement.size() && is_cpfg_name(statement[name_end]))
                ++name_end;
            const std::string name(statement.substr(0, name_end));
            const std::string_view rest = trimmed(statement.substr(name_end));
            if (name == "printf" || name == "fprintf") {
                names_.warn_once(span, "what the model prints is left out");
            } else if (name == "srand") {
                names_.warn_once(span, "srand() is left out: one seed decides all");
            } else if (!name.empty() && rest.starts_with('=') && !rest.starts_with("==")) {
                out.emplace_back(name, names_.expression(rest.substr(1), span));
            } else {
                names_.error(span, fmt::format("'{}' has no translation here",
                                               name.empty() ? comment_text(statement.substr(0, 20)) : name));
                return false;
            }
        }
        return true;
    }

    void take_start(std::string_view block, Span span) {
        std::vector<std::pair<std::string, std::string>> values;
        if (!assignments(block, span, values)) return;
        for (auto& [name, value] : values) {
            if (!globals_.insert(name).second)
                names_.error(span, fmt::format("'{}' changes, which has no translation", name));
            system_.globals.emplace_back(name, value);
        }
        system_.globals_span = span;
    }

    /// Blocks of each step and of the end: what they say may not change anything.
    void take_blocks(std::string_view block, Span span) {
        std::vector<std::pair<std::string, std::string>> values;
        if (assignments(block, span, values) && !values.empty())
            names_.error(span, "variables that change from step to step have no translation");
    }

    void add_production(const CpfgStatement& statement, Span span) {
        CpfgProduction production;
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
            if (system_.stochastic)
                production.probability = names_.expression(tail.substr(chance + 1), span);
            else
                names_.warn_once(
                    span, "without a seed cpfg passes over probabilities: the first production counts");
        }
        system_.productions[section_].push_back(std::move(production));
    }

    void read_left_side(std::string_view text, CpfgProduction& production) {
        const std::size_t less = find_outside(text, "<");
        if (less != std::string_view::npos) {
            production.has_left = true;
            if (trimmed(text.substr(0, less)) != "*")
                production.left = read_cpfg_string(text.substr(0, less), names_, production.span);
            text.remove_prefix(less + 1);
        }
        const std::size_t more = find_outside(text, ">");
        if (more != std::string_view::npos) {
            production.has_right = true;
            const std::string_view right = trimmed(text.substr(more + 1));
            if (right != "*") production.right = read_cpfg_string(right, names_, production.span);
        }
        production.predecessor = read_cpfg_string(text.substr(0, more), names_, production.span);
        // It says that the branch may go on, which is so without it.
        std::erase_if(production.right, [](const CpfgModule& module) { return module.symbol == "="; });
        if (production.predecessor.size() != 1)
            names_.error(production.span,
                         fmt::format("a production for {} modules has no translation: ours rewrite one",
                                     production.predecessor.size()));
    }

    /// `{ before } condition { after }`
    bool read_condition(std::string_view text, CpfgProduction& production) {
        text = trimmed(text);
        if (text.starts_with('{')) {
            const std::size_t end = std::min(text.find('}') + 1, text.size());
            if (!add_locals(text.substr(0, end), production)) return false;
            text = trimmed(text.substr(end));
        }
        const std::size_t open = std::min(text.find('{'), text.size());
        const std::string_view condition = trimmed(text.substr(0, open));
        if (condition != "*" && !condition.empty())
            production.condition = names_.expression(condition, production.span);
        return open == text.size() || add_locals(text.substr(open), production);
    }

    bool add_locals(std::string_view block, CpfgProduction& production) {
        std::vector<std::pair<std::string, std::string>> values;
        if (!assignments(block, production.span, values)) return false;
        for (auto& [name, value] : values) {
            if (globals_.contains(name)) {
                names_.error(
                    production.span,
                    fmt::format("'{}' is a variable of the model: that a production changes it has no "
                                "translation",
                                name));
                return false;
            }
            production.locals.emplace_back(name, value);
        }
        return true;
    }

    CpfgNames& names_;
    CpfgSystem system_;
    int systems_ = 0;
    bool ended_ = false;
    CpfgSection section_ = CpfgSection::productions;
    std::set<std::string> globals_;
};

} // namespace

std::optional<CpfgSystem> read_cpfg_system(CpfgNames& names) {
    return SystemReader(names).read();
}

} // namespace graftal
