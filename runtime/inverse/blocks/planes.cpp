#include "runtime/inverse/blocks/planes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/inverse/blocks/block_map.h"

namespace graftal {

namespace {

/// Bytes for each pixel: the planes, their coding, and their decoding to measure the error.
constexpr std::uint64_t bytes_a_coded_pixel = 26;
constexpr float red_share = 0.299f, green_share = 0.587f, blue_share = 0.114f;
/// Colours less red, or blue, than luma and more, in levels of a chroma.
constexpr float red_span = 2 * (1 - red_share), blue_span = 2 * (1 - blue_share);

/// A stored sample as a level; NaN is 0.
float level(float sample) {
    return 255 * (sample > 0 ? std::min(sample, 1.0f) : 0.0f);
}

float clamped_sample(float level) {
    return std::clamp(level, 0.0f, 255.0f) / 255;
}

/// Sums of up to four pixels as their means.
void average(LevelPlane& sums, int width, int height) {
    for (int y = 0; y < sums.height; ++y)
        for (int x = 0; x < sums.width; ++x)
            sums.levels[sums.index(x, y)] /=
                static_cast<float>(std::min(2, width - 2 * x) * std::min(2, height - 2 * y));
}

} // namespace

LevelPlane with_margin(const LevelPlane& plane, int width, int height) {
    LevelPlane padded(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            padded.levels[padded.index(x, y)] =
                plane.at(std::min(x, plane.width - 1), std::min(y, plane.height - 1));
    return padded;
}

std::string PlanesSink::begin(int width, int height, int channels) {
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (std::max(width, height) > most_picture_side) {
        refusal_ = fmt::format("has {}x{} pixels; block coding takes at most {} a side", width, height,
                               most_picture_side);
    } else if (pixels * bytes_a_coded_pixel > memory_bytes_) {
        refusal_ = fmt::format("has {}x{} pixels: to code them takes {} MiB, and {} are allowed", width,
                               height, (pixels * bytes_a_coded_pixel >> 20) + 1, memory_bytes_ >> 20);
    }
    if (!refusal_.empty()) return "it " + refusal_;
    channels_ = channels;
    picture_ = {width, height, channels >= 3, channels % 2 == 0, {}};
    picture_.planes.emplace_back(width, height);
    for (int chroma = 0; picture_.colour && chroma < 2; ++chroma)
        picture_.planes.emplace_back((width + 1) / 2, (height + 1) / 2);
    if (picture_.alpha) picture_.planes.emplace_back(width, height);
    return {};
}

void PlanesSink::take(const float* samples) {
    std::vector<LevelPlane>& planes = picture_.planes;
    for (int x = 0; x < picture_.width; ++x, samples += channels_) {
        const std::size_t pixel = planes.front().index(x, row_);
        float luma = level(samples[0]);
        if (picture_.colour) {
            const float red = luma, green = level(samples[1]), blue = level(samples[2]);
            luma = red_share * red + green_share * green + blue_share * blue;
            coloured_ |= red != green || green != blue;
            const std::size_t half = planes[1].index(x / 2, row_ / 2);
            planes[1].levels[half] += (blue - luma) / blue_span + middle_level;
            planes[2].levels[half] += (red - luma) / red_span + middle_level;
        }
        planes.front().levels[pixel] = luma;
        if (picture_.alpha) {
            const float alpha = level(samples[channels_ - 1]);
            planes.back().levels[pixel] = alpha;
            transparent_ |= alpha < 255;
        }
    }
    ++row_;
}

PicturePlanes PlanesSink::finish() {
    std::vector<LevelPlane>& planes = picture_.planes;
    if (picture_.alpha && !transparent_) planes.pop_back();
    if (picture_.colour && !coloured_) planes.erase(planes.begin() + 1, planes.begin() + 3);
    picture_.alpha = transparent_;
    picture_.colour = coloured_;
    for (int chroma = 1; picture_.colour && chroma <= 2; ++chroma)
        average(planes[static_cast<std::size_t>(chroma)], picture_.width, picture_.height);
    return std::move(picture_);
}

PicturePlanes planes_of(const Image& image) {
    PlanesSink sink(UINT64_MAX);
    sink.begin(image.width, image.height, image.channels);
    const std::size_t row = image.pixels.size() / static_cast<std::size_t>(image.height);
    for (std::size_t at = 0; at < image.pixels.size(); at += row)
        sink.take(image.pixels.data() + at);
    return sink.finish();
}

Image image_of(const PicturePlanes& picture) {
    const std::vector<LevelPlane>& planes = picture.planes;
    Image image{picture.width, picture.height, (picture.colour ? 3 : 1) + (picture.alpha ? 1 : 0), {}};
    const std::size_t pixels = planes.front().levels.size();
    image.pixels.reserve(pixels * static_cast<std::size_t>(image.channels));
    for (std::size_t i = 0; i < pixels; ++i) {
        const float luma = planes.front().levels[i];
        if (picture.colour) {
            const float red = luma + red_span * (planes[2].levels[i] - middle_level);
            const float blue = luma + blue_span * (planes[1].levels[i] - middle_level);
            const float green = (luma - red_share * red - blue_share * blue) / green_share;
            for (const float colour : {red, green, blue})
                image.pixels.push_back(clamped_sample(colour));
        } else {
            image.pixels.push_back(clamped_sample(luma));
        }
        if (picture.alpha) image.pixels.push_back(clamped_sample(planes.back().levels[i]));
    }
    return image;
}

} // namespace graftal
