// Words in which little repeats are drawn into a run: the same drawing, without objects.

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "compiler/graph/run.h"
#include "tests/unit/lsys/turtle.h"

namespace graftal::testing {
namespace {

constexpr std::uint64_t always = 0, never = std::numeric_limits<std::uint64_t>::max();

CompiledLsys compiled(const std::string& statements, unsigned steps, std::uint64_t run_from) {
    LowerOptions options;
    options.exact = true;
    options.run_from = run_from;
    return CompiledLsys(statements, steps, options);
}

std::size_t run_items(const Graph& graph) {
    std::size_t count = 0;
    for (const Object& object : graph.objects)
        count += object.packed.item_count();
    return count;
}

struct RunCase {
    const char* name;
    const char* statements;
    unsigned steps;
};

class LsysRun : public ::testing::TestWithParam<RunCase> {};

TEST_P(LsysRun, DrawsWhatTheWordDraws) {
    const RunCase& model = GetParam();
    const CompiledLsys shared = compiled(model.statements, model.steps, never);
    const CompiledLsys in_run = compiled(model.statements, model.steps, always);
    EXPECT_EQ(run_items(shared.graph), 0u);
    EXPECT_GT(run_items(in_run.graph), 0u);
    EXPECT_EQ(in_run.derivation->modules, shared.derivation->modules);
    EXPECT_EQ(in_run.derivation->segments, shared.derivation->segments);
    const Unfolding x(shared.graph), y(in_run.graph);
    ASSERT_EQ(x.strokes.size(), y.strokes.size());
    EXPECT_EQ(x.balls, y.balls);
    EXPECT_EQ(x.triangles.size(), y.triangles.size());
    for (std::size_t i = 0; i < x.strokes.size(); ++i) {
        ASSERT_NEAR(glm::distance(x.strokes[i].from, y.strokes[i].from), 0, 1e-9) << i;
        ASSERT_NEAR(glm::distance(x.strokes[i].to, y.strokes[i].to), 0, 1e-9) << i;
        ASSERT_NEAR(x.strokes[i].width, y.strokes[i].width, 1e-9) << i;
        const auto name = [&](const CompiledLsys& m, int id) {
            return m.graph.materials.at(static_cast<std::size_t>(id)).name;
        };
        ASSERT_EQ(name(shared, x.strokes[i].colour), name(in_run, y.strokes[i].colour)) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Models, LsysRun,
    ::testing::Values(
        RunCase{
            "NothingRepeats",
            "axiom A(1, 1)\nA(l, k) -> F(l)[+(30 + k*0.001)A(l*0.9, 2*k)][-(25 + k*0.001)A(l*0.8, 2*k + 1)]",
            8},
        RunCase{"Conditions",
                "width 0.1\naxiom A(1)\nA(x) : x < 4 -> F(x)A(x + 1)[+A(x + 2)]\nA(x) : x >= 4 -> F(0.5)", 9},
        RunCase{
            "Probabilities",
            "angle 30\nwidth 0.2\naxiom F\nF -> F[+F]F[-F]F : 0.33\nF -> F[+F]F : 0.33\nF -> F[-F]F : 0.34",
            5},
        RunCase{"Chance",
                "width 0.02\nseed 5\naxiom A(1)\n"
                "A(l) -> F(l)!(0.02*l)/(random(0, 360))[&(random(20, 70))A(l*random(0.6, 0.8))][+(normal(0, "
                "9))A(l*0.7)]",
                6},
        RunCase{"ChanceOfEitherKind",
                "width 0.02\naxiom A(1)B(2)\nA(l) -> F(l)[+(random(0, 90))A(l*0.7)]B(l) : 0.6\nA(l) -> "
                "F(l)A(l*0.9) : 0.4\n"
                "B(x) -> [-F(x)]B(x*0.5)",
                7},
        RunCase{
            "AgesOfModules",
            "width 0.1\naxiom A\nmodules A B\nA -> F(1 + age)[+B]A\nB : age < 2 -> F(0.3)B\nB : age >= 2 -> "
            "F(step)",
            7},
        RunCase{"Interpretation",
                "width 0.1\nmodules A I\naxiom A(1)\nA(x) -> I(x)[+A(x*0.8)][-(17*x)A(x*0.7)]\n"
                "interpret I(x) -> F(x)[^(40)J(x)]\ninterpret J(x) : x > 0.5 -> F(x)J(x*0.6)\nmodules J",
                6},
        RunCase{"TurtleState",
                "tropism 0, -1, 0\naxiom !(0.2)T(0.1)A(1)\nA(l) -> "
                "F(l)!;[+(20*l)$A(l*0.9)],@O(0.1)@o(0.3)[/(50)&(30)A(l*0.8)]f(l)",
                6},
        RunCase{"OpenWidth", "axiom A(20)\nA(l) -> F(l)![+(l)A(l*1.2)][-(10)A(l*1.1)]@O", 9},
        RunCase{"Polygons",
                "width 0.1\naxiom A(1)\nA(l) -> F(l)[{.f(l)+f(l)+f(l).}][+A(l*0.9)][-(31)A(l*0.77)]", 5},
        RunCase{
            "GeneralisedCylinders",
            "axiom !(1)@Gs A(1)\nmodules A\nA(l) -> f(l)!(l*0.5)@Gc[+(23*l)f(1)@Ge][^(10)A(l*0.8)]A(l*0.9)",
            5},
        RunCase{"Contexts", "width 0.1\nmodules a b\naxiom baaaa[+aaa]aaa\nb < a -> b[-(33)F]F\nb -> F", 5},
        RunCase{"Decompositions",
                "width 0.1\naxiom A(1)\nA(l) -> B(l)[+A(l*0.9)][-A(l*0.8)]\ndecompose B(l) -> F(l)F(l)", 5}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(LsysRuns, RoundingDecidesNothing) {
    for (const double exact : {2.0, 0.3, -0.7, 1e6, 123456.789, 1e-9, 0.0})
        for (const double noise : {0.0, 1e-15, -3e-15})
            EXPECT_EQ(unrounded(exact * (1 + noise)), exact);
    for (const double other : {1 / 3.0, std::sqrt(2.0), 1e-200, 1e300, 0.1 * (1 + 3e-13)})
        EXPECT_EQ(unrounded(other), other);
    // 1 + 0.2 + ... is less than 2 by rounding, and would grow once more.
    for (const std::uint64_t run_from : {always, never}) {
        const CompiledLsys model =
            compiled("width 0.1\naxiom F(1)[+F(1)]\nF(l) : l < 2 -> F(l + 0.2)", 9, run_from);
        EXPECT_NEAR(Unfolding(model.graph).strokes.at(0).to.y, 2, 1e-12);
    }
}

TEST(LsysRuns, TakeNoObjectsWhereNothingRepeats) {
    const CompiledLsys model(
        "axiom A(1, 1)\nA(l, k) -> F(l)[+(30 + k*0.001)A(l*0.9, 2*k)][-(25 + k*0.001)A(l*0.8, 2*k + 1)]", 12,
        [] {
            LowerOptions options;
            options.exact = true;
            return options;
        }());
    EXPECT_EQ(run_items(model.graph), 4095u);
    EXPECT_EQ(instance_count(model.graph), 0u);
    EXPECT_LE(model.graph.objects.size(), 1u);
}

TEST(LsysRuns, LeaveWhatRepeatsToBeShared) {
    LowerOptions options;
    options.exact = true;
    const CompiledLsys model("taper 1\nangle 25\naxiom X\nX -> F[+X]F[-X]+X\nF -> FF", 8, options);
    EXPECT_EQ(run_items(model.graph), 0u);
    EXPECT_LT(4 * instance_count(model.graph), std::stoul(model.derivation->segments));
}

TEST(LsysRuns, StandBesideModels) {
    const CompiledLsys model =
        compiled("width 0.1\naxiom A(1)\nA(l) -> F(l)[~cube(l)][+(20*l)A(l*0.9)][-A(l*0.7)]", 6, always);
    EXPECT_EQ(run_items(model.graph), 63u);
    EXPECT_EQ(model.graph.objects[model.graph.root].instances.size(), 64u); // the cubes, and the run
}

TEST(LsysRuns, StopAtTooLongAWord) {
    for (const std::uint64_t run_from : {always, never}) {
        LowerOptions options;
        options.exact = true;
        options.run_from = run_from;
        options.max_modules = 5000;
        try {
            const CompiledLsys model("axiom A(1)\nA(k) -> F(k)A(2*k)A(2*k + 1)", 30, options);
            FAIL();
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find("the derivation has more than 5000 modules"),
                      std::string::npos)
                << error.what();
        }
    }
}

constexpr const char* no_two_alike =
    "axiom A(1, 1)\nA(l, k) -> F(l)[+(30 + k*0.001)A(l*0.9, 2*k)][-(25 + k*0.001)A(l*0.8, 2*k + 1)]";

TEST(LsysRuns, RoundNoSizes) {
    const CompiledLsys model(no_two_alike, 15);
    EXPECT_EQ(run_items(model.graph), 32767u);
    EXPECT_EQ(model.derivation->size_step, 0);
    EXPECT_EQ(model.derivation->error, 0);
}

TEST(LsysRuns, PartsOnceEachOfTooLongAWordAreRefusedSoon) {
    // It was composed into a million parts first, in 2.3 GB.
    LowerOptions options;
    options.max_modules = 20'000;
    try {
        const CompiledLsys model(no_two_alike, 30, options);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what())
                      .find("the model has more than 131072 different parts, and hardly any serves twice"),
                  std::string::npos)
            << error.what();
    }
}

TEST(LsysRuns, LinesAreAsThickAsTheFigureAsks) {
    const char* const statements = "axiom A(20)\nA(l) -> F(l)[+(l)A(l*1.2)][-(10)A(l*1.1)]";
    const CompiledLsys shared = compiled(statements, 9, never), in_run = compiled(statements, 9, always);
    const Unfolding x(shared.graph), y(in_run.graph);
    ASSERT_FALSE(y.strokes.empty());
    EXPECT_GT(y.strokes[0].width, 0.1);
    EXPECT_NEAR(x.strokes[0].width, y.strokes[0].width, 1e-9);
}

} // namespace
} // namespace graftal::testing
