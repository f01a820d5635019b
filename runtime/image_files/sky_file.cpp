#include "runtime/image_files/sky_file.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compiler/support/small_letters.h"
#include "compiler/support/srgb.h"
#include "runtime/image_files/image_files.h"

namespace graftal {

namespace {

constexpr int least_written_rows = 512;
constexpr double most_half = 65504;

bool is_linear_name(const std::string& path) {
    const std::string ending =
        in_small_letters(std::string_view(path).substr(path.size() - std::min<std::size_t>(path.size(), 4)));
    return ending == ".exr" || ending == ".hdr";
}

/// Takes the rows of a file; each texel is the mean of several pixels across and down.
class SkySink : public RowSink {
  public:
    SkySink(bool linear, std::uint64_t most) : linear_(linear), most_(most) {}

    std::string begin(int width, int height, int channels) override {
        const auto count = [](int w, int h) {
            return static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h);
        };
        if (count(width, height) > most_file_texels) return "it is too large";
        loaded_.file_width = width;
        loaded_.file_height = rows_left_ = height;
        channels_ = static_cast<std::size_t>(channels);
        const auto across = [this](int size) { return (size + reduced_ - 1) / reduced_; };
        while (count(across(width), across(height)) > most_ ||
               std::max(across(width), across(height)) > most_sky_columns)
            ++reduced_;
        width_ = across(width);
        height_ = across(height);
        texels_.reserve(count(width_, height_));
        cells_.resize(static_cast<std::size_t>(width_));
        return {};
    }

    void take(const float* samples) override {
        for (int x = 0; x < loaded_.file_width; ++x) {
            Cell& cell = cells_[static_cast<std::size_t>(x / reduced_)];
            cell.sum += light_of(samples + static_cast<std::size_t>(x) * channels_);
            ++cell.count;
        }
        --rows_left_;
        if (++rows_ < reduced_ && rows_left_ > 0) return;
        rows_ = 0;
        for (Cell& cell : cells_) {
            const Rgb mean = cell.sum / cell.count;
            texels_.push_back(
                {static_cast<float>(mean.r), static_cast<float>(mean.g), static_cast<float>(mean.b)});
            cell = Cell();
        }
    }

    LoadedSkyPicture finished() && {
        loaded_.picture = std::make_shared<const SkyPicture>(width_, height_, std::move(texels_));
        return std::move(loaded_);
    }

  private:
    struct Cell {
        Rgb sum{0.0};
        double count = 0;
    };

    Rgb light_of(const float* samples) {
        Rgb light;
        bool mended = false;
        for (int c = 0; c < 3; ++c) {
            const float sample = samples[channels_ >= 3 ? c : 0];
            const double value = linear_ ? sample : linear_from_srgb(sample);
            light[c] = value > 0 ? std::min<double>(value, most_radiance) : 0;
            mended = mended || !(value >= 0 && value <= most_radiance);
        }
        loaded_.mended += mended;
        return light;
    }

    bool linear_;
    std::uint64_t most_;
    LoadedSkyPicture loaded_;
    int width_ = 0, height_ = 0;
    int reduced_ = 1;
    int rows_left_ = 0;
    int rows_ = 0; ///< of the file, in the cells
    std::size_t channels_ = 0;
    std::vector<Cell> cells_;
    std::vector<SkyPicture::Texel> texels_;
};

} // namespace

Status read_sky_picture(const std::string& path, std::uint64_t most_texels, LoadedSkyPicture& loaded) {
    SkySink sink(is_linear_name(path), most_texels);
    Status status = read_rows(path, sink);
    if (status.ok()) loaded = std::move(sink).finished();
    return status;
}

Status write_sky_picture(const PendingFile& pending, const SkyPicture& picture, double factor) {
    // The factor is odd, so that the middles of rows stay middles.
    int finer = 1;
    while (finer * picture.height() < least_written_rows)
        finer += 2;
    Image image{picture.width(), finer * picture.height(), 3, {}};
    image.pixels.reserve(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Rgb light = picture.radiance_at((x + 0.5) / image.width, (y + 0.5) / image.height);
            for (int c = 0; c < 3; ++c)
                image.pixels.push_back(static_cast<float>(std::min(factor * light[c], most_half)));
        }
    return write_image(pending, image, SampleFormat::srgb8);
}

} // namespace graftal
