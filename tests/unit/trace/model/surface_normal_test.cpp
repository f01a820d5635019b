// The limit's normals, as the meshes get them and as rays find them: two ways to one field.

#include "runtime/trace/model/surface_normal.h"

#include <cmath>
#include <random>

#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "compiler/detail/leaf_walk.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

constexpr unsigned levels = 4;

DetailOptions options(bool limit_normals) {
    DetailOptions options;
    options.error_px = 0;
    options.steps = levels;
    options.limit_normals = limit_normals;
    return options;
}

/// Seven of a cube's eight corners, half as large, turned and moved.
Graph corners() {
    Graph graph = empty_graph();
    for (int i = 0; i < 7; ++i)
        place(graph, graph.root, graph.root,
              Affine::translate({i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5}) *
                  Affine::rotate({1, 2, 3}, 20 * i) * Affine::scale(Vec3(0.5)));
    return graph;
}

/// What the walk through the leaves of a mesh says of the point: the normals of the leaf that it lies on.
Vec3 normal_by_leaves(const std::vector<WalkedLeaf>& leaves, Vec3 point) {
    double nearest = 1e300;
    Vec3 normal(0.0);
    for (const WalkedLeaf& leaf : leaves) {
        const Affine& place = leaf.representative_from_leaf;
        const Vec3 local = inverse(place)(point);
        const double off = std::abs(glm::length(local) - 1);
        if (off >= nearest) continue;
        nearest = off;
        const Vec3 own = glm::normalize(glm::transpose(inverse(place).linear) * local);
        normal = glm::normalize(own + leaf.normals.at(point));
    }
    EXPECT_LT(nearest, 1e-6);
    return normal;
}

TEST(LimitNormal, IsThatOfTheMeshes) {
    const auto model = traced(corners(), options(true));
    const DetailGraph& cut = model->prepared.cut;
    const Symmetry& symmetry = model->prepared.symmetry;
    BakeRequest request;
    request.representative = cut.root;
    request.steps = model->prepared.root_steps;
    request.detail_per_unit = INFINITY;
    request.painters = {{symmetry.pair[cut.root], Rgb(0.8)}};
    request.limit_normals = true;
    LeafWalk walk(cut, symmetry, request, request.painters);
    std::vector<WalkedLeaf> leaves;
    for (WalkedLeaf leaf; walk.next(leaf);)
        leaves.push_back(leaf);
    ASSERT_EQ(leaves.size(), 2401u);
    Traversal traversal(*model);
    const auto plain = traced(corners(), options(false));
    Traversal own(*plain);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    int hits = 0, turned = 0;
    for (int i = 0; i < 2000; ++i) {
        const Ray ray{{unit(random), unit(random), 5}, {0.1 * unit(random), 0.1 * unit(random), -1}};
        SurfaceHit hit, own_hit;
        if (!traversal.closest(ray, {}, hit)) continue;
        ASSERT_TRUE(own.closest(ray, {}, own_hit));
        ++hits;
        const Vec3 expected = normal_by_leaves(leaves, ray(hit.t));
        EXPECT_NEAR(glm::distance(hit.normal, expected), 0, 1e-5) << i;
        if (glm::distance(own_hit.normal, hit.normal) > 0.1) ++turned;
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(turned, hits / 2); // else nothing was tested
}

TEST(LimitNormal, FieldIsSeenFromFramesThatAreScaledAndMoved) {
    NormalField field;
    field.add(1, {1, 2, 3}, 2);
    field.add(2, {-1, 0, 1}, 5);
    const Vec3 shift(3, -1, 2), point(0.3, 0.7, -0.2);
    EXPECT_NEAR(glm::distance(field.seen_from(4, shift).at(point), field.at(4.0 * point + shift)), 0, 1e-12);
    const Vec3 expected = (point - Vec3(1, 2, 3)) / 3.0 + (point - Vec3(-1, 0, 1)) / 11.25;
    EXPECT_NEAR(glm::distance(field.at(point), expected), 0, 1e-12);
    const Vec3 before = field.at(point);
    field.add(3, {9, 9, 9}, 0); // a ball without size says nothing
    EXPECT_EQ(field.at(point), before);
}

} // namespace
} // namespace graftal
