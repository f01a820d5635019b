// Measures of plants that are known by hand.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/plants/measures_report.h"
#include "runtime/plants/outline.h"
#include "runtime/plants/plant_measures.h"
#include "tests/unit/plants/plants.h"

#include <nlohmann/json.hpp>

namespace graftal {
namespace {

using test::plant_of;
using test::plant_text;
using test::square;

PlantMeasures measures_of(const std::string& block, std::optional<double> ground = {}) {
    const auto plant = plant_of(plant_text("material leaf { color: 0,1,0 }", block));
    return measure_plant(*plant, tree_of(*plant), ground);
}

TEST(PlantMeasures, OfAFork) {
    const PlantMeasures m = measures_of("axiom F(2)[+(90)F(1)][-(30)F(1)L]F(3)F(1)");
    EXPECT_EQ(m.all.segments, 5u);
    EXPECT_EQ(m.all.modules, 6u);
    EXPECT_EQ(m.tips, 3u);
    EXPECT_DOUBLE_EQ(m.all.length, 8);
    EXPECT_NEAR(m.all.wood_volume, 8 * std::numbers::pi * 0.0025, 1e-12);
    EXPECT_NEAR(m.all.wood_area, 8 * std::numbers::pi * 0.1, 1e-12);
    EXPECT_DOUBLE_EQ(m.longest_path, 6);
    EXPECT_DOUBLE_EQ(m.mean_path, 4);
    EXPECT_EQ(m.angle_deg.count(), 2u);
    EXPECT_NEAR(m.angle_deg.mean(), 60, 1e-9);
    EXPECT_NEAR(m.angle_deg.deviation(), 30 * std::numbers::sqrt2, 1e-9);
    ASSERT_EQ(m.orders.size(), 2u);
    EXPECT_EQ(m.orders[0].axes, 1u);
    EXPECT_EQ(m.orders[1].axes, 2u);
    EXPECT_DOUBLE_EQ(m.orders[0].length, 6);
    EXPECT_DOUBLE_EQ(m.orders[1].length, 2);
    ASSERT_EQ(m.streams.size(), 2u);
    EXPECT_EQ(m.streams[0].streams, 3u);
    EXPECT_EQ(m.streams[0].segments, 4u) << "F(3)F(1) are one stream";
    EXPECT_EQ(m.streams[1].streams, 1u);
    EXPECT_NEAR(*m.branching_ratio, 3, 1e-12);
    ASSERT_EQ(m.ranks.size(), 3u);
    EXPECT_DOUBLE_EQ(m.ranks[0].length, 4);
    EXPECT_DOUBLE_EQ(m.ranks[1].length, 3);
    EXPECT_DOUBLE_EQ(m.ranks[2].length, 1);
    EXPECT_NEAR(m.height, 6.05, 1e-12) << "with the ball at its end";
    EXPECT_NEAR(m.projected[0].wood_area, 0.1 * 1.5, 1e-12)
        << "from above: one branch lies, one is 30 degrees off";
}

TEST(PlantMeasures, OfALevelLeaf) {
    const PlantMeasures m = measures_of("axiom &(90)" + square(2), 8);
    EXPECT_EQ(m.all.leaves, 1u);
    EXPECT_NEAR(m.all.leaf_area, 4, 1e-12);
    EXPECT_NEAR(m.crown_area, 4, 1e-12);
    EXPECT_NEAR(m.ground(), 8, 1e-12);
    EXPECT_NEAR(m.leaf_inclination_deg, 0, 1e-6);
    for (const Projected& some : m.projected)
        EXPECT_NEAR(some.leaf_area, 4 * std::sin(some.elevation_deg * std::numbers::pi / 180), 1e-9);
    EXPECT_NEAR(measures_of("axiom " + square(1)).leaf_inclination_deg, 90, 1e-9);
    EXPECT_NEAR(measures_of("axiom &(50)" + square(1)).leaf_inclination_deg, 40, 1e-9);
}

/// Within 0.1 % of the circles and ellipses, and of what lies between them.
TEST(PlantMeasures, CrownsOfRoundOrgansHaveTheAreaOfTheirCircles) {
    constexpr double pi = std::numbers::pi;
    const auto crown = [](const std::string& block) { return measures_of(block).crown_area; };
    EXPECT_NEAR(crown("axiom &(90)@o(2)"), pi, 1e-9);
    EXPECT_NEAR(measures_of("axiom &(90)@o(2)").all.leaf_area, crown("axiom &(90)@o(2)"), 1e-9);
    EXPECT_NEAR(crown("axiom @O(2)"), pi, 1e-9);
    EXPECT_NEAR(crown("axiom !(2)F(5)"), pi, 1e-9) << "a trunk";
    // A segment begins flat: lying, it is half a disc and a rectangle from above, and so high as it is thick.
    EXPECT_NEAR(crown("axiom &(90)!(2)F(4)"), 8 + pi / 2, 0.001 * (8 + pi / 2));
    EXPECT_NEAR(measures_of("axiom !(2)F(4)").height, 5, 1e-9);
    EXPECT_NEAR(measures_of("axiom &(60)!(2)F(4)").height, 2 + 1 + std::sin(pi / 3), 1e-9);
    EXPECT_NEAR(crown("axiom &(30)@o(2)"), pi / 2, 1e-9) << "a disc that stands nearly upright";
    EXPECT_NEAR(crown("axiom @o(2)"), 0, 1e-9);
    for (const int turn : {0, 3, 17, 45}) {
        const std::string there = "axiom \\(" + std::to_string(turn) + ")&(90)";
        EXPECT_NEAR(crown(there + "@O(2)f(6)@O(2)"), pi + 12, 0.001 * (pi + 12)) << turn;
        EXPECT_NEAR(crown(there + "@o(2)f(6)@o(2)"), pi + 12, 0.001 * (pi + 12)) << turn;
    }
    const double upward = std::sin(pi / 4) * std::cos(pi / 9); // of the disc's normal
    EXPECT_NEAR(measures_of("axiom +(20)&(45)@o(2)").height, 2 * std::sqrt(1 - upward * upward), 1e-9);
    EXPECT_NEAR(crown("axiom !(0)F(5)&(90)F(3)"), 0, 1e-9);
}

TEST(PlantMeasures, OfLeavesThatAreModels) {
    const auto plant = plant_of("lsys leaf {\n steps 0\n axiom " + square(0.5) +
                                "\n}\nmain lsys a {\n width 0.1\n steps 0\n"
                                " axiom F[&(90)~leaf(2)]~leaf(1)L\n interpret L -> [&(90)~leaf]F(2)\n}\n");
    const PlantMeasures m = measure_plant(*plant, tree_of(*plant), std::nullopt);
    EXPECT_EQ(m.all.leaves, 3u);
    EXPECT_NEAR(m.all.leaf_area, 1.5, 1e-12);
    EXPECT_NEAR(m.projected[0].leaf_area, 1.25, 1e-12);
    EXPECT_NEAR(m.projected.back().leaf_area, 0.25 * 2 / std::numbers::pi, 0.002)
        << "the upright one, mean over all sides";
    EXPECT_DOUBLE_EQ(m.all.length, 3);
    double names = 0, materials = 0, ranks = 0, orders = 0;
    for (const NamedSums& sums : m.names)
        names += sums.leaf_area;
    for (const NamedSums& sums : m.materials)
        materials += sums.leaf_area;
    for (const PlantSums& sums : m.ranks)
        ranks += sums.leaf_area;
    for (const AxisOrder& sums : m.orders)
        orders += sums.leaf_area;
    for (const double sum : {names, materials, ranks, orders})
        EXPECT_NEAR(sum, 1.5, 1e-12);
}

TEST(PlantMeasures, OfNothing) {
    const PlantMeasures m = measures_of("axiom A");
    EXPECT_EQ(m.all.segments, 0u);
    EXPECT_EQ(m.crown_area, 0);
    const auto json = nlohmann::json::parse(measures_json("m.lsys", m, nullptr));
    EXPECT_TRUE(json["leaf_area_index"].is_null());
    EXPECT_TRUE(json["angle"]["mean"].is_null());
    EXPECT_FALSE(json.contains("light"));
}

TEST(PlantMeasures, OutlineIsTheConvexHull) {
    Outline outline;
    for (int i = 0; i < 5000; ++i)
        outline.add({std::cos(i * 0.7) * (i % 7) / 6, std::sin(i * 0.7) * (i % 7) / 6});
    EXPECT_LT(outline.area(), std::numbers::pi);
    EXPECT_GT(outline.area(), std::numbers::pi - 0.01);
    for (const glm::dvec2 corner : {glm::dvec2(2, 0), {0, 2}, {-2, 0}, {0, -2}, {1, 1}, {2, 0}})
        outline.add(corner);
    EXPECT_NEAR(outline.area(), 8, 1e-12);
    EXPECT_EQ(Outline().area(), 0);
}

TEST(PlantMeasures, OutlineKeepsWhatNothingSurrounds) {
    Outline outline;
    for (int i = 0; i < 3000; ++i) // a disc of many, and then others around it
        outline.add_ellipse({std::cos(i * 0.7) * (i % 7) / 6, std::sin(i * 0.7) * (i % 7) / 6}, {0.5, 0},
                            {0, 0.5});
    EXPECT_NEAR(outline.area(), 2.25 * std::numbers::pi, 0.001 * 2.25 * std::numbers::pi);
    for (const glm::dvec2 centre : {glm::dvec2(9, 0), {0, 9}, {-9, 0}, {0, -9}})
        outline.add_ellipse(centre, {1, 0}, {0, 1});
    const double diamond = 162 + 4 * 9 * std::numbers::sqrt2 + std::numbers::pi;
    EXPECT_NEAR(outline.area(), diamond, 0.001 * diamond);
    outline.add_ellipse({9, 9}, {0, 0}, {0, 0});
    outline.add({-9, -9});
    EXPECT_GT(outline.area(), diamond);
}

/// Each key that is printed is one of measures_keys(), which the help explains.
TEST(PlantMeasures, KeysAreExplained) {
    const auto lit = test::lit(plant_text("material leaf { color: 0,1,0 }\nlight { sun: 0,1,0 }",
                                          "axiom F[+(30)F][-(30)F]@O(1)&(90)" + square(1)),
                               4);
    ASSERT_TRUE(lit.light) << lit.messages;
    const PlantMeasures m = measure_plant(*lit.plant, tree_of(*lit.plant), std::nullopt);
    const auto is_known = [](const std::string& name) {
        return std::ranges::any_of(measures_keys(), [&](const MeasuresKey& key) { return key.name == name; });
    };
    const auto json = nlohmann::json::parse(measures_json("m.lsys", m, &*lit.light));
    for (const auto& [key, value] : json.items()) {
        EXPECT_TRUE(value.is_object() || is_known(key)) << key;
        if (value.is_object()) {
            for (const auto& [inner, number] : value.items())
                EXPECT_TRUE(is_known(key + " " + inner)) << key << " " << inner;
        }
        if (!value.is_array()) continue;
        ASSERT_FALSE(value.empty()) << key;
        for (const auto& [column, number] : value.front().items())
            EXPECT_TRUE(is_known(key + " " + column) || is_known("orders " + column)) << key << " " << column;
    }
    const std::string text = measures_text("m.lsys", m, &*lit.light);
    EXPECT_NE(text.find("branching_ratio                2"), std::string::npos) << text;
    EXPECT_NE(text.find("\nstrahler\n"), std::string::npos) << text;
}

} // namespace
} // namespace graftal
