#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <gif_lib.h>

#include "runtime/image_files/animation.h"
#include "runtime/image_files/gif_palette.h"
#include "runtime/image_files/image_files.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

/// Frames in which colours are counted.
constexpr std::size_t most_counted = 32;
constexpr int clear = GifPalette::most_colours;

struct Frame {
    int width = 0, height = 0;
    std::vector<Levels> pixels;
};

Status read_frame(const std::string& path, Frame& frame) {
    Image image;
    if (Status status = read_image(path, image); !status.ok()) return status;
    if (image.channels < 3) return Status::failure(fmt::format("'{}' is not in colour", path));
    const bool is_first = frame.pixels.empty();
    if (!is_first && (image.width != frame.width || image.height != frame.height))
        return Status::failure(fmt::format("'{}' has another size or kind than the first frame", path));
    frame.width = image.width;
    frame.height = image.height;
    frame.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    const float* sample = image.pixels.data();
    for (Levels& pixel : frame.pixels) {
        for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = level8_of(sample[c]);
        sample += image.channels;
    }
    return {};
}

/// One file, by giflib. All frames have the colours of one palette; a frame holds what changed.
class Gif {
  public:
    Gif(std::string path, GifPalette& palette, int delay_hundredths)
        : path_(std::move(path)), palette_(palette), delay_hundredths_(delay_hundredths) {}
    Gif(const Gif&) = delete;
    Gif& operator=(const Gif&) = delete;
    ~Gif() {
        if (gif_) EGifCloseFile(gif_, nullptr);
    }

    Status open(const std::string& temporary, int width, int height) {
        file_.reset(std::fopen(temporary.c_str(), "wb"));
        if (!file_) return system_failure("write", path_);
        const auto put = [](GifFileType* gif, const GifByteType* bytes, int count) {
            return static_cast<int>(std::fwrite(bytes, 1, static_cast<std::size_t>(count),
                                                static_cast<std::FILE*>(gif->UserData)));
        };
        gif_ = EGifOpen(file_.get(), put, nullptr);
        const std::unique_ptr<ColorMapObject, void (*)(ColorMapObject*)> map(
            GifMakeMapObject(clear + 1, nullptr), GifFreeMapObject);
        if (!gif_ || !map) return failed();
        for (std::size_t i = 0; i < palette_.colours().size(); ++i) {
            const Levels& colour = palette_.colours()[i];
            map->Colors[i] = {colour[0], colour[1], colour[2]};
        }
        EGifSetGifVersion(gif_, true);
        numbers_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), clear);
        const GifByteType for_ever[] = {1, 0, 0};
        return check(EGifPutScreenDesc(gif_, width, height, 8, 0, map.get()) == GIF_OK &&
                     EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE) == GIF_OK &&
                     EGifPutExtensionBlock(gif_, 11, "NETSCAPE2.0") == GIF_OK &&
                     EGifPutExtensionBlock(gif_, sizeof for_ever, for_ever) == GIF_OK &&
                     EGifPutExtensionTrailer(gif_) == GIF_OK);
    }

    Status add(const Frame& frame) {
        const auto width = static_cast<std::size_t>(frame.width);
        std::size_t left = width, right = 0, top = numbers_.size(), below = 0;
        std::vector<GifByteType> shown(numbers_.size());
        for (std::size_t i = 0; i < numbers_.size(); ++i) {
            const std::size_t x = i % width, y = i / width;
            const std::uint8_t number = palette_.number_of(frame.pixels[i], x, y);
            shown[i] = number == numbers_[i] ? static_cast<GifByteType>(clear) : number;
            if (number == numbers_[i]) continue;
            numbers_[i] = number;
            left = std::min(left, x);
            right = std::max(right, x + 1);
            top = std::min(top, y);
            below = std::max(below, y + 1);
        }
        if (right == 0) left = top = 0, right = below = 1; // a frame of one clear pixel
        const GraphicsControlBlock stays{DISPOSE_DO_NOT, false, delay_hundredths_, clear};
        GifByteType control[4];
        EGifGCBToExtension(&stays, control);
        bool is_put = EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, sizeof control, control) == GIF_OK &&
                      EGifPutImageDesc(gif_, static_cast<int>(left), static_cast<int>(top),
                                       static_cast<int>(right - left), static_cast<int>(below - top), false,
                                       nullptr) == GIF_OK;
        for (std::size_t y = top; y < below && is_put; ++y)
            is_put =
                EGifPutLine(gif_, shown.data() + y * width + left, static_cast<int>(right - left)) == GIF_OK;
        return check(is_put);
    }

    Status close() {
        const bool is_closed = EGifCloseFile(std::exchange(gif_, nullptr), nullptr) == GIF_OK;
        if (Status status = check(is_closed); !status.ok()) return status;
        return std::fclose(file_.release()) == 0 ? Status() : system_failure("write", path_);
    }

  private:
    /// Files may take bytes that find no room, and tell later.
    Status check(bool is_well) { return is_well && std::fflush(file_.get()) == 0 ? Status() : failed(); }
    Status failed() const { return system_failure("write", path_); }

    std::string path_;
    GifPalette& palette_;
    int delay_hundredths_;
    OpenFile file_;
    GifFileType* gif_ = nullptr;
    std::vector<std::uint16_t> numbers_; ///< of the pixels that are shown
};

} // namespace

Status write_gif(const std::string& path, const std::vector<std::string>& frames, FrameRate rate,
                 const OnFrame& on_frame) {
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    GifPalette palette;
    Frame frame;
    const std::size_t step = std::max<std::size_t>(1, frames.size() / most_counted);
    for (std::size_t i = 0; i < frames.size(); i += step) {
        if (!on_frame(0)) return Status::failure("interrupted");
        if (Status status = read_frame(frames[i], frame); !status.ok()) return status;
        palette.count(frame.pixels);
    }
    palette.make();
    constexpr int most_px = 65535;
    if (frame.width > most_px || frame.height > most_px)
        return Status::failure(
            fmt::format("cannot write '{}': a GIF has at most {} pixels along a side", path, most_px));
    Gif gif(path, palette, static_cast<int>(100 / rate.per_second() + 0.5));
    Status status = gif.open(pending.temporary_path(), frame.width, frame.height);
    for (std::size_t i = 0; i < frames.size() && status.ok(); ++i) {
        status = on_frame(i) ? read_frame(frames[i], frame) : Status::failure("interrupted");
        if (status.ok()) status = gif.add(frame);
    }
    if (status.ok()) status = gif.close();
    return status.ok() ? pending.commit() : status;
}

} // namespace graftal
