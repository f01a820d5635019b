// The names of an `.inst` file: its used models, its definitions and its references.

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/inst/lowerer.h"
#include "compiler/lower/inner_parameters.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/syntax/everyday_words.h"
#include "compiler/syntax/expression_functions.h"

namespace graftal {

namespace {

/// Names that are compared with misspelt ones.
constexpr std::size_t max_suggestion_work = 100'000;
/// Objects that a file may ask its used models for: each is a look at the whole file.
constexpr std::size_t max_parts_of_used = 1000;

} // namespace

void InstLowerer::import_used(const UseStatement& use) {
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

void InstLowerer::add_family(const UseStatement& use, FileId file) {
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

std::optional<ObjectId> InstLowerer::part_of_used(std::string_view name, const std::vector<double>& arguments,
                                                  Span place) {
    if (++parts_ > max_parts_of_used) {
        scratch_
            .error(place,
                   fmt::format("the model asks its used models for more than {} objects", max_parts_of_used))
            .with_hint("define the object here, or round its arguments");
        stopped_ = true;
        return std::nullopt;
    }
    const std::optional<ObjectId> part = import_called(name, arguments);
    if (!part && std::exchange(lowering_.part_missing, false))
        unknown_object(place, inst_object_name(name, arguments));
    return part;
}

std::optional<ObjectId> InstLowerer::import_called(std::string_view name,
                                                   const std::vector<double>& arguments) {
    const std::string_view model = name.substr(0, name.find('.'));
    const auto use =
        std::ranges::find(module_.uses, model, [](const UseStatement& one) { return one.name.text; });
    const std::size_t known = graph_.objects.size();
    const std::optional<ObjectId> part = import_part(
        graph_, by_name_, *use, {std::string(name.substr(model.size() + 1)), arguments}, lowering_);
    for (std::size_t id = known; id < graph_.objects.size(); ++id) {
        by_name_.emplace(graph_.objects[id].name, static_cast<ObjectId>(id));
        instance_count_ += graph_.objects[id].instances.size();
    }
    if (part) by_name_.emplace(inst_object_name(name, arguments), *part);
    return part;
}

std::size_t InstLowerer::inner_count(std::string_view name) const {
    const auto family = families_.find(name);
    return family == families_.end() ? 0 : family->second.parameters().size();
}

const std::pair<const std::string, Span>* InstLowerer::use_of(std::string_view name) const {
    const auto use = uses_.find(name.substr(0, name.find('.')));
    return use == uses_.end() ? nullptr : &*use;
}

void InstLowerer::check_names(const InstDefinition& definition) {
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
        for (const TransformLine& line : group.transforms)
            check_numbers(line.numbers, definition);
        for (const InstTint& tint : group.tints)
            check_numbers(tint.values, definition);
        if (!group.material || materials_.contains(*group.material)) continue;
        if (const auto id =
                material_named(*group.material, group.material_span, graph_.materials, diagnostics_))
            materials_.emplace(*group.material, *id);
    }
}

void InstLowerer::check_numbers(const std::vector<Expression>& numbers, const InstDefinition& definition) {
    for (const Expression& number : numbers) {
        const bool call = number.kind == Expression::Kind::call;
        if (!call && number.kind != Expression::Kind::name) continue;
        if (call ? number.table || expression_function(number.text) || chance_function(number.text)
                 : number.text == "pi" || lets_.contains(number.text) ||
                       std::ranges::find(definition.parameters, number.text, &InstParameter::name) !=
                           definition.parameters.end())
            continue;
        if (!index_.any(number.text) && !primitive_kind_named(number.text) && !use_of(number.text)) continue;
        diagnostics_
            .error(number.span, fmt::format("'{}' is an object, and a number stands here", number.text))
            .with_hint("begin a new line before it, without a comma: each instance begins its own line");
        failed_.insert(&definition);
    }
}

bool InstLowerer::check_reference(const InstReference& reference) {
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

std::optional<PrimitiveKind> InstLowerer::kind_of(const InstReference& reference) const {
    const bool hidden =
        uses_.contains(reference.name) || index_.defined(reference.name, reference.arguments.size());
    return hidden ? std::nullopt : kind_of_numbers(reference.name);
}

bool InstLowerer::check_mesh(const InstReference& reference) {
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

Diagnostic& InstLowerer::wrong_count(const InstReference& reference, std::size_t arity) {
    return wrong_count(reference, arity == 0 ? std::string("no arguments")
                                             : fmt::format("{} argument{}", arity, arity == 1 ? "" : "s"));
}

Diagnostic& InstLowerer::wrong_count(const InstReference& reference, const std::string& takes) {
    return diagnostics_.error(reference.span, fmt::format("'{}' takes {}, not {}", reference.name, takes,
                                                          reference.arguments.size()));
}

void InstLowerer::unknown_object(Span span, std::string_view name) {
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
    std::string hint = shape_word_hint(name);
    if (hint.empty()) hint = line_word_hint(name);
    if (hint.empty()) hint = choices(name, known);
    error.with_hint(hint.empty() ? fmt::format("the primitives are {}", fmt::join(primitives, ", ")) : hint);
}

} // namespace graftal
