#include "runtime/inverse/blocks/pifs_file.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/support/counter_random.h"
#include "runtime/inverse/blocks/decode.h"
#include "runtime/inverse/blocks/encode.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t memory = 64 << 20;

std::string fault_of(std::string_view text, std::uint64_t memory_bytes = memory) {
    std::string fault;
    EXPECT_FALSE(read_pifs(text, memory_bytes, fault)) << "accepted";
    return fault;
}

BlockPicture some_picture() {
    PicturePlanes planes{75, 50, true, true, {}};
    for (const int half : {0, 1, 1, 0}) {
        planes.planes.emplace_back(half ? 38 : 75, half ? 25 : 50);
        LevelPlane& plane = planes.planes.back();
        for (std::size_t i = 0; i < plane.levels.size(); ++i)
            plane.levels[i] =
                static_cast<float>(128 + 100 * std::sin(0.05 * static_cast<double>(i * i % 977)));
    }
    return find_blocks(planes, {6, 30}, SerialWorkers(), {}, {}).picture;
}

TEST(PifsFile, WhatIsWrittenIsRead) {
    const BlockPicture picture = some_picture();
    std::string fault;
    const auto read = read_pifs(pifs_text(picture), memory, fault);
    ASSERT_TRUE(read) << fault;
    EXPECT_EQ(read->width, 75);
    EXPECT_EQ(read->height, 50);
    EXPECT_TRUE(read->colour && read->alpha);
    ASSERT_EQ(read->planes.size(), picture.planes.size());
    std::size_t sloped = 0;
    for (std::size_t i = 0; i < picture.planes.size(); ++i) {
        EXPECT_EQ(read->planes[i].blocks, picture.planes[i].blocks) << i;
        EXPECT_EQ(read->planes[i].pool_bits, picture.planes[i].pool_bits);
        for (const BlockMap& block : picture.planes[i].blocks)
            sloped += block.slope != 0;
    }
    EXPECT_GT(sloped, 20u);
}

TEST(PifsFile, TruncationsAndFlippedBitsAreSeenOrChangeNothing) {
    const BlockPicture picture = some_picture();
    const std::string text = pifs_text(picture);
    std::size_t idle = 0;
    for (std::size_t length = 0; length < text.size(); ++length)
        EXPECT_NE(fault_of(text.substr(0, length)), "");
    for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
        std::string flipped = text;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
        std::string fault;
        const auto read = read_pifs(flipped, memory, fault);
        ASSERT_NE(fault.empty(), !read) << bit;
        if (!read) continue;
        ++idle; // such as the one that no decoder may look at (RFC 8878, 3.1.1.1.1.4)
        for (std::size_t i = 0; i < picture.planes.size(); ++i)
            ASSERT_EQ(read->planes[i].blocks, picture.planes[i].blocks) << bit;
    }
    EXPECT_LT(idle, text.size() / 8);
    EXPECT_THAT(fault_of(text + "x"), HasSubstr("cut off, or has more"));
    EXPECT_THAT(fault_of("not one"), HasSubstr("does not begin with PIFS"));
    EXPECT_THAT(fault_of("PIFS\x02"), HasSubstr("version"));
}

/// A file of a grey picture of 8x8 pixels in one block, or in four with one domain, if nothing is changed.
struct Content {
    int kind = 0, pool = 12, width = 8, height = 8;
    std::string rest = std::string(1, '\1') + std::string("\1\1\1\1\x40\x40\x40\x40") + std::string(8, '\0');
    std::string text() const {
        std::string head = {static_cast<char>(kind),   static_cast<char>(pool),
                            static_cast<char>(width),  static_cast<char>(width >> 8),
                            static_cast<char>(height), static_cast<char>(height >> 8)};
        return pifs_around(std::vector{head + rest});
    }
};

TEST(PifsFile, FaultyContentIsRefused) {
    std::string fault;
    ASSERT_TRUE(read_pifs(Content{}.text(), memory, fault)) << fault;
    EXPECT_THAT(fault_of(Content{.kind = 4}.text()), HasSubstr("head"));
    EXPECT_THAT(fault_of(Content{.pool = 17}.text()), HasSubstr("head"));
    EXPECT_THAT(fault_of(Content{.width = 0}.text()), HasSubstr("head"));
    EXPECT_THAT(fault_of(Content{.height = 32769}.text()), HasSubstr("head"));
    EXPECT_THAT(fault_of(Content{.width = 32768, .height = 32768}.text()), HasSubstr("more memory"));
    EXPECT_THAT(fault_of(Content{.width = 1024, .height = 1024}.text()), HasSubstr("ends too early"));
    Content content;
    content.rest[0] = '\3';
    EXPECT_THAT(fault_of(content.text()), HasSubstr("bits are left over"));
    content = {};
    content.rest[1] = '\x71';
    EXPECT_THAT(fault_of(content.text()), HasSubstr("too steep"));
    content = {};
    content.rest[9] = '\1'; // the pool has one domain
    EXPECT_THAT(fault_of(content.text()), HasSubstr("names a domain"));
    content = {};
    content.rest += '\0';
    EXPECT_THAT(fault_of(content.text()), HasSubstr("too long"));
    content = {.width = 4, .height = 4, .rest = std::string("\1\x40\0\0", 4)}; // smaller than a domain
    EXPECT_THAT(fault_of(content.text()), HasSubstr("names a domain"));
}

TEST(PifsFile, AContentThatIsHugeIsRefusedBeforeItIsMade) {
    const std::string bomb = pifs_around(std::vector{std::string(40 << 20, '\0')});
    EXPECT_LT(bomb.size(), 10'000u);
    EXPECT_THAT(fault_of(bomb), HasSubstr("its content takes 40 MiB"));
    EXPECT_THAT(fault_of(bomb, 256 << 20), HasSubstr("head"));
}

TEST(PifsFile, RandomContentIsDecodedOrRefused) {
    const CounterRandom random(5);
    std::uint64_t draws = 0;
    int accepted = 0;
    for (int i = 0; i < 2000; ++i) {
        Content content{.kind = i % 4, .pool = i % 17, .width = 1 + i % 70, .height = 1 + i / 31};
        content.rest.assign(random(draws++) % 600, '\0');
        for (char& byte : content.rest)
            if (random(draws++) % 4 == 0) byte = static_cast<char>(random(draws++) % (i % 3 ? 0x71 : 0x100));
        std::string fault;
        // The right length: cut where the content is too long.
        for (std::size_t length = content.rest.size(); length > 0; --length) {
            if (const auto picture = read_pifs(content.text(), memory, fault)) {
                ++accepted;
                const PicturePlanes drawn = decode_blocks(*picture, 9, 7, SerialWorkers(), no_control(), {});
                for (const float level : drawn.planes[0].levels)
                    ASSERT_TRUE(std::isfinite(level));
                break;
            }
            ASSERT_NE(fault, "");
            if (fault.find("too long") == std::string::npos) break;
            content.rest.resize(length - 1);
        }
    }
    EXPECT_GT(accepted, 20);
}

} // namespace
} // namespace graftal
