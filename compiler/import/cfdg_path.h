#pragma once

#include <string>
#include <vector>

#include "compiler/import/cfdg_ast.h"
#include "compiler/import/cfdg_expression.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

/// What a path draws: lines of an object, each with the adjustments of its command.
struct PathPart {
    std::vector<std::string> lines;             ///< `instance: polygon(...)`; of a stroke, squares and discs
    const Modification* modification = nullptr; ///< null of a path without commands
};

/// Follows a path whose numbers are known. Nothing after an error.
std::optional<std::vector<PathPart>> follow(const Shape& path, const ForeignFile& file,
                                            const Expressions& expressions);

} // namespace graftal::cfdg
