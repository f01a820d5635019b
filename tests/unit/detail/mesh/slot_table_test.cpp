#include "compiler/detail/mesh/slot_table.h"

#include <array>

#include <gmock/gmock.h>

namespace graftal {
namespace {

using testing::ElementsAre;

const Rgb red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);

TEST(SlotTable, LeavesThatLookAlikeToAllPaintersShareASlot) {
    SlotTable slots(2);
    for (const auto& colours : {std::array{red, blue}, {green, blue}, {red, blue}, {red, green}})
        slots.add(colours);
    EXPECT_EQ(slots.slot_count(), 3u);
    EXPECT_EQ(slots.slot_of(0), 0u);
    EXPECT_EQ(slots.slot_of(1), 1u);
    EXPECT_EQ(slots.slot_of(2), 0u);
    EXPECT_EQ(slots.slot_of(3), 2u);
    EXPECT_THAT(slots.take_palettes(), ElementsAre(Palette{red, green, red}, Palette{blue, blue, green}));
}

TEST(SlotTable, OneColourIsOneColour) {
    SlotTable slots(2);
    slots.add(std::array{red, blue});
    slots.add(std::array{green, blue});
    EXPECT_THAT(slots.take_palettes(), ElementsAre(Palette{red, green}, Palette{blue}));
}

} // namespace
} // namespace graftal
