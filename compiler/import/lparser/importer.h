#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Files of L-Parser (`.ls`), one model in each, in both layouts: depth, angle, thickness, axiom, rules and
/// `@`, each on its line (Lparser 3 and 4); and lines that begin with a keyword (Lparser 5 and Lparser2).
/// Where the manual is silent, what the programs do: Lapre's Lparser2.c, and K-3D's port of Lparser 4.
Importer lparser_importer();

} // namespace graftal
