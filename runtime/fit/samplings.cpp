#include "runtime/fit/samplings.h"

#include <algorithm>
#include <cmath>

#include "compiler/detail/work.h"

namespace graftal {

namespace {

/// Octaves of error for an octave of samples: of light through four samples or more, below, and of edges.
constexpr double loss_of_light = 0.15, loss_of_last_light = 0.4, loss_of_edges = 0.35;
/// Octaves of error for an octave of a block's width.
constexpr double loss_of_pixels = 1.3;
constexpr double enough_light = 4; // samples
/// Samples that are worth a denoised one.
constexpr double worth_of_denoising = 2;

} // namespace

SampleGoal sample_goal(Quality quality) {
    return by_quality<SampleGoal>(quality, {16, 6}, {64, 3}, {1024, 1});
}

std::vector<Sampling> looks_before(const Sampling& finest, double seconds_a_sample, double soon_seconds) {
    constexpr int coarsest = 16;
    constexpr double small_share = 0.1;
    const double samples = finest.samples_a_pixel();
    std::vector<Sampling> looks;
    if (samples * seconds_a_sample <= soon_seconds) return looks;
    for (int block = coarsest; block > finest.block; block /= 2) {
        const double taken = 1.0 / (block * block);
        if (taken > small_share * samples) break;
        // Whatever is coarser than one that is soon there comes too late to be of use.
        if (block < coarsest && taken * seconds_a_sample <= soon_seconds) looks.clear();
        looks.push_back({.block = block});
    }
    return looks;
}

double least_seconds(const Sampling& sampling, ImageSize size) {
    return sampling.samples_a_pixel() * size.width * size.height / WorkRates::samples;
}

Sampling affordable_sampling(const Sampling& wanted, double samples) {
    if (samples >= wanted.cost_in_samples()) return wanted;
    if (samples >= 2 || (samples >= 1 && wanted.most_samples > 0)) {
        Sampling fewer = wanted;
        fewer.antialias.reset();
        fewer.most_samples = static_cast<int>(std::min(samples, wanted.samples_a_pixel()));
        while (fewer.feature_rays() > 0 && fewer.cost_in_samples() > samples)
            --fewer.most_samples;
        if (fewer.feature_rays() > 0) return fewer;
        for (Sampling thin{.most_samples = 2, .noise_255 = wanted.noise_255, .denoise = true, .sparse = 2};
             wanted.denoise && thin.sparse <= 4; thin.sparse *= 2)
            if (thin.cost_in_samples() <= samples) return thin;
        fewer.denoise = false;
        fewer.most_samples = static_cast<int>(samples);
        return fewer;
    }
    if (samples >= 1) return {};
    const double width = std::ceil(std::sqrt(1 / std::max(samples, 1e-9)) - 1e-9);
    return {.block = static_cast<int>(std::min<double>(width, coarsest_block))};
}

double loss_of_samples(const Sampling& wanted, const Sampling& had) {
    const double want = wanted.samples_a_pixel();
    double have = had.samples_a_pixel();
    if (wanted.denoise && !had.denoise) have /= worth_of_denoising;
    const double in_pixel = std::max(have, 1.0);
    const double loss_of_block = loss_of_pixels * std::log2(had.block);
    if (!(want > in_pixel)) return loss_of_block;
    if (wanted.most_samples == 0) return loss_of_edges * std::log2(want / in_pixel) + loss_of_block;
    const double light = std::log2(want / std::max(in_pixel, std::min(enough_light, want)));
    const double last_light = std::log2(std::min(enough_light, want) / std::min(in_pixel, enough_light));
    return loss_of_light * light + loss_of_last_light * std::max(last_light, 0.0) + loss_of_block;
}

} // namespace graftal
