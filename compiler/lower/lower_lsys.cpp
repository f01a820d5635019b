#include "compiler/lower/lower_lsys.h"

#include <algorithm>
#include <deque>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lowering.h"
#include "compiler/lower/lsys_drawing.h"
#include "compiler/lower/lsys_grammar.h"
#include "compiler/syntax/lsys_parser.h"

namespace graftal {

namespace {

/// They are composed by recursion.
constexpr unsigned max_block_nesting = 256;

class LsysLowering {
  public:
    LsysLowering(FileId file, Lowering& lowering)
        : file_(file), errors_before_(lowering.diagnostics.error_count()), lowering_(lowering),
          diagnostics_(lowering.diagnostics), tree_(parse_lsys(lowering.sources, file, lowering.diagnostics)),
          pool_(graph_) {}

    /// All checks run, whatever has failed before, so that one run reports all of a file's errors.
    std::optional<Graph> run() && {
        if (tree_.blocks.empty() && !failed())
            diagnostics_.error({file_, 0, 0}, "this file has no 'lsys' block")
                .with_hint("lsys NAME { axiom F  F -> F[+F]F }, each statement on its line");
        lets_ = evaluate_lets(tree_.statements, {}, lowering_);
        lower_settings(tree_.statements, lets_, graph_, lowering_);
        import_models();
        build_grammars();
        if (failed()) return std::nullopt;
        const std::optional<ObjectId> root = root_of(main_block(), Span());
        if (!root || failed()) return std::nullopt;
        graph_.root = *root;
        graph_.settings.steps.reset(); // spent on the derivation
        return std::move(graph_);
    }

  private:
    struct Block {
        const LsysBlock* source = nullptr;
        std::optional<LsysGrammar> grammar;
        std::optional<ObjectId> root; ///< once it is composed
        bool under_way = false;
    };

    bool failed() const { return diagnostics_.error_count() > errors_before_; }

    void import_models() {
        for (const LsysUse& use : tree_.uses) {
            if (diagnostics_.full()) return;
            const auto [first, fresh] = uses_.try_emplace(use.name.text, Use{use.name.span, std::nullopt});
            if (!fresh)
                diagnostics_.error(use.name.span, fmt::format("duplicate use '{}'", use.name.text))
                    .with_note(first->second.span, "first defined here");
            else if (use.name.text.find('.') != std::string_view::npos)
                diagnostics_.error(
                    use.name.span,
                    fmt::format("the name '{}' of a used model must not have a '.'", use.name.text));
            else
                first->second.root = import_model(graph_, use.path_span, use.name.text, use.path, lowering_);
        }
    }

    /// Also checks the names of blocks and of `--set`.
    void build_grammars() {
        Environment all_lets = lets_;
        const LsysBlock* main = nullptr;
        for (const LsysBlock& block : tree_.blocks) {
            if (diagnostics_.full()) return;
            if (main && block.is_main)
                diagnostics_.error(block.name.span, "a second 'main' block")
                    .with_note(main->name.span, "the first is here");
            if (block.is_main) main = &block;
            Block& added = blocks_.emplace_back();
            added.source = &block;
            check_name(block);
            Environment lets = evaluate_lets(block.lets, lets_, lowering_);
            all_lets.insert(lets.begin(), lets.end());
            added.grammar = build_grammar(block, std::move(lets), diagnostics_);
        }
        if (lowering_.at_root_model()) check_set_names(all_lets, lowering_);
    }

    void check_name(const LsysBlock& block) {
        const auto [first, fresh] = names_.try_emplace(block.name.text, block.name.span);
        const auto use = uses_.find(block.name.text);
        if (!fresh)
            diagnostics_.error(block.name.span, fmt::format("duplicate block '{}'", block.name.text))
                .with_note(first->second, "first defined here");
        else if (use != uses_.end())
            diagnostics_.error(block.name.span, fmt::format("'{}' is a used model already", block.name.text))
                .with_note(use->second.span, "first defined here");
        else if (primitive_named(block.name.text))
            diagnostics_.error(block.name.span,
                               fmt::format("'{}' is a primitive and cannot name a block", block.name.text));
    }

    Block& main_block() {
        const auto main = std::ranges::find_if(blocks_, [](const Block& b) { return b.source->is_main; });
        return main == blocks_.end() ? blocks_.back() : *main;
    }

    /// Composes a block on first use. `use`: of `~NAME`; unknown for the main block.
    std::optional<ObjectId> root_of(Block& block, Span use) {
        if (block.root) return block.root;
        const std::string_view name = block.source->name.text;
        if (block.under_way) {
            diagnostics_.error(use, fmt::format("'{}' would place itself", name))
                .with_hint("a model inside itself is what productions are for");
            return std::nullopt;
        }
        if (nesting_ == max_block_nesting) {
            diagnostics_.error(use,
                               fmt::format("blocks place each other more than {} deep", max_block_nesting));
            return std::nullopt;
        }
        block.under_way = true;
        ++nesting_;
        const std::optional<std::map<SymbolId, ObjectId>> models = models_of(*block.grammar);
        std::optional<unsigned> steps;
        if (find_steps(block, steps) && models) block.root = draw(block, *models, steps);
        --nesting_;
        block.under_way = false;
        return block.root;
    }

    std::optional<std::map<SymbolId, ObjectId>> models_of(const LsysGrammar& grammar) {
        std::map<SymbolId, ObjectId> models;
        bool good = true;
        for (SymbolId id = 0; id < grammar.symbols.size(); ++id) {
            if (!grammar.symbols[id].starts_with('~')) continue;
            const std::string_view name = std::string_view(grammar.symbols[id]).substr(1);
            const std::optional<ObjectId> root = model_named(name, grammar.first_uses[id]);
            if (root)
                models.emplace(id, *root);
            else
                good = false;
        }
        if (!good) return std::nullopt;
        return models;
    }

    std::optional<ObjectId> model_named(std::string_view name, Span span) {
        if (const auto kind = primitive_named(name)) return graph_.primitive(*kind);
        if (const auto use = uses_.find(name); use != uses_.end()) return use->second.root;
        for (Block& block : blocks_)
            if (block.source->name.text == name) return root_of(block, span);
        std::vector<std::string> known;
        for (const auto& [used, use] : uses_)
            known.emplace_back(used);
        for (const auto& [block, place] : names_)
            known.emplace_back(block);
        for (int kind = 0; kind < primitive_kind_count; ++kind)
            known.emplace_back(name_of(static_cast<PrimitiveKind>(kind)));
        const std::string hint = did_you_mean(name, known);
        diagnostics_.error(span, fmt::format("'~{}' names no used model and no block of this file", name))
            .with_hint(hint.empty()
                           ? fmt::format("use {} = \"FILE\" at the top of the file makes it one", name)
                           : hint);
        return std::nullopt;
    }

    bool is_root(const Block& block) { return lowering_.at_root_model() && &block == &main_block(); }

    /// False after an error; no steps are infinitely many.
    bool find_steps(const Block& block, std::optional<unsigned>& steps) {
        Span span = block.source->steps ? block.source->steps->span : block.source->name.span;
        steps = block.grammar->steps;
        if (is_root(block) && lowering_.options.steps) {
            steps = lowering_.options.steps;
            span = Span();
        } else if (block.grammar->infinite) {
            return true;
        }
        if (!steps) steps = graph_.settings.steps;
        if (!steps)
            diagnostics_
                .error(span, fmt::format("'lsys {}' does not say how many steps to derive",
                                         block.source->name.text))
                .with_hint(is_root(block) ? "add 'steps 5' to it, or '--steps 5' to the command"
                                          : "add 'steps 5' to it");
        else if (*steps > max_derivation_steps)
            diagnostics_.error(span, fmt::format("a derivation has at most {} steps", max_derivation_steps));
        return steps && *steps <= max_derivation_steps;
    }

    std::optional<ObjectId> draw(const Block& block, const std::map<SymbolId, ObjectId>& models,
                                 std::optional<unsigned> steps) {
        const LsysBlock& source = *block.source;
        const LowerOptions& options = lowering_.options;
        const std::uint64_t seed =
            lowering_.at_root_model() && options.seed ? *options.seed : block.grammar->seed;
        std::optional<LsysDrawing> drawing = draw_lsys(
            *block.grammar, models, {steps, seed, options.exact, options.max_modules, options.max_objects},
            graph_, pool_, diagnostics_);
        if (!drawing) return std::nullopt;
        if (drawing->instances.empty()) {
            diagnostics_.error(source.name.span, fmt::format("'lsys {}' draws nothing{}", source.name.text,
                                                             steps ? fmt::format(" after {} step{}", *steps,
                                                                                 *steps == 1 ? "" : "s")
                                                                   : std::string()));
            return std::nullopt;
        }
        if (is_root(block)) lowering_.derivation = std::move(drawing->derivation);
        return add_root(source, std::move(drawing->instances));
    }

    std::optional<ObjectId> add_root(const LsysBlock& block, std::vector<Instance> instances) {
        Object root;
        root.name = pool_.unique_name(block.name.text);
        root.instances = std::move(instances);
        root.span = block.name.span;
        const ObjectId id = graph_.add(std::move(root));
        if (!within_limits(graph_.objects.size(), instance_count(graph_), block.name.span, lowering_))
            return std::nullopt;
        return id;
    }

    struct Use {
        Span span;
        std::optional<ObjectId> root; ///< nothing after an error
    };

    FileId file_;
    std::size_t errors_before_;
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    LsysFile tree_;
    Environment lets_; ///< of the file
    Graph graph_;
    ObjectPool pool_;
    std::deque<Block> blocks_;
    unsigned nesting_ = 0; ///< blocks under way
    std::map<std::string_view, Use> uses_;
    std::map<std::string_view, Span> names_; ///< of the blocks
};

} // namespace

std::optional<Graph> lower_lsys(FileId file, Lowering& lowering) {
    return LsysLowering(file, lowering).run();
}

} // namespace graftal
