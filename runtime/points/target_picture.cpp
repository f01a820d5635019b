#include "runtime/points/target_picture.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/srgb.h"
#include "runtime/image_files/image_files.h"

namespace graftal {

namespace {

class TargetSink final : public RowSink {
  public:
    /// `linear`: the picture holds light, not sRGB.
    TargetSink(const TargetCriterion& criterion, int most_cells_a_side, bool in_colour, bool linear,
               TargetPicture& target)
        : criterion_(criterion), most_(most_cells_a_side), in_colour_(in_colour), linear_(linear),
          target_(target) {}

    std::string begin(int width, int height, int channels) override {
        target_.width = width;
        target_.height = height;
        channels_ = static_cast<std::size_t>(channels);
        const int longer = std::max(width, height), size = longer / most_ + (longer % most_ > 0);
        target_.pixels_per_cell = size;
        target_.cells = CellSet(width / size + (width % size > 0), height / size + (height % size > 0));
        if (channels == 2 || channels == 4) opaque_ = target_.cells.cells;
        for (ColourSums& sums : sums_)
            if (in_colour_)
                sums = {std::vector<Rgb>(target_.cells.cells.size(), Rgb(0.0)),
                        std::vector<float>(target_.cells.cells.size())};
        return "";
    }

    void take(const float* samples) override {
        const int size = target_.pixels_per_cell;
        const std::size_t row = target_.cells.index(0, row_ / size);
        for (int x = 0; x < target_.width; ++x, samples += channels_) {
            const std::size_t cell = row + static_cast<std::size_t>(x / size);
            const double grey =
                channels_ < 3 ? samples[0] : 0.2126 * samples[0] + 0.7152 * samples[1] + 0.0722 * samples[2];
            if (criterion_.light ? grey > criterion_.threshold : grey < criterion_.threshold) {
                target_.cells.cells[cell] = true;
                add_colour(sums_[0], cell, samples);
            }
            if (opaque_.empty()) continue;
            const double alpha = samples[channels_ - 1];
            if (alpha >= criterion_.threshold) {
                opaque_[cell] = true;
                add_colour(sums_[1], cell, samples);
            }
            target_.by_alpha |= alpha < 1;
        }
        ++row_;
    }

    void finish() {
        if (target_.by_alpha) target_.cells.cells = std::move(opaque_);
        target_.colours = std::move(sums_[target_.by_alpha].light);
        target_.pixels = std::move(sums_[target_.by_alpha].pixels);
    }

  private:
    struct ColourSums {
        std::vector<Rgb> light;
        std::vector<float> pixels;
    };

    void add_colour(ColourSums& sums, std::size_t cell, const float* samples) const {
        if (!in_colour_) return;
        for (int c = 0; c < 3; ++c) {
            const double stored = samples[channels_ < 3 ? 0 : c];
            sums.light[cell][c] += std::clamp(linear_ ? stored : linear_from_srgb(stored), 0.0, 1.0);
        }
        sums.pixels[cell] += 1;
    }

    const TargetCriterion& criterion_;
    int most_;
    bool in_colour_, linear_;
    TargetPicture& target_;
    ColourSums sums_[2]; ///< of the set by brightness, and by alpha
    std::size_t channels_ = 1;
    std::vector<bool> opaque_; ///< the set by alpha, of a picture that has one
    int row_ = 0;
};

} // namespace

bool TargetPicture::empty() const {
    return std::find(cells.cells.begin(), cells.cells.end(), true) == cells.cells.end();
}

Status read_target(const std::string& path, const TargetCriterion& criterion, TargetPicture& target,
                   int most_cells_a_side, bool in_colour) {
    TargetSink sink(criterion, most_cells_a_side, in_colour, is_exr_name(path), target);
    const Status status = read_rows(path, sink);
    if (status.ok()) sink.finish();
    return status;
}

std::string criterion_text(const TargetCriterion& criterion, bool by_alpha) {
    return (by_alpha          ? "of an alpha of at least "
            : criterion.light ? "lighter than "
                              : "darker than ") +
           shortest(criterion.threshold);
}

std::string empty_target_text(const std::string& path, const TargetCriterion& criterion, bool by_alpha) {
    return fmt::format("the target '{}' is empty: it has no pixel {}", path,
                       criterion_text(criterion, by_alpha));
}

} // namespace graftal
