#include "runtime/image/texture.h"

#include <cmath>
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "runtime/image/image.h"

namespace graftal {

namespace {

std::uint8_t level_of(float sample, bool linear) {
    const float encoded = linear ? srgb_encoded(sample) : sample;
    return encoded > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(encoded, 1.0f))) : 0;
}

Texture texture_of(const Image& image, bool linear) {
    Texture texture;
    texture.width = image.width;
    texture.height = image.height;
    const auto channels = static_cast<std::size_t>(image.channels);
    const bool has_alpha = channels == 2 || channels == 4;
    std::size_t solid = 0;
    texture.texels.resize(image.pixels.size() / channels);
    for (std::size_t i = 0; i < texture.texels.size(); ++i) {
        const float* const samples = image.pixels.data() + i * channels;
        Texture::Texel& texel = texture.texels[i];
        for (std::size_t c = 0; c < 3; ++c)
            texel.srgb[c] = level_of(samples[channels >= 3 ? c : 0], linear);
        texel.clear = has_alpha && !(samples[channels - 1] >= 0.5f);
        if (texel.clear) continue;
        ++solid;
        for (int c = 0; c < 3; ++c)
            texture.mean[c] += srgb_decoded(texel.srgb[static_cast<std::size_t>(c)]);
    }
    if (solid > 0) texture.mean /= static_cast<double>(solid);
    texture.coverage = static_cast<double>(solid) / static_cast<double>(texture.texels.size());
    return texture;
}

/// The number of the texel that holds x, of n from 0 to 1, repeated.
std::size_t texel_number(double x, int n) {
    const double within = x - std::floor(x);
    if (!(within >= 0)) return 0; // not a number
    return std::min(static_cast<std::size_t>(within * n), static_cast<std::size_t>(n - 1));
}

} // namespace

const Texture::Texel& Texture::at(double u, double v) const {
    const std::size_t row = static_cast<std::size_t>(height) - 1 - texel_number(v, height);
    return texels[row * static_cast<std::size_t>(width) + texel_number(u, width)];
}

double srgb_decoded(std::uint8_t level) {
    const double encoded = level / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::shared_ptr<const Texture> load_texture(const std::string& path, Status& status) {
    static std::mutex mutex;
    static std::map<std::string, std::shared_ptr<const Texture>> known;
    const std::lock_guard lock(mutex);
    std::shared_ptr<const Texture>& texture = known[path];
    if (texture) return texture;
    Image image;
    status = read_image(path, image);
    if (status.ok() && (image.width <= 0 || image.height <= 0 || image.channels <= 0))
        status = Status::failure(fmt::format("cannot read picture '{}': it is empty", path));
    if (status.ok()) texture = std::make_shared<const Texture>(texture_of(image, is_exr_name(path)));
    return texture;
}

Status look_at_texture(const std::string& path, Rgb& mean, double& coverage) {
    Status status;
    if (const auto texture = load_texture(path, status)) {
        mean = texture->mean;
        coverage = texture->coverage;
    }
    return status;
}

Status write_texture(const std::string& path, const Texture& texture) {
    Image image{texture.width, texture.height, 4, {}};
    image.pixels.reserve(4 * texture.texels.size());
    for (const Texture::Texel& texel : texture.texels) {
        for (const std::uint8_t level : texel.srgb)
            image.pixels.push_back(static_cast<float>(level) / 255.0f);
        image.pixels.push_back(texel.clear ? 0.0f : 1.0f);
    }
    return write_image(path, image, SampleFormat::srgb8);
}

} // namespace graftal
