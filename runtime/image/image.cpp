#include "runtime/image/image.h"

#include <algorithm>
#include <cctype>
#include <memory>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "compiler/support/check.h"
#include "compiler/support/file.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_samples = 1ull << 29;

std::string extension(const std::string& path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string::npos || path[dot] != '.') return {};
    std::string lower = path.substr(dot);
    for (char& c : lower)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

/// What OpenImageIO last complained about, on one line.
std::string complaint(std::string text) {
    if (text.empty()) text = OIIO::geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text.empty() ? "unknown error" : text;
}

Status read_failure(const std::string& path, std::string text) {
    return Status::failure(fmt::format("cannot read picture '{}': {}", path, complaint(std::move(text))));
}

Status write_failure(const std::string& path, std::string text) {
    return Status::failure(fmt::format("cannot write picture '{}': {}", path, complaint(std::move(text))));
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

/// Writes float samples in the file format `spec` asks for.
Status write_samples(const std::string& path, const OIIO::ImageSpec& spec, const float* samples) {
    PendingFile pending(path);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(pending.temporary_path());
    if (!output) return write_failure(path, {});
    if (!output->open(pending.temporary_path(), spec) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, samples) || !output->close())
        return write_failure(path, output->geterror());
    return pending.commit();
}

} // namespace

bool is_exr_name(const std::string& path) {
    return extension(path) == ".exr";
}

bool is_picture_name(const std::string& path) {
    return is_exr_name(path) || extension(path) == ".png";
}

Status read_image(const std::string& path, Image& image) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
    if (!input) return read_failure(path, {});
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        return read_failure(path, "it has no pixels in two dimensions");
    if (spec.image_pixels() > most_samples / static_cast<std::uint64_t>(spec.nchannels))
        return read_failure(path, "it is too large");
    const int channels = std::min(spec.nchannels, 4);
    image = {spec.width, spec.height, channels, {}};
    image.pixels.resize(spec.image_pixels() * static_cast<std::uint64_t>(channels));
    const bool whole = spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16;
    if (!(whole ? read_levels(*input, image) : read_floats(*input, image)))
        return read_failure(path, input->geterror());
    return {};
}

Status write_image(const std::string& path, const Image& image, SampleFormat format,
                   const ImageMetadata& metadata) {
    GRAFTAL_CHECK(is_picture_name(path), path);
    const bool exr = is_exr_name(path);
    const bool linear = exr || format == SampleFormat::linear16;
    const OIIO::TypeDesc type = exr      ? OIIO::TypeDesc::FLOAT
                                : linear ? OIIO::TypeDesc::UINT16
                                         : OIIO::TypeDesc::UINT8;
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
    spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    if (!exr) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (!metadata.software.empty()) spec.attribute("Software", metadata.software);
    if (!metadata.description.empty()) spec.attribute("ImageDescription", metadata.description);
    return write_samples(path, spec, image.pixels.data());
}

Status write_palette(const std::string& path, int width, int height, const std::vector<Rgb>& pixels) {
    GRAFTAL_CHECK(pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height), path);
    Image image{width, height, 3, {}};
    image.pixels.reserve(3 * pixels.size());
    for (const Rgb& rgb : pixels)
        for (int c = 0; c < 3; ++c)
            image.pixels.push_back(static_cast<float>(rgb[c]));
    return write_image(path, image, SampleFormat::linear16);
}

} // namespace graftal
