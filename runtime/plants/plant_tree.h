#pragma once

#include <cstdint>
#include <vector>

#include "compiler/lower/plant.h"

namespace graftal {

/// The tree of a plant's segments. All vectors have an entry for each module of the plant.
struct PlantTree {
    /// The segment that bears the module, or that it follows; PlantModule::none: it stands at the root.
    std::vector<std::uint32_t> bearer;
    /// Strahler's order of a segment (Strahler 1957, "Quantitative analysis of watershed geomorphology"): 1
    /// of one that bears no segment; else the largest of those that it bears, and one more where that is
    /// there twice. A module that is drawn as several segments has the largest of theirs; others have 0.
    std::vector<std::uint16_t> strahler;
    /// The length of segments from the root to the end of the module.
    std::vector<double> path;
};

/// O(modules).
PlantTree tree_of(const Plant& plant);

} // namespace graftal
