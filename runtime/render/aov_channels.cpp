#include "runtime/render/aov_channels.h"

#include <set>

#include <fmt/format.h>

#include "runtime/render/matte_channels.h"

namespace graftal {

MoreChannels aov_channels(const AovPicture& aovs, const CutGraph& cut, const View& view, bool alpha) {
    const ObjectNumbers numbers(cut);
    MoreChannels more;
    more.names = {"coverage", "Z",        "normal.X", "normal.Y", "normal.Z",
                  "albedo.R", "albedo.G", "albedo.B", "id",       "levels"};
    if (alpha) more.names.insert(more.names.begin(), "A");
    const std::vector<std::string> of_mattes = matte_channel_names();
    more.names.insert(more.names.end(), of_mattes.begin(), of_mattes.end());
    more.samples.reserve(aovs.pixels.size() * more.names.size());
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < aovs.pixels.size(); ++i) {
        const AovPixel& pixel = aovs.pixels[i];
        const std::uint32_t number = numbers.of(pixel.node);
        if (number > 0) seen.insert(number);
        if (alpha) more.samples.push_back(1);
        more.samples.insert(more.samples.end(), {pixel.coverage, pixel.depth});
        more.samples.insert(more.samples.end(), std::begin(pixel.normal), std::end(pixel.normal));
        more.samples.insert(more.samples.end(), std::begin(pixel.albedo), std::end(pixel.albedo));
        more.samples.insert(more.samples.end(),
                            {static_cast<float>(number), static_cast<float>(pixel.levels)});
        append_mattes(aovs.mattes[i], more.samples);
    }
    std::string names;
    for (const std::uint32_t number : seen)
        names += fmt::format("{} {}\n", number, numbers.names()[number - 1]);
    more.tags = matte_tags(aovs.mattes, cut, view);
    more.tags.insert(more.tags.begin(), {"graftal:ids", names});
    return more;
}

} // namespace graftal
