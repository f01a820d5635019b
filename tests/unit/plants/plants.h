#pragma once

#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "compiler/lower/plant.h"
#include "runtime/plants/plant_of_model.h"
#include "runtime/plants/plant_tree.h"

namespace graftal::test {

/// The plant of an L-system, and the light on it.
struct LitPlant {
    std::shared_ptr<const Plant> plant;
    std::optional<PlantLight> light;
    std::string messages;

    double at(std::size_t module) const { return static_cast<double>(light->organs.at(module).light); }
    double error(std::size_t module) const { return static_cast<double>(light->organs.at(module).error); }
};

/// A model with these statements before the block, and these in it. All is of a material `leaf` that they
/// have.
inline std::string plant_text(const std::string& statements, const std::string& block) {
    const bool has_leaf = statements.find("material leaf") != std::string::npos;
    return statements + "\nlsys a {\n width 0.1\n steps 0\n" + (has_leaf ? " colors leaf\n " : " ") + block +
           "\n}\n";
}

inline std::shared_ptr<const Plant> plant_of(const std::string& text) {
    PictureSession session("m.lsys");
    session.edit(text);
    Compilation compilation;
    auto plant = plant_of_model(session, {}, "no plant", compilation);
    EXPECT_TRUE(plant) << compilation.diagnostics.render(compilation.sources);
    return plant;
}

/// Lights the plant with so many samples of each organ, or nothing as commands do, unless `work_seconds` are
/// too few. `exact`: as --exact derives it.
inline LitPlant lit(const std::string& text, std::optional<int> samples, int threads = 1,
                    double work_seconds = 1000, bool exact = false) {
    PictureSession session("m.lsys");
    session.edit(text);
    Compilation compilation;
    RenderOptions options;
    options.threads = threads;
    options.compile.lower.exact = exact;
    LitPlant found;
    found.plant = plant_of_model(session, options.compile, "no plant", compilation);
    if (found.plant)
        found.light = light_of_model(session, options, *found.plant, {samples, work_seconds}, compilation);
    found.messages = compilation.diagnostics.render(compilation.sources);
    return found;
}

/// A module that draws a square with sides of `side`, whose first corner is where the turtle stands; it lies
/// in the plane of the heading and the left.
inline std::string square(double side) {
    const std::string f = "f(" + std::to_string(side) + ")";
    return "{." + f + "+(90)" + f + "+(90)" + f + "}";
}

} // namespace graftal::test
