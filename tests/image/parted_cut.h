#pragma once

#include "compiler/povray/cut/compile.h"

namespace graftal {

/// The model cut anew, with culling off: pieces of up to `mesh_triangles` triangles become meshes, larger
/// ones placements of their parts. 0 makes every leaf a placement of its own, infinity the whole one mesh.
CompiledModel parted_at(const CompiledModel& model, double mesh_triangles);

} // namespace graftal
