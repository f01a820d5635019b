#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "compiler/session/stage_options.h"

namespace graftal {

/// Something that runs from one value to another while an animation plays.
struct Sweep {
    std::string name; ///< of the running value, e.g. "--set k"
    /// Sets what it has come to at t in [0, 1]; returns the command line's words for that, e.g. "--set
    /// k=0.5".
    std::function<std::string(double t, StageOptions& options)> apply;
};

/// Replaces the sweep of the same name, or adds one.
void add_sweep(std::vector<Sweep>& sweeps, Sweep sweep);
void drop_sweep(std::vector<Sweep>& sweeps, const std::string& name);

// From the first value at t = 0 to the second at t = 1, both exactly (but see swept_by_steps).

double swept(double from, double to, double t);
Vec3 swept(Vec3 from, Vec3 to, double t);
/// A value on the way by equal factors in equal times. Requires positive values.
double swept_by_factor(double from, double to, double t);
/// All whole numbers on the way, each for an equal part of the time.
std::uint64_t swept_whole(std::uint64_t from, std::uint64_t to, double t);
/// `from` and all that lie a whole number of steps from it on the way, each for an equal part of the time.
double swept_by_steps(double from, double to, double step, double t);

/// A value that runs evenly from one key to the next: before the first and after the last it stays. Requires
/// keys, by their times.
struct SweepKey {
    double t = 0;
    double value = 0;
};
double swept_by_keys(const std::vector<SweepKey>& keys, double t);

/// Course of time on the way.
enum class Ease {
    linear,
    smooth, ///< slow at both ends: t^2 (3 - 2 t)
};

double eased(Ease ease, double t);

} // namespace graftal
