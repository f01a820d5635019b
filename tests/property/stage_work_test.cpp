// Every stage before a picture counts its work against one limit: a model beyond it is refused with its
// stage, or told of in part, and one within it is what it is without a limit.

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/session/session.h"
#include "compiler/session/stages.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Analysis {
    std::shared_ptr<const AnalysedModel> model;
    std::string messages;
};

Analysis analysed(const std::string& name, const std::string& text, double work_seconds,
                  bool colours_count = true) {
    StageOptions options;
    options.detail.work_seconds = work_seconds;
    options.lower.may_leave_out_colours = !colours_count;
    Compilation compilation;
    Analysis analysis;
    analysis.model = Session(name, text).analysed(options, compilation);
    analysis.messages = compilation.diagnostics.render(compilation.sources);
    return analysis;
}

void expect_refused(const std::string& name, const std::string& text, const std::string& stage) {
    const Analysis analysis = analysed(name, text, 2);
    EXPECT_EQ(analysis.model, nullptr) << name;
    EXPECT_THAT(analysis.messages,
                HasSubstr(name + ":1:1: error: the model takes more than 2 seconds of work"));
    EXPECT_THAT(analysis.messages, HasSubstr(fmt::format("in the stage '{}'", stage)));
    EXPECT_THAT(analysis.messages, HasSubstr("allow more with --work"));
}

/// A forest of objects under many hues: `kinds` * 360 objects, each of `copies` instances.
std::string hued(int kinds, int copies, const char* hue) {
    std::string text;
    for (int kind = 0; kind < kinds; ++kind)
        text += fmt::format(
            "canonical object o{} {{ {} * {{ rotate: y, 3 translate: 0.01, 0, 0 }} o{} scale: 0.3 {}\n"
            "  instance: sphere tint: 0.9, 0.2, 0.1, 0.5 scale: 0.{} }}\n",
            kind, copies, (kind + 1) % kinds, hue, kind + 1);
    return text + "object top { o0 }\n";
}

TEST(StageWork, LongWordsEndAtTheLimit) {
    expect_refused("context.lsys",
                   "lsys a {\n  steps 30\n  axiom F(0)\n  G < F(x) -> F(x + 1)G\n  F(x) -> F(x + 1)F(x)\n}\n",
                   "lower");
    expect_refused("query.lsys",
                   "lsys a {\n  steps 40\n  axiom A(0)\n  A(x) -> F?P(0, 0, 0)A(x + 1)A(x)\n}\n", "lower");
}

TEST(StageWork, ManyCopiesEndAtTheLimit) {
    expect_refused(
        "copies.inst",
        "object a { 1000 * { translate: 1, 0, 0 } 1000 * { translate: 0, 1, 0 rotate: y, 1 } sphere "
        "scale: random(0.3, 0.8) }\n",
        "lower");
}

TEST(StageWork, ManyHuesEndAtTheLimit) {
    expect_refused("hues.inst", hued(4, 2500, "hue: 1"), "lower");
}

TEST(StageWork, WhoAsksForShapesGetsThemWithoutTheHues) {
    const Analysis limited = analysed("hues.inst", hued(4, 800, "hue: 1"), 2, false);
    const Analysis plain = analysed("hues.inst", hued(4, 800, ""), 2, false);
    ASSERT_TRUE(limited.model);
    ASSERT_TRUE(plain.model);
    EXPECT_THAT(limited.messages, HasSubstr("graftal leaves the hues and inks out here"));
    EXPECT_EQ(plain.messages, "");
    EXPECT_EQ(limited.model->graph.objects.size(), plain.model->graph.objects.size());
    EXPECT_EQ(limited.model->bounds[limited.model->graph.root].box.max,
              plain.model->bounds[plain.model->graph.root].box.max);
}

TEST(StageWork, HuesWithinTheLimitStay) {
    const Analysis analysis = analysed("hues.inst", hued(3, 4, "hue: 10"), 2, false);
    ASSERT_TRUE(analysis.model);
    EXPECT_EQ(analysis.messages, "");
    EXPECT_EQ(analysis.model->graph.objects.size(), 38u) << "one for each hue that comes about";
}

TEST(StageWork, RandomPlantsGetFewerVariants) {
    const std::string text =
        "lsys a {\n  angle 1\n  steps 300\n  thickness 0.1\n  taper .8\n  axiom A\n  A -> BAB\n"
        "  B -> ABB : 0.289\n  B -> F(.5)@O(.2){.+F.F.F.-F.+F.+F.}AAF(.5) : 0.711\n}\n";
    const Analysis limited = analysed("chance.lsys", text, 1), whole = analysed("chance.lsys", text, 4);
    ASSERT_TRUE(limited.model);
    ASSERT_TRUE(whole.model);
    EXPECT_LT(limited.model->derivation->variants, whole.model->derivation->variants);
    EXPECT_GT(limited.model->derivation->drift, whole.model->derivation->drift);
    EXPECT_THAT(limited.messages, HasSubstr("variants of each random part in place of"));
    EXPECT_LE(limited.model->work_seconds, 2) << "the least that there is";
}

TEST(StageWork, IsTheSameEachTimeAndGrowsWithTheModel) {
    const double once = analysed("hues.inst", hued(3, 4, "hue: 10"), 30).model->work_seconds;
    EXPECT_GT(once, 0);
    EXPECT_EQ(analysed("hues.inst", hued(3, 4, "hue: 10"), 30).model->work_seconds, once);
    EXPECT_GT(analysed("hues.inst", hued(3, 40, "hue: 10"), 30).model->work_seconds, once);
}

TEST(StageWork, ALimitThatSufficesChangesNothing) {
    const std::string text = hued(3, 20, "hue: 10");
    const Analysis limited = analysed("hues.inst", text, 5), free = analysed("hues.inst", text, INFINITY);
    ASSERT_TRUE(limited.model);
    ASSERT_TRUE(free.model);
    EXPECT_EQ(print(limited.model->graph), print(free.model->graph));
    EXPECT_EQ(limited.model->work_seconds, free.model->work_seconds);
}

/// What prepares a graph for a picture counts too, before it begins: a graph that could be read within the
/// work, but not drawn, is refused.
TEST(StageWork, PreparationCounts) {
    StageOptions options;
    options.detail.work_seconds = 1e6;
    Session session("hues.inst", hued(4, 600, "hue: 1"));
    Compilation compilation;
    const auto prepared = session.prepared(options, compilation);
    const auto analysed = session.analysed(options, compilation);
    ASSERT_TRUE(prepared);
    ASSERT_TRUE(analysed);
    EXPECT_GT(prepared->work_seconds, 1.05 * analysed->work_seconds);
    options.draws = false; // the stages before may take it all
    options.detail.work_seconds = 1.01 * analysed->work_seconds;
    ASSERT_GT(options.detail.work_seconds, 2) << "more than the least that there is";
    Compilation refused;
    EXPECT_TRUE(session.analysed(options, refused));
    EXPECT_EQ(session.prepared(options, refused), nullptr);
    EXPECT_THAT(refused.diagnostics.render(refused.sources), HasSubstr("in the stage 'prepare'"));
}

/// A graph within the limit is no less within it because a picture follows: only stages that choose leave
/// work for that.
TEST(StageWork, PicturesRefuseNoGraphThatReportsTake) {
    const std::string text = hued(4, 400, "hue: 1");
    StageOptions options;
    options.detail.work_seconds = 1e6;
    options.draws = false;
    Compilation compilation;
    const auto whole = Session("hues.inst", text).analysed(options, compilation);
    ASSERT_TRUE(whole);
    options.detail.work_seconds = 1.1 * whole->work_seconds;
    ASSERT_GT(options.detail.work_seconds, 2) << "more than the least that there is";
    options.draws = true;
    const auto drawn = Session("hues.inst", text).analysed(options, compilation);
    ASSERT_TRUE(drawn) << compilation.diagnostics.render(compilation.sources);
    EXPECT_EQ(print(drawn->graph), print(whole->graph));
}

/// Stages that choose how much they do leave most of the work for the picture.
TEST(StageWork, PicturesGetFewerVariantsThanReports) {
    const std::string text = "lsys a {\n  angle 1\n  steps 300\n  axiom A\n  A -> BAB\n"
                             "  B -> ABB : 0.289\n  B -> F(.5)@O(.2)F.+F.F+(10)AAF(.5) : 0.711\n}\n";
    StageOptions options;
    options.detail.work_seconds = 2;
    Compilation compilation;
    const auto drawn = Session("chance.lsys", text).analysed(options, compilation);
    options.draws = false;
    const auto reported = Session("chance.lsys", text).analysed(options, compilation);
    ASSERT_TRUE(drawn);
    ASSERT_TRUE(reported);
    EXPECT_LT(drawn->derivation->variants, reported->derivation->variants);
}

TEST(StageWork, ASessionGoesOnWithALargerLimit) {
    StageOptions options;
    options.detail.work_seconds = 2;
    Session session("hues.inst", hued(4, 800, "hue: 1"));
    Compilation refused, allowed;
    EXPECT_EQ(session.analysed(options, refused), nullptr);
    EXPECT_TRUE(refused.diagnostics.has_errors());
    options.detail.work_seconds = 1e6;
    EXPECT_NE(session.analysed(options, allowed), nullptr);
    EXPECT_FALSE(allowed.diagnostics.has_errors());
}

/// Objects that differ in their colours only are bounded once: what bounds find does not depend on them.
TEST(StageWork, ColoursDoNotMoveBounds) {
    const Analysis coloured = analysed("hues.inst", hued(4, 40, "hue: 1"), 1e6);
    const Analysis plain = analysed("hues.inst", hued(4, 40, ""), 1e6);
    ASSERT_TRUE(coloured.model);
    ASSERT_TRUE(plain.model);
    EXPECT_GT(coloured.model->graph.objects.size(), 50 * plain.model->graph.objects.size());
    const Box a = coloured.model->bounds[coloured.model->graph.root].box,
              b = plain.model->bounds[plain.model->graph.root].box;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(a.min[axis], b.min[axis], 1e-9);
        EXPECT_NEAR(a.max[axis], b.max[axis], 1e-9);
    }
    EXPECT_NEAR(coloured.model->contraction.rate(), plain.model->contraction.rate(), 1e-12);
    EXPECT_EQ(coloured.model->bounds.size(), coloured.model->graph.objects.size());
}

} // namespace
} // namespace graftal
