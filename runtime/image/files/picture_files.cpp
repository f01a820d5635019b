#include "runtime/image/picture_files.h"

#include <algorithm>
#include <memory>

#include <OpenImageIO/imageio.h>

namespace graftal {

namespace {

std::string complaint(std::string text) {
    if (text.empty()) text = OIIO::geterror();
    return text.empty() ? "unknown error" : text;
}

bool read_floats(OIIO::ImageInput& input, Image& image) {
    return input.read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.pixels.data());
}

/// Whole numbers become the float nearest to level / largest, which OpenImageIO's own conversion misses by a
/// last bit. 8-bit levels arrive as 257 times themselves, 65535 = 255 * 257.
bool read_levels(OIIO::ImageInput& input, Image& image) {
    std::vector<std::uint16_t> levels(image.pixels.size());
    if (!input.read_image(0, 0, 0, image.channels, OIIO::TypeDesc::UINT16, levels.data())) return false;
    std::transform(levels.begin(), levels.end(), image.pixels.begin(),
                   [](std::uint16_t level) { return static_cast<float>(level) / 65535.0f; });
    return true;
}

std::string read(const std::string& path, std::uint64_t most_samples, Image& image) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
    if (!input) return complaint({});
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        return "it has no pixels in two dimensions";
    if (spec.image_pixels() > most_samples / static_cast<std::uint64_t>(spec.nchannels))
        return "it is too large";
    const int channels = std::min(spec.nchannels, 4);
    image = {spec.width, spec.height, channels, {}};
    image.pixels.resize(spec.image_pixels() * static_cast<std::uint64_t>(channels));
    const bool whole = spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16;
    if (!(whole ? read_levels(*input, image) : read_floats(*input, image)))
        return complaint(input->geterror());
    return {};
}

OIIO::TypeDesc type_of(PictureFiles::Samples samples) {
    switch (samples) {
    case PictureFiles::Samples::integer8:
        return OIIO::TypeDesc::UINT8;
    case PictureFiles::Samples::integer16:
        return OIIO::TypeDesc::UINT16;
    case PictureFiles::Samples::real32:
        return OIIO::TypeDesc::FLOAT;
    }
    return OIIO::TypeDesc::UNKNOWN;
}

std::string write(const std::string& path, const Image& image, PictureFiles::Samples samples, bool linear,
                  const std::vector<PictureFiles::Tag>& tags) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type_of(samples));
    spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    // PNG keeps alpha straight; to EXR colour belongs to alpha already.
    if (samples != PictureFiles::Samples::real32) spec.attribute("oiio:UnassociatedAlpha", 1);
    for (const PictureFiles::Tag& tag : tags)
        spec.attribute(tag.name, tag.value);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    if (!output) return complaint({});
    if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data()) ||
        !output->close())
        return complaint(output->geterror());
    return {};
}

std::string write_levels(const std::string& path, int width, int height,
                         const std::vector<std::uint16_t>& levels) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("png:compressionLevel", 0);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    if (!output) return complaint({});
    if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::UINT16, levels.data()) ||
        !output->close())
        return complaint(output->geterror());
    return {};
}

} // namespace

} // namespace graftal

extern "C" const graftal::PictureFiles* graftal_picture_files() {
    // Pictures are small; a pool of threads would outlive main(), where leak checkers stumble over it.
    static const bool single_threaded = OIIO::attribute("threads", 1);
    static_cast<void>(single_threaded);
    static constexpr graftal::PictureFiles files{graftal::read, graftal::write, graftal::write_levels};
    return &files;
}
