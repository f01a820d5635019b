#pragma once

#include <functional>
#include <optional>
#include <string>

#include "compiler/session/session.h"
#include "runtime/inverse/colours.h"
#include "runtime/inverse/search.h"
#include "runtime/points/target_picture.h"

namespace graftal {

struct FindOptions {
    std::string target; ///< a picture
    TargetCriterion criterion;
    SearchOptions search;
    bool occupancy = false; ///< by search_occupancy(): the same cells; else by search()
    bool in_colour = false; ///< gives each map a tint, too
    std::string start;      ///< a model to begin with, in the frame of found models; "": none
    StageOptions compile;   ///< of that model
    std::string made_by;    ///< the command line, for the model's comment
    int threads = 0;        ///< 0: one a processor
    std::function<void(const SearchProgress&)> on_progress;
};

/// A model whose attractor is near the target, and how near. The picture is one unit wide, and its lower left
/// corner is <0, 0>. Distances are in cells.
struct FoundModel {
    std::string text; ///< `.rifs`
    PlaneMaps maps;   ///< in the model's units, as the text has them
    SetAgreement agreement;
    std::optional<SystemColours> colours; ///< where they were asked for
    double contractivity = 0;             ///< below 1, by the singular values of the maps as they are written
    double epsilon = 0;                   ///< Hausdorff distance of the target from its images
    double bound = 0;                     ///< of the attractor's distance from the target (collage.h)
    double cell = 0;                      ///< in pixels
    std::size_t cells = 0;                ///< of the target
    int width = 0, height = 0;            ///< of the box around the target, in cells
    double seconds = 0;                   ///< of counted work
    bool by_alpha = false;
};

/// The model depends on target, options and seed, not on the number of threads, unless the flag is raised:
/// then it is the best so far. Nothing comes back after errors in `compilation.diagnostics`, or with a failed
/// `compilation.status`. Memory goes with the search, not with the picture.
std::optional<FoundModel> find_model(const FindOptions& options, const CancelFlag& cancel,
                                     Compilation& compilation);

} // namespace graftal
