#include "runtime/trace/denoise.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "compiler/support/counter_random.h"
#include "runtime/image/develop.h"

namespace graftal {
namespace {

constexpr int width = 150, height = 110; // more than one tile each way

/// A picture whose light is known, sampled with noise.
struct Sampled {
    std::vector<NoiseMeter> samples;
    std::vector<PixelFeatures> features;
    std::vector<Rgb> light;

    /// `light_at`: of a pixel, by its features; each sample is that times 2 u, of u in [0, 1).
    Sampled(int count, const std::function<PixelFeatures(int, int)>& features_at,
            const std::function<Rgb(int, int, const PixelFeatures&)>& light_at, double noise = 1) {
        const CounterRandom random(7);
        std::uint64_t draw = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                features.push_back(features_at(x, y));
                light.push_back(light_at(x, y, features.back()));
                NoiseMeter meter;
                for (int i = 0; i < count; ++i)
                    meter.add(light.back() * (1 + noise * (2 * CounterRandom::unit(random(draw++)) - 1)));
                samples.push_back(meter);
            }
    }

    Denoised denoised(const Workers& workers = SerialWorkers()) const {
        return denoise(samples, features, width, height, {}, workers);
    }

    /// Root of the mean squared error as a film shows it, of 255.
    double error_of(const std::function<Rgb(std::size_t)>& shown) const {
        double sum = 0;
        for (std::size_t i = 0; i < light.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double off = 255 * (developed(shown(i)[c], {}) - developed(light[i][c], {}));
                sum += off * off / 3;
            }
        return std::sqrt(sum / static_cast<double>(light.size()));
    }
    double error_of_mean() const {
        return error_of([&](std::size_t i) { return samples[i].mean(); });
    }
    double error_of_denoised() const {
        const Denoised clean = denoised();
        return error_of([&](std::size_t i) {
            const float* rgb = &clean.picture.pixels[3 * i];
            return Rgb(rgb[0], rgb[1], rgb[2]);
        });
    }
};

/// Three that take the last task first.
class Backwards : public Workers {
  public:
    int count() const override { return 3; }
    int for_each(std::uint64_t tasks, const std::function<void(int, std::uint64_t)>& work) const override {
        for (std::uint64_t i = tasks; i-- > 0;)
            work(static_cast<int>(i % 3), i);
        return 3;
    }
};

/// A wall with stripes of paint, and a hole that shows the sky.
PixelFeatures wall(int x, int y) {
    if (x > 60 && x < 90 && y > 30 && y < 70) return {};
    const float paint = x / 7 % 2 == 0 ? 0.8f : 0.3f;
    return {1, paint, 0.5f, 0.2f, 0, 0, 1, 0.01f * static_cast<float>(x), 0};
}

Rgb linear(int, int, const PixelFeatures& f) {
    if (f[0] == 0) return Rgb(0.6);
    return {0.5 * static_cast<double>(f[1]), 0.5 * static_cast<double>(f[2]),
            0.1 + 0.3 * static_cast<double>(f[7])};
}

TEST(Denoise, LightThatFollowsTheFeaturesLosesMostOfItsNoise) {
    for (const int count : {2, 4, 8, 32}) {
        const Sampled sampled(count, wall, linear);
        EXPECT_LT(sampled.error_of_denoised(), 0.3 * sampled.error_of_mean()) << count;
    }
}

TEST(Denoise, DetailThatNoFeatureShowsStays) {
    // A pattern of single pixels on an even wall: an average would be 20 times worse than the samples.
    const auto plain = [](int, int) { return PixelFeatures{1, 0.5f, 0.5f, 0.5f, 0, 0, 1, 1, 0}; };
    const auto pixels = [](int x, int y, const PixelFeatures&) {
        return Rgb((x * 7 + y * 3) % 5 < 2 ? 0.6 : 0.2);
    };
    for (const int count : {4, 16, 64}) {
        const Sampled sampled(count, plain, pixels, 0.2);
        EXPECT_LT(sampled.error_of_denoised(), 1.05 * sampled.error_of_mean()) << count;
    }
}

TEST(Denoise, ErrorsThatAreToldAreThoseThatAreLeft) {
    for (const int count : {4, 16}) {
        const Sampled sampled(count, wall, linear);
        double squares = 0;
        const Denoised clean = sampled.denoised();
        for (const float error : clean.errors_255)
            squares += static_cast<double>(error) * static_cast<double>(error);
        const double told = std::sqrt(squares / static_cast<double>(clean.errors_255.size()));
        EXPECT_GT(told, 0.5 * sampled.error_of_denoised()) << count;
        EXPECT_LT(told, 2 * sampled.error_of_denoised()) << count;
    }
}

TEST(Denoise, WhatHasNoNoiseStaysToTheBit) {
    const Sampled sampled(4, wall, linear, 0);
    const Denoised clean = sampled.denoised();
    for (std::size_t i = 0; i < sampled.light.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_EQ(clean.picture.pixels[3 * i + c],
                      static_cast<float>(sampled.samples[i].mean()[static_cast<int>(c)]));
    EXPECT_EQ(clean.mean_error_255(), 0);
}

TEST(Denoise, SingleSamplesAndHostileOnesAreTakenAsTheyAre) {
    const Sampled single(1, wall, linear);
    const Denoised same = single.denoised();
    EXPECT_EQ(same.picture.pixels.front(), static_cast<float>(single.samples.front().mean().x));
    Sampled hostile(8, wall, linear);
    for (std::size_t i = 0; i < hostile.features.size(); i += 97) {
        hostile.features[i].fill(1e30f);
        hostile.samples[i].add(Rgb(1e30));
    }
    for (const float value : hostile.denoised().picture.pixels)
        ASSERT_TRUE(std::isfinite(value));
}

/// A pixel shows only what those near it have to do with, whatever shines elsewhere in its row and column.
TEST(Denoise, ABrightPixelChangesNothingBeyondItsNeighbours) {
    constexpr int reach_px = 40; // of the windows, of those that fits are averaged over, and of errors
    const Sampled calm(4, wall, linear);
    const std::vector<float> before = calm.denoised().picture.pixels;
    for (const double bright : {1e4, 1e9, 1e30, 1e200}) {
        Sampled sampled = calm;
        constexpr int bright_x = 5, bright_y = 3;
        sampled.samples[bright_y * width + bright_x].add(Rgb(bright));
        const Denoised clean = sampled.denoised();
        std::size_t i = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c, ++i) {
                    ASSERT_FALSE(std::isnan(clean.picture.pixels[i])) << bright << " at " << x << ", " << y;
                    if (x > bright_x + reach_px || y > bright_y + reach_px) {
                        ASSERT_EQ(clean.picture.pixels[i], before[i]) << bright << " at " << x << ", " << y;
                    }
                }
        for (const float error : clean.errors_255)
            ASSERT_TRUE(std::isfinite(error)) << bright;
    }
}

TEST(Denoise, ModelsOfAnySizeHaveFeaturesOfTheirOwn) {
    for (const float near : {1e-45f, 1e-40f, 1e-30f, 1e30f}) {
        const auto far_wall = [near](int x, int y) {
            PixelFeatures features = wall(x, y);
            features[near_feature] *= near;
            return features;
        };
        const auto painted = [](int, int, const PixelFeatures& f) {
            return Rgb(0.2 + 0.5 * static_cast<double>(f[1]));
        };
        const Sampled sampled(4, far_wall, painted);
        EXPECT_LT(sampled.error_of_denoised(), 0.5 * sampled.error_of_mean()) << near;
    }
}

TEST(Denoise, WorkersChangeNothing) {
    const Sampled sampled(4, wall, linear);
    EXPECT_EQ(sampled.denoised().picture, sampled.denoised(Backwards()).picture);
}

} // namespace
} // namespace graftal
