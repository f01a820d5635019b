#include <cmath>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "compiler/graph/text/print.h"
#include "compiler/inst/scatter_points.h"
#include "compiler/languages/lower.h"
#include "compiler/support/stage_work.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

std::string errors_of(const std::string& text) {
    SourceMap sources;
    Diagnostics diagnostics;
    EXPECT_FALSE(lower_text("m.inst", text, {}, sources, diagnostics).graph) << text;
    return diagnostics.render(sources);
}

Graph graph_of(const std::string& text, const LowerOptions& options = {}) {
    SourceMap sources;
    Diagnostics diagnostics;
    const std::optional<Graph> graph = lower_text("m.inst", text, options, sources, diagnostics).graph;
    EXPECT_TRUE(graph) << diagnostics.render(sources);
    return graph.value_or(Graph());
}

/// What stands in the only object, which holds nothing but a scatter with these lines.
std::vector<Instance> scattered(const std::string& lines, const std::string& before = "",
                                const LowerOptions& options = {}) {
    const Graph graph = graph_of(before + "\nobject o {\n" + lines + "\n}\n", options);
    return graph.objects.empty() ? std::vector<Instance>() : graph.objects[graph.root].instances;
}

Vec2 place(const Instance& instance) {
    const Vec3 t = instance.parent_from_child.translation;
    return {t.x, t.z};
}

std::vector<Vec2> places(const std::vector<Instance>& instances) {
    std::vector<Vec2> out;
    for (const Instance& instance : instances)
        out.push_back(place(instance));
    return out;
}

double least_distance(const std::vector<Vec2>& points) {
    double least = INFINITY;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, glm::distance(points[i], points[j]));
    return least;
}

TEST(Scatter, the_line_of_the_issue_places_what_it_says) {
    const std::string ground = "ground { height: 2  area: disc 60, 5, 5 }";
    const std::vector<Instance> trees = scattered("scatter cone over ground 200 by poisson seed 7", ground);
    ASSERT_EQ(trees.size(), 200u);
    EXPECT_GE(least_distance(places(trees)), loose_distance(FlatArea::round({5, 5}, 60).size(), 200));
    for (const Instance& tree : trees) {
        EXPECT_LE(glm::distance(place(tree), Vec2(5, 5)), 60);
        EXPECT_EQ(tree.parent_from_child.translation.y, 2);
        EXPECT_EQ(tree.parent_from_child.linear, Mat3(1.0));
        EXPECT_EQ(tree.tint, Tint());
    }
    EXPECT_EQ(places(trees),
              places(scattered("scatter: cone  seed: 7  by: poisson  over: ground  count: 200", ground)));
}

TEST(Scatter, ground_without_an_area_lies_before_the_camera) {
    const std::vector<Instance> trees = scattered("scatter: cone  count: 300  over: ground  by: uniform",
                                                  "camera { location: 3, 9, 40  look_at: 3, 1, 10 }");
    double farthest = 0;
    for (const Instance& tree : trees)
        farthest = std::max(farthest, glm::distance(place(tree), Vec2(3, 10)));
    EXPECT_LE(farthest, 30);
    EXPECT_GT(farthest, 28);
}

TEST(Scatter, every_order_gives_the_count_inside_what_is_left_of_the_area) {
    for (const std::string order : {"poisson", "uniform", "jitter", "spiral"})
        for (const std::string area : {"-3, -5, 8, 1", "disc 4", "disc 0.01, 1e3, 1", "0, 0, 1000, 0.01"})
            for (const int count : {1, 2, 7, 500}) {
                const std::vector<Instance> found = scattered(
                    "scatter: cube  by: " + order + "  over: " + area + "  count: " + std::to_string(count));
                EXPECT_EQ(found.size(), static_cast<std::size_t>(count)) << order << " " << area;
            }
    for (const std::string order : {"poisson", "uniform", "jitter", "spiral"}) {
        const std::vector<Instance> found =
            scattered("scatter: cube  over: -5, -5, 5, 5  except: disc 3  except: "
                      "5, 5, -1, -1  count: 400  by: " +
                      order);
        ASSERT_EQ(found.size(), 400u) << order;
        for (const Vec2 p : places(found)) {
            EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 5);
            EXPECT_GT(glm::length(p), 3);
            EXPECT_TRUE(p.x < -1 || p.y < -1);
        }
    }
}

TEST(Scatter, poisson_keeps_the_distance_and_fills_the_area_where_no_count_is_given) {
    const std::vector<Vec2> points =
        places(scattered("scatter: cube  over: 0, 0, 30, 20  apart: 1.25  except: disc 4, 10, 10"));
    EXPECT_GE(least_distance(points), 1.25);
    // No place is left: wherever one looks, another stands near. Of many looks few may find a gap.
    int gaps = 0, looks = 0;
    for (double x = 0.05; x < 30; x += 0.1)
        for (double y = 0.05; y < 20; y += 0.1) {
            if (glm::distance(Vec2(x, y), Vec2(10, 10)) <= 4) continue;
            ++looks;
            gaps += std::none_of(points.begin(), points.end(),
                                 [&](Vec2 p) { return glm::distance(p, Vec2(x, y)) < 1.25; });
        }
    EXPECT_LE(gaps, looks / 300);
}

TEST(Scatter, says_how_many_fit) {
    const std::string text = "object o { scatter: cube  over: 0, 0, 3, 3  count: 100  apart: 1 }";
    const std::string said = errors_of(text);
    EXPECT_THAT(said, HasSubstr("only 9 of 100 places fit 1 apart"));
}

TEST(Scatter, more_than_the_graph_has_room_for_are_refused_before_they_are_made) {
    EXPECT_THAT(errors_of("object o { scatter: cube  over: disc 1  apart: 1e-9 }"),
                HasSubstr("more than 4000000 places fit"));
    EXPECT_THAT(errors_of("object o { scatter: cube  over: disc 1  count: 1e15 }"),
                HasSubstr("room for 4000000 more instances"));
}

TEST(Scatter, jitter_has_one_in_each_cell) {
    const std::vector<Vec2> points =
        places(scattered("scatter: cube  by: jitter  over: 0,0,10,10  count: 100"));
    std::map<std::pair<int, int>, int> cells;
    for (const Vec2 p : points)
        ++cells[{static_cast<int>(p.x), static_cast<int>(p.y)}];
    EXPECT_EQ(cells.size(), 100u);
}

TEST(Scatter, spiral_gives_each_as_much_room) {
    const std::vector<Vec2> points =
        places(scattered("scatter: cube  by: spiral  over: disc 10  count: 1000"));
    for (std::size_t i = 0; i < points.size(); ++i) // the i-th lies on the circle that holds i others
        EXPECT_NEAR(glm::dot(points[i], points[i]), (static_cast<double>(i) + 0.5) / 10, 1e-9);
    EXPECT_GT(least_distance(points), 0.4);
}

TEST(Scatter, a_number_on_a_line_of_its_own_is_the_count_also_after_an_axis) {
    EXPECT_EQ(scattered("scatter: cube\nover: disc 9\nby: uniform\nturn: y\n40").size(), 40u);
    EXPECT_EQ(scattered("scatter: cube\nover: disc 9\nby: uniform\ncount: 7\nturn: y,\n40").size(), 7u);
}

TEST(Scatter, turns_sizes_and_leans_stay_in_their_ranges_and_use_all_of_them) {
    const std::vector<Instance> found = scattered(
        "scatter: cube  count: 2000  over: disc 9  by: uniform  size: 0.5..2  turn: y, 30..90  lean: 0..10");
    double least = 9, most = 0, upright = 1;
    for (const Instance& instance : found) {
        const Mat3& m = instance.parent_from_child.linear;
        const Vec3 s = singular_values(m);
        EXPECT_NEAR(s.x, s.z, 1e-14 * s.x); // uniform
        EXPECT_GT(glm::determinant(m), 0);
        least = std::min(least, s.x);
        most = std::max(most, s.x);
        upright = std::min(upright, m[1].y / s.x);
        const double turn = std::atan2(-m[0].z, m[0].x) * 180 / 3.14159265358979;
        EXPECT_GT(turn, 30 - 1);
        EXPECT_LT(turn, 90 + 1);
    }
    EXPECT_NEAR(least, 0.5, 0.01);
    EXPECT_NEAR(most, 2, 0.01);
    EXPECT_NEAR(std::acos(upright) * 180 / 3.14159265358979, 10, 0.1);
}

TEST(Scatter, a_turn_about_an_axis_is_the_rotation_about_it) {
    for (const char axis : {'x', 'y', 'z'}) {
        const std::string turn = std::string("  turn: ") + axis + ", 70";
        const Mat3 m = scattered("scatter: cube  count: 1  over: disc 1" + turn)[0].parent_from_child.linear;
        Vec3 about(0.0);
        about[axis - 'x'] = 1;
        EXPECT_LT(largest_entry(m - Affine::rotate(about, 70).linear), 1e-15);
    }
}

TEST(Scatter, transforms_come_after_for_all) {
    const std::vector<Instance> plain = scattered("scatter: cube  count: 5  over: disc 3  turn: y  seed: 1");
    const std::vector<Instance> moved =
        scattered("scatter: cube  count: 5  over: disc 3  scale: 2  turn: y  translate: 0, 1, 0  seed: 1");
    const Affine after = Affine::translate({0, 1, 0}) * Affine::scale(Vec3(2.0));
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(moved[i].parent_from_child, after * plain[i].parent_from_child);
}

TEST(Scatter, tints_lie_between_the_two_given) {
    const std::vector<Instance> found =
        scattered("scatter: cube  count: 200  over: disc 3  tint: 1, 0, 0, 0.2 .. 0, 0, 1, 0.6");
    double low = 1, high = 0;
    for (const Instance& instance : found) {
        const double t = instance.tint.rgb.b;
        EXPECT_NEAR(instance.tint.rgb.r, 1 - t, 1e-15);
        EXPECT_NEAR(instance.tint.alpha, 0.2 + 0.4 * t, 1e-15);
        low = std::min(low, t);
        high = std::max(high, t);
    }
    EXPECT_LT(low, 0.05);
    EXPECT_GT(high, 0.95);
}

TEST(Scatter, weights_decide_how_often) {
    std::map<ObjectId, int> times;
    for (const Instance& instance :
         scattered("scatter: cube, cone, sphere  weights: 3, 0, 1  count: 4000  over: disc 3  by: uniform"))
        ++times[instance.master];
    ASSERT_EQ(times.size(), 2u);
    EXPECT_NEAR(times.begin()->second, 3000, 100);
}

TEST(Scatter, one_line_more_leaves_the_others_where_they_are) {
    const std::string lines = "scatter: cube  count: 50  over: disc 3  seed: 5";
    EXPECT_EQ(places(scattered(lines)), places(scattered(lines + "  size: 1..2  tint: 0,0,0,0 .. 1,1,1,1")));
    EXPECT_NE(places(scattered(lines)), places(scattered("scatter: cube  count: 50  over: disc 3  seed: 6")));
}

TEST(Scatter, two_of_one_file_differ_and_the_command_line_changes_both) {
    const std::string lines =
        "scatter: cube  count: 50  over: disc 3\nscatter: cone  count: 50  over: disc 3";
    LowerOptions options;
    options.seed = 3;
    const std::vector<Vec2> own = places(scattered(lines)), asked = places(scattered(lines, "", options));
    ASSERT_EQ(own.size(), 100u);
    EXPECT_GT(least_distance({own[0], own[50]}), 0);
    EXPECT_GT(least_distance({asked[0], asked[50]}), 0);
    EXPECT_NE(own[0], asked[0]);
    EXPECT_NE(own[50], asked[50]);
}

TEST(Scatter, objects_with_parameters_scatter_by_them) {
    const Graph graph =
        graph_of("canonical object grove(n) { scatter: cone  count: n  over: disc n  seed: n }\n"
                 "object o { grove(3), grove(5) }");
    std::map<std::string, std::size_t> sizes;
    for (const Object& object : graph.objects)
        sizes[object.name] = object.instances.size();
    EXPECT_EQ(sizes["grove(3)"], 3u);
    EXPECT_EQ(sizes["grove(5)"], 5u);
}

TEST(Scatter, prints_as_what_it_became_and_reads_back_equal) {
    const Graph graph =
        graph_of("ground { area: disc 3, 1, 2 }\nobject o { scatter: cone, cube  count: 60  over: "
                 "ground  turn: y  lean: 9  size: 1..2  tint: 0,0,0,0 .. 1,1,1,1 }");
    EXPECT_TRUE(equal(graph, graph_of(print(graph))));
}

TEST(Scatter, its_words_are_still_names_elsewhere) {
    const Graph graph = graph_of("canonical object scatter { sphere }\ncanonical object size { cube }\n"
                                 "object o {\n  size\n  scatter\n  union: size, scatter\n}");
    EXPECT_EQ(graph.objects[graph.root].instances.size(), 4u);
}

/// The same bytes on all machines: numbers that were computed elsewhere.
TEST(Scatter, is_the_same_everywhere) {
    const std::vector<Instance> found =
        scattered("scatter: cube  count: 3  over: 0,0,10,10  seed: 7  turn: y");
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(place(found[2]), Vec2(8.108419822696831, 6.433267244309744));
    EXPECT_EQ(found[2].parent_from_child.linear[0].x, -0.04889097248684727);
}

TEST(Scatter, a_hundred_thousand_take_no_time_to_speak_of) {
    const std::vector<Instance> found = scattered("scatter: cube  count: 100000  over: disc 1000");
    EXPECT_EQ(found.size(), 100'000u);
}

/// Whether the lines of a scatter of spheres take more work than these seconds.
bool takes_more(double seconds, const std::string& lines) {
    StageWork work(seconds);
    LowerHelp help;
    help.control.work = &work;
    SourceMap sources;
    Diagnostics diagnostics;
    try {
        lower_text("m.inst", "object o {\nscatter: sphere\n" + lines + "\n}\n", {}, sources, diagnostics,
                   help);
    } catch (const OutOfWork&) {
        return true;
    }
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
    return false;
}

TEST(Scatter, counts_places_that_lie_outside_and_exceptions) {
    // Hardly a place of a spiral lies in a long strip: this took hours.
    EXPECT_TRUE(takes_more(0.1, "over: 0, 0, 1e9, 1  count: 1000  by: spiral"));
    EXPECT_FALSE(takes_more(0.1, "over: 0, 0, 10, 1  count: 1000  by: spiral"));
    std::string exceptions;
    for (int i = 0; i < 20'000; ++i)
        exceptions += "except: 11, 11, 12, 12\n";
    EXPECT_TRUE(takes_more(1, "over: 0, 0, 10, 10  count: 1000\n" + exceptions));
    EXPECT_FALSE(takes_more(0.1, "over: 0, 0, 10, 10  count: 1000\nexcept: 1, 1, 2, 2"));
}

TEST(Scatter, ranges_have_a_width) {
    EXPECT_THAT(errors_of("object o { scatter: sphere  over: disc 1  count: 3\nturn: -1e308..1e308 }"),
                HasSubstr("the ends of this 'turn' lie too far apart"));
}

} // namespace
} // namespace graftal
