// Models whose parts are only scaled evenly and moved: the short way through them is the general way.

#include "runtime/trace/traverse/traversal.h"

#include <memory>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

/// The twenty cubes along the edges of a cube, in two colours, each again; with a terminal or balls for what
/// is culled. Sevenths of ten are rounded, so that the order of operations shows; quarters keep directions in
/// the general way, too.
Graph sponge(bool terminal) {
    Graph graph = empty_graph();
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x * x + y * y + z * z >= 2)
                    place(graph, self, self,
                          Affine::translate(0.7 * Vec3(x, y, z)) * Affine::scale(Vec3(0.25)),
                          {{x == 0, y == 0, 1}, 0.3});
    if (terminal) graph.objects[self].terminal = Instance{cube, {}, {}, {}, {}};
    place(graph, graph.root, self, {});
    return graph;
}

struct EvenCase {
    Graph graph;
    DetailOptions options;
};

EvenCase even_case(bool terminal, double error_px, std::optional<unsigned> steps = {}) {
    EvenCase one{sponge(terminal), {}};
    one.options.error_px = error_px;
    one.options.steps = steps;
    return one;
}

/// Rays from the eye and from the places that they meet; the same bits both ways.
void expect_equal_bits(const TraceModel& even, const TraceModel& general) {
    Traversal a(even), b(general);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto direction = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    Ray ray{even.view.camera.location, {0, 0, -1}};
    std::size_t hits = 0;
    for (int i = 0; i < 6000; ++i) {
        const RayRange range{i % 2 ? 1e-6 : 0.0};
        SurfaceHit hit, other;
        const bool found = b.closest(ray, range, other);
        ASSERT_EQ(a.closest(ray, range, hit), found) << i;
        ASSERT_EQ(a.meets_any(ray, range), b.meets_any(ray, range)) << i;
        ray = {even.view.camera.location, Vec3(0, 0, -1) + 0.3 * direction()};
        if (!found) continue;
        ++hits;
        ASSERT_EQ(hit.t, other.t) << i;
        ASSERT_EQ(hit.normal, other.normal) << i;
        ASSERT_EQ(hit.rgb, other.rgb) << i;
        ASSERT_EQ(hit.node, other.node) << i;
        ASSERT_EQ(hit.levels, other.levels) << i;
        if (i % 3) ray = {ray(hit.t), direction()};
    }
    EXPECT_GT(hits, 500u);
    EXPECT_EQ(a.visits(), b.visits());
    EXPECT_EQ(a.work(), b.work());
    EXPECT_EQ(a.given_up(), b.given_up());
}

TEST(TraversalEven, GivesTheSameBits) {
    int number = 0;
    for (const EvenCase& one : {even_case(true, 2), even_case(true, 0.5), even_case(true, 0, 3),
                                even_case(true, 1, 3), even_case(false, 3), even_case(false, 1, 4)})
        for (const auto& eye : {std::optional<Vec3>(), std::optional(Vec3(0.05, 0.1, 0.9))}) {
            SCOPED_TRACE(++number);
            const auto even = traced(one.graph, one.options, eye),
                       general = traced(one.graph, one.options, eye);
            ASSERT_TRUE(even->even);
            general->even = false;
            expect_equal_bits(*even, *general);
        }
}

TEST(TraversalEven, GivesUpWhereOthersDo) {
    const EvenCase one = even_case(true, 0.5);
    const auto even = traced(one.graph, one.options), general = traced(one.graph, one.options);
    general->even = false;
    even->most_visits = general->most_visits = 3;
    expect_equal_bits(*even, *general);
    Traversal traversal(*even);
    SurfaceHit hit;
    for (int i = 0; i < 100; ++i)
        traversal.closest({even->view.camera.location, {0.003 * i, 0.002 * i, -1}}, {}, hit);
    EXPECT_GT(traversal.given_up(), 0u);
}

TEST(TraversalEven, IsNotForWhatIsTurnedSqueezedOrEndless) {
    const DetailOptions options = even_case(true, 1).options;
    const auto is_even = [&](const Affine& map, std::optional<PrimitiveKind> other = {}) {
        Graph graph = empty_graph();
        const ObjectId cube = graph.primitive(PrimitiveKind::cube);
        const ObjectId self = graph.add({"self", {}, {}, {}, {}});
        place(graph, self, cube, Affine::scale({0.1, 0.2, 0.3}));
        place(graph, self, self, Affine::translate(Vec3(0.5)) * map);
        place(graph, graph.root, self, {});
        if (other) place(graph, graph.root, graph.primitive(*other), {});
        return traced(graph, options)->even;
    };
    const Affine half = Affine::scale(Vec3(0.5));
    EXPECT_TRUE(is_even(half));
    EXPECT_TRUE(is_even(half, PrimitiveKind::sphere));
    EXPECT_FALSE(is_even(half, PrimitiveKind::plane));
    EXPECT_FALSE(is_even(Affine::rotate({0, 0, 1}, 20) * half));
    EXPECT_FALSE(is_even(Affine::scale(Vec3(0.5, 0.5, 0.25))));
    EXPECT_FALSE(is_even(Affine::scale(Vec3(-0.5))));
}

/// Packets of rays know no packed boxes.
TEST(TraversalEven, IsNotForRuns) {
    auto run = std::make_shared<graftal::Run>();
    for (int i = 0; i < 3; ++i)
        run->add(
            {.base = Vec3(i, 0, 0), .axis = Vec3(0, 1, 0), .radius = 0.1, .shape = PrimitiveKind::cylinder});
    Object twigs{"twigs", {}, {}, {}, {}};
    twigs.packed.run = run;
    twigs.packed.materials.emplace_back();
    Graph graph = empty_graph();
    place(graph, graph.root, graph.add(std::move(twigs)), {});
    const auto model = traced(graph, {});
    EXPECT_FALSE(model->packed_boxes.empty());
    EXPECT_FALSE(model->even);
    EXPECT_FALSE(Traversal(*model).takes_packets());
}

} // namespace
} // namespace graftal
