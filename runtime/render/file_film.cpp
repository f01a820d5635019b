#include "runtime/render/file_film.h"

#include <algorithm>

#include "runtime/image/develop.h"
#include "runtime/render/aov_channels.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

/// With the coverage for alpha. Behind the model all is black, so that the light is premultiplied already;
/// straight, it is that of what is met alone.
Image with_alpha(const Image& picture, const AovPicture& aovs, bool straight) {
    Image image{picture.width, picture.height, 4, {}};
    image.pixels.reserve(4 * aovs.pixels.size());
    for (std::size_t i = 0; i < aovs.pixels.size(); ++i) {
        const float alpha = aovs.pixels[i].coverage;
        const float share = straight && alpha > 0 ? 1 / alpha : 1;
        for (std::size_t k = 0; k < 3; ++k)
            image.pixels.push_back(share * picture.pixels[3 * i + k]);
        image.pixels.push_back(alpha);
    }
    return image;
}

} // namespace

Status DevelopedFilm::end(int, const Image& picture, const AovPicture* aovs) {
    const SampleFormat format = options_.format;
    const bool exr = is_exr_name(options_.output);
    const bool transparent = options_.compile.view.transparent && aovs;
    Image image = transparent ? with_alpha(picture, *aovs, !exr) : picture;
    if (format == SampleFormat::linear16 || exr) return take(image, aovs);
    constexpr int rows = 16; // a piece of work
    const Developer developer(shape().view.film, format, shape().window.x, shape().window.y);
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
    const bool has_more = options().aovs && aovs;
    if (has_more) more = aov_channels(*aovs, shape().cut, shape().view, developed.channels < 4);
    return write_image(options().output, developed, options().format, options().metadata,
                       has_more ? &more : nullptr);
}

} // namespace graftal
