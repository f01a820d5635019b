#include "compiler/inst/lower_inst.h"

#include <algorithm>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/inst/inst_index.h"
#include "compiler/inst/lower_scatter.h"
#include "compiler/lower/inner_parameters.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/lower/model_family.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

/// Words of definitions that are evaluated over all enumerated objects: some seconds of work.
constexpr std::size_t max_work = 30'000'000;

/// Names that are compared with misspelt ones.
constexpr std::size_t max_suggestion_work = 100'000;

/// How the instances of one group are placed.
struct Placement {
    Affine parent_from_child;
    Tint tint;
    std::optional<MaterialId> material;
};

/// An object of the file and how it was first reached.
struct Reached {
    ObjectId id = 0;
    const InstDefinition* definition = nullptr;
    std::vector<double> arguments;
    Span use;               ///< the reference that reached it; unknown where nothing did
    std::size_t parent = 0; ///< index of the object that holds the reference; its own where nothing did
};

/// `f(0) -> f(1) -> f(2) -> ... -> f(99999) -> f(100000)`
std::string abridged_chain(const std::vector<std::string_view>& names) {
    constexpr std::size_t head = 4, tail = 2;
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += " -> ";
        if (i == head && names.size() > head + tail + 1) {
            text += "...";
            i = names.size() - tail - 1;
            continue;
        }
        text += names[i];
    }
    return text;
}

class InstLowerer {
  public:
    InstLowerer(const InstModule& module, Lowering& lowering)
        : module_(module), lowering_(lowering), diagnostics_(lowering.diagnostics),
          index_(module_, diagnostics_) {}

    std::optional<Graph> run() && {
        lets_ = lower_lets(module_.scene, lowering_);
        inner_parameters(module_.scene, lets_, diagnostics_); // for its checks
        lower_settings(module_.scene, lets_, graph_, lowering_);
        for (MaterialId id = 0; id < graph_.materials.size(); ++id)
            materials_.emplace(graph_.materials[id].name, id);
        for (const UseStatement& use : module_.uses)
            import_used(use);
        for (const InstDefinition& definition : module_.definitions)
            if (!diagnostics_.full()) check_names(definition);
        enumerate();
        choose_root();
        if (failed()) return std::nullopt;
        return std::move(graph_);
    }

  private:
    bool failed() const { return lowering_.file_failed(); }

    // Names

    void import_used(const UseStatement& use) {
        const auto [first, fresh] = uses_.emplace(use.name.text, use.name.span);
        if (!fresh) {
            diagnostics_.error(use.name.span, fmt::format("duplicate object '{}'", use.name.text))
                .with_note(first->second, "first defined here");
            return;
        }
        if (is_reserved_name(use.name.text) || use.name.text.find('.') != std::string::npos) {
            diagnostics_.error(use.name.span, fmt::format("'{}' cannot name a model", use.name.text))
                .with_hint("use a name without dots that is not a primitive's");
            return;
        }
        const std::size_t known = graph_.objects.size();
        const std::optional<FileId> file = read_model(use, lowering_);
        if (!file) return;
        const std::optional<ObjectId> root = import_model(graph_, use, lowering_);
        if (!root) return;
        add_family(use, *file);
        by_name_[std::string(use.name.text)] = *root;
        for (std::size_t id = known; id < graph_.objects.size(); ++id) {
            by_name_[graph_.objects[id].name] = static_cast<ObjectId>(id);
            instance_count_ += graph_.objects[id].instances.size();
        }
    }

    void add_family(const UseStatement& use, FileId file) {
        std::vector<InnerParameter> parameters = inner_parameters_of(file, lowering_);
        if (parameters.empty()) return;
        const auto make = [this, &use, parameters](const std::vector<double>& values) {
            const std::size_t known = graph_.objects.size();
            const std::optional<ObjectId> root =
                import_member(graph_, use, named_values(parameters, values), lowering_);
            for (std::size_t id = known; id < graph_.objects.size(); ++id)
                instance_count_ += graph_.objects[id].instances.size();
            return root;
        };
        const std::string name(use.name.text);
        families_.emplace(name, ModelFamily(name, std::move(parameters), make));
    }

    /// How many arguments a used model takes at most.
    std::size_t inner_count(std::string_view name) const {
        const auto family = families_.find(name);
        return family == families_.end() ? 0 : family->second.parameters().size();
    }

    /// The used model that a name stands for or lies in; null for the file's own names.
    const std::pair<const std::string, Span>* use_of(std::string_view name) const {
        const auto use = uses_.find(name.substr(0, name.find('.')));
        return use == uses_.end() ? nullptr : &*use;
    }

    void check_names(const InstDefinition& definition) {
        if (const auto* use = use_of(definition.name); use && use->first == definition.name)
            diagnostics_.error(definition.span, fmt::format("duplicate object '{}'", definition.name))
                .with_note(use->second, "first defined here");
        else if (use)
            diagnostics_
                .error(definition.span,
                       fmt::format("'{}' belongs to the model used as '{}'", definition.name, use->first))
                .with_note(use->second, "used here");
        for (const InstGroup& group : definition.groups) {
            for (const InstReference& reference : group.masters)
                if (!check_reference(reference)) unknown_.insert(&reference);
            if (group.material && !materials_.contains(*group.material))
                material_named(*group.material, group.material_span, graph_, diagnostics_);
        }
    }

    /// Reports and gives false if nothing of this name, or not with as many arguments, can exist.
    bool check_reference(const InstReference& reference) {
        const std::size_t arity = reference.arguments.size();
        const InstDefinition* definition = index_.any(reference.name);
        if (!reference.path.empty()) return check_mesh(reference);
        if (index_.defined(reference.name, arity)) return true;
        const std::optional<PrimitiveKind> kind = kind_of(reference);
        if (kind && takes_count(*kind, arity)) return true;
        if (definition) {
            wrong_count(reference, definition->parameters.size()).with_note(definition->span, "defined here");
            return false;
        }
        if (kind) {
            wrong_count(reference, counts_taken(*kind));
            return false;
        }
        if (reference.name == name_of(PrimitiveKind::mesh) && !uses_.contains(reference.name))
            return check_mesh(reference);
        const bool whole = primitive_named(reference.name) || uses_.contains(reference.name);
        if (whole && arity > inner_count(reference.name)) {
            wrong_count(reference, inner_count(reference.name));
            return false;
        }
        // A part of a used model is looked up once its arguments are known.
        if (whole || use_of(reference.name)) return true;
        if (module_.complete) unknown_object(reference.span, reference.name);
        return false;
    }

    /// The kind of a primitive that numbers make. The model's own objects of as many arguments hide it, and
    /// used models do.
    std::optional<PrimitiveKind> kind_of(const InstReference& reference) const {
        const bool hidden =
            uses_.contains(reference.name) || index_.defined(reference.name, reference.arguments.size());
        return hidden ? std::nullopt : kind_of_numbers(reference.name);
    }

    /// `mesh "leaf.obj"`: read here, once for each file.
    bool check_mesh(const InstReference& reference) {
        if (reference.path.empty() || reference.name != name_of(PrimitiveKind::mesh)) {
            diagnostics_
                .error(reference.span, reference.path.empty()
                                           ? "'mesh' takes the name of a file"
                                           : fmt::format("'{}' takes no name of a file", reference.name))
                .with_hint("a mesh is written 'mesh \"leaf.obj\"'");
            return false;
        }
        const std::optional<Primitive> mesh = load_mesh(reference.path_span, reference.path, lowering_);
        if (mesh) meshes_.emplace(&reference, *mesh);
        return mesh.has_value();
    }

    Diagnostic& wrong_count(const InstReference& reference, std::size_t arity) {
        return wrong_count(reference, arity == 0
                                          ? std::string("no arguments")
                                          : fmt::format("{} argument{}", arity, arity == 1 ? "" : "s"));
    }

    Diagnostic& wrong_count(const InstReference& reference, const std::string& takes) {
        return diagnostics_.error(reference.span, fmt::format("'{}' takes {}, not {}", reference.name, takes,
                                                              reference.arguments.size()));
    }

    void unknown_object(Span span, std::string_view name) {
        Diagnostic& error = diagnostics_.error(span, fmt::format("unknown object '{}'", name));
        suggestion_work_ += module_.definitions.size() + by_name_.size();
        if (suggestion_work_ > max_suggestion_work) return;
        std::vector<std::string> known = index_.names();
        std::vector<std::string> primitives;
        for (const PrimitiveKind kind : all_primitive_kinds)
            primitives.emplace_back(name_of(kind));
        known.insert(known.end(), primitives.begin(), primitives.end());
        for (const auto& [use, place] : uses_)
            known.push_back(use);
        for (const auto& [object, id] : by_name_)
            known.push_back(object);
        std::sort(known.begin(), known.end());
        known.erase(std::unique(known.begin(), known.end()), known.end());
        const std::string hint = choices(name, known);
        error.with_hint(hint.empty() ? fmt::format("the primitives are {}", fmt::join(primitives, ", "))
                                     : hint);
    }

    // Enumeration

    /// The rendered objects and the plain canonical ones, in the order of the text, then what they reach,
    /// breadth first.
    void enumerate() {
        for (const InstDefinition& definition : module_.definitions)
            if (definition.rendered || index_.always_exists(definition)) call_for(definition);
        for (std::size_t i = 0; i < reached_.size() && !stopped_ && !diagnostics_.full(); ++i)
            lower_object(i);
    }

    void call_for(const InstDefinition& definition) {
        std::vector<double> arguments;
        for (const InstParameter& parameter : definition.parameters)
            arguments.push_back(parameter.number);
        const std::string name = inst_object_name(definition.name, arguments);
        if (index_.match(definition.name, arguments, name) != &definition) return; // a duplicate
        if (stopped_ || by_name_.contains(name)) return;
        add_object(definition, std::move(arguments), name, Span(), reached_.size());
    }

    std::optional<ObjectId> add_object(const InstDefinition& definition, std::vector<double> arguments,
                                       const std::string& name, Span use, std::size_t parent) {
        const bool enumerated = !index_.always_exists(definition);
        const std::size_t most = lowering_.options.max_objects;
        if (graph_.objects.size() >= most)
            return stop(use, definition, parent, name,
                        fmt::format("the model has more than {} objects", most));
        if (enumerated && ++tuples_[&definition] > max_argument_tuples)
            return stop(use, definition, parent, name,
                        fmt::format("the model uses object '{}' with more than {} different arguments",
                                    definition.name, max_argument_tuples));
        Object object;
        object.name = name;
        object.span = definition.span;
        const ObjectId id = graph_.add(std::move(object));
        by_name_.emplace(name, id);
        reached_.push_back({id, &definition, std::move(arguments), use, parent});
        return id;
    }

    /// Ends the enumeration, naming the chain that leads to `name`.
    std::nullopt_t stop(Span use, const InstDefinition& definition, std::size_t parent, std::string_view name,
                        std::string message) {
        std::vector<std::string_view> chain = {name};
        for (std::size_t at = parent; at < reached_.size(); at = reached_[at].parent) {
            chain.push_back(graph_.objects[reached_[at].id].name);
            if (reached_[at].parent == at) break;
        }
        std::reverse(chain.begin(), chain.end());
        Diagnostic& error = diagnostics_.error(use.known() ? use : definition.span,
                                               fmt::format("{}: {}", message, abridged_chain(chain)));
        error.with_hint("a recursion over arguments needs a base case, such as an object for the argument 0");
        stopped_ = true;
        return std::nullopt;
    }

    void lower_object(std::size_t index) {
        const InstDefinition& definition = *reached_[index].definition;
        if (failed_.contains(&definition)) return;
        work_ += definition.size + index_.patterns(definition.name, definition.parameters.size()).size();
        if (work_ > max_work) {
            stop(reached_[index].use, definition, reached_[index].parent,
                 graph_.objects[reached_[index].id].name,
                 "the model takes too much work to list all its objects");
            return;
        }
        environment_ = lets_;
        for (std::size_t i = 0; i < definition.parameters.size(); ++i)
            if (!definition.parameters[i].is_number())
                environment_[definition.parameters[i].name] = reached_[index].arguments[i];
        Object lowered;
        for (const InstGroup& group : definition.groups)
            lower_group(group, index, lowered);
        report(index);
        Object& object = graph_.objects[reached_[index].id];
        object.instances = std::move(lowered.instances);
        object.terminal = std::move(lowered.terminal);
        object.terminal_px = lowered.terminal_px;
    }

    void lower_group(const InstGroup& group, std::size_t parent, Object& object) {
        if (group.scatter) return lower_scattered(group, parent, object);
        const std::optional<Placement> placement = lower_placement(group);
        instance_count_ += group.masters.size();
        if (!stopped_ && !within_limits(graph_.objects.size(), instance_count_, group.span, lowering_))
            stopped_ = true;
        const double chance = lower_chance(group);
        if (group.below) object.terminal_px = lower_size_px(*group.below, environment_, scratch_).value_or(0);
        for (const InstReference& reference : group.masters) {
            const std::optional<ObjectId> master = resolve(reference, parent);
            if (stopped_) return;
            if (!master || !placement) continue;
            Instance instance{*master, placement->parent_from_child, placement->tint, placement->material,
                              reference.span};
            instance.chance = chance;
            if (group.terminal)
                object.terminal = instance;
            else
                object.instances.push_back(instance);
        }
    }

    void lower_scattered(const InstGroup& group, std::size_t parent, Object& object) {
        std::vector<std::optional<ObjectId>> masters;
        for (const InstReference& reference : group.masters) {
            masters.push_back(resolve(reference, parent));
            if (stopped_) return;
        }
        const std::optional<Placement> placement = lower_placement(group);
        const std::size_t most = lowering_.options.max_objects * max_instances_per_object;
        const ScatterContext context{environment_, graph_.settings, scatter_seed(),
                                     most - std::min(most, instance_count_)};
        const double chance = lower_chance(group);
        const bool good = placement && std::ranges::count(masters, std::optional<ObjectId>()) == 0;
        bool lost = false;
        const auto begin = [&](std::size_t count) {
            if (!good) return;
            instance_count_ += count;
            object.instances.reserve(object.instances.size() + count);
        };
        const auto take = [&](const ScatteredPlace& place) {
            if (!good) return;
            const Affine map = placement->parent_from_child * place.parent_from_child;
            lost = lost || !range_fault(map).empty();
            object.instances.push_back({*masters[place.master], map, place.tint, placement->material,
                                        group.masters[place.master].span});
            object.instances.back().chance = chance;
        };
        lower_scatter(group, context, {begin, take}, scratch_);
        if (lost)
            scratch_.error(group.span, "the sizes or places of these instances leave the range of numbers")
                .with_hint(range_hint);
    }

    /// 0 where none is stated.
    double lower_chance(const InstGroup& group) {
        if (!group.chance) return 0;
        const std::optional<double> chance = evaluate(*group.chance, environment_, scratch_);
        if (!chance || *chance == 0 || (*chance > 0 && is_size(*chance))) return chance.value_or(0);
        const char* const rule =
            *chance < 0 ? "not be negative, but is" : "be 0 or lie between 1e-100 and 1e+100, not";
        scratch_.error(group.chance->span, fmt::format("a chance must {} {}", rule, shortest(*chance)))
            .with_hint("chances are relative to those of the other instances");
        return 0;
    }

    std::optional<std::uint64_t> scatter_seed() const {
        return lowering_.at_root_model() ? lowering_.options.seed : std::nullopt;
    }

    std::optional<Placement> lower_placement(const InstGroup& group) {
        Placement placement;
        const std::optional<Affine> map = lower_transforms(group.transforms, environment_, scratch_);
        std::vector<Tint> tints;
        const std::size_t tint_lines = group.scatter ? 0 : group.tints.size(); // those of a scatter vary
        for (std::size_t i = 0; i < tint_lines; ++i)
            if (const auto tint = lower_tint(group.tints[i].values, environment_, scratch_))
                tints.push_back(*tint);
        if (group.material && materials_.contains(*group.material))
            placement.material = materials_.at(*group.material);
        if (!map || tints.size() < tint_lines) return std::nullopt;
        placement.parent_from_child = *map;
        placement.tint = composed(tints);
        return placement;
    }

    /// The graph's object of a primitive. By a map: a model may have 100,000 shapes, and Graph::primitive()
    /// looks at every object.
    ObjectId primitive(const Primitive& primitive) {
        for (; indexed_ < graph_.objects.size(); ++indexed_)
            if (const std::optional<Primitive>& known = graph_.objects[indexed_].primitive)
                primitives_.emplace(*known, static_cast<ObjectId>(indexed_));
        const auto [found, is_new] = primitives_.try_emplace(primitive, 0);
        if (!is_new) return found->second;
        Object object;
        object.name = name_of(primitive);
        object.primitive = primitive;
        return found->second = graph_.add(std::move(object));
    }

    std::optional<ObjectId> resolve(const InstReference& reference, std::size_t parent) {
        if (unknown_.contains(&reference)) return std::nullopt;
        if (const auto mesh = meshes_.find(&reference); mesh != meshes_.end()) return primitive(mesh->second);
        std::vector<double> arguments;
        for (const Expression& expression : reference.arguments)
            if (const std::optional<double> value = evaluate(expression, environment_, scratch_))
                arguments.push_back(*value == 0 ? 0 : *value); // -0 and 0 are one argument
        if (arguments.size() < reference.arguments.size()) return std::nullopt;
        const std::string name = inst_object_name(reference.name, arguments);
        if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
        if (const std::optional<Primitive> plain = primitive_named(name))
            return by_name_[name] = primitive(*plain);
        if (const std::optional<PrimitiveKind> kind = kind_of(reference)) {
            if (const auto known = shapes_.find(name); known != shapes_.end()) return known->second;
            const std::optional<Primitive> made = lower_primitive(*kind, arguments, reference.span, scratch_);
            if (!made) return std::nullopt;
            return shapes_[name] = primitive(*made);
        }
        if (const auto family = families_.find(reference.name); family != families_.end())
            return family->second.exact(arguments, reference.span, scratch_);
        if (const InstDefinition* definition = index_.match(reference.name, arguments, name))
            return add_object(*definition, std::move(arguments), name, reference.span, parent);
        if (const InstDefinition* definition = index_.any(reference.name))
            scratch_
                .error(reference.span,
                       fmt::format("no definition of '{}' matches '{}'", reference.name, name))
                .with_note(definition->span, "defined here");
        else if (by_name_.contains(use_of(reference.name)->first))
            unknown_object(reference.span, name);
        return std::nullopt;
    }

    /// Hands on the errors of one object. Its definition is then left alone: for other arguments the same
    /// errors would follow.
    void report(std::size_t index) {
        if (!scratch_.has_errors()) return;
        const Reached& reached = reached_[index];
        for (const Diagnostic& found : scratch_.all()) {
            Diagnostic& error = diagnostics_.error(found.span, found.message).with_hint(found.hint);
            error.notes = found.notes;
            if (!reached.arguments.empty() && reached.use.known())
                error.with_note(reached.use, fmt::format("in '{}', first reached from here",
                                                         graph_.objects[reached.id].name));
        }
        scratch_ = Diagnostics();
        failed_.insert(reached.definition);
    }

    // The root

    void choose_root() {
        std::vector<const Reached*> rendered;
        for (const Reached& reached : reached_)
            if (reached.definition->rendered) rendered.push_back(&reached);
        if (rendered.size() == 1) graph_.root = rendered.front()->id;
        if (rendered.size() > 1) add_scene(rendered);
        if (!rendered.empty() || !module_.complete || failed()) return;
        const Span place = module_.definitions.empty() ? module_.end : module_.definitions.back().span;
        diagnostics_.error(place, "the model draws nothing: every object is 'canonical'")
            .with_hint("write 'object NAME { ... }' for the object that the picture shows");
    }

    void add_scene(const std::vector<const Reached*>& rendered) {
        Object scene;
        scene.name = "scene";
        for (int i = 2; by_name_.contains(scene.name); ++i)
            scene.name = fmt::format("scene_{}", i);
        scene.span = rendered.front()->definition->span;
        for (const Reached* reached : rendered)
            scene.instances.push_back({reached->id, Affine(), Tint(), {}, reached->definition->span});
        graph_.root = graph_.add(std::move(scene));
    }

    const InstModule& module_;
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    InstIndex index_;
    Environment lets_;
    Graph graph_;
    std::map<std::string, Span, std::less<>> uses_;
    std::map<std::string, ModelFamily, std::less<>> families_; ///< of the used models with inner parameters
    std::unordered_map<std::string, ObjectId> by_name_;
    std::unordered_map<std::string, MaterialId> materials_;

    std::vector<Reached> reached_;
    Environment environment_; ///< of the object being lowered
    Diagnostics scratch_;     ///< its errors
    std::set<const InstReference*> unknown_;
    std::unordered_map<const InstReference*, Primitive> meshes_;
    std::unordered_map<std::string, ObjectId> shapes_;   ///< primitives of numbers, by their references
    std::unordered_map<Primitive, ObjectId> primitives_; ///< the first objects' of the graph
    std::size_t indexed_ = 0;                            ///< so many objects primitives_ knows of
    std::set<const InstDefinition*> failed_;
    std::unordered_map<const InstDefinition*, std::size_t> tuples_;
    std::size_t instance_count_ = 0;
    std::size_t work_ = 0;
    std::size_t suggestion_work_ = 0;
    bool stopped_ = false;
};

} // namespace

std::optional<Graph> lower_inst(const InstModule& module, Lowering& lowering) {
    return InstLowerer(module, lowering).run();
}

} // namespace graftal
