#include "compiler/cut/coarser.h"

#include <limits>

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(ReadableSeconds, HaveTwoDigitsAsPeopleWriteThem) {
    EXPECT_EQ(readable_seconds(0.123), "0.12");
    EXPECT_EQ(readable_seconds(9.94), "9.9");
    EXPECT_EQ(readable_seconds(12.4), "12");
    EXPECT_EQ(readable_seconds(99.7), "100");
    EXPECT_EQ(readable_seconds(113), "110");
    EXPECT_EQ(readable_seconds(3249), "3200");
    EXPECT_EQ(readable_seconds(2.34e9), "2.3e+09");
    EXPECT_EQ(readable_seconds(std::numeric_limits<double>::infinity()), "inf");
}

} // namespace
} // namespace graftal
