#include <functional>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

std::size_t boxes(const std::string& text) {
    const ImportedShapes model("a.es", text);
    EXPECT_TRUE(model.graph) << model.said() << model.translation;
    return model.leaves().size();
}

TEST(EisenScript, CountsGenerationsAsStructureSynthDoes) {
    // The first generation is the text outside of rules; a box is drawn in the one after its rule.
    EXPECT_EQ(boxes("set maxdepth 5\nr\nrule r { box { x 1 s 0.9 } r }"), 3u);
    EXPECT_EQ(boxes("set maxdepth 2\nbox\nr\nrule r { box }"), 1u);
    EXPECT_EQ(boxes("set maxobjects 10\nr\nrule r { box { x 1 } r { y 1 } r }"),
              3u); // 12 states wait after the fourth generation
}

TEST(EisenScript, DepthsAndTheRulesThatFollow) {
    EXPECT_EQ(boxes("r\nrule r md 4 { box { x 1 } r }"), 4u);
    EXPECT_EQ(boxes("r\nrule r md 4 > end { box { x 1 } r }\nrule end { 3 * { y 1 } box }"), 7u);
    // Each rule counts for itself, and anew each time it is reached from outside.
    EXPECT_EQ(boxes("2 * { z 5 } r\nrule r md 3 { s md3 }\nrule s { r box }\nrule md3 { }"), 6u);
    EXPECT_EQ(boxes("r\nrule r md 3 > r { box { x 1 } r }\nset maxdepth 12"), 10u);
}

TEST(EisenScript, LoopsMultiplyFromTheFirst) {
    const ImportedShapes model("a.es", "2 * { x 3 } 2 * { rz 90 } box");
    ASSERT_TRUE(model.graph) << model.said();
    std::set<std::pair<double, double>> places;
    for (const UnfoldedLeaf& leaf : model.leaves())
        places.emplace(leaf.world_from_object.translation.x, leaf.world_from_object.translation.y);
    EXPECT_EQ(places, (std::set<std::pair<double, double>>{{3, 0}, {6, 0}}));
    EXPECT_EQ(model.leaves().size(), 4u);
    EXPECT_EQ(boxes("3 * { x 1 } 4 * { y 1 } 5 * { z 1 } box"), 60u);
}

TEST(EisenScript, NumbersWithOperators) {
    const auto place = [](const std::string& number) {
        const ImportedShapes model("a.es", "{ x " + number + " y 7 } sphere");
        EXPECT_TRUE(model.graph) << model.said();
        return model.leaves().at(0).world_from_object.translation;
    };
    EXPECT_EQ(place("-1.1 * 10").x, place("-11").x);
    EXPECT_EQ(place("1 + 2 * 3 / 4 - 1").x, place("1.5").x);
    EXPECT_EQ(place("1 + 2 * 3 / 4 - 1").y, place("0").y);
    EXPECT_THAT(ImportedShapes("a.es", "{ x 1 / 0 } box").said(), HasSubstr("this has no value"));
    EXPECT_THAT(ImportedShapes("a.es", "{ x 1 * } box").said(), HasSubstr("expected a number"));
}

TEST(EisenScript, TurnsAboutTheMiddleOfTheCube) {
    const ImportedShapes model("a.es", "{ x 1 rz 90 s 2 1 1 y 1 } box");
    ASSERT_TRUE(model.graph) << model.said();
    const Affine place = model.leaves().at(0).world_from_object;
    EXPECT_NEAR(place.translation.x, 0, 1e-12);
    EXPECT_NEAR(place.translation.y, 0, 1e-12);
    EXPECT_NEAR(place.linear[0].y, 1, 1e-12); // half of the edge of 2
}

TEST(EisenScript, ColoursAreHandedDown) {
    const auto colour = [](const std::string& operators) {
        const ImportedShapes model("a.es", "{ " + operators + " } box");
        EXPECT_TRUE(model.graph) << model.said();
        return model.leaves().at(0).tint.over(Rgb(0.5));
    };
    EXPECT_EQ(colour("x 1"), Rgb(1, 0, 0));
    EXPECT_NEAR(colour("hue 120").g, 1, 1e-9);
    EXPECT_NEAR(colour("sat 0.5").g, 0.2140, 1e-4); // half of the screen's light
    EXPECT_NEAR(colour("b 0.5").r, 0.2140, 1e-4);
    EXPECT_EQ(colour("color white"), Rgb(1));
    EXPECT_EQ(colour("color #00f hue 120"), Rgb(1, 0, 0));
    EXPECT_NEAR(colour("blend white 1").g, 0.2140, 1e-4);
}

TEST(EisenScript, KeepsNamesConstantsAndComments) {
    const ImportedShapes model("a.es", "// a stair\n#define angle 6 // degrees\nset background #fff\nStep\n"
                                       "/* one step */\nrule Step md 3 { box { y 1 ry angle } Step }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("# a stair\n"));
    EXPECT_THAT(model.translation, HasSubstr("let angle = 6   # degrees\n"));
    EXPECT_THAT(model.translation, HasSubstr("# one step\ncanonical object Step(left) {\n"));
    EXPECT_THAT(model.translation,
                HasSubstr("instance: Step(left - 1)  rotate: y, angle  translate: 0, 1, 0"));
    EXPECT_THAT(model.translation, HasSubstr("background: 1, 1, 1"));
    EXPECT_EQ(model.leaves().size(), 3u);
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(model.translation, '\n')), model.lines);
}

TEST(EisenScript, SizesEndGrowth) {
    // The diagonal of the cube is sqrt(3) at first; 0.5^2 of it is 0.43.
    EXPECT_EQ(boxes("set minsize 0.4\nr\nrule r { box { s 0.5 x 1 } r }"), 3u);
    EXPECT_EQ(boxes("set maxsize 4\nr\nrule r { box { s 2 x 1 } r }"), 2u);
}

TEST(EisenScript, ChanceChoosesByWeight) {
    const ImportedShapes model("a.es", "200 * { x 2 } r\nrule r w 3 { box }\nrule r { }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_NEAR(static_cast<double>(model.leaves().size()), 150, 10);
}

TEST(EisenScript, MeshesJoinFrames) {
    EXPECT_EQ(boxes("{ z 2 } mesh"), 8u);
    EXPECT_EQ(boxes("r\nrule r md 3 { { z 1 } r  mesh }"), 24u - 0u);
}

TEST(EisenScript, FaultsHaveTheirPlaces) {
    const auto said = [](const std::string& text) { return ImportedShapes("a.es", text).said(); };
    EXPECT_THAT(said("r\nrule r { { q 1 } box }"), HasSubstr("a.es:2:12: error: expected a transformation"));
    EXPECT_THAT(said("bix"), HasSubstr("a.es:1:1: error: unknown rule 'bix'"));
    EXPECT_THAT(said("rule r { box }"), HasSubstr("the script draws nothing"));
    EXPECT_THAT(said("{ color nocolour } box"), HasSubstr("'nocolour' is not a colour"));
    EXPECT_THAT(said("set colorpool image:a.png\nbox"), HasSubstr("'image:'"));
    EXPECT_THAT(said("#define a b\n#define b a\n{ x a } box"), HasSubstr("more than 100 substitutions"));
    EXPECT_THAT(said("r\nrule r { box"), HasSubstr("expected '}' at the end of the rule"));
    EXPECT_THAT(said("set raytracer::shadows false\nbox"), HasSubstr("warning: 'raytracer::shadows'"));
}

TEST(EisenScript, IgnoredWordsAreNamed) {
    const auto said = [](const std::string& text) { return ImportedShapes("a.es", text).said(); };
    EXPECT_THAT(said("#wobble 3\nbox"), HasSubstr("a.es:1:1: warning: '#wobble' is no '#define'"));
    EXPECT_THAT(said("set recursion depth\nbox"),
                HasSubstr("warning: 'set recursion depth' changes nothing"));
    EXPECT_THAT(said("set rotation [1 0 0 0 1 0 0 0 1]\nset scale 2\nbox"),
                HasSubstr("a.es:1:1: warning: 'set rotation', 'set scale' make no camera"));
    EXPECT_EQ(said("set translation [0 0 -20]\nset scale 2\nbox"), "");
}

std::string times(int count, const std::function<std::string(int)>& text) {
    std::string all;
    for (int i = 0; i < count; ++i)
        all += text(i);
    return all;
}

/// Small texts that would become large ones, or take long to count.
TEST(EisenScript, WorkIsBounded) {
    const auto is_refused = [](const std::string& text, const std::string& why) {
        const ImportedShapes model("a.es", text);
        EXPECT_THAT(model.diagnostics.render(model.sources), HasSubstr(why));
        EXPECT_THAT(model.diagnostics.render(model.sources), HasSubstr("hint: ")) << why;
        EXPECT_EQ(model.translation, "");
    };
    const auto number = [](int i) { return std::to_string(i); };
    is_refused("a\n" +
                   times(1500, [&](int i) { return "rule a md " + number(i + 1) + " { { x 1 } a box }\n"; }),
               "a.es:2:6: error: more than 98 depths of rules ('maxdepth') count together here");
    is_refused("a\nrule a {\n" + times(200, [](int) { return "100 * { x 1 } 100 * { y 1 } mesh\n"; }) + "}\n",
               "a.es:4:1: error: the script has more than 10000 copies of a 'mesh'");
    is_refused("set minsize 0.001\na\nrule a { 9999 * { x 1 s 0.9 } box }\n",
               "error: the script has more than 300000 operators of copies that change their size");
    is_refused("set colorpool list:" + times(1000, [&](int) { return "red,"; }) + "red\na\nrule a {\n" +
                   times(1000, [](int) { return "{ x 1 color random } box\n"; }) + "}\n",
               "error: the script has more than 300000 colours of pools");
    is_refused(times(1500, [&](int i) { return "#define a" + number(i) + "x " + number(i) + "\n"; }) +
                   "a\nrule a {\n" +
                   times(40,
                         [&](int i) {
                             return "{ " +
                                    times(90, [&](int j) { return "x a" + number(j + 14 * i) + "x "; }) +
                                    "} box\n";
                         }) +
                   "}\n",
               "error: the substitutions of the script take too long");
    // One mistake of thousands asks for the nearest name no more than a hundred times.
    const ImportedShapes unknown("a.es", times(20'000, [&](int i) { return "zz" + number(i) + "\n"; }));
    EXPECT_EQ(unknown.diagnostics.all().size(), unknown.diagnostics.error_count());
    EXPECT_LE(unknown.diagnostics.error_count(), 101u);
}

} // namespace
} // namespace graftal::testing
