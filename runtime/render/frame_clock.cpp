#include "runtime/render/frame_clock.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace graftal {

void FrameClock::add(double seconds) {
    constexpr std::size_t most = 10;
    recent_.push_back(seconds);
    if (recent_.size() > most) recent_.pop_front();
}

std::optional<double> FrameClock::seconds_left(std::size_t frames) const {
    if (recent_.empty()) return std::nullopt;
    const double sum = std::accumulate(recent_.begin(), recent_.end(), 0.0);
    return sum / static_cast<double>(recent_.size()) * static_cast<double>(frames);
}

std::string duration_text(double seconds) {
    const long whole = std::lround(std::clamp(seconds, 0.0, 1e9));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

} // namespace graftal
