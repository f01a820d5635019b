#include "compiler/povray/sdl_writer.h"
#include "tests/unit/broken_invariant.h"
#include "tests/unit/comma_locale.h"

#include <charconv>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace graftal {
namespace {

/// What the statements write, and in how many pieces.
struct Collected {
    std::string text;
    int pieces = 0;
    TextSink sink = [this](std::string_view piece) {
        text += piece;
        ++pieces;
        return true;
    };
};

std::string number(double value, int digits) {
    Collected all;
    SdlWriter out(all.sink);
    out.number(value, digits);
    out.flush();
    return all.text;
}

TEST(SdlNumber, IsAsShortAsItsDigitsAllow) {
    EXPECT_EQ(number(0, 9), "0");
    EXPECT_EQ(number(-0.0, 9), "0");
    EXPECT_EQ(number(1, 9), "1");
    EXPECT_EQ(number(-1, 9), "-1");
    EXPECT_EQ(number(0.5, 9), "0.5");
    EXPECT_EQ(number(1.0 / 3, 9), "0.333333333");
    EXPECT_EQ(number(-2.0 / 3, 3), "-0.667");
    EXPECT_EQ(number(100, 9), "100");
    EXPECT_EQ(number(1200, 2), "1.2e+03");
    EXPECT_EQ(number(123456789, 9), "123456789");
    EXPECT_EQ(number(0.001, 9), "0.001");
    EXPECT_EQ(number(0.1 + 0.2, 9), "0.3");
}

TEST(SdlNumber, CarriesIntoTheNextPowerOfTen) {
    EXPECT_EQ(number(0.99999999996, 9), "1");
    EXPECT_EQ(number(9.9996, 4), "10");
    EXPECT_EQ(number(999999999.7, 9), "1000000000");
    EXPECT_EQ(number(0.0000999999, 3), "0.0001");
}

TEST(SdlNumber, VerySmallAndVeryLargeKeepTheirDigits) {
    EXPECT_EQ(number(1.25e-30, 9), "1.25e-30");
    EXPECT_EQ(number(-1.25e200, 9), "-1.25e+200");
    EXPECT_EQ(number(5e-324, 3), "4.94e-324");
}

TEST(SdlNumber, ReadsBackWithinHalfAUnitInTheLastDigit) {
    std::uint64_t state = 12345;
    for (int digits : {1, 3, 6, 7, 9, 12})
        for (int i = 0; i < 20000; ++i) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const double mantissa = 1 + static_cast<double>(state >> 12) / static_cast<double>(1ull << 52);
            const double value = std::ldexp(mantissa, static_cast<int>(state % 80) - 40);
            const std::string text = number(value, digits);
            double back = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), back);
            ASSERT_EQ(error, std::errc());
            ASSERT_EQ(end, text.data() + text.size()) << text;
            const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
            ASSERT_LE(std::abs(back - value), 0.5 * unit * (1 + 1e-6) + 2e-15 * value)
                << text << " " << value;
        }
}

TEST(SdlNumber, PowersOfTenAndTheirNeighboursAreRight) {
    for (int exponent = -12; exponent <= 12; ++exponent) {
        const double power = std::pow(10.0, exponent);
        for (const double value : {std::nextafter(power, 0.0), power, std::nextafter(power, 1e30)})
            for (const int digits : {1, 6, 9, 12}) {
                const std::string text = number(value, digits);
                EXPECT_NEAR(std::strtod(text.c_str(), nullptr) / power, 1, 1e-14) << text;
            }
    }
}

TEST(SdlNumber, DoesNotFollowTheLocale) {
    const CommaLocale comma;
    ASSERT_TRUE(comma.installed());
    EXPECT_EQ(number(0.5, 9), "0.5");
    EXPECT_EQ(number(1.5e-30, 9), "1.5e-30");
}

TEST(SdlWriter, MatrixHasTheImagesOfTheAxesThenOfTheOrigin) {
    Collected all;
    SdlWriter out(all.sink);
    Affine a;
    a.linear = Mat3(1, 2, 3, 4, 5, 6, 7, 8, 9.5); // column by column
    a.translation = {10, 11, 12};
    out.matrix(a);
    out.flush();
    EXPECT_EQ(all.text, "matrix <1,2,3,4,5,6,7,8,9.5,10,11,12>");
}

TEST(SdlWriter, RoundingNoiseInMatricesIsZero) {
    Collected all;
    SdlWriter out(all.sink);
    Affine a;
    a.linear[0] = {1, 6e-17, -3e-17};
    a.translation = {1e-17, 0, 0};
    out.matrix(a);
    out.flush();
    EXPECT_EQ(all.text, "matrix <1,0,0,0,1,0,0,0,1,1e-17,0,0>");
}

TEST(SdlWriter, LongTextsPassInPiecesAndWhole) {
    Collected all;
    SdlWriter out(all.sink);
    const std::string line(1000, 'x');
    for (int i = 0; i < 1000; ++i)
        out << line;
    const std::string huge(1'000'000, 'y');
    out << huge;
    EXPECT_TRUE(out.flush());
    EXPECT_EQ(all.text, std::string(1'000'000, 'x') + huge);
    EXPECT_GT(all.pieces, 10);
    EXPECT_LT(all.pieces, 40);
}

TEST(SdlWriter, AStoppedSinkIsNotCalledAgain) {
    int calls = 0;
    const TextSink sink = [&](std::string_view) {
        ++calls;
        return false;
    };
    SdlWriter out(sink);
    for (int i = 0; i < 1'000'000; ++i)
        out << "some text";
    EXPECT_TRUE(out.stopped());
    EXPECT_FALSE(out.flush());
    EXPECT_EQ(calls, 1);
}

TEST(SdlWriter, NumbersAreFinite) {
    EXPECT_BROKEN(number(std::nan(""), 9), "finite");
    EXPECT_BROKEN(number(INFINITY, 9), "finite");
}

} // namespace
} // namespace graftal
