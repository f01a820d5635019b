#include "runtime/image_files/picture_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <fstream>
#include <memory>
#include <string_view>

#include <OpenImageIO/imageio.h>
#include <openexr.h>

namespace graftal {

namespace {

/// Larger pictures must come row by row, or in bands of less than this, out of their file.
constexpr std::uint64_t most_held_samples = 1u << 26;

/// OpenImageIO makes the canvas when it opens the file: 23 bytes may ask for 16 GiB. Its reader looks at no
/// more of the stamp than the first three letters, and so do we.
bool is_huge_gif(const std::string& path) {
    std::array<unsigned char, 10> head{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(head.data()), head.size());
    if (!file || head[0] != 'G' || head[1] != 'I' || head[2] != 'F') return false;
    const std::uint64_t width = head[6] + 256u * head[7], height = head[8] + 256u * head[9];
    return 4 * width * height > most_held_samples;
}

/// OpenEXR makes room for a whole tile, which may be much larger than the picture.
bool has_huge_tiles(exr_const_context_t file) {
    int parts = 0;
    exr_get_count(file, &parts);
    for (int part = 0; part < parts; ++part) {
        std::uint32_t width = 0, height = 0;
        const exr_attr_chlist_t* channels = nullptr;
        if (exr_get_tile_descriptor(file, part, &width, &height, nullptr, nullptr) != EXR_ERR_SUCCESS ||
            exr_get_channels(file, part, &channels) != EXR_ERR_SUCCESS)
            continue;
        const double samples = 1.0 * width * height * std::max(1, channels->num_channels);
        if (samples > static_cast<double>(most_held_samples)) return true;
    }
    return false;
}

/// OpenEXR's reader in C++ makes room for an attribute as long as it says it is. The one in C looks at
/// lengths that are known, but not at those of attributes whose type has no name.
std::string complaint_about_exr(const std::string& path) {
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {}; // we say it
    exr_context_t file = nullptr;
    const exr_result_t result = exr_start_read(&file, path.c_str(), &settings);
    if (result != EXR_ERR_SUCCESS) return exr_get_default_error_message(result);
    const bool huge = has_huge_tiles(file);
    exr_finish(&file);
    return huge ? "its tiles are too large" : "";
}

/// Whether an attribute of a head reaches beyond the end of the file. Heads end with an empty name; a file of
/// several has one more empty name after the last.
bool reaches_beyond_its_end(const std::string& path) {
    constexpr std::uint32_t several_heads = 0x1000;
    std::ifstream file(path, std::ios::binary);
    file.seekg(0, std::ios::end);
    const std::streamoff end = file.tellg();
    file.seekg(4);
    const auto number = [&] {
        std::array<unsigned char, 4> bytes{};
        file.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
        return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | std::uint32_t{bytes[3]} << 24;
    };
    const bool several = (number() & several_heads) != 0;
    for (bool first_of_head = true; file;) {
        std::string name, type;
        std::getline(file, name, '\0');
        if (name.empty() && (first_of_head || !several)) return !file;
        first_of_head = name.empty();
        if (name.empty()) continue;
        std::getline(file, type, '\0');
        const std::uint32_t length = number();
        if (!file || length > end - file.tellg()) return true;
        file.seekg(length, std::ios::cur);
    }
    return true;
}

bool is_exr(const std::string& path) {
    std::array<char, 4> stamp{};
    std::ifstream file(path, std::ios::binary);
    file.read(stamp.data(), stamp.size());
    return file && stamp == std::array{'\x76', '\x2f', '\x31', '\x01'};
}

/// Why the head of a GIF or an EXR is not to be believed: it asks for more memory than the picture can need,
/// and their readers make room before they look whether the file holds as much. "" for other formats, and for
/// what cannot be read.
std::string false_claim(const std::string& path) {
    if (is_huge_gif(path)) return "it is too large";
    if (!is_exr(path)) return "";
    if (reaches_beyond_its_end(path)) return "its head is damaged: it reaches beyond the end of the file";
    const std::string complaint = complaint_about_exr(path);
    return complaint.empty() ? "" : "its head is damaged: " + complaint;
}

std::string complaint(std::string text) {
    if (text.empty()) text = OIIO::geterror();
    return text.empty() ? "unknown error" : text;
}

/// The rows of an open file, in bands that are as high as its tiles.
class Bands {
  public:
    explicit Bands(OIIO::ImageInput& input)
        : input_(input), spec_(input.spec()), channels_(std::min(spec_.nchannels, 4)),
          height_(spec_.tile_width ? spec_.tile_height : rows_at_once),
          whole_(spec_.format == OIIO::TypeDesc::UINT8 || spec_.format == OIIO::TypeDesc::UINT16) {}

    int channels() const { return channels_; }
    std::uint64_t samples() const { return row_samples() * static_cast<std::uint64_t>(height_); }

    bool hand_on(RowSink& sink) {
        samples_.resize(samples());
        if (whole_) levels_.resize(samples());
        for (int y = 0; y < spec_.height; y += height_) {
            const int rows = std::min(height_, spec_.height - y);
            if (!(whole_ ? read_levels(y, rows) : read(y, rows, OIIO::TypeDesc::FLOAT, samples_.data())))
                return false;
            for (int row = 0; row < rows; ++row)
                sink.take(samples_.data() + row_samples() * static_cast<std::uint64_t>(row));
        }
        return true;
    }

  private:
    static constexpr int rows_at_once = 16;

    std::uint64_t row_samples() const {
        return static_cast<std::uint64_t>(spec_.width) * static_cast<std::uint64_t>(channels_);
    }

    bool read(int y, int rows, OIIO::TypeDesc type, void* samples) {
        const int top = spec_.y + y, bottom = top + rows;
        if (!spec_.tile_width)
            return input_.read_scanlines(0, 0, top, bottom, spec_.z, 0, channels_, type, samples);
        return input_.read_tiles(0, 0, spec_.x, spec_.x + spec_.width, top, bottom, spec_.z, spec_.z + 1, 0,
                                 channels_, type, samples);
    }

    /// Whole numbers become the float nearest to level / largest, which OpenImageIO's own conversion misses
    /// by a last bit. 8-bit levels arrive as 257 times themselves, 65535 = 255 * 257.
    bool read_levels(int y, int rows) {
        if (!read(y, rows, OIIO::TypeDesc::UINT16, levels_.data())) return false;
        std::transform(levels_.begin(), levels_.end(), samples_.begin(),
                       [](std::uint16_t level) { return static_cast<float>(level) / 65535.0f; });
        return true;
    }

    OIIO::ImageInput& input_;
    const OIIO::ImageSpec& spec_;
    int channels_;
    int height_;
    bool whole_;
    std::vector<std::uint16_t> levels_;
    std::vector<float> samples_;
};

/// Whether the format's reader takes the picture out of its file a row at a time.
bool comes_in_rows(const OIIO::ImageInput& input) {
    static constexpr std::string_view formats[] = {"openexr", "tiff", "jpeg", "hdr", "targa", "bmp", "pnm"};
    return std::find(std::begin(formats), std::end(formats), input.format_name()) != std::end(formats);
}

/// The formats that pictures come in. OpenImageIO has readers of rare ones, too, that crash on a bad file.
bool is_read(const OIIO::ImageInput& input) {
    static constexpr std::string_view formats[] = {"png",   "openexr", "tiff", "jpeg", "hdr",
                                                   "targa", "bmp",     "pnm",  "gif",  "webp"};
    return std::find(std::begin(formats), std::end(formats), input.format_name()) != std::end(formats);
}

std::string read_open(OIIO::ImageInput& input, RowSink& sink) {
    if (!is_read(input))
        return std::string("it is a picture of the format '") + input.format_name() +
               "'; make it a PNG, EXR, TIFF, JPEG, HDR, TGA, BMP, PNM, GIF or WebP";
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
        return "it has no pixels in two dimensions";
    Bands bands(input);
    const std::uint64_t held = comes_in_rows(input) ? bands.samples() : spec.image_pixels() * 4;
    if (held > most_held_samples) return "it is too large";
    std::string error = sink.begin(spec.width, spec.height, bands.channels());
    if (error.empty() && !bands.hand_on(sink)) error = complaint(input.geterror());
    return error;
}

/// Readers of formats throw what they like at what they did not expect.
std::string read(const std::string& path, RowSink& sink) {
    try {
        if (std::string claim = false_claim(path); !claim.empty()) return claim;
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
        return input ? read_open(*input, sink) : complaint({});
    } catch (const std::exception& fault) {
        return std::string("its reader failed: ") + fault.what();
    }
}

} // namespace

} // namespace graftal

extern "C" const graftal::PictureFiles* graftal_picture_files() {
    // Pictures are small; a pool of threads would outlive main(), where leak checkers stumble over it.
    static const bool single_threaded = OIIO::attribute("threads", 1);
    static_cast<void>(single_threaded);
    static constexpr graftal::PictureFiles files{graftal::read};
    return &files;
}
