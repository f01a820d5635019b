#pragma once

#include "compiler/lower/language.h"

namespace graftal {

/// `.inst`: Hart's textual instancing language, and the text form of graphs (docs/language.md).
Language inst_language();

} // namespace graftal
