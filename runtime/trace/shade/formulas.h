#pragma once

#include "compiler/support/formula_words.h"

namespace graftal::formulas {
#include "runtime/trace/shade/formulas.glsl"
} // namespace graftal::formulas
