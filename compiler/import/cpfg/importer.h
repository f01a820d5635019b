#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// L-systems of cpfg, of the Virtual Laboratory (`.l`), one in each file, with the view file beside it that
/// has the same name (`.v`) and the functions that this one names. Source: the CPFG manual (Prusinkiewicz,
/// Hanan, Mech and others, University of Calgary), and where it is silent, lsys_input.y, generate.c and
/// interpret.c of the program.
Importer cpfg_importer();

} // namespace graftal
