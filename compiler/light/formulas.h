#pragma once

#include "compiler/support/formula_words.h"

namespace graftal::formulas {
#include "compiler/light/formulas.glsl"
} // namespace graftal::formulas
