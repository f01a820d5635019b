
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/inst/parse/parser.h"
#include "tests/unit/inst/inst_model.h"

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

void expect_near(Vec3 a, Vec3 b) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], 1e-14);
}

TEST(Inst, the_gasket_of_the_paper_is_cyclic) {
    const InstModel model(R"(
canonical object up {
    union: up, left, right
    scale: 0.5, 0.5
    translate: 0.0, 0.5
}
canonical object left {
    union: up, left, right
    scale: 0.5, 0.5
    translate: -0.433, -0.25
}
canonical object right {
    union: up, left, right
    scale: 0.5, 0.5
    translate: 0.433, -0.25
}
object top {
    union: up, left, right
}
)");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.names(), UnorderedElementsAre("top", "up", "left", "right"));
    EXPECT_EQ(model.graph->objects[model.graph->root].name, "top");
    EXPECT_THAT(model.masters("left"), ElementsAre("up", "left", "right"));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(model.map("left", i), (Affine{Mat3(0.5), {-0.433, -0.25, 0}}));
    EXPECT_EQ(model.map("top"), Affine());
}

TEST(Inst, lines_apply_in_the_order_of_the_text) {
    const InstModel model(R"(object a {
        sphere
        translate: 1, 0, 0
        rotate: z, 90
        scale: 2, 3, 4
        cube
        scale: 2, 3, 4
        rotate: z, 90
        translate: 1, 0, 0
    })");
    ASSERT_TRUE(model.graph) << model.said();
    expect_near(model.map("a", 0)({0, 0, 0}), {0, 3, 0});
    expect_near(model.map("a", 0)({1, 0, 1}), {0, 6, 4});
    expect_near(model.map("a", 1)({1, 0, 1}), {1, 2, 4});
}

TEST(Inst, each_kind_of_transform) {
    const InstModel model(R"(object a {
        sphere scale: 3
        instance: sphere scale: 2, 0.5
        instance: sphere scale: -2, 8
        instance: sphere scale: <1, 2, 3>
        instance: sphere rotate: x, 90
        instance: sphere rotate: <1, 1, 1>, 120
        instance: sphere rotate: y 90
        instance: sphere translate: 1, 2
        instance: sphere shear: xy, 0.5
        instance: sphere shear: zx 2
        instance: sphere matrix: 1, 2, 3, 4,  0, 1, 5, 6,  0, 0, 1, 7
        instance: sphere projection: 1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0
    })");
    ASSERT_TRUE(model.graph) << model.said();
    const auto at = [&](std::size_t i, Vec3 p) { return model.map("a", i)(p); };
    expect_near(at(0, {1, 1, 1}), {3, 3, 3});
    expect_near(at(1, {1, 1, 1}), {2, 0.5, 1});
    expect_near(at(2, {1, 1, 1}), {-2, 8, 4});
    expect_near(at(3, {1, 1, 1}), {1, 2, 3});
    expect_near(at(4, {0, 1, 0}), {0, 0, 1}); // right-handed
    expect_near(at(5, {1, 0, 0}), {0, 1, 0});
    expect_near(at(6, {0, 0, 1}), {1, 0, 0});
    expect_near(at(7, {0, 0, 0}), {1, 2, 0});
    expect_near(at(8, {1, 2, 3}), {2, 2, 3});
    expect_near(at(9, {1, 2, 3}), {1, 2, 5});
    expect_near(at(10, {1, 1, 1}), {10, 12, 8});
    expect_near(at(11, {1, 1, 1}), {1, 0, 0});
}

TEST(Inst, a_line_for_a_group_holds_for_each_of_its_instances) {
    const InstModel model(R"(
        material m { color: 1, 0, 0 }
        object a { union: sphere, cube scale: 2 tint: 1, 0, 0, 0.5 material: m
                   instance: torus })");
    ASSERT_TRUE(model.graph) << model.said();
    const std::vector<Instance>& instances = model.object("a").instances;
    ASSERT_EQ(instances.size(), 3u);
    for (const std::size_t i : {0u, 1u}) {
        EXPECT_EQ(instances[i].parent_from_child.linear, Mat3(2.0));
        EXPECT_EQ(instances[i].tint, (Tint{{1, 0, 0}, 0.5}));
        EXPECT_EQ(instances[i].material, MaterialId(0));
    }
    EXPECT_EQ(instances[2].parent_from_child, Affine());
    EXPECT_EQ(instances[2].tint, Tint());
    EXPECT_FALSE(instances[2].material);
}

TEST(Inst, tints_of_a_group_compose_with_later_lines_in_front) {
    const InstModel model(R"(object a {
        sphere
        tint: 1, 0, 0, 0.5
        tint rgb <0, 0, 1> 0.5
        sphere
        tint: 0.1, 0.2, 0.3, 0
        sphere
        tint: 0, 1, 0, 1
        tint: 1, 0, 0, 0
    })");
    ASSERT_TRUE(model.graph) << model.said();
    const std::vector<Instance>& instances = model.object("a").instances;
    const PathTint expected = PathTint({0, 0, 0.5}, 0.5) * PathTint({0.5, 0, 0}, 0.5);
    expect_near(PathTint(instances[0].tint).premultiplied, expected.premultiplied);
    EXPECT_EQ(instances[0].tint.alpha, 0.75);
    EXPECT_EQ(instances[1].tint, (Tint{{0.1, 0.2, 0.3}, 0})) << "a single tint is kept as it is";
    EXPECT_EQ(instances[2].tint, (Tint{{0, 1, 0}, 1}));
}

TEST(Inst, a_terminal_is_a_group_of_its_own) {
    const InstModel model(R"(
        canonical object a { union: a, a scale: 0.5 terminal: triangle scale: 3 tint: 1, 1, 1, 0.25 below 4 * 3 }
        object top { a })");
    ASSERT_TRUE(model.graph) << model.said();
    const Object& a = model.object("a");
    EXPECT_EQ(a.instances.size(), 2u);
    ASSERT_TRUE(a.terminal);
    EXPECT_EQ(model.graph->objects[a.terminal->master].primitive, PrimitiveKind::triangle);
    EXPECT_EQ(a.terminal->parent_from_child.linear, Mat3(3.0));
    EXPECT_EQ(a.terminal->tint.alpha, 0.25);
    EXPECT_EQ(a.terminal_px, 12);
}

TEST(Inst, parametric_objects_are_enumerated_as_far_as_they_are_reached) {
    const InstModel model(R"(
        let r = 0.64
        canonical object tip(0) { sphere }
        canonical object tip(n) { union: trunk(11 - n), tip(n - 1) rotate: x, 18.95 translate: 0, 1, 0 }
        canonical object trunk(0) { instance: cylinder }
        canonical object trunk(n) { instance: trunk(n - 1) scale: r, 1, r }
        canonical object never(n) { never(n + 1) }
        object tree { tip(3) })");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<std::string> expected = {"tree", "sphere", "cylinder"};
    for (int n = 0; n <= 3; ++n)
        expected.push_back("tip(" + std::to_string(n) + ")");
    for (int n = 0; n <= 10; ++n)
        expected.push_back("trunk(" + std::to_string(n) + ")");
    EXPECT_THAT(model.names(), ::testing::UnorderedElementsAreArray(expected));
    EXPECT_THAT(model.masters("tip(3)"), ElementsAre("trunk(8)", "tip(2)"));
    EXPECT_THAT(model.masters("tip(0)"), ElementsAre("sphere"));
    EXPECT_EQ(model.map("trunk(5)").linear[0][0], 0.64);
}

TEST(Inst, numbers_in_patterns_win_from_left_to_right) {
    const InstModel model(R"(
        canonical object f(n, m) { sphere }
        canonical object f(n, 0) { cube }
        canonical object f(0, n) { cone }
        canonical object f(0, 0) { torus }
        canonical object f(-1.5, n) { cylinder }
        object top { union: f(1, 1), f(1, 0), f(0, 1), f(0, 0), f(1 - 2.5, 0), f(1 - 1, -0) })");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.masters("top"),
                ElementsAre("f(1, 1)", "f(1, 0)", "f(0, 1)", "f(0, 0)", "f(-1.5, 0)", "f(0, 0)"));
    EXPECT_THAT(model.masters("f(1, 1)"), ElementsAre("sphere"));
    EXPECT_THAT(model.masters("f(1, 0)"), ElementsAre("cube"));
    EXPECT_THAT(model.masters("f(0, 1)"), ElementsAre("cone"));
    EXPECT_THAT(model.masters("f(0, 0)"), ElementsAre("torus"));
    EXPECT_THAT(model.masters("f(-1.5, 0)"), ElementsAre("cylinder"));
}

TEST(Inst, parameters_hide_lets_and_reach_every_line) {
    const InstModel model(R"(
        let n = 100, k = 2
        canonical object f(n) { sphere scale: n*k tint: n/4, 0, 0, 1 translate: n, 0 }
        object top { f(3) translate: n, 0 })");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.map("f(3)"), (Affine{Mat3(6.0), {3, 0, 0}}));
    EXPECT_EQ(model.object("f(3)").instances[0].tint.rgb.r, 0.75);
    EXPECT_EQ(model.map("top").translation.x, 100);
}

TEST(Inst, parametric_cycles_are_legal) {
    const InstModel model(R"(
        canonical object f(n) { union: f(mod(n + 1, 3)), sphere scale: 0.5 }
        object top { f(0) })");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.masters("f(2)"), ElementsAre("f(0)", "sphere"));
}

TEST(Inst, several_rendered_objects_are_united) {
    const InstModel model(
        "object scene { sphere } object b { union: scene, cube } canonical object scene_2 { b }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.graph->objects[model.graph->root].name, "scene_3");
    EXPECT_THAT(model.masters("scene_3"), ElementsAre("scene", "b"));
}

TEST(Inst, every_object_and_instance_has_a_place) {
    const std::string text = "canonical object tip(n) {\n  union: sphere, cube\n}\nobject top { tip(2) }\n";
    const InstModel model(text);
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.sources.text(model.object("tip(2)").span), "tip(n)");
    EXPECT_EQ(model.sources.text(model.object("top").span), "top");
    EXPECT_EQ(model.sources.text(model.object("tip(2)").instances[1].span), "cube");
    EXPECT_EQ(model.sources.text(model.object("top").instances[0].span), "tip(2)");
}

TEST(Inst, keywords_may_name_objects) {
    const InstModel model(
        "canonical object scale { sphere } canonical object material { cube }\n"
        "object union {\n  instance: scale\n  scale: 2\n  union: scale, material,\n  scale: 3\n}");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.masters("union"), ElementsAre("scale", "scale", "material"));
}

/// Prints a graph and reads it again.
void expect_round_trip(const InstModel& model) {
    ASSERT_TRUE(model.graph) << model.said();
    const std::string text = print(*model.graph);
    const InstModel again(text);
    ASSERT_TRUE(again.graph) << again.said() << text;
    EXPECT_TRUE(equal(*model.graph, *again.graph)) << text;
    EXPECT_EQ(print(*again.graph), text);
}

TEST(Inst, a_printed_graph_reads_back_to_the_last_bit) {
    expect_round_trip(InstModel(R"(
        camera { location: 1/3, sqrt(2), 5 angle: 100/3 }
        light { sun: 1, 2, 3 color: 1/3, 0.1, 1 } background { zenith: 0, 0, 1/7 horizon: 1, 1, 1 }
        ground { height: -1/3 material: bark color: 1, 0, 0 } steps: 4
        material bark { color: 1/3, 0.2, 0.1 reflection: 1/7 } material unused { roughness: 1/3 }
        canonical object tip(0) { sphere projection: 1/3, 0,0,0, 0,0,0,0, 0,0,0,1/7 }
        canonical object tip(n) { union: tip(n - 1), tip(n - 0.5), tip(n - 1)
            rotate: <1, 2, 3>, 17.3 scale: 1/3 translate: 1/7, -1e-300, 1e99 tint: 1/3, 0, 1/7, 0.1
            material: bark terminal: cube shear: xz, 1/9 tint: 1/3, 1, 1, 1/3 }
        canonical object tip(-1) { sphere } canonical object tip(0.5) { torus scale: 1e-99 }
        canonical object tip(-0.5) { cube }
        canonical object kept { union: kept, top scale: 0.25 }
        object top { tip(3) scale: -1/3, 0.7, 0.9 }
        object other { union: top, kept scale: 1/3 })"));
}

TEST(Inst, chances_hold_for_each_instance_of_their_group_and_read_back) {
    const InstModel model("let half = 1/2\n"
                          "object a { union: b, chance  scale: 0.5  chance: half/2\n"
                          "           instance: b  chance 3  scale: 0.1\n"
                          "           chance }\n" // a name, where no number follows
                          "canonical object b { sphere }  canonical object chance { cube }\n");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<double> chances;
    for (const Instance& instance : model.object("a").instances)
        chances.push_back(instance.chance);
    EXPECT_THAT(chances, ElementsAre(0.25, 0.25, 3, 0));
    expect_round_trip(model);
    EXPECT_THAT(InstModel("object a { sphere  chance: -1 }").said(),
                HasSubstr("m.inst:1:28: error: a chance must not be negative, but is -1\n"));
    EXPECT_THAT(InstModel("object a { sphere  terminal: cube  chance: 1 }").said(),
                HasSubstr("m.inst:1:36: error: a terminal has no chance\n"));
    EXPECT_THAT(InstModel("object a { sphere  chance: 1  chance: 2 }").said(),
                HasSubstr("m.inst:1:31: error: duplicate 'chance'\n"));
}

TEST(Inst, a_root_that_is_instanced_itself_reads_back) {
    expect_round_trip(
        InstModel("object top { union: part, top scale: 0.5 } canonical object part { union: top, cube "
                  "scale: 1/3 }"));
}

/// What is said of a model that has faults. Where a limit ends the work the message names that limit; where
/// texts are long they are so long that time in their square would never end.
std::string what_is_said_of(const std::string& text) {
    const InstModel model(text);
    EXPECT_FALSE(model.graph);
    return model.said();
}

TEST(InstHostile, unbounded_recursion_ends_soon_and_names_the_chain) {
    EXPECT_THAT(what_is_said_of("canonical object f(n) { union: f(n + 1), f(n + 1) }\nobject top { f(0) }"),
                HasSubstr("m.inst:1:32: error: the model uses object 'f' with more than 100000 different "
                          "arguments: top -> f(0) -> f(1) -> f(2) -> ... -> f(99999) -> f(1e+05)\n"));
}

TEST(InstHostile, doubling_recursion_is_bounded_by_the_number_of_objects) {
    std::string errors, text = "object top { f0(0) }\n";
    for (int i = 0; i < 30; ++i) {
        const std::string self = "f" + std::to_string(i), next = "f" + std::to_string((i + 1) % 30);
        text += "canonical object " + self + "(n) { union: " + next + "(2*n), " + next + "(2*n + 1) }\n";
    }
    LowerOptions options;
    options.max_objects = 50'000;
    const InstModel model(text, options);
    EXPECT_FALSE(model.graph);
    EXPECT_THAT(model.said(), HasSubstr("the model has more than 50000 objects: top -> f0(0) -> f1("));
}

TEST(InstHostile, wide_objects_are_bounded_by_the_number_of_instances) {
    std::string many = "sphere";
    for (int i = 0; i < 999; ++i)
        many += ", sphere";
    EXPECT_THAT(
        what_is_said_of("canonical object f(0) { sphere }\ncanonical object f(n) { union: f(n - 1), " + many +
                        " }\nobject top { f(50000) }"),
        HasSubstr("the model has more than 4000000 instances"));
}

TEST(InstHostile, long_lines_times_many_objects_are_bounded) {
    std::string lines;
    for (int i = 0; i < 20'000; ++i)
        lines += " rotate: y, n";
    EXPECT_THAT(
        what_is_said_of("canonical object f(0) { sphere }\ncanonical object f(n) { instance: f(n - 1)" +
                        lines + " }\nobject top { f(90000) }"),
        HasSubstr("the model takes too much work to list all its objects"));
}

TEST(InstHostile, nested_braces_give_one_error) {
    const std::string errors =
        what_is_said_of("object x " + std::string(1'000'000, '{') + std::string(1'000'000, '}'));
    EXPECT_THAT(errors, HasSubstr("m.inst:1:266: error: brackets nest more than 256 deep"));
    EXPECT_EQ(errors.find("error:"), errors.rfind("error:"));
    EXPECT_THAT(what_is_said_of("object x { sphere " + std::string(1'000'000, '(')),
                HasSubstr("brackets nest more than 256 deep"));
}

TEST(InstHostile, a_chain_of_100000_objects_is_legal) {
    std::string text = "object o0 { o1 }\n";
    for (int i = 1; i < 100'000; ++i)
        text += "canonical object o" + std::to_string(i) + " { o" + std::to_string(i + 1) + " scale: 0.9 }\n";
    text += "canonical object o100000 { sphere }\n";
    const InstModel model(text);
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.graph->objects.size(), 100'002u);
    EXPECT_TRUE(
        InstModel("canonical object f(0) { sphere } canonical object f(n) { f(n - 1) } object t { f(99999) }")
            .graph);
}

TEST(InstHostile, many_errors_end) {
    std::string text;
    for (int i = 0; i < 100'000; ++i)
        text += "canonical object o" + std::to_string(i) + " { unknown" + std::to_string(i) + " }\n";
    EXPECT_THAT(what_is_said_of(text), HasSubstr("unknown object 'unknown99'"));
    for (const char wrong : {'}', '\xFF'})
        EXPECT_THAT(what_is_said_of(std::string(1'000'000, wrong)), HasSubstr("error: "));
}

TEST(InstHostile, lets_are_not_copied_for_each_object) {
    std::string lets;
    for (int i = 0; i < 20'000; ++i)
        lets += "let a" + std::to_string(i) + " = 1\n";
    EXPECT_TRUE(InstModel(lets +
                          "canonical object f(0) { sphere }\ncanonical object f(n) { f(n - 1) scale: a7 }\n"
                          "object o { f(50000) }")
                    .graph);
}

TEST(InstHostile, a_known_object_is_not_looked_for_among_patterns) {
    std::string text;
    for (int i = 0; i < 20'000; ++i)
        text += "canonical object f(" + std::to_string(i) + ", n) { sphere }\n";
    text += "canonical object f(m, n) { cube }\nobject o {\n";
    for (int i = 0; i < 50'000; ++i)
        text += "f(-1, 1)\n";
    const InstModel model(text + "}");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.object("o").instances.size(), 50'000u);
    EXPECT_EQ(model.masters("f(-1, 1)"), std::vector<std::string>{"cube"});
}

TEST(InstHostile, groups_share_the_conditions_and_repeats_around_them) {
    SourceMap sources;
    Diagnostics diagnostics;
    const InstModule module = parse_inst(
        sources,
        sources.add("m.inst",
                    "object o {\n2 * { rotate: y, 9 } {\nwhen 1 {\nsphere\ncube\n}\ncube\n}\nsphere\n}"),
        diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
    const std::vector<InstGroup>& groups = module.definitions[0].groups;
    ASSERT_EQ(groups.size(), 4u);
    EXPECT_EQ(groups[0].conditions.size(), 1u);
    EXPECT_EQ(groups[0].conditions.begin(), groups[1].conditions.begin());
    EXPECT_TRUE(groups[2].conditions.empty());
    EXPECT_EQ(groups[0].repeats.begin(), groups[2].repeats.begin());
    EXPECT_EQ(groups[0].repeats.size(), 1u);
    EXPECT_TRUE(groups[3].repeats.empty());
}

TEST(Inst, parameters_leave_lets_to_other_objects) {
    const InstModel model("let n = 7\ncanonical object f(n) { sphere scale: n }\ncanonical object g(m) { "
                          "sphere scale: n * m }\n"
                          "object o { f(2), g(3), f(4) }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.map("f(2)").linear[0][0], 2);
    EXPECT_EQ(model.map("g(3)").linear[0][0], 21);
    EXPECT_EQ(model.map("f(4)").linear[0][0], 4);
    EXPECT_FALSE(
        InstModel("canonical object f(n) { sphere scale: n }\ncanonical object g(m) { sphere scale: n }\n"
                  "object o { f(2), g(3) }")
            .graph);
}

} // namespace
} // namespace graftal
