#include "runtime/image_files/animation.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

#include <gif_lib.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/png_chunks.h"
#include "runtime/render/frame_store.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int width = 40, height = 30;

/// Something to tell frames apart by, with gradients.
Image picture(int number) {
    Image image{width, height, 3, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int level : {6 * x, 8 * y, 20 * number})
                image.pixels.push_back(static_cast<float>(level) / 255.0f);
    return image;
}

class AnimationFiles : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    std::string contents(const std::string& name) const {
        std::string text;
        EXPECT_TRUE(read_text(path(name), text).ok());
        return text;
    }
    Image read(const std::string& name) const {
        Image image;
        const Status status = read_image(path(name), image);
        EXPECT_TRUE(status.ok()) << status.message();
        return image;
    }
    std::vector<std::string> write_frames(const FrameStore& store) const {
        for (std::size_t i = 0; i < store.count(); ++i) {
            const ImageMetadata metadata{"test", "frame", "stamp " + std::to_string(i)};
            EXPECT_TRUE(
                write_image(store.path(i), picture(static_cast<int>(i)), SampleFormat::srgb8, metadata).ok());
        }
        return store.paths();
    }
    std::size_t file_count() const {
        const std::filesystem::directory_iterator files(directory_.path());
        return static_cast<std::size_t>(std::distance(begin(files), end(files)));
    }

    TemporaryDirectory directory_;
};

/// The n-th frame of an animated PNG, as a still picture.
std::string still(const std::vector<PngChunk>& chunks, int wanted) {
    std::string text(png_signature);
    text += png_chunk("IHDR", chunks.front().data);
    int frame = -1;
    for (const PngChunk& chunk : chunks) {
        frame += chunk.type == "fcTL";
        if (frame != wanted) continue;
        if (chunk.type == "IDAT") text += png_chunk("IDAT", chunk.data);
        if (chunk.type == "fdAT") text += png_chunk("IDAT", chunk.data.substr(4));
    }
    return text + png_chunk("IEND", {});
}

TEST_F(AnimationFiles, AnimatedPngHoldsTheFramesExactly) {
    const FrameStore store(directory_.path(), 5);
    const std::vector<std::string> frames = write_frames(store);
    ASSERT_TRUE(write_animated_png(path("a.png"), frames, {2500}, [](auto) { return true; }).ok());
    EXPECT_EQ(read("a.png"), picture(0)) << "a still viewer shows the first frame";
    const std::string text = contents("a.png");
    const auto chunks = png_chunks(text);
    ASSERT_TRUE(chunks);
    std::uint32_t sequence = 0;
    for (const PngChunk& chunk : *chunks) {
        if (chunk.type == "acTL") {
            EXPECT_EQ(chunk.data, big_endian(5) + big_endian(0));
        }
        if (chunk.type == "fcTL" || chunk.type == "fdAT") {
            EXPECT_EQ(chunk.data.substr(0, 4), big_endian(sequence++));
        }
        if (chunk.type == "fcTL") {
            EXPECT_EQ(chunk.data.substr(4), big_endian(width) + big_endian(height) + big_endian(0) +
                                                big_endian(0) + big_endian(1, 2) + big_endian(25, 2) +
                                                std::string(2, '\0'));
        }
    }
    for (int i = 0; i < 5; ++i) {
        std::ofstream(path("still.png"), std::ios::binary) << still(*chunks, i);
        EXPECT_EQ(read("still.png"), picture(i)) << i;
    }
    EXPECT_EQ(png_text(*chunks, "Software"), "test");
}

TEST_F(AnimationFiles, GifHoldsTheFramesNearly) {
    const FrameStore store(directory_.path(), 3);
    const std::vector<std::string> frames = write_frames(store);
    ASSERT_TRUE(write_gif(path("a.gif"), frames, {2500}, [](auto) { return true; }).ok());
    const std::string text = contents("a.gif");
    EXPECT_TRUE(text.starts_with("GIF89a") && text.ends_with(';'));
    std::size_t delays = 0; // graphic control extensions with a delay of 4 hundredths
    for (std::size_t at = text.find("\x21\xf9\x04"); at != std::string::npos;
         at = text.find("\x21\xf9\x04", at + 1))
        delays += text[at + 4] == 4 && text[at + 5] == 0;
    EXPECT_EQ(delays, 3u);
    EXPECT_THAT(text, HasSubstr("NETSCAPE2.0")) << "repeats";
    Image first = read("a.gif"), expected = picture(0);
    ASSERT_EQ(first.width, width);
    EXPECT_LT(compare_images(first, expected).mean, 0.02);
}

/// The frames of a GIF as a viewer shows them, and by frame the number of pixels that it draws.
struct ShownFrames {
    std::vector<Image> frames;
    std::vector<int> drawn;
};

ShownFrames shown_frames(const std::string& path) {
    ShownFrames shown;
    GifFileType* gif = DGifOpenFileName(path.c_str(), nullptr);
    EXPECT_TRUE(gif && DGifSlurp(gif) == GIF_OK) << path;
    if (!gif) return shown;
    Image canvas{gif->SWidth, gif->SHeight, 3, {}};
    canvas.pixels.resize(static_cast<std::size_t>(3 * canvas.width * canvas.height));
    for (int i = 0; i < gif->ImageCount; ++i) {
        const SavedImage& image = gif->SavedImages[i];
        GraphicsControlBlock control;
        EXPECT_EQ(DGifSavedExtensionToGCB(gif, i, &control), GIF_OK);
        EXPECT_EQ(image.ImageDesc.ColorMap, nullptr) << "one palette for all";
        int drawn = 0;
        for (int k = 0; k < image.ImageDesc.Width * image.ImageDesc.Height; ++k) {
            if (image.RasterBits[k] == control.TransparentColor) continue;
            ++drawn;
            const GifColorType& colour = gif->SColorMap->Colors[image.RasterBits[k]];
            const int x = image.ImageDesc.Left + k % image.ImageDesc.Width;
            const int y = image.ImageDesc.Top + k / image.ImageDesc.Width;
            float* pixel = canvas.pixels.data() + 3 * (y * canvas.width + x);
            for (const int level : {colour.Red, colour.Green, colour.Blue})
                *pixel++ = static_cast<float>(level) / 255.0f;
        }
        shown.frames.push_back(canvas);
        shown.drawn.push_back(drawn);
    }
    DGifCloseFile(gif, nullptr);
    return shown;
}

/// Palettes by frame made a flower's heart white, pink and olive in turn, and left petals in the sky.
TEST_F(AnimationFiles, WhatStaysKeepsItsColoursInAGif) {
    const FrameStore store(directory_.path(), 4);
    constexpr float red[] = {1.0f, 0.1f, 0.1f};
    std::vector<Image> pictures;
    for (int number = 0; number < 4; ++number) {
        pictures.push_back(picture(3));
        for (int y = 8; y < 14; ++y) // a red square that moves
            for (int x = 7 * number + 4; x < 7 * number + 10; ++x)
                std::copy_n(std::begin(red), 3, pictures.back().pixels.begin() + 3 * (y * width + x));
        ASSERT_TRUE(
            write_image(store.path(static_cast<std::size_t>(number)), pictures.back(), SampleFormat::srgb8)
                .ok());
    }
    ASSERT_TRUE(write_gif(path("a.gif"), store.paths(), {2500}, [](auto) { return true; }).ok());
    const ShownFrames shown = shown_frames(path("a.gif"));
    ASSERT_EQ(shown.frames.size(), 4u);
    EXPECT_EQ(shown.drawn.front(), width * height);
    for (std::size_t i = 0; i < 4; ++i) {
        const ImageDifference apart = compare_images(shown.frames[i], pictures[i]);
        EXPECT_LT(apart.mean, 0.015) << i; // of all colours that there are
        EXPECT_LT(apart.max, 0.12) << i;
        EXPECT_LE(shown.drawn[i],
                  i == 0 ? width * height : 2 * 36); // the square, where it is and where it was
    }
}

TEST_F(AnimationFiles, AFilmOfOneColourIsThat) {
    const FrameStore store(directory_.path(), 2);
    Image plain = picture(0);
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        plain.pixels[i] = static_cast<float>(i % 3 * 50) / 255.0f;
    for (std::size_t i = 0; i < 2; ++i)
        ASSERT_TRUE(write_image(store.path(i), plain, SampleFormat::srgb8).ok());
    ASSERT_TRUE(write_gif(path("a.gif"), store.paths(), {2500}, [](auto) { return true; }).ok());
    const ShownFrames shown = shown_frames(path("a.gif"));
    ASSERT_EQ(shown.frames.size(), 2u);
    EXPECT_EQ(shown.frames.back(), plain);
    EXPECT_EQ(shown.drawn.back(), 0);
}

TEST_F(AnimationFiles, FailuresLeaveNoFile) {
    const FrameStore store(directory_.path(), 3);
    std::vector<std::string> frames = write_frames(store);
    const std::size_t before = file_count();
    const auto give_up = [](std::size_t frame) { return frame < 1; };
    for (const auto write : {write_animated_png, write_gif}) {
        const std::string name = path(write == write_gif ? "a.gif" : "a.png");
        EXPECT_EQ(write(name, frames, {2500}, give_up).message(), "interrupted");
        EXPECT_THAT(write("/nowhere/" + name, frames, {2500}, [](auto) { return true; }).message(),
                    HasSubstr("cannot write"));
    }
    frames.push_back(path("none.png"));
    EXPECT_FALSE(write_animated_png(path("a.png"), frames, {2500}, [](auto) { return true; }).ok());
    EXPECT_FALSE(write_gif(path("a.gif"), frames, {2500}, [](auto) { return true; }).ok());
    frames.pop_back();
    Image wide = picture(1);
    wide.width = height;
    wide.height = width;
    ASSERT_TRUE(write_image(frames.back(), wide, SampleFormat::srgb8).ok());
    EXPECT_THAT(write_animated_png(path("a.png"), frames, {2500}, [](auto) { return true; }).message(),
                HasSubstr("has another size"));
    EXPECT_EQ(file_count(), before);
}

TEST_F(AnimationFiles, ChunksOfDamagedFilesAreRefused) {
    ASSERT_TRUE(write_image(path("a.png"), picture(1), SampleFormat::srgb8, {"", "", "mark"}).ok());
    const std::string whole = contents("a.png");
    ASSERT_TRUE(png_chunks(whole));
    EXPECT_EQ(png_text(*png_chunks(whole), stamp_keyword), "mark");
    EXPECT_FALSE(png_text(*png_chunks(whole), "other"));
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(png_chunks(whole.substr(0, length))) << length;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        EXPECT_FALSE(png_chunks(damaged)) << at;
    }
    EXPECT_FALSE(png_chunks(whole + "x"));
}

TEST_F(AnimationFiles, StoreKnowsItsFrames) {
    FrameStore store(path("new/frames"), 12345);
    ASSERT_TRUE(store.create().ok());
    EXPECT_EQ(store.name(6), "frame_00007.png");
    EXPECT_EQ(store.name_pattern(), "frame_%05d.png");
    EXPECT_EQ(FrameStore("x", 9).name(6), "frame_0007.png");

    const std::string frame = store.path(3);
    EXPECT_FALSE(store.has(3, "s"));
    ASSERT_TRUE(write_image(frame, picture(3), SampleFormat::srgb8, {"", "", "s"}).ok());
    EXPECT_TRUE(store.has(3, "s"));
    EXPECT_FALSE(store.has(3, "t"));
    std::string text;
    ASSERT_TRUE(read_text(frame, text).ok());
    std::ofstream(frame, std::ios::binary) << text.substr(0, text.size() - 20);
    EXPECT_FALSE(store.has(3, "s")) << "half a file";
    std::ofstream(frame, std::ios::binary) << text;

    // What is not ours stays, and the directory with it.
    const std::string strange = store.directory() + "/frame_12346.png";
    ASSERT_TRUE(write_image(strange, picture(3), SampleFormat::srgb8).ok());
    ASSERT_TRUE(
        write_image(store.directory() + "/frame_12347.png", picture(3), SampleFormat::srgb8, {"", "", "u"})
            .ok());
    std::ofstream(store.directory() + "/.frame_00009.123.1.png") << "half";
    std::ofstream(store.directory() + "/notes.txt") << "mine";
    store.tidy();
    EXPECT_FALSE(std::filesystem::exists(store.directory() + "/.frame_00009.123.1.png"));
    store.remove();
    EXPECT_FALSE(std::filesystem::exists(frame));
    EXPECT_FALSE(std::filesystem::exists(store.directory() + "/frame_12347.png"));
    EXPECT_TRUE(std::filesystem::exists(strange));
    std::filesystem::remove(strange);
    std::filesystem::remove(store.directory() + "/notes.txt");
    store.remove();
    EXPECT_FALSE(std::filesystem::exists(store.directory()));
}

TEST_F(AnimationFiles, DigestDependsOnAllThatIsAdded) {
    const auto digest = [](std::initializer_list<const char*> texts) {
        Digest sum;
        for (const char* text : texts)
            sum.add(text);
        return sum.text();
    };
    EXPECT_EQ(digest({"a", "b"}), digest({"a", "b"}));
    EXPECT_NE(digest({"a", "b"}), digest({"b", "a"}));
    EXPECT_NE(digest({"ab", ""}), digest({"a", "b"}));
    EXPECT_EQ(digest({}).size(), 16u);
}

/// While one lives, files cannot grow beyond a size: writing more fails as on a full disk.
class SmallFiles {
  public:
    explicit SmallFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~SmallFiles() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

  private:
    rlimit before_;
    void (*handler_)(int);
};

/// Files may take bytes that find no room without a word, and half a picture would be renamed.
TEST_F(AnimationFiles, NoRoomIsAFailure) {
    const FrameStore store(directory_.path(), 2);
    const std::vector<std::string> frames = write_frames(store);
    const auto all = [](auto) { return true; };
    const auto write = [&](const std::string& name) {
        if (name == "a.gif") return write_gif(path(name), frames, {2500}, all);
        if (name == "a.apng") return write_animated_png(path(name), frames, {2500}, all);
        return write_image(path(name), picture(1), SampleFormat::srgb8);
    };
    for (const std::string name : {"a.png", "a.exr", "a.gif", "a.apng"}) {
        ASSERT_TRUE(write(name).ok());
        const auto whole = std::filesystem::file_size(path(name));
        std::filesystem::remove(path(name));
        const std::size_t before = file_count();
        for (const auto bytes : {whole - 1, whole / 2, std::uintmax_t{1}}) {
            const SmallFiles small(bytes);
            EXPECT_THAT(write(name).message(), AllOf(HasSubstr("cannot write"), HasSubstr("File too large")))
                << name << " " << bytes;
        }
        EXPECT_EQ(file_count(), before) << name;
        const SmallFiles enough(whole);
        EXPECT_TRUE(write(name).ok()) << name;
    }
}

} // namespace
} // namespace graftal
