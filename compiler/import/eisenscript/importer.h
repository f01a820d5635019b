#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// EisenScript (`.es`), the language of Structure Synth 1.5. Rules become objects with parameters: the
/// generations that are left where `maxdepth` or `maxobjects` ends the growth, and the counts of rules with a
/// depth of their own. The middle of the cube lies at the origin.
Importer eisenscript_importer();

} // namespace graftal
