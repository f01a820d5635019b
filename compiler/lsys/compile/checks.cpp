#include "compiler/lsys/compile/checks.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/parse/scanner.h"

namespace graftal {

namespace {

class GrammarChecks {
  public:
    /// `miscounted`: symbols whose numbers of parameters a message has compared.
    GrammarChecks(const LsysGrammar& grammar, const std::vector<LsysUse>& uses,
                  const std::set<SymbolId>& miscounted, Diagnostics& diagnostics)
        : grammar_(grammar), uses_(uses), miscounted_(miscounted), diagnostics_(diagnostics) {}

    /// Each symbol, and each number of parameters of it, is spoken of once.
    void check_symbols() {
        std::set<SymbolId> seen_by_contexts;
        for (const LsysRule& rule : grammar_.rules)
            for (const auto* context : {&rule.following, &rule.left, &rule.right})
                for (const LsysPattern& pattern : *context)
                    seen_by_contexts.insert(pattern.symbol);
        std::set<std::string_view> declared;
        for (const Name& module : grammar_.source->modules)
            declared.insert(module.text);
        std::set<std::pair<SymbolId, std::size_t>> checked;
        Word word;
        for (const LsysUse& use : uses_) {
            const std::string& name = grammar_.symbols[use.symbol];
            if (!is_letter(name) || use.span.begin != word.end) finish(word);
            if (is_letter(name)) {
                word.text += name;
                word.end = use.arity == 0 ? use.span.end : 0;
            }
            const bool rewritten = grammar_.is_rewritten(use.symbol);
            if (grammar_.commands[use.symbol] != TurtleCommand::none) continue;
            if (!checked.emplace(use.symbol, rewritten ? use.arity : 0).second) continue;
            if (rewritten) {
                if (!grammar_.source->broken && !miscounted_.contains(use.symbol) &&
                    !is_rewritten(use.symbol, use.arity))
                    warn_of_arity(use, name);
            } else if (!is_letter(name)) {
                diagnostics_.error(use.span, fmt::format("'{}' means nothing to the turtle", name))
                    .with_hint(name == "\""
                                   ? "write strings of modules without quotes: axiom F"
                                   : "use letters for modules; docs/language.md lists the turtle's symbols");
            } else if (!seen_by_contexts.contains(use.symbol) && !declared.contains(name)) {
                word.idle.push_back(&use);
            }
        }
        finish(word);
    }

  private:
    bool is_rewritten(SymbolId id, std::size_t arity) const {
        return std::ranges::any_of(grammar_.rules_of, [&](const auto& rules) {
            return std::ranges::any_of(rules[id], [&](std::uint32_t rule) {
                return grammar_.rules[rule].predecessor.arity == arity;
            });
        });
    }

    /// Letters that follow each other without anything between them: one name, perhaps, read letter by
    /// letter.
    struct Word {
        std::string text;
        std::uint32_t end = 0;            ///< where the next letter would stand; 0: nowhere
        std::vector<const LsysUse*> idle; ///< modules without a production, not spoken of before
    };

    /// Without what could not be read, nobody knows which modules have a production.
    void finish(Word& word) {
        if (!word.idle.empty() && !grammar_.source->broken) warn_of_idle(word);
        word = {};
    }

    void warn_of_idle(const Word& word) {
        std::string quoted, names;
        for (const LsysUse* use : word.idle) {
            const std::string& name = grammar_.symbols[use->symbol];
            quoted += fmt::format("{}'{}'",
                                  quoted.empty()            ? ""
                                  : use == word.idle.back() ? " and "
                                                            : ", ",
                                  name);
            names += " " + name;
        }
        const Span span = join(word.idle.front()->span, word.idle.back()->span);
        if (word.idle.size() == 1) {
            diagnostics_.warning(span, fmt::format("{} has no production and draws nothing", quoted))
                .with_hint(fmt::format("write 'modules{}' if you mean this", names));
            return;
        }
        std::vector<std::string> declared;
        for (const Name& module : grammar_.source->modules)
            declared.emplace_back(module.text);
        const std::string meant = did_you_mean(word.text, declared);
        const bool can_be_declared = word.text.size() <= max_lsys_symbol && can_name_module(word.text);
        const std::string separate = fmt::format("'modules{}' if you mean this", names);
        diagnostics_.warning(span, fmt::format("{} have no production and draw nothing", quoted))
            .with_hint(!meant.empty()    ? meant
                       : can_be_declared ? fmt::format("write 'modules {}' to make one name of "
                                                       "them, or {}",
                                                       word.text, separate)
                                         : fmt::format("write {}", separate));
    }

    void warn_of_arity(const LsysUse& use, const std::string& name) {
        std::set<std::size_t> known;
        for (const auto& rules : grammar_.rules_of)
            for (const std::uint32_t rule : rules[use.symbol])
                known.insert(grammar_.rules[rule].predecessor.arity);
        diagnostics_
            .warning(use.span,
                     fmt::format("no production rewrites '{}' with {}", name, parameter_count(use.arity)))
            .with_hint(fmt::format("its productions have {}", parameter_count(*known.begin())));
    }

    static bool is_letter(const std::string& name) {
        return std::isalnum(static_cast<unsigned char>(name.front())) || name.front() == '_';
    }

    const LsysGrammar& grammar_;
    const std::vector<LsysUse>& uses_;
    const std::set<SymbolId>& miscounted_;
    Diagnostics& diagnostics_;
};

} // namespace

bool is_bracket(const LsysGrammar& grammar, SymbolId id) {
    return grammar.commands[id] == TurtleCommand::open_branch ||
           grammar.commands[id] == TurtleCommand::close_branch;
}

std::string parameter_count(std::size_t parameters) {
    return fmt::format("{} parameter{}", parameters == 0 ? "no" : std::to_string(parameters),
                       parameters == 1 ? "" : "s");
}

void check_grammar(const LsysGrammar& grammar, const std::vector<LsysUse>& uses, Diagnostics& diagnostics) {
    std::set<SymbolId> miscounted;
    // Without the parts that an error lost, a production may seem to fit nothing.
    if (!grammar.source->broken && !diagnostics.has_errors())
        miscounted = warn_of_idle_productions(grammar, uses, diagnostics);
    GrammarChecks(grammar, uses, miscounted, diagnostics).check_symbols();
}

} // namespace graftal
