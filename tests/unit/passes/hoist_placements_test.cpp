#include "compiler/passes/hoist_placements.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

const Affine half = Affine::scale(Vec3(0.5));
const Affine aside = Affine::translate({2, 0, 0});

Instance edge_to(ObjectId master, const Affine& map = {}) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = map;
    return instance;
}

ObjectId add_of(Graph& graph, const std::string& name, std::vector<Instance> instances) {
    Object object;
    object.name = name;
    object.instances = std::move(instances);
    return graph.add(std::move(object));
}

TEST(HoistPlacements, MovesASharedMapToTheUsers) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere),
                   cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId pair = add_of(graph, "pair", {edge_to(sphere, half), edge_to(cube, half)});
    graph.root = add_of(graph, "root", {edge_to(pair, aside), edge_to(pair)});
    const auto [after, renumbering] = hoist_placements(graph);
    EXPECT_EQ(after.objects[pair].instances[0].parent_from_child, Affine());
    EXPECT_EQ(after.objects[graph.root].instances[0].parent_from_child, aside * half);
    EXPECT_EQ(after.objects[graph.root].instances[1].parent_from_child, half);
    EXPECT_EQ(renumbering.now, (std::vector<ObjectId>{0, 1, 2, 3}));
    EXPECT_EQ(renumbering.taken[pair].parent_from_rest, half);
    EXPECT_EQ(renumbering.taken[graph.root].parent_from_rest, Affine()) << "a root has no users";
    ASSERT_TRUE(renumbering.united.contains(pair));
    EXPECT_EQ(renumbering.united.at(pair), (std::vector<ObjectId>{sphere, cube}));
    const std::vector<ObjectBounds> bounds = carried_over(
        renumbering,
        {primitive_bounds(PrimitiveKind::sphere), primitive_bounds(PrimitiveKind::cube), {}, {}});
    EXPECT_EQ(bounds[pair].box.max, Vec3(1.0));
}

TEST(HoistPlacements, LeavesNothingOfAnEndingObjectOfOneInstance) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId inner = add_of(graph, "inner", {edge_to(sphere, half)});
    const ObjectId outer = add_of(graph, "outer", {edge_to(inner, aside)});
    graph.root = add_of(graph, "root", {edge_to(outer), edge_to(sphere)});
    const auto [after, renumbering] = hoist_placements(graph);
    EXPECT_EQ(after.objects[graph.root].instances[0].master, sphere);
    EXPECT_EQ(after.objects[graph.root].instances[0].parent_from_child, aside * half);
    EXPECT_EQ(renumbering.now[outer], sphere);
    EXPECT_EQ(renumbering.taken[outer].parent_from_rest, aside * half);
}

TEST(HoistPlacements, TheTerminalStaysWhereItIs) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId self = add_of(graph, "self", {});
    graph.objects[self].instances = {edge_to(self, half), edge_to(self, half)};
    graph.objects[self].terminal = edge_to(sphere, aside);
    graph.root = add_of(graph, "root", {edge_to(self)});
    const auto [after, renumbering] = hoist_placements(graph);
    const Affine& root_from_self = after.objects[graph.root].instances[0].parent_from_child;
    EXPECT_EQ(root_from_self, half);
    EXPECT_EQ(root_from_self * after.objects[self].terminal->parent_from_child, aside);
}

TEST(HoistPlacements, KeepsWhatIsNotSharedOrFlat) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const Affine flat = Affine::scale({1, 0, 1});
    const ObjectId two = add_of(graph, "two", {edge_to(sphere, half), edge_to(sphere, aside)});
    const ObjectId crushed = add_of(graph, "crushed", {edge_to(sphere, flat), edge_to(sphere, flat)});
    graph.root = add_of(graph, "root", {edge_to(two), edge_to(crushed)});
    const auto [after, renumbering] = hoist_placements(graph);
    EXPECT_TRUE(equal(after, graph));
    EXPECT_TRUE(renumbering.united.empty());
}

} // namespace
} // namespace graftal
