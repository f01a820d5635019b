#include "compiler/detail/coarser.h"

#include <limits>

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(ReadableSeconds, HaveTwoDigitsAsPeopleWriteThem) {
    EXPECT_EQ(readable_seconds(0.123), "0.13");
    EXPECT_EQ(readable_seconds(9.94), "10");
    EXPECT_EQ(readable_seconds(0.3), "0.3");
    EXPECT_EQ(readable_seconds(110), "110");
    EXPECT_EQ(readable_seconds(12.4), "13");
    EXPECT_EQ(readable_seconds(99.7), "100");
    EXPECT_EQ(readable_seconds(113), "120");
    EXPECT_EQ(readable_seconds(3249), "3300");
    EXPECT_EQ(readable_seconds(2.34e9), "2.3e+09");
    EXPECT_EQ(readable_seconds(std::numeric_limits<double>::infinity()), "inf");
}

} // namespace
} // namespace graftal
