#pragma once

#include <string_view>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// The modules of a string, after its macros.
LSystemString read_cpfg_string(std::string_view given, CpfgNames& names, Span span);

} // namespace graftal
