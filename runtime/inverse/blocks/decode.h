#pragma once

#include <functional>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/inverse/blocks/block_map.h"
#include "runtime/inverse/blocks/planes.h"

namespace graftal {

/// The maps of a plane at a resolution of its own: W(f) of the plane f, as block_map.h has it. A domain is
/// sampled between four pixels, which are its four pixels at whole multiples of the size that was coded.
class PlaneIteration {
  public:
    /// `width` and `height`: of the whole picture in the new pixels. `coded_width` and `coded_height`: in
    /// those of the plane, which halves may end.
    PlaneIteration(const CodedPlane& plane, double coded_width, double coded_height, int width, int height);

    /// A plane with the margin of the blocks, where a domain may lie.
    LevelPlane grey() const { return {columns_, rows_, middle_level}; }
    std::uint64_t samples() const {
        return static_cast<std::uint64_t>(columns_) * static_cast<std::uint64_t>(rows_);
    }
    /// W(f), and sup |W(f) - f|. Throws Cancelled.
    float apply(const LevelPlane& from, LevelPlane& to, const Workers& workers,
                const CancelFlag& cancel) const;

  private:
    /// Two neighbours along an axis, and the share of the second.
    struct Tap {
        int first = 0, second = 0;
        float share = 0;
    };
    float fill(const BlockMap& block, const LevelPlane& from, LevelPlane& to) const;
    Tap tap(double place, double scale, int count) const;

    const CodedPlane& plane_;
    double scale_x_, scale_y_; ///< new pixels for one that was coded
    int columns_, rows_;
    std::vector<DomainPool> pools_; ///< by side, the least first
};

/// Pixels of W(f) that take a second of one processor.
inline constexpr double decoded_pixels_a_second = 1.2e8;
/// Memory that decoding takes, until the picture is written.
std::uint64_t decoding_bytes(const BlockPicture& picture, int width, int height);

/// The attractors of a picture at any size, each to a tenth of a level: W is iterated until it moves no pixel
/// by more than (1 - s) / s tenths. All planes come in the full size. Counts the work by the control
/// (OutOfWork), and throws Cancelled. `on_progress` gets the share that is done.
PicturePlanes decode_blocks(const BlockPicture& picture, int width, int height, const Workers& workers,
                            const Control& control, const std::function<void(double)>& on_progress);

/// The largest |slope| of a picture: the factor by which it contracts.
double contraction_of(const BlockPicture& picture);

} // namespace graftal
