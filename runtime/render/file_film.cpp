#include "runtime/render/file_film.h"

#include <algorithm>

#include "runtime/image/develop.h"
#include "runtime/render/aov_channels.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

FileFilm::FileFilm(const RenderOptions& options, const Film& film, const CutGraph& cut)
    : options_(options), film_(film) {
    if (options.aovs) numbers_.emplace(cut);
}

void FileFilm::begin(const Tile& window, int) {
    window_ = window;
}

Status FileFilm::end(int, const Image& picture, const AovPicture* aovs) {
    MoreChannels more;
    if (aovs) more = aov_channels(*aovs, *numbers_);
    const bool linear = options_.format == SampleFormat::linear16 || is_exr_name(options_.output);
    const Image developed =
        linear ? Image()
               : developed_picture(picture, window_, film_, options_.format, WorkerThreads(options_.threads));
    return write_image(options_.output, linear ? picture : developed, options_.format, options_.metadata,
                       aovs ? &more : nullptr);
}

Image developed_picture(const Image& picture, const Tile& window, const Film& film, SampleFormat format,
                        const Workers& workers) {
    constexpr int rows = 16; // a piece of work
    Image image = picture;
    const Developer developer(film, format, window.x, window.y);
    workers.for_each(static_cast<std::uint64_t>((image.height + rows - 1) / rows),
                     [&](int, std::uint64_t piece) {
                         const int begin = static_cast<int>(piece) * rows;
                         developer.develop(image, begin, std::min(begin + rows, image.height));
                     });
    return image;
}

} // namespace graftal
