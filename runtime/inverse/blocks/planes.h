#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/image/image.h"
#include "runtime/image_files/row_sink.h"

namespace graftal {

/// Grey levels from 0 to 255, row by row, top first.
struct LevelPlane {
    int width = 0, height = 0;
    std::vector<float> levels;

    LevelPlane() = default;
    LevelPlane(int w, int h, float level = 0)
        : width(w), height(h), levels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), level) {}

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    float at(int x, int y) const { return levels[index(x, y)]; }
};

/// A plane with a margin to the right and below, which repeats the border.
LevelPlane with_margin(const LevelPlane& plane, int width, int height);

/// A picture by its planes: grey, or luma and two chromas as in JPEG (ITU-R BT.601); then alpha, if any.
struct PicturePlanes {
    int width = 0, height = 0;
    bool colour = false, alpha = false;
    std::vector<LevelPlane> planes;
};

/// Takes a picture into planes; chromas have half the size. Colours that are all grey, and alphas that are
/// all 1, make no planes.
class PlanesSink final : public RowSink {
  public:
    /// Refuses pictures that take more memory when they are coded.
    explicit PlanesSink(std::uint64_t memory_bytes) : memory_bytes_(memory_bytes) {}

    std::string begin(int width, int height, int channels) override;
    void take(const float* samples) override;
    /// To be called once, after the last row.
    PicturePlanes finish();
    /// The refusal for memory; "" if there was none.
    const std::string& refusal() const { return refusal_; }

  private:
    std::uint64_t memory_bytes_;
    std::string refusal_;
    PicturePlanes picture_;
    int channels_ = 0, row_ = 0;
    bool coloured_ = false, transparent_ = false;
};

/// The planes of a picture in memory.
PicturePlanes planes_of(const Image& image);

/// The picture of planes that all have its size.
Image image_of(const PicturePlanes& picture);

} // namespace graftal
