#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/import/cfdg/evaluate/evaluator.h"
#include "compiler/import/cfdg/paths/outline.h"

namespace graftal::cfdg {

/// The drawing of one command of a path.
struct PathPart {
    std::vector<Polygon> polygons;
    Change change;
    Span span;
    bool of_world = false; ///< it depends on how its place stretches: a stroke of CF::IsoWidth
};

/// Follows a path under the values of its parameters, at its place in the picture. Nothing after an error.
std::optional<std::vector<PathPart>> follow(const Shape& path, const Surroundings& at, const Affine& world,
                                            const ForeignFile& file, const Grammar& grammar,
                                            Evaluator& evaluator);

} // namespace graftal::cfdg
