#include "compiler/lsys/turtle/length_tally.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(LengthTally, oneLengthIsThatLength) {
    LengthTally tally;
    EXPECT_TRUE(tally.empty());
    for (int i = 0; i < 5; ++i)
        tally.add(0.3);
    EXPECT_EQ(tally.longest(), 0.3);
    EXPECT_EQ(tally.median(), 0.3);
}

TEST(LengthTally, weighsByTheLength) {
    LengthTally tally;
    tally.add(8);
    for (int i = 0; i < 7; ++i)
        tally.add(1);
    EXPECT_EQ(tally.median(), 8); // 7 of 15 are shorter
    for (int i = 0; i < 2; ++i)
        tally.add(1);
    EXPECT_EQ(tally.median(), 1); // 9 of 17
    EXPECT_EQ(tally.longest(), 8);
}

TEST(LengthTally, countsBeyondDoubles) {
    LengthTally tally;
    tally.add(1);
    for (int i = 0; i < 5000; ++i) { // 2^5000
        const LengthTally before = tally;
        tally.add(before, 1);
    }
    LengthTally large;
    large.add(tally, 4);
    large.add(1e9);
    EXPECT_EQ(large.median(), 4);
    EXPECT_EQ(large.longest(), 1e9);
}

} // namespace
} // namespace graftal
