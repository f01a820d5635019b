#pragma once

#include "runtime/studio/studio_home.h"

namespace graftal {

/// The model that a studio opens where nobody names one.
OpenedModel example_model();

} // namespace graftal
