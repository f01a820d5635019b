#pragma once

#include "compiler/graph/graph.h"

namespace graftal {

/// A point of a canonical primitive that is farthest along `direction`. Not for planes.
Vec3 primitive_support_point(PrimitiveKind kind, Vec3 direction);

} // namespace graftal
