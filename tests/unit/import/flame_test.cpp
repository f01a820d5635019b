#include <gmock/gmock.h>

#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

std::string flame(const std::string& maps) {
    return "<flames><flame name=\"a b\" size=\"640 480\" center=\"1 2\" scale=\"160\">\n" + maps +
           "</flame></flames>";
}

TEST(Flame, AffineMapsThatShrinkAreALimitSet) {
    const ImportedShapes model(
        "a.flame",
        flame("<xform weight=\"3\" color=\"0\" linear=\"0.5\" coefs=\"1 0 0 1 0 0\"/>\n"
              "<xform weight=\"1\" color=\"1\" linear=\"1\" coefs=\"0 .5 -.5 0 1 2\" post=\"1 0 0 1 3 0\"/>\n"
              "<color index=\"0\" rgb=\"255 0 0\"/><color index=\"255\" rgb=\"0 0 255\"/>"));
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("rifs a_b {\n"));
    EXPECT_THAT(model.translation, HasSubstr("0.5 0 0 0.5  0 0  0.75  tint rgb <1, 0, 0> 0.5\n"));
    EXPECT_THAT(model.translation, HasSubstr("0 -0.5 0.5 0  4 2  0.25  tint rgb <0, 0, 1> 0.5\n"));
    EXPECT_THAT(model.translation, HasSubstr("width: 4 }"));
}

TEST(Flame, ChaosIsTheDigraph) {
    const std::string half = "linear=\".5\" coefs=\"1 0 0 1 ";
    const ImportedShapes model("a.flame",
                               flame("<xform weight=\"1\" chaos=\"0 1\" " + half +
                                     "1 0\"/><xform weight=\"1\" chaos=\"1 1\" " + half + "0 0\"/>"));
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("follow matrix {   # 'chaos'\n    0 1\n    0.5 0.5\n  }\n"));
    std::size_t instances = 0;
    for (const Object& object : model.graph->objects)
        if (object.name == "w1") instances = object.instances.size();
    EXPECT_EQ(instances, 1u); // w1 follows w2 only
}

TEST(Flame, OthersAreOrbits) {
    const ImportedShapes model("a.flame",
                               flame("<xform weight=\"1\" swirl=\"1\" linear=\".2\" coefs=\".5 0 0 .5 0 0\"/>"
                                     "<xform weight=\"1\" julia=\"1\" coefs=\"1 0 0 1 0 0\"/>"));
    EXPECT_TRUE(model.orbit) << model.said() << model.translation;
    EXPECT_THAT(model.translation, HasSubstr("probability 0.25")); // two branches of julia
}

TEST(Flame, WhatHasNoFormulaIsNamed) {
    const auto said = [](const std::string& maps) { return ImportedShapes("a.flame", flame(maps)).said(); };
    EXPECT_THAT(said("<xform weight=\"1\" blur=\"1\" coefs=\"1 0 0 1 0 0\"/>"),
                HasSubstr("a.flame:2:2: error: the variation 'blur' is not translated"));
    EXPECT_THAT(said("<xform weight=\"1\" wobble=\"1\" coefs=\"1 0 0 1 0 0\"/>"), HasSubstr("'wobble'"));
    EXPECT_THAT(said("<xform weight=\"1\" linear=\"1\" coefs=\"1 0 0\"/>"),
                HasSubstr("'coefs' takes six numbers"));
    EXPECT_THAT(said("<xform"), HasSubstr("this is no XML"));
    EXPECT_THAT(said(""), HasSubstr("no maps"));
}

} // namespace
} // namespace graftal::testing
