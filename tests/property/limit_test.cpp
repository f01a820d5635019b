// Limits of L-systems against the iterated function systems that they equal (Prusinkiewicz and Hammel 1994),
// and against long finite derivations.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/analysis/counts.h"
#include "compiler/languages/lower.h"
#include "compiler/session/values.h"
#include "tests/property/nearest.h"

namespace graftal {
namespace {

using ::graftal::testing::farthest_from;

/// A share of the set's radius: points stand for parts of this size.
constexpr double resolution = 1.0 / 300;

struct LimitSet {
    std::vector<Vec3> points;
    double radius = 0;
    double dimension = 0;
};

void gather(const AnalysedModel& model, ObjectId id, const Affine& place, double least, LimitSet& set) {
    const Ball& ball = model.bounds[id].ball;
    if (norm(place.linear) * ball.radius <= least) {
        set.points.push_back(place(ball.centre));
        return;
    }
    for (const Instance& instance : model.graph.objects[id].instances)
        gather(model, instance.master, place * instance.parent_from_child, least, set);
    if (model.graph.objects[id].primitive) // a segment of some width: its axis
        for (double t = 0; t <= 1; t += least / (2 * norm(place.linear)))
            set.points.push_back(place({0, t, 0}));
}

LimitSet limit_set(const std::string& name, const std::string& text) {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph = lower_text(name, text, {}, sources, diagnostics).graph;
    if (!graph) {
        ADD_FAILURE() << diagnostics.render(sources);
        return {};
    }
    AnalysedModel model;
    model.graph = std::move(*graph);
    model.components = strong_components(model.graph);
    model.contraction = decide_contraction(model.graph, model.components);
    EXPECT_EQ(model.contraction.verdict, Verdict::proved) << text;
    model.bounds = bound_objects(model.graph, model.components, model.contraction);
    LimitSet set;
    set.radius = model.bounds[model.graph.root].ball.radius;
    set.dimension = similarity_dimension(model.graph, model.components).value_or(0);
    gather(model, model.graph.root, {}, resolution * set.radius, set);
    return set;
}

void expect_same(const std::string& lsys, const std::string& rifs, double slack = 0) {
    const LimitSet a = limit_set("a.lsys", lsys), b = limit_set("b.rifs", rifs);
    ASSERT_FALSE(a.points.empty() || b.points.empty());
    EXPECT_NEAR(a.dimension, b.dimension, 1e-9);
    // A point stands for a ball of at most this radius.
    const double error = 2 * resolution * std::max(a.radius, b.radius) + slack;
    const double there = farthest_from(b.points, a.points), back = farthest_from(a.points, b.points);
    EXPECT_LE(there, error) << lsys;
    EXPECT_LE(back, error) << lsys;
    std::printf("error %.4g: lsys to rifs %.4g, rifs to lsys %.4g (of radius %.4g)\n", error, there, back,
                a.radius);
}

TEST(Limit, Koch) {
    expect_same("lsys koch {\nangle 60\nsteps infinite\naxiom F\nF -> F+F--F+F\n}",
                R"(rifs koch {
  map a { scale 1/3 }
  map b { scale 1/3  rotate z 60  translate <0, 1/3, 0> }
  map c { scale 1/3  rotate z -60  translate <-sin(60)/3, 1/2, 0> }
  map d { scale 1/3  translate <0, 2/3, 0> }
})");
}

TEST(Limit, Dragon) {
    expect_same("lsys dragon {\nmodules l r\nsteps infinite\naxiom l\nl -> l+r+\nr -> -l-r\ninterpret {\nl "
                "-> F\nr -> F\n}\n}",
                R"(rifs dragon {
  map a { scale 1/sqrt(2)  rotate z -45 }
  map b { scale 1/sqrt(2)  rotate z -135  translate <0, 1, 0> }
})");
}

/// F and G are mirror images, of each other and of their levels before: the limit is that of even numbers of
/// steps.
TEST(Limit, SierpinskiByEdges) {
    expect_same("lsys gasket {\nangle 60\nsteps infinite\naxiom F\nF -> G-F-G\nG -> F+G+F\n}",
                R"(rifs gasket {
  map a { scale 1/2 }
  map b { scale 1/2  translate <0, 1/2, 0> }
  map c { scale 1/2  translate <-sin(60)/2, 1/4, 0> }
})");
}

/// F doubles, X_n is about 2^(n+1) long: a stem of half the height, two branches half way up it, a top.
TEST(Limit, BranchingPlant) {
    expect_same("lsys plant {\nangle 25.7\nsteps infinite\naxiom X\nX -> F[+X][-X]FX\nF -> FF\n}",
                R"(rifs plant {
  map left  { scale 1/2  rotate z 25.7  translate <0, 1/4, 0> }
  map right { scale 1/2  rotate z -25.7  translate <0, 1/4, 0> }
  map top   { scale 1/2  translate <0, 1/2, 0> }
  condense cylinder scale <0.0001, 1/2, 0.0001>
})",
                0.001);
}

TEST(Limit, ParametricTree) {
    expect_same("lsys tree {\nsteps infinite\naxiom A(1,0.0002)\nA(l,w) -> "
                "!(w)F(l)[+(30)A(l*0.5,w*0.5)][-(40)A(l*0.6,w*0.6)]\n}",
                R"(rifs tree {
  map left  { scale 0.5  rotate z 30  translate <0, 1, 0> }
  map right { scale 0.6  rotate z -40  translate <0, 1, 0> }
  condense cylinder scale <0.0001, 1, 0.0001>
})",
                0.001);
}

} // namespace
} // namespace graftal
