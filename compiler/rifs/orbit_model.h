#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/support/diagnostics.h"
#include "compiler/syntax/expression_code.h"

namespace graftal {

/// A map by formulas: numbers of a point are computed in order, each from x, y, z and those before it.
struct OrbitFormulas {
    std::string name;                  ///< "" if it has none
    std::vector<Expression> sources;   ///< the codes point into these: do not change
    std::vector<ExpressionCode> codes; ///< the map's own names, then the new x, y and z
    std::vector<std::uint32_t> draws;  ///< random numbers that each of the codes takes
    std::size_t all_draws = 0;         ///< their sum
    std::vector<std::string> names;    ///< of all values: x, y, z, then the map's own
    double probability = 1;            ///< relative to the other maps
    Tint tint;
    std::optional<MaterialId> material;
    Span span;
};

/// A point that is mapped again and again, by one map or by several that are chosen at random.
struct OrbitModel {
    std::string name;
    Vec3 start{0.0};
    std::uint64_t skip = 100; ///< points at the beginning that do not count
    /// If above 0, a point that goes astray begins again at random x and y from -restart to restart.
    double restart = 0;
    bool flat = true; ///< z stays 0
    std::vector<OrbitFormulas> maps;
    std::optional<OrbitFormulas> last; ///< from a point to what is shown of it
    /// Factors of the probabilities of the maps after each map, row by row; empty: all are 1. Each row has
    /// something to go on with.
    std::vector<double> follow;
    Environment lets; ///< names of the formulas; for messages
    Graph scene;      ///< its settings and materials; a root that has the maps' colours
    Span span;

    /// Reports that the map cannot be computed at this point by these random numbers: why. `map`: its number;
    /// that behind the last one is `last`.
    void report(std::size_t map, Vec3 point, std::span<const double> draws, Diagnostics& diagnostics) const;
};

/// Farther from the origin an orbit counts as diverging, as in flam3.
inline constexpr double farthest_of_orbit = 1e10;

/// Applies the map; nothing where a formula has no value. `draws`: all_draws uniform numbers of [0, 1).
/// `slots` is for its memory.
std::optional<Vec3> apply(const OrbitFormulas& map, Vec3 point, std::span<const double> draws,
                          std::vector<double>& slots);

} // namespace graftal
