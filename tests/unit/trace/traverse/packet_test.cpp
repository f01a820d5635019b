// Rays in packets meet what each of them meets alone, to the last bit, by whatever instructions.

#include <array>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

constexpr std::size_t together = Surfaces::most_together;
using Packet = std::array<Ray, together>;

/// Parts on a lattice, so that many touch or lie in each other, in as many colours. Some are triangles, in
/// any direction, or balls.
Graph random_model(std::mt19937_64& random, bool terminal) {
    Graph graph = empty_graph();
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId triangle = graph.primitive(PrimitiveKind::triangle);
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    const auto share = [&] { return static_cast<double>(random() % 5) / 4; };
    const std::size_t count = 4 + random() % 12;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 at(share() - 0.5, share() - 0.5, share() - 0.5);
        const Affine even = Affine::translate(1.4 * at) * Affine::scale(Vec3(random() % 2 ? 0.25 : 0.3));
        const Tint tint{{share(), share(), share()}, 0.5};
        const Affine turned = even * Affine::rotate({1, 2, 3}, 90.0 * static_cast<double>(random() % 4) + 10);
        switch (random() % 8) {
        case 0:
            place(graph, self, triangle, turned, tint);
            break;
        case 1:
            place(graph, self, triangle, even, tint);
            break;
        case 2:
            place(graph, self, ball, even, tint);
            break;
        case 3:
            place(graph, self, cube, even, tint);
            break;
        default:
            place(graph, self, self, even, tint);
        }
    }
    place(graph, self, self, Affine::translate(Vec3(0.5)) * Affine::scale(Vec3(0.25)));
    if (terminal) graph.objects[self].terminal = Instance{cube, {}, {}, {}, {}};
    place(graph, graph.root, self, {});
    return graph;
}

/// Neighbours of a picture; beside each other along a plane of the lattice; or each anywhere.
Packet random_packet(const View& view, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    const CameraRays camera(view);
    const double x = view.size.width * (0.5 + 0.4 * unit(random)),
                 y = view.size.height * (0.5 + 0.4 * unit(random)), step = std::exp2(4 * unit(random));
    const Vec3 from = 0.4 * any(), along = any();
    const auto kind = random() % 4;
    Packet rays;
    for (std::size_t i = 0; i < together; ++i) {
        const auto column = static_cast<double>(i % 4), row = static_cast<double>(i / 4);
        if (kind < 2)
            rays[i] = camera.through(x + step * column, y + step * row);
        else if (kind == 2)
            rays[i] = {Vec3(0.25 * column - 0.35, 0.125 * row, 3), {1e-3, 1e-3 * row, -1}};
        else
            rays[i] = {from + 0.01 * any(), along + 0.05 * any()};
    }
    return rays;
}

struct Tally {
    std::size_t rays = 0, hits = 0;
};

void expect_as_alone(const TraceModel& model, std::mt19937_64& random, int packets, Tally& tally) {
    Traversal alone(model), packet(model), portable(model, Instructions::portable);
    for (int i = 0; i < packets; ++i) {
        const Packet rays = random_packet(model.view, random);
        const std::size_t count = random() % 4 ? together : 1 + random() % together;
        const RayRange range{random() % 2 ? 0 : 1e-6, random() % 4 ? INFINITY : 3.0};
        std::array<SurfaceHit, together> hits, narrow;
        const std::span some = std::span(rays).first(count);
        const std::uint32_t met = packet.closest_each(some, range, hits);
        ASSERT_EQ(portable.closest_each(some, range, narrow), met);
        for (std::size_t k = 0; k < count; ++k, ++tally.rays) {
            SCOPED_TRACE(i);
            SurfaceHit hit;
            ASSERT_EQ(alone.closest(rays[k], range, hit), (met >> k & 1) != 0) << k;
            if (!(met >> k & 1)) continue;
            ++tally.hits;
            for (const SurfaceHit* other : {&hits[k], &narrow[k]}) {
                ASSERT_EQ(hit.t, other->t) << k;
                ASSERT_EQ(hit.normal, other->normal) << k;
                ASSERT_EQ(hit.rgb, other->rgb) << k;
                ASSERT_EQ(hit.material, other->material) << k;
                ASSERT_EQ(hit.light_share, other->light_share) << k;
                ASSERT_EQ(hit.node, other->node) << k;
                ASSERT_EQ(hit.levels, other->levels) << k;
            }
        }
    }
    EXPECT_EQ(packet.visits(), portable.visits());
}

TEST(TraversalPacket, MeetsWhatItsRaysMeetAlone) {
    Tally tally;
    std::size_t even = 0;
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        const bool terminal = seed % 2 != 0;
        const Graph graph = random_model(random, terminal);
        DetailOptions options;
        options.error_px = seed % 3 == 0 ? 0 : static_cast<double>(seed % 3);
        if (options.error_px == 0 || seed % 5 == 0) options.steps = static_cast<unsigned>(1 + seed % 4);
        const auto model = traced(graph, options);
        even += model->even;
        expect_as_alone(*model, random, 60, tally);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(even, 100u);
    EXPECT_GT(tally.hits, tally.rays / 10);
}

TEST(TraversalPacket, LeavesRaysAloneThatMayBeGivenUp) {
    std::mt19937_64 random(7);
    const Graph graph = random_model(random, true);
    DetailOptions options;
    options.error_px = 0.5;
    const auto model = traced(graph, options);
    model->most_visits = 3;
    Tally tally;
    expect_as_alone(*model, random, 200, tally);
    EXPECT_GT(tally.hits, 0u);
}

} // namespace
} // namespace graftal
