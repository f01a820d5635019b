#pragma once

#include <vector>

namespace graftal {

/// A point of a pixel, from its upper left corner, and its share of the pixel's light.
struct PixelSample {
    double x = 0.5;
    double y = 0.5;
    double weight = 1;
};

/// Where POV-Ray 3.7 looks through a pixel that it samples once (`-A`): its middle (CreateCameraRay of
/// tracepixel.cpp).
inline constexpr PixelSample povray_sample_of_pixel{};

/// The samples of a pixel under `+A0.0 +AM2 +R<depth> -J`, row by row; the weights add up to 1. POV-Ray
/// halves the pixel depth - 1 times each way and takes the mean of each cell's corners. So the samples are
/// those corners, (2^(depth - 1) + 1) squared, of which neighbouring pixels share the outer ones. Means are
/// taken before anything is clamped. Requires 1 <= depth <= 9, as +R does.
inline std::vector<PixelSample> povray_samples_of_pixel(int depth) {
    const int cells = 1 << (depth - 1);
    // Along a line each cell gives half its share to either end.
    const auto share = [&](int i) { return (i == 0 || i == cells ? 0.5 : 1.0) / cells; };
    std::vector<PixelSample> samples;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i)
            samples.push_back(
                {static_cast<double>(i) / cells, static_cast<double>(j) / cells, share(i) * share(j)});
    return samples;
}

} // namespace graftal
