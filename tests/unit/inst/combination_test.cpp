// Intersections and differences, from the text to the graph and back.

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/lower/check_graph.h"
#include "compiler/passes/hoist_placements.h"
#include "compiler/passes/merge_equivalent.h"
#include "tests/unit/inst/inst_model.h"

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

void expect_reads_back(const InstModel& model) {
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_TRUE(verify(*model.graph).empty());
    const InstModel again(print(*model.graph));
    ASSERT_TRUE(again.graph) << again.said();
    EXPECT_TRUE(equal(*model.graph, *again.graph)) << print(*model.graph);
}

TEST(Combination, one_word_holds_for_all_groups_of_an_object) {
    const InstModel model(
        "object a { difference: cube, sphere scale: 0.5  instance: cone\n torus scale: 2 }");
    expect_reads_back(model);
    EXPECT_EQ(model.object("a").combination, Combination::subtract);
    EXPECT_THAT(model.masters("a"), ElementsAre("cube", "sphere", "cone", "torus"));
}

TEST(Combination, later_groups_may_name_it) {
    const InstModel model("object a { cube  intersection: sphere }");
    expect_reads_back(model);
    EXPECT_EQ(model.object("a").combination, Combination::intersect);
}

TEST(Combination, each_copy_of_a_repeat_is_an_operand) {
    const InstModel model("object a { intersection: cube\n"
                          "repeat 2 { rotate: y, 90 } repeat 3 { rotate: x, 10 } sphere }");
    expect_reads_back(model);
    EXPECT_EQ(model.object("a").instances.size(), 7u);
}

TEST(Combination, of_one_part_is_that_part) {
    const InstModel model("object a { difference: cube }");
    expect_reads_back(model);
    EXPECT_EQ(model.object("a").combination, Combination::unite);
}

TEST(Combination, names_may_still_be_those_of_objects) {
    const InstModel model("canonical object difference { cube }\n"
                          "object a {\n difference\n sphere\n}");
    expect_reads_back(model);
    EXPECT_EQ(model.object("a").combination, Combination::unite);
}

TEST(Combination, of_empty_parts_is_empty_where_nothing_can_be_left) {
    const std::string empty = "canonical object none { nothing }\n";
    const InstModel less(empty + "object a { difference: none, cube }\n");
    EXPECT_THAT(less.said(), HasSubstr("the model draws nothing"));
    const InstModel common(empty + "object a { intersection: cube, none, sphere }\n");
    EXPECT_THAT(common.said(), HasSubstr("the model draws nothing"));
    const InstModel whole(empty + "object a { difference: cube, none }\n");
    expect_reads_back(whole);
    EXPECT_EQ(whole.object("a").combination, Combination::unite);
}

TEST(Combination, is_told_apart_by_equality_and_by_merging) {
    const InstModel model("canonical object a { difference: cube, sphere }\n"
                          "canonical object b { difference: sphere, cube }\n"
                          "canonical object c { intersection: sphere, cube }\n"
                          "canonical object d { intersection: cube, sphere }\n"
                          "canonical object e { union: cube, sphere }\n"
                          "object all { a, b, c, d, e }");
    expect_reads_back(model);
    const Graph merged = merge_equivalent(*model.graph).graph;
    EXPECT_EQ(merged.objects.size(), model.graph->objects.size() - 1); // c and d
    for (const char* const other : {"b", "c", "e"}) {
        Graph changed = *model.graph;
        for (Object& object : changed.objects)
            if (object.name == "a") object.combination = model.object(other).combination;
        EXPECT_EQ(equal(changed, *model.graph), std::string(other) == "b");
    }
}

TEST(Combination, is_left_whole_by_hoisting) {
    const InstModel model("canonical object a { difference: cube, sphere scale: 0.5 translate: 1, 0, 0 }\n"
                          "object all { a, cone }");
    const Graph hoisted = hoist_placements(*model.graph).graph;
    EXPECT_TRUE(verify(hoisted).empty());
    const auto a = std::ranges::find(hoisted.objects, "a", &Object::name);
    ASSERT_NE(a, hoisted.objects.end());
    EXPECT_EQ(a->instances.size(), 2u);
}

TEST(Combination, limits_how_deep_it_nests) {
    std::string text = "canonical object a0 { sphere }\n";
    for (int i = 1; i <= 40; ++i)
        text += "canonical object a" + std::to_string(i) + " { difference: cube, a" + std::to_string(i - 1) +
                " scale: 0.9 }\n";
    EXPECT_THAT(InstModel(text + "object all { a40 }").said(), HasSubstr("more than 32 deep"));
    EXPECT_TRUE(InstModel(text.substr(0, text.find("canonical object a33")) + "object all { a32 }").graph);
}

TEST(Combination, a_terminal_that_leads_back_into_one_is_an_error) {
    for (const char* const text : {"canonical object b { sphere  terminal: d }\n"
                                   "object d { difference: cube  instance: b }\n",
                                   "object d { intersection: cube, sphere  terminal: d }\n",
                                   "canonical object b { sphere  terminal: c }\n"
                                   "canonical object c { cone  terminal: d }\n"
                                   "object d { difference: cube, b }\n"}) {
        const InstModel model(text);
        EXPECT_FALSE(model.graph) << text;
        EXPECT_THAT(model.said(), HasSubstr("leads back to it")) << text;
        EXPECT_THAT(model.said(), ::testing::Not(HasSubstr("deep"))) << text;
    }
}

/// Each object of a ring is looked at once, however far the flat part lies from the operand.
TEST(Combination, a_flat_part_is_found_all_around_a_long_ring) {
    constexpr ObjectId count = 50'000;
    Graph graph;
    for (ObjectId id = 0; id < count; ++id) {
        Object object;
        object.name = "r" + std::to_string(id);
        object.instances.push_back({(id + 1) % count, Affine::scale(Vec3(0.9)), {}, {}, {}});
        graph.add(std::move(object));
    }
    const ObjectId flat = graph.primitive(PrimitiveKind::triangle);
    graph.objects[count - 1].instances.push_back({flat, {}, {}, {}, {}});
    Object cup;
    cup.name = "cup";
    cup.combination = Combination::subtract;
    for (const ObjectId part : {graph.primitive(PrimitiveKind::cube), ObjectId{0}})
        cup.instances.push_back({part, {}, {}, {}, {}});
    graph.root = graph.add(std::move(cup));
    Diagnostics diagnostics;
    EXPECT_FALSE(check_graph(graph, diagnostics));
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_EQ(diagnostics.all()[0].message,
              "'triangle' in 'r0' encloses no volume, so it cannot be a part of the difference 'cup'");
}

} // namespace
} // namespace graftal
