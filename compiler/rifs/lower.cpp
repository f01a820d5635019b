#include "compiler/rifs/lower.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/graph/components.h"
#include "compiler/graph/path.h"
#include "compiler/lower/inner_parameters.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/lower/lowering.h"
#include "compiler/lower/model_family.h"
#include "compiler/lower/primitive_objects.h"
#include "compiler/primitives/primitive.h"
#include "compiler/rifs/chances.h"
#include "compiler/rifs/lower_orbit.h"
#include "compiler/rifs/system.h"
#include "compiler/support/number_range.h"
#include "compiler/syntax/everyday_words.h"

namespace graftal {

namespace {

/// A condensation or terminal, looked up and evaluated.
struct Part {
    ObjectId master = 0;
    Affine parent_from_child;
    Tint tint;
    std::optional<MaterialId> material;
    Span span;
    std::optional<double> probability; ///< stated
    double terminal_px = 0;            ///< of a terminal
};

/// Two tints of one path as one; one alone keeps its bits.
Tint composed(const Tint& parent, const Tint& child) {
    if (parent.alpha == 0) return child;
    if (child.alpha == 0) return parent;
    return straight(PathTint(parent) * PathTint(child));
}

class RifsLowering {
  public:
    RifsLowering(const RifsFile& tree, Lowering& lowering)
        : tree_(tree), lowering_(lowering), diagnostics_(lowering.diagnostics) {}

    /// All checks run, whatever has failed before, so that one run reports all of a file's errors.
    std::optional<Graph> run() && {
        if (!tree_.orbits.empty()) {
            lower_orbit_file(tree_, lowering_);
            return std::nullopt;
        }
        if (tree_.blocks.empty() && !failed())
            diagnostics_.error({tree_.file, 0, 0}, "this file has no 'rifs' block")
                .with_hint("write one, such as 'rifs dust { map a { scale: 1/3 } map b { scale: 1/3  "
                           "translate: 2/3, 0, 0 } }'");
        lets_ = lower_lets(tree_.statements, lowering_);
        inner_parameters(tree_.statements, lets_, diagnostics_); // for its checks
        lower_settings(tree_.statements, lets_, graph_, lowering_);
        import_models();
        RifsLooks looks(lets_, graph_.materials, diagnostics_);
        system_ = evaluate_rifs(tree_, lets_, looks, diagnostics_);
        check_block_names();
        lower_parts(looks);
        if (!resolve_digraphs(system_, lets_, lowering_) || failed()) return std::nullopt;
        mark_empty(system_, diagnostics_);
        if (!failed()) add_objects();
        if (failed()) return std::nullopt;
        return std::move(graph_);
    }

  private:
    struct Use {
        Span span;
        std::optional<ObjectId> root;      ///< nothing after an error
        std::optional<ModelFamily> family; ///< if it has inner parameters
    };

    bool failed() const { return lowering_.file_failed(); }

    void import_models() {
        for (const UseStatement& use : tree_.uses) {
            if (diagnostics_.full()) return;
            const auto [first, fresh] =
                uses_.try_emplace(use.name.text, Use{use.name.span, std::nullopt, std::nullopt});
            if (!fresh) {
                diagnostics_.error(use.name.span, fmt::format("duplicate use '{}'", use.name.text))
                    .with_note(first->second.span, "first defined here");
            } else if (is_reserved_name(use.name.text)) {
                diagnostics_.error(
                    use.name.span,
                    fmt::format("'{}' is a primitive and cannot name a used model", use.name.text));
            } else if (use.name.text.find('.') != std::string_view::npos) {
                diagnostics_.error(
                    use.name.span,
                    fmt::format("the name '{}' of a used model must not have a '.'", use.name.text));
            } else {
                const std::optional<FileId> file = read_model(use, lowering_);
                if (!file) continue;
                first->second.root = import_model(graph_, use, lowering_);
                if (first->second.root) add_family(first->second, use, *file);
            }
        }
    }

    void add_family(Use& use, const UseStatement& source, FileId file) {
        std::vector<InnerParameter> parameters = inner_parameters_of(file, lowering_);
        if (parameters.empty()) return;
        const auto make = [this, &source, parameters](const std::vector<double>& values) {
            return import_member(graph_, source, named_values(parameters, values), lowering_);
        };
        use.family.emplace(std::string(source.name.text), std::move(parameters), make);
    }

    /// Objects of blocks and of used models are told apart by these names.
    void check_block_names() {
        for (const RifsBlock& block : tree_.blocks)
            if (const auto use = uses_.find(block.name.text); use != uses_.end())
                diagnostics_
                    .error(block.name.span,
                           fmt::format("'{}' is already the name of a used model", block.name.text))
                    .with_note(use->second.span, "first defined here");
    }

    void lower_parts(RifsLooks& looks) {
        std::vector<const RifsPart*> parts;
        std::set<const RifsPart*> terminals; // looked up only
        const auto add_terminal = [&](const std::optional<RifsPart>& terminal) {
            if (terminal) terminals.insert(parts.emplace_back(&*terminal));
        };
        for (const RifsBlock& block : tree_.blocks) {
            for (const RifsPart& part : block.condense)
                parts.push_back(&part);
            for (const RifsMap& map : block.maps)
                add_terminal(map.terminal);
            add_terminal(block.terminal);
        }
        std::sort(parts.begin(), parts.end(), [](const RifsPart* a, const RifsPart* b) {
            return a->span.begin < b->span.begin; // in the order of the text
        });
        for (const RifsPart* part : parts)
            if (!diagnostics_.full()) lower_part(*part, looks);
        const Components components = strong_components(graph_);
        for (const RifsPart* part : parts)
            if (terminals.contains(part)) check_terminal(*part, components);
    }

    void lower_part(const RifsPart& part, RifsLooks& looks) {
        const std::optional<ObjectId> master = find_master(part);
        const std::optional<Affine> placed = lower_transforms(part.transforms, lets_, diagnostics_);
        const Tint tint = looks.tint(part.look);
        const std::optional<MaterialId> material = looks.material(part.look);
        // Reported with those of the maps if it is wrong.
        Diagnostics ignored;
        const std::optional<double> p = evaluate_probability(part.probability, lets_, ignored);
        const std::optional<double> px = part.below ? lower_size_px(*part.below, lets_, diagnostics_) : 0.0;
        if (master && placed && px)
            parts_.emplace(&part, Part{*master, *placed, tint, material, part.span, p, *px});
    }

    std::optional<ObjectId> find_master(const RifsPart& part) {
        const std::string_view name = part.master.text;
        const std::optional<Primitive> primitive = primitive_named(name);
        const auto use = uses_.find(name);
        ModelFamily* const family = use != uses_.end() && use->second.family ? &*use->second.family : nullptr;
        const std::optional<PrimitiveKind> kind = kind_of_numbers(name);
        const bool of_numbers = kind && use == uses_.end(); // else the used model hides it
        if (!primitive && !of_numbers && use == uses_.end()) return unknown_master(part.master);
        std::vector<double> arguments;
        for (const Expression& expression : part.arguments)
            if (const auto value = evaluate(expression, lets_, diagnostics_)) arguments.push_back(*value);
        if (arguments.size() < part.arguments.size()) return std::nullopt;
        if (of_numbers && !takes_count(*kind, arguments.size()))
            return wrong_count(part, counts_taken(*kind));
        const std::size_t most = family ? family->parameters().size() : 0;
        if (!of_numbers && arguments.size() > most)
            return wrong_count(part, fmt::format("{} argument{}", most, most == 1 ? "" : "s"));
        if (primitive) return primitives_.of(*primitive);
        if (family && !arguments.empty()) return family->exact(arguments, part.master.span, diagnostics_);
        if (!of_numbers) return use->second.root;
        const std::optional<Primitive> made =
            lower_primitive(*kind, arguments, part.master.span, diagnostics_);
        return made ? std::optional(primitives_.of(*made)) : std::nullopt;
    }

    std::nullopt_t unknown_master(const Name& name) {
        std::vector<std::string> known;
        for (const bool plain : {false, true})
            for (const PrimitiveKind kind : all_primitive_kinds)
                if (plain ? form_of(kind) == PrimitiveForm::plain : traits_of(kind).make != nullptr)
                    known.emplace_back(name_of(kind));
        for (const auto& [used, use] : uses_)
            known.emplace_back(used);
        const std::string shape = shape_word_hint(name.text);
        diagnostics_.error(name.span, fmt::format("'{}' is neither a primitive nor a used model", name.text))
            .with_hint((shape.empty() ? choices(name.text, known) : shape) +
                       "; write 'use NAME = \"FILE\"' to load a model");
        return std::nullopt;
    }

    std::nullopt_t wrong_count(const RifsPart& part, const std::string& takes) {
        diagnostics_.error(part.master.span, fmt::format("'{}' takes {}, not {}", part.master.text, takes,
                                                         part.arguments.size()));
        return std::nullopt;
    }

    /// Once a part; check_graph() would report it for each object that has it.
    void check_terminal(const RifsPart& part, const Components& components) {
        const auto lowered = parts_.find(&part);
        if (lowered == parts_.end() || !components.unending[lowered->second.master]) return;
        diagnostics_
            .error(part.master.span, fmt::format("the terminal '{}' recurs without end", part.master.text))
            .with_hint("graftal draws a terminal where it cuts recursion; only 'condense' may be recursive");
    }

    void add_objects() {
        chances_ = rifs_chances(system_, condensation_shares());
        const bool qualified = tree_.blocks.size() > 1 || names_collide();
        std::vector<ObjectId> ids(system_.nodes.size());
        auto next = static_cast<ObjectId>(graph_.objects.size());
        for (std::uint32_t i = 0; i < system_.nodes.size(); ++i)
            if (!system_.nodes[i].empty) ids[i] = next++;
        for (const RifsNode& node : system_.nodes) {
            lowering_.meter.add();
            if (node.empty) continue;
            const std::string_view block = system_.blocks[node.block].source->name.text;
            add_node(node, qualified ? fmt::format("{}.{}", block, node.name) : node.name, ids);
        }
        add_root(ids);
    }

    /// The probabilities of the condensation sets, block by block, as far as they are stated.
    std::vector<std::vector<std::optional<double>>> condensation_shares() const {
        std::vector<std::vector<std::optional<double>>> shares;
        for (const RifsBlock& block : tree_.blocks) {
            shares.emplace_back();
            for (const RifsPart& part : block.condense)
                shares.back().push_back(parts_.at(&part).probability);
        }
        return shares;
    }

    bool names_collide() const {
        return std::any_of(system_.nodes.begin(), system_.nodes.end(), [&](const RifsNode& node) {
            return node.name == system_.blocks[node.block].source->name.text;
        });
    }

    /// None where it is smaller than a chance may be: no random number stands for it.
    static double stated_chance(double chance) { return is_size(chance) ? chance : 0; }

    /// A_j = w_j(C u U A_i): the condensation sets of the block that w_j is applied to, then the masters.
    void add_node(const RifsNode& node, std::string name, const std::vector<ObjectId>& ids) {
        Object object;
        object.name = std::move(name);
        object.span = node.source->name.span;
        const RifsBlock& under = *system_.blocks[system_.block_under(node)].source;
        const RifsChances::OfNode chances = chances_ ? chances_->of(system_, node) : RifsChances::OfNode();
        const auto at = [](const std::vector<double>& list, std::size_t i) {
            return list.empty() ? 0 : stated_chance(list[i]);
        };
        for (std::size_t i = 0; i < under.condense.size(); ++i) {
            object.instances.push_back(placed(parts_.at(&under.condense[i]), &node));
            object.instances.back().chance = at(chances.condensations, i);
        }
        for (std::size_t i = 0; i < node.masters.size(); ++i) {
            if (system_.nodes[node.masters[i]].empty) continue;
            object.instances.push_back(
                {ids[node.masters[i]], node.map, node.tint, node.material, node.source->name.span});
            object.instances.back().chance = at(chances.masters, i);
        }
        const std::optional<RifsPart>& terminal =
            node.source->terminal ? node.source->terminal : under.terminal;
        if (terminal) set_terminal(object, *terminal, &node);
        graph_.add(std::move(object));
    }

    void add_root(const std::vector<ObjectId>& ids) {
        const RifsSubsystem& main = system_.blocks[system_.main];
        Object root;
        root.name = main.source->name.text;
        root.span = main.source->name.span;
        for (std::size_t i = 0; i < main.source->condense.size(); ++i) {
            root.instances.push_back(placed(parts_.at(&main.source->condense[i]), nullptr));
            if (chances_)
                root.instances.back().chance = stated_chance(chances_->condensation(system_.main, i));
        }
        for (const std::uint32_t start : main.start) {
            if (system_.nodes[start].empty) continue;
            root.instances.push_back(
                {ids[start], Affine(), Tint(), std::nullopt, system_.nodes[start].source->name.span});
            if (chances_) root.instances.back().chance = stated_chance(chances_->share[start]);
        }
        if (main.source->terminal) set_terminal(root, *main.source->terminal, nullptr);
        graph_.root = graph_.add(std::move(root));
    }

    void set_terminal(Object& object, const RifsPart& terminal, const RifsNode* node) {
        const Part& part = parts_.at(&terminal);
        object.terminal = placed(part, node);
        object.terminal_px = part.terminal_px;
    }

    /// A part under the map of `node`, or as it is.
    Instance placed(const Part& part, const RifsNode* node) {
        if (!node) return {part.master, part.parent_from_child, part.tint, part.material, part.span};
        const Affine map = node->map * part.parent_from_child;
        const bool vanishes = map.linear == Mat3(0.0);
        if (const std::string fault = range_fault(map); !fault.empty())
            diagnostics_
                .error(part.span,
                       fmt::format("under map '{}' this {}", node->name, vanishes ? "vanishes" : fault))
                .with_note(node->source->name.span, "the map is here");
        return {part.master, map, composed(node->tint, part.tint),
                part.material ? part.material : node->material, part.span};
    }

    const RifsFile& tree_;
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    Environment lets_;
    Graph graph_;
    RifsSystem system_;
    std::optional<RifsChances> chances_; ///< nothing: none are stated
    std::map<std::string_view, Use> uses_;
    std::map<const RifsPart*, Part> parts_; // looked up only, never walked
    PrimitiveObjects primitives_{graph_};
};

} // namespace

std::optional<Graph> lower_rifs(const RifsFile& tree, Lowering& lowering) {
    return RifsLowering(tree, lowering).run();
}

} // namespace graftal
