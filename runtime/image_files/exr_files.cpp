#include "runtime/image_files/exr_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include <openexr.h>

namespace graftal {

namespace {

/// The file that OpenEXR writes to. It keeps the first thing that goes wrong.
class ExrFile {
  public:
    explicit ExrFile(const std::string& path) : file_(std::fopen(path.c_str(), "wb")) {
        if (!file_) error_ = std::strerror(errno);
        exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
        how.user_data = this;
        how.write_fn = &ExrFile::write;
        how.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {}; // else it prints
        if (file_) check(exr_start_write(&context_, path.c_str(), EXR_WRITE_FILE_DIRECTLY, &how));
    }
    ~ExrFile() {
        if (encodes_) exr_encoding_destroy(context_, &encoder_);
        if (context_) exr_finish(&context_);
        if (file_) std::fclose(file_);
    }
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    bool ok() const { return error_.empty(); }

    /// `channels`: by name, as a pixel has them together.
    void begin(int width, int height, std::span<const std::string> channels) {
        if (!ok()) return;
        channels_ = channels;
        width_ = width;
        int part = 0;
        check(exr_add_part(context_, nullptr, EXR_STORAGE_SCANLINE, &part));
        check(exr_initialize_required_attr_simple(context_, 0, width, height, EXR_COMPRESSION_ZIP));
        for (const std::string& name : channels)
            check(exr_add_channel(context_, 0, name.c_str(), EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1,
                                  1));
    }

    void tag(const char* name, const std::string& text) {
        if (ok() && !text.empty()) check(exr_attr_set_string(context_, 0, name, text.c_str()));
    }

    /// After the tags.
    int rows_at_once() {
        int rows = 1;
        if (ok()) check(exr_write_header(context_));
        if (ok()) check(exr_get_scanlines_per_chunk(context_, 0, &rows));
        return rows;
    }

    /// Adds a chunk's rows, or those that are left at the bottom.
    void add(int y, const float* samples) {
        exr_chunk_info_t chunk;
        if (!ok() || !check(exr_write_scanline_chunk_info(context_, 0, y, &chunk))) return;
        const bool first = !std::exchange(encodes_, true);
        check(first ? exr_encoding_initialize(context_, 0, &chunk, &encoder_)
                    : exr_encoding_update(context_, 0, &chunk, &encoder_));
        if (!ok()) return;
        for (exr_coding_channel_info_t& channel : std::span(encoder_.channels, channels_.size())) {
            const auto at = std::ranges::find(channels_, channel.channel_name) - channels_.begin();
            const auto pixel = static_cast<std::int32_t>(sizeof(float) * channels_.size());
            channel.encode_from_ptr = reinterpret_cast<const std::uint8_t*>(samples + at);
            channel.user_pixel_stride = pixel;
            channel.user_line_stride = width_ * pixel;
            channel.user_bytes_per_element = sizeof(float);
            channel.user_data_type = EXR_PIXEL_FLOAT;
        }
        if (first && check(exr_encoding_choose_default_routines(context_, 0, &encoder_))) {
            compress_ = encoder_.compress_fn;
            encoder_.encoding_user_data = this;
            encoder_.compress_fn = &ExrFile::compress;
        }
        if (ok()) check(exr_encoding_run(context_, 0, &encoder_));
    }

    /// The first error's text, or "".
    std::string finish() {
        if (std::exchange(encodes_, false)) exr_encoding_destroy(context_, &encoder_);
        if (context_) check(exr_finish(&context_)); // writes where the chunks are
        if (file_ && std::fclose(std::exchange(file_, nullptr)) != 0) note(errno);
        return error_;
    }

  private:
    static std::int64_t write(exr_const_context_t, void* self, const void* bytes, std::uint64_t count,
                              std::uint64_t offset, exr_stream_error_func_ptr_t) {
        ExrFile& file = *static_cast<ExrFile*>(self);
        const bool is_there =
            offset == file.offset_ || ::fseeko(file.file_, static_cast<off_t>(offset), SEEK_SET) == 0;
        if (!is_there || std::fwrite(bytes, 1, count, file.file_) != count) {
            file.note(errno);
            return -1;
        }
        file.offset_ = offset + count;
        return static_cast<std::int64_t>(count);
    }

    /// Stores data that compression does not shrink as they are: readers tell them by their size. OpenEXR
    /// 3.1's core would store the compressed bytes of that very size.
    static exr_result_t compress(exr_encode_pipeline_t* encoder) {
        const exr_result_t result = static_cast<ExrFile*>(encoder->encoding_user_data)->compress_(encoder);
        if (result == EXR_ERR_SUCCESS && encoder->compressed_bytes == encoder->packed_bytes)
            std::memcpy(encoder->compressed_buffer, encoder->packed_buffer, encoder->packed_bytes);
        return result;
    }

    void note(int number) {
        if (ok()) error_ = std::strerror(number ? number : EIO);
    }

    bool check(exr_result_t result) {
        if (ok() && result != EXR_ERR_SUCCESS) error_ = exr_get_default_error_message(result);
        return ok();
    }

    std::FILE* file_;
    std::uint64_t offset_ = 0;
    exr_context_t context_ = nullptr;
    exr_encode_pipeline_t encoder_ = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t (*compress_)(exr_encode_pipeline_t*) = nullptr; ///< OpenEXR's
    bool encodes_ = false;
    std::span<const std::string> channels_;
    int width_ = 0;
    std::string error_;
};

/// The channels' names in OpenEXR: grey is luminance.
std::vector<std::string> names_of(int channels) {
    if (channels <= 2)
        return channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"Y", "A"};
    std::vector<std::string> names{"R", "G", "B", "A"};
    names.resize(static_cast<std::size_t>(channels));
    return names;
}

/// `give_row`: fills in a row, and says what went wrong, or "".
template<typename GiveRow>
std::string write_bands(const std::string& path, int width, int height,
                        const std::vector<std::string>& channels, const ImageMetadata& metadata,
                        const std::vector<std::pair<std::string, std::string>>& tags,
                        const GiveRow& give_row) {
    ExrFile file(path);
    file.begin(width, height, channels);
    file.tag("Software", metadata.software);
    file.tag("comments", metadata.description);
    file.tag(stamp_keyword, metadata.stamp);
    for (const auto& [name, text] : tags)
        file.tag(name.c_str(), text);
    const int band = file.rows_at_once();
    const std::size_t row_samples = static_cast<std::size_t>(width) * channels.size();
    std::vector<float> samples(static_cast<std::size_t>(band) * row_samples);
    for (int y = 0; y < height && file.ok(); y += band) {
        for (int row = y; row < std::min(y + band, height); ++row) {
            std::string problem =
                give_row(row, samples.data() + static_cast<std::size_t>(row - y) * row_samples);
            if (!problem.empty()) return problem;
        }
        file.add(y, samples.data());
    }
    return file.finish();
}

class ExrReader {
  public:
    explicit ExrReader(const std::string& path) {
        exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
        how.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
        good_ = exr_start_read(&context_, path.c_str(), &how) == EXR_ERR_SUCCESS;
    }
    ~ExrReader() {
        if (decodes_) exr_decoding_destroy(context_, &decoder_);
        if (context_) exr_finish(&context_);
    }
    ExrReader(const ExrReader&) = delete;
    ExrReader& operator=(const ExrReader&) = delete;

    bool read(std::uint64_t most_samples, Image& image) {
        if (!good_ || !is_plain()) return false;
        exr_attr_box2i_t box;
        std::int32_t band = 0;
        if (!done(exr_get_data_window(context_, 0, &box)) ||
            !done(exr_get_scanlines_per_chunk(context_, 0, &band)))
            return false;
        const std::int64_t width = std::int64_t{box.max.x} - box.min.x + 1,
                           height = std::int64_t{box.max.y} - box.min.y + 1;
        const auto channels = static_cast<std::int64_t>(names_.size());
        if (width < 1 || height < 1 || width > most_side || height > most_side ||
            static_cast<std::uint64_t>(width * height * channels) > most_samples)
            return false;
        image = {static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels), {}};
        image.pixels.resize(static_cast<std::size_t>(width * height * channels));
        for (std::int64_t row = 0; row < height; row += band)
            if (!read_rows(static_cast<int>(box.min.y + row),
                           image.pixels.data() + static_cast<std::size_t>(row * width * channels), image))
                return false;
        return true;
    }

  private:
    static constexpr std::int64_t most_side = 1 << 20;

    static bool done(exr_result_t result) { return result == EXR_ERR_SUCCESS; }

    bool is_plain() {
        int parts = 0;
        exr_storage_t storage = EXR_STORAGE_TILED;
        const exr_attr_chlist_t* channels = nullptr;
        if (!done(exr_get_count(context_, &parts)) || parts != 1 ||
            !done(exr_get_storage(context_, 0, &storage)) || storage != EXR_STORAGE_SCANLINE ||
            !done(exr_get_channels(context_, 0, &channels)) ||
            (channels->num_channels != 3 && channels->num_channels != 4))
            return false;
        names_ = names_of(channels->num_channels);
        return std::ranges::all_of(std::span(channels->entries, names_.size()), [&](const auto& entry) {
            return std::ranges::count(names_, entry.name.str) == 1 && entry.x_sampling == 1 &&
                   entry.y_sampling == 1 && entry.pixel_type != EXR_PIXEL_UINT;
        });
    }

    bool read_rows(int y, float* samples, const Image& image) {
        exr_chunk_info_t chunk;
        if (!done(exr_read_scanline_chunk_info(context_, 0, y, &chunk))) return false;
        const bool first = !std::exchange(decodes_, true);
        if (!done(first ? exr_decoding_initialize(context_, 0, &chunk, &decoder_)
                        : exr_decoding_update(context_, 0, &chunk, &decoder_)))
            return false;
        for (exr_coding_channel_info_t& channel : std::span(decoder_.channels, names_.size())) {
            const auto at = std::ranges::find(names_, channel.channel_name) - names_.begin();
            channel.decode_to_ptr = reinterpret_cast<std::uint8_t*>(samples + at);
            channel.user_pixel_stride = static_cast<std::int32_t>(sizeof(float) * names_.size());
            channel.user_line_stride = image.width * channel.user_pixel_stride;
            channel.user_bytes_per_element = sizeof(float);
            channel.user_data_type = EXR_PIXEL_FLOAT;
        }
        if (first && !done(exr_decoding_choose_default_routines(context_, 0, &decoder_))) return false;
        return done(exr_decoding_run(context_, 0, &decoder_));
    }

    exr_context_t context_ = nullptr;
    exr_decode_pipeline_t decoder_ = EXR_DECODE_PIPELINE_INITIALIZER;
    bool good_ = false, decodes_ = false;
    std::vector<std::string> names_; ///< of the channels, as Image has them
};

} // namespace

bool read_povray_exr(const std::string& path, std::uint64_t most_samples, Image& image) {
    return ExrReader(path).read(most_samples, image);
}

std::string write_exr_rows(const std::string& path, const RowShape& shape, RowSource& rows,
                           const ImageMetadata& metadata) {
    return write_bands(path, shape.width, shape.height, names_of(shape.channels), metadata, {},
                       [&](int, float* to) { return rows.give(to); });
}

std::string write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata,
                      const MoreChannels* more) {
    static const MoreChannels none;
    const MoreChannels& others = more ? *more : none;
    std::vector<std::string> names = names_of(image.channels);
    const std::size_t own = names.size();
    names.insert(names.end(), others.names.begin(), others.names.end());
    const auto width = static_cast<std::size_t>(image.width);
    return write_bands(path, image.width, image.height, names, metadata, others.tags, [&](int y, float* to) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        for (std::size_t pixel = first; pixel < first + width; ++pixel) {
            to = std::copy_n(image.pixels.data() + pixel * own, own, to);
            to = std::copy_n(others.samples.data() + pixel * others.names.size(), others.names.size(), to);
        }
        return std::string();
    });
}

} // namespace graftal
