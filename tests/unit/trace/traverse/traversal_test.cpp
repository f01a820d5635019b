#include "runtime/trace/traverse/traversal.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

constexpr double infinity = std::numeric_limits<double>::infinity();

DetailOptions exact(unsigned steps = 1) {
    DetailOptions options;
    options.error_px = 0;
    options.steps = steps;
    return options;
}

DetailOptions culled(double error_px = 0.5) {
    DetailOptions options;
    options.error_px = error_px;
    return options;
}

bool sane(const SurfaceHit& hit) {
    return std::isfinite(hit.t) && std::abs(glm::length(hit.normal) - 1) < 1e-9 && hit.material != nullptr &&
           hit.rgb.r >= 0 && hit.rgb.r <= 1;
}

/// Rays at the model from all around, along axes, from within and from nowhere: none may break anything.
std::size_t shoot(const TraceModel& model, int count) {
    Traversal traversal(model);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double odd[] = {0, -0.0, 1, -1, 5e-324, 1e-300, 1e300, infinity, std::nan("")};
    const Box& box = model.edges.front().box;
    const Vec3 centre = box.empty() ? Vec3(0.0) : box.centre();
    const double size = box.empty() ? 1 : glm::length(box.size());
    std::size_t hits = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 any(unit(random), unit(random), unit(random));
        Ray ray{centre + size * any, centre + 0.3 * size * Vec3(unit(random), unit(random), unit(random))};
        ray.direction -= ray.origin;
        if (i % 3 == 1) ray.direction = Vec3(i % 2, (i / 2) % 2, i % 5 == 0);
        if (i % 3 == 1 && i % 4 == 0) ray.origin = centre - 2 * size * ray.direction;
        if (i % 7 == 0) ray.direction[i % 3] = odd[random() % std::size(odd)];
        if (i % 11 == 0) ray.origin[i % 3] = odd[random() % std::size(odd)];
        SurfaceHit hit;
        if (!traversal.closest(ray, {1e-9, infinity}, hit)) continue;
        ++hits;
        EXPECT_TRUE(sane(hit)) << i;
    }
    return hits;
}

TEST(Traversal, MeetsAPrimitiveThroughTwoInstances) {
    Graph graph = empty_graph();
    const ObjectId group = graph.add({"group", {}, {}, {}, {}});
    place(graph, group, graph.primitive(PrimitiveKind::sphere), Affine::translate({0, 2, 0}),
          {{1, 0, 0}, 0.5});
    place(graph, group, graph.primitive(PrimitiveKind::cube), Affine::translate({9, 0, 0}));
    place(graph, graph.root, group, Affine::scale({3, 3, 3}), {{0, 0, 1}, 0.5});
    const auto model = traced(graph, exact());
    Traversal traversal(*model);
    SurfaceHit hit;
    ASSERT_TRUE(traversal.closest({{0, 6, 10}, {0, 0, -2}}, {}, hit));
    EXPECT_NEAR(hit.t, 3.5, 1e-12);
    EXPECT_NEAR(glm::distance(hit.normal, Vec3(0, 0, 1)), 0, 1e-12);
    // Blue in front of red in front of the plain grey.
    EXPECT_NEAR(glm::distance(hit.rgb, Rgb(0.25 + 0.2, 0.2, 0.5 + 0.2)), 0, 1e-12);
    EXPECT_FALSE(traversal.meets_any({{0, 6, 10}, {0, 0, -2}}, {0, 3.4}));
    EXPECT_TRUE(traversal.meets_any({{0, 6, 10}, {0, 0, -2}}, {0, 3.6}));
    // From within, the other side.
    ASSERT_TRUE(traversal.closest({{0, 6, 0}, {0, 0, -2}}, {}, hit));
    EXPECT_NEAR(hit.t, 1.5, 1e-12);
}

TEST(Traversal, IsTheSameByAllInstructions) {
    for (const double scale : {0.5, 0.45}) {
        const auto model = traced(test::tetrahedron(scale), culled());
        Traversal portable(*model, Instructions::portable), best(*model);
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> unit(-1, 1);
        std::size_t hits = 0;
        for (int i = 0; i < 20'000; ++i) {
            const Ray ray{{unit(random), unit(random), 4}, {0.2 * unit(random), 0.2 * unit(random), -1}};
            SurfaceHit a, b;
            ASSERT_EQ(portable.closest(ray, {}, a), best.closest(ray, {}, b));
            ASSERT_EQ(a.t, b.t);
            ASSERT_EQ(a.normal, b.normal);
            ASSERT_EQ(a.rgb, b.rgb);
            hits += a.t > 0;
        }
        EXPECT_GT(hits, 1000u) << scale;
        EXPECT_EQ(portable.visits(), best.visits());
    }
}

// What is culled covers as much as what it stands for.
TEST(Traversal, CoversWithoutSmallPartsWhatItCoversWithAll) {
    DetailOptions all = exact(), some = culled();
    all.steps = some.steps = 13;
    Graph tetrahedron = test::tetrahedron();
    for (Object& object : tetrahedron.objects)
        if (object.terminal) object.terminal->parent_from_child = Affine::scale(Vec3(0.75)); // apart, then
    const auto whole = traced(tetrahedron, all), cut = traced(tetrahedron, some);
    Traversal exact_rays(*whole), cut_rays(*cut);
    const Vec3 askew = glm::normalize(Vec3(0.31, 0.23, -1)); // along some directions its shadow is full
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    double hits = 0, all_hits = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 aim{unit(random), unit(random), unit(random)};
        const Ray ray{aim - 10.0 * askew, askew};
        all_hits += exact_rays.meets_any(ray, {});
        hits += cut_rays.meets_any(ray, {});
    }
    EXPECT_GT(all_hits, 1000);
    EXPECT_NEAR(hits / all_hits, 1, 0.1);
}

TEST(Traversal, GoesAsDeepAsTheErrorAsks) {
    // Visits grow by a constant for each halving of the error, as the depth does.
    double last = 20;
    for (const double error_px : {4.0, 1.0, 1.0 / 4, 1.0 / 16, 1.0 / 256}) {
        const auto model = traced(test::tetrahedron(), culled(error_px));
        Traversal traversal(*model);
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> unit(-1, 1);
        for (int i = 0; i < 5000; ++i)
            traversal.meets_any(
                {{unit(random), unit(random), 4}, {0.1 * unit(random), 0.1 * unit(random), -1}}, {});
        const double visits = static_cast<double>(traversal.visits()) / 5000;
        EXPECT_LT(visits, last + 12) << error_px;
        last = visits;
    }
}

TEST(Traversal, DrawsFourHundredLevelsInPlace) {
    Graph graph = empty_graph();
    const ObjectId spiral = graph.add({"spiral", {}, {}, {}, {}});
    place(graph, spiral, graph.primitive(PrimitiveKind::sphere), {});
    place(graph, spiral, spiral, Affine::translate({3, 0, 0}) * Affine::scale(Vec3(0.5)));
    place(graph, graph.root, spiral, {});
    const auto model = traced(graph, exact(400));
    Traversal traversal(*model);
    SurfaceHit hit;
    // Ball k is at 6 - 6 / 2^k, its radius 1 / 2^k.
    for (const int k : {0, 1, 10, 30, 45}) {
        const double x = 6 - std::ldexp(6, -k), radius = std::ldexp(1, -k);
        ASSERT_TRUE(traversal.closest({{x, 0, 10}, {0, 0, -1}}, {}, hit)) << k;
        EXPECT_NEAR(10 - hit.t, radius, 1e-14) << k;
        EXPECT_TRUE(traversal.meets_any({{x, 0.99 * radius, 10}, {0, 0, -1}}, {})) << k;
        EXPECT_FALSE(traversal.meets_any({{x, 1.01 * radius, 10}, {0, 0, -1}}, {})) << k;
    }
}

TEST(Traversal, FindsTheOneThatIsMetAmongAMillion) {
    Graph graph = empty_graph();
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    for (int i = 0; i < 1'000'000; ++i)
        place(graph, graph.root, ball,
              Affine::translate({i % 1000, i / 1000, (i % 1000 * 7919) % 13}) * Affine::scale(Vec3(0.25)));
    const auto model = traced(graph, exact());
    Traversal traversal(*model);
    SurfaceHit hit;
    for (const int i : {0, 999, 123'456, 999'999}) {
        ASSERT_TRUE(traversal.closest({{i % 1000, i / 1000, 100}, {0, 0, -1}}, {}, hit));
        EXPECT_NEAR(100 - hit.t, (i % 1000 * 7919) % 13 + 0.25, 1e-9);
    }
    EXPECT_LT(traversal.visits(), 100u);
    EXPECT_FALSE(traversal.meets_any({{0.5, 0.5, 100}, {0, 0, -1}}, {}));
}

TEST(Traversal, FollowsAChainOfAHundredThousand) {
    Graph graph = empty_graph();
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    ObjectId last = ball;
    for (int i = 0; i < 100'000; ++i) {
        const ObjectId link = graph.add({"link" + std::to_string(i), {}, {}, {}, {}});
        place(graph, link, last, Affine::translate({1, 0, 0}));
        place(graph, link, ball, Affine::scale(Vec3(0.25)));
        last = link;
    }
    place(graph, graph.root, last, {});
    const auto model = traced(graph, exact());
    Traversal traversal(*model);
    SurfaceHit hit;
    ASSERT_TRUE(traversal.closest({{99'999, 0, 10}, {0, 0, -1}}, {}, hit));
    EXPECT_NEAR(hit.t, 9.75, 1e-6);
    EXPECT_TRUE(traversal.meets_any({{-10, 0, 0}, {1, 0, 0}}, {}));
}

/// 2^60 balls in one place, or nearly so.
Graph pairs_of_pairs(double apart) {
    Graph graph = empty_graph();
    ObjectId last = graph.primitive(PrimitiveKind::sphere);
    for (int i = 0; i < 60; ++i) {
        const ObjectId pair = graph.add({"pair" + std::to_string(i), {}, {}, {}, {}});
        place(graph, pair, last, Affine::translate({0, 0, apart}));
        place(graph, pair, last, Affine::translate({0, 0, 0 - apart}));
        last = pair;
    }
    place(graph, graph.root, last, {});
    return graph;
}

TEST(Traversal, GivesUpWhereItWouldNotEnd) {
    const auto model = traced(pairs_of_pairs(1e-7), exact());
    Traversal traversal(*model);
    SurfaceHit hit;
    EXPECT_TRUE(traversal.closest({{0, 0, 10}, {0, 0, -1}}, {}, hit));
    EXPECT_NEAR(hit.t, 9, 1e-5);
    EXPECT_EQ(traversal.given_up(), 1u);
    EXPECT_LE(traversal.visits(), model->most_visits + model->more_visits() + 64);
}

TEST(Traversal, TakesPartsThatCoincideForOne) {
    const auto model = traced(pairs_of_pairs(0), exact());
    Traversal traversal(*model);
    EXPECT_TRUE(traversal.meets_any({{0, 0, 10}, {0, 0, -1}}, {}));
    EXPECT_EQ(traversal.given_up(), 0u);
}

TEST(Traversal, DrawsWhatIsFlattenedOrCrushed) {
    for (const Vec3 factors : {Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(1, 1, 1e-12), Vec3(1e-200, 1, 1)}) {
        Graph graph = empty_graph();
        place(graph, graph.root, graph.primitive(PrimitiveKind::sphere), Affine::scale(factors));
        place(graph, graph.root, graph.primitive(PrimitiveKind::cube), Affine::translate({5, 0, 0}));
        for (const DetailOptions& options : {exact(), culled()}) {
            const auto model = traced(graph, options);
            Traversal traversal(*model);
            EXPECT_TRUE(traversal.meets_any({{0, 0, 10}, {0, 0, -1}}, {})) << factors.x << factors.z;
            EXPECT_FALSE(traversal.meets_any({{0, 2, 10}, {0, 0, -1}}, {}));
            shoot(*model, 2000);
        }
    }
}

// Thirty half-size copies in one place are as many leaves as no walk can visit, and look like one.
TEST(Traversal, CrushedPartsThatCoincideForEverAreMetOnce) {
    Graph graph = empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    place(graph, self, graph.primitive(PrimitiveKind::cube), {});
    for (int i = 0; i < 30; ++i)
        place(graph, self, self, Affine::translate({0.5, 0, i / 60.0}) * Affine::scale(Vec3(0.5)));
    place(graph, graph.root, self, Affine::scale({1, 1, 0}));
    const auto model = traced(graph, culled());
    Traversal traversal(*model);
    // All of it lies in the largest cube.
    for (const Vec3& within : {Vec3(0.5, 0.5, 10), Vec3(0.98, 0.3, 10), Vec3(-0.98, -0.98, 10)})
        EXPECT_TRUE(traversal.meets_any({within, {0, 0, -1}}, {}));
    for (const Vec3& beside :
         {Vec3(1.05, 0.3, 10), Vec3(1.2, 0.3, 10), Vec3(1.2, 0.95, 10), Vec3(0, 1.05, 10)})
        EXPECT_FALSE(traversal.meets_any({beside, {0, 0, -1}}, {}));
    EXPECT_EQ(traversal.given_up(), 0u);
    EXPECT_LT(traversal.visits(), 100'000u);
}

TEST(Traversal, ARayThatIsGivenUpMeetsWhatItDidNotLookInto) {
    Graph graph = empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (int i = 0; i < 8; ++i)
        place(graph, self, self,
              Affine::translate({i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5}) * Affine::scale(Vec3(0.5)));
    place(graph, graph.root, self, {});
    const auto model = traced(graph, culled(0.01));
    model->most_visits = 3;
    Traversal traversal(*model);
    for (int i = 0; i < 20; ++i) {
        const Ray ray{{0.05 * (i % 5) - 0.11, 0.05 * (i / 5.0) - 0.11, 10}, {0, 0, -1}};
        SurfaceHit hit;
        EXPECT_TRUE(traversal.closest(ray, {1e-9, infinity}, hit)) << "sky through the middle of a cube";
        EXPECT_TRUE(sane(hit));
        EXPECT_TRUE(traversal.meets_any(ray, {1e-9, infinity}));
    }
    EXPECT_GT(traversal.given_up(), 0u);
    EXPECT_LE(traversal.visits(), 40 * (model->most_visits + model->more_visits() + 64));
}

// A child that is only looked at in the world takes as long as a part that is gone into.
TEST(Traversal, WorkCountsWhatIsLookedAtInTheWorld) {
    Graph graph = empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (int i = 0; i < 30; ++i)
        place(graph, self, self, Affine::translate({i % 6, i / 6, 0.1 * i}) * Affine::scale(Vec3(0.3)));
    place(graph, graph.root, self, Affine::scale({1, 1, 0}));
    const auto model = traced(graph, culled());
    Traversal traversal(*model);
    for (int i = 0; i < 100; ++i)
        traversal.meets_any({{0.05 * i, 0.04 * i, 10}, {0, 0, -1}}, {});
    constexpr std::uint64_t looked_at = 30 * RayWork::crushed;
    EXPECT_GE(traversal.work(), 100 * looked_at) << "thirty children for each ray";
    EXPECT_GE(traversal.visits(), 100 * looked_at / RayWork::part)
        << "they are of the visits that a ray may make";
}

// Found by a random model: twelve unequal maps took twice the work that was allowed.
TEST(Traversal, WorkCountsTheImageOfEachPartThatIsCrushed) {
    Graph graph = empty_graph();
    const ObjectId corners = graph.add({"corners", {}, {}, {}, {}});
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    for (int i = 0; i < 4; ++i)
        place(graph, corners, ball,
              Affine::translate({i % 2 - 0.5, i / 2 - 0.5, 0}) * Affine::scale(Vec3(0.1)));
    for (int i = 0; i < 30; ++i)
        place(graph, graph.root, corners, Affine::translate({0, 0, 0.1 * i}) * Affine::scale({1, 1, 0}));
    const auto model = traced(graph, culled());
    Traversal traversal(*model);
    for (int i = 0; i < 100; ++i)
        EXPECT_FALSE(traversal.meets_any({{1e-3 * i, 0, 10}, {0, 0, -1}}, {})) << "between the corners";
    EXPECT_GE(traversal.work(), 100 * 30 * (RayWork::image + RayWork::crushed));
}

TEST(Traversal, WorkCountsThePathToWhatIsSeen) {
    const auto model = traced(test::tetrahedron(0.45), culled());
    Traversal traversal(*model);
    SurfaceHit hit;
    const double tip = 0.5 / (1 - 0.45);
    ASSERT_TRUE(traversal.closest({{tip, tip, 10}, {0, 0, -1}}, {}, hit));
    EXPECT_GE(traversal.work(), RayWork::part * traversal.visits() + RayWork::shaded * 6);
}

// Found by random graphs: the proof that the model contracts takes paths of 1000 instances, and in the
// prepared graph, where what is crushed has a node of its own, they are twice as long.
TEST(Traversal, DrawsWhatIsHardlyProvedToContract) {
    Graph graph = empty_graph();
    const ObjectId branch = graph.add({"branch", {}, {}, {}, {}}), tip = graph.add({"tip", {}, {}, {}, {}});
    const ObjectId cone = graph.primitive(PrimitiveKind::cone);
    place(graph, branch, cone, Affine::scale(Vec3(0.5)));
    place(graph, branch, tip,
          {Mat3(0.1, 0, 1, 0.28235008753836155, 0.38068594597280025, 0.5, -0.07628720626235008, 1e200,
                -0.7071067811865476),
           Vec3(1e200, 0, 0.4299275875091553)});
    place(graph, tip, cone, Affine::scale(Vec3(0.5)));
    place(graph, tip, branch, Affine::scale({1, 0, 1}));
    place(graph, graph.root, branch, {});
    shoot(*traced(graph, culled()), 100);
}

TEST(Traversal, SurvivesRaysAndModelsOfAllKinds) {
    for (const double scale : {0.5, 0.45})
        EXPECT_GT(shoot(*traced(test::tetrahedron(scale), culled()), 20'000), 1000u) << scale;
    Graph planes = empty_graph();
    place(planes, planes.root, planes.primitive(PrimitiveKind::plane), {});
    place(planes, planes.root, planes.primitive(PrimitiveKind::torus), Affine::translate({0, 3, 0}));
    EXPECT_GT(shoot(*traced(planes, exact()), 5000), 500u);
    Graph far = empty_graph();
    place(far, far.root, far.primitive(PrimitiveKind::cone),
          Affine::translate({1e60, 0, 0}) * Affine::scale(Vec3(1e50)));
    shoot(*traced(far, exact()), 2000);
    Graph tiny = empty_graph();
    place(tiny, tiny.root, tiny.primitive(PrimitiveKind::cylinder), Affine::scale(Vec3(1e-90)));
    shoot(*traced(tiny, exact()), 2000);
}

/// Rays through the boxes of thousands of triangles, beside the triangles.
TEST(Traversal, TheRaysOfOneCameraRayHaveAShareTogether) {
    Graph graph = test::empty_graph();
    const ObjectId triangle = graph.primitive(PrimitiveKind::triangle);
    for (int i = 0; i < 3000; ++i)
        test::place(graph, graph.root, triangle, Affine::translate({0, 0, -0.01 * i}));
    const auto model = test::traced(graph, {});
    model->most_visits = 2000;
    const auto visits = [&](bool each) {
        Traversal traversal(*model);
        traversal.begin_path();
        SurfaceHit hit;
        for (int i = 0; i < 30; ++i) {
            if (each) traversal.begin_path();
            traversal.closest({Vec3(0.7, 0.8, 5), Vec3(0, 0, -1)}, {}, hit);
        }
        return traversal.visits();
    };
    EXPECT_GT(visits(true), 30 * 2000u);
    EXPECT_LT(visits(false), visits(true) / 3);
}

} // namespace
} // namespace graftal
