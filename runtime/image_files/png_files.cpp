#include "runtime/image_files/png_files.h"

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include <png.h>

#include "compiler/support/check.h"
#include "runtime/image_files/png_chunks.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

/// The first complaint of libpng; of fixed size, for no destructor would run on the way out of libpng.
struct Complaint {
    char text[200] = "";
};

[[noreturn]] void complain(png_structp png, png_const_charp text) {
    auto* const complaint = static_cast<Complaint*>(png_get_error_ptr(png));
    std::snprintf(complaint->text, sizeof complaint->text, "%s", text);
    png_longjmp(png, 1);
}

/// Warnings are about chunks that say nothing of the samples.
void ignore(png_structp, png_const_charp) {}

/// Calls libpng. It leaves `work` by longjmp after a complaint: nothing with a destructor may live in there.
template<typename Work> bool succeeds(png_structp png, const Work& work) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    work();
    return true;
}

int bytes_per_sample(int bits) {
    return bits / 8;
}

// Writing

void put_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    errno = 0;
    if (std::fwrite(bytes, 1, count, static_cast<std::FILE*>(png_get_io_ptr(png))) != count)
        png_error(png, std::strerror(errno ? errno : EIO));
}

void flush_nothing(png_structp) {}

struct Kind {
    int width, height, channels, bits;
    bool linear;
    bool compressed = true;
};

class Writer {
  public:
    explicit Writer(std::FILE* file)
        : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint_, complain, ignore)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {
        if (png_) png_set_write_fn(png_, file, put_bytes, flush_nothing);
    }
    ~Writer() { png_destroy_write_struct(&png_, &info_); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// `fill(y, row)` gives the bytes of each row, and says whether there are any.
    template<typename Fill>
    std::string write(const Kind& kind, const ImageMetadata& metadata, const Fill& fill) {
        if (!info_) return std::strerror(ENOMEM);
        std::vector<png_byte> row(static_cast<std::size_t>(kind.width) *
                                  static_cast<std::size_t>(kind.channels * bytes_per_sample(kind.bits)));
        const bool well = succeeds(png_, [&] {
            put_head(kind, metadata);
            for (int y = 0; y < kind.height; ++y) {
                if (!fill(y, row.data())) return;
                png_write_row(png_, row.data());
            }
            png_write_end(png_, nullptr);
        });
        return well ? "" : complaint_.text;
    }

  private:
    void put_head(const Kind& kind, const ImageMetadata& metadata) {
        constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                 PNG_COLOR_TYPE_RGB_ALPHA};
        png_set_IHDR(png_, info_, static_cast<png_uint_32>(kind.width), static_cast<png_uint_32>(kind.height),
                     kind.bits, types[kind.channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        if (kind.linear)
            png_set_gAMA(png_, info_, 1.0);
        else
            png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
        set_text("Software", metadata.software);
        set_text(stamp_keyword, metadata.stamp);
        set_text("Description", metadata.description);
        choose_compression(kind);
        png_write_info(png_, info_);
    }

    void set_text(const char* keyword, const std::string& text) {
        if (text.empty()) return;
        ::png_text entry{};
        entry.compression = PNG_TEXT_COMPRESSION_NONE;
        entry.key = const_cast<png_charp>(keyword);
        entry.text = const_cast<png_charp>(text.c_str());
        png_set_text(png_, info_, &entry, 1);
    }

    /// The fastest level: pictures are written again as they are refined. In 8 bit their flat grounds and
    /// repeated colours are best left to zlib as they are; in 16 bit differences of neighbours help. On
    /// average 2.9 ms and 105 kB a picture of docs/gallery, against 11.2 ms and 113 kB by libpng's defaults;
    /// in 16 bit 7.3 ms and 229 kB a picture of 640x360, against 30.6 ms and 188 kB.
    void choose_compression(const Kind& kind) {
        png_set_compression_level(png_, kind.compressed ? 1 : 0);
        png_set_filter(png_, PNG_FILTER_TYPE_BASE,
                       kind.compressed && kind.bits == 16 ? PNG_FILTER_SUB : PNG_FILTER_NONE);
    }

    Complaint complaint_;
    png_structp png_;
    png_infop info_;
};

template<typename Fill>
std::string write(const std::string& path, const Kind& kind, const ImageMetadata& metadata,
                  const Fill& fill) {
    OpenFile file(std::fopen(path.c_str(), "wb"));
    if (!file) return std::strerror(errno);
    const std::string error = Writer(file.get()).write(kind, metadata, fill);
    if (!error.empty()) return error;
    return std::fclose(file.release()) == 0 ? "" : std::strerror(errno);
}

void put_level16(png_byte* bytes, unsigned value) {
    bytes[0] = static_cast<png_byte>(value >> 8);
    bytes[1] = static_cast<png_byte>(value & 0xff);
}

void put_row(const float* values, std::size_t count, int bits, png_byte* row) {
    if (bits == 8)
        for (std::size_t i = 0; i < count; ++i)
            row[i] = level8_of(values[i]);
    else
        for (std::size_t i = 0; i < count; ++i)
            put_level16(row + 2 * i, level_of(values[i], 65535));
}

// Reading

void get_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto* const file = static_cast<std::FILE*>(png_get_io_ptr(png));
    if (std::fread(bytes, 1, count, file) != count)
        png_error(png, std::ferror(file) ? std::strerror(errno) : "it ends too early");
}

class Reader {
  public:
    explicit Reader(std::FILE* file)
        : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint_, complain, ignore)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {
        if (png_) png_set_read_fn(png_, file, get_bytes);
    }
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    std::string read(RowSink& sink) {
        if (!info_) return std::strerror(ENOMEM);
        if (!succeeds(png_, [&] { get_head(); })) return complaint_.text;
        const std::size_t width = png_get_image_width(png_, info_),
                          height = png_get_image_height(png_, info_);
        const int channels = png_get_channels(png_, info_);
        if (std::string error = sink.begin(static_cast<int>(width), static_cast<int>(height), channels);
            !error.empty())
            return error;
        const std::size_t row_bytes = png_get_rowbytes(png_, info_);
        std::vector<float> samples(width * static_cast<std::size_t>(channels));
        if (passes_ > 1) return read_interlaced(height, row_bytes, samples, sink);
        std::vector<png_byte> row(row_bytes);
        for (std::size_t y = 0; y < height; ++y) {
            if (!succeeds(png_, [&] { png_read_row(png_, row.data(), nullptr); })) return complaint_.text;
            hand_on(row.data(), samples, sink);
        }
        return succeeds(png_, [&] { png_read_end(png_, nullptr); }) ? "" : complaint_.text;
    }

  private:
    /// All kinds become 8 or 16 bit, without palette; a transparent colour becomes alpha.
    void get_head() {
        png_read_info(png_, info_);
        png_set_expand(png_);
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
    }

    /// Every pass goes over the whole picture.
    std::string read_interlaced(std::size_t height, std::size_t row_bytes, std::vector<float>& samples,
                                RowSink& sink) {
        constexpr std::size_t most_bytes = 256u << 20;
        if (row_bytes > most_bytes / height) return "it is interlaced and too large for that";
        // Not cleared, so that a file that promises much and holds little takes little memory.
        const auto bytes = std::make_unique_for_overwrite<png_byte[]>(row_bytes * height);
        const auto get_passes = [&] {
            for (int pass = 0; pass < passes_; ++pass)
                for (std::size_t y = 0; y < height; ++y)
                    png_read_row(png_, bytes.get() + y * row_bytes, nullptr);
            png_read_end(png_, nullptr);
        };
        if (!succeeds(png_, get_passes)) return complaint_.text;
        for (std::size_t y = 0; y < height; ++y)
            hand_on(bytes.get() + y * row_bytes, samples, sink);
        return {};
    }

    void hand_on(const png_byte* bytes, std::vector<float>& samples, RowSink& sink) const {
        if (png_get_bit_depth(png_, info_) == 8)
            std::transform(bytes, bytes + samples.size(), samples.begin(),
                           [](png_byte value) { return static_cast<float>(value) / 255.0f; });
        else
            for (std::size_t i = 0; i < samples.size(); ++i)
                samples[i] = static_cast<float>(bytes[2 * i] << 8 | bytes[2 * i + 1]) / 65535.0f;
        sink.take(samples.data());
    }

    Complaint complaint_;
    png_structp png_;
    png_infop info_;
    int passes_ = 1;
};

} // namespace

std::optional<bool> is_png_file(const std::string& path) {
    const OpenFile file(std::fopen(path.c_str(), "rb"));
    if (!file) return std::nullopt;
    char start[png_signature.size()];
    const std::size_t count = std::fread(start, 1, sizeof start, file.get());
    if (std::ferror(file.get())) return std::nullopt;
    return count == sizeof start && std::equal(start, start + sizeof start, png_signature.begin());
}

std::string read_png(const std::string& path, RowSink& sink) {
    const OpenFile file(std::fopen(path.c_str(), "rb"));
    return file ? Reader(file.get()).read(sink) : std::strerror(errno);
}

std::string write_png(const std::string& path, const Image& image, SampleFormat format,
                      const ImageMetadata& metadata) {
    ImageRows rows(image);
    return write_png_rows(path, {image.width, image.height, image.channels}, rows, format, metadata);
}

std::string write_png_rows(const std::string& path, const RowShape& shape, RowSource& rows,
                           SampleFormat format, const ImageMetadata& metadata) {
    GRAFTAL_CHECK(1 <= shape.channels && shape.channels <= 4, path);
    const Kind kind{shape.width, shape.height, shape.channels, format == SampleFormat::srgb8 ? 8 : 16,
                    format == SampleFormat::linear16};
    std::vector<float> samples(static_cast<std::size_t>(shape.width) *
                               static_cast<std::size_t>(shape.channels));
    std::string problem;
    const std::string error = write(path, kind, metadata, [&](int, png_byte* row) {
        problem = rows.give(samples.data());
        if (!problem.empty()) return false;
        put_row(samples.data(), samples.size(), kind.bits, row);
        return true;
    });
    return problem.empty() ? error : problem;
}

std::string write_png_levels(const std::string& path, int width, int height,
                             std::span<const std::uint16_t> levels) {
    const Kind kind{
        .width = width, .height = height, .channels = 3, .bits = 16, .linear = true, .compressed = false};
    const std::size_t row_samples = 3 * static_cast<std::size_t>(width);
    return write(path, kind, {}, [&](int y, png_byte* row) {
        for (std::size_t i = 0; i < row_samples; ++i)
            put_level16(row + 2 * i, levels[static_cast<std::size_t>(y) * row_samples + i]);
        return true;
    });
}

} // namespace graftal
