#include "runtime/image_files/small_text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace graftal {

namespace {

constexpr char first_letter = ' ', last_letter = '~';

/// The letters' pixels, row by row from the top left: the highest of 60 bits is the first.
constexpr std::array<std::uint64_t, last_letter - first_letter + 1> letters = {
    0x000000000000000, 0x008208208008000, 0x014514000000000, 0x01453e53e514000, 0x00872870a708000,
    0x012a94214aa4000, 0x010a2842a91a000, 0x008208000000000, 0x004210410204000, 0x010204104210000,
    0x000894f94880000, 0x000208f88200000, 0x000000000308400, 0x000000f80000000, 0x00000000021c200,
    0x002084210820000, 0x0085228a2508000, 0x00862820823e000, 0x01c88231083e000, 0x03e08430289c000,
    0x00431493e104000, 0x03e82cc8289c000, 0x00c420b3289c000, 0x03e084108410000, 0x01c8a272289c000,
    0x01c8a6682118000, 0x00021c20021c200, 0x00021c200308400, 0x002108408102000, 0x00003e03e000000,
    0x010204084210000, 0x01c884208008000, 0x01c8a6aac81c000, 0x0085228be8a2000, 0x03c4927124bc000,
    0x01c8a082089c000, 0x03c4924924bc000, 0x03e820f2083e000, 0x03e820f20820000, 0x01c8a082689c000,
    0x0228a2fa28a2000, 0x01c20820821c000, 0x00e104104918000, 0x022928c28922000, 0x02082082083e000,
    0x0228b6aa28a2000, 0x0228b2aa68a2000, 0x01c8a28a289c000, 0x03c8a2f20820000, 0x01c8a28a2a9c080,
    0x03c8a2f28922000, 0x01c8a070289c000, 0x03e208208208000, 0x0228a28a289c000, 0x0228a2514508000,
    0x0228a2aaada2000, 0x0228942148a2000, 0x022894208208000, 0x03e08421083e000, 0x01c41041041c000,
    0x020810204082000, 0x01c10410411c000, 0x008522000000000, 0x000000000000f80, 0x204000000000000,
    0x00001c09e89e000, 0x02082cca2cac000, 0x00001c8a089c000, 0x00209a9a299a000, 0x00001c8be81c000,
    0x00c490f10410000, 0x00001e8a278289c, 0x02082cca28a2000, 0x00801820821c000, 0x00200608209248c,
    0x020822938922000, 0x01820820821c000, 0x000034aaaaa2000, 0x00002cca28a2000, 0x00001c8a289c000,
    0x00002cca2cac820, 0x00001a9a299a082, 0x00002cca0820000, 0x00001c81c0bc000, 0x01043c41048c000,
    0x0000228a299a000, 0x000022894508000, 0x0000228aaa94000, 0x000022508522000, 0x0000228a668289c,
    0x00003e10843e000, 0x006204604206000, 0x008208208208000, 0x018108188118000, 0x012aa4000000000};

bool has_ink(char letter, int x, int y) {
    if (letter < first_letter || letter > last_letter) letter = '?';
    const int bit = letter_width_px * letter_height_px - 1 - (y * letter_width_px + x);
    return (letters[static_cast<std::size_t>(letter - first_letter)] >> bit & 1) != 0;
}

} // namespace

void write_small_text(std::string_view text, int x, int y, float level, Image& picture) {
    const int bottom = std::min(y + letter_height_px, picture.height);
    for (const char letter : text) {
        const int right = std::min(x + letter_width_px, picture.width);
        for (int row = std::max(y, 0); row < bottom; ++row)
            for (int column = std::max(x, 0); column < right; ++column)
                if (has_ink(letter, column - x, row - y))
                    std::fill_n(picture.pixels.begin() +
                                    static_cast<std::ptrdiff_t>(picture.channels) *
                                        (static_cast<std::ptrdiff_t>(row) * picture.width + column),
                                picture.channels, level);
        x += letter_width_px;
    }
}

} // namespace graftal
