#include "compiler/primitives/intersect.h"
#include "compiler/primitives/tapered.h"

#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/primitives/all_primitives.h"

namespace graftal {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr auto triangle = PrimitiveKind::triangle, sphere = PrimitiveKind::sphere, cube = PrimitiveKind::cube,
               plane = PrimitiveKind::plane, cylinder = PrimitiveKind::cylinder, cone = PrimitiveKind::cone,
               torus = PrimitiveKind::torus;
const Primitive frustum = tapered(0.5);

std::optional<PrimitiveHit> meet(const Primitive& kind, Vec3 origin, Vec3 direction, RayRange range = {}) {
    PrimitiveHit hit;
    if (!intersect(kind, {origin, direction}, range, hit)) return {};
    return hit;
}

struct Case {
    Primitive kind = PrimitiveKind::sphere;
    Vec3 origin, direction;
    double t;
    Vec3 normal;
    RayRange range = {};
};

void expect(const Case& c, int number) {
    SCOPED_TRACE(testing::Message() << "case " << number << ": " << name_of(c.kind));
    const auto hit = meet(c.kind, c.origin, c.direction, c.range);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, c.t, 4e-15 * std::max(1.0, std::abs(c.t)));
    EXPECT_LE(glm::length(hit->normal - c.normal), 1e-14);
}

const double r2 = std::sqrt(0.5), r5 = std::sqrt(0.2);

TEST(Intersect, MeetsEachSurface) {
    const Case cases[] = {
        {triangle, {0, 0, 2}, {0, 0, -1}, 2, {0, 0, 1}},
        {triangle, {0, 0, -2}, {0, 0, 1}, 2, {0, 0, 1}}, // both sides have one normal
        {triangle, {0, 0.999, 1}, {0, 0, -2}, 0.5, {0, 0, 1}},
        {triangle, {0, 1, 1}, {0, 0, -1}, 1, {0, 0, 1}}, // a corner
        {triangle, {0.25, -0.5, 1}, {0, 0, -1}, 1, {0, 0, 1}},
        {sphere, {0, 0, 3}, {0, 0, -1}, 2, {0, 0, 1}},
        {sphere, {0, 0, 3}, {0, 0, -0.5}, 4, {0, 0, 1}},
        {sphere, {0.6, 0, 4000}, {0, 0, -1}, 3999.2, {0.6, 0, 0.8}},
        {cube, {0.5, 0.25, 3}, {0, 0, -1}, 2, {0, 0, 1}},
        {cube, {-5, 0.5, 0.5}, {1, 0, 0}, 4, {-1, 0, 0}},
        {cube, {0, 3, 0}, {0.25, -1, 0.125}, 2, {0, 1, 0}},
        {cube, {3, 2.5, 0}, {-1, -1, 0}, 2, {1, 0, 0}},
        {plane, {7, 3, 5}, {0, -1, 0}, 3, {0, 1, 0}},
        {plane, {7, -3, 5}, {0, 0.5, 1}, 6, {0, 1, 0}}, // from below the same normal
        {cylinder, {0, 0.5, 3}, {0, 0, -1}, 2, {0, 0, 1}},
        {cylinder, {0.5, 3, 0}, {0, -1, 0}, 2, {0, 1, 0}},
        {cylinder, {0.5, -3, 0}, {0, 1, 0}, 3, {0, -1, 0}},
        {cylinder, {-3, 0.5, 0.6}, {1, 0, 0}, 2.2, {-0.8, 0, 0.6}},
        {cone, {3, 0.5, 0}, {-1, 0, 0}, 2.5, {r2, r2, 0}},
        {cone, {0.25, 3, 0}, {0, -1, 0}, 2.25, {r2, r2, 0}},
        {cone, {0.5, -3, 0}, {0, 1, 0}, 3, {0, -1, 0}},
        {cone, {0, 0.25, -3}, {0, 0, 1}, 2.25, {0, r2, -r2}},
        {cone, {3, 0, 0}, {-1, 0.25, 0}, 8 / 3., {r2, r2, 0}},
        {torus, {3, 0, 0}, {-1, 0, 0}, 1.75, {1, 0, 0}},
        {torus, {1, 3, 0}, {0, -1, 0}, 2.75, {0, 1, 0}},
        {torus, {0, 3, 1}, {0, -2, 0}, 1.375, {0, 1, 0}},
        {torus, {1.2, -3, 0}, {0, 1, 0}, 2.85, {0.8, -0.6, 0}},
        {torus, {0, 0, 3000}, {0, 0, -1}, 2998.75, {0, 0, 1}},
        {frustum, {0.25, 3, 0}, {0, -1, 0}, 2, {0, 1, 0}},
        {frustum, {0.75, 3, 0}, {0, -1, 0}, 2.5, {2 * r5, r5, 0}},
        {frustum, {0, 0.5, 3}, {0, 0, -1}, 2.25, {0, r5, 2 * r5}},
        {frustum, {0.9, -1, 0}, {0, 1, 0}, 1, {0, -1, 0}},
        {tapered(0.75), {3, 1, 0}, {-1, -0.25, 0}, 36 / 17., {4 / std::sqrt(17), 1 / std::sqrt(17), 0}},
    };
    for (int i = 0; const Case& c : cases)
        expect(c, i++);
}

TEST(Intersect, CountsTheWorkOfATorusWhetherItIsMetOrNot) {
    PrimitiveHit met, missed;
    EXPECT_TRUE(intersect(torus, {{3, 0, 0}, {-1, 0, 0}}, {}, met));
    EXPECT_FALSE(intersect(torus, {{0, 3, 0}, {0, -1, 0}}, {}, missed)); // through the hole
    EXPECT_GT(missed.steps, 0u);
    EXPECT_EQ(met.steps, missed.steps);
}

TEST(Intersect, FindsTheExitFromInside) {
    const Case cases[] = {
        {sphere, {0, 0, 0}, {0, 0.5, 0}, 2, {0, 1, 0}},
        {cube, {0.5, 0, 0}, {1, 0, 0}, 0.5, {1, 0, 0}},
        {cube, {0, 0, 0}, {0.5, -1, 0.25}, 1, {0, -1, 0}},
        {cylinder, {0, 0.5, 0}, {1, 0, 0}, 1, {1, 0, 0}},
        {cylinder, {0, 0.5, 0}, {0, 1, 0}, 0.5, {0, 1, 0}},
        {cylinder, {0, 0.5, 0}, {0.5, -1, 0}, 0.5, {0, -1, 0}},
        {cone, {0, 0.25, 0}, {0, -1, 0}, 0.25, {0, -1, 0}},
        {cone, {0, 0.25, 0}, {0, 0, -1}, 0.75, {0, r2, -r2}},
        {cone, {0, 0.5, 0}, {0, 1, 0}, 0.5, {0, 1, 0}}, // through the apex
        {frustum, {0, 0.5, 0}, {0, 0, -1}, 0.75, {0, r5, -2 * r5}},
        {frustum, {0, 0.5, 0}, {0.25, 1, 0}, 0.5, {0, 1, 0}},
        {torus, {1, 0, 0}, {1, 0, 0}, 0.25, {1, 0, 0}},
        {torus, {1, 0, 0}, {-1, 0, 0}, 0.25, {-1, 0, 0}},
        {torus, {-1, 0, 0}, {0, 1, 0}, 0.25, {0, 1, 0}},
        {torus, {0, 0, 0}, {1, 0, 0}, 0.75, {-1, 0, 0}}, // from the middle of the hole
    };
    for (int i = 0; const Case& c : cases)
        expect(c, i++);
}

TEST(Intersect, TakesTheFirstCrossingWithinTheRange) {
    const Case cases[] = {
        {sphere, {0, 0, 3}, {0, 0, -1}, 4, {0, 0, -1}, {2, no_end}}, // open: 2 itself does not count
        {sphere, {0, 0, 3}, {0, 0, 1}, -4, {0, 0, -1}, {-10, 0}},
        {cube, {0, 0, 3}, {0, 0, -1}, 4, {0, 0, -1}, {2, 4.5}},
        {cylinder, {0, 3, 0}, {0, -1, 0}, 3, {0, -1, 0}, {2, no_end}},
        {cone, {0.25, 3, 0}, {0, -1, 0}, 3, {0, -1, 0}, {2.5, no_end}},
        {frustum, {0, 3, 0}, {0, -1, 0}, 3, {0, -1, 0}, {2.5, no_end}},
        {torus, {3, 0, 0}, {-1, 0, 0}, 2.25, {-1, 0, 0}, {2, no_end}},
        {torus, {3, 0, 0}, {-1, 0, 0}, 3.75, {1, 0, 0}, {2.5, 4}},
        {torus, {3, 0, 0}, {-1, 0, 0}, 4.25, {-1, 0, 0}, {4, no_end}},
        {plane, {0, -3, 0}, {0, -1, 0}, -3, {0, 1, 0}, {-no_end, no_end}},
    };
    for (int i = 0; const Case& c : cases)
        expect(c, i++);
    EXPECT_FALSE(meet(sphere, {0, 0, 3}, {0, 0, -1}, {0, 2}));
    EXPECT_FALSE(meet(sphere, {0, 0, 3}, {0, 0, -1}, {2, 4}));
    EXPECT_FALSE(meet(cube, {0, 0, 3}, {0, 0, -1}, {2, 4}));
    EXPECT_FALSE(meet(cylinder, {0, 3, 0}, {0, -1, 0}, {2, 3}));
    EXPECT_FALSE(meet(plane, {0, 3, 0}, {0, -1, 0}, {3, 9}));
    EXPECT_FALSE(meet(triangle, {0, 0, 3}, {0, 0, -1}, {0, 3}));
    EXPECT_FALSE(meet(torus, {3, 0, 0}, {-1, 0, 0}, {2.3, 3.7}));
    for (const Primitive& primitive : test::all_primitives())
        EXPECT_FALSE(meet(primitive, {0, 0.25, 0.5}, {0.1, 0.2, 1}, {nan, nan}));
}

TEST(Intersect, MissesWhatIsNotThere) {
    const struct {
        Primitive kind = PrimitiveKind::sphere;
        Vec3 origin, direction;
    } cases[] = {
        {triangle, {0, 1.001, 1}, {0, 0, -1}},  {triangle, {0, -0.501, 1}, {0, 0, -1}},
        {triangle, {0.5, 0.2, 1}, {0, 0, -1}},  {triangle, {0, 0, 1}, {1, 0, 0}},
        {triangle, {-5, 0, 0}, {1, 0, -0.0}}, // within its plane
        {sphere, {1.001, 0, 3}, {0, 0, -1}},    {sphere, {0, 0, 3}, {0, 0, 1}},
        {cube, {1.001, 0, 3}, {0, 0, -1}},      {cube, {3.001, 0, -1}, {-1, 0, 1}},
        {cube, {-3, 1.001, 0}, {1, -0.0, 0}},   {plane, {0, 1, 0}, {1, 0, 0}},
        {plane, {0, 1, 0}, {1, -0.0, 0}},       {plane, {0, 0, 0}, {1, 0, 0}},
        {plane, {0, 1, 0}, {0, 1, 0}},          {cylinder, {-3, 1.001, 0}, {1, 0, 0}},
        {cylinder, {1.001, 3, 0}, {0, -1, 0}},  {cylinder, {-3, 0.5, 1.001}, {1, 0, 0}},
        {cylinder, {2.1, 0, 0}, {-1, 1, 0}},    {cone, {-3, 0.5, 0.501}, {1, 0, 0}},
        {cone, {-3, 1.5, 0}, {1, 0, 0}}, // the other nappe
        {cone, {0, 3, 0}, {1, -0.5, 0}},        {cone, {2.5, -1, 0}, {-1, 0.5, 2}},
        {frustum, {-3, 0.5, 0.751}, {1, 0, 0}}, {frustum, {-3, 3, 0}, {1, 0, 0}},
        {frustum, {-3, 2.5, 0}, {1, 0.125, 0}}, {torus, {0, 3, 0}, {0, -1, 0}},
        {torus, {0.7, 3, 0}, {0, -1, 0}},       {torus, {-3, 0.251, 1}, {1, 0, 0}},
        {torus, {-3, 0, 1.251}, {1, 0, 0}},     {torus, {0, 0, 0}, {0.3, 1, 0.3}},
    };
    for (int i = 0; const auto& c : cases)
        EXPECT_FALSE(meet(c.kind, c.origin, c.direction)) << "case " << i++ << ": " << name_of(c.kind);
}

TEST(Intersect, KeepsItsDigitsFarAway) {
    for (const double far : {1e1, 1e3, 1e4}) {
        // Just inside and outside of the silhouette.
        const double slack = 1e-15 * far + 1e-14;
        EXPECT_TRUE(meet(sphere, {far, far, 1 - slack}, {-1, -1, 0}));
        EXPECT_FALSE(meet(sphere, {far, far, 1 + slack}, {-1, -1, 0}));
        EXPECT_TRUE(meet(cylinder, {far, 0.5, 1 - slack}, {-1, 0, 0}));
        EXPECT_FALSE(meet(cylinder, {far, 0.5, 1 + slack}, {-1, 0, 0}));
        EXPECT_TRUE(meet(cone, {far, 0.5, 0.5 - slack}, {-1, 0, 0}));
        EXPECT_FALSE(meet(cone, {far, 0.5, 0.5 + slack}, {-1, 0, 0}));
        EXPECT_TRUE(meet(torus, {far, 0, 1.25 - slack}, {-1, 0, 0}));
        EXPECT_FALSE(meet(torus, {far, 0, 1.25 + slack}, {-1, 0, 0}));
        const auto hit = meet(torus, {1 + far, far, 0}, {-1, -1, 0});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t, far - 0.25 * r2, 4e-16 * far + 1e-15);
    }
}

/// Rays to points of edges and apices, of which no rounding may make a miss: what comes next is well inside.
TEST(Intersect, LosesNoRayBetweenFaces) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> wide(-4, 4), angle(0, 6.283185307179586), one(-1, 1);
    int met = 0;
    const auto aim = [&](const Primitive& kind, Vec3 target, Vec3 inside) {
        // Towards what is inside, from where the ray comes through the target first.
        const Vec3 way = (inside - target) * std::exp(wide(random));
        const auto hit = meet(kind, target - way, way);
        ASSERT_TRUE(hit) << name_of(kind);
        ASSERT_NEAR(hit->t, 1, 1e-13 * std::max(1.0, 1 / glm::length(way))) << name_of(kind);
        ++met;
    };
    const Primitive capped[] = {cylinder, cone, frustum, tapered(1. / 128), tapered(127. / 128)};
    for (int i = 0; i < 20000; ++i) {
        const double turn = angle(random);
        const Vec3 out(std::cos(turn), 0, std::sin(turn));
        for (const Primitive& kind : capped) {
            const Vec3 inside(0.3 * one(random) * out.z, 0.5 + 0.2 * one(random), 0.3 * one(random) * out.x);
            aim(kind, out, inside);
            aim(kind, out * top_radius(kind) + Vec3(0, 1, 0), inside);
        }
        Vec3 edge(one(random) < 0 ? 1 : -1, one(random) < 0 ? 1 : -1, one(random));
        if (i % 2) edge.z = edge.x;
        std::swap(edge.z, edge[i % 3]);
        aim(cube, edge, 0.9 * Vec3(one(random), one(random), one(random)));
    }
    EXPECT_EQ(met, 20000 * 11);
}

TEST(Intersect, GrazingRaysFindTheSurfaceOrNothing) {
    const struct {
        Primitive kind = PrimitiveKind::sphere;
        Vec3 origin, direction;
        double least_t, most_t;
    } cases[] = {
        {sphere, {1, 0, 3}, {0, 0, -1}, 3, 3},
        {cube, {1, 0, 3}, {0, 0, -1}, 2, 4}, // within a face
        {cube, {1, 1, 3}, {0, -0.0, -1}, 2, 4},
        {cube, {2, 0, 0}, {-1, 1, 0}, 1, 1}, // touches an edge
        {cube, {1 + 4e-16, 0, 3}, {1e-18, 0, -1}, 2, 4},
        {cylinder, {1, 3, 0}, {0, -1, 0}, 2, 3}, // along the side
        {cylinder, {3, 1, 0}, {-1, 0, 0}, 2, 4}, // along a cap
        {cylinder, {1, 0.5, 3}, {0, 0, -1}, 3, 3},
        {cone, {3, 1, 0}, {-1, 0, 0}, 3, 3},  // the apex
        {cone, {-1, 2, 0}, {1, -1, 0}, 1, 2}, // along a side, through the apex
        {cone, {2, -1, 1e-200}, {-1, 1, 0}, 1, 2},
        {frustum, {2, -1, 0}, {-1, 2, 0}, 0.5, 1},
        {torus, {3, 0.25, 0}, {-1, 0, 0}, 2, 4}, // touches twice
        {torus, {1.25, 0, 3}, {0, 0, -1}, 3, 3},
        {torus, {0.75, 3, 0}, {0, -1, 0}, 3, 3},
        {torus, {0.75, 0, 3}, {0, 0, -1}, 1, 2}, // enters, then touches the hole from inside the tube
    };
    for (int i = 0; const auto& c : cases) {
        SCOPED_TRACE(i++);
        const auto hit = meet(c.kind, c.origin, c.direction);
        if (!hit) continue;
        EXPECT_GE(hit->t, c.least_t - 1e-7);
        EXPECT_LE(hit->t, c.most_t + 1e-7);
        EXPECT_NEAR(glm::length(hit->normal), 1, 1e-15);
    }
    EXPECT_TRUE(meet(cube, {1 + 4e-16, 0, 3}, {0, 0, -1})); // so that stacked cubes show no gap
    EXPECT_TRUE(meet(cube, {-1 - 4e-16, 0, 3}, {-0.0, 0, -1}));
    EXPECT_TRUE(meet(sphere, {1, 0, 3}, {0, 0, -1})); // solids are closed
    EXPECT_TRUE(meet(cylinder, {1, 0.5, 3}, {0, 0, -1}));
    EXPECT_TRUE(meet(torus, {0.75, 0, 3}, {0, 0, -1}));
}

/// From a point of the surface: nothing there but rounding, then the next crossing, if there is one.
TEST(Intersect, StartsOnTheSurface) {
    const Case inwards[] = {
        {sphere, {0, 1, 0}, {0, -1, 0}, 2, {0, -1, 0}},    {cube, {0, 1, 0}, {0, -1, 0}, 2, {0, -1, 0}},
        {cylinder, {0, 1, 0}, {0, -1, 0}, 1, {0, -1, 0}},  {cylinder, {1, 0.5, 0}, {-1, 0, 0}, 2, {-1, 0, 0}},
        {cone, {0, 1, 0}, {0, -1, 0}, 1, {0, -1, 0}},      {cone, {0.5, 0.5, 0}, {-1, 0, 0}, 1, {-r2, r2, 0}},
        {frustum, {0, 1, 0}, {0, -1, 0}, 1, {0, -1, 0}},   {torus, {1.25, 0, 0}, {-1, 0, 0}, 0.5, {-1, 0, 0}},
        {torus, {0.75, 0, 0}, {-1, 0, 0}, 1.5, {1, 0, 0}},
    };
    for (int i = 0; Case c : inwards) {
        c.range.least = 1e-12;
        expect(c, i++);
    }
    for (const Primitive& kind :
         std::initializer_list<Primitive>{sphere, cube, cylinder, cone, frustum, plane, triangle}) {
        const double top = kind == triangle || kind == plane ? 0 : 1;
        EXPECT_FALSE(meet(kind, {0, top, 0}, {0, 1, 1}, {1e-12, no_end})) << name_of(kind);
    }
    EXPECT_FALSE(meet(torus, {1.25, 0, 0}, {1, 0.5, 0}, {1e-12, no_end}));
}

TEST(Intersect, TurnsDownWhatIsNotFinite) {
    for (const Primitive& primitive : test::all_primitives())
        for (int i = 0; i < 3; ++i)
            for (const double bad : {nan, no_end, -no_end, 1e300}) {
                Ray ray{{0.1, 0.2, 3}, {0, 0, -1}};
                ray.origin[i] = bad;
                EXPECT_FALSE(meet(primitive, ray.origin, ray.direction));
                ray = {{0.1, 0.2, 3}, {0, 0, -1}};
                ray.direction[i] = bad;
                EXPECT_FALSE(meet(primitive, ray.origin, ray.direction));
            }
    for (const Primitive& primitive : test::all_primitives())
        for (const Vec3 direction : {Vec3(0.0), Vec3(-0.0), Vec3(5e-324), Vec3(1e-300)})
            EXPECT_FALSE(meet(primitive, {0.1, 0.2, 0.3}, direction));
}

TEST(Intersect, NeverGivesNonsense) {
    const double odd[] = {0,       -0.0,   5e-324, -1e-310, 1e-300, 1e300, -1e300,    no_end,
                          -no_end, nan,    1,      -1,      0.5,    0.25,  1e-17,     -1e-17,
                          1e-160,  -1e160, 1e12,   -1e9,    0.75,   1.25,  1 + 1e-15, 1e-9};
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> plain(-1.5, 1.5);
    const auto number = [&](unsigned weird) {
        return random() % 8 < weird ? odd[random() % std::size(odd)] : plain(random);
    };
    int met = 0;
    const std::vector<Primitive> all = test::all_primitives();
    for (int i = 0; i < 1'000'000; ++i) {
        const unsigned weird = i % 5;
        const Ray ray{{number(weird), number(weird), number(weird)},
                      {number(weird), number(weird), number(weird)}};
        const RayRange range{i % 3 ? 0 : number(weird), i % 3 ? no_end : number(weird)};
        PrimitiveHit hit;
        // Half of them frusta would be too many.
        const Primitive& kind = all[static_cast<std::size_t>(i % 2 ? i / 2 % 8 : i / 2) % all.size()];
        if (!intersect(kind, ray, range, hit)) continue;
        ++met;
        ASSERT_TRUE(std::isfinite(hit.t) && hit.t > range.least && hit.t < range.most)
            << i << ' ' << name_of(kind) << ' ' << hit.t;
        ASSERT_NEAR(glm::length(hit.normal), 1, 1e-12) << i << ' ' << name_of(kind);
    }
    EXPECT_GT(met, 100'000);
}

} // namespace
} // namespace graftal
