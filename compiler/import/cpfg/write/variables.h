#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// The variables of a model, as those of ours that never change (`let`) and those that do.
class CpfgVariables {
  public:
    CpfgVariables(const CpfgNames& names, const LSystem& system);

    using Values = std::vector<std::pair<std::string, std::string>>;
    const Values& lets() const { return lets_; }
    const Values& variables() const { return variables_; }

    /// The model's blocks, less the statements that became variables.
    const std::map<LSystemMoment, LSystemBlock>& blocks() const { return blocks_; }

    /// Whether a production may not use the name for a value of its own.
    bool is_global(const std::string& name) const { return globals_.contains(name); }

  private:
    void take_start(const CpfgNames& names, const LSystemBlock& start, const std::set<std::string>& changed);

    std::set<std::string> globals_;
    Values lets_, variables_;
    std::map<LSystemMoment, LSystemBlock> blocks_;
};

/// ` : condition`, with the production's blocks or local values; "" for neither. `in_steps`: it does not hold
/// before the first step.
std::string cpfg_condition_text(const LSystemProduction& production, const CpfgVariables& variables,
                                bool in_steps);

} // namespace graftal
