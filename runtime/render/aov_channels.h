#pragma once

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/scene/scene.h"
#include "runtime/image_files/image_files.h"
#include "runtime/trace/aovs.h"

namespace graftal {

/// The channels of an EXR for AOVs, as docs/native.md describes them: A, coverage, Z, normal.X, normal.Y,
/// normal.Z, albedo.R, albedo.G, albedo.B, id, levels and those of mattes. The tag `graftal:ids` names the
/// objects that are seen, one "NUMBER NAME" a line. Without `alpha` there is no A, for the picture has it.
/// Requires mattes, and the graph and view that the picture was made of.
MoreChannels aov_channels(const AovPicture& aovs, const DetailGraph& cut, const View& view,
                          bool alpha = true);

} // namespace graftal
