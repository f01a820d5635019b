#include "compiler/inst/lower.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "compiler/inst/empty.h"
#include "compiler/inst/lowerer.h"
#include "compiler/lower/inner_parameters.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/syntax/lost_value.h"

namespace graftal {

namespace {

/// The names that the groups of an object refer to.
using NamesWithin = std::map<std::string_view, std::vector<std::string_view>>;

NamesWithin names_within(const InstModule& module) {
    NamesWithin names;
    for (const InstDefinition& definition : module.definitions)
        for (const InstGroup& group : definition.groups)
            for (const InstReference& reference : group.masters)
                names[definition.name].push_back(reference.name);
    return names;
}

/// Whether an object is made of another, however deep. True too once `looks_left` is used up.
bool leads_to(const NamesWithin& names, std::string_view from, std::string_view to, std::size_t& looks_left) {
    std::set<std::string_view> found;
    std::vector<std::string_view> waiting = {from};
    while (!waiting.empty()) {
        const auto within = names.find(waiting.back());
        waiting.pop_back();
        if (within == names.end()) continue;
        for (const std::string_view name : within->second) {
            if (name == to || looks_left == 0) return true;
            --looks_left;
            if (found.insert(name).second) waiting.push_back(name);
        }
    }
    return false;
}

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

} // namespace

InstLowerer::InstLowerer(const InstModule& module, Lowering& lowering)
    : module_(module), lowering_(lowering), diagnostics_(lowering.diagnostics), index_(module_, diagnostics_),
      chance_(module_), seed_(lowering.options.seed.value_or(0)) {}

std::optional<Graph> InstLowerer::run() && {
    lowering_.notes.asks_chance |= chance_.has_random();
    lets_ = lower_lets(module_.scene, lowering_);
    object_.values = choice_.values = lets_;
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
    if (lowering_.at_root_model()) note_drawn_twice();
    const Span place = graph_.objects[graph_.root].span;
    if (!drop_empty(graph_, hues_, inks_)) {
        diagnostics_.error(place, "the model draws nothing").with_hint("its conditions leave nothing of it");
        return std::nullopt;
    }
    if (!inks_.empty() && !apply_inks(graph_, inks_, hues_, place, lowering_)) return std::nullopt;
    if (!hues_.empty() && !apply_hues(graph_, hues_, place, lowering_)) return std::nullopt;
    return std::move(graph_);
}

void InstLowerer::enumerate() {
    if (const std::optional<PartCall>& part = lowering_.loading.back().part) {
        call_for(*part);
    } else {
        for (const InstDefinition& definition : module_.definitions)
            if (definition.rendered || index_.always_exists(definition)) call_for(definition);
    }
    for (std::size_t i = 0; i < reached_.size() && !stopped_ && !diagnostics_.full(); ++i)
        lower_object(i);
}

void InstLowerer::call_for(const InstDefinition& definition) {
    std::vector<double> arguments;
    for (const InstParameter& parameter : definition.parameters)
        arguments.push_back(parameter.is_number() ? parameter.number : lost_value); // an error said so
    const std::string name = inst_object_name(definition.name, arguments);
    if (index_.match(definition.name, arguments, name) != &definition) return; // a duplicate
    if (stopped_ || by_name_.contains(name)) return;
    if (definition.rendered || !chance_.is_random(definition.name))
        add_called(definition, std::move(arguments), name);
}

void InstLowerer::call_for(const PartCall& part) {
    const std::string name = inst_object_name(part.name, part.arguments);
    std::optional<ObjectId> root;
    if (const InstDefinition* const definition = index_.match(part.name, part.arguments, name)) {
        root = add_called(*definition, part.arguments, name);
    } else if (uses_.contains(part.name)) {
        root = whole_used(part);
    } else if (use_of(part.name)) {
        root = import_called(part.name, part.arguments);
    } else {
        root = no_part();
    }
    graph_.root = root.value_or(0);
}

std::optional<ObjectId> InstLowerer::whole_used(const PartCall& part) {
    const auto root = by_name_.find(part.name);
    if (root == by_name_.end()) return std::nullopt; // it did not load
    if (part.arguments.empty()) return root->second;
    if (part.arguments.size() > inner_count(part.name)) return no_part();
    return families_.find(part.name)->second.exact(part.arguments, uses_.at(part.name), diagnostics_);
}

std::nullopt_t InstLowerer::no_part() {
    lowering_.part_missing = true;
    ++lowering_.known_failures;
    return std::nullopt;
}

std::optional<ObjectId> InstLowerer::add_called(const InstDefinition& definition,
                                                std::vector<double> arguments, const std::string& name) {
    if (!chance_.is_random(definition.name))
        return add_object({0, &definition, std::move(arguments), Span(), reached_.size()}, name);
    const std::uint64_t key = key_of(name);
    const InstDefinition* const chosen = choose(definition, arguments, key, 0);
    for (const Diagnostic& found : scratch_.all())
        diagnostics_.error(found.span, found.message).with_hint(found.hint);
    scratch_ = Diagnostics();
    if (!chosen) return std::nullopt;
    return add_object({0, chosen, std::move(arguments), Span(), reached_.size(), 0, key}, name);
}

std::optional<ObjectId> InstLowerer::add_object(Reached reached, const std::string& name) {
    const InstDefinition& definition = *reached.definition;
    const bool enumerated = !index_.always_exists(definition);
    const std::size_t most = lowering_.options.max_objects;
    if (graph_.objects.size() >= most)
        return stop(reached.use, definition, reached.parent, name,
                    fmt::format("the model has more than {} objects", most));
    if (enumerated && ++tuples_[&definition] > max_argument_tuples)
        return stop(reached.use, definition, reached.parent, name,
                    fmt::format("the model uses object '{}' with more than {} different arguments",
                                definition.name, max_argument_tuples));
    Object object;
    object.name = name;
    object.span = definition.span;
    reached.id = graph_.add(std::move(object));
    by_name_.emplace(name, reached.id);
    reached_.push_back(std::move(reached));
    return reached_.back().id;
}

std::nullopt_t InstLowerer::stop(Span use, const InstDefinition& definition, std::size_t parent,
                                 std::string_view name, std::string message) {
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

void InstLowerer::lower_object(std::size_t index) {
    const InstDefinition& definition = *reached_[index].definition;
    if (failed_.contains(&definition)) return;
    current_ = index;
    place_ = 0;
    if (!work(definition.size + index_.patterns(definition.name, definition.parameters.size()).size()))
        return;
    set_parameters(definition, reached_[index].arguments, object_);
    if (!tests_.empty()) tests_ = {}; // clear() takes as long as that of the largest object
    Lowered lowered;
    for (const InstGroup& group : definition.groups)
        lower_group(group, lowered);
    report(index);
    Object& object = graph_.objects[reached_[index].id];
    object.instances = std::move(lowered.object.instances);
    if (object.instances.size() > 1) object.combination = definition.combination.value_or(Combination::unite);
    object.terminal = std::move(lowered.object.terminal);
    object.terminal_px = lowered.object.terminal_px;
    keep_colours(reached_[index].id, std::move(lowered));
}

bool InstLowerer::count_work(std::size_t words) {
    work_ += words;
    lowering_.meter.add(words);
    return work_ <= max_inst_work;
}

bool InstLowerer::work(std::size_t words) {
    if (count_work(words)) return true;
    const Reached& reached = reached_[current_];
    if (!stopped_)
        stop(reached.use, *reached.definition, reached.parent, graph_.objects[reached.id].name,
             "the model takes too much work to list all its objects");
    return false;
}

void InstLowerer::set_parameters(const InstDefinition& definition, const std::vector<double>& arguments,
                                 ObjectEnvironment& environment) const {
    for (const std::string& name : environment.parameters) {
        if (const auto let = lets_.find(name); let != lets_.end())
            environment.values[name] = let->second;
        else
            environment.values.erase(name);
    }
    environment.parameters.clear();
    for (std::size_t i = 0; i < definition.parameters.size(); ++i) {
        if (definition.parameters[i].is_number()) continue;
        environment.parameters.push_back(definition.parameters[i].name);
        environment.values[definition.parameters[i].name] = arguments[i];
    }
}

void InstLowerer::keep_colours(ObjectId id, Lowered lowered) {
    const auto turns = [](HueTurn turn) { return turn.part != 0; };
    if (turns(lowered.hues.terminal) || std::ranges::any_of(lowered.hues.instances, turns))
        hues_.emplace(id, std::move(lowered.hues));
    const auto changes = [](const InkChange& change) { return !change.empty(); };
    if (changes(lowered.inks.terminal) || std::ranges::any_of(lowered.inks.instances, changes))
        inks_.emplace(id, std::move(lowered.inks));
}

void InstLowerer::report(std::size_t index) {
    if (!scratch_.has_errors()) return;
    const Reached& reached = reached_[index];
    for (const Diagnostic& found : scratch_.all()) {
        Diagnostic& error = diagnostics_.error(found.span, found.message).with_hint(found.hint);
        error.notes = found.notes;
        if (!reached.arguments.empty() && reached.use.known())
            error.with_note(reached.use,
                            fmt::format("in '{}', first reached from here", graph_.objects[reached.id].name));
    }
    scratch_ = Diagnostics();
    failed_.insert(reached.definition);
}

void InstLowerer::choose_root() {
    if (lowering_.loading.back().part) return;
    std::vector<const Reached*> rendered;
    for (const Reached& reached : reached_)
        if (reached.definition->rendered) rendered.push_back(&reached);
    if (rendered.size() == 1) graph_.root = rendered.front()->id;
    if (rendered.size() > 1) add_scene(rendered);
    if (!rendered.empty() || !module_.complete || failed()) return;
    if (module_.definitions.empty()) {
        diagnostics_.error(module_.end, "this file has no object")
            .with_hint("write one, such as 'object ball { sphere }'");
        return;
    }
    diagnostics_
        .error(module_.definitions.back().span, "the model draws nothing: every object is 'canonical'")
        .with_hint("write 'object NAME { ... }' for the object that the picture shows");
}

void InstLowerer::note_drawn_twice() {
    std::map<std::string_view, Span> drawn; // by the names of objects without parameters
    for (const InstDefinition& definition : module_.definitions)
        if (definition.rendered && definition.parameters.empty())
            drawn.emplace(definition.name, definition.span);
    const NamesWithin names = names_within(module_);
    std::size_t looks_left = 1'000'000; // a note is not worth more
    for (const InstDefinition& definition : module_.definitions)
        for (const InstGroup& group : definition.groups)
            for (const InstReference& reference : group.masters) {
                const auto used = drawn.find(reference.name);
                if (used == drawn.end() || reference.name == definition.name ||
                    !reference.arguments.empty() || group.terminal) // a terminal may stand for a whole model
                    continue;
                if (leads_to(names, reference.name, definition.name, looks_left)) continue; // a recursion
                diagnostics_
                    .note(used->second, fmt::format("'{}' is drawn by itself, and again inside '{}'",
                                                    reference.name, definition.name))
                    .with_hint(fmt::format("write 'canonical object {}' to draw it only inside others",
                                           reference.name))
                    .with_note(reference.span, "it is used here");
                drawn.erase(used);
            }
}

void InstLowerer::add_scene(const std::vector<const Reached*>& rendered) {
    Object scene;
    scene.name = "scene";
    for (int i = 2; by_name_.contains(scene.name); ++i)
        scene.name = fmt::format("scene_{}", i);
    scene.span = rendered.front()->definition->span;
    for (const Reached* reached : rendered)
        scene.instances.push_back({reached->id, Affine(), Tint(), {}, reached->definition->span});
    graph_.root = graph_.add(std::move(scene));
}

std::optional<Graph> lower_inst(const InstModule& module, Lowering& lowering) {
    return InstLowerer(module, lowering).run();
}

} // namespace graftal
