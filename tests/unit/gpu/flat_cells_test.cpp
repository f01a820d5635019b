// Cells of several levels: what they pass over is what the graph would be walked through, once each.

#include "runtime/gpu/flat_cells.h"

#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "compiler/unfolded/drawn_bounds.h"
#include "tests/unit/unfolded/models.h"

namespace graftal {
namespace {

FlatGraph flattened(const Graph& graph) {
    const std::shared_ptr<const PreparedGraph> prepared = test::prepared(graph, {});
    const LayeredGraph layers = layered(prepared->cut, prepared->root_steps);
    std::optional<FlatGraph> flat = flat_graph(layers, drawn_bounds(layers.cut), 0.5, 100'000);
    EXPECT_TRUE(flat);
    return flat ? *flat : FlatGraph{};
}

/// Objects at random, of primitives and of each other, with maps that turn and sometimes stretch.
Graph random_graph(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto within = [&](double least, double most) {
        return std::uniform_real_distribution(least, most)(random);
    };
    const auto vector = [&](double most) {
        return Vec3(within(-most, most), within(-most, most), within(-most, most));
    };
    Graph graph = test::empty_graph();
    graph.materials.resize(2);
    graph.materials[0].name = "bark";
    graph.materials[1].name = "leaf";
    const ObjectId shape = graph.primitive(PrimitiveKind::cylinder);
    std::vector<ObjectId> objects;
    for (int i = 0; i < 4; ++i)
        objects.push_back(graph.add({"object" + std::to_string(i), {}, {}, {}, {}}));
    for (const ObjectId object : objects) {
        test::place(graph, object, shape, Affine::scale(Vec3(0.1, 0.5, 0.1)));
        const int count = 1 + static_cast<int>(within(0, 4));
        for (int i = 0; i < count; ++i) {
            const Affine turn = Affine::rotate(glm::normalize(vector(1) + Vec3(0, 2, 0)), within(0, 6));
            const Vec3 size = within(0, 1) < 0.8 ? Vec3(within(0.2, 0.5)) : Vec3(0.3, within(0.2, 0.4), 0.25);
            test::place(graph, object, objects[static_cast<std::size_t>(within(0, 4))],
                        Affine::translate(vector(1)) * turn * Affine::scale(size),
                        {Rgb(within(0, 1)), within(0, 1)});
            if (within(0, 1) < 0.3)
                graph.objects[object].instances.back().material = static_cast<MaterialId>(within(0, 2));
        }
    }
    test::place(graph, graph.root, objects[0], Affine::scale(Vec3(3)));
    return graph;
}

/// The graph's own edges that an edge stands for.
std::vector<std::uint32_t> way_of(const FlatCells& cells, std::uint32_t number) {
    const PassedEdge& passed = cells.edges[number];
    if (passed.before == flat_none) return {number};
    std::vector<std::uint32_t> way = way_of(cells, passed.before);
    way.push_back(passed.last);
    return way;
}

/// Ways that part at each node into all of its edges have shares that add up to 1.
double share_of(const FlatGraph& graph, std::uint32_t node, const std::vector<std::uint32_t>& way) {
    double share = 1;
    for (const std::uint32_t number : way) {
        const FlatNode& parent = graph.nodes[node];
        EXPECT_TRUE(number >= parent.first_edge && number < parent.first_edge + parent.edge_count);
        share /= parent.edge_count;
        node = graph.edges[number].child;
    }
    return share;
}

void expect_same(const FlatGraph& graph, const std::vector<std::uint32_t>& way, const FlatEdge& edge) {
    Affine map;
    Paint tint;
    std::uint32_t levels = 0, material = flat_none;
    for (const std::uint32_t number : way) {
        const FlatEdge& own = graph.edges[number];
        map = map * parent_from_child(own);
        tint = own.tint.under(tint);
        levels += own.levels;
        if (own.material != flat_none) material = own.material;
    }
    const Affine whole = parent_from_child(edge);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(whole.linear[i][k], map.linear[i][k], 1e-9);
        EXPECT_NEAR(whole.translation[i], map.translation[i], 1e-9);
        EXPECT_NEAR(edge.tint.fixed[static_cast<std::size_t>(i)], tint.fixed[static_cast<std::size_t>(i)],
                    1e-6);
    }
    EXPECT_NEAR(edge.stretch, norm(map.linear), 1e-5);
    EXPECT_NEAR(edge.tint.open, tint.open, 1e-6);
    EXPECT_EQ(edge.levels, levels);
    EXPECT_EQ(edge.material, material);
    EXPECT_EQ(edge.child, graph.edges[way.back()].child);
}

TEST(FlatCells, HoldEachWayOnce) {
    std::size_t deepest = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const FlatGraph graph = flattened(random_graph(seed));
        const FlatCells cells = flat_cells(graph);
        ASSERT_LE(cells.edges.size(), graph.edges.size() + 66'000);
        for (std::uint32_t node = 0; node < graph.nodes.size(); ++node) {
            std::vector<std::vector<std::uint32_t>> sets = {cells.shallow[node]};
            for (const FlatCell& cell : cells.deep[node])
                sets.push_back(cell.edges);
            for (const std::vector<std::uint32_t>& set : sets) {
                if (graph.nodes[node].edge_count == 0) continue;
                double shares = 0;
                std::set<std::vector<std::uint32_t>> ways;
                for (const std::uint32_t number : set) {
                    const std::vector<std::uint32_t> way = way_of(cells, number);
                    EXPECT_TRUE(ways.insert(way).second);
                    shares += share_of(graph, node, way);
                    expect_same(graph, way, cells.edges[number].edge);
                    deepest = std::max(deepest, way.size());
                }
                EXPECT_NEAR(shares, 1, 1e-9) << seed;
                EXPECT_LE(set.size(), std::max<std::size_t>(512, cells.shallow[node].size()));
            }
        }
    }
    EXPECT_GE(deepest, 3u);
}

/// Each demand of a cell on its node holds for everything that it passes over.
TEST(FlatCells, AskForWhatIsPassedOver) {
    std::size_t passed = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const FlatGraph graph = flattened(random_graph(seed));
        const FlatCells cells = flat_cells(graph);
        for (std::uint32_t node = 0; node < graph.nodes.size(); ++node)
            for (const FlatCell& cell : cells.deep[node])
                for (const std::uint32_t number : cell.edges) {
                    Affine map;
                    std::uint32_t levels = 0;
                    const std::vector<std::uint32_t> way = way_of(cells, number);
                    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
                        const FlatEdge& edge = graph.edges[way[i]];
                        const FlatNode& child = graph.nodes[edge.child];
                        map = map * parent_from_child(edge);
                        levels += edge.levels;
                        EXPECT_TRUE(!child.unending || cell.least_steps > levels);
                        if (child.cut_detail == 0) continue;
                        ++passed;
                        EXPECT_LE(cell.least_size,
                                  child.diameter * norm(map.linear) / child.cut_detail * (1 + 1e-5));
                        const auto at = [](const std::array<float, 3>& v) { return Vec3(v[0], v[1], v[2]); };
                        EXPECT_GE(cell.reach * (1 + 1e-5),
                                  glm::distance(map(at(child.centre)), at(graph.nodes[node].centre)));
                    }
                }
    }
    EXPECT_GT(passed, 100u);
}

} // namespace
} // namespace graftal
