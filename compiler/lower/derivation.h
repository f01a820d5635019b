#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graftal {

/// The members of a model with inner parameters that an L-system placed.
struct FamilyReport {
    std::string model;                   ///< as `~` names it
    std::vector<std::string> parameters; ///< names of the inner ones
    std::size_t used = 0;                ///< different members
    std::size_t possible = 0;            ///< members of the family
    double error = 0;                    ///< largest distance of an argument from the value in its place
};

/// A report of how an L-system was compiled.
struct Derivation {
    std::string way;               ///< "composed" part by part, or "derived" and then shared
    std::optional<unsigned> steps; ///< nothing: infinite
    bool timed = false;            ///< the drawing reads the time
    bool grows = false;            ///< after other steps it may be another
    double time = 0;               ///< the steps, and what share of the next had passed
    std::string modules;           ///< of the word after these steps: decimal, exact
    std::string segments;          ///< drawn segments
    std::size_t parts = 0;         ///< different modules with their steps and states that were composed
    double size_step = 0;       ///< widths relative to a part's size are rounded to steps of this logarithm
    std::uint32_t variants = 1; ///< of each random part
    double drift = 0; ///< relative standard error of the mean number of segments and bodies over the variants
    double error = 0; ///< bound on the displacement of any point
    std::vector<FamilyReport> families; ///< families placed, by name
};

} // namespace graftal
