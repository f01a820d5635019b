#include "runtime/farm/contact_sheet.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/image/texture.h"
#include "runtime/image_files/small_text.h"
#include "runtime/trace/tile.h"

namespace graftal {

namespace {

constexpr int channels = 3, most_sheet_width = 8192, largest_cell = 320, gap = 4;
constexpr int label_height = letter_height_px + 2;

/// Reads nothing but the head of a picture.
class HeadSink : public RowSink {
  public:
    int width = 0, height = 0;
    std::string begin(int file_width, int file_height, int) override {
        width = file_width;
        height = file_height;
        return "enough";
    }
    void take(const float*) override {}
};

struct Cell {
    int width, height;
};

/// Reduces a picture while it is read, to the mean light of squares of pixels.
class ReducedSink : public RowSink {
  public:
    explicit ReducedSink(Cell cell) : cell_(cell) {}

    std::string begin(int width, int height, int file_channels) override {
        if (file_channels < channels) return "it is not in colour";
        constexpr std::uint64_t most_pixels = 1u << 28;
        if (whole_of({width, height}).pixels() > most_pixels) return "it is too large";
        file_width_ = width;
        file_channels_ = file_channels;
        factor_ = std::max(
            {1, (width + cell_.width - 1) / cell_.width, (height + cell_.height - 1) / cell_.height});
        picture.width = (width + factor_ - 1) / factor_;
        picture.height = (height + factor_ - 1) / factor_;
        picture.channels = channels;
        picture.pixels.assign(static_cast<std::size_t>(channels) * static_cast<std::size_t>(picture.width) *
                                  static_cast<std::size_t>(picture.height),
                              0);
        counts_.assign(picture.pixels.size() / channels, 0);
        return {};
    }

    void take(const float* samples) override {
        const std::size_t first =
            static_cast<std::size_t>(row_++ / factor_) * static_cast<std::size_t>(picture.width);
        for (int x = 0; x < file_width_; ++x, samples += file_channels_) {
            const std::size_t pixel = first + static_cast<std::size_t>(x / factor_);
            ++counts_[pixel];
            for (int c = 0; c < channels; ++c)
                picture.pixels[channels * pixel + static_cast<std::size_t>(c)] +=
                    static_cast<float>(srgb_decoded(level8_of(samples[c])));
        }
    }

    /// The sums into what is shown.
    void finish() {
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            picture.pixels[i] = srgb_encoded(picture.pixels[i] / static_cast<float>(counts_[i / channels]));
    }

    Image picture;

  private:
    Cell cell_;
    int file_width_ = 0, file_channels_ = 0, factor_ = 1, row_ = 0;
    std::vector<int> counts_;
};

/// The start of a label that fits, with ".." where some is missing.
std::string fitting(const std::string& label, int width) {
    const auto room = static_cast<std::size_t>(width / letter_width_px);
    if (label.size() <= room) return label;
    return room < 3 ? "" : label.substr(0, room - 2) + "..";
}

class SheetRows : public RowSource {
  public:
    SheetRows(const std::vector<SheetPicture>& pictures, std::uint64_t columns, Cell cell,
              const CancelFlag& cancel, const std::function<void(std::size_t)>& on_picture)
        : pictures_(pictures), columns_(columns), cell_(cell), cancel_(cancel), on_picture_(on_picture) {}

    RowShape shape() const {
        const int rows = static_cast<int>((pictures_.size() + columns_ - 1) / columns_);
        return {static_cast<int>(columns_) * (cell_.width + gap) + gap, rows * pitch() + gap, channels};
    }

    std::string give(float* samples) override {
        const int in_band = row_ % pitch();
        if (in_band == 0)
            if (std::string problem = read_band(row_ / pitch()); !problem.empty()) return problem;
        const auto count = static_cast<std::size_t>(shape().width * channels);
        std::copy_n(band_.pixels.begin() + static_cast<std::ptrdiff_t>(count) * in_band, count, samples);
        ++row_;
        return {};
    }

  private:
    int pitch() const { return gap + cell_.height + label_height; }

    /// A row of cells with their labels, and the gap above them.
    std::string read_band(int number) {
        band_.width = shape().width;
        band_.height = pitch();
        band_.channels = channels;
        band_.pixels.assign(static_cast<std::size_t>(channels) * static_cast<std::size_t>(band_.width) *
                                static_cast<std::size_t>(band_.height),
                            1);
        const std::size_t first = static_cast<std::size_t>(number) * columns_;
        const std::size_t end = std::min<std::size_t>(first + columns_, pictures_.size());
        for (std::size_t i = first; i < end; ++i) {
            if (cancel_.raised()) return "interrupted";
            ReducedSink sink(cell_);
            if (Status status = read_rows(pictures_[i].path, sink); !status.ok()) return status.message();
            sink.finish();
            set(sink.picture, pictures_[i].label, static_cast<int>(i - first));
            if (on_picture_) on_picture_(i + 1);
        }
        return {};
    }

    void set(const Image& picture, const std::string& label, int column) {
        const int cell_left = gap + column * (cell_.width + gap);
        const int left = cell_left + (cell_.width - picture.width) / 2;
        const int top = gap + (cell_.height - picture.height) / 2;
        const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(channels) * picture.width;
        for (int y = 0; y < picture.height; ++y)
            std::copy_n(picture.pixels.begin() + y * row, row,
                        band_.pixels.begin() +
                            channels * (static_cast<std::ptrdiff_t>(top + y) * band_.width + left));
        write_small_text(fitting(label, cell_.width), cell_left, band_.height - letter_height_px, 0, band_);
    }

    const std::vector<SheetPicture>& pictures_;
    std::uint64_t columns_;
    Cell cell_;
    const CancelFlag& cancel_;
    const std::function<void(std::size_t)>& on_picture_;
    Image band_; ///< one row of cells
    int row_ = 0;
};

/// In the shape of the first picture.
Status choose_cell(const std::string& first, std::uint64_t columns, Cell& cell) {
    HeadSink head;
    const Status status = read_rows(first, head);
    if (head.width == 0) return status;
    const int room = (most_sheet_width - gap) / static_cast<int>(columns) - gap;
    cell.width = std::clamp(room, 1, std::min(largest_cell, head.width));
    const std::int64_t height = static_cast<std::int64_t>(cell.width) * head.height / head.width;
    cell.height = static_cast<int>(std::clamp<std::int64_t>(height, 1, 4 * cell.width));
    return {};
}

} // namespace

Status write_contact_sheet(const std::string& path, const std::vector<SheetPicture>& pictures,
                           std::uint64_t columns, const ImageMetadata& metadata, const CancelFlag& cancel,
                           const std::function<void(std::size_t)>& on_picture) {
    columns = std::clamp<std::uint64_t>(columns, 1, (most_sheet_width - gap) / (gap + 1));
    Cell cell{};
    if (Status status = choose_cell(pictures.front().path, columns, cell); !status.ok()) return status;
    SheetRows rows(pictures, columns, cell, cancel, on_picture);
    return write_rows(path, rows.shape(), rows, SampleFormat::srgb8, metadata);
}

} // namespace graftal
