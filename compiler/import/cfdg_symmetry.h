#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal::cfdg {

/// What a tile repeats by: columns of `linear`; one of them is 0 in a frieze, both without a tile.
struct Lattice {
    Vec3 across{0.0}, up{0.0};

    bool is_tiled() const { return across != Vec3(0.0) && up != Vec3(0.0); }
    bool is_frieze() const { return (across != Vec3(0.0)) != (up != Vec3(0.0)); }
};

/// The maps of a symmetry of Context Free, such as "CF::Dihedral" with its numbers: all of them up to those
/// of the lattice. Nothing if there is none of this name, or it does not fit the numbers or the lattice;
/// `fault` says why.
std::optional<std::vector<Affine>> symmetry(std::string_view name, const std::vector<double>& numbers,
                                            const Lattice& lattice, std::string& fault);

/// Adds the maps that are not there.
void add_unique(std::vector<Affine>& maps, const std::vector<Affine>& more);

} // namespace graftal::cfdg
