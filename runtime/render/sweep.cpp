#include "runtime/render/sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graftal {

void add_sweep(std::vector<Sweep>& sweeps, Sweep sweep) {
    drop_sweep(sweeps, sweep.name);
    sweeps.push_back(std::move(sweep));
}

void drop_sweep(std::vector<Sweep>& sweeps, const std::string& name) {
    std::erase_if(sweeps, [&](const Sweep& sweep) { return sweep.name == name; });
}

double swept(double from, double to, double t) {
    return (1 - t) * from + t * to;
}

Vec3 swept(Vec3 from, Vec3 to, double t) {
    return (1 - t) * from + t * to;
}

double swept_by_factor(double from, double to, double t) {
    if (t == 0 || t == 1) return t == 0 ? from : to;
    return std::exp(swept(std::log(from), std::log(to), t));
}

std::uint64_t swept_whole(std::uint64_t from, std::uint64_t to, double t) {
    if (t >= 1) return to;
    const std::uint64_t way = std::max(from, to) - std::min(from, to);
    const auto done = std::min(way, static_cast<std::uint64_t>(t * (static_cast<double>(way) + 1)));
    return from <= to ? from + done : from - done;
}

double swept_by_steps(double from, double to, double step, double t) {
    constexpr double most = 1e9, rounding = 1e-9;
    const double count = std::min(std::floor(std::abs(to - from) / step + rounding), most);
    const auto done = static_cast<double>(swept_whole(0, static_cast<std::uint64_t>(count), t));
    return from <= to ? from + done * step : from - done * step;
}

double swept_by_keys(const std::vector<SweepKey>& keys, double t) {
    const auto after = std::ranges::find_if(keys, [&](const SweepKey& key) { return key.t > t; });
    if (after == keys.begin()) return keys.front().value;
    if (after == keys.end()) return keys.back().value;
    const SweepKey &a = after[-1], &b = *after;
    return swept(a.value, b.value, (t - a.t) / (b.t - a.t));
}

double eased(Ease ease, double t) {
    return ease == Ease::smooth ? t * t * (3 - 2 * t) : t;
}

} // namespace graftal
