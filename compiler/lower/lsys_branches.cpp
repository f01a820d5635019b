#include "compiler/lower/lsys_branches.h"

#include <algorithm>

#include "compiler/lower/lsys_rewriter.h"

namespace graftal {

static_assert(max_distinct_modules < 1u << 31);

/// The trunk doubles as the stack of what is read of the open branches.
LsysBranches::LsysBranches(const LsysGrammar& grammar, const ModuleTable& modules,
                           std::span<const ModuleId> word) {
    std::vector<std::size_t> open; // where in the trunk the branches begin
    for (const ModuleId module : word) {
        const TurtleCommand command = grammar.commands[modules.symbol(module)];
        if (command == TurtleCommand::open_branch) {
            open.push_back(trunk_.size());
        } else if (command == TurtleCommand::close_branch) {
            const ModuleId number = number_of(std::span(trunk_).subspan(open.back()));
            trunk_.resize(open.back());
            trunk_.push_back(number);
            open.pop_back();
        } else {
            trunk_.push_back(module);
        }
    }
}

ModuleId LsysBranches::number_of(std::span<const ModuleId> branch) {
    std::uint64_t hash = branch.size();
    for (const ModuleId module : branch)
        hash = mixed(hash, module);
    const auto next = static_cast<std::uint32_t>(ranges_.size());
    const std::uint32_t id = ids_.find_or_add(hash, next, [&](std::uint32_t known) {
        return std::ranges::equal(this->branch(known), branch);
    });
    if (id == next) {
        ranges_.push_back({store_.size(), branch.size()});
        store_.insert(store_.end(), branch.begin(), branch.end());
    }
    return id | mark;
}

} // namespace graftal
