#pragma once

#include <vector>

#include "compiler/session/stages.h"
#include "runtime/graftal/model.h"

namespace graftal::v1 {

/// All that was said about a model, in words of the library, the status last.
std::vector<Message> messages_of(const Compilation& compilation);

} // namespace graftal::v1
