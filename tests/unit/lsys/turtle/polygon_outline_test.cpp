// Outlines of a turtle's polygons: what a picture covers once.

#include "compiler/lsys/turtle/polygon_outline.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/unfold.h"
#include "compiler/languages/lower.h"
#include "compiler/support/files.h"

namespace graftal::testing {
namespace {

using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

const Mat3 plain_axes(1.0); // right, ahead, up
const std::vector<Vec3> leaf = {{0, 0, 0}, {-0.4, 0.6, 0}, {0, 2, 0}, {0.6, 0.5, 0}};

TEST(PolygonOutline, StandsAsTheTurtleDidWhereItBegan) {
    const auto outline = outline_of(leaf, plain_axes);
    ASSERT_TRUE(outline);
    EXPECT_THAT(outline->numbers, Pointwise(DoubleNear(1e-12), {0.0, 0.0, -0.2, 0.3, 0.0, 1.0, 0.3, 0.25}));
    // A polygon in the plane of the heading and the up vector is seen with its up to the right.
    const auto upright = outline_of(std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {0, 1, 0.5}}, plain_axes);
    ASSERT_TRUE(upright);
    EXPECT_THAT(upright->numbers, Pointwise(DoubleNear(1e-12), {0.0, 0.0, 0.0, 1.0, 0.5, 1.0}));
    // Where the way ahead stands on the plane, the up vector is upright.
    const auto across = outline_of(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 0, 0.5}}, plain_axes);
    ASSERT_TRUE(across);
    EXPECT_THAT(across->numbers, Pointwise(DoubleNear(1e-12), {0.0, 0.0, 1.0, 0.0, 1.0, 0.5}));
}

TEST(PolygonOutline, NumbersAreTheShapeAlone) {
    const auto outline = outline_of(leaf, plain_axes);
    ASSERT_TRUE(outline);
    std::mt19937_64 random(3);
    const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    for (int i = 0; i < 100; ++i) {
        const Affine turn = Affine::rotate({unit(), unit(), unit()}, 180 * unit());
        const double size = std::pow(10.0, 20 * unit());
        const Vec3 shift = size * Vec3(unit(), unit(), unit());
        std::vector<Vec3> moved;
        for (const Vec3& corner : leaf)
            moved.push_back(turn(size * corner) + shift);
        const auto other = outline_of(moved, turn.linear);
        ASSERT_TRUE(other);
        EXPECT_EQ(other->numbers, outline->numbers);
        for (std::size_t k = 0; k < moved.size(); ++k) {
            const Vec3 corner(other->numbers[2 * k], other->numbers[2 * k + 1], 0);
            EXPECT_LT(glm::distance(other->start_from_outline(corner), moved[k]), 1e-5 * size);
        }
    }
}

TEST(PolygonOutline, LeavesOutWhatIsNoCorner) {
    std::vector<Vec3> corners = {{0, 0, 0}, {0, 0, 0}, {-0.2, 0.3, 0}, {-0.4, 0.6, 0}, {0, 2, 0},
                                 {0, 3, 0}, {0, 2, 0}, {0.6, 0.5, 0},  {0, 0, 0}};
    const auto outline = outline_of(corners, plain_axes);
    ASSERT_TRUE(outline);
    EXPECT_EQ(outline->numbers, outline_of(leaf, plain_axes)->numbers);
}

TEST(PolygonOutline, IsNothingWithoutAPlaneOrAnArea) {
    std::vector<Vec3> bent = leaf;
    bent[1].z = 0.3;
    EXPECT_FALSE(outline_of(bent, plain_axes));
    bent[1].z = 1e-6; // rounding
    EXPECT_TRUE(outline_of(bent, plain_axes));
    EXPECT_FALSE(outline_of(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, plain_axes));
    EXPECT_FALSE(outline_of(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, plain_axes));
    EXPECT_FALSE(outline_of(std::vector<Vec3>(5, Vec3(1, 2, 3)), plain_axes));
    EXPECT_FALSE(outline_of(std::vector<Vec3>{{0, 0, 0}, {INFINITY, 0, 0}, {0, 1, 0}}, plain_axes));
    // The first corner comes again between others.
    EXPECT_FALSE(outline_of(
        std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}, {-1, -1, 0}}, plain_axes));
    std::vector<Vec3> round;
    for (std::size_t i = 0; i <= most_outline_corners; ++i) {
        const double turn = 2 * 3.141592653589793 * double(i) / double(most_outline_corners + 1);
        round.emplace_back(std::cos(turn), std::sin(turn), 0);
    }
    EXPECT_FALSE(outline_of(round, plain_axes));
}

/// The polygons and triangles of a drawn model.
struct Drawn {
    explicit Drawn(const std::string& statements, const std::string& material = "texture: \"leaf.png\"",
                   unsigned steps = 2) {
        LowerOptions options;
        options.steps = steps;
        MemoryFiles files;
        files.set("leaf.png", "");
        LowerHelp help;
        help.files = &files;
        const LoweredText lowered = lower_text(
            "m.lsys", "material m { " + material + " }\nlsys m {\n colors m\n" + statements + "\n}\n",
            options, sources, diagnostics, help);
        if (!lowered.graph) throw std::runtime_error(diagnostics.render(sources));
        unfold(*lowered.graph, lowered.graph->root, Affine());
    }

    void unfold(const Graph& graph, ObjectId id, const Affine& place) {
        const Object& object = graph.objects[id];
        if (object.primitive == PrimitiveKind::triangle) ++triangles;
        if (object.primitive == PrimitiveKind::polygon) {
            names.push_back(name_of(*object.primitive));
            places.push_back(place);
        }
        for (const Instance& instance : object.instances)
            unfold(graph, instance.master, place * instance.parent_from_child);
    }

    SourceMap sources;
    Diagnostics diagnostics;
    std::vector<std::string> names;
    std::vector<Affine> places;
    std::size_t triangles = 0;
};

TEST(PicturedPolygons, AreOnePolygonEach) {
    const std::string word = "{.+(30)f-(60)f(2)-(120)f(2)}";
    const Drawn drawn("axiom " + word + "f(5)/(40)&(20)" + word);
    ASSERT_EQ(drawn.names.size(), 2u) << drawn.diagnostics.render(drawn.sources);
    EXPECT_EQ(drawn.triangles, 0u);
    EXPECT_EQ(drawn.names[0], drawn.names[1]);
    EXPECT_TRUE(drawn.diagnostics.all().empty());
    const Drawn plain("axiom " + word, "color: 0, 1, 0");
    EXPECT_EQ(plain.names.size(), 0u);
    EXPECT_EQ(plain.triangles, 2u);
}

// The axes are those where it begins, in whatever parts the word is composed.
TEST(PicturedPolygons, AreTheSameWhereverTheyBeginAndEnd) {
    const Drawn whole("axiom f(3)+(25){.+(30)f-(60)f(2)-(120)f(2)}");
    ASSERT_EQ(whole.names.size(), 1u);
    for (const char* const parts : {"axiom f(3)+(25)A-(60)f(2)-(120)f(2)}\n A -> {.+(30)f",
                                    "axiom f(3)+(25){.+(30)A-(120)f(2)}\n A -> f-(60)f(2)",
                                    "axiom f(3)+(25){.+(30)f-(60)A\n A -> f(2)-(120)f(2)}",
                                    "axiom A-(60)f(2)B\n A -> f(3)+(25){.+(30)f\n B -> -(120)f(2)}"}) {
        const Drawn drawn(parts);
        ASSERT_EQ(drawn.names.size(), 1u) << parts;
        EXPECT_EQ(drawn.names[0], whole.names[0]) << parts;
        EXPECT_LT(largest_entry(drawn.places[0].linear - whole.places[0].linear), 1e-9) << parts;
        EXPECT_LT(largest_entry(drawn.places[0].translation - whole.places[0].translation), 1e-9) << parts;
    }
}

TEST(PicturedPolygons, ThatCannotBeCoveredOnceAreTrianglesWithOneWarning) {
    for (const char* const statements :
         {"axiom {.f&(50)f+(90)f+(90)f}f{.f&(50)f+(90)f+(90)f}",                              // bent
          "axiom {.f+(135)f(1.5)+(135)f+(135)f(1.5)}f{.f+(135)f(1.5)+(135)f+(135)f(1.5)}"}) { // crossed
        const Drawn drawn(statements);
        EXPECT_EQ(drawn.names.size(), 0u) << statements;
        EXPECT_GT(drawn.triangles, 2u) << statements;
        ASSERT_EQ(drawn.diagnostics.all().size(), 1u) << statements;
        EXPECT_THAT(drawn.diagnostics.render(drawn.sources), HasSubstr("each triangle of this polygon"));
    }
}

} // namespace
} // namespace graftal::testing
