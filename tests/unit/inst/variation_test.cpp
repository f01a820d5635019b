// Repeats, weighted alternatives, random numbers, and hues along depth.

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/graph/unfold.h"
#include "compiler/inst/hues.h"
#include "compiler/support/hue.h"
#include "tests/unit/inst/inst_model.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

void expect_close(Vec3 a, Vec3 b, double tolerance = 1e-12) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance);
}

LowerOptions seeded(std::uint64_t seed) {
    LowerOptions options;
    options.seed = seed;
    return options;
}

void expect_printed_graph_reads_back(const InstModel& model) {
    ASSERT_TRUE(model.graph) << model.said();
    const InstModel again(print(*model.graph));
    ASSERT_TRUE(again.graph) << again.said();
    EXPECT_TRUE(equal(*model.graph, *again.graph)) << print(*model.graph);
}

// Repeats

TEST(Repeat, each_copy_has_the_block_once_more_than_the_one_before) {
    for (const std::string head : {"repeat 4", "4 *", "(2 + n) *", "repeat 2*n", "repeat: "}) {
        const std::string text = "let n = 2\nobject a {\n" + head +
                                 " { rotate: y, 90  translate: 0, 1, 0 } sphere translate: 1, 0, 0 }";
        const InstModel model(text);
        if (head == "repeat: ") {
            EXPECT_FALSE(model.graph); // this is a keyword with a colon, and no count
            continue;
        }
        ASSERT_TRUE(model.graph) << head << model.said();
        ASSERT_EQ(model.root().instances.size(), 4u) << head;
        const Vec3 expected[] = {{1, 0, 0}, {0, 1, -1}, {-1, 2, 0}, {0, 3, 1}};
        for (std::size_t i = 0; i < 4; ++i)
            expect_close(model.root().instances[i].parent_from_child.translation, expected[i]);
        expect_printed_graph_reads_back(model);
    }
}

TEST(Repeat, tints_compose_with_those_of_outer_copies_in_front) {
    const InstModel model(
        "object a { 3 * { tint: 1, 0, 0, 0.5  translate: 1, 0, 0 } sphere tint: 0, 0, 1, 1 }");
    ASSERT_TRUE(model.graph) << model.said();
    const double reds[] = {0, 0.5, 0.75};
    for (std::size_t i = 0; i < 3; ++i)
        expect_close(model.root().instances[i].tint.rgb, {reds[i], 0, 1 - reds[i]});
}

TEST(Repeat, nested_repeats_make_the_product_and_the_graph_their_sum) {
    const InstModel model("object a { 10 * { translate: 1, 0, 0 } 10 * { translate: 0, 1, 0 } "
                          "10 * { translate: 0, 0, 1 } sphere }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(instance_count(*model.graph), 30u);
    std::set<std::tuple<long, long, long>> places;
    std::size_t drawn = 0;
    for (const Instance& x : model.root().instances)
        for (const Instance& y : model.master(x).instances)
            for (const Instance& z : model.master(y).instances) {
                const Vec3 at = (x.parent_from_child * y.parent_from_child * z.parent_from_child).translation;
                places.insert({std::lround(at.x), std::lround(at.y), std::lround(at.z)});
                ++drawn;
            }
    EXPECT_EQ(drawn, 1000u);
    EXPECT_EQ(places.size(), 1000u);
    EXPECT_EQ(*places.rbegin(), std::make_tuple(9, 9, 9));
    expect_printed_graph_reads_back(model);
}

TEST(Repeat, a_recursion_keeps_its_levels) {
    // An object in between would count as a level of its own.
    const InstModel model(
        "object a { sphere\n 2 * { rotate: y, 180 } 2 * { rotate: z, 10 } a scale 0.3 translate 2, 0 }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.root().instances.size(), 5u);
}

TEST(Repeat, braces_hold_several_groups) {
    const InstModel model("object a { 3 * { translate: 0, 2, 0 } { sphere\n cube scale: 0.5\n"
                          " 2 * { translate: 3, 0, 0 } cone }\n torus }");
    ASSERT_TRUE(model.graph) << model.said();
    std::map<std::string, std::size_t> count;
    for (const Instance& instance : model.root().instances)
        ++count[model.master(instance).name];
    EXPECT_EQ(count["sphere"], 3u);
    EXPECT_EQ(count["cube"], 3u);
    EXPECT_EQ(count["torus"], 1u);
    EXPECT_EQ(count["a.repeat"], 3u);
}

TEST(Repeat, mistakes_end_in_messages) {
    const std::pair<const char*, const char*> cases[] = {
        {"object a { 1e9 * { translate: 1, 0, 0 } sphere }", "a repeat makes a whole number of copies"},
        {"object a { 2.5 * { translate: 1, 0, 0 } sphere }", "from 1 to 4000000, not 2.5"},
        {"object a { 0 * { translate: 1, 0, 0 } sphere }", "not 0"},
        {"object a { (0 - 3) * { translate: 1, 0, 0 } sphere }", "not -3"},
        {"object a { 1000 * { scale: 0.5 } sphere }", "a copy of this repeat"},
        {"object a { 100 * { scale: 0.5, 1, 1 } sphere }", "a copy of this repeat is singular"},
        {"object a { 3 * { sphere } }", "expected a transform, 'tint', 'hue', 'ink' or '}'"},
        {"object a { sphere\n 3 * { scale: 0.5 } }", "expected the objects to repeat"},
        {"object a { 3 * { scale: 0.5 } { sphere } scale: 2 }", "'scale' has no object to apply to"},
        {"object a { sphere\n 3 * { scale: 0.5 } { scale: 2 cube } }", "'scale' has no object to apply to"},
        {"object a { 3 * { scale: 0.5 } { sphere ", "expected '}' at the end of the repeated objects"},
        {"object a { sphere\n 3 * { scale: 0.5 } terminal: cube }", "a repeat cannot contain a terminal"},
        {"object a { 3 * { scale 0.5 } scatter sphere 5 over disc 3 }", "a repeat cannot contain a scatter"},
        {"object a { 3 * { tint 1, 0, 0, 1 .. 0, 0, 1, 1 } sphere }",
         "a range of tints belongs to a scatter"},
    };
    for (const auto& [text, message] : cases) {
        const InstModel model(text);
        EXPECT_FALSE(model.graph) << text;
        EXPECT_THAT(model.said(), HasSubstr(message)) << text;
    }
}

TEST(Repeat, no_copies_are_made_beyond_the_limits) {
    LowerOptions options;
    options.max_objects = 1000;
    const InstModel model(
        "canonical object b { sphere }\nobject a { 2000 * { translate: 1, 0, 0 } { b\n b\n b } }", options);
    EXPECT_FALSE(model.graph);
    EXPECT_THAT(model.said(), HasSubstr("the model has more than 4000 instances"));
}

TEST(Repeat, nests_to_a_limit) {
    const auto nested = [](std::size_t depth) {
        std::string text = "object a {";
        for (std::size_t i = 0; i < depth; ++i)
            text += " 1 * { rotate: y, 1 }";
        return text + " sphere }";
    };
    EXPECT_TRUE(InstModel(nested(256)).graph);
    for (const std::size_t depth : {257u, 100'000u}) {
        const InstModel model(nested(depth));
        EXPECT_FALSE(model.graph);
        EXPECT_THAT(model.said(), HasSubstr("repeats nest more than 256 deep"));
    }
}

TEST(Repeat, too_many_copies_are_refused) {
    for (const char* text :
         {"object a { 4000000 * { translate: 1, 0, 0 } sphere }",
          "object a { 4000000 * { translate: 1, 0, 0 } 4000000 * { translate: 0, 1, 0 } sphere }",
          "object a { 2000 * { translate: 1, 0, random(0, 1) } 2000 * { translate: 0, 1, 0 } sphere }"}) {
        const InstModel model(text);
        EXPECT_FALSE(model.graph) << text;
        EXPECT_THAT(model.said(), HasSubstr("1:12: error: the repeats of the model make too many copies"));
    }
}

TEST(Repeat, each_of_50000_shared_parts_has_its_name_at_once) {
    const InstModel model("canonical object f(0) { sphere }\ncanonical object f(n) {\n"
                          " 2 * { translate: 1, 0, 0 } 2 * { translate: 0, 1, 0 } sphere\n f(n - 1) }\n"
                          "object a { f(50000) }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.object("f.repeat50000").instances.size(), 2u);
}

TEST(Repeat, objects_may_have_the_names_of_the_new_words) {
    const InstModel model(
        "canonical object repeat { sphere }\ncanonical object hue { cube }\n"
        "canonical object weight { cone }\nobject a { repeat\n hue\n weight, repeat scale: 2\n}");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.root().instances.size(), 4u);
}

// Alternatives and random numbers

TEST(Alternatives, are_chosen_by_their_weights) {
    const InstModel model(
        "canonical object leaf weight 3 { sphere }\ncanonical object leaf weight 1 { cube }\n"
        "object a { 400 * { translate: 1, 0, 0 } leaf }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.root().instances.size(), 400u);
    EXPECT_LE(model.graph->objects.size(), 64u + 3u) << "a pool of variants, and not an object a place";
    std::size_t spheres = 0;
    for (const Instance& instance : model.root().instances)
        spheres += model.master(model.master(instance).instances.front()).name == "sphere";
    EXPECT_NEAR(static_cast<double>(spheres), 300, 45); // 5 standard deviations
    std::set<std::string> cubes;
    for (const Object& object : model.graph->objects)
        if (object.name.starts_with("leaf.v") && model.master(object.instances.front()).name == "cube")
            cubes.insert(object.name);
    EXPECT_NEAR(static_cast<double>(cubes.size()), 16, 1.1) << "of 64 variants";
    expect_printed_graph_reads_back(model);
}

TEST(Alternatives, depend_on_the_seed_and_on_nothing_else) {
    const std::string text =
        "canonical object t(0) { sphere }\n"
        "canonical object t(n) weight n { t(n-1) rotate: z, random(-30, 30) translate: 0, 1, 0 }\n"
        "canonical object t(n) weight 2 { union: t(n-1), t(n-1) scale: 0.6 translate: 1, 1, 0 }\n";
    const std::string root = "object a { t(8) }\n";
    const InstModel model(text + root), again(text + root), other(text + root, seeded(7));
    const InstModel with_more("canonical object x { cube scale random(1, 2) }\n" + text + root);
    ASSERT_TRUE(model.graph && other.graph && with_more.graph) << model.said() << with_more.said();
    EXPECT_EQ(print(*model.graph), print(*again.graph));
    EXPECT_NE(print(*model.graph), print(*other.graph));
    EXPECT_EQ(print(*model.graph), print(*with_more.graph)) << "another object that nothing reaches";
    expect_printed_graph_reads_back(other);
}

TEST(Alternatives, may_be_recursions_without_end) {
    const InstModel model(
        "canonical object r weight 2 { sphere\n r scale: 0.8 translate: 1, 0, 0 }\n"
        "canonical object r weight 1 { cube\n r scale: random(0.5, 0.7) rotate: y, 40 translate: 1, 0, 0 }\n"
        "object a { r }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_LE(model.graph->objects.size(), 64u + 3u);
    expect_printed_graph_reads_back(model);
}

TEST(Alternatives, of_a_drawn_object_are_one_of_them) {
    std::set<std::string> seen;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const InstModel model("object a weight 1 { sphere }\nobject a weight 1 { cube }", seeded(seed));
        ASSERT_TRUE(model.graph) << model.said();
        ASSERT_EQ(model.root().instances.size(), 1u);
        seen.insert(model.master(model.root().instances.front()).name);
    }
    EXPECT_EQ(seen.size(), 2u);
}

TEST(Alternatives, mistakes_end_in_messages) {
    const std::pair<const char*, const char*> cases[] = {
        {"object a weight 1 { sphere }\nobject a { cube }", "duplicate object 'a'"},
        {"object a weight 1 { sphere }\ncanonical object a weight 1 { cube }",
         "must all be canonical, or none of them"},
        {"object a weight 0 { sphere }\nobject a weight 0 { cube }", "the weights of 'a' are all 0"},
        {"object a weight 0-1 { sphere }\nobject a weight 1 { cube }", "a weight lies between 0 and 1e+100"},
        {"object a weight x { sphere }\nobject a weight 1 { cube }", "unknown name 'x'"},
        {"object a weight 1/0 { sphere }\nobject a weight 1 { cube }", "division by zero"},
        {"object a weight 1e308 { sphere }\nobject a weight 1 { cube }", "not at 1e+308"},
        {"object a weight 1e308 * 10 { sphere }\nobject a weight 1 { cube }", "is not a finite number"},
        {"object a weight x { sphere }", "unknown name 'x'"},
        {"object a weight 0 { sphere }", "the weights of 'a' are all 0"},
        {"let x = random(0, 1)\nobject a { sphere }", "only the lines of an object"},
    };
    for (const auto& [text, message] : cases) {
        const InstModel model(text);
        EXPECT_FALSE(model.graph) << text;
        EXPECT_THAT(model.said(), HasSubstr(message)) << text;
    }
}

TEST(Alternatives, that_are_too_many_to_weigh_are_refused) {
    std::string text = "canonical object f(0) { sphere }\nobject a { f(10000) }\n";
    for (int i = 0; i < 2000; ++i)
        text += "canonical object f(n) weight n { f(n - 1) }\n";
    const InstModel model(text);
    EXPECT_FALSE(model.graph);
    EXPECT_THAT(model.said(), HasSubstr("the model takes too much work to list all its objects"));
}

TEST(RandomNumbers, make_a_hundred_thousand_primitives_at_once) {
    const InstModel model(
        "object a { 100000 * { translate: 1, 0, 0 } superellipsoid(random(0.1, 2), random(0.1, 2)) }");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_GT(model.graph->objects.size(), 99'000u);
    const InstModel one("object a { 5 * { translate: 1, 0, 0 } superellipsoid(0.5, random(0.5, 0.5)) }");
    ASSERT_TRUE(one.graph) << one.said();
    EXPECT_EQ(one.graph->objects.size(), 2u);
}

TEST(RandomNumbers, are_spread_over_the_variants) {
    const InstModel model(
        "canonical object b { sphere scale: random(1, 2) }\nobject a { 500 * { translate: 1, 0, 0 } b }");
    ASSERT_TRUE(model.graph) << model.said();
    double sum = 0, variants = 0;
    for (const Object& object : model.graph->objects) {
        if (!object.name.starts_with("b.v")) continue;
        const double scale = object.instances.front().parent_from_child.linear[0][0];
        EXPECT_GE(scale, 1);
        EXPECT_LT(scale, 2);
        sum += scale;
        ++variants;
    }
    EXPECT_EQ(variants, 64);
    EXPECT_NEAR(sum / variants, 1.5, 0.01) << "stratified";
}

TEST(RandomNumbers, may_stand_in_every_line) {
    const InstModel model(
        "canonical object f(n) { sphere scale: n }\n"
        "object a {\n"
        " repeat random(3, 4) { translate: 1, random(0, 1), 0 hue: random(0, 9) tint: 1, 0, 0, random(0, 1) "
        "}\n"
        " sphere tint: hsv(random(80, 120), 0.8, 0.4), 1\n"
        " f(random(1, 2)) tint: random(0, 1), 0, 0, 1 hue: normal(0, 20) chance: random(1, 2)\n"
        " terminal: sphere below: random(2, 3) scale: random(1, 2)\n}");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.root().instances.size(), 4u);
    expect_printed_graph_reads_back(model);
}

TEST(RandomNumbers, differ_between_the_copies_of_a_repeat) {
    const InstModel model("object a { 50 * { translate: 1, 0, random(0, 1) } sphere scale: random(1, 2) }");
    ASSERT_TRUE(model.graph) << model.said();
    std::set<double> sizes, steps;
    double last = 0;
    for (const Instance& instance : model.root().instances) {
        sizes.insert(instance.parent_from_child.linear[0][0]);
        steps.insert(instance.parent_from_child.translation.z - last);
        last = instance.parent_from_child.translation.z;
    }
    EXPECT_GT(sizes.size(), 45u);
    EXPECT_GT(steps.size(), 45u);
}

TEST(RandomNumbers, places_of_a_scatter_hold_different_variants) {
    const InstModel model(
        "canonical object b { sphere scale: random(0.1, 0.2) }\nobject a { scatter b 100 over disc 50 }");
    ASSERT_TRUE(model.graph) << model.said();
    std::set<ObjectId> masters;
    for (const Instance& instance : model.root().instances)
        masters.insert(instance.master);
    EXPECT_GT(masters.size(), 40u);
    EXPECT_LE(masters.size(), 64u);
}

// Colours

TEST(Hsv, is_a_colour_wherever_one_stands) {
    const InstModel model("material m { color: hsv(120, 1, 0.5) }\nbackground: hsv(240, 0.5, 1)\n"
                          "object a { sphere tint: hsv(0, 1, 0.8), 0.5\n cube material: m }");
    ASSERT_TRUE(model.graph) << model.said();
    expect_close(model.root().instances[0].tint.rgb, {0.8, 0, 0});
    EXPECT_EQ(model.root().instances[0].tint.alpha, 0.5);
    expect_close(model.graph->materials[0].rgb, {0, 0.5, 0});
    expect_close(model.graph->settings.background->rgb, {0.5, 0.5, 1});
    for (const char* text :
         {"object a { sphere tint: hsv(0, 1.2, 1), 1 }", "object a { sphere tint: hsv(0, 1), 1 }",
          "object a { sphere tint: hsv(0, 1, 2), 1 }", "object a { sphere tint: hsv(0, 1, 1) }"})
        EXPECT_FALSE(InstModel(text).graph) << text;
}

TEST(Hue, turning_keeps_saturation_and_value) {
    expect_close(hue_turned({0.8, 0.2, 0.2}, 1.0 / 3), {0.2, 0.8, 0.2});
    expect_close(hue_turned({1, 0, 0}, 1.0 / 6), {1, 1, 0});
    expect_close(hue_turned({0.3, 0.9, 0.6}, 1), {0.3, 0.9, 0.6});
    EXPECT_EQ(hue_turned({0.3, 0.3, 0.3}, 0.4), Rgb(0.3));
    for (int i = 0; i < 360; ++i)
        expect_close(hue_turned(rgb_from_hsv(i, 0.7, 0.9), 77.0 / 360), rgb_from_hsv(i + 77, 0.7, 0.9));
}

TEST(Hue, turns_are_exact_fractions) {
    EXPECT_EQ(exact_turn(30), (HueTurn{1, 12}));
    EXPECT_EQ(exact_turn(-30), (HueTurn{11, 12}));
    EXPECT_EQ(exact_turn(720), (HueTurn{0, 1}));
    EXPECT_EQ(exact_turn(360.0 / 7), (HueTurn{1, 7}));
    EXPECT_EQ(exact_turn(360.0 / 3600), (HueTurn{1, 3600}));
    EXPECT_EQ(exact_turn(7.1), (HueTurn{71, 3600}));
    EXPECT_FALSE(exact_turn(7.123));
    EXPECT_FALSE(exact_turn(std::sqrt(2)));
    EXPECT_EQ(whole_degrees(7.123), (HueTurn{7, 360}));
    EXPECT_EQ(sum(HueTurn{1, 6}, HueTurn{1, 2}), (HueTurn{2, 3}));
    EXPECT_EQ(sum(HueTurn{5, 6}, HueTurn{1, 6}), (HueTurn{0, 1}));
    EXPECT_FALSE(sum(HueTurn{1, 3599}, HueTurn{1, 3581}));
    EXPECT_FALSE(sum(HueTurn{1, 3599}, HueTurn{1, 277})) << "a million states";
}

TEST(Hue, goes_round_with_a_recursion) {
    const InstModel model(
        "canonical object arm { sphere tint: 1, 0, 0, 1\n arm scale: 0.9 translate: 2, 0, 0 hue: 30 }\n"
        "object a { arm }");
    ASSERT_TRUE(model.graph) << model.said();
    const Object* object = &model.master(model.root().instances.front());
    for (int depth = 0; depth < 30; ++depth) {
        expect_close(object->instances[0].tint.rgb, rgb_from_hsv(30 * depth, 1, 1));
        object = &model.master(object->instances[1]);
    }
    EXPECT_EQ(std::ranges::count_if(model.graph->objects,
                                    [](const Object& o) { return o.name.starts_with("arm"); }),
              12);
    expect_printed_graph_reads_back(model);
}

TEST(Hue, turns_materials_and_used_objects_alike_in_a_repeat) {
    const InstModel model("material m { color: 0.5, 0.1, 0.1 }\nmaterial grey { color: 0.2, 0.2, 0.2 }\n"
                          "canonical object b { sphere material: m\n cube material: grey\n cone }\n"
                          "object a { 3 * { translate: 3, 0, 0 hue: 120 } b tint: 0, 0, 1, 0.5 }");
    ASSERT_TRUE(model.graph) << model.said();
    const Rgb materials[] = {{0.5, 0.1, 0.1}, {0.1, 0.5, 0.1}, {0.1, 0.1, 0.5}};
    const Rgb tints[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Instance& copy = model.root().instances[i];
        expect_close(copy.tint.rgb, tints[i]);
        const Object& b = model.master(copy);
        expect_close(model.graph->materials[*b.instances[0].material].rgb, materials[i]);
        EXPECT_EQ(model.graph->materials[*b.instances[1].material].name, "grey");
        EXPECT_FALSE(b.instances[2].material);
    }
    expect_printed_graph_reads_back(model);
}

TEST(Hue, what_cannot_be_exact_is_said) {
    const InstModel rounded(
        "canonical object arm { sphere tint: 1, 0, 0, 1\n arm scale: 0.9 translate: 2, 0, 0 hue: 7.123 }\n"
        "object a { arm }");
    ASSERT_TRUE(rounded.graph);
    EXPECT_THAT(rounded.said(), HasSubstr("note: the hue turns by 7 degrees, not by 7.123"));
    LowerOptions options;
    options.max_objects = 500;
    const InstModel many(
        "canonical object arm { sphere tint: 1, 0, 0, 1\n arm scale: 0.9 translate: 2, 0, 0 hue: 0.1 }\n"
        "object a { arm }",
        options);
    EXPECT_FALSE(many.graph);
    EXPECT_THAT(many.said(), HasSubstr("the turns of hues make more than 500 objects"));
    const InstModel twice("object a { sphere hue: 10 hue: 20 }");
    EXPECT_THAT(twice.said(), HasSubstr("duplicate 'hue'"));
    const InstModel alone("object a { hue: 10 sphere }");
    EXPECT_THAT(alone.said(), HasSubstr("'hue' has no object to apply to"));
}

TEST(RandomNumbers, leave_counts_and_hues_beside_them_exact) {
    // Where a group drew a random number anywhere, 22.5 degrees became 23, and 2.5 copies 2.
    const InstModel turned(
        "object o { 16 * { rotate: y, 22.5  hue: 22.5 } sphere scale: random(1, 2) tint: 1, 0, 0, 1 }");
    ASSERT_TRUE(turned.graph) << turned.said();
    EXPECT_EQ(turned.said(), "");
    const std::vector<Instance>& copies = turned.root().instances;
    ASSERT_EQ(copies.size(), 16u);
    const Rgb opposite = copies[8].tint.rgb; // cyan
    EXPECT_NEAR(opposite.r, 0, 1e-12);
    EXPECT_NEAR(opposite.g, opposite.b, 1e-12);
    EXPECT_THAT(InstModel("object o { 2.5 * { rotate: y, 9 } sphere scale: random(1, 2) }").said(),
                HasSubstr("a repeat makes a whole number of copies, from 1 to"));
    const InstModel random("object o { (random(2, 2.9)) * { rotate: y, 9 } sphere }");
    ASSERT_TRUE(random.graph) << random.said();
    EXPECT_EQ(random.root().instances.size(), 2u);
}

} // namespace
} // namespace graftal
