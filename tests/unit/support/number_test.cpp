#include "compiler/support/number.h"
#include "tests/unit/comma_locale.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::string with_digits(double value, int digits) {
    std::string out;
    append_number(out, value, digits);
    return out;
}

TEST(Number, ShortestIsWhatAPersonWouldWrite) {
    EXPECT_EQ(shortest(0.5), "0.5");
    EXPECT_EQ(shortest(0.1 + 0.2), "0.30000000000000004");
    EXPECT_EQ(shortest(-3), "-3");
    EXPECT_EQ(shortest(1e21), "1e+21");
    EXPECT_EQ(shortest(1e-7), "1e-07");
    EXPECT_EQ(shortest(0.0), "0");
    EXPECT_EQ(shortest(-0.0), "0");
}

TEST(Number, ShortestReadsBackToTheLastBit) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 100'000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        const auto back = parse_number(shortest(value));
        ASSERT_TRUE(back) << shortest(value);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(value));
    }
    using limits = std::numeric_limits<double>;
    for (const double value : {limits::min(), limits::max(), limits::lowest(), limits::denorm_min(), 1 / 3.0})
        EXPECT_EQ(parse_number(shortest(value)), value) << shortest(value);
}

TEST(Number, DigitsAreSignificantAndTrailingZerosGo) {
    EXPECT_EQ(with_digits(1.0 / 3, 6), "0.333333");
    EXPECT_EQ(with_digits(2.0, 6), "2");
    EXPECT_EQ(with_digits(1234567.0, 3), "1.23e+06");
    EXPECT_EQ(with_digits(0.5, 9), "0.5");
    EXPECT_EQ(with_digits(-0.0, 6), "0");
    EXPECT_EQ(with_digits(1e300, 3), "1e+300");
    std::string out = "x = ";
    append_number(out, 1.5, 4);
    EXPECT_EQ(out, "x = 1.5") << "it appends";
}

TEST(Number, TheShortWayGivesWhatTheLibraryGives) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 200'000; ++i) {
        const int digits = 1 + static_cast<int>(random() % 17);
        double value = std::ldexp(static_cast<double>(random() >> 11), -53); // [0, 1)
        if (i % 3 == 0) value *= std::pow(10, static_cast<int>(random() % 24) - 8);
        if (i % 3 == 1) value = std::round(value * 1024) / 1024; // often a tie
        char expected[64];
        char* const end =
            std::to_chars(expected, expected + sizeof expected, value, std::chars_format::general, digits)
                .ptr;
        ASSERT_EQ(with_digits(value, digits), std::string(expected, end));
    }
}

TEST(Number, TinyNegativesDoNotPrintAsMinusZero) {
    EXPECT_NE(with_digits(-1e-300, 3), "-0");
}

TEST(Number, TheLocaleDoesNotMatter) {
    const CommaLocale comma;
    ASSERT_TRUE(comma.installed());
    EXPECT_EQ(shortest(1234.5), "1234.5");
    EXPECT_EQ(with_digits(1234.5, 9), "1234.5");
    EXPECT_EQ(parse_number("1234.5"), 1234.5);
}

TEST(Number, ParseTakesDecimalsOnly) {
    EXPECT_EQ(parse_number(".16"), 0.16);
    EXPECT_EQ(parse_number("-2e-3"), -0.002);
    EXPECT_EQ(parse_number("2."), 2);
    for (const char* bad : {"", " 1", "1 ", "1x", "0x10", "1,5", "+1", "--1", "1e", "inf", "-inf", "nan",
                            "infinity", "NAN", "nan(1)", "1e400", "-1e400", "1_000"})
        EXPECT_EQ(parse_number(bad), std::nullopt) << "'" << bad << "'";
    EXPECT_EQ(parse_number(std::string_view("1\0", 2)), std::nullopt);
}

TEST(Number, WhatIsTooSmallIsZeroNotAnError) {
    EXPECT_EQ(parse_number("1e-400"), 0);
    EXPECT_EQ(parse_number("-0.0000001e-400"), 0);
    EXPECT_EQ(parse_number(std::string(5000, '9') + "e-5400"), 0);
}

} // namespace
} // namespace graftal
