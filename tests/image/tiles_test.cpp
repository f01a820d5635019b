// A part of a picture has the very bits that it has in the whole: whatever the light, the lens, the film and
// the samples, and wherever its edges lie. A fit that is found once is the fit of all parts.

#include <cstring>
#include <functional>
#include <optional>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "runtime/render/file_film.h"
#include "runtime/render/native_engine.h"

namespace graftal {
namespace {

constexpr ImageSize size{101, 75};

struct TiledPicture {
    const char* name;
    std::string model; ///< of the project, or a text
    std::function<void(RenderOptions&)> choose;

    friend std::ostream& operator<<(std::ostream& out, const TiledPicture& picture) {
        return out << picture.name;
    }
};

const std::string ball_and_floor = R"(
    material gloss { diffuse: 0.5 specular: 0.6 roughness: 0.02 reflection: 0.3 }
    object things {
        sphere scale: 0.8 translate: 0, 0.8, 0 material gloss tint: 0.8, 0.3, 0.2, 1
        cube scale: 0.3 translate: 1.2, 0.3, 0.6
    }
    ground { height: 0 }
)";

void plainly(RenderOptions& options) {
    options.compile.view.light = DefaultLight::plain;
}

const TiledPicture pictures[] = {
    {"Solid", "scenes/hart/sierpinski.inst", plainly},
    {"OneSample", "scenes/hart/sierpinski.inst",
     [](RenderOptions& options) {
         plainly(options);
         options.antialias = std::nullopt;
     }},
    {"FaintSet", "scenes/hart/pound_sign.rifs",
     [](RenderOptions& options) {
         plainly(options);
         options.antialias = 3;
     }},
    {"Blocks", "scenes/hart/pound_sign.rifs",
     [](RenderOptions& options) {
         plainly(options);
         options.limit_work(1e-3);
     }},
    {"SoftLight", ball_and_floor, [](RenderOptions& options) { options.samples = 3; }},
    {"Noise", ball_and_floor,
     [](RenderOptions& options) {
         options.samples = 64;
         options.noise_255 = 8;
     }},
    {"LensAndFilm",
     ball_and_floor + "camera { location: 3,2,5 look_at: 0,0.5,0 aperture: 0.2 focus: 0,0.5,0 }\n"
                      "film { exposure: 1.3 white: 5000 soft }\n",
     [](RenderOptions& options) { options.samples = 4; }},
    {"FilmOnALattice", ball_and_floor + "film { exposure: 0.7 soft }\n", plainly},
};

class Tiles : public testing::TestWithParam<TiledPicture> {
  protected:
    RenderOptions options() const {
        RenderOptions options;
        options.compile.view.size = size;
        options.output = "picture.png";
        GetParam().choose(options);
        return options;
    }

    std::optional<Image> draw(PictureSession& session, const RenderOptions& options) const {
        Compilation compilation;
        MemoryFilm film(options);
        RenderOptions render = options;
        render.film = &film;
        const auto report = render_natively(session, render, compilation);
        EXPECT_TRUE(report) << compilation.diagnostics.render(compilation.sources)
                            << compilation.status.message();
        return report ? std::optional(film.picture()) : std::nullopt;
    }
};

/// What differs between the tiles and the whole, in samples.
std::size_t differing(const Image& whole, const Tile& tile, const Image& part) {
    std::size_t count = 0;
    for (int y = 0; y < tile.height; ++y) {
        const auto row = 3 * static_cast<std::size_t>(tile.width);
        const float* const a = part.pixels.data() + static_cast<std::size_t>(y) * row;
        const float* const b = whole.pixels.data() + 3 * (static_cast<std::size_t>(tile.y + y) *
                                                              static_cast<std::size_t>(whole.width) +
                                                          static_cast<std::size_t>(tile.x));
        for (std::size_t i = 0; i < row; ++i)
            count += std::memcmp(a + i, b + i, sizeof(float)) != 0;
    }
    return count;
}

TEST_P(Tiles, AreTheWholePicture) {
    const std::string& model = GetParam().model;
    const bool in_file = model.starts_with("scenes/");
    PictureSession session(in_file ? GRAFTAL_SOURCE_DIR "/" + model : "model.inst");
    if (!in_file) session.edit(model);
    RenderOptions chosen = options();
    chosen.denoise = false; // parts are not, either
    const std::optional<Image> whole = draw(session, chosen);
    chosen.denoise.reset();
    ASSERT_TRUE(whole);
    // Something is to be seen, in colours that no blank picture has.
    EXPECT_NE(whole->pixels, std::vector<float>(whole->pixels.size(), whole->pixels.front()));

    Compilation compilation;
    const std::optional<PictureFit> fit = fit_natively(session, chosen, compilation);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->size, size);
    EXPECT_GT(fit->seconds, 0);
    std::uint64_t pixels = 0;
    // Edges at no multiple of anything, within blocks and beside them.
    constexpr int columns[] = {0, 33, 34, 70, size.width}, rows[] = {0, 17, 64, size.height};
    for (std::size_t i = 0; i + 1 < std::size(columns); ++i)
        for (std::size_t j = 0; j + 1 < std::size(rows); ++j) {
            const Tile tile{columns[i], rows[j], columns[i + 1] - columns[i], rows[j + 1] - rows[j]};
            SCOPED_TRACE(testing::Message() << tile.x << "," << tile.y);
            chosen.tile = tile;
            chosen.threads = 1 + static_cast<int>(i % 2);
            chosen.fit = j % 2 == 0 ? fit : std::nullopt;
            const std::optional<Image> part = draw(session, chosen);
            ASSERT_TRUE(part);
            ASSERT_EQ(part->width, tile.width);
            ASSERT_EQ(part->height, tile.height);
            EXPECT_EQ(differing(*whole, tile, *part), 0u);
            pixels += tile.pixels();
        }
    EXPECT_EQ(pixels, whole_of(size).pixels());
}

INSTANTIATE_TEST_SUITE_P(OfPictures, Tiles, testing::ValuesIn(pictures), testing::PrintToStringParamName());

TEST(TilesOfAFit, TakeNoOtherRays) {
    PictureSession session(GRAFTAL_SOURCE_DIR "/scenes/hart/sierpinski.inst");
    RenderOptions options;
    options.compile.view.size = size;
    options.compile.view.light = DefaultLight::plain;
    Compilation compilation;
    options.fit = fit_natively(session, options, compilation);
    ASSERT_TRUE(options.fit);
    options.tile = Tile{40, 30, 10, 10};
    MemoryFilm film(options);
    options.film = &film;
    const auto report = render_natively(session, options, compilation);
    ASSERT_TRUE(report);
    // Lattices of two steps a pixel, their edges included: the tracer's own tiles meet in row 32.
    EXPECT_EQ(report->rays.camera_rays, 21u * 5u + 21u * 17u);
}

} // namespace
} // namespace graftal
