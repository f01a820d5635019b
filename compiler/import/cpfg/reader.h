#pragma once

#include <optional>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// The L-system of a source; nothing after an error.
std::optional<LSystem> read_cpfg_system(CpfgNames& names);

} // namespace graftal
