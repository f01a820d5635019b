#include "tests/unit/studio/page.h"

#include <algorithm>
#include <array>

#include <zlib.h>

namespace graftal {

SeenTile read_tile(const std::string& message) {
    std::array<std::uint32_t, 8> words{};
    for (std::size_t i = 0; i < 32; ++i)
        words[i / 4] |= std::uint32_t{static_cast<unsigned char>(message[i])} << 8 * (i % 4);
    EXPECT_EQ(words[0], 0x4c495447u);
    const auto number = [&](std::size_t i) { return static_cast<int>(words[i]); };
    SeenTile tile{words[1], words[2], number(3), number(4), number(5), number(6), number(7), {}};
    const auto samples = [&](int pixels) {
        return static_cast<std::size_t>((pixels + tile.block - 1) / tile.block);
    };
    tile.rgb.resize(3 * samples(tile.width) * samples(tile.height));
    uLongf size = tile.rgb.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(tile.rgb.data()), &size,
                         reinterpret_cast<const Bytef*>(message.data() + 32), message.size() - 32),
              Z_OK);
    EXPECT_EQ(size, tile.rgb.size());
    return tile;
}

std::uint32_t Page::show(nlohmann::json fields) {
    nlohmann::json state{{"type", "state"}, {"number", ++number}, {"name", "crystal.rifs"},
                         {"width", 64},     {"height", 36},       {"quality", "draft"}};
    state.update(fields);
    say(state);
    return number;
}

nlohmann::json Page::ask(const std::string& what, nlohmann::json fields) {
    nlohmann::json message{{"type", "ask"}, {"id", ++id}, {"what", what}};
    message.update(fields);
    say(message);
    work();
    const auto answer = std::ranges::find_if(
        heard, [&](const nlohmann::json& said) { return said["type"] == "answer" && said["id"] == id; });
    return answer == heard.end() ? nlohmann::json() : *answer;
}

nlohmann::json Page::last(const std::string& type) const {
    const auto found = std::find_if(heard.rbegin(), heard.rend(),
                                    [&](const nlohmann::json& said) { return said["type"] == type; });
    return found == heard.rend() ? nlohmann::json() : *found;
}

std::size_t Page::count(const std::string& type) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(heard, [&](const nlohmann::json& said) { return said["type"] == type; }));
}

std::string Page::picture(int width, int height) const {
    std::string picture(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), '\0');
    for (const SeenTile& tile : tiles) {
        if (tile.number != number) continue;
        const int across = (tile.width + tile.block - 1) / tile.block;
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x)
                std::copy_n(tile.rgb.begin() + 3 * (y / tile.block * across + x / tile.block), 3,
                            picture.begin() + 3 * ((tile.y + y) * width + tile.x + x));
    }
    return picture;
}

} // namespace graftal
