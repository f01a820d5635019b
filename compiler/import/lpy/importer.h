#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// `.lpy` files of L-Py (OpenAlea), where they are plain L-systems: rules may decide by `if` and name values,
/// but loops, objects and modules of Python are refused by their line.
Importer lpy_importer();

} // namespace graftal
