#pragma once

#include "runtime/studio/studio_home.h"

namespace graftal {

/// What a studio opens where nobody names a model.
OpenedModel example_model();

} // namespace graftal
