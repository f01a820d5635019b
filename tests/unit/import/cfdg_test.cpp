#include <gmock/gmock.h>

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

TEST(ContextFree, SmallerShapesLieInFront) {
    const ImportedShapes model(
        "a.cfdg", "startshape A\nshape A { SQUARE [s 0.5] B [s 0.8] } shape B { SQUARE [s 0.1] SQUARE [] }");
    ASSERT_TRUE(model.graph) << model.said();
    const std::vector<UnfoldedLeaf> leaves = model.leaves(); // of sizes 0.5, 0.08 and 0.8
    EXPECT_GT(leaves.at(1).world_from_object.translation.z, leaves.at(0).world_from_object.translation.z);
    EXPECT_GT(leaves.at(0).world_from_object.translation.z, leaves.at(2).world_from_object.translation.z);
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
    EXPECT_THAT(model.translation, HasSubstr("canonical object A {"));
    EXPECT_EQ(model.leaves(4).size(), 4u);
    const ImportedShapes endless("a.cfdg", "startshape A\nshape A { CIRCLE [] A [x 1] }");
    EXPECT_THAT(endless.said(), HasSubstr("note: 'A' calls itself without becoming smaller"));
    EXPECT_EQ(endless.leaves().size(), 300u);
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
    EXPECT_GT(model.leaves().size(), 10u);
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
    EXPECT_THAT(model.translation,
                HasSubstr("camera { orthographic  location: 2,0,10  look_at: 2,0,0  width: 10 }"));
    EXPECT_EQ(model.leaves().size(), 5u);
}

TEST(ContextFree, WhatHasNoCounterpartIsNamed) {
    const auto said = [](const std::string& text) { return ImportedShapes("a.cfdg", text).said(); };
    EXPECT_THAT(said("startshape A\nrule A { SQUARE { b 0.1| } }"),
                HasSubstr("a.cfdg:2:19: error: colour targets ('|')"));
    EXPECT_THAT(said("startshape A\nshape A(adjustment a) { SQUARE [] }"), HasSubstr("of type 'adjustment'"));
    EXPECT_THAT(said("startshape A\nshape A { clone [] SQUARE [] }"), HasSubstr("'clone' is not translated"));
    EXPECT_THAT(said("startshape A\nshape A { B [] }"), HasSubstr("a.cfdg:2:11: error: unknown shape 'B'"));
    EXPECT_THAT(said("shape A { SQUARE [] }"), HasSubstr("no 'startshape'"));
    EXPECT_THAT(said("startshape A\nf(number n) = f(n) + f(n)\nshape A { SQUARE [x (f(1))] }"),
                HasSubstr("error"));
    EXPECT_THAT(said("startshape A\nshape A { if (rand(2) > 1) SQUARE [] }"),
                HasSubstr("a random condition"));
    EXPECT_THAT(said("import nothere.cfdg\nstartshape A\nshape A { SQUARE [] }"),
                HasSubstr("there is no file 'nothere.cfdg'"));
}

} // namespace
} // namespace graftal::testing
