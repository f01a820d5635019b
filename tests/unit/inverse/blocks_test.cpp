#include "runtime/inverse/blocks/encode.h"

#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/support/counter_random.h"
#include "runtime/image_files/image_files.h"
#include "runtime/inverse/blocks/coded_picture.h"
#include "runtime/inverse/blocks/decode.h"
#include "runtime/inverse/blocks/pifs_file.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "runtime/system/worker_threads.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

/// A picture of one channel or more, in 255 levels.
template<typename Level> Image picture(int width, int height, int channels, const Level& level) {
    Image image{width, height, channels, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.pixels.push_back(static_cast<float>(level(x, y, c)) / 255);
    return image;
}

/// Waves without end, so that no block is like another.
double waves(int x, int y, int c) {
    return 127.5 + 50 * std::sin(0.11 * x + c) + 40 * std::cos(0.07 * y * (1 + 0.01 * x) + 2 * c);
}

BlockPicture coded(const Image& image, double tolerance, int threads = 1, double seconds = 30) {
    return find_blocks(planes_of(image), {tolerance, seconds}, WorkerThreads(threads), {}, {}).picture;
}

Image decoded(const BlockPicture& blocks, int width, int height) {
    return image_of(decode_blocks(blocks, width, height, WorkerThreads(2), no_control(), {}));
}

/// The largest difference of two pictures, in levels.
double apart(const Image& a, const Image& b) {
    const ImageDifference difference = compare_images(a, b);
    EXPECT_TRUE(difference.same_size);
    return 255 * difference.max;
}

/// Random maps of a grey plane whose attractor lies between black and white. Isometries: one, or any.
BlockPicture random_system(int width, int height, int side, std::uint64_t seed, std::optional<int> isometry) {
    BlockPicture picture{width, height, false, false, {}};
    picture.planes.push_back({{width, height}, 12, {}});
    const DomainPool pool(picture.planes[0].grid, side, 12);
    const CounterRandom random(seed);
    std::uint64_t draws = 0;
    const auto below = [&](int count) {
        return static_cast<int>(random(draws++) % static_cast<unsigned>(count));
    };
    walk_partition(
        picture.planes[0].grid, [&](int, int, int at) { return at > side; },
        [&](int x, int y, int at) {
            BlockMap block{x, y, at};
            block.slope = (3 + below(3)) * (below(2) ? 1 : -1);
            block.isometry = isometry.value_or(below(8));
            block.domain = static_cast<std::uint32_t>(below(static_cast<int>(pool.count())));
            const int room = 120 * (slope_steps - std::abs(block.slope)) / slope_steps;
            block.level = 128 + 2 * (below(room + 1) - room / 2);
            picture.planes[0].blocks.push_back(block);
        });
    return picture;
}

TEST(Blocks, FixedPointsAreRecoveredToTheLastLevel) {
    for (int isometry = 0; isometry < isometries; ++isometry) {
        const Image truth =
            decoded(random_system(64, 48, 8, 7u + static_cast<unsigned>(isometry), isometry), 64, 48);
        const BlockPicture found = coded(truth, 0);
        EXPECT_LT(apart(decoded(found, 64, 48), truth), 0.5) << isometry;
    }
    const Image truth = decoded(random_system(96, 96, 16, 3, {}), 96, 96);
    EXPECT_LT(apart(decoded(coded(truth, 0), 96, 96), truth), 0.5);
}

TEST(Blocks, IsometriesAreThoseOfTheSquare) {
    // The first range is 4 by 4 pixels, its domain 8 by 8 elsewhere; there, blocks are flat.
    const auto level = [](int u, int v) { return 10 * u + 60 * v + 4; }; // of the cells, all different
    for (int isometry = 0; isometry < isometries; ++isometry) {
        BlockPicture picture{32, 32, false, false, {}};
        picture.planes.push_back({{32, 32}, 12, {}});
        const DomainPool pool(picture.planes[0].grid, 4, 12);
        ASSERT_EQ(pool.step, 1);
        walk_partition(
            picture.planes[0].grid, [](int, int, int) { return true; },
            [&](int x, int y, int side) {
                BlockMap block{x, y, side};
                if (x == 0 && y == 0) {
                    block.slope = 4;
                    block.isometry = isometry;
                    block.domain = static_cast<std::uint32_t>(8 * pool.columns + 8); // at <8, 8>
                    block.level = 100;
                } else if (x >= 8 && y >= 8 && x < 16 && y < 16) {
                    block.level = level((x - 8) / 4, (y - 8) / 4);
                }
                picture.planes[0].blocks.push_back(block);
            });
        const Image image = decoded(picture, 32, 32);
        for (int v = 0; v < 2; ++v)
            for (int u = 0; u < 2; ++u) {
                int a = isometry & 4 ? v : u, b = isometry & 4 ? u : v;
                if (isometry & 1) a = 1 - a;
                if (isometry & 2) b = 1 - b;
                EXPECT_NEAR(255 * image.pixels[static_cast<std::size_t>(2 * v * 32 + 2 * u)],
                            (level(a, b) - 127.5) / 2 + 100, 0.2)
                    << isometry << " at " << u << ", " << v;
            }
    }
}

TEST(Blocks, ConstantPicturesAreExactAndSmall) {
    for (const int level : {0, 37, 255}) {
        const Image image = picture(200, 100, 3, [&](int, int, int) { return level; });
        const BlockPicture blocks = coded(image, 8);
        EXPECT_FALSE(blocks.colour);
        EXPECT_LT(pifs_text(blocks).size(), 60u);
        EXPECT_LT(apart(decoded(blocks, 200, 100), image), 1e-3);
    }
}

TEST(Blocks, ARampHasMoreLevelsWhenItIsEnlarged) {
    // 2 x + 1.5 at the middle of pixel x: each block is half of what a domain twice as wide has.
    BlockPicture ramp{64, 64, false, false, {}};
    ramp.planes.push_back({{64, 64}, 12, {}});
    const DomainPool pool(ramp.planes[0].grid, 8, 12);
    walk_partition(
        ramp.planes[0].grid, [](int, int, int side) { return side > 8; },
        [&](int x, int y, int side) {
            const int domain_x = std::min(x / 2 * 2, 48);
            const auto domain = static_cast<std::uint32_t>(domain_x / pool.step);
            ASSERT_EQ(pool.x(domain), domain_x);
            ramp.planes[0].blocks.push_back({x, y, side, 4, 0, domain, 2 * x - domain_x + 64});
        });
    for (const int width : {64, 128, 192, 256, 100}) {
        const Image image = decoded(ramp, width, width);
        for (int x = 0; x < width; ++x)
            EXPECT_NEAR(255 * image.pixels[static_cast<std::size_t>(x)], 128 * (x + 0.5) / width + 0.5, 0.11)
                << x << " of " << width;
    }
    EXPECT_NEAR(apart(decoded(ramp, 64, 64), decoded(coded(decoded(ramp, 64, 64), 0), 64, 64)), 0, 0.5);
}

TEST(Blocks, AnySizeIsDecodedToAnySize) {
    for (const auto& [width, height] :
         {std::pair(1, 1), {3, 1}, {5, 5}, {9, 8}, {37, 53}, {64, 1}, {33, 32}}) {
        const Image image = picture(width, height, 3, waves);
        const BlockPicture blocks = coded(image, 0);
        const Image again = decoded(blocks, width, height);
        ASSERT_EQ(again.width, width);
        ASSERT_EQ(again.height, height);
        if (width * height > 1000) {
            EXPECT_LT(compare_images(again, image).rms, 6.0 / 255);
        }
        for (const auto& [w, h] : {std::pair(1, 1), {2 * width, 2 * height}, {17, 29}}) {
            const Image other = decoded(blocks, w, h);
            ASSERT_EQ(other.pixels.size(), static_cast<std::size_t>(w * h * other.channels));
            for (const float sample : other.pixels)
                ASSERT_TRUE(sample >= 0 && sample <= 1);
        }
    }
    const Image pixel = picture(1, 1, 3, [](int, int, int c) { return 200 - 50 * c; });
    EXPECT_LT(apart(decoded(coded(pixel, 0), 1, 1), pixel), 1.5);
}

TEST(Blocks, ChannelsStayThoseOfThePicture) {
    const auto opaque = [](int x, int y, int c) { return c == 3 ? 255 : waves(x, y, c); };
    const auto grey = [](int x, int y, int c) { return c == 3 ? 2 * x : waves(x, y, 0); };
    EXPECT_EQ(decoded(coded(picture(40, 40, 4, opaque), 8), 40, 40).channels, 3);
    EXPECT_EQ(decoded(coded(picture(40, 40, 4, grey), 8), 40, 40).channels, 2);
    EXPECT_EQ(decoded(coded(picture(40, 40, 2, [](int x, int, int) { return 3 * x; }), 8), 40, 40).channels,
              2);
    const auto clear = [](int x, int y, int c) { return c == 3 ? 2 * (x + y) : waves(x, y, c); };
    const Image image = picture(64, 60, 4, clear), again = decoded(coded(image, 1), 64, 60);
    ASSERT_EQ(again.channels, 4);
    for (std::size_t i = 3; i < image.pixels.size(); i += 4)
        ASSERT_NEAR(again.pixels[i], image.pixels[i], 6.0 / 255);
    EXPECT_LT(compare_images(again, image).rms, 5.0 / 255);
}

TEST(Blocks, SixteenBitsGiveLevelsBetweenLevels) {
    // Steps of a tenth of a level: the ramp's slope is that of no 8-bit picture.
    const Image image = picture(128, 32, 1, [](int x, int, int) { return 100 + 0.1 * x; });
    const Image again = decoded(coded(image, 0), 128, 32);
    EXPECT_LT(apart(again, image), 0.6);
    EXPECT_GT(std::set<float>(again.pixels.begin(), again.pixels.end()).size(), 40u);
}

TEST(Blocks, LessToleranceIsNearerAndLarger) {
    const Image image = picture(128, 128, 3, waves);
    double error = 1;
    std::size_t size = 0;
    for (const double tolerance : {40.0, 12.0, 3.0, 0.0}) {
        const BlockPicture blocks = coded(image, tolerance);
        const double now = compare_images(decoded(blocks, 128, 128), image).rms;
        EXPECT_LT(now, error);
        EXPECT_LT(now, std::max(tolerance, 4.0) / 255);
        EXPECT_GT(pifs_text(blocks).size(), size);
        error = now;
        size = pifs_text(blocks).size();
    }
}

TEST(Blocks, ThreadsDoNotMatter) {
    const Image image = picture(150, 90, 4, waves);
    const std::string one = pifs_text(coded(image, 4)), three = pifs_text(coded(image, 4, 3));
    EXPECT_EQ(one, three);
}

TEST(Blocks, WorkDecidesThePools) {
    const Image image = picture(256, 256, 1, waves);
    const BlockPicture much = coded(image, 4), little = coded(image, 4, 1, 0.1);
    EXPECT_EQ(much.planes[0].pool_bits, 12);
    EXPECT_LT(little.planes[0].pool_bits, 10);
    EXPECT_LT(compare_images(decoded(little, 256, 256), image).rms, 10.0 / 255);
    EXPECT_THROW(coded(image, 4, 1, 1e-6), OutOfWork);
}

TEST(Blocks, DistanceFromTheAttractorIsWithinTheBound) {
    TemporaryDirectory directory;
    ASSERT_TRUE(directory.create().ok());
    const std::string path = directory.path() + "/p.png";
    for (const double tolerance : {2.0, 30.0}) {
        ASSERT_TRUE(write_image(path, picture(100, 80, 1, waves), SampleFormat::srgb8).ok());
        Compilation compilation;
        const auto found = code_picture(path, tolerance, {}, {}, compilation);
        ASSERT_TRUE(found) << compilation.status.message();
        EXPECT_LE(found->contraction, 0.875);
        EXPECT_LE(found->most, found->bound + 0.2);
        EXPECT_GT(found->rms, 0);
        // The file decodes to a picture as far away as was said.
        ASSERT_TRUE(write_text(directory.path() + "/p.pifs", found->text).ok());
        const auto image = draw_pifs(directory.path() + "/p.pifs", {}, {}, {}, compilation);
        ASSERT_TRUE(image);
        Image original;
        ASSERT_TRUE(read_image(path, original).ok());
        EXPECT_NEAR(255 * compare_images(*image, original).rms, found->rms, 0.2);
    }
}

/// W works on the picture with its margin: its largest distance there is that of the bound.
TEST(Blocks, TheBoundCountsTheMargin) {
    TemporaryDirectory directory;
    ASSERT_TRUE(directory.create().ok());
    const std::string path = directory.path() + "/p.png";
    const CounterRandom random(5);
    for (const auto& [width, height] : {std::pair(5, 5), {33, 9}, {21, 37}}) {
        const auto noise = [&](int x, int y, int) {
            return static_cast<double>(random(static_cast<std::uint64_t>(100 * y + x)) % 256);
        };
        ASSERT_TRUE(write_image(path, picture(width, height, 1, noise), SampleFormat::srgb8).ok());
        Image original;
        ASSERT_TRUE(read_image(path, original).ok());
        Compilation compilation;
        const auto found = code_picture(path, 8, {}, {}, compilation);
        ASSERT_TRUE(found) << compilation.status.message();
        std::string fault;
        const auto blocks = read_pifs(found->text, 1 << 30, fault);
        ASSERT_TRUE(blocks) << fault;
        const PlaneIteration iteration(blocks->planes.front(), width, height, width, height);
        LevelPlane to = iteration.grey();
        const LevelPlane from = with_margin(planes_of(original).planes.front(), to.width, to.height);
        iteration.apply(from, to, WorkerThreads(1), {});
        double most = 0;
        for (std::size_t i = 0; i < to.levels.size(); ++i)
            most = std::max(most, std::abs(double{to.levels[i]} - from.levels[i]));
        EXPECT_NEAR(found->collage_most, most, 1e-3) << width;
        EXPECT_LE(found->most, found->bound + 0.2) << width;
    }
}

class BlocksTask : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(directory_.create().ok());
        path_ = directory_.path() + "/p.png";
        ASSERT_TRUE(write_image(path_, picture(300, 200, 3, waves), SampleFormat::srgb8).ok());
    }
    std::string message() const {
        return compilation_.diagnostics.render(compilation_.sources) + compilation_.status.message();
    }

    TemporaryDirectory directory_;
    std::string path_;
    BlockTask task_;
    Compilation compilation_;
};

TEST_F(BlocksTask, MemoryRefusesBeforehand) {
    task_.memory_bytes = 1 << 20;
    EXPECT_FALSE(code_picture(path_, 8, task_, {}, compilation_));
    EXPECT_THAT(message(), HasSubstr("has 300x200 pixels: to code them takes 2 MiB, and 1 are allowed"));
    EXPECT_THAT(message(), HasSubstr("--memory"));
}

TEST_F(BlocksTask, MemoryRefusesLargeDecodings) {
    task_.memory_bytes = 64 << 20;
    const auto found = code_picture(path_, 30, task_, {}, compilation_);
    ASSERT_TRUE(found) << message();
    const std::string file = directory_.path() + "/p.pifs";
    ASSERT_TRUE(write_text(file, found->text).ok());
    EXPECT_FALSE(draw_pifs(file, ImageSize{3000, 2000}, task_, {}, compilation_));
    EXPECT_THAT(message(), HasSubstr("to 3000x2000 pixels takes"));
}

TEST_F(BlocksTask, WorkAndSignalsEndIt) {
    EXPECT_FALSE(code_picture(path_, 8, task_, CancelFlag([] { return true; }), compilation_));
    EXPECT_EQ(message(), "");
    const auto found = code_picture(path_, 30, task_, {}, compilation_);
    ASSERT_TRUE(found) << message();
    const std::string file = directory_.path() + "/p.pifs";
    ASSERT_TRUE(write_text(file, found->text).ok());
    EXPECT_FALSE(draw_pifs(file, {}, task_, CancelFlag([] { return true; }), compilation_));
    EXPECT_EQ(message(), "");
    task_.seconds = 0.001;
    EXPECT_FALSE(draw_pifs(file, {}, task_, {}, compilation_));
    EXPECT_THAT(message(), HasSubstr("--work"));
}

} // namespace
} // namespace graftal
