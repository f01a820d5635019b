#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal::cfdg {

/// The steps by which a tile repeats, columns of `linear`; one is 0 in a frieze, both are 0 without a tile.
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

/// Reads lists such as `CF::Dihedral, 5, 30, CF::p2`: words, each with its numbers behind it.
class SymmetryReader {
  public:
    /// The maps are added to `maps`; `fail` is told of symmetries that are not there. `maps` must outlive
    /// this.
    SymmetryReader(const Lattice& lattice, std::vector<Affine>& maps,
                   std::function<void(const std::string&)> fail)
        : lattice_(lattice), maps_(maps), fail_(std::move(fail)) {}

    void begin(const std::string& word);
    /// False if no word is open.
    bool add(const std::vector<double>& numbers);
    /// Takes the symmetry that is open, if one is.
    void end();

  private:
    Lattice lattice_;
    std::vector<Affine>& maps_;
    std::function<void(const std::string&)> fail_;
    std::string word_;
    std::vector<double> numbers_;
};

} // namespace graftal::cfdg
