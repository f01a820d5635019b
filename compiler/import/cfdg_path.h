#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/import/cfdg_evaluator.h"
#include "compiler/import/cfdg_outline.h"

namespace graftal::cfdg {

/// What a command of a path draws.
struct PathPart {
    std::vector<Polygon> polygons;
    Change change;
    Span span;
};

/// Follows a path under the values of its parameters. Nothing after an error.
std::optional<std::vector<PathPart>> follow(const Shape& path, const Surroundings& at,
                                            const ForeignFile& file, const Grammar& grammar,
                                            Evaluator& evaluator);

} // namespace graftal::cfdg
