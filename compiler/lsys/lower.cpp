#include "compiler/lsys/lower.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/lower/inner_parameters.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/lower/lowering.h"
#include "compiler/lower/model_family.h"
#include "compiler/lsys/as_drawn.h"
#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/drawing.h"
#include "compiler/lsys/set_block.h"
#include "compiler/lsys/turtle/model_placer.h"
#include "compiler/support/counter_random.h"
#include "compiler/syntax/everyday_words.h"

namespace graftal {

namespace {

/// Blocks nest at most this deep: recursion composes them.
constexpr unsigned max_block_nesting = 256;

constexpr const char* no_steps_hint =
    "write 'steps 1' to apply each production once; those under 'interpret' need no steps";

class LsysLowering {
  public:
    LsysLowering(const LsysFile& tree, Lowering& lowering)
        : tree_(tree), lowering_(lowering), diagnostics_(lowering.diagnostics), pool_(graph_) {}

    /// All checks run, whatever has failed before, so that one run reports all of a file's errors.
    std::optional<Graph> run() && {
        if (tree_.blocks.empty() && !failed())
            diagnostics_.error({tree_.file, 0, 0}, "this file has no 'lsys' block")
                .with_hint(
                    "write one, with each statement on its own line: 'lsys bush {', 'angle 25', 'steps 4', "
                    "'axiom F', 'F -> F[+F]F', '}'");
        lets_ = evaluate_lets(tree_.statements, {}, lowering_, given_inner());
        inner_parameters(tree_.statements, lets_, diagnostics_); // for its checks
        lower_settings(tree_.statements, lets_, graph_, lowering_);
        import_models();
        build_grammars();
        if (failed()) return std::nullopt;
        const std::optional<ObjectId> root = root_of(*main_block_, Span());
        if (!root || failed()) return std::nullopt;
        graph_.root = *root;
        graph_.settings.steps.reset(); // spent on the derivation
        return std::move(graph_);
    }

  private:
    struct Use {
        Span span;
        std::optional<ObjectId> root;      ///< nothing after an error
        std::optional<ModelFamily> family; ///< in place of a root, if it has inner parameters
    };

    struct Block {
        const LsysBlock* source = nullptr;
        std::optional<LsysGrammar> grammar; ///< with the defaults of its inner parameters
        std::optional<ModelFamily> family;  ///< if it has some
        std::optional<ObjectId> root;       ///< once it is composed
        bool under_way = false;
    };

    /// A thing that `~NAME` places: one root, or a family.
    struct Model {
        std::optional<ObjectId> root; ///< nothing after an error
        ModelFamily* family = nullptr;
    };

    /// The values that the user of this file gives its inner parameters.
    const Environment& given_inner() const { return lowering_.loading.back().inner; }

    bool failed() const { return lowering_.file_failed(); }

    void import_models() {
        for (const UseStatement& use : tree_.uses) {
            if (diagnostics_.full()) return;
            const auto [first, fresh] = uses_.try_emplace(use.name.text, Use{use.name.span, {}, {}});
            if (!fresh)
                diagnostics_.error(use.name.span, fmt::format("duplicate use '{}'", use.name.text))
                    .with_note(first->second.span, "first defined here");
            else if (is_reserved_name(use.name.text)) // `~NAME` would place the primitive
                diagnostics_.error(
                    use.name.span,
                    fmt::format("'{}' is a primitive and cannot name a used model", use.name.text));
            else if (use.name.text.find('.') != std::string_view::npos)
                diagnostics_.error(
                    use.name.span,
                    fmt::format("the name '{}' of a used model must not have a '.'", use.name.text));
            else
                import_used(use, first->second);
        }
    }

    /// A model with inner parameters is imported when it is known which of its family are placed.
    void import_used(const UseStatement& source, Use& use) {
        const std::optional<FileId> file = read_model(source, lowering_);
        if (!file) return;
        std::vector<InnerParameter> parameters = inner_parameters_of(*file, lowering_);
        if (parameters.empty()) {
            use.root = import_model(graph_, source, lowering_);
            return;
        }
        const auto make = [this, &source, parameters](const std::vector<double>& values) {
            return import_member(graph_, source, named_values(parameters, values), lowering_);
        };
        use.family.emplace(std::string(source.name.text), std::move(parameters), make);
    }

    /// Builds the grammars of the blocks, and checks the names of blocks and of `--set`.
    void build_grammars() {
        Environment all_lets = lets_;
        const LsysBlock* main = nullptr;
        const LsysBlock* const chosen = graftal::main_block(tree_);
        for (const LsysBlock& block : tree_.blocks) {
            if (diagnostics_.full()) return;
            if (main && block.is_main)
                diagnostics_.error(block.name.span, "a second 'main' block")
                    .with_note(main->name.span, "the first is here");
            if (block.is_main) main = &block;
            Block& added = blocks_.emplace_back();
            added.source = &block;
            check_name(block);
            const bool is_main = &block == chosen;
            Environment lets =
                evaluate_lets(block.lets, lets_, lowering_, is_main ? given_inner() : Environment());
            if (is_main) {
                main_block_ = &added;
                set_main_ = set_block(block, lets, lowering_);
                added.source = &*set_main_;
            }
            all_lets.insert(lets.begin(), lets.end());
            if (is_main)
                for (const LsysVariable& variable : block.variables)
                    all_lets.try_emplace(std::string(variable.name.text));
            add_family(added, lets);
            added.grammar = build_grammar(*added.source, std::move(lets), diagnostics_);
        }
        if (lowering_.at_root_model())
            check_set_names(all_lets, {"angle", "step", "width", "thickness", "steps", "seed"},
                            tree_.statements, lowering_);
    }

    void add_family(Block& block, const Environment& lets) {
        std::vector<InnerParameter> parameters = inner_parameters(block.source->lets, lets, diagnostics_);
        if (parameters.empty()) return;
        const auto make = [this, &block, parameters](const std::vector<double>& values) {
            return member_of(block, named_values(parameters, values));
        };
        block.family.emplace(std::string(block.source->name.text), std::move(parameters), make);
    }

    void check_name(const LsysBlock& block) {
        const auto [first, fresh] = names_.try_emplace(block.name.text, block.name.span);
        const auto use = uses_.find(block.name.text);
        if (!fresh)
            diagnostics_.error(block.name.span, fmt::format("duplicate block '{}'", block.name.text))
                .with_note(first->second, "first defined here");
        else if (use != uses_.end())
            diagnostics_
                .error(block.name.span,
                       fmt::format("'{}' is already the name of a used model", block.name.text))
                .with_note(use->second.span, "first defined here");
        else if (is_reserved_name(block.name.text))
            diagnostics_.error(block.name.span,
                               fmt::format("'{}' is a primitive and cannot name a block", block.name.text));
    }

    /// Composes a block on first use. `use`: of `~NAME`; unknown for the main block.
    std::optional<ObjectId> root_of(Block& block, Span use) {
        if (!block.root) block.root = compose(block, *block.grammar, use);
        return block.root;
    }

    /// Composes a block with these values of its inner parameters.
    std::optional<ObjectId> member_of(Block& block, const Environment& inner) {
        const std::size_t known = diagnostics_.all().size();
        Environment lets = evaluate_lets(block.source->lets, lets_, lowering_, inner);
        const std::optional<LsysGrammar> grammar =
            build_grammar(*block.source, std::move(lets), diagnostics_);
        std::optional<ObjectId> root;
        if (grammar) root = compose(block, *grammar, block.source->name.span);
        diagnostics_.drop_repeated_remarks(known);
        return root;
    }

    std::optional<ObjectId> compose(Block& block, const LsysGrammar& grammar, Span use) {
        const std::string_view name = block.source->name.text;
        if (block.under_way) {
            diagnostics_.error(use, fmt::format("'{}' would place itself", name))
                .with_hint("write productions for a model inside itself");
            return std::nullopt;
        }
        if (nesting_ == max_block_nesting) {
            diagnostics_.error(use,
                               fmt::format("blocks place each other more than {} deep", max_block_nesting));
            return std::nullopt;
        }
        block.under_way = true;
        ++nesting_;
        const std::optional<std::map<SymbolId, Model>> models = models_of(grammar);
        std::optional<unsigned> steps;
        std::optional<ObjectId> root;
        if (find_steps(block, grammar, steps) && models) root = draw(block, grammar, *models, steps);
        --nesting_;
        block.under_way = false;
        return root;
    }

    std::optional<std::map<SymbolId, Model>> models_of(const LsysGrammar& grammar) {
        std::map<SymbolId, Model> models;
        bool good = true;
        for (SymbolId id = 0; id < grammar.symbols.size(); ++id) {
            if (!grammar.symbols[id].starts_with('~')) continue;
            const std::string_view name = std::string_view(grammar.symbols[id]).substr(1);
            const Model model = model_named(name, grammar.first_uses[id]);
            good = good && (model.root || model.family);
            models.emplace(id, model);
        }
        if (!good) return std::nullopt;
        return models;
    }

    Model model_named(std::string_view name, Span span) {
        if (const auto primitive = primitive_named(name)) return {graph_.primitive(*primitive)};
        if (const auto use = uses_.find(name); use != uses_.end())
            return {use->second.root, use->second.family ? &*use->second.family : nullptr};
        for (Block& block : blocks_) {
            if (block.source->name.text != name) continue;
            if (block.family && !block.under_way) return {{}, &*block.family};
            return {root_of(block, span)}; // of a family: for its error
        }
        report_unknown(name, span);
        return {};
    }

    void report_unknown(std::string_view name, Span span) {
        std::vector<std::string> known;
        for (const auto& [used, use] : uses_)
            known.emplace_back(used);
        for (const auto& [block, place] : names_)
            known.emplace_back(block);
        for (const PrimitiveKind kind : all_primitive_kinds)
            if (form_of(kind) == PrimitiveForm::plain) known.emplace_back(name_of(kind));
        const std::string shape = shape_word_hint(name);
        const std::string hint = shape.empty() ? did_you_mean(name, known) : shape;
        diagnostics_.error(span, fmt::format("'~{}' names no used model and no block of this file", name))
            .with_hint(
                hint.empty()
                    ? fmt::format("write use {} = \"FILE\" at the top of the file to load a model", name)
                    : hint);
    }

    ModelPlacer placer(const std::map<SymbolId, Model>& models) {
        return [this, &models](SymbolId symbol, std::span<const double> parameters,
                               Span place) -> std::optional<PlacedModel> {
            const Model& model = models.at(symbol);
            if (!model.family) return PlacedModel{*model.root, placed_scale(parameters)};
            const std::size_t inner = std::min(parameters.size(), model.family->parameters().size());
            const Vec3 scale = placed_scale(parameters.subspan(inner));
            const std::optional<ObjectId> root =
                model.family->nearest(parameters.first(inner), place, diagnostics_);
            if (!root) return std::nullopt;
            return PlacedModel{*root, scale};
        };
    }

    bool is_root(const Block& block) { return lowering_.at_root_model() && &block == main_block_; }

    /// The steps that the command line asks for.
    std::optional<unsigned> asked_steps(const LsysGrammar& grammar) const {
        const LowerOptions& options = lowering_.options;
        if (!options.time || (options.steps && !grammar.draws_in_time())) return options.steps;
        return static_cast<unsigned>(*options.time);
    }

    /// The share of the step after the last that has passed when the block is drawn.
    double share_of_step(const Block& block, const LsysGrammar& grammar) {
        const std::optional<double>& time = lowering_.options.time;
        return time && is_root(block) && grammar.draws_in_time() ? *time - std::floor(*time) : 0;
    }

    /// False after an error; no steps are infinitely many.
    bool find_steps(const Block& block, const LsysGrammar& grammar, std::optional<unsigned>& steps) {
        Span span = block.source->steps ? block.source->steps->span : block.source->name.span;
        if (is_root(block)) steps = asked_steps(grammar);
        if (steps)
            span = Span();
        else if (grammar.infinite)
            return true;
        else
            steps = grammar.steps;
        if (!steps) steps = graph_.settings.steps;
        if (!steps) {
            Diagnostic& error = diagnostics_.error(
                span, fmt::format("'lsys {}' has no number of steps", block.source->name.text));
            error.with_hint(is_root(block) ? "add 'steps 5' to it, or give '--steps 5'"
                                           : "add 'steps 5' to it");
            if (const std::optional<LsysValue>& step = block.source->step)
                error.with_note(step->span, "'step' is the length of F: is 'steps' meant?");
        } else if (*steps > max_derivation_steps)
            diagnostics_.error(span, fmt::format("a derivation has at most {} steps", max_derivation_steps));
        return steps && *steps <= max_derivation_steps;
    }

    /// Used models that differ only in their seeds differ under `--seed`, too.
    std::uint64_t seed_of(const LsysGrammar& grammar) const {
        const std::optional<std::uint64_t> asked = lowering_.options.seed;
        if (!asked) return grammar.seed;
        return lowering_.at_root_model() ? *asked : CounterRandom(*asked)(grammar.seed);
    }

    LsysDrawOptions draw_options(const Block& block, const LsysGrammar& grammar,
                                 const std::map<SymbolId, Model>& models, std::optional<unsigned> steps) {
        const LowerOptions& options = lowering_.options;
        return {.steps = steps,
                .share = share_of_step(block, grammar),
                .seed = seed_of(grammar),
                .exact = options.exact,
                .max_modules = options.max_modules,
                .inner = inner_counts(models),
                .has_other_models = has_other_models(models),
                .max_parts = options.max_objects,
                .run_from = options.run_from,
                .meter = &lowering_.meter};
    }

    /// Notes what is wanted in place of a graph.
    void tell(const LsysGrammar& grammar, const std::map<SymbolId, Model>& models,
              const LsysDrawOptions& options) {
        const ModelPlacer place = placer(models);
        LowerNotes& notes = lowering_.notes;
        switch (lowering_.options.in_place) {
        case LowerOptions::InPlace::nothing:
            break;
        case LowerOptions::InPlace::word:
            notes.word = word_as_drawn(grammar, place, options, graph_, pool_, diagnostics_);
            break;
        case LowerOptions::InPlace::plant:
            notes.plant = plant_as_drawn(grammar, place, options, graph_, pool_, diagnostics_);
            break;
        case LowerOptions::InPlace::totals:
            notes.totals = totals_as_drawn(grammar, place, options, graph_, pool_, diagnostics_);
            break;
        }
    }

    std::optional<ObjectId> draw(const Block& block, const LsysGrammar& grammar,
                                 const std::map<SymbolId, Model>& models, std::optional<unsigned> steps) {
        const LsysBlock& source = *block.source;
        const LsysDrawOptions options = draw_options(block, grammar, models, steps);
        lowering_.notes.asks_chance |= grammar.asks_chance();
        if (lowering_.options.in_place != LowerOptions::InPlace::nothing && is_root(block)) {
            tell(grammar, models, options);
            return std::nullopt;
        }
        std::optional<LsysDrawing> drawing =
            draw_lsys(grammar, placer(models), options, graph_, pool_, diagnostics_);
        if (!drawing) return std::nullopt;
        if (drawing->limited_by_work) lowering_.notes.limited_by_work = true;
        if (is_root(block)) {
            lowering_.notes.derivation = std::move(drawing->derivation);
            lowering_.notes.derivation->families = families();
            lowering_.notes.derivation->grows = grammar.grows();
        }
        const bool is_idle =
            steps == 0u && !(is_root(block) && asked_steps(grammar)) && grammar.has_rules(RuleKind::produce);
        if (drawing->instances.empty() && !drawing->packed) {
            report_nothing(block, steps, is_idle);
            return std::nullopt;
        }
        if (is_idle) warn_of_no_steps(source);
        return add_root(source, std::move(*drawing));
    }

    static std::map<SymbolId, std::size_t> inner_counts(const std::map<SymbolId, Model>& models) {
        std::map<SymbolId, std::size_t> counts;
        for (const auto& [symbol, model] : models)
            if (model.family) counts.emplace(symbol, model.family->parameters().size());
        return counts;
    }

    /// Whether some model is not a primitive of finite size.
    bool has_other_models(const std::map<SymbolId, Model>& models) const {
        return std::ranges::any_of(models, [&](const auto& entry) {
            const Model& model = entry.second;
            if (!model.root) return true;
            const std::optional<Primitive>& primitive = graph_.objects[*model.root].primitive;
            return !primitive || *primitive == PrimitiveKind::plane;
        });
    }

    void warn_of_no_steps(const LsysBlock& block) {
        diagnostics_
            .warning(block.steps ? block.steps->span : block.name.span,
                     fmt::format("'lsys {}' takes 0 steps, so its productions never apply", block.name.text))
            .with_hint(no_steps_hint)
            .with_note(block.productions.front().span, "the first production is here");
    }

    void report_nothing(const Block& block, std::optional<unsigned> steps, bool is_idle) {
        const Name& name = block.source->name;
        std::string message = fmt::format("'lsys {}' draws nothing", name.text);
        if (steps) message += fmt::format(" after {} step{}", *steps, *steps == 1 ? "" : "s");
        Diagnostic& said = is_root(block) && lowering_.options.may_draw_nothing
                               ? diagnostics_.note(name.span, std::move(message))
                               : diagnostics_.error(name.span, std::move(message));
        said.with_hint(is_idle
                           ? no_steps_hint
                           : "no module of the word draws: F draws a segment, and 'interpret A -> F' says "
                             "how to draw an A");
    }

    std::vector<FamilyReport> families() const {
        std::vector<FamilyReport> reports;
        for (const auto& [name, use] : uses_)
            if (use.family && use.family->is_used()) reports.push_back(use.family->report());
        for (const Block& block : blocks_)
            if (block.family && block.family->is_used()) reports.push_back(block.family->report());
        return reports;
    }

    /// The root of a block. Packed edges make an object of their own, unless they are all.
    std::optional<ObjectId> add_root(const LsysBlock& block, LsysDrawing drawing) {
        Object root;
        root.name = pool_.unique_name(block.name.text);
        root.span = block.name.span;
        if (drawing.packed && !drawing.instances.empty()) {
            Object parts;
            parts.name = pool_.unique_name(fmt::format("{}_parts", block.name.text));
            parts.span = root.span;
            parts.packed = std::exchange(drawing.packed, {});
            drawing.instances.push_back({graph_.add(std::move(parts)), {}, {}, {}, root.span});
        }
        root.packed = std::move(drawing.packed);
        root.instances = std::move(drawing.instances);
        const ObjectId id = graph_.add(std::move(root));
        if (!within_limits(graph_.objects.size(), instance_count(graph_), block.name.span, lowering_))
            return std::nullopt;
        return id;
    }

    const LsysFile& tree_;
    std::optional<LsysBlock> set_main_; ///< the main block with what `--set` says
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    Environment lets_; ///< of the file
    Graph graph_;
    ObjectPool pool_;
    std::deque<Block> blocks_;
    Block* main_block_ = nullptr;
    unsigned nesting_ = 0; ///< blocks under way
    std::map<std::string_view, Use> uses_;
    std::map<std::string_view, Span> names_; ///< of the blocks
};

} // namespace

std::optional<Graph> lower_lsys(const LsysFile& tree, Lowering& lowering) {
    return LsysLowering(tree, lowering).run();
}

} // namespace graftal
