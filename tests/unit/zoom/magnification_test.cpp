#include "compiler/zoom/magnification.h"

#include <cmath>

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(Magnification, ReadsWhatPeopleWrite) {
    struct Case {
        const char* text;
        double log2;
    };
    const Case cases[] = {{"1", 0},
                          {"8", 3},
                          {"0.25", -2},
                          {"1e3", std::log2(1000)},
                          {"1E+3", std::log2(1000)},
                          {"2.5e-2", std::log2(0.025)},
                          {"2^330", 330},
                          {"2^-20", -20},
                          {"2^+3", 3},
                          {"1^-1000000000000", 0},
                          {"3^5", std::log2(243)},
                          {"1e300", 300 * std::log2(10)},
                          {"1e1000", 1000 * std::log2(10)},
                          {"4.5e-5000", std::log2(4.5) - 5000 * std::log2(10)},
                          {"1e1000000", 1e6 * std::log2(10)}};
    for (const Case& c : cases) {
        SCOPED_TRACE(c.text);
        const auto zoom = Magnification::parse(c.text);
        ASSERT_TRUE(zoom);
        EXPECT_NEAR(zoom->log2(), c.log2, 1e-12 * std::max(1.0, std::abs(c.log2)));
        EXPECT_GE(zoom->mantissa, 1);
        EXPECT_LT(zoom->mantissa, 2);
    }
}

TEST(Magnification, RefusesTheRest) {
    for (const char* text : {"",
                             "0",
                             "-1",
                             "x",
                             "1e",
                             "e5",
                             "2^",
                             "^3",
                             "2^3^4",
                             "0^5",
                             "-2^2",
                             "inf",
                             "nan",
                             "1e1000001",
                             "1e99999999999999999999",
                             "2^9999999999",
                             "1e5x",
                             " 1",
                             "1^-9223372036854775808",
                             "1^9223372036854775807",
                             "1e-9223372036854775808",
                             "1e+-300",
                             "1e+-3",
                             "2^+-3",
                             "2^++3"})
        EXPECT_FALSE(Magnification::parse(text)) << text;
}

TEST(Magnification, PowersOfTwoAreExact) {
    EXPECT_EQ(Magnification::parse("2^1000"), (Magnification{1, 1000}));
    EXPECT_EQ(Magnification::exp2(-3000), (Magnification{1, -3000}));
    EXPECT_EQ((Magnification{1.5, 10}) * (Magnification{1.5, -20}), (Magnification{1.125, -9}));
}

TEST(Magnification, TimesALengthSaturates) {
    EXPECT_EQ((Magnification{1, 3}).times(5), 40);
    EXPECT_EQ((Magnification{1, 5000}).times(1), HUGE_VAL);
    EXPECT_EQ((Magnification{1, -50'000'000'000}).times(1), 0);
    EXPECT_EQ((Magnification{1, 5000}).times(0), 0);
}

} // namespace
} // namespace graftal
