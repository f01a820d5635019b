// blocks_bench rate PICTURE TOLERANCE...: codes a picture by blocks, and prints a line of fields, separated
// by tabs, for each tolerance: that, bits a pixel, PSNR in dB and SSIM; PSNR and SSIM of JPEG, and of WebP,
// at the quality whose file is nearest in size; seconds of coding and of decoding. "-" where no quality comes
// near.
//
// blocks_bench enlarge PICTURE TOLERANCE: codes the picture at a quarter of its width, and prints PSNR and
// SSIM of four times that: by blocks, by bicubic interpolation of what was coded, and by blocks and bicubic
// where they start from the decoded picture; and the bits for each of the small pixels.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "runtime/image_files/image_files.h"
#include "runtime/inverse/blocks/decode.h"
#include "runtime/inverse/blocks/encode.h"
#include "runtime/inverse/blocks/pifs_file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

namespace oiio = OIIO;

struct Likeness {
    double psnr = 0, ssim = 0;
};

/// Eight-bit levels, as every viewer shows them.
Image shown(Image image) {
    for (float& sample : image.pixels)
        sample = static_cast<float>(level8_of(sample)) / 255;
    return image;
}

std::vector<double> luma(const Image& image) {
    const auto channels = static_cast<std::size_t>(image.channels);
    std::vector<double> luma;
    for (std::size_t i = 0; i < image.pixels.size(); i += channels)
        luma.push_back(255 * (channels < 3 ? double{image.pixels[i]}
                                           : 0.299 * image.pixels[i] + 0.587 * image.pixels[i + 1] +
                                                 0.114 * image.pixels[i + 2]));
    return luma;
}

/// The mean is weighed by a Gaussian of 11 by 11 pixels with a deviation of 1.5; only where it lies inside
/// the picture.
std::vector<double> blurred(const std::vector<double>& values, int width, int height) {
    constexpr int reach = 5;
    double weights[2 * reach + 1], sum = 0;
    for (int i = -reach; i <= reach; ++i)
        sum += (weights[i + reach] = std::exp(-i * i / 4.5));
    const auto at = [&](const std::vector<double>& from, int x, int y) {
        return from[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)];
    };
    std::vector<double> rows(values.size()), result;
    for (int y = 0; y < height; ++y)
        for (int x = reach; x < width - reach; ++x) {
            double& to = rows[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
            for (int i = -reach; i <= reach; ++i)
                to += weights[i + reach] / sum * at(values, x + i, y);
        }
    for (int y = reach; y < height - reach; ++y)
        for (int x = reach; x < width - reach; ++x) {
            double to = 0;
            for (int i = -reach; i <= reach; ++i)
                to += weights[i + reach] / sum * at(rows, x, y + i);
            result.push_back(to);
        }
    return result;
}

/// PSNR over all channels; mean SSIM of the luma (Wang, Bovik, Sheikh and Simoncelli 2004).
Likeness quality(const Image& original, const Image& other) {
    double sum = 0;
    for (std::size_t i = 0; i < original.pixels.size(); ++i)
        sum += std::pow(255.0 * (original.pixels[i] - other.pixels[i]), 2);
    Likeness quality;
    quality.psnr = 10 * std::log10(255 * 255 * static_cast<double>(original.pixels.size()) / sum);
    const std::vector<double> a = luma(original), b = luma(other);
    std::vector<double> aa, bb, ab;
    for (std::size_t i = 0; i < a.size(); ++i) {
        aa.push_back(a[i] * a[i]);
        bb.push_back(b[i] * b[i]);
        ab.push_back(a[i] * b[i]);
    }
    const int w = original.width, h = original.height;
    const std::vector<double> ma = blurred(a, w, h), mb = blurred(b, w, h), maa = blurred(aa, w, h),
                              mbb = blurred(bb, w, h), mab = blurred(ab, w, h);
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    for (std::size_t i = 0; i < ma.size(); ++i)
        quality.ssim +=
            (2 * ma[i] * mb[i] + c1) * (2 * (mab[i] - ma[i] * mb[i]) + c2) /
            ((ma[i] * ma[i] + mb[i] * mb[i] + c1) * (maa[i] - ma[i] * ma[i] + mbb[i] - mb[i] * mb[i] + c2)) /
            static_cast<double>(ma.size());
    return quality;
}

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Image decoded(const BlockPicture& blocks, int width, int height) {
    return image_of(decode_blocks(blocks, width, height, SerialWorkers(), no_control(), {}));
}

/// WebP has no grey pictures: three equal channels, or the luma of three.
Image in_channels(const Image& image, int channels) {
    if (image.channels == channels) return image;
    Image other{image.width, image.height, channels, {}};
    for (const double level : luma(image))
        other.pixels.insert(other.pixels.end(), static_cast<std::size_t>(channels),
                            static_cast<float>(level / 255));
    return other;
}

/// A picture as another format keeps it.
class Rival {
  public:
    Rival(const Image& original, const char* ending, const char* name)
        : original_(original), kept_(in_channels(original, 3)), name_(name) {
        if (name_ == "jpeg") kept_ = original;
        if (!folder_.create().ok()) std::exit(3);
        path_ = folder_.path() + "/rival." + ending;
    }

    /// The best quality whose file has at most so many bytes and one in a hundred more.
    std::string fields(std::size_t bytes) {
        int low = 0, high = 100; // low: small enough
        while (high - low > 1) {
            const int middle = (low + high) / 2;
            (written(middle) <= bytes + bytes / 100 ? low : high) = middle;
        }
        if (low == 0) return "-\t-";
        written(low);
        Image image;
        if (!read_image(path_, image).ok()) std::exit(3);
        const Likeness got = quality(original_, in_channels(image, original_.channels));
        char text[80];
        std::snprintf(text, sizeof text, "%.2f\t%.4f", got.psnr, got.ssim);
        return text;
    }

  private:
    std::size_t written(int quality) const {
        oiio::ImageSpec spec(kept_.width, kept_.height, kept_.channels, oiio::TypeDesc::UINT8);
        spec.attribute("Compression", name_ + ":" + std::to_string(quality));
        const auto file = oiio::ImageOutput::create(path_);
        if (!file || !file->open(path_, spec) ||
            !file->write_image(oiio::TypeDesc::FLOAT, kept_.pixels.data()) || !file->close())
            std::exit(3);
        return std::filesystem::file_size(path_);
    }

    const Image& original_;
    Image kept_;
    std::string name_;
    TemporaryDirectory folder_;
    std::string path_;
};

void rate(const Image& original, double tolerance) {
    const double begun = seconds();
    const BlockPicture blocks =
        find_blocks(planes_of(original), {tolerance, 1e6}, SerialWorkers(), {}, {}).picture;
    const std::size_t bytes = pifs_text(blocks).size();
    const double coded = seconds();
    const Image again = shown(decoded(blocks, original.width, original.height));
    const double done = seconds();
    const Likeness got = quality(original, again);
    Rival jpeg(original, "jpg", "jpeg"), webp(original, "webp", "webp");
    const std::string of_jpeg = jpeg.fields(bytes), of_webp = webp.fields(bytes);
    std::printf("%g\t%.3f\t%.2f\t%.4f\t%s\t%s\t%.2f\t%.2f\n", tolerance,
                8.0 * static_cast<double>(bytes) / (static_cast<double>(original.width) * original.height),
                got.psnr, got.ssim, of_jpeg.c_str(), of_webp.c_str(), coded - begun, done - coded);
    std::fflush(stdout);
}

Image resized(const Image& image, int width, int height, const char* filter) {
    const oiio::ImageSpec spec(image.width, image.height, image.channels, oiio::TypeDesc::FLOAT);
    std::vector<float> pixels = image.pixels;
    const oiio::ImageBuf from(spec, pixels.data());
    const oiio::ImageBuf to = oiio::ImageBufAlgo::resize(
        from, filter, 0.0f, oiio::ROI(0, width, 0, height, 0, 1, 0, image.channels));
    Image result{width, height, image.channels,
                 std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                    static_cast<std::size_t>(image.channels))};
    to.get_pixels(to.roi(), oiio::TypeDesc::FLOAT, result.pixels.data());
    return result;
}

void enlarge(const Image& whole, double tolerance) {
    const int width = whole.width / 4, height = whole.height / 4;
    Image original{4 * width, 4 * height, whole.channels, {}};
    const auto channels = static_cast<std::size_t>(whole.channels);
    for (int y = 0; y < original.height; ++y) {
        const auto row =
            whole.pixels.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * channels *
                                                               static_cast<std::size_t>(whole.width));
        original.pixels.insert(original.pixels.end(), row,
                               row + static_cast<std::ptrdiff_t>(channels) * original.width);
    }
    const Image small = shown(resized(original, width, height, "box"));
    const BlockPicture blocks =
        find_blocks(planes_of(small), {tolerance, 1e6}, SerialWorkers(), {}, {}).picture;
    const Image large = shown(decoded(blocks, original.width, original.height));
    const auto bicubic = [&](const Image& from) {
        return quality(original, shown(resized(from, original.width, original.height, "catmull-rom")));
    };
    const Likeness of_blocks = quality(original, large), of_original = bicubic(small),
                   of_decoded = bicubic(shown(decoded(blocks, width, height)));
    std::printf("%.2f\t%.4f\t%.2f\t%.4f\t%.2f\t%.4f\t%.2f\n", of_blocks.psnr, of_blocks.ssim,
                of_original.psnr, of_original.ssim, of_decoded.psnr, of_decoded.ssim,
                8.0 * static_cast<double>(pifs_text(blocks).size()) / (static_cast<double>(width) * height));
}

int run(int argc, char** argv) {
    const std::string what = argc > 3 ? argv[1] : "";
    if (what != "rate" && what != "enlarge")
        return std::fprintf(stderr, "blocks_bench rate|enlarge PICTURE TOLERANCE...\n"), 2;
    Image original;
    if (const Status status = read_image(argv[2], original); !status.ok())
        return std::fprintf(stderr, "%s\n", status.message().c_str()), 3;
    // A grey picture may come as a coloured one.
    const PicturePlanes planes = planes_of(original);
    if (!planes.colour && !planes.alpha) original = image_of(planes);
    for (int i = 3; i < argc; ++i)
        what == "rate" ? rate(original, std::atof(argv[i])) : enlarge(original, std::atof(argv[i]));
    return 0;
}

} // namespace
} // namespace graftal

int main(int argc, char** argv) {
    return graftal::run(argc, argv);
}
