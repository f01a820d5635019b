#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Houdini's L-system node, as people publish its parameters: a text of lines such as `Premise: A` and
/// `Rule 1: A=F[+A]`. Other lines are remarks. Each premise begins a model.
Importer houdini_importer();

} // namespace graftal
