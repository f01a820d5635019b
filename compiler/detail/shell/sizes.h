#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace graftal {

/// The details of its diameter at which a node is drawn as its shell (shell.h): where it is crowded itself,
/// and not only some small part of it, and not too large for one. Of larger ones the parts are drawn, up to
/// `parted`, from where a ray would meet too many of them.
struct ShellSizes {
    std::uint32_t octaves = 0; ///< bit i: details from 2^i to 2^(i + 1)
    double parted = std::numeric_limits<double>::infinity();

    bool any() const { return octaves != 0 || parted < std::numeric_limits<double>::infinity(); }
    bool has(double detail) const {
        if (detail > parted) return true;
        const int octave = std::ilogb(detail);
        return octave >= 0 && octave < 32 && (octaves >> octave & 1) != 0;
    }
};

/// True if this number of leaves cannot all lie side by side in a set of this detail across.
bool is_crowded(double leaves, double detail, bool flat);

} // namespace graftal
