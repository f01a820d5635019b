#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>

#include "compiler/import/importer.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// Another program whose L-systems are translated as those of cpfg are. A reader of its own writes their
/// expressions in our language, and gives its turtle's commands the words here.
struct CpfgDialect {
    /// The symbol of ours that says the same with the same parameters; "" for none.
    std::function<std::string(const std::string& symbol)> same;
    /// Our text for what a module tells the turtle, where that is more than one symbol; else nothing.
    std::function<std::optional<std::string>(const LSystemModule& module, Span span)> told;
    std::set<std::string> drawn_late; ///< symbols whose text stands under `interpret`: it has chance
    std::optional<double> angle_deg;  ///< of a turn without a number; nothing: the settings say it
    std::string start;                ///< text before the axiom: the turtle's state
    Translation head = {}, settings = {}, ending = {}; ///< lines before the block; in it, first and last
};

} // namespace graftal
