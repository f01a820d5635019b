#include "runtime/trace/intersect.h"

namespace graftal {

bool intersect(PrimitiveKind, const Ray&, const RayRange&, PrimitiveHit&) {
    return false;
}

} // namespace graftal
