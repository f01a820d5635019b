#pragma once

#include "compiler/lower/language.h"

namespace graftal {

/// `.rifs`: recurrent iterated function systems, and orbits (docs/language.md).
Language rifs_language();

} // namespace graftal
