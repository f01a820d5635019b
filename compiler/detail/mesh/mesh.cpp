#include "compiler/detail/mesh/mesh.h"

namespace graftal {

Box box_of(const Mesh& mesh) {
    Box box;
    for (const Vec3& vertex : mesh.vertices)
        box.include(vertex);
    return box;
}

} // namespace graftal
