#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Fractint's L-systems (`.l`): many in a file, as blocks `Name { Angle 6  Axiom F--F--F  F=F+F--F+F }`,
/// each statement on its own line, in letters of any case (Fractint 20, "L-Systems"). Where the manual is
/// silent, this follows the program: Iterated Dynamics, libid/fractals/lsystem.cpp.
Importer fractint_lsystem_importer();

} // namespace graftal
