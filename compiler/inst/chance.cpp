#include "compiler/inst/chance.h"

#include <map>
#include <utility>

#include "compiler/syntax/expression_functions.h"

namespace graftal {

namespace {

using Calls = std::vector<const Expression*>;
using Names = std::set<std::string, std::less<>>;

/// Collects by recursion, as deep as the parser allows.
void collect(const Expression& expression, Calls& calls) {
    if (expression.kind == Expression::Kind::call && chance_function(expression.text))
        calls.push_back(&expression);
    for (const Expression& operand : expression.operands)
        collect(operand, calls);
}

void collect(const std::vector<Expression>& expressions, Calls& calls) {
    for (const Expression& expression : expressions)
        collect(expression, calls);
}

void collect(const std::vector<TransformLine>& lines, const std::vector<InstTint>& tints, Calls& calls) {
    for (const TransformLine& line : lines)
        collect(line.numbers, calls);
    for (const InstTint& tint : tints)
        collect(tint.values, calls);
}

void collect(const std::vector<InstInkStep>& steps, Calls& calls) {
    for (const InstInkStep& step : steps)
        collect(step.values, calls);
}

Calls calls_of(const InstGroup& group) {
    Calls calls;
    for (const InstReference& reference : group.masters)
        collect(reference.arguments, calls);
    static const std::vector<InstTint> none;
    collect(group.transforms, group.scatter ? none : group.tints, calls);
    for (const std::optional<Expression>* number : {&group.below, &group.chance})
        if (*number) collect(**number, calls);
    if (group.hue) collect(*group.hue, calls);
    collect(group.ink, calls);
    for (const auto& repeat : group.repeats) {
        collect(repeat->count, calls);
        collect(repeat->transforms, repeat->tints, calls);
        if (repeat->hue) collect(*repeat->hue, calls);
        collect(repeat->ink, calls);
    }
    return calls;
}

/// For each name, the objects that name it.
using Users = std::map<std::string, Names, std::less<>>;

/// Adds all objects that contain one of the names, at any depth.
void add_users(const Users& users, Names& names) {
    std::vector<std::string> open(names.begin(), names.end());
    while (!open.empty()) {
        const auto found = users.find(open.back());
        open.pop_back();
        if (found == users.end()) continue;
        for (const std::string& user : found->second)
            if (names.insert(user).second) open.push_back(user);
    }
}

/// Names on cycles, and names that reach one: this removes the names that contain no other name left, again
/// and again (Kahn 1962), and gives the rest.
Names on_cycles(const InstModule& module, const Users& users) {
    std::map<std::string, std::size_t, std::less<>> held; // names, each once
    for (const InstDefinition& definition : module.definitions)
        held.emplace(definition.name, 0);
    for (const auto& [name, by] : users)
        if (held.contains(name))
            for (const std::string& user : by)
                ++held.at(user);
    std::vector<std::string> free;
    Names left;
    for (const auto& [name, count] : held) {
        left.insert(name);
        if (count == 0) free.push_back(name);
    }
    while (!free.empty()) {
        const std::string name = std::move(free.back());
        free.pop_back();
        left.erase(name);
        const auto by = users.find(name);
        if (by == users.end()) continue;
        for (const std::string& user : by->second)
            if (--held.at(user) == 0) free.push_back(user);
    }
    return left;
}

} // namespace

InstChance::InstChance(const InstModule& module) {
    Users users;
    for (const InstDefinition& definition : module.definitions) {
        if (definition.weight) random_.insert(definition.name);
        for (const InstGroup& group : definition.groups) {
            for (const InstReference& reference : group.masters)
                users[reference.name].insert(definition.name);
            Calls calls = calls_of(group);
            if (calls.empty()) continue;
            random_.insert(definition.name);
            calls_.emplace(&group, std::move(calls));
        }
    }
    add_users(users, random_);
    recurring_ = on_cycles(module, users);
    for (const UseStatement& use : module.uses) // with their parts: `leaf.blade`
        for (auto name = users.lower_bound(use.name.text);
             name != users.end() && name->first.starts_with(use.name.text); ++name)
            recurring_.insert(name->first);
    add_users(users, recurring_);
}

const std::vector<const Expression*>& InstChance::calls(const InstGroup& group) const {
    static const Calls none;
    const auto found = calls_.find(&group);
    return found == calls_.end() ? none : found->second;
}

} // namespace graftal
