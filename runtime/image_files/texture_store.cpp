#include "runtime/image_files/texture_store.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/sky_file.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_texels = 1u << 25;
constexpr std::uint64_t most_texels_of_all = 1u << 27;
constexpr std::uint64_t least_texels = 1u << 12;
constexpr std::uint64_t most_sky_texels = 1u << 23;
constexpr std::uint64_t texels_a_sky_texel = 4; // 16 bytes, with what sampling needs

std::uint64_t texel_count(int width, int height) {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
}

std::uint64_t texels_of(const LoadedSkyPicture& sky) {
    return texels_a_sky_texel * texel_count(sky.picture->width(), sky.picture->height());
}

/// Makes a texture of the rows of a file, reduced to `most` texels.
class TextureSink : public RowSink {
  public:
    TextureSink(bool linear, std::uint64_t most) : linear_(linear), most_(most) {
        for (int level = 0; level < 256; ++level)
            decoded_[static_cast<std::size_t>(level)] = srgb_decoded(static_cast<std::uint8_t>(level));
    }

    std::string begin(int width, int height, int channels) override {
        if (texel_count(width, height) > most_file_texels) return "it is too large";
        texture_.file_width = width;
        texture_.file_height = height;
        rows_left_ = height;
        channels_ = static_cast<std::size_t>(channels);
        const auto across = [this](int size) { return (size + reduced_ - 1) / reduced_; };
        while (texel_count(across(width), across(height)) > most_)
            ++reduced_;
        texture_.width = across(width);
        texture_.height = across(height);
        texture_.texels.reserve(texel_count(texture_.width, texture_.height));
        cells_.resize(static_cast<std::size_t>(texture_.width));
        return {};
    }

    void take(const float* samples) override {
        for (int x = 0; x < texture_.file_width; ++x)
            cells_[static_cast<std::size_t>(x / reduced_)].add(
                texel_of(samples + static_cast<std::size_t>(x) * channels_), decoded_);
        --rows_left_;
        if (++rows_ < reduced_ && rows_left_ > 0) return;
        rows_ = 0;
        for (Cell& cell : cells_) {
            texture_.texels.push_back(cell.texel());
            cell = Cell();
        }
    }

    Texture finished() && {
        std::size_t solid = 0;
        for (const Texture::Texel& texel : texture_.texels) {
            if (texel.clear) continue;
            ++solid;
            for (int c = 0; c < 3; ++c)
                texture_.mean[c] += decoded_[texel.srgb[static_cast<std::size_t>(c)]];
        }
        if (solid > 0) texture_.mean /= static_cast<double>(solid);
        texture_.coverage = static_cast<double>(solid) / static_cast<double>(texture_.texels.size());
        return std::move(texture_);
    }

  private:
    using Decoded = std::array<double, 256>;

    /// The texels of the file that become one.
    struct Cell {
        Texture::Texel first;
        Rgb light{0.0}; ///< of the solid ones
        int solid = 0;
        int count = 0;

        void add(const Texture::Texel& texel, const Decoded& decoded) {
            ++count;
            if (texel.clear) return;
            if (solid++ == 0) first = texel;
            for (int c = 0; c < 3; ++c)
                light[c] += decoded[texel.srgb[static_cast<std::size_t>(c)]];
        }
        Texture::Texel texel() const {
            Texture::Texel mean = first;
            mean.clear = 2 * solid < count;
            if (solid > 1)
                for (int c = 0; c < 3; ++c)
                    mean.srgb[static_cast<std::size_t>(c)] =
                        level8_of(srgb_encoded(static_cast<float>(light[c] / solid)));
            return mean;
        }
    };

    Texture::Texel texel_of(const float* samples) const {
        Texture::Texel texel;
        for (std::size_t c = 0; c < 3; ++c) {
            const float sample = samples[channels_ >= 3 ? c : 0];
            texel.srgb[c] = level8_of(linear_ ? srgb_encoded(sample) : sample);
        }
        const bool has_alpha = channels_ == 2 || channels_ == 4;
        texel.clear = has_alpha && !(samples[channels_ - 1] >= 0.5f);
        return texel;
    }

    bool linear_;
    std::uint64_t most_;
    Decoded decoded_;
    Texture texture_;
    int reduced_ = 1; ///< texels of the file, across and up, whose mean a texel is
    int rows_left_ = 0;
    int rows_ = 0; ///< of the file, in the cells
    std::size_t channels_ = 0;
    std::vector<Cell> cells_;
};

} // namespace

Status read_texture(const std::string& path, std::uint64_t most_texels, Texture& texture) {
    TextureSink sink(is_exr_name(path), most_texels);
    const Status status = read_rows(path, sink);
    if (status.ok()) texture = std::move(sink).finished();
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
