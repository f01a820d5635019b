#include "runtime/render/samplings.h"

#include "compiler/detail/work.h"

namespace graftal {

namespace {

/// False where the coarsest look is left alone.
bool look_less_closely(std::vector<Sampling>& samplings, int coarsest_block) {
    Sampling& finest = samplings.back();
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

std::vector<Sampling> within_seconds(std::vector<Sampling> samplings, double seconds_a_sample,
                                     double seconds) {
    while (seconds_a_sample * samples_a_pixel(samplings) > seconds && look_less_closely(samplings, 8)) {
    }
    return samplings;
}

} // namespace graftal
