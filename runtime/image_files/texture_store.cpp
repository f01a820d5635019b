#include "runtime/image_files/texture_store.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/reducing_sink.h"
#include "runtime/image_files/sky_file.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_texels = 1u << 25;
constexpr std::uint64_t most_texels_of_all = 1u << 27;
constexpr std::uint64_t least_texels = 1u << 12;
constexpr std::uint64_t most_sky_texels = 1u << 23;
constexpr std::uint64_t texels_a_sky_texel = 4; // 16 bytes, with what sampling needs

std::uint64_t texels_of(const LoadedSkyPicture& sky) {
    return texels_a_sky_texel * sky.picture->texels().size();
}

/// Pixels of a texture's picture.
class TexturePixels {
  public:
    using Texel = Texture::Texel;
    /// The pixels that become one texel.
    struct Cell {
        Texel first;
        Rgb light{0.0}; ///< of the solid ones
        int solid = 0;
        int count = 0;
    };

    explicit TexturePixels(bool linear) : linear_(linear) {
        for (int level = 0; level < 256; ++level)
            decoded_[static_cast<std::size_t>(level)] = srgb_decoded(static_cast<std::uint8_t>(level));
    }

    void add(const float* samples, std::size_t channels, Cell& cell) const {
        const Texel texel = texel_of(samples, channels);
        ++cell.count;
        if (texel.clear) return;
        if (cell.solid++ == 0) cell.first = texel;
        cell.light += light_of(texel);
    }

    static Texel texel(const Cell& cell) {
        Texel mean = cell.first;
        mean.clear = 2 * cell.solid < cell.count;
        if (cell.solid > 1)
            for (int c = 0; c < 3; ++c)
                mean.srgb[static_cast<std::size_t>(c)] =
                    level8_of(srgb_encoded(static_cast<float>(cell.light[c] / cell.solid)));
        return mean;
    }

    Rgb light_of(const Texel& texel) const {
        return {decoded_[texel.srgb[0]], decoded_[texel.srgb[1]], decoded_[texel.srgb[2]]};
    }

  private:
    Texel texel_of(const float* samples, std::size_t channels) const {
        Texel texel;
        for (std::size_t c = 0; c < 3; ++c) {
            const float sample = samples[channels >= 3 ? c : 0];
            texel.srgb[c] = level8_of(linear_ ? srgb_encoded(sample) : sample);
        }
        const bool has_alpha = channels == 2 || channels == 4;
        texel.clear = has_alpha && !(samples[channels - 1] >= 0.5f);
        return texel;
    }

    bool linear_;
    std::array<double, 256> decoded_;
};

} // namespace

Status read_texture(const std::string& path, std::uint64_t most_texels, Texture& texture) {
    TexturePixels pixels(is_exr_name(path));
    ReducingSink sink(pixels, most_texels);
    const Status status = read_rows(path, sink);
    if (!status.ok()) return status;
    texture = {sink.shape.width, sink.shape.height, sink.width, sink.height, std::move(sink.texels)};
    std::size_t solid = 0;
    for (const Texture::Texel& texel : texture.texels) {
        if (texel.clear) continue;
        ++solid;
        texture.mean += pixels.light_of(texel);
    }
    if (solid > 0) texture.mean /= static_cast<double>(solid);
    texture.coverage = static_cast<double>(solid) / static_cast<double>(texture.texels.size());
    return status;
}

std::shared_ptr<const Texture> TextureStore::load(const std::string& path, Status& status) {
    const std::lock_guard lock(mutex_);
    if (const auto known = known_.find(path); known != known_.end()) return known->second.texture;
    const FileStamp stamp = stamp_of(path);
    const std::uint64_t room = most_texels_of_all - std::min(texels_of_all_, most_texels_of_all);
    Texture read;
    status = read_texture(path, std::clamp(room, least_texels, most_texels), read);
    if (!status.ok()) return nullptr;
    auto texture = std::make_shared<const Texture>(std::move(read));
    texels_of_all_ += texture->texels.size();
    known_[path] = {texture, stamp};
    return texture;
}

Status TextureStore::look_at(const std::string& path, TextureFacts& facts) {
    Status status;
    if (const auto texture = load(path, status))
        facts = {.mean = texture->mean,
                 .coverage = texture->coverage,
                 .file_width = texture->file_width,
                 .file_height = texture->file_height,
                 .width = texture->width,
                 .height = texture->height};
    return status;
}

Status TextureStore::load_sky(const std::string& path, LoadedSkyPicture& loaded) {
    const std::lock_guard lock(mutex_);
    if (const auto known = skies_.find(path); known != skies_.end()) {
        loaded = known->second.loaded;
        return {};
    }
    const FileStamp stamp = stamp_of(path);
    const std::uint64_t room = most_texels_of_all - std::min(texels_of_all_, most_texels_of_all);
    const Status status =
        read_sky_picture(path, std::clamp(room / texels_a_sky_texel, least_texels, most_sky_texels), loaded);
    if (!status.ok()) return status;
    texels_of_all_ += texels_of(loaded);
    skies_[path] = {loaded, stamp};
    return {};
}

bool TextureStore::forget_changed() {
    const std::lock_guard lock(mutex_);
    const auto forget = [this](auto& entries, const auto& size) {
        return std::erase_if(entries, [&](const auto& entry) {
            if (stamp_of(entry.first) == entry.second.stamp) return false;
            texels_of_all_ -= size(entry.second);
            return true;
        });
    };
    std::size_t forgotten = forget(known_, [](const Entry& entry) { return entry.texture->texels.size(); });
    forgotten += forget(skies_, [](const SkyEntry& entry) { return texels_of(entry.loaded); });
    return forgotten > 0;
}

Status write_texture(const PendingFile& pending, const Texture& texture) {
    Image image{texture.width, texture.height, 4, {}};
    image.pixels.reserve(4 * texture.texels.size());
    for (const Texture::Texel& texel : texture.texels) {
        for (const std::uint8_t level : texel.srgb)
            image.pixels.push_back(static_cast<float>(level) / 255.0f);
        image.pixels.push_back(texel.clear ? 0.0f : 1.0f);
    }
    return write_image(pending, image, SampleFormat::srgb8);
}

} // namespace graftal
