#pragma once

#include "compiler/analysis/bounding.h"
#include "compiler/support/control.h"

namespace graftal {

/// bound_objects() under a control, which follows the pieces that the search for box faces looks at, and is
/// asked after each face.
std::vector<ObjectBounds> bound_objects(const Graph& graph, const Components& components,
                                        const Contraction& contraction, const Control& control,
                                        std::uint64_t* pieces = nullptr);

} // namespace graftal
