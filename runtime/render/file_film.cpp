#include "runtime/render/file_film.h"

#include <algorithm>

#include "runtime/image/develop.h"
#include "runtime/render/aov_channels.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

Status DevelopedFilm::end(int, const Image& picture, const AovPicture* aovs) {
    const SampleFormat format = options_.format;
    if (format == SampleFormat::linear16 || is_exr_name(options_.output)) return take(picture, aovs);
    constexpr int rows = 16; // a piece of work
    Image image = picture;
    const Developer developer(shape_.film, format, shape_.window.x, shape_.window.y);
    const auto develop = [&](int, std::uint64_t piece) {
        const int begin = static_cast<int>(piece) * rows;
        developer.develop(image, begin, std::min(begin + rows, image.height));
    };
    WorkerThreads(options_.threads)
        .for_each(static_cast<std::uint64_t>((image.height + rows - 1) / rows), develop);
    return take(image, aovs);
}

Status FileFilm::take(const Image& developed, const AovPicture* aovs) {
    MoreChannels more;
    if (aovs) more = aov_channels(*aovs, ObjectNumbers(cut_));
    return write_image(options().output, developed, options().format, options().metadata,
                       aovs ? &more : nullptr);
}

} // namespace graftal
