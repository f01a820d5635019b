// Pictures in files, as textures, collages and comparisons read them: any bytes give a picture or a message.
// The first byte chooses the name's ending, which is where a reader is looked for first.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/support/check.h"
#include "runtime/image_files/image_files.h"
#include "runtime/image_files/sky_file.h"
#include "runtime/image_files/texture_store.h"
#include "tests/fuzz/scratch.h"

using namespace graftal;

namespace {

constexpr auto endings = std::to_array<const char*>({"png", "exr", "gif", "jpg", "tif", "bmp", "tga", "hdr",
                                                     "ppm", "webp", "ico", "sgi", "dds", "psd", "txt"});

constexpr std::uint64_t most_samples = 1u << 20;
constexpr std::uint64_t most_texels = 1u << 12;

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static const fuzz::Scratch scratch;
    const std::string name = std::string("picture.") + endings[data[0] % endings.size()];
    scratch.write(name, {reinterpret_cast<const char*>(data) + 1, size - 1});
    Image image;
    ImageSink sink(image, most_samples);
    const Status status = read_rows(scratch.path(name), sink);
    if (!status.ok()) {
        GRAFTAL_CHECK(!status.message().empty(), "picture fuzzer: a picture or a message");
        return 0;
    }
    const auto samples = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                         static_cast<std::size_t>(image.channels);
    GRAFTAL_CHECK(samples > 0 && image.pixels.size() == samples, "picture fuzzer: all samples are there");
    GRAFTAL_CHECK(compare_images(image, image).max == 0, "picture fuzzer: a picture is like itself");
    Texture texture;
    GRAFTAL_CHECK(read_texture(scratch.path(name), most_texels, texture).ok(), "picture fuzzer: read twice");
    const auto texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
    GRAFTAL_CHECK(texels > 0 && texture.texels.size() == texels && texels <= most_texels,
                  "picture fuzzer: all texels are there");
    GRAFTAL_CHECK(texture.coverage >= 0 && texture.coverage <= 1 && texture.mean.x >= 0 &&
                      texture.mean.x <= 1,
                  "picture fuzzer: what a texture says of itself");
    texture.at(0.3, -1e300);
    LoadedSkyPicture sky;
    GRAFTAL_CHECK(read_sky_picture(scratch.path(name), most_texels, sky).ok(), "picture fuzzer: read again");
    const Rgb light = sky.picture->radiance({0.6, 0, 0.8});
    GRAFTAL_CHECK(light.x >= 0 && light.y <= most_radiance && std::isfinite(sky.picture->on_paper().z),
                  "picture fuzzer: a sky's light");
    return 0;
}
