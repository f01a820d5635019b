#include "runtime/farm/join_tiles.h"

#include <algorithm>

#include <fmt/format.h>

namespace graftal {

namespace {

constexpr int colours = 3;

/// Puts the rows of one tile in their place among those of its neighbours.
class TileSink : public RowSink {
  public:
    TileSink(const Tile& tile, int width, std::vector<float>& band)
        : tile_(tile), width_(width), band_(band) {}

    std::string begin(int width, int height, int file_channels) override {
        if (width == tile_.width && height == tile_.height && file_channels == colours) return {};
        return fmt::format("it has {}x{} pixels of {} channels, not {}x{} of {}", width, height,
                           file_channels, tile_.width, tile_.height, colours);
    }
    void take(const float* samples) override {
        const auto place =
            static_cast<std::ptrdiff_t>(colours) * (static_cast<std::ptrdiff_t>(row_++) * width_ + tile_.x);
        std::copy_n(samples, colours * tile_.width, band_.begin() + place);
    }

  private:
    Tile tile_;
    int width_;
    std::vector<float>& band_;
    int row_ = 0;
};

class TileRows : public RowSource {
  public:
    TileRows(const JobFolder& folder, const Job& job, const CancelFlag& cancel,
             const std::function<void(int)>& on_rows)
        : folder_(folder), job_(job), cancel_(cancel), on_rows_(on_rows) {
        const ImageSize size = job.fit->size;
        band_.resize(band_bytes(size, std::min(job.tile.height, size.height)) / sizeof(float));
    }

    std::string give(float* samples) override {
        const int in_band = row_ % job_.tile.height;
        if (in_band == 0)
            if (std::string problem = read_band(); !problem.empty()) return problem;
        const auto row_samples = static_cast<std::ptrdiff_t>(colours) * job_.fit->size.width;
        std::copy_n(band_.begin() + in_band * row_samples, row_samples, samples);
        ++row_;
        if (on_rows_) on_rows_(row_);
        return {};
    }

  private:
    std::string read_band() {
        const std::uint64_t columns = job_.tile_columns();
        const auto first = static_cast<std::uint64_t>(row_ / job_.tile.height) * columns + 1;
        for (std::uint64_t task = first; task < first + columns; ++task) {
            if (cancel_.raised()) return "interrupted";
            TileSink sink(job_.tile_of(task), job_.fit->size.width, band_);
            const Status status = read_rows(folder_.part(job_, task), sink);
            if (!status.ok()) return status.message();
        }
        return {};
    }

    const JobFolder& folder_;
    const Job& job_;
    const CancelFlag& cancel_;
    const std::function<void(int)>& on_rows_;
    std::vector<float> band_; ///< one row of tiles
    int row_ = 0;
};

} // namespace

std::uint64_t band_bytes(ImageSize size, int tile_height) {
    return static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(tile_height) * colours *
           sizeof(float);
}

Status join_tiles(const JobFolder& folder, const Job& job, SampleFormat format, const ImageMetadata& metadata,
                  const CancelFlag& cancel, const std::function<void(int)>& on_rows) {
    TileRows rows(folder, job, cancel, on_rows);
    const ImageSize size = job.fit->size;
    return write_rows(folder.result(job), {size.width, size.height, colours}, rows, format, metadata);
}

} // namespace graftal
