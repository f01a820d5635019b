#include "compiler/lsys/compose/part_table.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

TurtlePart part_of(TurtleStateMask reads, double reach) {
    TurtlePart part;
    part.reads = reads;
    part.reach = reach;
    return part;
}

TurtleState state_of(double width, int colour) {
    TurtleState state;
    state.width = width;
    state.colour = colour;
    return state;
}

double reach_of(const TurtlePart* part) {
    return part ? part->reach : -1;
}

TEST(PartTable, APartServesWhereWhatItReadsIsEqual) {
    PartTable table;
    table.add(7, 4, state_of(0.5, 1), part_of(reads_width, 10));
    EXPECT_EQ(reach_of(table.find(7, 4, state_of(0.5, 1))), 10);
    EXPECT_EQ(reach_of(table.find(7, 4, state_of(0.5, 2))), 10) << "it does not read the colour";
    EXPECT_EQ(table.find(7, 4, state_of(0.6, 1)), nullptr);
}

TEST(PartTable, AnotherModuleAndAnotherStageHaveOtherParts) {
    PartTable table;
    table.add(7, 4, {}, part_of(0, 10));
    table.add(7, 2, {}, part_of(0, 20));
    table.add(8, 4, {}, part_of(0, 30));
    EXPECT_EQ(reach_of(table.find(7, 4, {})), 10);
    EXPECT_EQ(reach_of(table.find(7, 2, {})), 20);
    EXPECT_EQ(reach_of(table.find(8, 4, {})), 30);
    EXPECT_EQ(table.find(8, 2, {}), nullptr);
    EXPECT_EQ(table.size(), 3u);
}

TEST(PartTable, PartsOfOneModuleMayReadDifferentThings) {
    PartTable table;
    table.add(7, 4, state_of(0.5, 1), part_of(reads_width, 10));
    table.add(7, 4, state_of(0.6, 2), part_of(reads_width | reads_colour, 20));
    EXPECT_EQ(reach_of(table.find(7, 4, state_of(0.5, 2))), 10);
    EXPECT_EQ(reach_of(table.find(7, 4, state_of(0.6, 2))), 20);
    EXPECT_EQ(table.find(7, 4, state_of(0.6, 1)), nullptr);
}

TEST(PartTable, PartsStayWhereTheyAre) {
    PartTable table;
    table.add(0, 0, {}, part_of(0, 5));
    const TurtlePart* const first = table.find(0, 0, {});
    for (ModuleId module = 1; module < 1000; ++module)
        table.add(module, 0, {}, part_of(0, module));
    EXPECT_EQ(table.find(0, 0, {}), first);
    EXPECT_EQ(reach_of(first), 5);
    EXPECT_EQ(reach_of(table.find(999, 0, {})), 999);
}

TEST(PartTable, VerticesOfOpenPolygonsTakeTheirRoom) {
    PartTable table;
    table.add(1, 0, {}, part_of(0, 1));
    const std::size_t one = table.bytes();
    TurtlePart part = part_of(0, 1);
    part.vertices.resize(10);
    part.polygon_ends.push_back({std::vector<Vec3>(20), 0});
    part.polygons.push_back({Mat3(1.0), std::vector<Vec3>(30)});
    table.add(2, 0, {}, std::move(part));
    EXPECT_EQ(table.bytes(), 2 * one + 60 * sizeof(Vec3));
}

} // namespace
} // namespace graftal
