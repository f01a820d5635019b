// The traversal against the plain definition: every part of the unfolding met by itself, the nearest wins.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/piece.h"
#include "compiler/detail/prepare.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/scene/scene.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/property/random_graph.h"

namespace graftal {
namespace {

struct Leaf {
    Primitive kind = PrimitiveKind::sphere;
    Affine leaf_from_world;
    Rgb rgb;
};

/// All that is drawn, unfolded; nothing if that is too much, or flat or tiny, for the plain way.
std::optional<std::vector<Leaf>> plain_unfolding(const TraceModel& model, std::size_t most) {
    const DetailGraph& cut = model.prepared.cut;
    std::vector<Leaf> leaves;
    Piece root;
    root.node = cut.root;
    root.steps = model.prepared.root_steps;
    std::vector<Piece> stack = {root};
    while (!stack.empty()) {
        const Piece piece = stack.back();
        stack.pop_back();
        const DetailNode& node = cut.nodes[piece.node];
        if (node.sealed || leaves.size() + stack.size() > most) return std::nullopt;
        const bool is_cut = graftal::is_cut(node, piece.steps, detail_of(cut, model.projection, piece),
                                            model.projection.error_px());
        const auto add = [&](const Primitive& kind, const Affine& place, const Rgb& base) {
            if (is_singular(place, 1e-4) || norm(place.linear) < 1e-6) return false;
            leaves.push_back({kind, inverse(place), piece.tint.over(base)});
            return true;
        };
        if (node.primitive) {
            if (!add(*node.primitive, piece.world_from_node, piece.inherited)) return std::nullopt;
        } else if (edge_count(node, is_cut) == 0) {
            if (!add(PrimitiveKind::sphere, piece.world_from_node * node.node_from_proxy,
                     colour_of_proxy(node).over(piece.inherited)))
                return std::nullopt;
        } else {
            for_each_edge(node, is_cut, [&](const DetailEdge& edge) {
                stack.push_back(descend(cut, piece, edge, is_cut));
            });
        }
    }
    return leaves;
}

struct PlainHit {
    double t = 0;
    double next = 0; ///< the second hit
    Rgb rgb{0.0};
    bool found = false;
};

PlainHit meet_plainly(const std::vector<Leaf>& leaves, const Ray& ray, const RayRange& range) {
    PlainHit best{range.most, range.most};
    for (const Leaf& leaf : leaves) {
        Ray local{leaf.leaf_from_world(ray.origin), leaf.leaf_from_world.linear * ray.direction};
        const double unit = 1 / largest_entry(local.direction);
        // Brought near first, as intersect() asks.
        const double shift =
            -glm::dot(local.origin, local.direction) / glm::dot(local.direction, local.direction);
        local.origin = local(shift);
        local.direction *= unit;
        PrimitiveHit hit;
        const RayRange near{(range.least - shift) / unit, (best.next - shift) / unit};
        if (!intersect(leaf.kind, local, near, hit)) continue;
        const double t = shift + unit * hit.t;
        if (t < best.t) {
            best.next = best.t;
            best.t = t;
            best.rgb = leaf.rgb;
            best.found = true;
        } else {
            best.next = std::min(best.next, t);
        }
    }
    return best;
}

View view_of(const Graph& graph, const std::vector<ObjectBounds>& bounds) {
    View view;
    view.size = {64, 48};
    const Box& box = bounds[graph.root].box;
    const double reach = std::max(glm::length(box.size()), 1e-6);
    view.camera.location = box.centre() + Vec3(0, 0, 2 * reach);
    return view;
}

/// Rays from outside at and past the model, along axes, and from within it.
Ray random_ray(const Box& box, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    const Vec3 half = 0.5 * box.size() + Vec3(1e-9);
    const Vec3 target = box.centre() + half * any();
    Ray ray;
    switch (random() % 4) {
    case 0:
        ray.origin = target; // from within
        ray.direction = any() + Vec3(1e-3, 0, 0);
        break;
    case 1:
        ray.direction = Vec3(0.0);
        ray.direction[static_cast<int>(random() % 3)] = random() % 2 ? 1 : -1;
        ray.origin = target - 3 * glm::length(half) * ray.direction;
        break;
    default:
        ray.origin = box.centre() + 3 * glm::length(half) * glm::normalize(any() + Vec3(1e-3, 0, 0));
        ray.direction = target - ray.origin;
    }
    ray.direction = glm::normalize(ray.direction) * std::exp2(4 * unit(random));
    return ray;
}

struct Tally {
    std::size_t models = 0, rays = 0, hits = 0, differing = 0;
};

void compare(const TraceModel& model, const std::vector<Leaf>& leaves, std::mt19937_64& random,
             Tally& tally) {
    Traversal traversal(model), portable(model, Instructions::portable);
    const Box& box = model.edges.front().box;
    const double size = glm::length(box.size());
    for (int i = 0; i < 60; ++i, ++tally.rays) {
        const Ray ray = random_ray(box, random);
        const RayRange range{1e-9 * size, 1e30};
        const PlainHit plain = meet_plainly(leaves, ray, range);
        SurfaceHit hit, twin;
        const bool found = traversal.closest(ray, range, hit);
        ASSERT_EQ(portable.closest(ray, range, twin), found);
        if (found) {
            ASSERT_EQ(hit.t, twin.t);
            ASSERT_EQ(hit.normal, twin.normal);
            ASSERT_NEAR(glm::length(hit.normal), 1, 1e-9);
        }
        ASSERT_EQ(traversal.meets_any(ray, range), found);
        tally.hits += found;
        const double tolerance = 1e-7 * (size / glm::length(ray.direction) + plain.t);
        bool same = found == plain.found && (!found || std::abs(hit.t - plain.t) <= tolerance);
        // Where two parts coincide either may show.
        if (same && found && plain.next - plain.t > 4 * tolerance)
            same = glm::distance(hit.rgb, plain.rgb) < 1e-9;
        tally.differing += !same;
    }
}

/// Rays together meet what each meets alone, to the last bit.
void compare_packets(const TraceModel& model, std::mt19937_64& random) {
    Traversal alone(model), packet(model), portable(model, Instructions::portable);
    const Box& box = model.edges.front().box;
    const RayRange range{1e-9 * glm::length(box.size()), 1e30};
    for (int i = 0; i < 12; ++i) {
        const Ray first = random_ray(box, random), last = random_ray(box, random);
        const double apart = i % 2 ? 1 : 0.02; // from one to the other, or some way
        std::array<Ray, Surfaces::most_together> rays;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            const double share = apart * static_cast<double>(k) / rays.size();
            rays[k].origin = first.origin + share * (last.origin - first.origin);
            rays[k].direction = first.direction + share * (last.direction - first.direction);
        }
        std::array<SurfaceHit, Surfaces::most_together> hits, narrow;
        const std::uint32_t met = packet.closest_each(rays, range, hits);
        ASSERT_EQ(portable.closest_each(rays, range, narrow), met);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            SurfaceHit hit;
            ASSERT_EQ(alone.closest(rays[k], range, hit), (met >> k & 1) != 0);
            if (!(met >> k & 1)) continue;
            for (const SurfaceHit* other : {&hits[k], &narrow[k]}) {
                ASSERT_EQ(hit.t, other->t);
                ASSERT_EQ(hit.normal, other->normal);
                ASSERT_EQ(hit.rgb, other->rgb);
                ASSERT_EQ(hit.node, other->node);
                ASSERT_EQ(hit.levels, other->levels);
            }
        }
    }
}

TEST(TraversalProperty, MeetsWhatThePlainUnfoldingMeets) {
    Tally tally;
    for (std::uint64_t seed = 1; seed <= 1200; ++seed) {
        testing::Choices choices(seed);
        const Graph graph =
            drop_unreachable(
                testing::random_graph(choices, {.duplicates = false, .runs = seed > 1000 || seed % 4 == 0}))
                .graph;
        const Components components = strong_components(graph);
        const Contraction contraction = decide_contraction(graph, components);
        if (contraction.verdict != Verdict::acyclic && contraction.verdict != Verdict::proved) continue;
        const std::vector<ObjectBounds> bounds = bound_objects(graph, components, contraction);
        const Box& box = bounds[graph.root].box;
        if (box.empty() || bounds[graph.root].unbounded) continue;
        if (std::max(largest_entry(box.min), largest_entry(box.max)) > 1e100)
            continue; // refused by compile.cpp
        DetailOptions options;
        options.error_px = seed % 3 == 0 ? 2 : 0;
        if (options.error_px == 0 || seed % 2 == 0) options.steps = static_cast<unsigned>(seed % 4);
        const TraceModel model(std::make_shared<const PreparedGraph>(
                                   prepare_graph(graph, components, bounds, options.preparing())),
                               view_of(graph, bounds), options);
        const auto leaves = plain_unfolding(model, 400);
        if (!leaves || leaves->empty()) continue;
        std::mt19937_64 random(seed);
        const std::size_t before = tally.differing;
        compare(model, *leaves, random, tally);
        compare_packets(model, random);
        if (HasFatalFailure()) FAIL() << "seed " << seed;
        EXPECT_LE(tally.differing - before, 1u) << "seed " << seed;
        ++tally.models;
    }
    EXPECT_GT(tally.models, 50u);
    EXPECT_GT(tally.hits, tally.rays / 10);
    // A ray may graze an edge.
    EXPECT_LE(tally.differing, tally.rays / 5000) << tally.rays << " rays at " << tally.models << " models";
}

} // namespace
} // namespace graftal
