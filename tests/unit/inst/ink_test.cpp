// Inks that are handed down, and groups under conditions.

#include <gmock/gmock.h>

#include "compiler/graph/text/print.h"
#include "compiler/support/hue.h"
#include "tests/unit/inst/inst_model.h"

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string said(const std::string& text) {
    return InstModel(text).said();
}

Rgb tint_of(const InstModel& model, std::string_view object, std::size_t i = 0) {
    return model.object(object).instances.at(i).tint.rgb;
}

TEST(Ink, IsTheColourOfPrimitivesBelow) {
    const InstModel model(
        "canonical object a { sphere\ncube tint: 0, 0, 1, 1 }\nobject b { instance: a  ink: 1, 0, 0 }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(tint_of(model, "a.ink1"), Rgb(1, 0, 0));
    EXPECT_EQ(tint_of(model, "a.ink1", 1), Rgb(0, 0, 1)); // a tint lies in front
    EXPECT_EQ(model.object("a").instances[0].tint.alpha, 0);
}

TEST(Ink, ChangesAreMadeOnTheWayDown) {
    const InstModel model(
        "canonical object c { sphere }\ncanonical object b { instance: c  ink { value 0.5 hue 120 } }\n"
        "object a { instance: b  ink: hsv(0, 1, 1)  ink { saturation to 0 by 0.5 value 3 } }");
    ASSERT_TRUE(model.graph) << model.said();
    const Rgb colour = tint_of(model, "c.ink1"); // hsv(120, 0.5, 0.5) on a screen
    EXPECT_NEAR(colour.g, 0.2140, 1e-4);
    EXPECT_NEAR(colour.r, 0.0509, 1e-4);
}

TEST(Ink, HuesGoUpOrDown) {
    const auto hue = [](const std::string& change) {
        const InstModel model(
            "canonical object b { sphere }\nobject a { instance: b  ink: hsv(300, 1, 1)  ink { " + change +
            " } }");
        EXPECT_TRUE(model.graph) << model.said();
        return tint_of(model, "b.ink1");
    };
    EXPECT_EQ(hue("hue up to 60 by 0.5"), Rgb(1, 0, 0));    // 300, 360
    EXPECT_EQ(hue("hue down to 60 by 0.25"), Rgb(0, 0, 1)); // 300, 240
    EXPECT_EQ(hue("hue to 60 by 0.75"), Rgb(0, 1, 0));      // 300, 120
    const InstModel named("let up = 60\ncanonical object b { sphere }\n"
                          "object a { instance: b  ink: hsv(300, 1, 1)  ink { hue up } }");
    ASSERT_TRUE(named.graph) << named.said();
    EXPECT_EQ(tint_of(named, "b.ink1"), Rgb(1, 0, 0)); // a turn by the number of this name
    EXPECT_THAT(said("object a { instance: sphere ink { value up to 1 by 0.1 } }"), HasSubstr("error"));
}

TEST(Ink, WithoutAnInkChangesDoNothing) {
    const InstModel model("object a { instance: sphere  ink { hue 10 value 0.5 } }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.root().instances[0].tint.alpha, 0);
}

TEST(Ink, EachCopyOfARepeatChangesItOnceMore) {
    const InstModel model(
        "object a { 3 * { translate: 1, 0, 0  ink { hue 120 } } sphere  ink { hue 0 } ink: hsv(0, 1, 1) }");
    ASSERT_TRUE(model.graph) << model.said();
    for (const Instance& instance : model.root().instances)
        EXPECT_EQ(instance.tint.rgb, Rgb(1, 0, 0)); // the group sets it after the copies
    const InstModel around("canonical object b { 3 * { translate: 1, 0, 0  ink { hue 120 } } sphere "
                           "}\nobject a { instance: b ink: hsv(0, 1, 1) }");
    EXPECT_EQ(tint_of(around, "b.ink1", 1), Rgb(0, 1, 0)) << around.said();
    EXPECT_EQ(tint_of(around, "b.ink1", 2), Rgb(0, 0, 1));
}

TEST(Ink, RecursionGoesThroughItsStates) {
    const InstModel model("canonical object a { sphere  instance: a scale: 0.5 ink { hue 90 } }\nobject b { "
                          "instance: a  ink: hsv(0, 1, 1) }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.names().size(), 7u); // a, b, sphere, and a under four hues
    const InstModel again(print(*model.graph));
    ASSERT_TRUE(again.graph) << again.said();
    EXPECT_TRUE(equal(*model.graph, *again.graph));
}

TEST(Ink, InksThatConvergeHaveAnEnd) {
    const InstModel model("canonical object a { sphere  instance: a scale: 0.9 ink { value to 0.5 by 0.01 } "
                          "}\nobject b { instance: a  ink: hsv(0, 1, 1) }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_LT(model.names().size(), 1500u);
    EXPECT_GT(model.names().size(), 300u);
}

TEST(Ink, BeyondTheLimitTheNearestServes) {
    LowerOptions options;
    options.max_objects = 300;
    const std::string text = "canonical object a {\nsphere\n instance: a scale: 0.9 ink { hue 1 } }\n"
                             "object b { instance: a  ink: hsv(0, 1, 1) }";
    const InstModel model(text, options);
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.said(), HasSubstr("note: there are too many different inks"));
    EXPECT_EQ(model.names().size(), 300u);
    options.max_objects = 3;
    EXPECT_THAT(InstModel(text, options).said(), HasSubstr("error: inks make more than 3 objects"));
}

TEST(Ink, AlphaMakesMaterialsSheer) {
    const InstModel model("material m { color: 1,1,1 transparency: 0.5 }\nobject a { instance: sphere "
                          "material: m ink: 1, 0, 0 ink { alpha 0.5 } }");
    ASSERT_TRUE(model.graph) << model.said();
    const Material& sheer = model.graph->materials[*model.root().instances[0].material];
    EXPECT_NEAR(sheer.transparency, 0.75, 1e-9);
    EXPECT_NEAR(sheer.filter, 0.25 / 0.75, 1e-9)
        << "half goes by the surface, and half of the rest takes its colour";
    const InstModel plain("object a { instance: sphere ink: 1, 0, 0 ink { alpha 0.25 } }");
    ASSERT_TRUE(plain.graph) << plain.said();
    EXPECT_TRUE(plain.graph->materials[*plain.root().instances[0].material].is_veil());
    const InstModel full("object a { instance: sphere ink: 1, 0, 0 ink { alpha 0.999 } }");
    ASSERT_TRUE(full.graph) << full.said();
    EXPECT_EQ(full.graph->materials[*full.root().instances[0].material].filter, 1) << "rounded to all of it";
}

TEST(Ink, FaultsAreNamed) {
    EXPECT_THAT(said("object a { instance: sphere ink { size 3 } }"),
                HasSubstr("expected 'hue', 'saturation', 'value', 'alpha' or '}'"));
    EXPECT_THAT(said("object a { instance: sphere ink { value to 2 by 0.1 } }"),
                HasSubstr("this target must lie between 0 and 1, not at 2"));
    EXPECT_THAT(said("object a { instance: sphere ink: 2, 0, 0 }"),
                HasSubstr("a number of a colour must lie between 0 and 1"));
    EXPECT_THAT(said("object a { instance: sphere ink { value -1 } }"),
                HasSubstr("this factor must lie between 0"));
    EXPECT_THAT(said("object a { ink: 1, 0, 0 }"), HasSubstr("'ink' has no object to apply to"));
    EXPECT_THAT(
        said("object a { 500 * { translate: 1,0,0 ink { value 2 value 0.5 hue to 5 by 0.1 } } sphere }"),
        HasSubstr("change the ink in more than 256 ways"));
}

TEST(Ink, IsANameElsewhere) {
    EXPECT_EQ(said("canonical object ink { sphere }\nobject a { ink scale: 2 }"), "");
}

TEST(When, KeepsTheGroupsOfItsBranch) {
    const InstModel model(
        "canonical object f(n) { when n > 1 { cube  instance: f(n - 1) translate: 3, 0, 0 }\n"
        "else when n == 1 { sphere } else { cone } }\nobject a { f(3)\nf(0) }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.masters("f(3)"), ElementsAre("cube", "f(2)"));
    EXPECT_THAT(model.masters("f(1)"), ElementsAre("sphere"));
    EXPECT_THAT(model.masters("f(0)"), ElementsAre("cone"));
}

TEST(When, EmptyObjectsAreLeftOut) {
    const InstModel model(
        "canonical object f(n) { when n > 0 { cube  instance: f(n - 1) translate: 3, 0, 0 hue: 30 } }\n"
        "canonical object hole { nothing }\nobject a { f(2)\nhole\n  3 * { translate: 0, 1, 0 } hole\nsphere "
        "hue: 5 }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.masters("a"), ElementsAre("f(2)", "sphere"));
    EXPECT_THAT(model.masters("f(1)"), ElementsAre("cube"));
    EXPECT_THAT(said("object a { when 0 { cube } }"), HasSubstr("the model draws nothing"));
    EXPECT_THAT(said("object a { nothing }"), HasSubstr("the model draws nothing"));
}

TEST(When, ChanceMayDrawNothing) {
    const InstModel model("canonical object t weight 1 { cube }\ncanonical object t weight 1 { nothing }\n"
                          "object a { 64 * { translate: 3, 0, 0 } t }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_NEAR(static_cast<double>(model.root().instances.size()), 32, 10);
}

TEST(When, FaultsAreNamed) {
    EXPECT_THAT(said("object a { when random(0, 1) { cube } }"), HasSubstr("'random' draws random numbers"));
    EXPECT_THAT(said("object a { when k { cube } }"), HasSubstr("unknown name 'k'"));
    EXPECT_THAT(said("object a { cube  when 1 { scale: 2 } }"),
                HasSubstr("'scale' has no object to apply to"));
    EXPECT_THAT(said("object a { when 1 { cube "), HasSubstr("expected '}'"));
}

TEST(Hsv, IsTheInverseOfRgb) {
    for (const Rgb rgb :
         {Rgb(1, 0, 0), Rgb(0.2, 0.7, 0.1), Rgb(0, 0, 0), Rgb(0.4, 0.4, 0.4), Rgb(0.3, 0.1, 0.9)}) {
        const Hsv hsv = hsv_from_rgb(rgb);
        const Rgb back = rgb_from_hsv(hsv.hue_deg, hsv.saturation, hsv.value);
        EXPECT_NEAR(back.r, rgb.r, 1e-12);
        EXPECT_NEAR(back.g, rgb.g, 1e-12);
        EXPECT_NEAR(back.b, rgb.b, 1e-12);
    }
}

} // namespace
} // namespace graftal
