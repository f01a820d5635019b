// Totals of plants, summed up part by part: they are those of the rows of the plant, where it has as many as
// rows have room for, and closed forms where it has more.

#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "runtime/plants/measures_report.h"
#include "runtime/plants/plant_measures.h"
#include "tests/unit/plants/plants.h"

namespace graftal {
namespace {

using test::plant_of;

PlantOrTotals told(PictureSession& session, std::uint64_t max_modules) {
    StageOptions options;
    options.lower.max_modules = max_modules;
    Compilation compilation;
    return plant_or_totals_of_model(session, options, false, compilation);
}

std::shared_ptr<const PlantTotals> totals_of(const std::string& text,
                                             std::uint64_t max_modules = 50'000'000) {
    PictureSession session("m.lsys");
    session.edit(text);
    return told(session, max_modules).totals;
}

void expect_same(const PlantSums& totals, const PlantSums& rows, const std::string& of) {
    EXPECT_EQ(totals.modules, rows.modules) << of;
    EXPECT_EQ(totals.segments, rows.segments) << of;
    EXPECT_EQ(totals.leaves, rows.leaves) << of;
    for (const auto sum :
         {&PlantSums::length, &PlantSums::wood_area, &PlantSums::wood_volume, &PlantSums::leaf_area})
        EXPECT_NEAR(totals.*sum, rows.*sum, 1e-9 * rows.*sum) << of;
}

void expect_same_named(const std::vector<NamedSums>& totals, const std::vector<NamedSums>& rows) {
    std::map<std::string, NamedSums> left;
    for (const NamedSums& sums : rows)
        if (!sums.empty()) left[sums.name] = sums;
    for (const NamedSums& sums : totals) {
        if (sums.empty()) continue;
        ASSERT_TRUE(left.contains(sums.name)) << sums.name;
        expect_same(sums, left[sums.name], sums.name);
        left.erase(sums.name);
    }
    EXPECT_TRUE(left.empty()) << left.begin()->first;
}

void expect_totals_of_rows(const PlantTotals& totals, const PlantMeasures& rows) {
    EXPECT_EQ(totals.steps, rows.steps);
    expect_same(totals.all, rows.all, "all");
    EXPECT_EQ(totals.balls, rows.balls);
    EXPECT_EQ(totals.unmeasured, rows.unmeasured);
    ASSERT_EQ(totals.orders.size(), rows.orders.size());
    for (std::size_t i = 0; i < totals.orders.size(); ++i)
        expect_same(totals.orders[i], rows.orders[i], "order " + std::to_string(i));
    expect_same_named(totals.names, rows.names);
    expect_same_named(totals.materials, rows.materials);
}

class PlantTotalsOfRows : public ::testing::TestWithParam<const char*> {};

TEST_P(PlantTotalsOfRows, AreSums) {
    const auto totals = totals_of(GetParam(), 1);
    ASSERT_TRUE(totals);
    const auto plant = plant_of(GetParam());
    ASSERT_TRUE(plant);
    expect_totals_of_rows(*totals, measure_plant(*plant, tree_of(*plant), std::nullopt));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, PlantTotalsOfRows,
    ::testing::Values(
        "lsys a {\nsteps 4\naxiom F\nF -> F[+F]F[-F]F\n}",
        // A branch that begins where another has just begun is of the same order, in a part or between two.
        "lsys a {\nsteps 3\naxiom [[A]]A\nA -> [[+FA][B]]FA\nB -> [[-F]A]\n}",
        "lsys a {\nsteps 5\naxiom XXFX\nX -> [Y]Z\nY -> [+FX]\nZ -> X\n}",
        // Sizes: parts are composed once and placed smaller.
        "lsys a {\nsteps 7\nwidth 0.1\naxiom A(1)\nA(s) -> "
        "!(0.1*s)F(s)[+(40)A(0.6*s)][-(30)A(0.7*s)]K(s)\n}",
        "lsys a {\nsteps 6\nwidth 0.1\naxiom A\nA -> F[+@Di(0.6)A][-@Di(0.7)A]@O(0.3)@o(0.2)\n}",
        // Modules that others are drawn in the place of, with branches, and in each other.
        "lsys a {\nsteps 4\naxiom A\nA -> F[+A]L A\ninterpret L -> [&(90)F(0.2)M]F(0.1)\nM -> "
        "[F(0.3)]@O(0.1)\n}",
        "lsys a {\nsteps 3\naxiom +A\nA -> F[+A]A\ninterpret + -> /(20)[F(0.1)]\nF -> "
        "f(0.1)F(0.5)f(0.1)\n}",
        // Polygons, whose name is that of their beginning; one that begins outside of its part.
        "lsys a {\nsteps 3\naxiom A\nA -> F[+{.f+(90)f.+(90)f.}]A\n}",
        "lsys a {\nsteps 2\naxiom K{.f+(90)A.}\nA -> f.[K]+(90)f\n}",
        // Models, flat and not; colours that come in from outside.
        "lsys leaf {\nsteps 0\naxiom {.f+(90)f.+(90)f.}\n}\nmain lsys a {\nsteps 4\naxiom A\nA -> "
        "F[+~leaf(0.5)]/A\n}",
        "material m {\ncolor: 1,0,0\n}\nmaterial n { color: 0,1,0\n} "
        "lsys a {\ncolors m, n\nsteps 4\naxiom A\nA -> F[';FA]A@o(0.5)\n}",
        // Modules that are cut off are in no sum.
        "lsys a {\nsteps 4\naxiom A\nA -> F[+F A F % FFF[F]]A\n}",
        "lsys a {\nsteps 3\naxiom A\nA -> F[+B]A\nB -> F%F\n}",
        // Chance, by the choices of the picture.
        "lsys a {\nsteps 6\nseed 3\naxiom A\nA : 0.5 -> F[+A]A\nA : 0.5 -> FF[-A][+A]\n}",
        // Directions that parts look at.
        "lsys a {\nsteps 5\naxiom A\nA -> F[+T(0.2)A][&A]$A\n}"));

TEST(PlantTotals, OfEachSceneAreThoseOfItsRows) {
    std::size_t seen = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(GRAFTAL_SOURCE_DIR "/scenes/abop")) {
        if (entry.path().extension() != ".lsys") continue;
        const std::string path = entry.path().string();
        PictureSession session(path);
        const auto totals = told(session, 1).totals;
        if (!totals || totals->all.modules > 2'000) continue;
        const auto plant = told(session, 50'000'000).plant;
        if (!plant) continue;
        SCOPED_TRACE(path);
        expect_totals_of_rows(*totals, measure_plant(*plant, tree_of(*plant), std::nullopt));
        ++seen;
    }
    EXPECT_GT(seen, 20u);
}

TEST(PlantTotals, OfMoreThanRowsHaveRoomForAreExact) {
    // F -> F[+F]F[-F]F: 5^30 segments of one; those of order k are the coefficients of (3 + 2x)^30.
    const auto totals = totals_of("lsys a {\n steps 30\n width 0.1\n axiom F\n F -> F[+F]F[-F]F\n}\n");
    ASSERT_TRUE(totals);
    EXPECT_EQ(totals->all.segments, pow(BigCount(5), 30));
    EXPECT_EQ(totals->all.modules, pow(BigCount(5), 30));
    EXPECT_NEAR(totals->all.length, std::pow(5.0, 30), 1e-12 * std::pow(5.0, 30));
    ASSERT_EQ(totals->orders.size(), 31u);
    BigCount expected = pow(BigCount(3), 30);
    for (unsigned k = 0; k <= 30; ++k) {
        EXPECT_EQ(totals->orders[k].segments, expected) << k;
        expected = expected * 2 * (30 - k) / (3 * (k + 1));
    }
    const auto json = nlohmann::json::parse(totals_json("m.lsys", *totals, 10));
    EXPECT_EQ(json["segments"], "931322574615478515625");
    EXPECT_EQ(json["orders"][1]["segments"], 4117822641892980);
    EXPECT_EQ(json["orders"][2]["segments"], "39805618871632140");
}

/// Each part has a sum for each order below it.
TEST(PlantTotals, OfParentsOfThousandsOfOrdersAreNotTold) {
    const auto plant = [](int steps) {
        return "lsys a {\n steps " + std::to_string(steps) + "\n width 0.1\n axiom A\n A -> F[A]A\n}\n";
    };
    EXPECT_TRUE(totals_of(plant(1000)));
    PictureSession session("m.lsys");
    session.edit(plant(3000));
    Compilation compilation;
    const PlantOrTotals told = plant_or_totals_of_model(session, {}, false, compilation);
    EXPECT_FALSE(told.plant || told.totals);
    EXPECT_NE(compilation.diagnostics.render(compilation.sources).find("more than 5000000 modules"),
              std::string::npos);
}

/// Each of the parts in a row has a sum for each order below it, which are added for every one.
TEST(PlantTotals, OfManyPartsWithManyOrdersAreNotTold) {
    const auto plant = [](std::size_t parts) {
        return "lsys a {\n steps 900\n width 0.1\n axiom R\n R -> " + std::string(parts, 'A') +
               "\n A -> F[A]A\n}\n";
    };
    EXPECT_TRUE(totals_of(plant(100)));
    EXPECT_FALSE(totals_of(plant(60'000)));
}

} // namespace
} // namespace graftal
