// Pictures of the native engine while they are made, and when it is told to stop.

#include "tests/golden/background_run.h"
#include "tests/golden/command_line.h"

#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "runtime/image/image.h"

namespace graftal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

using Clock = std::chrono::steady_clock;

class Progressive : public CommandLine {
  protected:
    BackgroundRun start(const std::string& command, const std::string& output,
                        std::vector<std::string> more) const {
        more.insert(more.begin(),
                    {command, source_path("scenes/forest/forest.inst"), "-o", output, "--engine", "native"});
        return {path("."), more};
    }
    /// A whole picture, or none if there is no file.
    Image picture(const std::string& name) const {
        return exists(name) ? CommandLine::picture(name) : Image();
    }
};

/// True if the pixels of each block, counted from the upper left corner, are equal.
bool is_in_blocks(const Image& image, int side) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < image.channels; ++c) {
                const auto at = [&](int i, int j) {
                    return image.pixels[static_cast<std::size_t>((j * image.width + i) * image.channels + c)];
                };
                if (at(x, y) != at(x - x % side, y - y % side)) return false;
            }
    return true;
}

/// Pixels along each side of the blocks that a picture is made of.
int block_of(const Image& image) {
    for (const int side : {16, 8, 4, 2})
        if (is_in_blocks(image, side)) return side;
    return 1;
}

TEST_F(Progressive, EveryPictureIsWholeAndFinerThanTheLast) {
    BackgroundRun run = start("render", "a.png", {"--size", "640x360", "--antialias", "3"});
    std::vector<Image> seen;
    while (run.running()) {
        const Image image = picture("a.png");
        if (image.width == 0) continue;
        ASSERT_EQ(image.width, 640);
        ASSERT_EQ(image.height, 360);
        if (seen.empty() || image.pixels != seen.back().pixels) seen.push_back(image);
    }
    EXPECT_EQ(run.wait(), 0) << run.messages();
    EXPECT_GE(seen.size(), 2u) << "of 4 or so";
    for (std::size_t i = 1; i < seen.size(); ++i) {
        EXPECT_LE(block_of(seen[i]), block_of(seen[i - 1]));
        if (block_of(seen[i - 1]) > 1) {
            EXPECT_LT(block_of(seen[i]), block_of(seen[i - 1]));
        }
    }
    EXPECT_EQ(files(), "a.png");
    EXPECT_EQ(start("render", "b.png", {"--size", "640x360", "--antialias", "3", "--no-progressive"}).wait(),
              0);
    EXPECT_EQ(compare_images(picture("a.png"), picture("b.png")).differing, 0u)
        << "the last is what there would have been at once";
}

TEST_F(Progressive, WithoutSamplesTheLastIsTheSameToo) {
    for (const std::string size : {"37x23", "8x8", "1x1"}) { // blocks and tiles that are not whole
        for (const std::string antialias : {"off", "2"}) {
            ASSERT_EQ(start("render", "a.png", {"--size", size, "--antialias", antialias, "--no-progressive"})
                          .wait(),
                      0);
            BackgroundRun run = start("render", "b.png", {"--size", size, "--antialias", antialias});
            ASSERT_EQ(run.wait(), 0) << run.messages();
            EXPECT_EQ(compare_images(picture("a.png"), picture("b.png")).differing, 0u) << size << antialias;
        }
    }
}

TEST_F(Progressive, InterruptionLeavesTheBestPictureSoFar) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        BackgroundRun run = start("render", "a.png", {"--size", "1280x720", "--antialias", "4"});
        run.wait_until([&] { return exists("a.png"); });
        run.send(signal);
        EXPECT_EQ(run.wait(), 128 + signal);
        EXPECT_THAT(run.messages(),
                    AllOf(HasSubstr("graftal: interrupted\na.png: unfinished: 1 sample per "),
                          MatchesRegex(".* in [0-9]+\\.[0-9][0-9] s, [0-9.e-]+ million rays per second.*")));
        const Image image = picture("a.png");
        EXPECT_EQ(image.width, 1280);
        EXPECT_EQ(image.height, 720);
        EXPECT_EQ(files(), "a.png");
        EXPECT_EQ(temporary_files(), "");
        ASSERT_EQ(shell("rm a.png").status, 0);
    }
}

TEST_F(Progressive, InterruptionBeforeAPictureLeavesNothing) {
    for (const std::string old : {"", "old"}) {
        if (!old.empty()) write("a.png", old);
        for (const bool progressive : {false, true}) {
            // Progressive, it takes seconds to the first; else, minutes.
            BackgroundRun run = progressive
                                    ? start("render", "a.png", {"--size", "4000x3000"})
                                    : start("render", "a.png", {"--antialias", "9", "--work", "20000"});
            run.wait_until([&] { return run.catches(SIGTERM); });
            run.send(SIGTERM);
            EXPECT_EQ(run.wait(), 128 + SIGTERM);
            EXPECT_EQ(run.messages(), "graftal: interrupted\n");
            EXPECT_EQ(files(), old.empty() ? "" : "a.png");
            EXPECT_EQ(read("a.png"), old);
        }
    }
}

/// A tile of this picture holds 67 million rays, which are minutes.
TEST_F(Progressive, InterruptionIsPrompt) {
    BackgroundRun run = start("render", "a.png", {"--antialias", "9", "--work", "20000", "--threads", "1"});
    run.wait_until([&] { return run.catches(SIGINT); });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const Clock::time_point begin = Clock::now();
    run.send(SIGINT);
    EXPECT_EQ(run.wait(), 128 + SIGINT);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(2))
        << "a hundredth of it, on a machine without work";
}

TEST_F(Progressive, AnimationGoesOnAfterAnInterruption) {
    const std::vector<std::string> turning = {"--size", "128x72", "--antialias", "off", "--frames", "6"};
    BackgroundRun run = start("animate", "a/", turning);
    run.wait_until([&] { return exists("a/frame_0002.png"); });
    run.send(SIGINT);
    EXPECT_EQ(run.wait(), 128 + SIGINT);
    EXPECT_THAT(run.messages(),
                AllOf(HasSubstr("graftal: interrupted\n"),
                      HasSubstr(" of 6 frames are in 'a'; the same command goes on from there\n")));
    EXPECT_FALSE(exists("a/frame_0006.png"));
    EXPECT_EQ(shell("ls -A a | grep -v '^frame_000.[.]png$'").out, "") << "no temporary";
    BackgroundRun rest = start("animate", "a/", turning);
    EXPECT_EQ(rest.wait(), 0) << rest.messages();
    EXPECT_THAT(rest.messages(), HasSubstr(" were there before; "));
    ASSERT_EQ(start("animate", "b/", turning).wait(), 0);
    for (int i = 1; i <= 6; ++i) {
        const std::string name = fmt::format("/frame_{:04}.png", i);
        EXPECT_EQ(compare_images(picture("a" + name), picture("b" + name)).differing, 0u) << i;
    }
}

} // namespace
} // namespace graftal
