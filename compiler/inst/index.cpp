#include "compiler/inst/index.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/graph/graph.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

bool has_names(const InstDefinition& definition) {
    return std::any_of(definition.parameters.begin(), definition.parameters.end(),
                       [](const InstParameter& parameter) { return !parameter.is_number(); });
}

/// `f(0, _)`: equal for patterns that match the same arguments.
std::string pattern_text(const InstDefinition& definition) {
    std::string text = definition.name;
    const char* separator = "(";
    for (const InstParameter& parameter : definition.parameters) {
        text += separator;
        text += parameter.is_number() ? shortest(parameter.number) : "_";
        separator = ", ";
    }
    return definition.parameters.empty() ? text : text + ")";
}

/// The head of the definition, as the text has it: `f(0, n)`.
std::string signature(const InstDefinition& definition) {
    std::string text = definition.name;
    const char* separator = "(";
    for (const InstParameter& parameter : definition.parameters) {
        text += separator;
        text += parameter.is_number() ? shortest(parameter.number) : parameter.name;
        separator = ", ";
    }
    return definition.parameters.empty() ? text : text + ")";
}

bool more_specific(const InstDefinition* a, const InstDefinition* b) {
    for (std::size_t i = 0; i < a->parameters.size(); ++i)
        if (a->parameters[i].is_number() != b->parameters[i].is_number()) return a->parameters[i].is_number();
    return false;
}

bool matches(const InstDefinition& definition, const std::vector<double>& arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i)
        if (definition.parameters[i].is_number() && definition.parameters[i].number != arguments[i])
            return false;
    return true;
}

} // namespace

std::string inst_object_name(std::string_view name, const std::vector<double>& arguments) {
    std::string text(name);
    const char* separator = "(";
    for (const double argument : arguments) {
        text += separator;
        text += shortest(argument);
        separator = ", ";
    }
    if (!arguments.empty()) text += ')';
    return text;
}

InstIndex::InstIndex(const InstModule& module, Diagnostics& diagnostics) {
    for (const InstDefinition& definition : module.definitions)
        add(definition, diagnostics);
    for (auto& [name, patterns] : patterns_)
        std::stable_sort(patterns.begin(), patterns.end(), more_specific);
}

void InstIndex::add(const InstDefinition& definition, Diagnostics& diagnostics) {
    if (is_reserved_name(definition.name)) {
        diagnostics
            .error(definition.span, fmt::format("'{}' is a primitive and cannot be defined", definition.name))
            .with_hint("choose another name");
        return;
    }
    const std::string text = pattern_text(definition);
    const auto [other, fresh] = by_pattern_.emplace(text, &definition);
    if (!fresh) return add_alternative(*other->second, definition, diagnostics);
    first_.emplace(definition.name, &definition);
    std::vector<const InstDefinition*>& named = patterns_[{definition.name, definition.parameters.size()}];
    if (!has_names(definition)) return;
    named.push_back(&definition);
    if (definition.rendered)
        diagnostics
            .error(definition.span,
                   fmt::format("the object '{}' is drawn, but has a parameter", definition.name))
            .with_hint("make it a 'canonical object', and add an object without parameters that contains it");
}

void InstIndex::add_alternative(const InstDefinition& first, const InstDefinition& definition,
                                Diagnostics& diagnostics) {
    if (!first.weight || !definition.weight) {
        Diagnostic& error =
            diagnostics.error(definition.span, fmt::format("duplicate object '{}'", signature(definition)));
        if (first.weight || definition.weight)
            error.with_hint("give each of these definitions a weight, or keep only one of them");
        error.with_note(first.span, "first defined here");
        return;
    }
    if (first.rendered != definition.rendered)
        diagnostics
            .error(definition.span,
                   fmt::format("the weighted definitions of '{}' must all be canonical, or none of them",
                               signature(definition)))
            .with_note(first.span, "the first is here");
    others_[&first].push_back(&definition);
}

std::vector<const InstDefinition*> InstIndex::alternatives(const InstDefinition& definition) const {
    std::vector<const InstDefinition*> all = {&definition};
    if (const auto others = others_.find(&definition); others != others_.end())
        all.insert(all.end(), others->second.begin(), others->second.end());
    return all;
}

const InstDefinition* InstIndex::match(std::string_view name, const std::vector<double>& arguments,
                                       std::string_view object_name) const {
    const auto literal = by_pattern_.find(std::string(object_name));
    if (literal != by_pattern_.end()) return literal->second;
    for (const InstDefinition* definition : patterns(name, arguments.size()))
        if (matches(*definition, arguments)) return definition;
    return nullptr;
}

bool InstIndex::always_exists(const InstDefinition& definition) const {
    return patterns(definition.name, definition.parameters.size()).empty();
}

const std::vector<const InstDefinition*>& InstIndex::patterns(std::string_view name,
                                                              std::size_t arity) const {
    static const std::vector<const InstDefinition*> none;
    const auto found = patterns_.find({std::string(name), arity});
    return found == patterns_.end() ? none : found->second;
}

const InstDefinition* InstIndex::any(std::string_view name) const {
    const auto found = first_.find(name);
    return found == first_.end() ? nullptr : found->second;
}

bool InstIndex::defined(std::string_view name, std::size_t arity) const {
    return patterns_.contains({std::string(name), arity});
}

std::vector<std::string> InstIndex::names() const {
    std::vector<std::string> out;
    for (const auto& [name, definition] : first_)
        out.push_back(name);
    return out;
}

} // namespace graftal
