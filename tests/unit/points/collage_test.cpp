#include "runtime/points/collage.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/image/distance_transform.h"
#include "runtime/image_files/image_files.h"
#include "runtime/points/draw_points.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

CellSet random_set(int width, int height, double share, unsigned seed, int depth = 1) {
    std::mt19937 random(seed);
    CellSet set(width, height, depth);
    for (std::size_t i = 0; i < set.cells.size(); ++i)
        set.cells[i] = std::uniform_real_distribution<>(0, 1)(random) < share;
    set.cells[set.cells.size() / 3] = true;
    return set;
}

TEST(DistanceTransform, IsExact) {
    for (unsigned seed = 0; seed < 60; ++seed) {
        const int width = 1 + static_cast<int>(seed * 7 % 23), height = 1 + static_cast<int>(seed * 5 % 19);
        const int depth = seed % 2 ? 1 : 1 + static_cast<int>(seed % 7);
        const CellSet set = random_set(width, height, seed % 3 ? 0.02 : 0.3, seed, depth);
        const std::vector<std::int64_t> squared = squared_distances(set);
        const std::vector<std::size_t> nearest = nearest_cells(set);
        const auto apart = [&](std::size_t a, std::size_t b) {
            const auto part = [](std::size_t cell, int each, int count) {
                return static_cast<int>(cell) / each % count;
            };
            std::int64_t sum = 0;
            for (const auto& [each, count] :
                 {std::pair(1, width), std::pair(width, height), std::pair(width * height, depth)}) {
                const std::int64_t away = part(a, each, count) - part(b, each, count);
                sum += away * away;
            }
            return sum;
        };
        for (std::size_t cell = 0; cell < set.cells.size(); ++cell) {
            std::int64_t least = INT64_MAX;
            for (std::size_t other = 0; other < set.cells.size(); ++other)
                if (set.cells[other]) least = std::min(least, apart(cell, other));
            ASSERT_EQ(squared[cell], least) << seed << ": " << cell;
            ASSERT_TRUE(set.cells[nearest[cell]]);
            ASSERT_EQ(apart(cell, nearest[cell]), least) << seed << ": " << cell;
        }
    }
}

TEST(DistanceTransform, HausdorffDistanceLooksBothWays) {
    CellSet a(20, 10), b(20, 10);
    a.cells[a.index(2, 3)] = true;
    b.cells[b.index(2, 3)] = b.cells[b.index(14, 8)] = true;
    EXPECT_DOUBLE_EQ(hausdorff_distance(a, b), 13);
    EXPECT_DOUBLE_EQ(hausdorff_distance(b, a), 13);
    EXPECT_DOUBLE_EQ(hausdorff_distance(a, a), 0);
}

class CollageTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    std::string write(const std::string& name, const std::string& text) {
        const std::string path = directory_.path() + "/" + name;
        EXPECT_TRUE(write_text(path, text).ok());
        return path;
    }

    /// The model's points as an opaque set.
    std::string picture_of(const std::string& model, std::map<std::string, double, std::less<>> set = {}) {
        PointsOptions options;
        options.compile.view.size = {200, 160};
        options.compile.lower.set = std::move(set);
        options.output = directory_.path() + "/target.png";
        options.points = 1'500'000;
        options.tone.transparent = true;
        Compilation compilation;
        PictureSession session(model);
        EXPECT_TRUE(draw_points(session, options, compilation))
            << compilation.diagnostics.render(compilation.sources);
        return options.output;
    }

    std::optional<Collage> measure(const std::string& model, const std::string& target) {
        CollageOptions options;
        options.target = target;
        options.criterion.threshold = 0.001;
        Compilation compilation;
        PictureSession session(model);
        auto collage = measure_collage(session, options, compilation);
        message_ = compilation.diagnostics.render(compilation.sources) + compilation.status.message();
        return collage;
    }

    TemporaryDirectory directory_;
    std::string message_;
};

TEST_F(CollageTest, AnAttractorIsItsOwnCollage) {
    for (const char* name :
         {"ifs/fern.rifs", "ifs/twin_dragon.rifs", "hart/sierpinski.inst", "ifs/koch_curve.rifs"}) {
        const std::string model = std::string(GRAFTAL_SOURCE_DIR) + "/scenes/" + name;
        const auto collage = measure(model, picture_of(model));
        ASSERT_TRUE(collage) << message_;
        EXPECT_LE(collage->epsilon, 3 * collage->pixel) << name;
        ASSERT_TRUE(collage->distance);
        EXPECT_LE(*collage->distance, 3 * collage->pixel) << name;
        EXPECT_TRUE(collage->by_alpha);
    }
}

TEST_F(CollageTest, TheBoundHolds) {
    // Targets that are far from the attractor: other attractors, in the same frame.
    std::mt19937 random(7);
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<>(low, high)(random);
    };
    for (int i = 0; i < 12; ++i) {
        std::string text =
            "let s = 1\ncamera { orthographic location: 0.5,0.5,9 look_at: 0.5,0.5,0 width: 3 }\nrifs r {\n";
        for (int m = 0; m < 3; ++m)
            text += fmt::format("map w{} {{ rotate z {} scale {}*s translate <{}, {}> }}\n", m,
                                number(-90, 90), number(0.3, 0.6), number(0, 0.6), number(0, 0.6));
        const std::string model = write("r.rifs", text + "}\n");
        const auto collage = measure(model, picture_of(model, {{"s", number(0.4, 1.3)}}));
        ASSERT_TRUE(collage) << message_;
        ASSERT_TRUE(collage->distance);
        EXPECT_TRUE(collage->euclidean);
        EXPECT_LE(*collage->distance, collage->bound + 1.5 * collage->pixel);
    }
}

TEST_F(CollageTest, MapsMayContractInAnotherNormOnly) {
    const std::string model =
        write("shear.rifs",
              "rifs shear { codes 2d {\n .5 1.2 0 .5 0 0\n .5 1.2 0 .5 1 0\n .5 1.2 0 .5 0 1\n } }\n");
    const auto collage = measure(model, picture_of(model));
    ASSERT_TRUE(collage) << message_;
    EXPECT_FALSE(collage->euclidean);
    EXPECT_LT(collage->contractivity, 1);
    EXPECT_GT(collage->condition, 1);
    EXPECT_LE(collage->epsilon, 3 * collage->pixel);
}

TEST_F(CollageTest, CondensationCounts) {
    const std::string model =
        write("c.rifs",
              "rifs c { map w { scale 0.7 translate <0.6, 0> }\ncondense cube scale <0.1, 0.4, 1e-6> }\n");
    const auto collage = measure(model, picture_of(model));
    ASSERT_TRUE(collage) << message_;
    EXPECT_EQ(collage->condensations, 1u);
    EXPECT_LE(collage->epsilon, 3 * collage->pixel);
}

TEST_F(CollageTest, WhatCannotBeMeasuredIsExplained) {
    const std::string scenes = std::string(GRAFTAL_SOURCE_DIR) + "/scenes/";
    const std::string fern = scenes + "ifs/fern.rifs", target = picture_of(fern);
    EXPECT_FALSE(measure(fern, "nowhere.png"));
    EXPECT_NE(message_.find("cannot read picture 'nowhere.png'"), std::string::npos) << message_;
    EXPECT_FALSE(measure(fern, fern));
    EXPECT_NE(message_.find("cannot read picture"), std::string::npos) << message_;
    EXPECT_FALSE(measure(scenes + "hart/pound_sign_2d.rifs", target));
    EXPECT_NE(message_.find("not every map may follow every map"), std::string::npos) << message_;
    EXPECT_FALSE(measure(scenes + "ifs/menger_sponge.rifs", target));
    EXPECT_NE(message_.find("leaves the plane z = 0"), std::string::npos) << message_;
    EXPECT_FALSE(measure(scenes + "ifs/tetrahedron.inst", target));
    EXPECT_NE(message_.find("it does not contain itself"), std::string::npos) << message_;
    EXPECT_FALSE(measure(write("grows.rifs", "rifs g { map a { scale 2 } }\n"), target));
    EXPECT_NE(message_.find("does not contract"), std::string::npos) << message_;

    const std::string blank = directory_.path() + "/blank.png";
    ASSERT_TRUE(write_image(blank, {8, 8, 3, std::vector<float>(192, 1.0f)}, SampleFormat::srgb8).ok());
    EXPECT_FALSE(measure(fern, blank));
    EXPECT_NE(message_.find("is empty: it has no pixel darker than 0.001"), std::string::npos) << message_;
}

} // namespace
} // namespace graftal
