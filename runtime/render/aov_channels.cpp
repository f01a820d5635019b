#include "runtime/render/aov_channels.h"

#include <set>

#include <fmt/format.h>

namespace graftal {

MoreChannels aov_channels(const AovPicture& aovs, const ObjectNumbers& numbers, bool alpha) {
    MoreChannels more;
    more.names = {"coverage", "Z",        "normal.X", "normal.Y", "normal.Z",
                  "albedo.R", "albedo.G", "albedo.B", "id",       "levels"};
    if (alpha) more.names.insert(more.names.begin(), "A");
    more.samples.reserve(aovs.size() * more.names.size());
    std::set<std::uint32_t> seen;
    for (const AovPixel& pixel : aovs) {
        const std::uint32_t number = numbers.of(pixel.node);
        if (number > 0) seen.insert(number);
        if (alpha) more.samples.push_back(1);
        more.samples.insert(more.samples.end(), {pixel.coverage, pixel.depth});
        more.samples.insert(more.samples.end(), std::begin(pixel.normal), std::end(pixel.normal));
        more.samples.insert(more.samples.end(), std::begin(pixel.albedo), std::end(pixel.albedo));
        more.samples.insert(more.samples.end(),
                            {static_cast<float>(number), static_cast<float>(pixel.levels)});
    }
    std::string names;
    for (const std::uint32_t number : seen)
        names += fmt::format("{} {}\n", number, numbers.names()[number - 1]);
    more.tags = {{"graftal:ids", names}};
    return more;
}

} // namespace graftal
