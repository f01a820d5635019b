#pragma once

#include <optional>
#include <string>

#include "compiler/import/importer.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// Parameters of the node, with the values that a new node has.
struct HoudiniSystem {
    double angle_deg = 28, angle_scale = 0.9;
    double step = 0.1, step_scale = 0.9;
    double thickness_scale = 0.9;
    std::optional<double> thickness;
    double gravity = 10;
    LSystem system; ///< whose expressions are ours
};

/// The model between its places in the file; nothing after an error.
std::optional<HoudiniSystem> read_houdini(const ForeignFile& file, const ForeignModel& model);

/// The system as a model of ours; of no use after an error.
Translation write_houdini(const ForeignFile& file, const ForeignModel& model, HoudiniSystem system);

} // namespace graftal
