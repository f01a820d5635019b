#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// L-systems of cpfg, of the Virtual Laboratory (`.l`), one in each file. The view file of the same name
/// lies beside it (`.v`), and names the functions. Source: the CPFG manual (Prusinkiewicz, Hanan, Mech and
/// others, University of Calgary), and where it is silent, lsys_input.y, generate.c and interpret.c of the
/// program.
Importer cpfg_importer();

} // namespace graftal
