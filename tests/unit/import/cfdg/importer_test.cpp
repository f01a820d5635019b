#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <gmock/gmock.h>

#include "compiler/primitives/polygon_rings.h"
#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

std::size_t shapes(const std::string& text, std::optional<unsigned> steps = {}) {
    const ImportedShapes model("a.cfdg", text);
    EXPECT_TRUE(model.graph) << model.said() << model.translation;
    return model.leaves(steps).size();
}

TEST(ContextFree, ReadsBothVersions) {
    EXPECT_EQ(shapes("startshape A\nrule A { SQUARE { x 1 } 3* { y 2 } CIRCLE { s 0.5 } }"), 4u);
    EXPECT_EQ(shapes("startshape A\nshape A { SQUARE [x 1] loop 3 [y 2] CIRCLE [s 0.5] }"), 4u);
    EXPECT_EQ(shapes("startshape A(2)\nshape A(number n) { loop (n) [y 2] CIRCLE [] if (n > 1) SQUARE [] "
                     "else A(n)[] }"),
              3u);
    EXPECT_EQ(shapes("startshape A\nbackground { b -0.1; h 220; sat 0.7 }\nrule A { SQUARE { x 1; s 2; } }"),
              1u);
    EXPECT_EQ(shapes("startshape A\nshape A { loop 2 [x 1] SQUARE [[x 1 s 2]] }"), 2u);
}

/// The scale 0.5^1000 is smaller than any that the language takes.
TEST(ContextFree, TurnsThatShrinkToNothingAreLeftOut) {
    const std::size_t seen = shapes("startshape A\nshape A { loop 1000 [x 1 s 0.5] B [] }\n"
                                    "shape B { SQUARE [] CIRCLE [x 5] }");
    EXPECT_GT(seen, 60u);
    EXPECT_LT(seen, 90u);
    EXPECT_EQ(shapes("startshape A\nshape A { SQUARE [] SQUARE [x 2 s 1 1e-14] SQUARE [x 4 s 1e7 1e-3] }"),
              2u);
}

TEST(ContextFree, GrammarsThatGrowWithoutEndAreRefusedOnce) {
    const ImportedShapes model("a.cfdg", "startshape A\nrule A { B {} A { s 25 r 85 y 6 } A { s 25 y 6 } }\n"
                                         "rule B { CIRCLE {} B { s 0.95 y 0.3 } }");
    EXPECT_EQ(model.said().find("error:"), model.said().rfind("error:")) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("grows beyond all bounds"));
}

TEST(ContextFree, MovesBeforeItTurnsAndScales) {
    const auto place = [](const std::string& adjustments) {
        const ImportedShapes model("a.cfdg", "startshape A\nshape A { SQUARE " + adjustments + " }");
        EXPECT_TRUE(model.graph) << model.said();
        return model.leaves().at(0).world_from_object;
    };
    EXPECT_NEAR(place("[r 90 x 2 s 0.5]").translation.x, 2, 1e-12);
    EXPECT_NEAR(place("[[r 90 x 2 s 0.5]]").translation.y, 2, 1e-12);
    EXPECT_NEAR(place("[s 3 2]").linear[1].y, 2, 1e-12);
    EXPECT_NEAR(place("[f 0]").linear[1].y, -1, 1e-12);
    EXPECT_NEAR(place("[skew 45 0]").linear[1].x, 1, 1e-9);
}

TEST(ContextFree, WhatSmallerShapesDrawLiesInFront) {
    const auto heights = [](const std::string& text) {
        const ImportedShapes model("a.cfdg", text);
        EXPECT_TRUE(model.graph) << model.said();
        std::vector<double> all;
        for (const UnfoldedLeaf& leaf : model.leaves())
            all.push_back(leaf.world_from_object.translation.z);
        return all;
    };
    // The size of the shape counts, not that of the primitive; in a shape, what comes later.
    const std::vector<double> nested =
        heights("startshape A\nshape A { SQUARE [s 0.5] B [s 0.8] C [s 0.9] }\n"
                "shape B { SQUARE [s 0.1] SQUARE [] } shape C { SQUARE [s 0.2] }");
    ASSERT_EQ(nested.size(), 4u); // of A, of B twice, of C
    EXPECT_LT(nested[0], nested[3]);
    EXPECT_LT(nested[3], nested[1]);
    EXPECT_LT(nested[1], nested[2]);
}

TEST(ContextFree, ColoursGoTheirShareOfTheWay) {
    const auto colour = [](const std::string& adjustments) {
        const ImportedShapes model("a.cfdg", "startshape A\nshape A { SQUARE " + adjustments + " }");
        EXPECT_TRUE(model.graph) << model.said();
        return model.leaves().at(0).tint.over(Rgb(0.5));
    };
    EXPECT_EQ(colour("[]"), Rgb(0));
    EXPECT_EQ(colour("[b 1]"), Rgb(1));
    EXPECT_NEAR(colour("[b 0.5]").r, 0.2140, 1e-4);
    EXPECT_EQ(colour("[hue 120 sat 1 b 1]"), Rgb(0, 1, 0));
    EXPECT_NEAR(colour("[b 1 0.5]").r, 0.2140, 1e-4);
}

TEST(ContextFree, RecursionThatShrinksHasNoEnd) {
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { CIRCLE [] A [x 1 s 0.5 b 0.1] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("    instance: A  scale: 0.5  translate: 1, 0, "));
    EXPECT_EQ(model.leaves(4).size(), 4u);
    EXPECT_EQ(model.leaves(100).size(), 100u);
    const ImportedShapes endless("a.cfdg",
                                 "startshape A\nCF::Size = [s 2000]\nshape A { CIRCLE [] A [x 1] }");
    EXPECT_THAT(endless.said(), HasSubstr("warning: 'A' calls itself without becoming smaller"));
    EXPECT_GT(endless.leaves().size(), 50'000u);
}

// A chaos game takes what room the others leave: a shape of many sizes, and a second game.
TEST(ContextFree, GamesWithoutEndLeaveRoomForOthers) {
    const ImportedShapes model("a.cfdg", "startshape S\nshape S { A [x 1] B [x -1] T [y 3] }\n"
                                         "shape A { CIRCLE [s 0.01] A [r 77 x 0.01] }\n"
                                         "shape B { TRIANGLE [s 0.01] B [r 99 x 0.01] }\n"
                                         "shape T { SQUARE [] T [s 0.9 y 1.2 b 0.01] }\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("warning: 'A' calls itself without becoming smaller"));
    const auto drawn = [&](const std::string& primitive) {
        std::size_t lines = 0;
        for (std::size_t at = 0; (at = model.translation.find(primitive, at)) != std::string::npos; ++at)
            ++lines;
        return lines;
    };
    EXPECT_GT(drawn("instance: CIRCLE"), 29'000u);
    EXPECT_GT(drawn("instance: TRIANGLE"), 29'000u);
    EXPECT_GT(drawn("instance: SQUARE"), 30u);
}

TEST(ContextFree, GamesThatGrowEndBeforeTheirNumbersDo) {
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { CIRCLE [s 0.1] A [r 10 x 1 s 1.01] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_GT(model.leaves().size(), 2000u);
    EXPECT_LT(model.leaves().size(), 4000u);
}

/// The number of objects in a translation.
std::size_t objects_in(const ImportedShapes& model) {
    std::size_t objects = 0;
    for (std::size_t at = 0; (at = model.translation.find("canonical object", at)) != std::string::npos; ++at)
        ++objects;
    return objects;
}

TEST(ContextFree, RecursionWithoutEndMayHaveValuesAndChance) {
    // Vectors, constant arguments, and a shape that expressions name.
    const ImportedShapes values("a.cfdg",
                                "startshape A(2, B)\nv = 1, 2\nshape A(number n, shape what) "
                                "{ what [x v] A(n, what) [s 0.5 x (v[1])] }\nshape B { SQUARE [] }");
    ASSERT_TRUE(values.graph) << values.said();
    EXPECT_EQ(values.leaves(60).size(), 60u);
    // Each of 64 variants calls one of them.
    const ImportedShapes chance("a.cfdg", "startshape A\nrule A { SQUARE { } A { s 0.5 r 10 } }\n"
                                          "rule A { CIRCLE { } A { s 0.6 x 1 } }");
    ASSERT_TRUE(chance.graph) << chance.said();
    EXPECT_EQ(objects_in(chance), 64u + 2);
    EXPECT_EQ(chance.leaves(200).size(), 200u);
    // Arguments that change make shapes for ever, which end where they are too small.
    const ImportedShapes counted("a.cfdg", "startshape A(0)\nCF::Size = [s 1]\n"
                                           "shape A(number n) { SQUARE [r n] A(n + 1) [s 0.5] }");
    ASSERT_TRUE(counted.graph) << counted.said();
    EXPECT_EQ(counted.leaves().size(), 11u) << "0.5^n of at least 0.3 pixels of 500";
    // A name of a rule hides that of the file.
    const ImportedShapes hidden("a.cfdg", "startshape A(1.5)\nCF::Size = [s 9]\nbig = 0.5\n"
                                          "shape A(number big) { SQUARE [] if (big > 1) A(0.9) [s big] }");
    ASSERT_TRUE(hidden.graph) << hidden.said();
    EXPECT_EQ(hidden.leaves().size(), 2u);
}

// Found by a random grammar of 10^22 veils: it had an object for each size, and its picture was black.
TEST(ContextFree, MoreVeilsThanHeightsTellApartHaveNoEnd) {
    const auto veils = [](const std::string& turns) {
        return ImportedShapes("a.cfdg", "startshape A\nshape A { SQUARE [a -0.5] loop " + turns +
                                            " [r 1 y -1] A [s 0.84819] }");
    };
    EXPECT_EQ(objects_in(veils("3")), 2u) << "A and the square";
    EXPECT_EQ(veils("3").leaves(2).size(), 1u + 3);
    // Few veils lie in their order, down to the size of a pixel.
    EXPECT_LT(veils("1").leaves(500).size(), 60u);
}

TEST(ContextFree, TurnsThatDrawTheSameAreParts) {
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { loop 301 [x 1] loop 300 [y 1] SQUARE [] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_LE(objects_in(model), 2u + 9 + 9);
    const std::vector<UnfoldedLeaf> leaves = model.leaves();
    ASSERT_EQ(leaves.size(), 301u * 300);
    Vec3 last(0.0);
    for (const UnfoldedLeaf& leaf : leaves)
        last = glm::max(last, leaf.world_from_object.translation);
    EXPECT_NEAR(last.x, 300, 1e-9);
    EXPECT_NEAR(last.y, 299, 1e-9);
    // More than can be written one by one.
    EXPECT_TRUE(
        ImportedShapes("a.cfdg", "startshape A\nshape A { loop 100000 [x 1] loop 100000 [y 1] SQUARE [] }")
            .graph);
    // Turns one by one draw the same: those whose index is read.
    const auto drawn = [](const std::string& rule) {
        const ImportedShapes one("a.cfdg", "startshape A\nCF::Size = [s 9]\nshape A { " + rule +
                                               " }\nshape B { TRIANGLE [b 0.5] SQUARE [s 0.1] }");
        EXPECT_TRUE(one.graph) << one.said();
        std::multimap<double, UnfoldedLeaf> by_height;
        for (const UnfoldedLeaf& leaf : one.leaves())
            by_height.emplace(leaf.world_from_object.translation.z, leaf);
        return by_height;
    };
    const std::string rest = " [r 10 x 0.1 b 0.01 hue 3] { SQUARE [b 0.1 x 1] B [s 0.5] SQUARE [s 0.2";
    const std::string end = "] } finally CIRCLE [x 2] SQUARE [b 1]";
    const std::multimap<double, UnfoldedLeaf> parts = drawn("loop i = 45" + rest + end);
    const std::multimap<double, UnfoldedLeaf> turns = drawn("loop i = 45" + rest + " x (0*i)" + end);
    ASSERT_EQ(parts.size(), 45u * 4 + 2);
    ASSERT_EQ(turns.size(), parts.size());
    for (auto part = parts.begin(), turn = turns.begin(); part != parts.end(); ++part, ++turn) {
        const Affine &a = part->second.world_from_object, &b = turn->second.world_from_object;
        EXPECT_NEAR(a.translation.x, b.translation.x, 1e-9) << "height " << part->first;
        EXPECT_NEAR(a.translation.y, b.translation.y, 1e-9);
        EXPECT_NEAR(a.linear[0].x, b.linear[0].x, 1e-9);
        EXPECT_NEAR(part->second.tint.over(Rgb(0.5)).g, turn->second.tint.over(Rgb(0.5)).g, 1e-6);
    }
}

// Found by a shape whose first place was too small to be seen: nothing drew it elsewhere.
TEST(ContextFree, AShapeIsDrawnWhereItIsLarge) {
    EXPECT_EQ(
        shapes("startshape A\nCF::Size = [s 4]\nshape A { B [s 0.00001] B [x 1] }\nshape B { SQUARE [] }"),
        2u);
}

TEST(ContextFree, LoopsKnowTheirIndex) {
    const ImportedShapes model(
        "a.cfdg", "startshape A\nshape A { loop i = 4 [x (i)] { SQUARE [s (i + 1)] } finally CIRCLE [] }");
    ASSERT_TRUE(model.graph) << model.said();
    const std::vector<UnfoldedLeaf> leaves = model.leaves();
    ASSERT_EQ(leaves.size(), 5u);
    EXPECT_NEAR(leaves[3].world_from_object.linear[0].x, 4, 1e-9);
    EXPECT_NEAR(leaves[3].world_from_object.translation.x, 3, 1e-9);
    EXPECT_NEAR(leaves[4].world_from_object.translation.x, 6, 1e-9);
}

TEST(ContextFree, PathsBecomePolygons) {
    const ImportedShapes model(
        "a.cfdg",
        "startshape P\npath P { MOVETO(0,0) LINETO(2,0) ARCTO(0,2,2) CLOSEPOLY() FILL[b 1] STROKE(0.2)[] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("instance: polygon(0, 0, 2, 0, "));
    EXPECT_EQ(model.leaves().size(), 2u);
}

/// Where the corners of a polygon lie in the picture.
std::vector<Vec3> corners_of(const UnfoldedLeaf& leaf) {
    const PolygonRings& rings = rings_of(*leaf.primitive);
    std::vector<Vec3> corners;
    for (const PlanePoint& corner : rings.corners)
        corners.push_back(leaf.world_from_object(Vec3(corner[0], corner[1], 0)));
    return corners;
}

// Found beside Context Free's pictures: parts of a path lay as high as the shape in front of it.
TEST(ContextFree, APathLiesBelowWhatFollowsIt) {
    const std::string square = "MOVETO(0, 0) LINETO(1, 0) LINETO(1, 1) CLOSEPOLY() FILL()[] ";
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { B [] SQUARE [] }\npath B { " + square +
                                             square + square + "}");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<double> heights;
    for (const UnfoldedLeaf& leaf : model.leaves())
        heights.push_back(leaf.world_from_object.translation.z);
    ASSERT_EQ(heights.size(), 4u);
    std::ranges::sort(heights);
    EXPECT_LT(heights[0], heights[2]);
    EXPECT_LT(heights[2], heights[3]);
}

TEST(ContextFree, VeilsLieFarEnoughApartToBeSeenThrough) {
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { SQUARE [a -0.5] CIRCLE [] B [] }\n"
                                         "shape B { loop 50 [] SQUARE [a -0.5] }");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<double> heights;
    for (const UnfoldedLeaf& leaf : model.leaves())
        heights.push_back(leaf.world_from_object.translation.z);
    ASSERT_EQ(heights.size(), 52u);
    for (std::size_t i = 1; i < heights.size(); ++i)
        EXPECT_GE(heights[i] - heights[i - 1], 0.99e-5) << "for rays that come through the one before";
}

TEST(ContextFree, AlphaCoversByAShare) {
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { SQUARE [a -0.5 sat 1 b 1] }");
    ASSERT_TRUE(model.graph) << model.said();
    const auto veil = std::ranges::find_if(model.graph->materials, &Material::is_veil);
    ASSERT_NE(veil, model.graph->materials.end());
    EXPECT_NEAR(veil->transparency, 0.5, 1e-9);
}

TEST(ContextFree, VariablesAndFunctions) {
    EXPECT_EQ(shapes("startshape A\nn = 3\ntwice(number k) = 2*k\nshape A { m = n - 1 loop (twice(m)) [x 1] "
                     "SQUARE [] }"),
              4u);
    EXPECT_EQ(shapes("startshape A\nshape A { k = rand(1, 2) SQUARE [s (k)] SQUARE [x (k)] }"), 2u);
    EXPECT_EQ(shapes("startshape A\nv = 4, 5\nshape A { switch (v[1]) { case 4: SQUARE [] case 5: { CIRCLE "
                     "[] CIRCLE [] } else: A [] } }"),
              2u);
    EXPECT_EQ(shapes("startshape A\nmove = [x 1 s 0.5]\nshape A { transform [y 1], [y 2] { SQUARE [trans "
                     "move] CIRCLE [] } }"),
              4u);
}

TEST(ContextFree, SceneStatements) {
    const ImportedShapes model(
        "a.cfdg", "startshape A [hue 240 sat 1 b 1]\nCF::Background = [b -1]\nCF::Size = [s 10 5 x 2]\n"
                  "CF::Symmetry = CF::Cyclic, 5\nshape A { SQUARE [x 3] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("background: 0, 0, 0\n"));
    EXPECT_THAT(
        model.translation,
        HasSubstr("camera { orthographic  location: -2,0,10  look_at: -2,0,0  width: 10  height: 5 }"));
    EXPECT_EQ(model.leaves().size(), 5u);
}

TEST(ContextFree, StrokesAreOutlines) {
    const auto drawn = [](const std::string& path) {
        const ImportedShapes model("a.cfdg", "startshape P\npath P { " + path + " }");
        EXPECT_TRUE(model.graph) << model.said() << model.translation;
        return model.translation;
    };
    EXPECT_THAT(drawn("MOVETO(0,0) LINETO(4,0) STROKE(2)[]"),
                HasSubstr("polygon(0, 1, 4, 1, 4, -1, 0, -1, 0, 1)"));
    EXPECT_THAT(drawn("MOVETO(0,0) LINETO(4,0) STROKE(2, CF::SquareCap)[]"),
                HasSubstr("polygon(-1, 1, 5, 1, 5, -1, -1, -1, -1, 1)"));
    // A miter at the corner, of both banks.
    EXPECT_THAT(drawn("MOVETO(0,0) LINETO(4,0) LINETO(4,4) STROKE(2)[]"),
                HasSubstr("polygon(0, 1, 3, 1, 3, 4, 5, 4, 5, -1, 0, -1, 0, 1)"));
    EXPECT_THAT(drawn("MOVETO(0,0) LINETO(4,0) LINETO(4,4) STROKE(2, CF::BevelJoin)[]"),
                HasSubstr("5, 4, 5, 0, 4, -1, 0, -1"));
}

/// The area that the polygons of a path cover.
double area_of(const std::string& path) {
    const ImportedShapes model("a.cfdg", "startshape P\npath P { " + path + " }");
    EXPECT_TRUE(model.graph) << model.said() << model.translation;
    double sum = 0;
    std::size_t at = 0;
    while ((at = model.translation.find("polygon(", at)) != std::string::npos) {
        std::vector<double> n;
        for (at += 8; model.translation[at - 1] != ')'; ++at) {
            std::size_t read = 0;
            n.push_back(std::stod(model.translation.substr(at), &read));
            at += read;
        }
        double area = 0; // a ring that ends in its first corner leads on to the next by a way of no area
        for (std::size_t i = 0; i + 3 < n.size(); i += 2)
            area += n[i] * n[i + 3] - n[i + 2] * n[i + 1];
        sum += std::abs(area + n[n.size() - 2] * n[1] - n[0] * n[n.size() - 1]) / 2;
    }
    return sum;
}

TEST(ContextFree, PathsMayCrossThemselves) {
    // A square of 4, and one of 2 within it that turns the same way, or the other.
    const std::string outer = "MOVETO(0,0) LINETO(4,0) LINETO(4,4) LINETO(0,4) CLOSEPOLY() ";
    const std::string same = "MOVETO(1,1) LINETO(3,1) LINETO(3,3) LINETO(1,3) CLOSEPOLY() ";
    const std::string other = "MOVETO(1,1) LINETO(1,3) LINETO(3,3) LINETO(3,1) CLOSEPOLY() ";
    EXPECT_NEAR(area_of(outer + same + "FILL[]"), 16, 1e-4);
    EXPECT_NEAR(area_of(outer + other + "FILL(CF::EvenOdd)[]"), 12, 1e-4);
    EXPECT_NEAR(area_of(outer + other + "FILL[]"), 12, 1e-4);
    // Two squares that overlap by one of 1.
    const std::string crossing = "MOVETO(3,3) LINETO(6,3) LINETO(6,6) LINETO(3,6) CLOSEPOLY() ";
    EXPECT_NEAR(area_of(outer + crossing + "FILL[]"), 16 + 9 - 1, 1e-4);
    EXPECT_NEAR(area_of(outer + crossing + "FILL(CF::EvenOdd)[]"), 16 + 9 - 2, 1e-4);
    // A bow tie: windings of 1 and -1.
    EXPECT_NEAR(area_of("MOVETO(0,0) LINETO(2,2) LINETO(2,0) LINETO(0,2) CLOSEPOLY() FILL[]"), 2, 1e-4);
    // A stroke that crosses its own way counts it once.
    EXPECT_NEAR(area_of("MOVETO(0,2) LINETO(4,2) MOVETO(2,0) LINETO(2,4) STROKE(1)[]"), 7, 1e-4);
}

TEST(ContextFree, VectorsAdjustmentsAndShapesAreValues) {
    EXPECT_EQ(shapes("startshape A([x 1 s 0.5], B(3))\nshape A(adjustment go, shape what) { what [trans go] "
                     "what [] }\n"
                     "shape B(n) { loop n [x 1] SQUARE [] }"),
              6u);
    EXPECT_EQ(shapes("startshape A((1, 2))\nvector2 twice(vector2 v) = 2*v\nshape A(vector2 v) "
                     "{ loop (v[0] + v[1]) [x twice(v)] SQUARE [] }"),
              3u);
    EXPECT_EQ(shapes("startshape A\nshape one(n) = if(n > 1, B, C)\nshape A { if(1, B, C) [] one(1) [] }\n"
                     "shape B { SQUARE [] SQUARE [x 1] } shape C { CIRCLE [] }"),
              3u);
    EXPECT_EQ(
        shapes(
            "startshape A\nshape A { loop i = 60 [] if (mod(div(5429325329025438, 2^i), 2)) SQUARE [x i] }"),
        29u); // bits of a number of 53
    EXPECT_EQ(shapes("startshape A\nack(m, n) = if(m == 0, n + 1, if(n == 0, ack(m - 1, 1), "
                     "ack(m - 1, ack(m, n - 1))))\nshape A { loop (ack(2, 2)) [x 1] SQUARE [] }"),
              7u);
    EXPECT_EQ(shapes("startshape A\nshape A { switch (5) { case 1..3: SQUARE [] case 4..6: { CIRCLE [] "
                     "CIRCLE [] } } transform CF::Dihedral, 3 SQUARE [x 1] let(n = 2; B(n)) [] }\n"
                     "shape B(n) { loop n [] CIRCLE [] }"),
              2u + 6u + 2u);
}

TEST(ContextFree, ParametersOfPaths) {
    const ImportedShapes model(
        "a.cfdg", "startshape A\nshape A { P(3) [] P(4) [x 3] }\npath P(natural n) { MOVETO(1, 0) "
                  "loop i = 1, n [] LINETO(cos(360*i/n), sin(360*i/n)) CLOSEPOLY() FILL[] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.leaves().size(), 2u);
    EXPECT_EQ(corners_of(model.leaves()[0]).size(), 3u);
    EXPECT_EQ(corners_of(model.leaves()[1]).size(), 4u);
    // Loops of operations alone move them; elsewhere, what is drawn.
    EXPECT_NEAR(area_of("MOVETO(0,0) loop 3 [r 90] LINETO(1,0) CLOSEPOLY() FILL[]"), 1, 1e-4);
}

// Found by grammars whose picture no seed changed.
TEST(ContextFree, ASeedDrawsAnotherVariation) {
    const auto places = [](const std::string& grammar, std::uint64_t seed) {
        const ImportedShapes model("a.cfdg", "startshape A\n" + grammar, seed);
        EXPECT_TRUE(model.graph) << model.said();
        std::vector<double> all;
        for (const UnfoldedLeaf& leaf : model.leaves())
            all.push_back(leaf.world_from_object.translation.x);
        return all;
    };
    const std::string spread = "shape A { SQUARE [x (rand(1))] }";
    for (const std::string& grammar : {spread, std::string("k = rand(1)\nshape A { SQUARE [x k] }"),
                                       std::string("shape A { SQUARE [x (rand_static(1))] }")}) {
        const double usual = places(grammar, 0).at(0), seventh = places(grammar, 7).at(0);
        EXPECT_GT(std::abs(usual - seventh), 1e-3) << grammar;
        EXPECT_EQ(places(grammar, 7).at(0), seventh) << grammar;
        EXPECT_EQ(ImportedShapes("a.cfdg", "startshape A\n" + grammar)
                      .leaves()
                      .at(0)
                      .world_from_object.translation.x,
                  usual);
    }
    // Numbers of many seeds are spread evenly, and rules are chosen by their weights.
    double sum = 0;
    std::size_t pairs = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        sum += places(spread, seed).at(0);
        pairs += places("rule A { SQUARE { } }\nrule A 3 { SQUARE { } SQUARE { } }", seed).size() - 1;
    }
    EXPECT_NEAR(sum / 400, 0.5, 0.05);
    EXPECT_NEAR(static_cast<double>(pairs) / 400, 0.75, 0.07);
}

TEST(ContextFree, ChanceDecidesOnceForEachVariant) {
    const std::string text = "startshape A\nshape A { loop i = 40 [x 1] B [] }\n"
                             "shape B { if (rand(2) > 1) SQUARE [] else { CIRCLE [] CIRCLE [] } }";
    const std::size_t drawn = shapes(text);
    EXPECT_GT(drawn, 45u); // neither always one nor always two
    EXPECT_LT(drawn, 75u);
    EXPECT_EQ(shapes(text), drawn);
    EXPECT_EQ(shapes("startshape A\nshape A { loop (randint::poisson(4)) [x 1] SQUARE [] }"),
              shapes("startshape A\nshape A { loop (randint::poisson(4)) [x 1] SQUARE [] }"));
}

TEST(ContextFree, ChanceThatDrawsNothingIsAskedAgain) {
    EXPECT_EQ(shapes("startshape A\nv = 1, 2\nshape A rule 9 { } rule { SQUARE [x v] }"), 1u);
}

TEST(ContextFree, ColoursGoToTheirTargets) {
    const auto colour = [](const std::string& adjustments) {
        const ImportedShapes model("a.cfdg",
                                   "startshape A [" + adjustments +
                                       "]\nshape A { B [h 0.5| sat 1| b 0.5|] } shape B { SQUARE [] }");
        EXPECT_TRUE(model.graph) << model.said() << model.translation;
        return model.leaves().at(0).tint.over(Rgb(0.5));
    };
    EXPECT_EQ(colour("|b 1 |sat 1 |h 240 b 1"), Rgb(0, 1, 0));      // half of the way from red to blue
    EXPECT_EQ(colour("|b 1 |sat 1 |h 60 h 300 b 1"), Rgb(1, 0, 0)); // a hue grows on its way
    EXPECT_NEAR(colour("|b 1").r, 0.2140, 1e-4);
}

TEST(ContextFree, SlowRecursionThatBranchesEndsAsInContextFree) {
    // Sizes 0.99^i 0.5^j of at least 0.3 of 500 pixels: 738 of j = 0, 69 fewer of each that follows.
    const ImportedShapes model("a.cfdg",
                               "startshape A\nCF::Size = [s 1]\nshape A { SQUARE [] A [s 0.99] A [s 0.5] }");
    ASSERT_TRUE(model.graph) << model.said();
    std::size_t objects = 0;
    // Each object draws one square, as do those that only one line would draw, and which are written in it.
    for (std::size_t at = 0; (at = model.translation.find("instance: SQUARE", at)) != std::string::npos; ++at)
        ++objects;
    EXPECT_NEAR(static_cast<double>(objects), 4320, 60);
}

TEST(ContextFree, PathsAreDrawnWhateverTheirScale) {
    EXPECT_EQ(shapes("startshape A\nCF::Size = [s 4]\nv = 0, 0\nshape A { P [s 0.001 x v] }\n"
                     "path P { MOVETO(0, 0) LINETO(1000, 0) LINETO(0, 1000) CLOSEPOLY() FILL[] }"),
              1u);
}

TEST(ContextFree, FillCoversTheCanvas) {
    const ImportedShapes model("a.cfdg", "startshape A\nshape A { FILL [b 0.5] SQUARE [s 2 4] }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.leaves().size(), 2u);
    EXPECT_GT(model.leaves().at(0).world_from_object.linear[0].x, 1000);
    EXPECT_THAT(model.translation, HasSubstr("look_at: 0,0,0  width: 2.2  height: 4.4 }"));
}

TEST(ContextFree, NameSpaces) {
    SourceMap sources;
    Diagnostics diagnostics;
    const FileId part = sources.add(
        "part.cfdg",
        "startshape EITHER\nside = 2\ntwice(n) = 2*n\nshape EITHER { loop (twice(side)) [x 1] ONE [] "
        "}\nshape ONE { SQUARE [] }");
    const FileId file =
        sources.add("a.cfdg", "startshape A\nimport @one part.cfdg\nshape ONE { CIRCLE [] CIRCLE [] "
                              "}\nshape A { one::EITHER [] ONE [] loop (one::twice(1)) [] ONE [] }");
    const ForeignFile foreign{file, sources, diagnostics,
                              [&](std::string_view) -> std::optional<FileId> { return part; }};
    const Importer* const importer = importer_of(foreign);
    ASSERT_TRUE(importer);
    const std::optional<Translation> translation =
        importer->translate(foreign, importer->models(foreign).front());
    ASSERT_TRUE(translation) << diagnostics.render(sources);
    const ImportedShapes model("m.inst", "");
    const auto count = [&](std::string_view word) {
        std::size_t found = 0;
        for (std::size_t at = 0; (at = translation->text.find(word, at)) != std::string::npos; ++at)
            ++found;
        return found;
    };
    EXPECT_EQ(count("instance: one__ONE"), 4u) << translation->text;
    EXPECT_EQ(count("instance: ONE"), 3u);
    EXPECT_EQ(count("instance: CIRCLE"), 2u);
}

TEST(ContextFree, SymmetriesAndTiles) {
    const auto count = [](const std::string& settings) {
        return shapes("startshape A\n" + settings + "\nshape A { SQUARE [x 0.1 y 0.2] }");
    };
    EXPECT_EQ(count("CF::Symmetry = CF::Dihedral, 3, 30"), 6u);
    EXPECT_EQ(count("CF::Symmetry = CF::Cyclic, 4, 1, 1, [x 5]"), 5u);
    EXPECT_EQ(count("CF::Tile = [s 2]"), 25u);
    EXPECT_EQ(count("CF::Tile = [s 2 0]"), 5u);
    EXPECT_EQ(count("CF::Tile = [s 2 0]\nCF::Symmetry = CF::p2mg"), 5u * 4);
    const std::vector<std::pair<std::string, std::size_t>> groups = {
        {"pm, 0", 2}, {"pg, 1", 2}, {"pmm", 4}, {"pmg, 0", 4}, {"pgg", 4},
        {"cm, 2", 2}, {"cmm", 4},   {"p4", 4},  {"p4m", 8},    {"p4g", 8}};
    for (const auto& [group, order] : groups)
        EXPECT_EQ(count("CF::Tile = [s 2]\nCF::Symmetry = CF::" + group), 25 * order) << group;
    for (const auto& [group, order] : std::vector<std::pair<std::string, std::size_t>>{
             {"p3", 3}, {"p3m1", 6}, {"p31m", 6}, {"p6", 6}, {"p6m", 12}})
        EXPECT_EQ(count("CF::Tile = [skew (atan(0.5)) 0 s 1 (sqrt(3)/2)]\nCF::Symmetry = CF::" + group),
                  25 * order)
            << group;
}

/// Names are found by a map, and nothing recurs once for each shape.
TEST(ContextFree, AChainOfManyShapes) {
    std::string text = "startshape S0\n";
    for (int i = 0; i < 30'000; ++i)
        text += "shape S" + std::to_string(i) + " { S" + std::to_string(i + 1) + " [s 0.5] }\n";
    text += "shape S30000 { SQUARE [] }";
    const ImportedShapes model("a.cfdg", text);
    EXPECT_TRUE(model.graph) << model.said().substr(0, 1000);
}

// However often a function calls itself, and whatever is left to do where that ends.
TEST(ContextFree, FunctionsThatCallThemselvesEnd) {
    for (const char* body : {"f(n) + f(n)", "f(n) + f(n) + f(n) + f(n)", "-f(n)", "f(f(n))",
                             "min(f(n), f(n))", "if(n, f(n), f(n))"}) {
        const ImportedShapes model("a.cfdg", std::string("startshape A\nf(number n) = ") + body +
                                                 "\nshape A { SQUARE [x (f(1))] SQUARE [x (f(2) + f(3))] }");
        EXPECT_TRUE(model.diagnostics.has_errors()) << body;
        EXPECT_LT(model.diagnostics.error_count(), 100u) << body;
    }
}

TEST(ContextFree, WhatHasNoCounterpartIsNamed) {
    const auto said = [](const std::string& text) { return ImportedShapes("a.cfdg", text).said(); };
    EXPECT_THAT(said("startshape A [|b 0.5]\nrule A { SQUARE { b -0.1| } }"),
                HasSubstr("a.cfdg:2:10: error: this changes a colour away from another"));
    EXPECT_THAT(said("startshape A\nshape A { SQUARE [blend CF::Multiply] }"),
                HasSubstr("'blend CF::Multiply' is not translated"));
    EXPECT_THAT(said("startshape A\nshape A { loop i = 2000 [] loop j = 2000 [] SQUARE [x i y j] }"),
                HasSubstr("a.cfdg:2:28: error: the loops of this grammar turn more than 2000000 times"));
    // Found by chance: it took 20 s, and 2 GiB, to write what each turn adds to those before.
    const std::string reddening = "startshape A\nv = 1, 2\nshape A { loop 20000 [x v hue 0.1|] SQUARE [] }";
    EXPECT_THAT(
        said(reddening),
        HasSubstr("a.cfdg:3:37: error: the loops of this grammar change colours more than 4000000 times"));
    EXPECT_EQ(shapes("startshape A\nv = 1, 2\nshape A { loop 2000 [x v hue 0.1|] SQUARE [] }"), 2000u);
    EXPECT_THAT(said("startshape FILL"), HasSubstr("'FILL' is no shape to start from"));
    EXPECT_THAT(said("startshape A\nshape A { B [] }"), HasSubstr("a.cfdg:2:11: error: unknown shape 'B'"));
    EXPECT_THAT(said("shape A { SQUARE [] }"), HasSubstr("no 'startshape'"));
    EXPECT_THAT(said("startshape A\nf(number n) = f(n) + f(n)\nshape A { SQUARE [x (f(1))] }"),
                HasSubstr("error"));
    EXPECT_THAT(said("startshape A\nv = 1, 2\nshape A { SQUARE [x (v[2])] }"),
                HasSubstr("a.cfdg:3:22: error: the vector has 2 elements"));
    EXPECT_THAT(said("import nothere.cfdg\nstartshape A\nshape A { SQUARE [] }"),
                HasSubstr("there is no file 'nothere.cfdg'"));
}

} // namespace
} // namespace graftal::testing
