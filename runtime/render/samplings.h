#pragma once

#include <optional>
#include <vector>

#include "compiler/scene/scene.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

/// The looks at a picture, from coarse to fine; only the last unless it is `progressive`.
std::vector<Sampling> samplings_of(std::optional<int> antialias, bool progressive);

/// The same for light that is sampled.
std::vector<Sampling> samplings_of_soft_light(int most_samples, double noise_255, bool progressive);

/// A look in blocks that takes about `seconds` of one processor, to be had before the first look: nothing if
/// that takes no more. `seconds_a_sample`: that the samples of a picture take together, one a pixel.
std::optional<Sampling> draft_before(const Sampling& first, double seconds_a_sample, double seconds);

/// What a quality asks for: the most samples of a pixel, and the noise that is left.
struct SampleGoal {
    int most_samples = 0;
    double noise_255 = 0;
};
SampleGoal sample_goal(Quality quality);

/// Of all looks together.
double samples_a_pixel(const std::vector<Sampling>& samplings);

/// Of one processor, for samples that meet nothing: no coarser model takes less.
double least_seconds(const std::vector<Sampling>& samplings, ImageSize size);

/// Takes samples away from the finest look, or the look itself, until `seconds` of one processor are enough
/// for the samples even if they meet nothing. One sample stays for each pixel.
std::vector<Sampling> with_fewer_samples(std::vector<Sampling> samplings, ImageSize size, double seconds);

/// Gives the finest look more samples, as many as it wants at most, while all take no more than `seconds`.
std::vector<Sampling> with_more_samples(std::vector<Sampling> samplings, const Sampling& wanted,
                                        double seconds_a_sample, double seconds);

/// As with_fewer_samples() until all samples take no more than `seconds`, where each of a picture takes so
/// long. One sample stays for each square of 8 by 8 pixels.
std::vector<Sampling> within_seconds(std::vector<Sampling> samplings, double seconds_a_sample,
                                     double seconds);

} // namespace graftal
