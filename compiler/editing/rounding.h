#pragma once

#include <cmath>

namespace graftal {

/// The value with so many decimals; as it is where doubles have no more.
inline double rounded(double value, int decimals) {
    constexpr double most = 1e15;
    const double power = std::pow(10.0, decimals);
    return std::abs(value) * power < most ? std::round(value * power) / power : value;
}

/// The fewest decimals whose rounding is `unseen(off)`: nobody sees a number change by `off`.
template<typename Unseen> int decimals_for(const Unseen& unseen) {
    constexpr int most = 17;
    int decimals = 0;
    for (double off = 0.5; decimals < most && !unseen(off); off /= 10)
        ++decimals;
    return decimals;
}

} // namespace graftal
