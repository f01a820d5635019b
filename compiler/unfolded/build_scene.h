#pragma once

#include "compiler/detail/detail_options.h"
#include "compiler/detail/prepare.h"
#include "compiler/unfolded/scene.h"

namespace graftal {

/// Fineness of the meshes of curved surfaces.
enum class SceneMeshes {
    by_size, ///< each leaf by its own size: for flat files, whose triangles count
    shared,  ///< one mesh a primitive, where nothing is culled: for files that share it
};

struct SceneLimits {
    std::size_t nodes = 2'000'000;
    std::size_t parts = 8'000'000;
};

/// Unfolds a prepared graph as far as nodes differ: in their object, their levels and, where parts are culled
/// for their size, in the size that they are seen at. A node that is seen at sizes that differ (the camera is
/// near) is not shared, until its parts are. Nothing, after an error, beyond the limits.
///
/// `detail`: resolved. Its error is a length on the picture, coarser out of it as for pictures, or the same
/// length everywhere (error_world). Without culling it still says how finely surfaces are meshed.
std::optional<UnfoldedScene> build_scene(const PreparedGraph& prepared, const View& view,
                                         const DetailOptions& detail, SceneMeshes meshes, Span model,
                                         const SceneLimits& limits, const Control& control,
                                         Diagnostics& diagnostics);

} // namespace graftal
