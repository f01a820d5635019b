#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/session/session.h"
#include "compiler/support/affine.h"

namespace graftal {

/// The maps of a model that a search is to begin with; none if `path` is empty. Nothing comes back, and
/// `compilation` says why, for a model that is no ordinary iterated function system without condensation, of
/// at most `most_maps` maps; nor for maps that are not `flat`, if they are to be.
std::optional<std::vector<Affine>> starting_maps(const std::string& path, const StageOptions& options,
                                                 std::size_t most_maps, bool flat, Compilation& compilation);

} // namespace graftal
