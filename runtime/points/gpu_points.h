#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "compiler/chaos/flat_game.h"
#include "runtime/gpu/device.h"
#include "runtime/points/accumulation.h"
#include "runtime/points/point_projection.h"
#include "runtime/points/point_source.h"

namespace graftal {

/// Random iteration on a device: the points of a picture, counted where they are made. The sums depend on
/// game, seed and number of points, on one device and driver also to the last bit.
class GpuPoints {
  public:
    struct Work {
        std::uint64_t points = 0;
        std::uint64_t seed = 0;
        std::uint64_t most_bytes = UINT64_MAX; ///< of cells; the picture is counted in bands of as many
        bool perspective = false;              ///< places of the game are to be divided by their depth
        /// Is asked between pieces, which take some 40 ms; after it says false the status is "interrupted".
        std::function<bool(double share)> goes_on;
    };

    /// How the sums of a pixel grow, which are the same in the end.
    enum class Sums {
        apart,  ///< each by an operation of its own
        pairs,  ///< two by one: requires GpuInfo::atomics_64, as the next does
        packed, ///< all by one, where pixels are not too full
    };
    /// The device outlives this.
    GpuPoints(Gpu& gpu, Sums sums) : gpu_(gpu), sums_(sums) {}
    explicit GpuPoints(Gpu& gpu) : GpuPoints(gpu, gpu.info().atomics_64 ? Sums::packed : Sums::apart) {}

    /// Adds all points of the game that the picture shows.
    Status add_to(Accumulation& picture, FlatGame game, const Work& work);

    double seconds() const { return seconds_; } ///< that the device has worked

  private:
    /// Colours that the game's points have, as kernels sum them.
    struct Colours {
        std::uint32_t channels = 0; ///< 0: all points have `first`; 1: from `first` to `last`; 3: any
        glm::vec3 first{0}, last{1};
    };
    struct Job;

    static Colours colours_of(FlatGame& game);
    Status load(const FlatGame& game, const Work& work, std::uint32_t walkers, std::size_t cells);
    /// Points of rows of the picture.
    Status play(Accumulation& picture, const Work& work, Job job);
    /// Takes the cells into the picture.
    Status flush(Accumulation& picture, const Job& job);
    /// The largest number of points in a cell, and all together.
    Status sweep(Job job, std::uint64_t& most, std::uint64_t& sum);
    Status run(const Job& job, std::uint32_t groups, double& seconds);

    Gpu& gpu_;
    Sums sums_;
    bool packs_ = false;
    Colours colours_;
    std::vector<glm::uvec4> totals_; ///< by group
    double seconds_ = 0;
    double share_ = 0; ///< of the work, that is done
};

/// Whether single precision places the source's points in the picture, to a sixteenth of a pixel.
bool is_sharp_in_single(const PointSource& source, const PointProjection& projection);

} // namespace graftal
