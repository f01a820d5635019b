#include "runtime/plants/plant_tree.h"

#include <algorithm>

namespace graftal {

namespace {

constexpr std::uint32_t none = PlantModule::none;

/// The segment at whose end stands what follows the module or branches off it.
std::uint32_t segment_after(const Plant& plant, const PlantTree& tree, std::uint32_t module) {
    const PlantModule& row = plant.modules[module];
    if (row.last_part != none) module = row.last_part;
    return is_segment(plant.modules[module]) ? module : tree.bearer[module];
}

void find_strahler(const Plant& plant, PlantTree& tree) {
    const std::size_t count = plant.modules.size();
    std::vector<std::uint16_t> most(count, 0); // of the segments that each one bears
    std::vector<bool> twice(count, false);
    for (std::size_t i = count; i-- > 0;) {
        const PlantModule& module = plant.modules[i];
        if (is_segment(module)) {
            const auto order = static_cast<std::uint16_t>(most[i] == 0 ? 1 : most[i] + (twice[i] ? 1 : 0));
            tree.strahler[i] = order;
            if (const std::uint32_t bearer = tree.bearer[i]; bearer != none) {
                twice[bearer] = order == most[bearer] || (order < most[bearer] && twice[bearer]);
                most[bearer] = std::max(most[bearer], order);
            }
        }
        if (module.part_of != none)
            tree.strahler[module.part_of] = std::max(tree.strahler[module.part_of], tree.strahler[i]);
    }
}

} // namespace

PlantTree tree_of(const Plant& plant) {
    const std::size_t count = plant.modules.size();
    PlantTree tree;
    tree.bearer.assign(count, none);
    tree.strahler.assign(count, 0);
    tree.path.assign(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const PlantModule& module = plant.modules[i];
        if (module.parent != none) tree.bearer[i] = segment_after(plant, tree, module.parent);
        if (tree.bearer[i] != none) tree.path[i] = tree.path[tree.bearer[i]];
        if (is_segment(module)) tree.path[i] += module.length;
    }
    for (std::size_t i = 0; i < count; ++i)
        if (const std::uint32_t last = plant.modules[i].last_part; last != none)
            tree.path[i] = tree.path[last];
    find_strahler(plant, tree);
    return tree;
}

} // namespace graftal
