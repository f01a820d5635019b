#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal {

/// A module of a derived word, as a part of a plant: a letter of the model's own, or one that draws.
struct PlantModule {
    static constexpr std::uint32_t none = UINT32_MAX;

    std::uint16_t name = 0; ///< among Plant::names
    std::vector<double> parameters;
    std::uint32_t parent = none; ///< the module that bears it; none of the first
    bool branches = false;       ///< it begins a branch of its parent; else it follows it on the same axis
    std::uint32_t order = 0;     ///< of its axis: 0 of the main one, 1 of its branches
    std::uint32_t rank = 0;      ///< place on its axis, from 0 on
    Vec3 start{0.0}, end{0.0};   ///< where the turtle stands before and after it, in the model's units
    Vec3 heading{0.0};           ///< unit vector, before it
    double width = 0;            ///< diameter of segments after it; 0: the model leaves that to graftal
    std::int64_t age = -1;       ///< steps since it came into being; -1: no rule of the model asks for ages
};

/// The structure of a plant: modules in the order of the word, so that parents come before what they bear.
struct Plant {
    std::vector<std::string> names;
    std::vector<PlantModule> modules;
    unsigned steps = 0; ///< of the derivation
};

} // namespace graftal
