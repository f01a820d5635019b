#include <gmock/gmock.h>

#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

TEST(FractintIfs, KeepsRowsNamesAndComments) {
    const ImportedShapes model("a.ifs", "; a file\nfern { ; Barnsley's\n  ; from a book\n"
                                        " 0 0 0 .16 0 0 .01 ; the stem\n .85 .04 -.04 .85 0 1.6 .85\n"
                                        " .2 -.26 .23 .22 0 1.6 .07\n -.15 .28 .26 .24 0 .44 .07\n}\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.graph->objects[model.graph->root].name, "fern");
    EXPECT_THAT(model.translation, HasSubstr("# Barnsley's\n# from a book\n"));
    EXPECT_THAT(model.translation, HasSubstr("# the stem\n"));
    EXPECT_THAT(model.translation,
                HasSubstr("0.85      0.04     -0.04      0.85         0       1.6       0.85\n"));
}

TEST(FractintIfs, ReadsSpaceCommasAndRowsWithoutProbability) {
    const ImportedShapes space("a.ifs",
                               "3d(3D) {\n .5 0 0 0 .5 0 0 0 .5 0 0 1 .5\n .5 0 0 0 .5 0 0 0 .5 0 0 -1 .5 }");
    ASSERT_TRUE(space.graph) << space.said();
    EXPECT_THAT(space.translation, HasSubstr("codes 3d {"));
    EXPECT_THAT(space.translation, HasSubstr("rifs m_3d {"));
    const ImportedShapes plain("a.ifs",
                               "levy {\n0.5, -0.5, 0.5, 0.5, 0, 0\n0.5, 0.5, -0.5, 0.5, 0.5, 0.5\n}");
    EXPECT_TRUE(plain.graph) << plain.said();
}

TEST(FractintIfs, ReadsTablesWithoutANameAndBraces) {
    const std::string rows =
        " .5 0 0 .5 0 0 .33\n\n .5, 0, 0, .5, +1, 0, .33 ; the second\n .5 0 0 .5 .5 1 .34\n";
    for (const char* const name : {"a gasket.ifs", "a gasket.txt"}) {
        const ImportedShapes model(name, rows);
        ASSERT_TRUE(model.graph) << model.said();
        EXPECT_THAT(model.translation, HasSubstr("rifs a_gasket {\n  codes 2d {\n"));
        EXPECT_THAT(model.translation, HasSubstr("0.33   # the second\n"));
        EXPECT_EQ(model.graph->objects[model.graph->root].instances.size(), 3u);
    }
    const ImportedShapes space("a.ifs", ".5 0 0 0 .5 0 0 0 .5 0 0 1\n.5 0 0 0 .5 0 0 0 .5 0 0 -1");
    EXPECT_THAT(space.translation, HasSubstr("codes 3d {"));
    EXPECT_FALSE(ImportedShapes("a.ifs", "3 4 5\n.5 0 0 .5 0 0 .33\n.5 0 0 .5 1 0 .33\n").graph);
}

TEST(FractintIfs, ProbabilitiesThatAreNoneBecomeFractints) {
    // Fractint adds up to -0.25, then 0.5, and gives the rest to the last.
    const ImportedShapes model("a.ifs", "a {\n .5 0 0 .5 0 0 -.25\n .5 0 0 .5 1 0 .75\n .5 0 0 .5 0 1 .1 }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("warning: these probabilities do not add up to 1"));
    EXPECT_THAT(model.translation, HasSubstr("1         0        0.5\n"));
    EXPECT_THAT(model.translation, HasSubstr("0         1        0.5\n"));
}

TEST(FractintIfs, WhatDoesNotShrinkIsAnOrbit) {
    const ImportedShapes model("a.ifs", "turn {\n 0 -1 1 0 0 0 .5\n .5 0 0 .5 1 0 .5\n}");
    EXPECT_TRUE(model.orbit) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("a.ifs:2:2: warning: this map does not shrink"));
}

TEST(FractintIfs, AMapOfOnePointKeepsItsProbability) {
    const ImportedShapes model("a.ifs", "p {\n .5 0 0 .5 0 0 .5\n 0 0 0 0 1 1 .1\n .5 0 0 .5 1 0 .4\n}\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("maps everything to one point; a small ball stands for it"));
    EXPECT_THAT(model.said(), ::testing::Not(HasSubstr("add up")));
    double point = 0, all = 0;
    for (const Instance& instance : model.graph->objects[model.graph->root].instances) {
        all += instance.chance;
        if (model.graph->objects[instance.master].primitive) point += instance.chance;
    }
    EXPECT_NEAR(point / all, 0.1, 1e-9);
}

TEST(FractintIfs, FaultsHaveTheirPlaces) {
    EXPECT_THAT(ImportedShapes("a.ifs", "a {\n .5 0 x .5 0 0 1\n}").said(),
                HasSubstr("a.ifs:2:7: error: 'x' is not a number"));
    EXPECT_THAT(ImportedShapes("a.ifs", "a {\n .5 0 0\n}").said(),
                HasSubstr("error: the last map has 3 numbers"));
    EXPECT_THAT(ImportedShapes("a.ifs", "a {\n .5 0 0 .5 0 0 1\n").said(), HasSubstr("'a' has no '}'"));
    EXPECT_THAT(ImportedShapes("a.ifs", "a { }").said(), HasSubstr("'a' has no maps"));
}

} // namespace
} // namespace graftal::testing
