// Runs are cut as the instances that they mean are.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/contraction.h"
#include "compiler/detail/graph/build_detail_graph.h"
#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/prepare.h"
#include "compiler/povray/cut/cut.h"
#include "tests/unit/povray/cut/cut_graph.h"

namespace graftal {
namespace {

/// A crooked branch of many segments, in two materials.
std::shared_ptr<const Run> branch(std::size_t count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    auto run = std::make_shared<Run>();
    Vec3 at(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        RunItem item;
        item.base = at;
        item.axis = 0.1 * Vec3(unit(random), 0.3 + unit(random), unit(random));
        item.radius = 0.02;
        item.shape = i % 7 == 0 ? tapered(0.5) : PrimitiveKind::cylinder;
        item.ball = item.shape == PrimitiveKind::cylinder;
        item.colour = static_cast<std::uint16_t>(i % 2);
        at += item.axis;
        run->add(item);
    }
    return run;
}

Graph with_materials() {
    Graph graph;
    for (const double red : {0.2, 0.9}) {
        Material material;
        material.name = red < 0.5 ? "dark" : "light";
        material.rgb = {red, 0.5, 0.1};
        graph.materials.push_back(material);
    }
    return graph;
}

/// Two placements of the branch and more, as a run or spelt out.
Graph two_branches(std::size_t count, bool spelt, int more = 0) {
    Graph graph = with_materials();
    const auto run = branch(count);
    Object object;
    object.name = "branch";
    if (spelt) {
        const auto add = [&](const Primitive& kind, const Affine& place, MaterialId material) {
            object.instances.push_back({graph.primitive(kind), place, {}, material, {}});
        };
        for (std::size_t i = 0; i < count; ++i) {
            const RunItem& item = (*run)[i];
            add(item.shape.primitive(), run_from_body(item), item.colour);
            if (item.ball) add(PrimitiveKind::sphere, run_from_ball(item), item.colour);
        }
    } else {
        object.packed.run = run;
        object.packed.materials = {MaterialId{0}, MaterialId{1}};
    }
    Object root;
    root.name = "two";
    const ObjectId master = graph.add(std::move(object));
    root.instances.push_back({master, {}, {}, {}, {}});
    root.instances.push_back(
        {master,
         Affine::translate({3, 0, 0}) * Affine::rotate({1, 2, 3}, 50) * Affine::scale(Vec3(0.5)),
         {},
         {},
         {}});
    for (int i = 0; i < more; ++i)
        root.instances.push_back({master, Affine::translate({5.0 + 2 * i, 0, 0}), {}, {}, {}});
    graph.root = graph.add(std::move(root));
    return graph;
}

struct Bounded {
    explicit Bounded(Graph g)
        : graph(std::move(g)), components(strong_components(graph)),
          bounds(bound_objects(graph, components, decide_contraction(graph, components))) {}

    Graph graph;
    Components components;
    std::vector<ObjectBounds> bounds;
};

View front_view(const Bounded& model, double distance) {
    const Box& box = model.bounds[model.graph.root].box;
    View view;
    view.size = {640, 480};
    view.camera.location = box.centre() + Vec3(0, 0, distance * glm::length(box.size()));
    return view;
}

Cut cut_of(const Bounded& model, const DetailOptions& options, double distance = 1.5, bool flatten = false) {
    Diagnostics diagnostics;
    std::optional<Cut> cut =
        test::cut_graph(model.graph, model.components, model.bounds, front_view(model, distance), options,
                        diagnostics, {.flatten = flatten});
    EXPECT_TRUE(cut) << diagnostics.render(SourceMap());
    return cut ? std::move(*cut) : Cut();
}

using Drawn = std::array<long long, 7>;

/// Where primitives stand, how large they are, and in which colour.
std::vector<Drawn> drawn(const Cut& cut) {
    std::vector<Drawn> all;
    const auto digits = [](double x) { return std::llround(x * 1e8); };
    for (const PlacementGroup& group : cut.groups)
        for_each_placement(group, [&](const Placement& placement) {
            const Affine& place = placement.world_from_body;
            const auto* kind = std::get_if<Primitive>(&cut.bodies[placement.body].shape);
            all.push_back({kind ? static_cast<long long>(kind->kind()) * 256 + kind->steps() : -1,
                           digits(place.translation.x), digits(place.translation.y),
                           digits(place.translation.z), digits(glm::length(place.linear[0])),
                           digits(glm::length(place.linear[1])), digits(cut.palettes[group.palette][0].r)});
        });
    std::ranges::sort(all);
    return all;
}

Cut spelt_out(const Bounded& model) {
    return cut_of(model, {.error_px = 0}, 1.5, true);
}

TEST(RunCut, EverySizeOfRunIsDrawnWhole) {
    for (const std::size_t count : {1u, 5u, 40u, 300u, 3000u}) {
        const Cut run = spelt_out(Bounded(two_branches(count, false)));
        const Cut spelt = spelt_out(Bounded(two_branches(count, true)));
        EXPECT_EQ(run.placement_count, spelt.placement_count) << count;
        EXPECT_EQ(drawn(run), drawn(spelt)) << count;
    }
}

TEST(RunCut, PartsArePlacedWhereTheRunHasThem) {
    const Cut cut = spelt_out(Bounded(two_branches(3000, false)));
    std::uint64_t parts = 0;
    std::size_t ranges = 0;
    for (const PlacementGroup& group : cut.groups) {
        EXPECT_TRUE(group.placements.empty()); // each would take as much as three parts do
        for (const PackedPlacements& packed : group.packed) {
            parts += packed.size();
            ++ranges;
        }
    }
    EXPECT_EQ(parts, cut.placement_count);
    EXPECT_EQ(ranges, 4u); // two colours, two branches
}

TEST(RunCut, PartsThatCoincideArePlacedOnce) {
    auto run = std::make_shared<graftal::Run>();
    for (int i = 0; i < 300; ++i) {
        RunItem item;
        item.base = {i % 3 == 0 ? 0.0 : 1.0, 2, 3};
        item.axis = {0.5, 0.25, 1};
        item.radius = 0.1;
        item.turn = static_cast<std::uint32_t>(i); // nobody sees how what is round is turned
        item.shape = PrimitiveKind::cylinder;
        item.ball = i % 2 == 0;
        run->add(item);
    }
    Graph graph = with_materials();
    Object object;
    object.name = "pile";
    object.packed.run = run;
    object.packed.materials = {MaterialId{0}};
    graph.root = graph.add(std::move(object));
    EXPECT_EQ(spelt_out(Bounded(std::move(graph))).placement_count, 4u);
}

TEST(RunCut, MeshesHaveAsManyTriangles) {
    DetailOptions options{.error_px = 0};
    options.memory_bytes = 200'000'000; // too little to spell all out
    const Cut run = cut_of(Bounded(two_branches(3000, false, 60)), options);
    const Cut spelt = cut_of(Bounded(two_branches(3000, true, 60)), options);
    EXPECT_GT(run.triangle_count, 0u);
    EXPECT_NEAR(static_cast<double>(run.triangle_count), static_cast<double>(spelt.triangle_count),
                0.2 * static_cast<double>(spelt.triangle_count));
}

TEST(RunCut, RangesAreCulledBeforeTheWhole) {
    const Bounded model(two_branches(20'000, false));
    const DetailOptions options{.error_px = 4};
    const Cut near = cut_of(model, options, 1), far = cut_of(model, options, 30);
    EXPECT_GT(near.placement_count + near.triangle_count, 10 * (far.placement_count + far.triangle_count));
    EXPECT_GT(far.error_px, 0);
    EXPECT_LE(far.error_px, 4);
}

TEST(RunCut, WhatIsOutOfSightIsNamedWhereMemoryLacks) {
    const Bounded model(two_branches(20'000, false));
    DetailOptions options{.error_px = 0.5};
    options.memory_bytes = 30'000'000;
    const auto hints = [&](double distance) {
        Diagnostics diagnostics;
        EXPECT_TRUE(test::cut_graph(model.graph, model.components, model.bounds, front_view(model, distance),
                                    options, diagnostics));
        return diagnostics.render(SourceMap());
    };
    const std::string near = hints(0.05), far = hints(3);
    EXPECT_NE(near.find("--memory, leave out invisible parts with --visible-only"), std::string::npos)
        << near;
    EXPECT_NE(far.find("allow an error of"), std::string::npos) << far;
    EXPECT_EQ(far.find("--visible-only"), std::string::npos) << far;
    options.visible_only = true;
    EXPECT_EQ(hints(0.05).find("--visible-only"), std::string::npos);
}

TEST(RunCut, CellsHoldNoEdges) {
    const Bounded model(two_branches(20'000, false));
    const PreparedGraph prepared = prepare_graph(model.graph, model.components, model.bounds, {});
    std::size_t edges = 0, items = 0;
    for (const DetailNode& node : prepared.cut.nodes) {
        edges += node.edges.size();
        if (node.cell) items += node.cell->count;
    }
    EXPECT_EQ(items, 20'000u);
    EXPECT_LT(edges, 200u); // memory goes with these
}

TEST(RunCut, CellsKnowTheSizesOfPartsHoweverLargeOrSmall) {
    const auto octave = [](double size) {
        auto run = std::make_shared<graftal::Run>();
        for (int i = 0; i < 200; ++i) {
            RunItem item;
            item.base = size * Vec3(i, 0, 0);
            item.axis = size * Vec3(0.75, 0, 0);
            item.radius = 0.02 * size;
            item.shape = PrimitiveKind::cylinder;
            run->add(item);
        }
        Graph graph;
        Object object;
        object.name = "row";
        object.packed.run = run;
        object.packed.materials.resize(1);
        graph.root = graph.add(std::move(object));
        const Bounded model(std::move(graph));
        const DetailGraph cut = build_detail_graph(model.graph, model.bounds);
        EXPECT_TRUE(cut.nodes[cut.root].cell);
        return cut.nodes[cut.root].cell->alike.at(0).quarter_octave;
    };
    EXPECT_EQ(octave(1), -2); // 0.75^4 lies between 1/4 and 1/2
    EXPECT_EQ(octave(0x1p270), 4 * 270 - 2);
    EXPECT_EQ(octave(0x1p-290), -4 * 290 - 2);
}

TEST(RunCut, ProxiesAreAsDarkAsWhatTheyStandFor) {
    // Few thin parts in a large box leave most of it open, many fill it.
    for (const auto& [radius, least, most] : {std::tuple(1e-4, 0.0, 0.05), std::tuple(0.5, 0.7, 1.0)}) {
        auto run = std::make_shared<graftal::Run>();
        for (int i = 0; i < 200; ++i) {
            RunItem item;
            item.base = {std::sin(3.7 * i), std::sin(5.1 * i), std::sin(7.3 * i)};
            item.axis = {0.2 * std::cos(i), 0.2 * std::sin(i), 0.1};
            item.radius = radius;
            item.shape = PrimitiveKind::cylinder;
            run->add(item);
        }
        Graph graph;
        Object object;
        object.name = "cloud";
        object.packed.run = run;
        object.packed.materials.resize(1);
        graph.root = graph.add(std::move(object));
        const Bounded model(std::move(graph));
        const DetailGraph cut = build_detail_graph(model.graph, model.bounds);
        const DetailNode& cell = cut.nodes[cut.root];
        ASSERT_TRUE(cell.cell);
        const double share = std::pow(cell.node_from_proxy.linear[0][0] / (0.5 * cell.cell->box.size().x), 2);
        EXPECT_GE(share, least) << radius;
        EXPECT_LE(share, most) << radius;
    }
}

} // namespace
} // namespace graftal
