#include "compiler/lsys/drawing.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/compose/composer.h"
#include "compiler/lsys/compose/limit.h"
#include "compiler/lsys/compose/rounding.h"
#include "compiler/lsys/derive/deriver.h"
#include "compiler/lsys/derive/folded_word.h"
#include "compiler/lsys/derive/stream.h"
#include "compiler/lsys/palette.h"
#include "compiler/lsys/walk/queries.h"
#include "compiler/lsys/width.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

// Random models: the most drift of their parts, and the numbers of their variants.
constexpr double most_drift = 0.05;
constexpr std::uint32_t fewest_variants = 16;
constexpr std::uint32_t most_variants = 4096;
/// Among so many, each module of a word finds one of its own.
constexpr std::uint32_t enough_variants = 1u << 31;

/// Most statements that blocks may carry out for each module that a word may have.
constexpr std::uint64_t instructions_a_module = 2;

/// Models with more parts get by with fewer directions.
constexpr std::size_t most_exact_parts = 100'000;
/// Models with more parts get by with fewer sizes, and with a quarter of this if sizes make the parts so
/// many. Random models may have as many for each sixteen variants.
constexpr std::size_t most_sized_parts = 16'384;
constexpr std::size_t most_resized_parts = 4'096;

/// Composing ends with more parts than this if few of them serve twice.
constexpr std::size_t most_single_parts = 16'384;
/// Composing this many parts fails where few serve twice and the word is too long for a run.
constexpr std::size_t most_parts_once_each = 131'072;
/// Words of up to this many modules are drawn into a run before sizes are rounded.
constexpr std::uint64_t most_modules_of_exact_runs = 1'000'000;

// Derivations whose levels are looked at for repetition.
constexpr unsigned first_limit_steps = 24;
constexpr unsigned last_limit_steps = 192;
/// Longer derivations are not tried, nor gone on with, if one has more parts than this.
constexpr std::size_t most_limit_parts = 1000;
constexpr std::size_t most_parts_of_one_limit = 16'384;

class Drawer {
  public:
    Drawer(const LsysGrammar& grammar, const ModelPlacer& models, const LsysDrawOptions& options,
           Diagnostics& diagnostics)
        : grammar_(grammar), models_(models), options_(options), diagnostics_(diagnostics),
          rewriter_(grammar, diagnostics, options.seed, options.meter,
                    instructions_a_module * options.max_modules),
          sizes_(grammar, options.inner), width_(stated_width(grammar)),
          width_is_open_(has_open_width(grammar)), has_sizes_(has_sizes(grammar, sizes_)),
          uses_directions_(uses_directions(grammar)), roundings_(roundings_of(grammar, sizes_)) {}

    std::optional<LsysDrawing> draw(Graph& graph, ObjectPool& pool) {
        if (!choose_palette(graph)) return std::nullopt;
        if (!options_.steps) return draw_limit(graph, pool);
        if (!choose_way(graph)) return std::nullopt;
        if (in_run_) return draw_run(graph);
        std::optional<LsysDrawing> drawing = compose(graph, pool);
        if (drawing || !gave_up_) return drawing;
        try_run(options_.max_modules);
        return in_run_ ? draw_run(graph) : compose(graph, pool);
    }

    bool tell(Graph& graph, ObjectPool& pool, WordWitness& witness) {
        if (!choose_palette(graph)) return false;
        const bool composes = witness.sums() || grammar_.is_stochastic;
        if (!choose_way(graph, composes)) return false;
        if (in_run_ || !composes) return tell_run(graph, witness);
        if (!choose_width(graph)) return false;
        Composition composition(*this, graph, pool, draws_lines(grammar_), models_);
        composition.bodies.tell(witness);
        composition.composer.tell(witness);
        return composition.variant(0).has_value();
    }

  private:
    /// Derives the word, as it must be without `composes`, or chooses the parts. False after an error.
    bool choose_way(const Graph& graph, bool composes = true) {
        steps_ = *options_.steps;
        if (options_.exact) rewriter_.use_no_pool();
        return options_.exact || grammar_.needs_word || !composes ? derive() : choose_parts(graph);
    }

    bool choose_palette(Graph& graph) {
        std::optional<std::vector<Material>> palette = palette_of(grammar_, graph, diagnostics_);
        if (palette) palette_ = std::move(*palette);
        return palette.has_value();
    }

    /// How parts are looked up, and how many variants there are of each; false after an error.
    bool choose_parts(const Graph& graph) {
        if (grammar_.is_stochastic) variants_ = fewest_of(grammar_);
        const std::uint32_t fewest = variants_;
        const std::size_t sixteens = std::max(1u, variants_ / fewest_variants);
        const auto sized = [&](const Rounding& rounding) {
            return sixteens * (rounding.resizes ? most_resized_parts : most_sized_parts);
        };
        const auto exact = [](const Rounding&) { return most_exact_parts; };
        if (has_sizes_ && !choose_rounding(graph, sized)) return false;
        // Variants that differ in their directions too would be too many to judge.
        if (uses_directions_ && !choose_rounding(graph, exact)) return false;
        if (!choose_variants(graph)) return false;
        return !uses_directions_ || variants_ == fewest || choose_rounding(graph, exact);
    }

    /// One composer with all that it needs.
    struct Composition {
        Composition(Drawer& owner, Graph& graph, ObjectPool& pool, bool lines, ModelPlacer placer)
            : Composition(owner, graph, pool, lines, std::move(placer), owner.options_.max_parts,
                          owner.diagnostics_) {}
        Composition(Drawer& owner, Graph& graph, ObjectPool& pool, bool lines, ModelPlacer placer,
                    std::size_t max_parts, Diagnostics& diagnostics)
            : drawer(owner), models(std::move(placer)), bodies(graph, owner.palette_),
              turtle(owner.turtle_context(bodies, diagnostics, lines)),
              composer(owner.rewriter_, turtle, pool, models, Variants(owner.options_.seed, owner.variants_),
                       owner.limits(max_parts)) {}

        std::optional<TurtlePart> variant(std::uint32_t number) {
            TurtleState start = drawer.start();
            start.variant = number;
            const double share = drawer.options_.share;
            std::optional<TurtlePart> part =
                drawer.word_ ? composer.compose_word(*drawer.word_, drawer.steps_, start, share)
                             : composer.compose(drawer.steps_, start, share);
            drawer.gave_up_ = drawer.gave_up_ || composer.gave_up();
            return part;
        }

        Drawer& drawer;
        ModelPlacer models;
        TurtleBodies bodies;
        TurtleContext turtle;
        LsysComposer composer;
    };

    TurtleContext turtle_context(TurtleBodies& bodies, Diagnostics& diagnostics, bool lines) const {
        TurtleContext context = graftal::turtle_context(grammar_, bodies, diagnostics);
        context.lines = lines;
        context.taper = branch_taper(grammar_);
        return context;
    }

    LsysLimits limits(std::size_t max_parts) const {
        const Rounding& rounding = roundings_.front();
        return {.max_parts = max_parts,
                .snap_angle = rounding.snap_angle_deg * std::numbers::pi / 180,
                .give_up_from = max_parts > most_single_parts && may_run() ? most_single_parts : SIZE_MAX,
                .refuse_from = may_refuse_ ? most_parts_once_each : SIZE_MAX,
                .stop_from = options_.steps ? SIZE_MAX : most_parts_of_one_limit,
                .sizes = rounding.resizes ? &sizes_ : nullptr,
                .size_step = rounding.size_step,
                .steps_unit = !options_.has_other_models};
    }

    /// Whether a run, in place of what is composed, gives the same drawing.
    bool may_run() const {
        return may_give_up_ && options_.steps && !word_ && !grammar_.is_stochastic && !uses_directions_ &&
               LsysStream::can_derive(grammar_) && can_draw_run();
    }

    bool can_draw_run() const {
        return LsysStream::can_draw(grammar_) && palette_.size() < open_width && grammar_.skin == 0;
    }

    std::optional<LsysDrawing> compose(Graph& graph, ObjectPool& pool) {
        if (!choose_width(graph)) return std::nullopt;
        // A part without the limbs that go on into it is no line.
        Composition composition(*this, graph, pool, draws_lines(grammar_) && grammar_.skin == 0, models_);
        composition.turtle.skin = grammar_.skin;
        std::optional<TurtlePart> part = composition.variant(0);
        if (!part) return std::nullopt;
        return drawing_of(*part, word_ ? "derived" : "composed", composition.composer.part_count());
    }

    TurtleState start() const {
        TurtleState start = turtle_start(grammar_);
        start.width = width_;
        return start;
    }

    LsysDrawing drawing_of(TurtlePart& part, const char* way, std::size_t part_count) const {
        LsysDrawing drawing;
        drawing.instances = std::move(part.instances);
        drawing.limited_by_work = limited_by_work_;
        Derivation& derivation = drawing.derivation;
        derivation.way = way;
        derivation.steps = steps_;
        derivation.timed = grammar_.draws_in_time();
        derivation.time = steps_ + options_.share;
        derivation.modules = part.modules.str();
        derivation.segments = part.segments.str();
        derivation.parts = part_count;
        derivation.size_step = roundings_.front().size_step;
        derivation.variants = rewriter_.is_pooled() ? variants_ : 1;
        derivation.drift = drift_;
        derivation.error = part.error.farthest;
        return drawing;
    }

    /// Module by module, by one turtle.
    std::optional<LsysDrawing> draw_run(Graph& graph) {
        TurtleBodies bodies(graph, palette_, true);
        TurtleContext context = turtle_context(bodies, diagnostics_, draws_lines(grammar_));
        context.open_width = width_is_open_ && draws_lines(grammar_);
        context.tallies = width_is_open_;
        std::optional<TurtlePart> part = follow_word(context);
        if (!part) return std::nullopt;
        if (width_is_open_) {
            const double before = width_;
            set_width_for(*part);
            if (context.open_width)
                bodies.widen_packed(width_ / before);
            else if ((part->reads & reads_width) && width_ != before)
                return draw_run(graph); // '!' has mixed this width with others
        }
        variants_ = 1;
        roundings_ = {{}};
        LsysDrawing drawing = drawing_of(*part, "derived", 1);
        drawing.packed = bodies.take_packed();
        return drawing;
    }

    /// The width by which draw_lsys() draws it, where that composes it: the figure's reach is then a bound.
    void choose_width_as_composed(const Graph& graph) {
        Graph scratch = graph;
        Diagnostics quiet;
        Drawer other(grammar_, models_, options_, quiet);
        if (!other.choose_palette(scratch) || !other.choose_way(scratch) || other.in_run_) return;
        if (!other.choose_width(scratch)) return;
        width_ = other.width_;
        width_is_open_ = false;
    }

    /// Module by module, once more where the width depends on the figure.
    bool tell_run(Graph& graph, WordWitness& witness) {
        if (width_is_open_) choose_width_as_composed(graph);
        if (width_is_open_) {
            struct : WordWitness {
                bool begins(const Module&, const Turtle&) override { return true; }
            } deaf;
            const std::optional<TurtlePart> figure = tell_turtle(graph, deaf);
            if (!figure) return false;
            set_width_for(*figure);
        }
        return tell_turtle(graph, witness).has_value();
    }

    std::optional<TurtlePart> tell_turtle(Graph& graph, WordWitness& witness) {
        TurtleBodies bodies(graph, palette_);
        bodies.tell(witness);
        TurtleContext context = turtle_context(bodies, diagnostics_, draws_lines(grammar_));
        context.tallies = width_is_open_;
        return follow_word(context, &witness);
    }

    /// Has one turtle draw the word module by module. `witness`: null where nobody listens.
    std::optional<TurtlePart> follow_word(TurtleContext& context, WordWitness* witness = nullptr) {
        Turtle turtle(context, start());
        LsysStream stream(rewriter_, models_, diagnostics_, stream_options());
        if (witness) stream.tell(*witness);
        if (!(word_ ? stream.draw(*word_, turtle) : stream.derive(turtle))) return std::nullopt;
        TurtlePart part = std::move(turtle).finish();
        part.modules = stream.module_count();
        return part;
    }

    LsysStream::Options stream_options() const {
        return {steps_, options_.share, options_.seed, options_.max_modules};
    }

    /// From now on it is a run, if the word has no more modules than that; else it is composed after all.
    void try_run(std::uint64_t max_modules) {
        LsysStream::Options options = stream_options();
        options.max_modules = std::min<std::uint64_t>({options.max_modules, max_modules, max_packed_items});
        Diagnostics quiet;
        in_run_ = LsysStream(rewriter_, models_, quiet, options).count();
        may_give_up_ = false;
        may_refuse_ = few_serve_twice_ || gave_up_;
    }

    /// Models for graphs that are thrown away, where it does not matter which models stand in their places.
    static ModelPlacer stand_ins(Graph& scratch) {
        return [&scratch](SymbolId, std::span<const double>, Span) {
            return PlacedModel{scratch.primitive(PrimitiveKind::sphere), Vec3(1.0)};
        };
    }

    bool derive() {
        LsysQueries queries(rewriter_, diagnostics_, options_.seed);
        LsysStage stage;
        if (grammar_.has_queries())
            stage = [&](std::uint32_t step, ModuleString& word) { return queries.answer(step, word); };
        LsysDeriver deriver(rewriter_, diagnostics_, options_.seed, options_.max_modules);
        if (can_draw_run() && LsysStream::can_derive(grammar_))
            deriver.give_up_where_little_repeats(options_.run_from);
        deriver.after_each_step(std::move(stage));
        auto word = deriver.derive(steps_);
        in_run_ = deriver.gave_up();
        return in_run_ || take_word(std::move(word));
    }

    bool take_word(std::optional<ModuleString> word) {
        // Equal modules are drawn differently where chance draws them: all of them, or in one of the sets.
        const bool by_chance = grammar_.is_random(RuleKind::interpret);
        const bool all_differ = by_chance && !rewriter_.is_pooled();
        if (word) {
            const std::size_t length = word->size();
            word_.emplace(grammar_, rewriter_.modules(), std::move(*word));
            in_run_ = can_draw_run() && length >= options_.run_from &&
                      (all_differ || little_repeats(word_->size(), length));
        }
        if (by_chance) variants_ = all_differ ? enough_variants : draw_sets;
        return word_.has_value();
    }

    /// Longer derivations until their levels repeat.
    std::optional<LsysDrawing> draw_limit(Graph& graph, ObjectPool& pool) {
        if (!may_have_limit(grammar_, diagnostics_)) return std::nullopt;
        for (steps_ = first_limit_steps; steps_ <= last_limit_steps; steps_ *= 2) {
            Composition composition(*this, graph, pool, draws_lines(grammar_), models_);
            composition.turtle.limit = true;
            if (composition.turtle.lines) composition.turtle.taper = 1; // they are as thick as they are long
            const std::optional<TurtlePart> part = composition.variant(0);
            if (composition.composer.gave_up()) break;
            if (!part) return std::nullopt;
            const std::size_t errors = diagnostics_.error_count();
            std::optional<std::vector<Instance>> folded =
                fold_levels(part->instances, steps_, composition.composer.origins(), rewriter_, graph, pool,
                            diagnostics_);
            if (diagnostics_.error_count() > errors) return std::nullopt;
            if (!folded && composition.composer.part_count() > most_limit_parts) break;
            if (!folded) continue;
            const auto early = sketch(graph, steps_ / 2), late = sketch(graph, steps_ - steps_ / 4);
            const Affine limit_from_levels =
                early && late ? unit_limit(*part, early->reach, late->reach, grammar_.step) : Affine();
            for (Instance& instance : *folded)
                instance.parent_from_child = limit_from_levels * instance.parent_from_child;
            LsysDrawing drawing;
            drawing.instances = std::move(*folded);
            drawing.derivation.way = "folded";
            drawing.derivation.parts = composition.composer.part_count();
            return drawing;
        }
        diagnostics_
            .error(grammar_.source->steps->span,
                   fmt::format("graftal found no limit of 'lsys {}': its levels do not repeat",
                               grammar_.source->name.text))
            .with_hint(
                "the levels of a limit may differ only in size: all lengths and widths must change alike");
        return std::nullopt;
    }

    /// The part that would be drawn after so many steps, without adding it to the graph.
    std::optional<TurtlePart> sketch(const Graph& graph, unsigned steps) {
        Graph scratch = graph;
        ObjectPool pool(scratch);
        const unsigned before = std::exchange(steps_, steps);
        Composition composition(*this, scratch, pool, false, stand_ins(scratch));
        composition.turtle.tallies = true;
        composition.turtle.taper = 1; // only lengths matter
        std::optional<TurtlePart> part = composition.variant(0);
        steps_ = before;
        return part;
    }

    /// Composes a small pool, or what of it there is room for, and judges by its variance how many variants
    /// it takes. Errors come again when the model itself is composed, except those of productions: false.
    bool choose_variants(const Graph& graph) {
        if (!grammar_.is_stochastic) return true;
        Graph scratch = graph;
        ObjectPool pool(scratch);
        Diagnostics quiet;
        Composition composition(*this, scratch, pool, false, stand_ins(scratch), options_.max_parts, quiet);
        double sum = 0, squares = 0;
        int shift = 0;
        std::uint32_t judged = 0;
        for (; judged < variants_; ++judged) {
            const std::optional<TurtlePart> part = composition.variant(judged);
            if (!part) break;
            // The unit of counts is 2^shift, since they may be beyond doubles.
            const BigCount drawn = part->segments + part->bodies;
            if (judged == 0 && drawn > 0) shift = std::max(0, static_cast<int>(msb(drawn)) - 60);
            const double count = BigCount(drawn >> shift).convert_to<double>();
            sum += count;
            squares += count * count;
        }
        if (judged < variants_ && (judged < 2 || !composition.composer.too_many_parts()))
            return !rewriter_.failed();
        const double mean = sum / judged;
        // The relative variance of one whole model is at least that of one level, and no more than that of
        // all.
        const double variance = mean > 0 ? std::max(0.0, squares / judged / (mean * mean) - 1) : 0;
        const double wanted = variance * std::max(1u, steps_) / (most_drift * most_drift);
        const double parts = static_cast<double>(composition.composer.part_count()) / judged;
        const double room = 0.5 * static_cast<double>(options_.max_parts) / std::max(parts, 1.0);
        const auto doubled = [&](double most) {
            std::uint32_t variants = variants_;
            while (variants < wanted && 2 * variants <= std::min<double>(most, most_variants))
                variants *= 2;
            return variants;
        };
        const std::uint32_t without_limit = doubled(room);
        const double affordable = rewriter_.work_left() / (StagePrice::random_part * std::max(parts, 1.0));
        variants_ = doubled(std::min(room, affordable));
        if (variants_ < without_limit) report_few_variants(without_limit);
        drift_ = std::sqrt(variance * std::max(1u, steps_) / variants_);
        return true;
    }

    void report_few_variants(std::uint32_t without_limit) {
        limited_by_work_ = true;
        diagnostics_.note(
            grammar_.source->name.span,
            fmt::format("graftal makes {} variants of each random part in place of {}, since more "
                        "take more work than --work allows",
                        variants_, without_limit));
    }

    static std::uint32_t fewest_of(const LsysGrammar& grammar) {
        const bool draws =
            std::ranges::any_of(grammar.rules, [](const LsysRule& rule) { return rule.draws > 0; });
        return draws ? draw_sets : fewest_variants;
    }

    /// The first that keeps the parts few enough; those before are dropped. False after an error of the
    /// productions: others come again when the model itself is composed.
    template<typename Most> bool choose_rounding(const Graph& graph, const Most& most) {
        while (roundings_.size() > 1) {
            const std::size_t most_parts = std::min(options_.max_parts, most(roundings_.front()));
            Graph scratch = graph;
            ObjectPool pool(scratch);
            Diagnostics quiet;
            Composition composition(*this, scratch, pool, false, stand_ins(scratch), most_parts, quiet);
            if (composition.variant(0) || !composition.composer.too_many_parts()) break;
            few_serve_twice_ = few_serve_twice_ ||
                               (most_parts >= most_single_parts && composition.composer.few_serve_twice());
            roundings_.pop_front();
            if (roundings_.front().size_step == 0 || !may_run() || most_parts < most_resized_parts) continue;
            try_run(few_serve_twice_ ? options_.max_modules : most_modules_of_exact_runs);
            if (in_run_) break;
        }
        return !rewriter_.failed();
    }

    /// Composed once to see how large the figure is, and how long its segments are.
    bool choose_width(const Graph& graph) {
        if (!width_is_open_) return true;
        const std::optional<TurtlePart> figure = sketch(graph, steps_);
        if (!figure) return false;
        set_width_for(*figure);
        return true;
    }

    void set_width_for(const TurtlePart& figure) {
        width_is_open_ = false;
        if (!figure.lengths.empty()) width_ = width_for(grammar_, figure.lengths, figure.reach);
    }

    const LsysGrammar& grammar_;
    const ModelPlacer& models_;
    const LsysDrawOptions& options_;
    Diagnostics& diagnostics_;
    LsysRewriter rewriter_;
    LsysSizes sizes_;
    std::optional<FoldedWord> word_; ///< where it is derived
    bool may_give_up_ = true;        ///< composing
    bool may_refuse_ = false;        ///< for the same reason, since a run has too many modules
    bool gave_up_ = false;           ///< composing, for it shared too little
    bool few_serve_twice_ = false;   ///< of the parts, if they are all kept
    bool in_run_ = false;            ///< it is drawn module by module; without a word it is derived so too
    double width_;
    bool width_is_open_; ///< width_ is one to go on with
    bool has_sizes_, uses_directions_;
    std::deque<Rounding> roundings_; ///< left to try; the first is in use
    unsigned steps_ = 0;
    std::uint32_t variants_ = 1;
    double drift_ = 0;
    bool limited_by_work_ = false;  ///< the variants are fewer than the drift asks for
    std::vector<Material> palette_; ///< of the colour indices
};

} // namespace

std::optional<LsysDrawing> draw_lsys(const LsysGrammar& grammar, const ModelPlacer& models,
                                     const LsysDrawOptions& options, Graph& graph, ObjectPool& pool,
                                     Diagnostics& diagnostics) {
    return Drawer(grammar, models, options, diagnostics).draw(graph, pool);
}

bool tell_lsys(const LsysGrammar& grammar, const ModelPlacer& models, const LsysDrawOptions& options,
               Graph& graph, ObjectPool& pool, Diagnostics& diagnostics, WordWitness& witness) {
    return Drawer(grammar, models, options, diagnostics).tell(graph, pool, witness);
}

} // namespace graftal
