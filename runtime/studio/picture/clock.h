#pragma once

#include <chrono>

namespace graftal {

/// Seconds of a clock that never goes back, since some time before the program.
inline double clock_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace graftal
