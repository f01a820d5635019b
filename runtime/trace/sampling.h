#pragma once

#include <cstdint>
#include <optional>

namespace graftal {

/// Fineness of the look at a picture: blocks of pixels that show what their middle does, or samples within
/// each pixel, on a lattice or at random.
struct Sampling {
    int block = 1; ///< pixels along each side of a block
    std::optional<int>
        antialias;        ///< with blocks of 1: POV-Ray's samples by +A0.0 +AM2 +R<depth> -J, else one
    int most_samples = 0; ///< with blocks of 1: samples through a filter, in place of a lattice
    double noise_255 = 0; ///< fewer, where the error of a pixel is below this, in 255ths as it is shown
    bool denoise = false; ///< takes noise out of two samples or more (denoise.h)
    int sparse = 1;       ///< where noise is taken out: one pixel of 1, 2 or 4 has samples

    /// Points of the lattice along each side of a pixel that are its own.
    int steps() const { return antialias ? 1 << (*antialias - 1) : 1; }
    /// Rays through a pixel, those that neighbours share counted once.
    double samples_a_pixel() const;
    /// Rays without light by which a pixel is denoised; 0 where it is not.
    int feature_rays() const;
    /// The price of the rays of a pixel, in samples.
    double cost_in_samples() const;
    bool operator==(const Sampling&) const = default;
};

struct TraceStatistics {
    std::uint64_t camera_rays = 0; ///< one a sample
    std::uint64_t work = 0;        ///< steps of all rays (Traversal::work)
    std::uint64_t given_up = 0;    ///< rays that met too many parts (Traversal::given_up)
    /// Pixels that have all their samples, and more noise than Sampling::noise_255.
    std::uint64_t noisy_pixels = 0;
    /// The noise that is left, of all pixels with two samples or more (NoiseMeter::error_255()), in 1/1024.
    std::uint64_t noise_1024 = 0, measured_pixels = 0;

    /// The mean noise of a pixel in 255ths as it is shown; nothing where no pixel has two samples.
    std::optional<double> noise_255() const;

    TraceStatistics& operator+=(const TraceStatistics& other);
};

} // namespace graftal
