#pragma once

#include <optional>
#include <vector>

#include "compiler/scene/scene.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

/// What a quality asks for: the most samples of a pixel, and the noise that is left.
struct SampleGoal {
    int most_samples = 0;
    double noise_255 = 0;
};
SampleGoal sample_goal(Quality quality);

/// Coarse looks that come before the finest one: each at blocks half as wide as those before it. They take
/// only a small share of what it takes, and the first about `soon_seconds` of one processor.
/// `seconds_a_sample`: of a picture with one sample a pixel. No look where the finest is there as soon.
std::vector<Sampling> looks_before(const Sampling& finest, double seconds_a_sample, double soon_seconds);

/// The samples of one processor that meet nothing take so many seconds: no coarser model takes less.
double least_seconds(const Sampling& sampling, ImageSize size);

/// The finest sampling up to `wanted` that has at most so many samples a pixel. Below one, pixels share
/// samples in blocks, of coarsest_block pixels a side at most.
Sampling affordable_sampling(const Sampling& wanted, double samples_a_pixel);
inline constexpr int coarsest_block = 8;

/// How much worse a picture looks by a sampling than by the one wanted, in octaves of the size of what is
/// left out: 1 is as bad as parts twice as large that are missing. Grows evenly as samples go: noise is
/// better than parts that are missing, and these are better than pixels that are missing.
double loss_of_samples(const Sampling& wanted, const Sampling& had);

} // namespace graftal
