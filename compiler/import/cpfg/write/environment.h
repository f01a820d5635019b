#pragma once

#include <string>

#include "compiler/import/cpfg/names.h"

namespace graftal {

/// The statement `environment ...` of ours that stands for a model's environment program; "" after the error
/// that it has no translation. `span`: of the query that asks it.
std::string translated_cpfg_environment(const std::string& file_name, CpfgNames& names, Span span);

} // namespace graftal
