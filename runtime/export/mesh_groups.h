#pragma once

// Choice of the parts that become one mesh, for formats that share meshes but no unions of them: a list of
// places of shared meshes, as the cut for POV-Ray is.

#include <vector>

#include "compiler/unfolded/scene.h"

namespace graftal {

struct GroupOptions {
    double most_nodes = 30'000;     ///< places of meshes and of what holds them
    double triangles_of_node = 100; ///< cost of a node to a reader, in triangles of a mesh
    std::vector<bool> held;         ///< by node: meshes of their own (held_parts.h); none where it is empty
};

struct MeshGroups {
    std::vector<bool> is_mesh; ///< by node: a mesh wherever it is placed; what is above it are unions
    std::vector<SceneId> meshes;
    double nodes = 0;     ///< places of both
    double triangles = 0; ///< of the meshes, each once
};

/// Opens what leads to held parts, and then the largest meshes first, as long as the nodes suffice; of all
/// states on the way the one that costs least. Only held parts may take more nodes than there may be.
/// Requires resolved looks.
MeshGroups group_meshes(const UnfoldedScene& scene, const GroupOptions& options);

/// Where a mesh lies in the world.
struct MeshPlace {
    SceneId mesh = 0;
    Affine world_from_mesh;
};

/// All of them, in the order of the parts.
std::vector<MeshPlace> places_of(const UnfoldedScene& scene, const MeshGroups& groups);

} // namespace graftal
