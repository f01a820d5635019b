#pragma once

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/image_files/row_sink.h"

namespace graftal {

/// Takes a picture reduced by a whole number, in both directions alike, as it comes out of its file. `Pixels`
/// has a `Cell`, for the pixels that become one texel: add(samples, channels, cell) and texel(cell).
template<typename Pixels> class ReducingSink final : public RowSink {
  public:
    /// Reduces to `most` texels, and `most_columns` of them across and down.
    ReducingSink(Pixels& pixels, std::uint64_t most, int most_columns = INT_MAX)
        : pixels_(pixels), most_(most), most_columns_(most_columns) {}

    std::string begin(int file_width, int file_height, int channels) override {
        if (count(file_width, file_height) > most_file_texels) return "it is too large";
        shape = {file_width, file_height, channels};
        rows_left_ = file_height;
        const auto across = [this](int size) { return (size + reduced_ - 1) / reduced_; };
        while (count(across(file_width), across(file_height)) > most_ ||
               std::max(across(file_width), across(file_height)) > most_columns_)
            ++reduced_;
        width = across(file_width);
        height = across(file_height);
        texels.reserve(count(width, height));
        cells_.resize(static_cast<std::size_t>(width));
        return {};
    }

    void take(const float* samples) override {
        const auto channels = static_cast<std::size_t>(shape.channels);
        for (int x = 0; x < shape.width; ++x)
            pixels_.add(samples + static_cast<std::size_t>(x) * channels, channels,
                        cells_[static_cast<std::size_t>(x / reduced_)]);
        --rows_left_;
        if (++rows_ < reduced_ && rows_left_ > 0) return;
        rows_ = 0;
        for (Cell& cell : cells_) {
            texels.push_back(pixels_.texel(cell));
            cell = Cell();
        }
    }

    RowShape shape; ///< of the file
    int width = 0, height = 0;
    std::vector<typename Pixels::Texel> texels;

  private:
    using Cell = typename Pixels::Cell;

    static std::uint64_t count(int across, int down) {
        return static_cast<std::uint64_t>(across) * static_cast<std::uint64_t>(down);
    }

    Pixels& pixels_;
    std::uint64_t most_;
    int most_columns_;
    int reduced_ = 1; ///< pixels of the file, across and down, that a texel stands for
    int rows_left_ = 0;
    int rows_ = 0; ///< of the file, in the cells
    std::vector<Cell> cells_;
};

} // namespace graftal
