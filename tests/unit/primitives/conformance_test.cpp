// What each row of the table must keep, whatever the primitive: its functions describe one surface. Each law
// runs over every bounded primitive.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/primitives/intersect.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "tests/unit/primitives/sample_shapes.h"

namespace graftal {
namespace {

using Triangle = std::array<Vec3, 3>;

/// A mesh that is fine, but not too large to look at each triangle often.
int fine(const Primitive& primitive) {
    constexpr std::size_t most_triangles = 10'000;
    int fineness = 0;
    while (fineness < max_fineness(primitive) &&
           tessellated(primitive, fineness + 1).triangles.size() <= most_triangles)
        ++fineness;
    return fineness;
}

std::vector<Triangle> triangles_of(const Primitive& primitive, int fineness) {
    const TessellatedPrimitive& mesh = tessellated(primitive, fineness);
    std::vector<Triangle> triangles;
    for (const auto& [a, b, c] : mesh.triangles)
        triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    return triangles;
}

Vec3 area_vector(const Triangle& t) {
    return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
}

/// Calls `add` with pieces of the triangle, halved across their longest sides until none is longer.
template<typename Add> void cut_small(const Triangle& t, double longest, const Add& add) {
    std::size_t side = 0;
    const auto length = [&](std::size_t k) { return glm::distance(t[k], t[(k + 1) % 3]); };
    for (std::size_t k = 1; k < 3; ++k)
        if (length(k) > length(side)) side = k;
    if (length(side) <= longest) return add(t);
    const Vec3 &a = t[side], &b = t[(side + 1) % 3], &c = t[(side + 2) % 3];
    const Vec3 middle = 0.5 * (a + b);
    cut_small({a, middle, c}, longest, add);
    cut_small({middle, b, c}, longest, add);
}

class Random {
  public:
    double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    Vec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(Vec3(normal(random_), normal(random_), normal(random_)));
    }
    std::size_t below(std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
    }

  private:
    std::mt19937_64 random_{7};
};

std::vector<Primitive> bounded_primitives() {
    std::vector<Primitive> bounded;
    for (const Primitive& primitive : test::sample_primitives())
        if (traits_of(primitive).bounded) bounded.push_back(primitive);
    return bounded;
}

class Conformance : public testing::TestWithParam<Primitive> {
  protected:
    const Primitive primitive = GetParam();
    const PrimitiveTraits& traits = traits_of(primitive);
    const int fineness = fine(primitive);
    const double error = tessellation_error(primitive, fineness);
    Random random;
};

TEST_P(Conformance, SupportIsThatOfTheMesh) {
    const TessellatedPrimitive& mesh = tessellated(primitive, fineness);
    for (int i = 0; i < 200; ++i) {
        const Vec3 direction = random.direction();
        double farthest = -INFINITY;
        for (const Vec3& vertex : mesh.vertices)
            farthest = std::max(farthest, glm::dot(vertex, direction));
        const double support = primitive_support(primitive, 3.0 * direction) / 3;
        if (const auto reach = traits_of(primitive).reach) {
            const double size = glm::length(traits_of(primitive).box(primitive).size());
            EXPECT_GE(reach(primitive, 3.0 * direction) / 3, support - 1e-12 * size);
            EXPECT_LE(reach(primitive, 3.0 * direction) / 3, support + size);
        }
        EXPECT_NEAR(support, farthest, 2 * error + 1e-9);
    }
}

TEST_P(Conformance, BoundsHoldTheSurfaceAndTouchIt) {
    const Box box = traits.box(primitive);
    const Ball ball = traits.ball(primitive);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p = traits.site(primitive, {random.unit(), random.unit(), random.unit()}).point;
        EXPECT_LE(glm::distance(p, ball.centre), ball.radius * (1 + 1e-12));
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(p[axis], box.min[axis] - 1e-12);
            EXPECT_LE(p[axis], box.max[axis] + 1e-12);
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 along(0.0);
        along[axis] = 1;
        EXPECT_NEAR(primitive_support(primitive, along), box.max[axis], 1e-9);
        EXPECT_NEAR(-primitive_support(primitive, -along), box.min[axis], 1e-9);
    }
}

TEST_P(Conformance, HullAndConvexPartsHoldTheSurface) {
    const std::vector<HullPiece> hull = traits.hull(primitive);
    const std::vector<ConvexPart> parts = traits.convex_parts(primitive);
    const double size = traits.ball(primitive).radius;
    for (int i = 0; i < 200; ++i) {
        const Vec3 direction = random.direction();
        double held = -INFINITY, shadow = -INFINITY;
        for (const HullPiece& piece : hull) {
            double reach = glm::dot(piece.place.translation, direction) + piece.thickness;
            if (piece.kind == HullPiece::Kind::disc)
                reach += std::hypot(glm::dot(piece.place.linear[0], direction),
                                    glm::dot(piece.place.linear[2], direction));
            held = std::max(held, reach);
        }
        for (const ConvexPart& part : parts)
            for (const Vec3& corner : part.corners)
                shadow = std::max(shadow, glm::dot(corner, direction));
        const double support = primitive_support(primitive, direction);
        EXPECT_GE(held, support - 1e-9 * size);
        EXPECT_NEAR(shadow, support, 0.3 * size); // shadows are drawn roughly
    }
}

TEST_P(Conformance, RaysMeetTheSurfaceWhereTheMeshIs) {
    const std::vector<Triangle> triangles = triangles_of(primitive, fineness);
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
        const Triangle& t = triangles[random.below(triangles.size())];
        const double u = 0.1 + 0.8 * random.unit(), v = (0.95 - u) * random.unit();
        const Vec3 target = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        const Vec3 normal = glm::normalize(area_vector(t));
        // From a little outside, at a slant.
        const Vec3 way = -glm::normalize(normal + 0.5 * random.direction());
        const double reach = 4 * error + 1e-6;
        const double largest = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
        const Ray ray{target - reach * way, way / largest};
        PrimitiveHit hit;
        // Beside an edge or a silhouette the surface may bend away below the ray.
        if (!intersect(primitive, ray, {0, 6 * reach * largest}, hit)) continue;
        ++met;
        EXPECT_NEAR(glm::length(hit.normal), 1, 1e-9);
        const Vec3 p = ray(hit.t);
        EXPECT_LE(glm::dot(p, hit.normal), primitive_support(primitive, hit.normal) + 1e-9);
    }
    EXPECT_GE(met, 1950);
}

/// From far away a ray meets the surface first where it first meets the mesh.
TEST_P(Conformance, RaysFromAfarMeetWhatTheMeshMeets) {
    const std::vector<Triangle> triangles = triangles_of(primitive, fineness);
    const Ball ball = traits.ball(primitive);
    int compared = 0, differ = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 target = traits.site(primitive, {random.unit(), random.unit(), random.unit()}).point;
        const Vec3 way = random.direction();
        const double largest = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
        const Ray ray{target - 3 * ball.radius * way, way / largest};
        std::optional<double> expected;
        for (const auto& [a, b, c] : triangles) { // by Moeller and Trumbore
            const Vec3 ab = b - a, ac = c - a, from = ray.origin - a, across = glm::cross(ab, ac);
            const double volume = -glm::dot(ray.direction, across);
            const Vec3 moment = glm::cross(from, ray.direction);
            const double u = glm::dot(ac, moment) / volume, v = -glm::dot(ab, moment) / volume;
            const double t = glm::dot(from, across) / volume;
            if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && (!expected || t < *expected)) expected = t;
        }
        PrimitiveHit hit;
        const bool met = intersect(primitive, ray, {}, hit);
        if (met && std::abs(glm::dot(hit.normal, way)) < 0.2) continue; // it grazes
        ++compared;
        const double slant = met ? std::abs(glm::dot(hit.normal, way)) : 1;
        if (met != expected.has_value() ||
            (met && std::abs(hit.t - *expected) / largest * slant > 2 * error + 1e-9))
            ++differ;
    }
    EXPECT_GT(compared, 100);
    EXPECT_LE(differ, compared / 50); // where one of them just misses an edge
}

TEST_P(Conformance, PicturesRunWithoutBreaks) {
    const TextureSpace space = texture_space(primitive, 2, 1.5);
    const std::vector<Triangle> triangles = triangles_of(primitive, fineness);
    std::size_t looked_at = 0;
    for (const Triangle& t : triangles) {
        const auto uv = texture_coordinates(primitive, space, t);
        bool at_pole = false;
        double longest = 0, least_out = INFINITY;
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(std::isfinite(uv[k][0]) && std::isfinite(uv[k][1]));
            EXPECT_LE(std::abs(uv[k][0]), 2 * space.around + 1e-9);
            EXPECT_LE(std::abs(uv[k][1]), 2 * space.along + 1e-9);
            longest = std::max(longest, glm::distance(t[k], t[(k + 1) % 3]));
            least_out = std::min(least_out, std::hypot(t[k].x, t[k].z));
        }
        at_pole = traits.wrap.around && least_out < 0.2;
        if (at_pole) continue; // there the picture comes together in a point
        ++looked_at;
        const double most_a_unit =
            4 * std::max(space.around, space.along) / (traits.wrap.around ? std::min(1.0, least_out) : 1);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_LE(std::abs(uv[k][0] - uv[(k + 1) % 3][0]), most_a_unit * longest);
            EXPECT_LE(std::abs(uv[k][1] - uv[(k + 1) % 3][1]), most_a_unit * longest);
        }
    }
    EXPECT_GT(looked_at, triangles.size() / 5);
}

TEST_P(Conformance, SitesAreSpreadEvenly) {
    constexpr std::size_t bins = 12, count = 40'000;
    std::vector<Triangle> pieces;
    for (const Triangle& t : triangles_of(primitive, fineness))
        cut_small(t, traits.ball(primitive).radius / 40,
                  [&](const Triangle& piece) { pieces.push_back(piece); });
    double whole = 0;
    for (const Triangle& piece : pieces)
        whole += glm::length(area_vector(piece));
    EXPECT_NEAR(whole / traits.area(primitive), 1, 4 * error + 0.01);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(traits.site(primitive, {random.unit(), random.unit(), random.unit()}).point);
    for (const Vec3& across : {Vec3(0.36, 0.48, 0.8), Vec3(0.64, -0.6, 0.48), Vec3(-0.48, 0.8, 0.36)}) {
        // Slabs of about equal area by the mesh, and how many points lie in each.
        std::vector<std::pair<double, double>> heights;
        for (const Triangle& t : pieces)
            heights.emplace_back(glm::dot(t[0] + t[1] + t[2], across) / 3, glm::length(area_vector(t)));
        std::ranges::sort(heights);
        std::vector<double> edges, shares;
        double below = 0, before = 0;
        for (const auto& [height, area] : heights) {
            below += area;
            if (below < whole * static_cast<double>(edges.size() + 1) / bins || edges.size() + 1 == bins)
                continue;
            edges.push_back(height);
            shares.push_back((below - before) / whole);
            before = below;
        }
        shares.push_back((whole - before) / whole);
        std::vector<double> counts(shares.size());
        for (const Vec3& p : points)
            ++counts[static_cast<std::size_t>(std::ranges::upper_bound(edges, glm::dot(p, across)) -
                                              edges.begin())];
        double chi_square = 0;
        for (std::size_t bin = 0; bin < shares.size(); ++bin) {
            const double expected = shares[bin] * count;
            chi_square += (counts[bin] - expected) * (counts[bin] - expected) / expected;
        }
        // With 11 degrees of freedom chance gives more than 45 once in 200,000 times; the mesh adds its
        // error.
        EXPECT_LT(chi_square, 45 + 2000 * error);
    }
}

TEST_P(Conformance, NormalsOfSitesAreThoseThatRaysFind) {
    int met = 0;
    const double step = 1e-4 * traits.ball(primitive).radius;
    for (int i = 0; i < 500; ++i) {
        const SurfaceSite site = traits.site(primitive, {random.unit(), random.unit(), random.unit()});
        EXPECT_NEAR(glm::length(site.normal), 1, 1e-9);
        const Vec3 n = site.normal;
        const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        PrimitiveHit hit;
        if (!intersect(primitive, {site.point + step * n, -n / largest}, {0, 2 * step * largest}, hit))
            continue;
        met += glm::dot(hit.normal, n) > 0.9 ? 1 : 0;
    }
    EXPECT_GT(met, 480);
}

TEST_P(Conformance, MapsThatAreSaidToKeepItDo) {
    std::vector<Affine> maps = {Affine()};
    for (int i = 0; i < 8; ++i) { // signs of the axes
        const Vec3 signs(i & 1 ? -1 : 1, i & 2 ? -1 : 1, i & 4 ? -1 : 1);
        for (const double angle_deg : {0, 37, 60, 90, 120, 180})
            for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)})
                maps.push_back(Affine::rotate(axis, angle_deg) * Affine::scale(signs));
    }
    for (int i = 0; i < 20; ++i) {
        maps.push_back(Affine::rotate(random.direction(), 360 * random.unit()));
        maps.push_back(Affine::translate({0, random.unit(), 0}));
        maps.push_back(Affine::scale(Vec3(0.5 + random.unit())));
    }
    const double size = traits.ball(primitive).radius;
    const Vec3 fixed = traits.fixed_point(primitive);
    int kept = 0;
    for (const Affine& map : maps) {
        if (!traits.keeps(primitive, map)) continue;
        ++kept;
        EXPECT_LT(glm::distance(map(fixed), fixed), 1e-8 * size);
        for (int i = 0; i < 30; ++i) {
            const Vec3 direction = random.direction();
            const double moved =
                glm::dot(map.translation, direction) + primitive_support(primitive, direction * map.linear);
            EXPECT_NEAR(moved, primitive_support(primitive, direction), 1e-8 * size);
            // A moved point lies on the surface: a ray through it meets something there.
            const SurfaceSite site = traits.site(primitive, {random.unit(), random.unit(), random.unit()});
            const Vec3 p = map(site.point), n = map.linear * site.normal;
            const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
            PrimitiveHit hit;
            const double step = 1e-3 * size;
            const double slack = 1e-6 * size;
            const bool meets = intersect(primitive, {p + step * n, -n / largest},
                                         {(step - slack) * largest, (step + slack) * largest}, hit);
            EXPECT_TRUE(meets);
        }
    }
    EXPECT_GE(kept, 1); // the identity
}

TEST_P(Conformance, IsItsOwnName) {
    EXPECT_EQ(primitive_kind_named(name_of(primitive.kind())), primitive.kind());
    EXPECT_TRUE(name_of(primitive).starts_with(name_of(primitive.kind())));
    for (const Primitive& other : test::sample_primitives()) {
        EXPECT_EQ(primitive == other, name_of(primitive) == name_of(other));
        EXPECT_EQ(primitive == other, (primitive <=> other) == 0);
        if (primitive == other) {
            EXPECT_EQ(primitive.hash(), other.hash());
        }
    }
}

std::string test_name(const testing::TestParamInfo<Primitive>& info) {
    std::string name;
    for (const char c : name_of(info.param).substr(0, 40))
        name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name + "_" + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(All, Conformance, testing::ValuesIn(bounded_primitives()), test_name);

} // namespace
} // namespace graftal
