#pragma once

// Parts that stay meshes of their own, such as the leaves of a tree, so that whoever reads a file may
// replace, hide and count them.

#include <optional>
#include <string>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/unfolded/scene.h"

namespace graftal {

/// Lays the parts that bear one of these names, or NAME.ANYTHING, beside all else: the root of `scene` then
/// holds the rest without them, and unions of nothing but them. A named part within a named one belongs to
/// that. The name `*` asks for all objects: what each draws itself is a part then, apart from the objects
/// that it places. Equal nodes become one before, so that a named part is one mesh for each of its looks and
/// finenesses. Each leaf keeps its place and its look. Says by node which ones are such parts; nothing, after
/// an error at `model`, for a name that no part has.
std::optional<std::vector<bool>> hold_parts(UnfoldedScene& scene, const std::vector<std::string>& names,
                                            Span model, Diagnostics& diagnostics);

} // namespace graftal
