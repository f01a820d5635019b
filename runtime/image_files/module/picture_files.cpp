#include "runtime/image_files/picture_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string_view>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "runtime/image_files/module/claims.h"

namespace graftal {

namespace {

std::string complaint(std::string text) {
    if (text.empty()) text = OIIO::geterror();
    return text.empty() ? "unknown error" : text;
}

/// A file to write that remembers what went wrong until it is closed: OpenImageIO's own does not tell when
/// the last bytes find no room on the disk.
class CheckedFile : public OIIO::Filesystem::IOProxy {
  public:
    explicit CheckedFile(const std::string& path)
        : IOProxy(path, Write), file_(std::fopen(path.c_str(), "wb")), error_(file_ ? 0 : errno) {}
    ~CheckedFile() override {
        if (file_) std::fclose(file_);
    }

    const char* proxytype() const override { return "checked_file"; }
    bool seek(std::int64_t offset) override {
        note(file_ && ::fseeko(file_, offset, SEEK_SET) == 0);
        m_pos = offset;
        return true;
    }
    std::int64_t tell() override { return m_pos; }
    /// After a failure the rest is dropped in silence: formats differ in how well they take one.
    std::size_t write(const void* bytes, std::size_t count) override {
        note(file_ && std::fwrite(bytes, 1, count, file_) == count);
        m_pos += static_cast<std::int64_t>(count);
        return count;
    }

    /// The first error's text, or "".
    std::string finish() {
        std::FILE* const file = std::exchange(file_, nullptr);
        note(file && std::fclose(file) == 0);
        return error_ ? std::strerror(error_) : "";
    }

  private:
    void note(bool well) {
        if (!well && error_ == 0) error_ = errno ? errno : EIO;
    }

    std::FILE* file_;
    int error_;
};

/// Writes a picture, or several, by a format's writer: `work` opens, writes and closes, and tells whether
/// that went well.
template<typename Work> std::string write_checked(const std::string& path, const Work& work) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    if (!output) return complaint({});
    CheckedFile file(path);
    output->set_ioproxy(&file);
    std::string error;
    if (!work(*output) || !output->close()) error = complaint(output->geterror());
    const std::string file_error = file.finish();
    return file_error.empty() ? error : file_error;
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

/// Levels of a frame, three channels of 8 bit.
std::string read_frame(const std::string& path, OIIO::ImageSpec& spec, std::vector<std::uint8_t>& levels) {
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
    if (!input) return complaint({});
    spec = OIIO::ImageSpec(input->spec().width, input->spec().height, 3, OIIO::TypeDesc::UINT8);
    if (input->spec().nchannels < spec.nchannels) return "'" + path + "' is not in colour";
    levels.resize(spec.image_bytes());
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, levels.data()))
        return complaint(input->geterror());
    return {};
}

std::string write_gif(const std::string& path, const std::vector<std::string>& frames, int delay_hundredths,
                      const std::function<bool(std::size_t)>& on_frame) {
    std::string frame_error;
    const auto add = [&](OIIO::ImageOutput& output, std::size_t i) {
        OIIO::ImageSpec spec;
        std::vector<std::uint8_t> levels;
        frame_error = on_frame(i) ? read_frame(frames[i], spec, levels) : "interrupted";
        if (!frame_error.empty()) return false;
        const int rate[2] = {100, delay_hundredths};
        spec.attribute("FramesPerSecond", OIIO::TypeRational, rate);
        const auto mode = i == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
        return output.open(path, spec, mode) && output.write_image(OIIO::TypeDesc::UINT8, levels.data());
    };
    const std::string error = write_checked(path, [&](OIIO::ImageOutput& output) {
        for (std::size_t i = 0; i < frames.size(); ++i)
            if (!add(output, i)) return false;
        return true;
    });
    return frame_error.empty() ? error : frame_error;
}

} // namespace

} // namespace graftal

extern "C" const graftal::PictureFiles* graftal_picture_files() {
    // Pictures are small; a pool of threads would outlive main(), where leak checkers stumble over it.
    static const bool single_threaded = OIIO::attribute("threads", 1);
    static_cast<void>(single_threaded);
    static constexpr graftal::PictureFiles files{graftal::read, graftal::write_gif};
    return &files;
}
