#include "runtime/render/samplings.h"

#include <algorithm>
#include <cmath>

#include "compiler/detail/work.h"

namespace graftal {

namespace {

/// False where the coarsest look is left alone.
bool look_less_closely(std::vector<Sampling>& samplings, int coarsest_block) {
    Sampling& finest = samplings.back();
    if (finest.most_samples > 1) {
        finest.most_samples /= 2;
        return true;
    }
    const int depth = finest.antialias.value_or(1);
    if (depth > 2) {
        --*finest.antialias;
        return true;
    }
    const int block = depth > 1 ? 1 : 2 * finest.block;
    if (block > coarsest_block) return false;
    if (samplings.size() > 1)
        samplings.pop_back();
    else
        finest = {block, {}};
    return true;
}

} // namespace

std::vector<Sampling> samplings_of(std::optional<int> antialias, bool progressive) {
    std::vector<Sampling> all;
    if (progressive)
        for (const int block : {8, 4, 2, 1})
            all.push_back({block, {}});
    if (antialias || !progressive) all.push_back({1, antialias});
    return all;
}

std::vector<Sampling> samplings_of_soft_light(int most_samples, double noise_255, bool progressive) {
    std::vector<Sampling> all;
    if (progressive) {
        for (const int block : {8, 4, 2})
            all.push_back({.block = block});
        for (int samples = 1; samples < most_samples; samples *= 4)
            all.push_back({.most_samples = samples});
    }
    all.push_back({.most_samples = most_samples, .noise_255 = noise_255});
    return all;
}

std::optional<Sampling> draft_before(const Sampling& first, double seconds_a_sample, double seconds) {
    constexpr int coarsest_block = 16;
    Sampling draft = first;
    while (draft.samples_a_pixel() * seconds_a_sample > seconds && draft.block < coarsest_block)
        draft = {.block = 2 * draft.block};
    return draft.block > first.block ? std::optional(draft) : std::nullopt;
}

SampleGoal sample_goal(Quality quality) {
    return by_quality<SampleGoal>(quality, {16, 6}, {64, 3}, {1024, 1});
}

double samples_a_pixel(const std::vector<Sampling>& samplings) {
    double sum = 0;
    for (const Sampling& sampling : samplings)
        sum += sampling.samples_a_pixel();
    return sum;
}

double least_seconds(const std::vector<Sampling>& samplings, ImageSize size) {
    return samples_a_pixel(samplings) * size.width * size.height / WorkRates::samples;
}

std::vector<Sampling> with_fewer_samples(std::vector<Sampling> samplings, ImageSize size, double seconds) {
    while (least_seconds(samplings, size) > seconds && look_less_closely(samplings, 1)) {
    }
    return samplings;
}

std::vector<Sampling> with_more_samples(std::vector<Sampling> samplings, const Sampling& wanted,
                                        double seconds_a_sample, double seconds) {
    const double coarse = samples_a_pixel(samplings) - samplings.back().samples_a_pixel();
    const double most = std::clamp(std::floor(seconds / seconds_a_sample - coarse), 0.0,
                                   static_cast<double>(wanted.most_samples));
    samplings.back().most_samples = std::max(samplings.back().most_samples, static_cast<int>(most));
    return samplings;
}

std::vector<Sampling> within_seconds(std::vector<Sampling> samplings, double seconds_a_sample,
                                     double seconds) {
    while (seconds_a_sample * samples_a_pixel(samplings) > seconds && look_less_closely(samplings, 8)) {
    }
    return samplings;
}

} // namespace graftal
