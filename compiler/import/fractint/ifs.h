#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Fractint's iterated function systems (`.ifs`), of the plane and of space: maps by rows of 6 or 12 numbers
/// and a probability, as in Fractint's manual, "IFS". They become `.rifs`. A system whose maps do not all
/// shrink has no limit set, and becomes an orbit, for `graftal points`.
Importer fractint_ifs_importer();

} // namespace graftal
