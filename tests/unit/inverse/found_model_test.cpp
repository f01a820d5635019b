#include "runtime/inverse/found/found_model.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/image_files/image_files.h"
#include "runtime/points/collage.h"
#include "runtime/render/picture_session.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

class FoundModelTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }

    /// A grey picture whose pixels `dark` chooses.
    template<typename Dark> std::string picture(int width, int height, const Dark& dark) const {
        Image image{width, height, 1, std::vector<float>(static_cast<std::size_t>(width * height), 1)};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (dark(x, y)) image.pixels[static_cast<std::size_t>(y * width + x)] = 0;
        EXPECT_TRUE(write_image(path("t.png"), image, SampleFormat::srgb8).ok());
        return path("t.png");
    }

    /// The attractor of maps of the square from <0, 0> to <1, 1>, y down.
    std::string attractor(const PlaneMaps& maps, int size) const {
        std::vector<bool> dark(static_cast<std::size_t>(size * size));
        Draws draws(CounterRandom(9), 0);
        Vec2 p = fixed_point(maps.front());
        for (int i = 0; i < 400'000; ++i) {
            p = maps[draws.below(maps.size())](p);
            const int x = static_cast<int>(p.x * size), y = static_cast<int>(p.y * size);
            if (x >= 0 && y >= 0 && x < size && y < size) dark[static_cast<std::size_t>(y * size + x)] = true;
        }
        return picture(size, size,
                       [&](int x, int y) { return dark[static_cast<std::size_t>(y * size + x)]; });
    }

    std::optional<FoundModel> find(const std::string& target, double seconds, int threads = 1,
                                   const CancelFlag& cancel = {}) {
        options_.target = target;
        options_.search.seconds = seconds;
        options_.threads = threads;
        Compilation compilation;
        auto found = find_model(options_, cancel, compilation);
        message_ = compilation.diagnostics.render(compilation.sources) + compilation.status.message();
        return found;
    }

    TemporaryDirectory directory_;
    FindOptions options_;
    std::string message_;
};

const PlaneMaps gasket = {{0.5, 0, 0, 0.5, 0, 0}, {0.5, 0, 0, 0.5, 0.5, 0}, {0.5, 0, 0, 0.5, 0.25, 0.5}};
const double third = 1.0 / 3, wave = 0.28867513459481287;
const PlaneMaps koch = {{third, 0, 0, third, 0, 0.2},
                        {third / 2, -wave, wave, third / 2, third + 0.2 * wave, 0.2 * 5 / 6},
                        {third / 2, wave, -wave, third / 2, 0.5 - 0.2 * wave, wave + 0.2 * 5 / 6},
                        {third, 0, 0, third, 2 * third, 0.2}};

TEST_F(FoundModelTest, TheGasketAndTheKochCurveAreFound) {
    for (const PlaneMaps& truth : {gasket, koch}) {
        const auto found = find(attractor(truth, 200), 6);
        ASSERT_TRUE(found) << message_;
        EXPECT_GE(found->agreement.tolerant, 0.99);
        EXPECT_GE(found->agreement.strict, 0.85);
        EXPECT_LE(found->maps.size(), truth.size());
        EXPECT_LT(found->contractivity, 0.9301);
        EXPECT_EQ(found->contractivity, largest_stretch(found->maps));
    }
}

TEST_F(FoundModelTest, ItsTextIsTheModelThatItMeasured) {
    const std::string target = attractor(gasket, 200);
    const auto found = find(target, 3);
    ASSERT_TRUE(found) << message_;
    ASSERT_TRUE(write_text(path("m.rifs"), found->text).ok());
    CollageOptions options;
    options.target = target;
    Compilation compilation;
    PictureSession session(path("m.rifs"));
    const auto collage = measure_collage(session, options, compilation);
    ASSERT_TRUE(collage) << compilation.diagnostics.render(compilation.sources) << found->text;
    EXPECT_EQ(compilation.diagnostics.render(compilation.sources), "");
    EXPECT_EQ(collage->maps, found->maps.size());
    EXPECT_NEAR(collage->contractivity, found->contractivity, 1e-12);
    EXPECT_NEAR(collage->epsilon / collage->pixel, found->epsilon * found->cell, 1.5);
    EXPECT_LE(*collage->distance, collage->bound);
}

/// A figure of pen strokes, no attractor of a few maps.
bool in_figure(int x, int y) {
    const double away = std::hypot(x - 11.5, y - 9.5);
    const bool bow = std::abs(away - 6) < 1.2 && (y < 10 || x > 11),
               foot = std::abs(y - 25) < 2 && x > 4 && x < 25;
    return bow || foot || (std::abs(x + y - 27.5) < 1.8 && y > 12 && y < 25);
}

TEST_F(FoundModelTest, OccupancyFindsTheCellsThemselves) {
    const std::string target = picture(32, 32, in_figure);
    options_.search.most_maps = 10;
    const auto near = find(target, 1);
    options_.occupancy = true;
    const auto one = find(target, 1), two = find(target, 1, 2);
    ASSERT_TRUE(near && one && two) << message_;
    EXPECT_GT(one->agreement.strict, 0.9);
    EXPECT_GT(one->agreement.strict, near->agreement.strict + 0.1);
    EXPECT_LE(one->maps.size(), 10);
    EXPECT_LT(one->contractivity, 0.9301);
    EXPECT_LT(one->seconds, 1.2) << "the work is bounded";
    EXPECT_EQ(one->text, two->text);
}

TEST_F(FoundModelTest, OccupancyKeepsWhatTheOtherSearchFinds) {
    options_.occupancy = true;
    const auto found = find(attractor(gasket, 200), 3);
    ASSERT_TRUE(found) << message_;
    EXPECT_GE(found->agreement.tolerant, 0.99);
    EXPECT_GE(found->agreement.strict, 0.85);
}

TEST_F(FoundModelTest, ThreadsDoNotMatterAndSeedsDo) {
    const std::string target = attractor(gasket, 100);
    options_.search.rules.similar = true;
    const auto one = find(target, 0.5), two = find(target, 0.5, 2);
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->text, two->text);
    for (const PlaneMap& map : one->maps) {
        EXPECT_NEAR(map.a * map.a, map.d * map.d, 1e-5);
        EXPECT_NEAR(map.b * map.b, map.c * map.c, 1e-5);
    }
    options_.search.seed = 2;
    EXPECT_NE(find(target, 0.5)->text, one->text);
}

TEST_F(FoundModelTest, ItGoesOnFromAModel) {
    const std::string target = attractor(gasket, 200);
    // Nearly the gasket, in the frame of found models: y up.
    const std::string start = path("start.rifs");
    ASSERT_TRUE(
        write_text(start,
                   "rifs s { codes 2d {\n.49 .01 0 .5 0 .5\n.5 0 0 .49 .5 .5\n.5 0 .01 .5 .25 0\n} }\n")
            .ok());
    options_.start = start;
    const auto found = find(target, 0.3);
    ASSERT_TRUE(found) << message_;
    EXPECT_GE(found->agreement.tolerant, 0.95);
    EXPECT_EQ(found->maps.size(), 3);
    options_.search.most_maps = 2;
    EXPECT_FALSE(find(target, 0.3));
    EXPECT_THAT(message_, HasSubstr("3 maps, more than the 2 that the search may use"));
    ASSERT_TRUE(write_text(start, "object o { sphere }\n").ok());
    EXPECT_FALSE(find(target, 0.3));
}

TEST_F(FoundModelTest, AnInterruptedSearchHasAnAnswer) {
    for (const bool occupancy : {false, true}) {
        options_.occupancy = occupancy;
        int asked = 0;
        const auto found =
            find(attractor(gasket, 100), 1000, 1, CancelFlag([&asked] { return ++asked > 40; }));
        ASSERT_TRUE(found) << message_;
        EXPECT_LT(found->contractivity, 1);
        EXPECT_THAT(found->text, HasSubstr("codes 2d"));
    }
}

TEST_F(FoundModelTest, HostileTargetsAreAnsweredOrRefused) {
    EXPECT_FALSE(find(picture(50, 50, [](int, int) { return false; }), 1));
    EXPECT_THAT(message_, HasSubstr("is empty: it has no pixel darker than 0.5"));
    EXPECT_FALSE(find(picture(50, 50, [](int x, int y) { return x == 7 && y == 9; }), 1));
    EXPECT_THAT(message_, HasSubstr("only 1 of its 50x50 pixels is darker than 0.5"));
    EXPECT_FALSE(find(picture(1, 1, [](int, int) { return true; }), 1));
    EXPECT_FALSE(find(path("none.png"), 1));
    ASSERT_TRUE(write_text(path("bad.png"), "\x89PNG\r\n\x1a\nrubbish").ok());
    EXPECT_FALSE(find(path("bad.png"), 1));

    const auto line = find(picture(300, 1, [](int, int) { return true; }), 0.2);
    ASSERT_TRUE(line) << message_;
    for (const bool occupancy : {false, true}) {
        options_.occupancy = occupancy;
        const auto full = find(picture(60, 40, [](int, int) { return true; }), 1);
        ASSERT_TRUE(full) << message_;
        EXPECT_GE(full->agreement.tolerant, 0.95);
        Draws draws(CounterRandom(3), 0);
        const auto noise = find(picture(200, 200, [&](int, int) { return draws.unit() < 0.05; }), 0.5);
        ASSERT_TRUE(noise) << message_;
        EXPECT_LT(noise->seconds, 5) << "the work is bounded";
    }
    options_.occupancy = true;
    ASSERT_TRUE(find(path("t.png"), 0.01)) << message_;
    ASSERT_TRUE(find(picture(300, 1, [](int, int) { return true; }), 0.2)) << message_;
    options_.occupancy = false;
    const auto dots =
        find(picture(3000, 3000, [](int x, int y) { return x % 100 == 0 && y % 100 == 0; }), 0.2);
    ASSERT_TRUE(dots) << message_;
    EXPECT_EQ(dots->cell, 12) << "3 pixels a cell, and then 4 cells a cell";
}

TEST_F(FoundModelTest, OpaquePixelsAreTheTargetOfAPictureWithAlpha) {
    Image image{40, 40, 2, std::vector<float>(3200, 0)};
    for (std::size_t y = 10; y < 30; ++y)
        for (std::size_t x = 10; x < 30; ++x)
            image.pixels[2 * (40 * y + x) + 1] = 1;
    ASSERT_TRUE(write_image(path("a.png"), image, SampleFormat::srgb8).ok());
    const auto found = find(path("a.png"), 0.2);
    ASSERT_TRUE(found) << message_;
    EXPECT_TRUE(found->by_alpha);
    EXPECT_EQ(found->cells, 400);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
    ASSERT_TRUE(write_image(path("a.png"), image, SampleFormat::srgb8).ok());
    EXPECT_FALSE(find(path("a.png"), 0.2));
    EXPECT_THAT(message_, HasSubstr("no pixel of an alpha of at least 0.5"));
}

} // namespace
} // namespace graftal
