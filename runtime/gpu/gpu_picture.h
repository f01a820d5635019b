#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "runtime/gpu/device.h"
#include "runtime/gpu/flat_model.h"
#include "runtime/trace/aovs.h"
#include "runtime/trace/tile.h"

namespace graftal {

/// A picture of one flat model, which grows by samples. Several devices take rows of tiles in turn, each on a
/// thread of its own. The sums are the same, to the last bit, however the work is cut into pieces; devices of
/// another kind may round otherwise.
class GpuPicture {
  public:
    /// Samples of a pixel: of light that is estimated, or of a lattice.
    struct Samples {
        std::uint32_t lattice = 0; ///< squares along each side of a pixel; 1: its middle; 0: by chance
        std::uint64_t sequence = 0;
        bool aovs = false; ///< read_aovs() is wanted, in place of light
    };

    /// `window`: the part of a picture of this size that is drawn. The devices, one or more, outlive it.
    GpuPicture(const std::vector<Gpu*>& gpus, ImageSize size, const Tile& window, const Samples& samples);

    /// Makes the kernel, and brings the model to the devices. `frames`: objects in each other that rays have
    /// room for. More of them take more of the device's memory, and so its time.
    Status prepare(const FlatModel& model, std::uint32_t frames = rooms.front());
    static constexpr std::array<std::uint32_t, 3> rooms = {64, 256, 2048}; ///< of frames, to be tried in turn

    /// Adds samples until each pixel has `count`, or is calm. `goes_on` is asked between pieces, which take
    /// about 30 ms, with the share that is done, by one thread at a time; after it says false the status is a
    /// failure: "interrupted".
    Status sample(std::uint32_t count, const std::function<bool(double share)>& goes_on);

    /// Samples a lattice takes.
    static std::uint32_t lattice_points(std::uint32_t lattice) {
        return lattice <= 1 ? 1 : (lattice + 1) * (lattice + 1);
    }

    /// Counts of all samples so far.
    struct Seen {
        double samples = 0; ///< of all pixels together
        double rays = 0;
        double steps = 0;        ///< boxes and parts that rays went to
        bool lost = false;       ///< rays had no room for some part: then the picture is wrong
        double noise_255 = 0;    ///< the mean error of a pixel as the film shows it; 0 where it is not known
        std::uint64_t noisy = 0; ///< pixels with more noise than is asked for
    };
    /// Gives the counts, and the mean light of the pixels to `picture`, which has three channels and the size
    /// of the window. Fails where a device by software has ended rays that took long.
    Status read(const Film& film, double noise_255, Image& picture, Seen& seen);

    /// Gives the values of each pixel of the window; `lost` as above. Requires Samples::aovs; `model` is the
    /// one prepared.
    Status read_aovs(const FlatModel& model, AovPicture& aovs, bool& lost);

    double seconds() const; ///< that the devices have worked, side by side

  private:
    /// The part that one device draws: every row of tiles whose number leaves `first`, divided by the
    /// devices.
    struct Share {
        Gpu* gpu;
        int first;
        double seconds = 0;         ///< that it has worked
        double pixels_a_second = 0; ///< samples of pixels, by the last piece; 0: unknown
    };
    using Asks = std::function<bool(double pixels)>; ///< told of the samples of pixels that were drawn

    std::size_t sums_a_pixel() const { return samples_.aovs ? 4 : 2; }
    /// Does it for each share, on threads of their own. The status is the first failure in the order of
    /// shares.
    Status for_each_share(const std::function<Status(Share&)>& act);
    /// Draws the samples up to `count`, as long as it `goes_on`.
    Status sample(Share& share, std::uint32_t count, const Asks& goes_on) const;
    Status read_sums(std::vector<glm::vec4>& sums);

    ImageSize size_;
    Tile window_;
    Samples samples_;
    std::vector<Share> shares_;
    std::uint32_t done_ = 0;
};

} // namespace graftal
