#pragma once

#include "compiler/lower/language.h"

namespace graftal {

/// `.lsys`: L-systems (docs/language.md).
Language lsys_language();

} // namespace graftal
