#pragma once

#include <optional>
#include <vector>

#include "compiler/scene/scene.h"
#include "runtime/trace/sampling.h"

namespace graftal {

/// Goal of a quality: the most samples of a pixel, and the noise that is left.
struct SampleGoal {
    int most_samples = 0;
    double noise_255 = 0;
};
SampleGoal sample_goal(Quality quality);

/// Coarse looks that come before the finest one: each at blocks half as wide as those before it. They take
/// only a small share of what it takes, and the first about `soon_seconds` of one processor.
/// `seconds_a_sample`: of a picture with one sample a pixel. No look where the finest is there as soon.
std::vector<Sampling> looks_before(const Sampling& finest, double seconds_a_sample, double soon_seconds);

/// Seconds of one processor for samples that meet nothing: no coarser model takes less.
double least_seconds(const Sampling& sampling, ImageSize size);

/// The finest sampling up to `wanted` that costs at most `samples` a pixel. Below one, pixels share samples
/// in blocks, of coarsest_block pixels a side at most. Samples that are too few to be denoised are not.
Sampling affordable_sampling(const Sampling& wanted, double samples);
inline constexpr int coarsest_block = 8;

/// Loss of a picture with `had` against `wanted`, in octaves of the size of what is left out: 1 is as bad as
/// missing parts twice as large. Grows evenly as samples go. Noise is better than missing parts, and these
/// are better than missing pixels.
double loss_of_samples(const Sampling& wanted, const Sampling& had);

} // namespace graftal
