#include "compiler/lsys/as_drawn.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/derive/deriver.h"
#include "compiler/lsys/derive/word.h"
#include "compiler/lsys/turtle/witness.h"
#include "compiler/lsys/walk/plant.h"
#include "compiler/lsys/walk/plant_tally.h"
#include "compiler/lsys/walk/queries.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

bool is_in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

bool is_long_name(std::string_view symbol) {
    return symbol.size() > 1 && is_in_name(symbol.back());
}

/// A word as an axiom would have it: `F(1)[+(25)A(0.5)]`, numbers as the shortest decimals that read back to
/// them, and blanks about names of several letters, and where letters would read as such a name. It is the
/// word before interpretation.
class WrittenWord : public WordWitness {
  public:
    /// Both must outlive this. `steps`: of the derivation. More modules are an error.
    WrittenWord(const LsysGrammar& grammar, unsigned steps, std::uint64_t most_modules,
                Diagnostics& diagnostics)
        : grammar_(grammar), steps_(steps), most_modules_(most_modules), diagnostics_(diagnostics) {
        for (const Name& name : grammar.source->modules)
            if (name.text.size() > 1) names_.insert(name.text);
    }

    std::string take() && { return std::move(text_); }

    void add(SymbolId symbol, std::span<const double> parameters) {
        const std::string& name = grammar_.symbols[symbol];
        const bool is_letter = name.size() == 1 && is_in_name(name.front());
        if (is_letter)
            letters_ += name;
        else
            letters_.clear();
        const bool apart = is_long_name(name) && !text_.empty() && text_.back() != ' ';
        if (apart || ends_as_a_name()) {
            text_ += ' ';
            letters_ = is_letter ? name : "";
        }
        text_ += name;
        if (!parameters.empty()) letters_.clear();
        for (std::size_t i = 0; i < parameters.size(); ++i)
            text_ += (i == 0 ? "(" : ",") + shortest(parameters[i]);
        if (!parameters.empty())
            text_ += ')';
        else if (is_long_name(name))
            text_ += ' ';
    }
    bool begins(const Module& module, const Turtle&) override {
        add(module.symbol, module.parameters);
        return ++count_ <= most_modules_ || refuse_length(grammar_, most_modules_, steps_, diagnostics_);
    }
    void closes_branch() override {
        text_ += ']';
        letters_.clear();
    }

  private:
    /// Whether the last letters, modules each, would read as one of a longer name.
    bool ends_as_a_name() const {
        if (names_.empty()) return false;
        for (std::size_t size = 2; size <= std::min(letters_.size(), max_lsys_symbol); ++size)
            if (names_.contains(std::string_view(letters_).substr(letters_.size() - size))) return true;
        return false;
    }

    const LsysGrammar& grammar_;
    unsigned steps_;
    std::uint64_t most_modules_;
    Diagnostics& diagnostics_;
    std::set<std::string_view> names_; ///< of several letters, that are declared
    std::uint64_t count_ = 0;
    std::string text_;
    std::string letters_; ///< at its end, that are modules each
};

/// The word of a grammar after these steps, derived module by module; nothing after an error. O(modules of
/// all words).
std::optional<std::string> derived_word(LsysRewriter& rewriter, unsigned steps, std::uint64_t seed,
                                        std::uint64_t max_modules, Diagnostics& diagnostics) {
    const LsysGrammar& grammar = rewriter.grammar();
    if (!rewriter.prepare(steps)) return std::nullopt;
    LsysQueries queries(rewriter, diagnostics, seed);
    LsysDeriver deriver(rewriter, diagnostics, seed, max_modules);
    if (grammar.has_queries())
        deriver.after_each_step(
            [&](std::uint32_t step, ModuleString& word) { return queries.answer(step, word); });
    const std::optional<ModuleString> word = deriver.derive(steps);
    if (!word) return std::nullopt;
    WrittenWord written(grammar, steps, max_modules, diagnostics);
    for (const ModuleId id : *word)
        written.add(rewriter.modules().symbol(id), rewriter.modules().parameters(id));
    return std::move(written).take();
}

bool has_word(const LsysGrammar& grammar, const LsysDrawOptions& options, Diagnostics& diagnostics) {
    if (options.steps) return true;
    const LsysBlock& block = *grammar.source;
    diagnostics
        .error(block.steps->span, fmt::format("'lsys {}' draws a limit, which has no word", block.name.text))
        .with_hint("give '--steps N' for the word after so many steps");
    return false;
}

/// Whether it is composed of parts that chance chooses once each, rather than derived.
bool is_composed(const LsysGrammar& grammar, const LsysDrawOptions& options) {
    return grammar.is_stochastic && !options.exact && !grammar.needs_word;
}

/// A rule that draws and cuts, so that no turtle comes to the rest of the word; null if there is none.
const LsysRule* cutting_rule(const LsysGrammar& grammar) {
    const auto cuts = [&](const LsysTemplate& module) {
        return grammar.commands[module.symbol] == TurtleCommand::cut;
    };
    const auto rule = std::ranges::find_if(grammar.rules, [&](const LsysRule& some) {
        return some.kind == RuleKind::interpret && std::ranges::any_of(some.successor, cuts);
    });
    return rule == grammar.rules.end() ? nullptr : &*rule;
}

} // namespace

std::optional<std::string> word_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                         LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                         Diagnostics& diagnostics) {
    if (!has_word(grammar, options, diagnostics)) return std::nullopt;
    const std::uint64_t most = std::min(most_told_modules, options.max_modules);
    if (!is_composed(grammar, options)) {
        LsysRewriter rewriter(grammar, diagnostics, options.seed, options.meter);
        if (options.exact) rewriter.use_no_pool();
        return derived_word(rewriter, *options.steps, options.seed, most, diagnostics);
    }
    if (const LsysRule* const rule = cutting_rule(grammar)) {
        diagnostics.error(rule->source->span, "an interpretation that cuts hides the rest of a random word")
            .with_hint("give '--exact'");
        return std::nullopt;
    }
    WrittenWord word(grammar, *options.steps, most, diagnostics);
    if (!tell_lsys(grammar, models, options, graph, pool, diagnostics, word)) return std::nullopt;
    return std::move(word).take();
}

std::shared_ptr<const Plant> plant_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                            LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                            Diagnostics& diagnostics) {
    if (!has_word(grammar, options, diagnostics)) return nullptr;
    const std::uint64_t most = std::min(most_told_modules, options.max_modules);
    LsysGrammar aged = grammar;
    if (!is_composed(grammar, options)) {
        options.max_modules = most;
        // Births tell modules apart that are equal otherwise, which chance may see in interpretations.
        if (!grammar.is_random(RuleKind::interpret)) aged.ages.assign(aged.symbols.size(), true);
    }
    PlantBuilder plant(aged, *options.steps + options.share, most, diagnostics);
    if (!tell_lsys(aged, models, options, graph, pool, diagnostics, plant)) return nullptr;
    return std::make_shared<const Plant>(std::move(plant).take());
}

std::shared_ptr<const PlantTotals> totals_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                                   const LsysDrawOptions& options, Graph& graph,
                                                   ObjectPool& pool, Diagnostics& diagnostics) {
    if (!options.steps || options.exact || grammar.needs_word) return nullptr;
    PlantTally tally(grammar, *options.steps + options.share);
    if (!tell_lsys(grammar, models, options, graph, pool, diagnostics, tally)) return nullptr;
    return std::make_shared<const PlantTotals>(tally.totals());
}

} // namespace graftal
