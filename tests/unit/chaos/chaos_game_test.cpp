// Random iteration against measures that are known exactly: cylinder sets of words of maps, by chi-square
// tests that a wrong measure fails by orders of magnitude.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "compiler/chaos/unroll.h"
#include "runtime/system/file.h"
#include "tests/unit/chaos/games.h"
#include "tests/unit/languages/lower_file.h"

namespace graftal {
namespace {

using testing::analysed;
using testing::chi_square;
using testing::expect_by_chance;
using testing::Played;
using testing::played;
using testing::points_of;

/// The gasket over the corners (0,0), (1,0), (0,1), with probabilities; its points have binary addresses.
std::string gasket(const std::string& p, const std::string& q, const std::string& r) {
    return "rifs gasket { codes 2d {\n .5 0 0 .5 0 0 " + p + "\n .5 0 0 .5 .5 0 " + q + "\n .5 0 0 .5 0 .5 " +
           r + "\n } }";
}

/// The number of the cell of level `depth` that holds a point of the gasket: a word of digits 0, 1, 2.
std::size_t word_of(Vec3 p, int depth) {
    std::size_t word = 0;
    for (int i = 0; i < depth; ++i) {
        const bool right = p.x >= 0.5, up = p.y >= 0.5;
        word = 3 * word + (right ? 1 : up ? 2 : 0);
        p = 2.0 * p - Vec3(right, up, 0);
    }
    return word;
}

std::vector<double> shares_of_words(const std::array<double, 3>& p, int depth) {
    std::vector<double> shares = {1};
    for (int i = 0; i < depth; ++i) {
        std::vector<double> longer;
        for (const double share : shares)
            for (const double chance : p)
                longer.push_back(share * chance);
        shares = longer;
    }
    return shares;
}

TEST(ChaosGame, InvariantMeasureOfUnequalProbabilities) {
    constexpr int depth = 4;
    const ChaosGame game = played("a.rifs", gasket(".2", ".3", ".5")).game();
    std::vector<double> counts(81, 0.0);
    for (const ChaosPoint& point : points_of(game, 200'000, depth + 2))
        ++counts[word_of(point.place, depth)];
    expect_by_chance(counts, shares_of_words({0.2, 0.3, 0.5}, depth));
    // The test can tell: probabilities that are off by a hundredth are ruled out.
    EXPECT_GT(chi_square(counts, shares_of_words({0.21, 0.29, 0.5}, depth)), 300);
    EXPECT_GT(chi_square(counts, shares_of_words({1 / 3., 1 / 3., 1 / 3.}, depth)), 50'000);
}

TEST(ChaosGame, MapsWithoutProbabilitiesGetTheEvenMeasure) {
    // Ratios 1/2, 1/4, 1/4: dimension 1, so chances of 1/2, 1/4, 1/4.
    const Played model =
        played("a.rifs", "rifs a { map a { scale 1/2 } map b { scale 1/4 translate <1/2, 0> }"
                         " map c { scale 1/4 translate <3/4, 0> } }");
    const Chances chances = chances_of(model.graph, model.components, model.bounds);
    const std::vector<double>& root = chances[model.graph.root];
    ASSERT_EQ(root.size(), 3u);
    EXPECT_NEAR(root[0], 0.5, 1e-9);
    EXPECT_NEAR(root[1], 0.25, 1e-9);
    EXPECT_NEAR(root[2], 0.25, 1e-9);
}

TEST(ChaosGame, FlatteningMapsGetASmallShare) {
    const Played model = played("a.rifs", "rifs fern { codes 2d {\n 0 0 0 .16 0 0\n .85 .04 -.04 .85 0 1.6\n"
                                          ".2 -.26 .23 .22 0 1.6\n -.15 .28 .26 .24 0 .44\n } }");
    const Chances chances = chances_of(model.graph, model.components, model.bounds);
    const double stem = chances[model.graph.root][0];
    EXPECT_GT(stem, 0.001);
    EXPECT_LT(stem, 0.05);
}

TEST(ChaosGame, ControlDigraphIsKept) {
    // No quadrant twice in a row, and all 4 * 3^4 words of five alike.
    const Played model =
        played("a.rifs", "rifs p { map a { scale 1/2 } map b { scale 1/2 translate <1/2, 0> }"
                         " map c { scale 1/2 translate <0, 1/2> } map d { scale 1/2 translate "
                         "<1/2, 1/2> } follow all except self }");
    std::vector<double> counts(1024, 0.0), shares(1024, 0.0);
    for (const ChaosPoint& point : points_of(model.game(), 200'000, 8)) {
        std::size_t word = 0;
        Vec3 p = point.place;
        for (int i = 0; i < 5; ++i) {
            const bool right = p.x >= 0.5, up = p.y >= 0.5;
            word = 4 * word + (right ? 1 : 0) + (up ? 2 : 0);
            p = 2.0 * p - Vec3(right, up, 0);
        }
        ++counts[word];
    }
    for (std::size_t word = 0; word < 1024; ++word) {
        bool repeats = false;
        for (std::size_t rest = word, i = 0; i < 4; ++i, rest /= 4)
            repeats |= rest % 4 == rest / 4 % 4;
        shares[word] = repeats ? 0 : 1.0 / 324;
    }
    expect_by_chance(counts, shares);
}

TEST(ChaosGame, MatrixOfProbabilities) {
    // Stationary shares 5/6 and 1/6; the cell (j, i) holds points that w_j was applied to after w_i.
    const Played model =
        played("a.rifs", "rifs r { map a { scale 1/2 } map b { scale 1/2 translate <1/2, 0> }\n"
                         "follow matrix {\n .9 .1\n .5 .5\n } }");
    std::vector<double> counts(4, 0.0);
    for (const ChaosPoint& point : points_of(model.game(), 200'000, 40))
        ++counts[std::min<std::size_t>(static_cast<std::size_t>(4 * point.place.x), 3)];
    expect_by_chance(counts, {5 / 6. * 0.9, 1 / 6. * 0.5, 5 / 6. * 0.1, 1 / 6. * 0.5});
}

TEST(ChaosGame, CondensationSetsGetTheirProbability) {
    const Played model =
        played("a.rifs", "rifs c { map half { scale 1/2 probability 0.7 }\n"
                         "condense sphere scale 0.01 translate <1, 0, 0> probability 0.3\n }");
    std::vector<double> counts(12, 0.0), shares(12, 0.0);
    for (const ChaosPoint& point : points_of(model.game(), 100'000, 1)) {
        const double level = -std::log2(point.place.x);
        ++counts[std::min<std::size_t>(static_cast<std::size_t>(std::lround(level)), 11)];
    }
    for (std::size_t k = 0; k < 12; ++k)
        shares[k] = k < 11 ? 0.3 * std::pow(0.7, k) : std::pow(0.7, 11);
    expect_by_chance(counts, shares);
}

TEST(ChaosGame, CondensationWithoutAProbabilityGetsItsArea) {
    // Areas fall by 1/4 a level.
    const Played model = played("a.rifs", "rifs c { map half { scale 1/2 }\n"
                                          "condense sphere scale 0.01 translate <1, 0, 0>\n }");
    std::vector<double> counts(6, 0.0), shares(6, 0.0);
    for (const ChaosPoint& point : points_of(model.game(), 100'000, 1))
        ++counts[std::min<std::size_t>(static_cast<std::size_t>(std::lround(-std::log2(point.place.x))), 5)];
    for (std::size_t k = 0; k < 6; ++k)
        shares[k] = k < 5 ? 0.75 * std::pow(0.25, k) : std::pow(0.25, 5);
    expect_by_chance(counts, shares);
}

TEST(ChaosGame, SharedPartsAreFoundOnAllWays) {
    // Two ways lead to the pair of balls, one of them twice as large: four times the area.
    const Played model =
        played("a.inst", "canonical object pair { sphere scale: 0.1\nsphere scale: 0.1 translate: 3,0,0 }\n"
                         "object top { pair translate: 0,10,0\n pair scale: 2 }");
    std::vector<double> counts(4, 0.0);
    for (const ChaosPoint& point : points_of(model.game(), 100'000, 1)) {
        const bool high = point.place.y > 5;
        ++counts[(high ? 2 : 0) + (point.place.x > 1.5 ? 1 : 0)];
    }
    expect_by_chance(counts, {0.4, 0.4, 0.1, 0.1});
}

TEST(ChaosGame, UsedAttractorsBelowOtherCyclesAreReached) {
    // A cycle that condenses another one: dust of one system at every level of the outer, and in nothing
    // else.
    const Played model =
        played("a.inst", "canonical object inner { inner scale: 0.5\ninner scale: 0.5 translate: 1,0,0 }\n"
                         "canonical object outer { inner scale: 0.1\nouter scale: 0.5 translate: 0,2,0 }\n"
                         "object top { outer }");
    std::array<int, 4> levels{};
    for (const ChaosPoint& point : points_of(model.game(), 20'000, 1)) {
        // Level k lies at y = 4 (1 - 2^-k).
        const double level = -std::log2(1 - point.place.y / 4);
        EXPECT_NEAR(level, std::round(level), 1e-6);
        ++levels[std::min<std::size_t>(static_cast<std::size_t>(std::lround(level)), 3)];
    }
    for (const int points : levels)
        EXPECT_GT(points, 200);
}

TEST(ChaosGame, TintsComposeParentInFront) {
    const Played model = played("a.rifs", "rifs t { map a { scale 1/2 tint rgb <1,0,0> 0.5 }\n"
                                          "map b { scale 1/2 translate <1/2,0> tint rgb <0,0,1> 0.5 } }");
    for (const ChaosPoint& point : points_of(model.game(), 2000, 1)) {
        double red = 0, x = point.place.x;
        for (int i = 0; i < 20; ++i) {
            const bool b = x >= 0.5;
            if (!b) red += std::pow(0.5, i + 1);
            x = 2 * x - b;
        }
        EXPECT_NEAR(point.rgb[0], red, 1e-4);
        EXPECT_NEAR(point.rgb[2], 1 - red, 1e-4);
        EXPECT_EQ(point.map, point.place.x < 0.5 ? 1u : 2u);
    }
}

TEST(ChaosGame, SequencesDifferAndRepeat) {
    const ChaosGame game = played("a.rifs", gasket(".2", ".3", ".5")).game();
    const auto first = points_of(game, 100, 1, 0), again = points_of(game, 100, 1, 0),
               other = points_of(game, 100, 1, 1);
    int equal = 0;
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(first[i].place, again[i].place);
        equal += first[i].place == other[i].place;
    }
    EXPECT_LT(equal, 5);
}

// A walk that ends once in 1e60 rounds draws the limit: it would never come to its end.
TEST(ChaosGame, WaysOutThatAreHardlyTakenAreLeftOut) {
    const auto most_height = [](const std::string& chance) {
        const Played model =
            played("a.inst", "object a { sphere chance: 1\n a scale: 0.5 chance: " + chance +
                                 "\n a scale: 0.5 translate: 1,0,0 chance: " + chance + " }");
        double most = 0;
        for (const ChaosPoint& point : points_of(model.game(), 2000, 6))
            most = std::max(most, std::abs(point.place.y));
        return most;
    };
    EXPECT_GT(most_height("1"), 0.5);
    EXPECT_GT(most_height("1e3"), 0); // some come from a small part
    for (const char* chance : {"1e12", "1e60", "1e100"})
        EXPECT_LT(most_height(chance), 1e-9) << chance;
}

TEST(ChaosGame, NothingButPlanesHasNoPoints) {
    const Played model = played("a.inst", "object top { plane }");
    EXPECT_FALSE(ChaosGame::of(model.graph, model.components, model.bounds, 0));
}

TEST(Unrolled, LevelsAreThoseOfTheGraph) {
    const Played model =
        played("a.inst", "canonical object up { union: up, left scale: 0.5\nterminal: sphere scale: 0.5 }\n"
                         "canonical object left { union: up, left scale: 0.5 translate: 1,0,0\n"
                         "terminal: sphere scale: 0.5 translate: 1,0,0 }\n"
                         "object top { up, left\nterminal: sphere }");
    for (const unsigned steps : {0u, 1u, 5u}) {
        const auto cut = unrolled(model.graph, model.components, model.bounds, steps, 10'000);
        ASSERT_TRUE(cut);
        const Played finite = analysed(*cut);
        EXPECT_EQ(finite.contraction.verdict, Verdict::acyclic);
        const double radius = std::pow(0.5, steps);
        std::vector<double> counts(std::size_t{1} << steps, 0.0);
        for (const ChaosPoint& point : points_of(finite.game(), 20'000, 1)) {
            const double spacing = 2.0 / static_cast<double>(counts.size());
            const double cell =
                std::clamp(std::round(point.place.x / spacing), 0.0, static_cast<double>(counts.size() - 1));
            EXPECT_NEAR(glm::length(point.place - Vec3(cell * spacing, 0, 0)), radius, radius + 1e-9);
            ++counts[static_cast<std::size_t>(cell)];
        }
    }
    EXPECT_FALSE(unrolled(model.graph, model.components, model.bounds, 5000, 10'000));
}

std::vector<std::string> scenes() {
    std::vector<std::string> paths;
    const std::filesystem::path root = GRAFTAL_SOURCE_DIR;
    for (const char* folder : {"scenes/ifs", "scenes/hart", "scenes/tilings", "scenes/limits"})
        for (const auto& entry : std::filesystem::directory_iterator(root / folder))
            paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
    return paths;
}

class ScenePoints : public ::testing::TestWithParam<std::string> {};

TEST_P(ScenePoints, StayInTheBoundsAndFillThem) {
    SourceMap sources;
    Diagnostics diagnostics;
    Status status;
    std::optional<Graph> graph = test::lower_file(GetParam(), {}, sources, diagnostics, status).graph;
    ASSERT_TRUE(graph) << diagnostics.render(sources);
    const Played model = analysed(std::move(*graph));
    ASSERT_TRUE(model.contraction.verdict == Verdict::proved ||
                model.contraction.verdict == Verdict::acyclic);
    const Box& box = model.bounds[model.graph.root].box;
    const double slack = 1e-9 * glm::length(box.size());
    Box found;
    for (const ChaosPoint& point : points_of(model.game(), 100'000, 1)) {
        found.include(point.place);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(point.rgb[c], -1e-6f);
            EXPECT_LE(point.rgb[c], 1 + 1e-6f);
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(found.min[axis], box.min[axis] - slack);
        EXPECT_LE(found.max[axis], box.max[axis] + slack);
        EXPECT_GE(found.size()[axis], 0.8 * box.size()[axis] - slack);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ScenePoints, ::testing::ValuesIn(scenes()), [](const auto& scene) {
    return std::filesystem::path(scene.param).stem().string();
});

} // namespace
} // namespace graftal
