#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Context Free's grammars (`.cfdg`), versions 2 and 3. Shapes become objects in the plane, rules with
/// weights become alternatives, colours inks. Smaller shapes lie in front, as Context Free paints them later.
Importer cfdg_importer();

} // namespace graftal
