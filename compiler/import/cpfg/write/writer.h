#pragma once

#include <string>

#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/names.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// The system as a model of ours, with the environment that a file describes ("": none). Useless after an
/// error.
Translation write_cpfg_system(CpfgNames& names, LSystem system, const ForeignModel& model,
                              const std::string& environment);

/// The system of another program as a model of ours. Useless after an error.
Translation write_dialect(const ForeignFile& file, LSystem system, const ForeignModel& model,
                          const CpfgDialect& dialect);

} // namespace graftal
