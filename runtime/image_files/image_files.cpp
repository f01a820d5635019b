#include "runtime/image_files/image_files.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <future>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "compiler/support/check.h"
#include "compiler/support/small_letters.h"
#include "runtime/image_files/animation.h"
#include "runtime/image_files/exr_files.h"
#include "runtime/image_files/picture_files.h"
#include "runtime/image_files/png_files.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_samples = 1ull << 28;

std::string extension(const std::string& path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string::npos || path[dot] != '.') return {};
    return in_small_letters(std::string_view(path).substr(dot));
}

struct Module {
    const PictureFiles* files = nullptr;
    std::string error;
};

Module load_module() {
    void* const library = ::dlopen(GRAFTAL_PICTURE_FILES, RTLD_LAZY | RTLD_LOCAL);
    void* const symbol = library ? ::dlsym(library, picture_files_symbol) : nullptr;
    if (!symbol) {
        const char* const reason = ::dlerror(); // null where there is no memory for it
        return {nullptr, reason ? reason : std::strerror(ENOMEM)};
    }
    return {reinterpret_cast<const PictureFiles* (*)()>(symbol)(), {}};
}

void (*on_late_libraries)() = nullptr; ///< null: nobody watches

/// A watch over libraries that load: its thread calls on_late_libraries() once the program has done nothing
/// for some seconds. On a busy machine it may take long, but goes on.
class LibraryWatch {
  public:
    /// Throws std::system_error where no thread can be made.
    LibraryWatch()
        : thread_([loaded = loaded_.get_future()] {
              for (std::clock_t before = std::clock();
                   loaded.wait_for(longest) == std::future_status::timeout;) {
                  const std::clock_t used = std::clock() - std::exchange(before, std::clock());
                  if (used < least_share * CLOCKS_PER_SEC * longest.count()) return on_late_libraries();
              }
          }) {}
    ~LibraryWatch() {
        loaded_.set_value();
        thread_.join();
    }
    LibraryWatch(const LibraryWatch&) = delete;
    LibraryWatch& operator=(const LibraryWatch&) = delete;

  private:
    static constexpr std::chrono::seconds longest{20}; ///< a quarter of one is the rule
    static constexpr double least_share = 1e-3;        ///< of a processor, where it is not waiting
    std::promise<void> loaded_;
    std::thread thread_;
};

Module load_in_time() {
    if (!on_late_libraries) return load_module();
    try {
        const LibraryWatch watch;
        return load_module();
    } catch (const std::system_error& error) {
        return {nullptr,
                fmt::format("cannot make a thread to watch libraries load: {}", error.code().message())};
    }
}

/// Loaded once, and never unloaded.
const Module& module() {
    static const Module loaded = load_in_time();
    return loaded;
}

/// PNG and the writing of EXR need no module: the first picture of 640x360 is written in 6 ms and 1 MiB,
/// where OpenImageIO took 240 ms and 120 MiB, nearly all of it to load.
std::string read(const std::string& path, RowSink& sink) {
    const std::optional<bool> png = is_png_file(path);
    if (!png) return std::strerror(errno);
    if (*png) return read_png(path, sink);
    return module().files ? module().files->read(path, sink) : module().error;
}

std::string write(const std::string& path, const Image& image, SampleFormat format,
                  const ImageMetadata& metadata, const MoreChannels* more) {
    return is_exr_name(path) ? write_exr(path, image, metadata, more)
                             : write_png(path, image, format, metadata);
}

Status failure(const char* verb, const std::string& path, std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return Status::failure(fmt::format("cannot {} picture '{}': {}", verb, path, text));
}

} // namespace

void watch_libraries_load(void (*on_late)()) {
    on_late_libraries = on_late;
}

bool is_exr_name(const std::string& path) {
    return extension(path) == ".exr";
}

bool is_picture_name(const std::string& path) {
    return is_exr_name(path) || extension(path) == ".png";
}

Status read_rows(const std::string& path, RowSink& sink) {
    if (is_special_file(path)) return failure("read", path, "it is " + special_file_text(path));
    const std::string error = read(path, sink);
    return error.empty() ? Status() : failure("read", path, error);
}

std::string ImageSink::begin(int width, int height, int channels) {
    row_samples_ = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    if (row_samples_ > most_samples_ / static_cast<std::uint64_t>(height)) return "it is too large";
    image_ = {width, height, channels, {}};
    // Reserved, not cleared: a file that promises much and holds little touches little memory.
    image_.pixels.reserve(row_samples_ * static_cast<std::size_t>(height));
    return {};
}

void ImageSink::take(const float* samples) {
    image_.pixels.insert(image_.pixels.end(), samples, samples + row_samples_);
}

std::string ImageRows::give(float* samples) {
    const std::size_t count =
        static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.channels);
    std::copy_n(image_.pixels.begin() + static_cast<std::ptrdiff_t>(given_), count, samples);
    given_ += count;
    return {};
}

Status read_image(const std::string& path, Image& image) {
    ImageSink sink(image, most_samples);
    return read_rows(path, sink);
}

Status read_povray_image(const std::string& path, Image& image) {
    if (is_exr_name(path) && read_povray_exr(path, most_samples, image)) return {};
    return read_image(path, image);
}

Status write_image(const std::string& path, const Image& image, SampleFormat format,
                   const ImageMetadata& metadata, const MoreChannels* more) {
    PendingFile pending(path);
    const Status status =
        pending.status().ok() ? write_image(pending, image, format, metadata, more) : pending.status();
    return status.ok() ? pending.commit() : status;
}

Status write_image(const PendingFile& pending, const Image& image, SampleFormat format,
                   const ImageMetadata& metadata, const MoreChannels* more) {
    GRAFTAL_CHECK(is_picture_name(pending.path()), pending.path());
    GRAFTAL_CHECK(!more || is_exr_name(pending.path()), pending.path());
    const std::string error = write(pending.temporary_path(), image, format, metadata, more);
    return error.empty() ? Status() : failure("write", pending.path(), error);
}

Status write_rows(const std::string& path, const RowShape& shape, RowSource& rows, SampleFormat format,
                  const ImageMetadata& metadata) {
    GRAFTAL_CHECK(is_picture_name(path) && 1 <= shape.channels && shape.channels <= 4, path);
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    const std::string error = is_exr_name(path)
                                  ? write_exr_rows(pending.temporary_path(), shape, rows, metadata)
                                  : write_png_rows(pending.temporary_path(), shape, rows, format, metadata);
    if (error == "interrupted") return Status::failure(error);
    return error.empty() ? pending.commit() : failure("write", path, error);
}

Status write_palette(const PendingFile& pending, int width, int height, std::span<const Rgb> pixels) {
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    GRAFTAL_CHECK(!pixels.empty() && pixels.size() <= size, pending.path());
    std::vector<std::uint16_t> levels;
    levels.reserve(3 * size);
    for (std::size_t i = 0; i < size; ++i) {
        const Rgb& rgb = pixels[std::min(i, pixels.size() - 1)];
        for (int c = 0; c < 3; ++c)
            levels.push_back(static_cast<std::uint16_t>(65535 * std::clamp(rgb[c], 0.0, 1.0) + 0.5));
    }
    const std::string error = write_png_levels(pending.temporary_path(), width, height, levels);
    return error.empty() ? Status() : failure("write", pending.path(), error);
}

} // namespace graftal
