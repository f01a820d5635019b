#include "compiler/support/decimal_text.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::string decimal(std::uint64_t number, int decimals) {
    char buffer[22];
    return {buffer, write_decimal(buffer, number, decimals)};
}

TEST(DecimalText, IntegersAsTheStandardLibraryWritesThem) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 10'000; ++i) {
        const std::uint64_t number = random() >> (random() % 64);
        char buffer[20];
        ASSERT_EQ(std::string(buffer, write_integer(buffer, number)), std::to_string(number));
    }
}

TEST(DecimalText, ZerosGoBehindThePointAlone) {
    EXPECT_EQ(decimal(1200, 0), "1200");
    EXPECT_EQ(decimal(1200, 1), "120");
    EXPECT_EQ(decimal(1200, 3), "1.2");
    EXPECT_EQ(decimal(1200, 4), "0.12");
    EXPECT_EQ(decimal(1200, 6), "0.0012");
    EXPECT_EQ(decimal(1, 19), "0.0000000000000000001");
    EXPECT_EQ(decimal(UINT64_MAX, 19), "1.8446744073709551615");
}

} // namespace
} // namespace graftal
