#include "runtime/points/draw_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "runtime/points/glow.h"
#include "runtime/points/point_projection.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "runtime/trace/camera_rays.h"

namespace graftal {
namespace {

class Points : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    std::string read(const std::string& name) const {
        std::string text;
        EXPECT_TRUE(read_text(path(name), text).ok()) << name;
        return text;
    }
    std::string scene(const std::string& name) const {
        return std::string(GRAFTAL_SOURCE_DIR) + "/scenes/" + name;
    }

    std::optional<PointsReport> draw(const std::string& model, const std::string& output,
                                     std::uint64_t points, int threads = 2,
                                     PointColour colour = PointColour::tint) {
        PointsOptions options;
        options.compile.view.size = {160, 120};
        options.output = path(output);
        options.points = points;
        options.threads = threads;
        options.colour = colour;
        Compilation compilation;
        PictureSession session(model);
        auto report = draw_points(session, options, compilation);
        message_ = compilation.diagnostics.render(compilation.sources) + compilation.status.message();
        return report;
    }

    TemporaryDirectory directory_;
    std::string message_;
};

TEST_F(Points, TheSameBytesForAnyNumberOfThreads) {
    for (const char* model :
         {"ifs/fern.rifs", "hart/pound_sign.rifs", "hart/elm.inst", "orbits/julia_set.rifs"})
        for (const char* ending : {".png", ".ply"}) {
            const std::string one = std::string("one") + ending, three = std::string("three") + ending;
            ASSERT_TRUE(draw(scene(model), one, 400'001, 1)) << message_;
            ASSERT_TRUE(draw(scene(model), three, 400'001, 3)) << message_;
            EXPECT_TRUE(read(one) == read(three)) << model << ending;
        }
}

TEST_F(Points, CloudsHaveEveryPointInThePlaceThatItHas) {
    ASSERT_TRUE(draw(scene("ifs/fern.rifs"), "fern.ply", 200'000)) << message_;
    const std::string text = read("fern.ply");
    const std::size_t head = text.find("end_header\n") + 11;
    EXPECT_NE(text.find("format binary_little_endian 1.0\n"), std::string::npos);
    EXPECT_NE(text.find("element vertex 200000\n"), std::string::npos);
    ASSERT_EQ(text.size(), head + 15 * 200'000);
    for (std::size_t i = 0; i < 200'000; ++i) {
        float p[3];
        std::memcpy(p, text.data() + head + 15 * i, sizeof p);
        ASSERT_GE(p[0], -2.182f);
        ASSERT_LE(p[0], 2.656f);
        ASSERT_GE(p[1], 0);
        ASSERT_LE(p[1], 9.999f);
        ASSERT_EQ(p[2], 0);
    }
}

TEST_F(Points, ColoursByMapAndByDensity) {
    ASSERT_TRUE(draw(scene("ifs/twin_dragon.rifs"), "map.png", 300'000, 2, PointColour::map)) << message_;
    ASSERT_TRUE(draw(scene("ifs/twin_dragon.rifs"), "tint.png", 300'000)) << message_;
    ASSERT_TRUE(draw(scene("ifs/twin_dragon.rifs"), "density.exr", 300'000, 2, PointColour::density))
        << message_;
    EXPECT_FALSE(read("map.png") == read("tint.png"));
}

TEST_F(Points, WhatHasNoRoomIsNotBegun) {
    EXPECT_FALSE(draw(scene("ifs/fern.rifs"), "fern.ply", 1'000'000'000'000'000));
    EXPECT_NE(message_.find("no room for"), std::string::npos) << message_;
    EXPECT_TRUE(std::filesystem::is_empty(directory_.path()));
}

/// Places of the points of a .ply: x and y.
std::vector<glm::dvec2> places_of(const std::string& ply) {
    const std::string end = "end_header\n";
    constexpr std::size_t stride = 15;
    std::vector<glm::dvec2> places;
    for (std::size_t at = ply.find(end) + end.size(); at + stride <= ply.size(); at += stride) {
        float xyz[3];
        std::memcpy(xyz, ply.data() + at, sizeof xyz);
        places.emplace_back(xyz[0], xyz[1]);
    }
    return places;
}

/// Maps to the corners 0, 1 and 2 of a line: a never follows itself, and only b follows c.
TEST_F(Points, OrbitsFollowTheirMatrix) {
    ASSERT_TRUE(write_text(path("o.rifs"), "orbit o {\n map a { x = 0  y = x  probability 1/2 }\n"
                                           " map b { x = 1  y = x  probability 1/4 }\n"
                                           " map c { x = 2  y = x  probability 1/4 }\n"
                                           " follow matrix {\n 0 1 3\n 1 1 1\n 0 1 0\n }\n}\n")
                    .ok());
    ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 400'000)) << message_;
    std::map<std::pair<int, int>, double> count; // of a map and the one before
    for (const glm::dvec2 place : places_of(read("o.ply")))
        count[{static_cast<int>(place.y), static_cast<int>(place.x)}] += 1;
    const auto share = [&](int before, int after) {
        return count[{before, after}] / (count[{before, 0}] + count[{before, 1}] + count[{before, 2}]);
    };
    EXPECT_EQ(share(0, 0), 0);
    EXPECT_NEAR(share(0, 1), 0.25, 0.01); // 1/4 of 1/4 and 3/4
    EXPECT_NEAR(share(1, 0), 0.5, 0.01);
    EXPECT_NEAR(share(1, 2), 0.25, 0.01);
    EXPECT_EQ(share(2, 1), 1);
}

TEST_F(Points, OrbitsShowWhatFinalMakesOfEachPoint) {
    ASSERT_TRUE(write_text(path("o.rifs"),
                           "orbit o {\n map { x = x/2  y = 0 }\n map { x = x/2 + 1/2  y = 0 }\n"
                           " final { let far = 2*x  x = far*far  y = 7  tint rgb <1, 0, 0> 1 }\n}\n")
                    .ok());
    ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 100'000)) << message_;
    double sum = 0, roots = 0;
    const std::vector<glm::dvec2> places = places_of(read("o.ply"));
    for (const glm::dvec2 place : places) {
        EXPECT_EQ(place.y, 7);
        sum += place.x;
        roots += std::sqrt(place.x);
    }
    // Means of x evenly in [0, 1]; an orbit that goes on from what is shown would leave it.
    EXPECT_NEAR(roots / static_cast<double>(places.size()), 1, 0.01);
    EXPECT_NEAR(sum / static_cast<double>(places.size()), 4.0 / 3, 0.02);
    EXPECT_EQ(read("o.ply").substr(read("o.ply").size() - 3), std::string("\xff\0\0", 3));
}

/// Every call is a number of its own, the same for both coordinates where a name keeps it.
TEST_F(Points, OrbitsDrawRandomNumbers) {
    ASSERT_TRUE(write_text(path("o.rifs"),
                           "orbit o {\n let unused = 1\n map { let t = random(0, 360), n = normal(0, 0.1)\n"
                           "  x = cos(t)  y = sin(t) + n - n + random(2, 3) - random(2, 3) } }\n")
                    .ok());
    ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 200'000)) << message_;
    double across = 0, up = 0;
    const std::vector<glm::dvec2> places = places_of(read("o.ply"));
    for (const glm::dvec2 place : places) {
        across += place.x * place.x;
        up += place.y * place.y;
    }
    EXPECT_NEAR(across / static_cast<double>(places.size()), 1.0 / 2, 0.005);
    EXPECT_NEAR(up / static_cast<double>(places.size()), 1.0 / 2 + 1.0 / 6, 0.005); // a triangle's, too
    const std::string one = read("o.ply");
    ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 200'000, 1)) << message_;
    EXPECT_TRUE(read("o.ply") == one) << "by any number of threads";
}

TEST_F(Points, OrbitsThatGoAstrayAreExplained) {
    const struct {
        const char *text, *message;
    } cases[] = {
        {"orbit o { start <1, 1>  x = 2*x  y = y }\n",
         "the orbit diverges: in step 34 it goes from <8589934592, 1>"},
        {"orbit o { start <1, 0>  x = 1/y  y = x }\n", "division by zero"},
        {"orbit o { start <1, 0>  map { let u = sqrt(y - x) x = u y = 0 } }\n", "sqrt"},
        {"orbit o { start <1, 1>  map { x = 2*x  y = y } map { x = x/2 y = 3*y } }\n", "the orbit diverges"},
        {"orbit o { map { x = 0 y = 0 } final { x = 1/x  y = 0 } }\n", "division by zero"},
        {"orbit o { x = 1/floor(random(0, 2))  y = 0 }\n", "division by zero"},
    };
    for (const auto& [text, message] : cases) {
        ASSERT_TRUE(write_text(path("o.rifs"), text).ok());
        EXPECT_FALSE(draw(path("o.rifs"), "o.png", 1'000'000));
        EXPECT_NE(message_.find(message), std::string::npos) << message_;
        EXPECT_NE(message_.find("o.rifs:1:"), std::string::npos) << message_;
        EXPECT_FALSE(std::filesystem::exists(path("o.png")));
    }
}

/// One in two moves has no value; five in sequence, one time in 32, end at a random place that counts.
TEST_F(Points, OrbitsMayBeginAgain) {
    const std::string sometimes = "x = 1/floor(random(0, 2))  y = 7";
    for (const std::string& maps : {sometimes, "map { " + sometimes + " } map { " + sometimes + " }"}) {
        ASSERT_TRUE(write_text(path("o.rifs"), "orbit o { restart 3\n " + maps + " }\n").ok());
        ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 200'000)) << message_;
        EXPECT_EQ(message_, "");
        double again = 0, farthest = 0;
        const std::vector<glm::dvec2> places = places_of(read("o.ply"));
        for (const glm::dvec2 place : places) {
            if (place.x == 1 && place.y == 7) continue;
            again += 1;
            farthest = std::max({farthest, std::abs(place.x), std::abs(place.y)});
        }
        EXPECT_NEAR(again / static_cast<double>(places.size()), 1.0 / 32, 0.002);
        EXPECT_LE(farthest, 3);
        EXPECT_GT(farthest, 2.9);
        const std::string one = read("o.ply");
        ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 200'000, 1)) << message_;
        EXPECT_TRUE(read("o.ply") == one) << "by any number of threads";
    }
}

/// Whatever goes wrong: divisions, roots, numbers too large for their kind, and what runs away slowly.
TEST_F(Points, OrbitsThatAlwaysBeginAgainAreWarnedOf) {
    for (const std::string image : {"1/0", "sqrt(-1 - x*x)", "exp(exp(9 + x*x))", "1e11", "log(0*x)",
                                    "exp(999) - exp(999)", "(-1)^(1/2 + 0*x)", "tan(90 + 0*x)"}) {
        ASSERT_TRUE(write_text(path("o.rifs"), "orbit o { restart 1  map { x = " + image +
                                                   " y = y } map { x = x  y = " + image + " }\n" +
                                                   "final { x = 1/(x - x)  y = 0 } }\n")
                        .ok());
        ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 10'000)) << image << message_;
        EXPECT_NE(message_.find("warning: 100 of 100 points of this orbit run away"), std::string::npos)
            << image << message_;
        for (const glm::dvec2 place : places_of(read("o.ply")))
            ASSERT_LE(std::max(std::abs(place.x), std::abs(place.y)), 1) << image;
    }
}

TEST_F(Points, OrbitsThatAreWrongAreExplained) {
    const struct {
        const char *text, *message;
    } cases[] = {
        {"orbit o { }\n", "'orbit o' has no map"},
        {"orbit o { x = y }\n", "this map has no formula 'y = ...'"},
        {"orbit o { x = y  y = u }\n", "unknown name 'u'"},
        {"orbit o { f(t) = g(t)  g(t) = t  x = f(y)  y = x }\n", "'g' is not defined above"},
        {"orbit o { f(t) = f(t)  x = f(y)  y = x }\n", "'f' is not defined above"},
        {"orbit o { f(t) = t  x = f(y, 1)  y = x }\n", "'f' takes 1 argument, not 2"},
        {"orbit o { skip 0.5  x = y  y = x }\n", "'skip' must be a whole number from 0 to 1e9, not 0.5"},
        {"orbit o { restart 0  x = y  y = x }\n", "'restart' must be above 0 and at most 1e+10, not 0"},
        {"orbit o { restart 1  restart 2  x = y  y = x }\n", "duplicate 'restart'"},
        {"orbit o { map { x = y y = x probability 0 } }\n", "the probabilities of 'orbit o' are all 0"},
        {"orbit o { map { x = y y = x probability 1 } map { x = y y = x } }\n",
         "either all maps have a probability"},
        {"orbit o { map { x = y y = x probability 2 } }\n", "a probability must lie between 0 and 1, not 2"},
        {"orbit o { map { x = y y = x material m } }\n", "unknown material 'm'"},
        {"orbit o { let c = random(0, 1)  x = c  y = x }\n", "random"},
        {"orbit o { map { x = y y = x } final { x = x } }\n", "this map has no formula 'y = ...'"},
        {"orbit o { map { x = y y = x } final { x = x y = y probability 1 } }\n",
         "'final' maps every point: it has no probability"},
        {"orbit o { map { x = y y = x } final { x = x y = y }\n final { x = x y = y } }\n",
         "duplicate 'final'"},
        {"orbit o { map { x = y y = x } follow all }\n", "an orbit takes 'follow matrix { ... }'"},
        {"orbit o { map { x = y y = x } follow matrix {\n 1 1\n } }\n",
         "the matrix of 'orbit o' needs 1 rows of as many numbers, for it has 1 map"},
        {"orbit o { map { x = y y = x } follow matrix {\n -1\n } }\n",
         "an entry must lie between 0 and 1e+06, not -1"},
        {"orbit o { map { x = y y = x } follow matrix {\n 0\n } }\n",
         "no map may follow map 1: the orbit would end"},
        {"orbit o { x = y  y = x }\norbit p { x = y  y = x }\n", "an orbit must be alone in its file"},
    };
    for (const auto& [text, message] : cases) {
        ASSERT_TRUE(write_text(path("o.rifs"), text).ok());
        EXPECT_FALSE(draw(path("o.rifs"), "o.png", 1000)) << text;
        EXPECT_NE(message_.find(message), std::string::npos) << message_;
        EXPECT_NE(message_.find("o.rifs:"), std::string::npos) << message_;
    }
    // Functions of functions, each twice in the next: 2^40 words.
    std::string text = "orbit o {\n f0(t) = t + t\n";
    for (int i = 1; i < 40; ++i)
        text += "f" + std::to_string(i) + "(t) = f" + std::to_string(i - 1) + "(t) + f" +
                std::to_string(i - 1) + "(t)\n";
    ASSERT_TRUE(write_text(path("o.rifs"), text + "x = f39(x)  y = x }\n").ok());
    EXPECT_FALSE(draw(path("o.rifs"), "o.png", 1000));
    EXPECT_NE(message_.find("this formula has more than 100000 words"), std::string::npos)
        << message_.substr(0, 500);
}

TEST_F(Points, OrbitsFollowTheirFormulas) {
    ASSERT_TRUE(write_text(path("o.rifs"), "let k = 2\norbit o { let half = 1/k  f(u, v) = (u + v)*half\n"
                                           "g(u) = f(u, 4)  start <0, 8> skip 0  x = g(x)  y = f(y, x) }\n")
                    .ok());
    ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 3)) << message_;
    const std::string text = read("o.ply");
    float p[3];
    const double expected[3][2] = {{2, 4}, {3, 3}, {3.5, 3}};
    for (std::size_t i = 0; i < 3; ++i) {
        std::memcpy(p, text.data() + text.find("end_header\n") + 11 + 15 * i, sizeof p);
        EXPECT_EQ(p[0], expected[i][0]);
        EXPECT_EQ(p[1], expected[i][1]);
    }
}

TEST_F(Points, OrbitsHaveNoLens) {
    ASSERT_TRUE(write_text(path("o.rifs"),
                           "orbit o { map { x = x/2  y = 0 } map { x = x/2 + 1/2  y = y/2 } }\n"
                           "camera { location: 0,0,5  look_at: 0,0,0  aperture: 0.5 }\n")
                    .ok());
    ASSERT_TRUE(draw(path("o.rifs"), "o.png", 1000)) << message_;
    EXPECT_NE(message_.find("warning: random points have no lens"), std::string::npos) << message_;
}

TEST_F(Points, OrbitsThatSkipMuchAreNoted) {
    for (const std::string skip : {"100", "200000"}) {
        ASSERT_TRUE(
            write_text(path("o.rifs"),
                       "orbit o { skip " + skip + "  map { x = x/2  y = 0 } map { x = x/2 + 1/2  y = 0 } }\n")
                .ok());
        ASSERT_TRUE(draw(path("o.rifs"), "o.ply", 140'000)) << message_;
        EXPECT_EQ(message_.find("'skip' leaves out 200000 points before every 131072") != std::string::npos,
                  skip == "200000")
            << message_;
    }
}

TEST_F(Points, LieWhereRaysSeeThem) {
    // Any point in front of the eye falls into the pixel whose ray goes through it.
    for (const bool parallel : {false, true}) {
        View view;
        view.size = {64, 48};
        view.camera.location = {1, 2, 5};
        view.camera.orthographic = parallel;
        view.camera.width = 3;
        const CameraRays rays(view);
        const PointProjection projection(view.camera, view.size);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x) {
                const Ray ray = rays.through(x + 0.3, y + 0.6);
                const auto pixel = projection.pixel_of(ray.origin + 3.7 * ray.direction);
                ASSERT_TRUE(pixel);
                EXPECT_EQ(*pixel, static_cast<std::size_t>(64 * y + x));
            }
        EXPECT_FALSE(projection.pixel_of({1e6, 2, 0}));
        if (!parallel) {
            EXPECT_FALSE(projection.pixel_of({1, 2, 7}));
        }
    }
}

TEST(Tone, CoversFromNothingToAll) {
    View view;
    view.size = {3, 1};
    Accumulation points(view.size);
    const float red[3] = {1, 0, 0};
    for (int i = 0; i < 1000; ++i)
        points.add(0, red);
    points.add(1, red);
    Tone tone;
    tone.transparent = true;
    const Image image = toned(points, tone, view);
    EXPECT_EQ(image.pixels[3], 1);
    EXPECT_GT(image.pixels[7], 0);
    EXPECT_LT(image.pixels[7], 0.1);
    EXPECT_EQ(image.pixels[11], 0);
    EXPECT_EQ(image.pixels[4], 1);
    EXPECT_EQ(image.pixels[5], 0);
}

TEST(Tone, TheGroundIsTheSkyThatTheModelShows) {
    View view;
    view.size = {1, 3};
    SkyLight& sky = view.sky_light.emplace();
    sky.zenith = Rgb(0, 0, 1);
    sky.horizon = Rgb(1.0);
    sky.below = Rgb(0, 1, 0);
    view.shows_sky_light = true;
    const double up = 2 * std::tan(view.camera.angle_deg * std::numbers::pi / 360);
    for (const bool parallel : {false, true}) {
        view.camera.orthographic = parallel;
        const Image image = toned(Accumulation(view.size), Tone(), view);
        ASSERT_EQ(image.pixels.size(), 9u);
        for (int y = 0; y < 3; ++y) {
            const Rgb expected = view.background(glm::normalize(Vec3(0, parallel ? 0 : (1 - y) * up, -1)));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(image.pixels[static_cast<std::size_t>(3 * y + c)], expected[c], 1e-6) << y;
        }
    }
}

TEST(Tone, LightAddsToTheGroundAndMayBeBrighterThanWhite) {
    View view;
    view.size = {100, 1};
    Accumulation points(view.size);
    const float red[3] = {1, 0, 0};
    for (std::size_t pixel = 0; pixel < 99; ++pixel)
        for (int i = 0; i < (pixel == 98 ? 1000 : 10); ++i)
            points.add(pixel, red);
    Tone tone;
    tone.ground = Rgb(0.25, 0.5, 0);
    tone.light = true;
    const Image light = toned(points, tone, view);
    EXPECT_FLOAT_EQ(light.pixels[0], 1.25f);
    EXPECT_FLOAT_EQ(light.pixels[1], 0.5f);
    EXPECT_GT(light.pixels[3 * 98], 1.5f);
    EXPECT_FLOAT_EQ(light.pixels[3 * 99], 0.25f);
    tone.light = false;
    const Image cover = toned(points, tone, view);
    EXPECT_FLOAT_EQ(cover.pixels[3 * 98], 1);
    EXPECT_FLOAT_EQ(cover.pixels[3 * 98 + 1], 0);
    tone.by_density = true;
    tone.scale = *ColourScale::parse("white,#000000");
    EXPECT_FLOAT_EQ(toned(points, tone, view).pixels[3 * 98 + 2], 0);
}

TEST(ColourScale, IsANameOrColours) {
    const ColourScale scale = *ColourScale::parse("#ff0000,black,white");
    EXPECT_EQ(scale.at(-1), Rgb(1, 0, 0));
    EXPECT_EQ(scale.at(0.5), Rgb(0.0));
    EXPECT_EQ(scale.at(7), Rgb(1.0));
    EXPECT_NEAR(scale.at(0.75).r, 0.2140, 1e-4); // half of sRGB
    for (const char* name : {"viridis", "gold", "ice", "ember", "grey", "ink"})
        EXPECT_TRUE(ColourScale::parse(name)) << name;
    for (const char* wrong :
         {"", "red", "black", "#12345,white", "white,", ",white", "#gg0000,white", "#-10000,white"})
        EXPECT_FALSE(ColourScale::parse(wrong)) << wrong;
    std::string many = "black";
    for (int i = 0; i < 64; ++i)
        many += ",white";
    EXPECT_FALSE(ColourScale::parse(many));
}

TEST(Glow, SpreadsTheLightAndLosesNone) {
    for (const ImageSize size : {ImageSize{256, 192}, ImageSize{5, 3}, ImageSize{1, 1}, ImageSize{1000, 1}}) {
        const std::size_t samples =
            3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        Image even{size.width, size.height, 3, std::vector<float>(samples, 0.5f)};
        spread_glow(even, 0.4);
        for (const float value : even.pixels)
            ASSERT_NEAR(value, 0.5, 1e-5);
    }
    Image dot{256, 256, 3, std::vector<float>(3 * 256 * 256)};
    const auto red = [&](int x, int y) -> float& {
        return dot.pixels[static_cast<std::size_t>(3 * (256 * y + x))];
    };
    red(128, 128) = 1000;
    spread_glow(dot, 0.5);
    double sum = 0;
    for (const float value : dot.pixels)
        sum += value;
    EXPECT_NEAR(sum, 1000, 0.1);
    EXPECT_GT(red(128, 128), 500);
    EXPECT_GT(red(131, 128), red(140, 128));
    EXPECT_GT(red(140, 128), red(146, 128));
    EXPECT_GT(red(146, 128), 0);
    EXPECT_EQ(dot.pixels[3 * (256 * 128 + 131) + 1], 0);
}

} // namespace
} // namespace graftal
