#pragma once

#include <optional>

#include "compiler/support/diagnostics.h"
#include "runtime/export/exported_scene.h"

namespace graftal {

struct ResolvedLooks {
    ExportedScene scene; ///< every leaf has its look, and no node has a cell
    double grain = 0;    ///< tints are told apart by this share
};

/// A scene whose leaves know how they look, for files where a part looks the same wherever it is placed. A
/// node is there once for each tint and material that it is placed with; tints are told apart by 1/255, or
/// less finely where that makes too many nodes. Nothing if even that is too many.
std::optional<ResolvedLooks> resolve_looks(const ExportedScene& scene, std::size_t most_nodes,
                                           std::size_t most_parts);

/// The same, or an error; warns where tints are coarser.
std::optional<ExportedScene> resolve_looks(const ExportedScene& scene, std::size_t most_nodes, Span model,
                                           Diagnostics& diagnostics);

} // namespace graftal
