#pragma once

#include <cstddef>

namespace graftal {

/// The prices of units of counted work, in seconds of one processor of 2024. Work before a picture is
/// counted by these, not timed, so that a model is refused on all machines or on none.
struct StagePrice {
    // Lowering
    static constexpr double word = 1e-7;          ///< of a text, each time that it is read to make an object
    static constexpr double module = 5e-8;        ///< of an L-system, each time that one is looked at
    static constexpr double new_module = 2e-7;    ///< with parameters that none before it has
    static constexpr double drawn_module = 4e-7;  ///< by itself, into a run
    static constexpr double part = 4e-6;          ///< composed of modules
    static constexpr double part_instance = 3e-7; ///< of such a part
    static constexpr double random_part = 6e-5;   ///< of a random model, until it is bounded
    static constexpr double draw = 5e-8;          ///< a random number
    static constexpr double copied_object = 5e-6; ///< such as one under another hue
    static constexpr double copied_instance = 1.5e-6; ///< of such an object
    // Zooms
    static constexpr double name = 5e-8; ///< of an instance, compared with a step of an address
    static constexpr double near = 7e-7; ///< a step down a zoom, or a part near it that is looked at
    // Checks, passes and strong components, all together
    static constexpr double object = 1.2e-5;
    static constexpr double instance = 8e-7;
    // Analysis
    static constexpr double instance_again = 4e-7; ///< classed by its shape
    static constexpr double cycle_edge = 4e-7;     ///< of a component that is proved to contract
    static constexpr double piece = 1.2e-7;        ///< that may reach farthest, or holds a ball up
    // Preparation
    static constexpr double body = 5e-7; ///< drawn into a shadow, to find what stands for an object
};

/// Work of the checks and passes of a graph.
constexpr double work_of_graph(std::size_t objects, std::size_t instances) {
    return StagePrice::object * static_cast<double>(objects) +
           StagePrice::instance * static_cast<double>(instances);
}

/// Work of making a graph ready to be unfolded: passes of its own, with checks, symmetry and colours.
constexpr double work_of_preparation(std::size_t objects, std::size_t instances) {
    return 3 * work_of_graph(objects, instances);
}

} // namespace graftal
