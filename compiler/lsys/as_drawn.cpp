#include "compiler/lsys/as_drawn.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/walk/plant.h"
#include "compiler/lsys/walk/written_word.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_written = 5'000'000;

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
    const std::uint64_t most = std::min(most_written, options.max_modules);
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
    WrittenWord word(grammar, most, diagnostics);
    if (!tell_lsys(grammar, models, options, graph, pool, diagnostics, word)) return std::nullopt;
    return std::move(word).take();
}

std::shared_ptr<const Plant> plant_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                            LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                            Diagnostics& diagnostics) {
    if (!has_word(grammar, options, diagnostics)) return nullptr;
    const std::uint64_t most = std::min(most_written, options.max_modules);
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

} // namespace graftal
