#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/import/cpfg/system.h"

namespace graftal {

/// Another program whose L-systems are translated as those of cpfg are. A reader of its own writes their
/// expressions in our language, and gives its turtle's commands the words here.
struct CpfgDialect {
    /// The symbol of ours that says the same with the same parameters; "" for none.
    std::function<std::string(const std::string& symbol)> same;
    /// Our text for what a module tells the turtle, where that is more than one symbol; else nothing.
    std::function<std::optional<std::string>(const CpfgModule& module, Span span)> told;
    std::set<std::string> drawn_late;        ///< symbols whose text stands under `interpret`: it has chance
    std::vector<std::string> head, settings; ///< lines before the block, and in it
};

} // namespace graftal
