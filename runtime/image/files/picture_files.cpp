#include "runtime/image/picture_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

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

    /// What went wrong, or "".
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

std::string write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::FLOAT);
    spec.attribute("oiio:ColorSpace", "Linear"); // and colour belongs to alpha already, as EXR has it
    const auto tag = [&](const char* name, const std::string& value) {
        if (!value.empty()) spec.attribute(name, value);
    };
    tag("Software", metadata.software);
    tag(stamp_keyword, metadata.stamp);
    tag("ImageDescription", metadata.description);
    return write_checked(path, [&](OIIO::ImageOutput& output) {
        return output.open(path, spec) && output.write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
    });
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
    static constexpr graftal::PictureFiles files{graftal::read, graftal::write_exr, graftal::write_gif};
    return &files;
}
