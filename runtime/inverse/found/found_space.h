#pragma once

#include <functional>
#include <optional>
#include <string>

#include "compiler/session/session.h"
#include "runtime/inverse/search.h"

namespace graftal {

struct FindSpaceOptions {
    std::string target; ///< is_mesh_name(): a cloud of points or a mesh, whose surface counts
    SearchOptionsOf<SpaceMap> search;
    std::string start;    ///< a model to begin with, in the target's coordinates; "": none
    StageOptions compile; ///< of that model
    std::string made_by;  ///< the command line, for the model's comment
    int threads = 0;      ///< 0: one a processor
    std::function<void(const SearchProgress&)> on_progress;
};

/// A model in space, in the coordinates of the target that its attractor is near, and how near. Distances are
/// in cells.
struct FoundSpaceModel {
    std::string text; ///< `.rifs`
    SpaceMaps maps;   ///< in the target's coordinates, as the text has them
    SetAgreement agreement;
    double contractivity = 0;             ///< below 1, by the singular values of the maps as they are written
    double epsilon = 0;                   ///< Hausdorff distance of the target from its images
    double bound = 0;                     ///< of the attractor's distance from the target (points/collage.h)
    double cell = 0;                      ///< in the target's units
    std::size_t cells = 0;                ///< of the target
    int width = 0, height = 0, depth = 0; ///< of the box around the target, in cells
    std::size_t points = 0, triangles = 0; ///< of the file; without triangles it is a cloud
    double seconds = 0;                    ///< of counted work
};

/// The model depends on target, options and seed, not on the number of threads, unless the flag is raised:
/// then it is the best so far. Nothing comes back after errors in `compilation.diagnostics`, or with a failed
/// `compilation.status`.
std::optional<FoundSpaceModel> find_space_model(const FindSpaceOptions& options, const CancelFlag& cancel,
                                                Compilation& compilation);

} // namespace graftal
