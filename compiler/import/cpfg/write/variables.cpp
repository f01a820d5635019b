#include "compiler/import/cpfg/write/variables.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/import/cpfg/block.h"

namespace graftal {

namespace {

/// Assigned after the start, or twice: names of these blocks, or of productions.
std::set<std::string> changed_names(const LSystem& system) {
    std::set<std::string> changed, seen;
    const auto take_all = [&](const LSystemBlock& block) {
        each_assignment(block, [&](const LSystemAction& action, bool) { changed.insert(action.name); });
    };
    for (const auto& [moment, block] : system.blocks) {
        if (moment != LSystemMoment::start) {
            take_all(block);
            continue;
        }
        each_assignment(block, [&](const LSystemAction& action, bool always) {
            if (!seen.insert(action.name).second || !always) changed.insert(action.name);
        });
    }
    for (const auto& [section, productions] : system.productions)
        for (const LSystemProduction& production : productions) {
            take_all(production.before);
            take_all(production.after);
        }
    return changed;
}

/// `with a = 1, b = a/2` says the same: plain values, each once, none of chance.
bool is_plain(const LSystemProduction& production, const CpfgVariables& variables) {
    std::set<std::string> taken;
    for (const LSystemString* string : {&production.predecessor, &production.left, &production.right})
        for (const LSystemModule& module : *string)
            taken.insert(module.parameters.begin(), module.parameters.end());
    bool plain = true;
    for (const LSystemBlock* block : {&production.before, &production.after})
        for (const LSystemAction& action : *block)
            plain = plain && action.kind == LSystemAction::Kind::assign && action.target == action.name &&
                    !variables.is_global(action.name) && taken.insert(action.name).second &&
                    !is_random(action.value);
    return plain;
}

} // namespace

CpfgVariables::CpfgVariables(const CpfgNames& names, const LSystem& system) : blocks_(system.blocks) {
    for (const LSystemArray& array : system.arrays)
        globals_.insert(array.name);
    for (const auto& [moment, block] : system.blocks)
        each_assignment(block, [&](const LSystemAction& action, bool) { globals_.insert(action.name); });
    const auto start = system.blocks.find(LSystemMoment::start);
    const std::set<std::string> changed = changed_names(system);
    if (start != system.blocks.end()) take_start(names, start->second, changed);
    std::set<std::string> known;
    for (const LSystemArray& array : system.arrays)
        known.insert(array.name);
    for (const Values* values : {&lets_, &variables_})
        for (const auto& [name, value] : *values)
            known.insert(name);
    for (const std::string& name : globals_)
        if (!known.contains(name)) variables_.emplace_back(name, "0");
}

/// The beginning of the block whose values are known before: it becomes statements of their own.
void CpfgVariables::take_start(const CpfgNames& names, const LSystemBlock& start,
                               const std::set<std::string>& changed) {
    std::set<std::string> let_names = names.lets(), said;
    LSystemBlock rest;
    bool constant = true; // nothing was left for the block yet
    for (const LSystemAction& action : start) {
        const bool known =
            constant && action.kind == LSystemAction::Kind::assign && action.target == action.name &&
            !is_random(action.value) && said.insert(action.name).second &&
            !names_any(action.value, [&](std::string_view name) {
                return globals_.contains(std::string(name)) && !let_names.contains(std::string(name));
            });
        if (!known) {
            constant = false;
            rest.push_back(action);
        } else if (changed.contains(action.name)) {
            variables_.emplace_back(action.name, action.value);
        } else {
            lets_.emplace_back(action.name, action.value);
            let_names.insert(action.name);
        }
    }
    blocks_[LSystemMoment::start] = std::move(rest);
}

std::string cpfg_condition_text(const LSystemProduction& production, const CpfgVariables& variables,
                                bool in_steps) {
    std::string condition = production.condition;
    if (in_steps) condition = condition.empty() ? "step > 0" : fmt::format("step > 0 && ({})", condition);
    const bool has_blocks = !production.before.empty() || !production.after.empty();
    if (condition.empty() && !has_blocks) return "";
    std::string text = " : ";
    if (is_plain(production, variables)) {
        text += condition.empty() ? "1" : condition;
        bool first = true;
        for (const LSystemBlock* block : {&production.before, &production.after})
            for (const LSystemAction& action : *block) {
                text += fmt::format("{}{} = {}", first ? " with " : ", ", action.name, action.value);
                first = false;
            }
        return text;
    }
    if (!production.before.empty()) text += cpfg_block_text(production.before);
    if (!condition.empty() || production.before.empty())
        text += (production.before.empty() ? "" : " ") + (condition.empty() ? std::string("*") : condition);
    if (!production.after.empty()) text += " " + cpfg_block_text(production.after);
    return text;
}

} // namespace graftal
