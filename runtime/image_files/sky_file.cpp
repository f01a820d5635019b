#include "runtime/image_files/sky_file.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compiler/support/small_letters.h"
#include "compiler/support/srgb.h"
#include "runtime/image_files/image_files.h"
#include "runtime/image_files/reducing_sink.h"

namespace graftal {

namespace {

constexpr int least_written_rows = 512;
constexpr double most_half = 65504;

bool is_linear_name(const std::string& path) {
    const std::string ending =
        in_small_letters(std::string_view(path).substr(path.size() - std::min<std::size_t>(path.size(), 4)));
    return ending == ".exr" || ending == ".hdr";
}

/// Pixels of a sky's picture. A texel is the mean of several.
struct SkyPixels {
    using Texel = SkyPicture::Texel;
    struct Cell {
        Rgb sum{0.0};
        double count = 0;
    };

    void add(const float* samples, std::size_t channels, Cell& cell) {
        Rgb light;
        bool is_mended = false;
        for (int c = 0; c < 3; ++c) {
            const float sample = samples[channels >= 3 ? c : 0];
            const double value = linear ? sample : linear_from_srgb(sample);
            light[c] = value > 0 ? std::min<double>(value, most_radiance) : 0;
            is_mended = is_mended || !(value >= 0 && value <= most_radiance);
        }
        mended += is_mended;
        cell.sum += light;
        ++cell.count;
    }

    static Texel texel(const Cell& cell) {
        const Rgb mean = cell.sum / cell.count;
        return {static_cast<float>(mean.r), static_cast<float>(mean.g), static_cast<float>(mean.b)};
    }

    bool linear = false;
    std::uint64_t mended = 0;
};

} // namespace

Status read_sky_picture(const std::string& path, std::uint64_t most_texels, LoadedSkyPicture& loaded) {
    SkyPixels pixels{is_linear_name(path)};
    ReducingSink sink(pixels, most_texels, most_sky_columns);
    Status status = read_rows(path, sink);
    if (status.ok())
        loaded = {std::make_shared<const SkyPicture>(sink.width, sink.height, std::move(sink.texels)),
                  sink.shape.width, sink.shape.height, pixels.mended};
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
