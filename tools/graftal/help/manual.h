#pragma once

#include <string>

#include "tools/graftal/help/option_tree.h"

namespace graftal {

/// A page of section 1 of the manual, for `man -l`: troff with the macros of man(7). `whole`: the tree that
/// the command belongs to.
std::string manual_page(const CommandTree& command, const CommandTree& whole);

} // namespace graftal
