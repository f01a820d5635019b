#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compiler/support/status.h"
#include "compiler/support/tint.h"
#include "runtime/image/image.h"
#include "runtime/image_files/row_sink.h"
#include "runtime/system/file.h"

namespace graftal {

/// Texts in a picture's file about its making.
struct ImageMetadata {
    std::string software;    ///< tag Software
    std::string description; ///< tag ImageDescription: the command line
    std::string stamp;       ///< tag graftal:stamp: what a frame of an animation was made from
};

/// Channels of an EXR besides the colours.
struct MoreChannels {
    std::vector<std::string> names; ///< OpenEXR's names, such as "normal.X"
    std::vector<float> samples;     ///< row by row, top first, the channels of a pixel together
    std::vector<std::pair<std::string, std::string>> tags; ///< name and text
};

/// True for names that write_image knows: `.png` and `.exr`, in any case.
bool is_picture_name(const std::string& path);
bool is_exr_name(const std::string& path);

inline constexpr const char* stamp_keyword = "graftal:stamp";

/// Keeps all of a picture; refuses one of more than `most_samples`.
class ImageSink : public RowSink {
  public:
    ImageSink(Image& image, std::uint64_t most_samples) : image_(image), most_samples_(most_samples) {}
    std::string begin(int width, int height, int channels) override;
    void take(const float* samples) override;

  private:
    Image& image_;
    std::uint64_t most_samples_;
    std::size_t row_samples_ = 0;
};

/// A library's own code runs while it is loaded, and may wait for ever: log4cplus does where one of its
/// threads cannot be made, and lets no signal through meanwhile. From now on a thread of its own calls
/// `on_late` where OpenImageIO takes 20 seconds to load. A program that must not hang calls this in its
/// main(). Without it nobody watches: a library or a server lets its host decide.
void watch_libraries_load(void (*on_late)());

/// Reads a regular file in any format that OpenImageIO knows, row by row where the format allows it.
Status read_rows(const std::string& path, RowSink& sink);

/// read_rows() into one image; refuses pictures of more than 2^28 samples (1 GiB).
Status read_image(const std::string& path, Image& image);

/// read_image() of a picture that POV-Ray has just made.
Status read_povray_image(const std::string& path, Image& image);

/// Gives the rows of a picture that outlives it.
class ImageRows : public RowSource {
  public:
    explicit ImageRows(const Image& image) : image_(image) {}
    std::string give(float* samples) override;

  private:
    const Image& image_;
    std::size_t given_ = 0; ///< samples
};

/// Writes `.png` or `.exr`, whole or not at all. Requires is_picture_name(path). The bytes depend on the
/// arguments only. Samples are clamped to [0, 1] in PNG. `more`: null, or requires an EXR.
Status write_image(const std::string& path, const Image& image, SampleFormat format,
                   const ImageMetadata& metadata = {}, const MoreChannels* more = nullptr);
/// write_image() without the commit.
Status write_image(const PendingFile& pending, const Image& image, SampleFormat format,
                   const ImageMetadata& metadata = {}, const MoreChannels* more = nullptr);

/// write_image() of rows that come one after the other: the same bytes, whatever the size, in memory for a
/// few rows. Requires 1 to 4 channels.
Status write_rows(const std::string& path, const RowShape& shape, RowSource& rows, SampleFormat format,
                  const ImageMetadata& metadata = {});

/// Writes a 16-bit PNG of linear values for an SDL image_map with `gamma 1.0`: sample = round(65535 value).
/// Pixels that are missing at the end are filled with the last. Does not commit. Requires
/// 0 < pixels.size() <= width * height.
Status write_palette(const PendingFile& pending, int width, int height, std::span<const Rgb> pixels);

} // namespace graftal
