#pragma once

#include <string>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/cpfg/system.h"

namespace graftal {

/// The system as a model of ours, with the environment that a file describes ("": none). Useless after an
/// error.
Translation write_cpfg_system(CpfgNames& names, CpfgSystem system, const ForeignModel& model,
                              const std::string& environment);

} // namespace graftal
