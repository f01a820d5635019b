#pragma once

#include <string>

#include "compiler/import/importer.h"

namespace graftal {

/// The files that go with a model; "" for those that it has not.
struct CpfgCompanions {
    std::string view;        ///< view file
    std::string environment; ///< of the environment program
};

/// The files that the model's `specifications` name; else the view file has the model's name.
CpfgCompanions find_cpfg_companions(const ForeignFile& file);

} // namespace graftal
