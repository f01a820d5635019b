// Strahler orders and paths against plain recursion, and across modules that are drawn as others.

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "compiler/support/counter_random.h"
#include "runtime/plants/plant_measures.h"
#include "tests/unit/plants/plants.h"

namespace graftal {
namespace {

using test::plant_of;
using test::plant_text;

/// Orders of the rows that are segments, in their order, as digits; others are "-".
std::string orders(const std::string& block) {
    const auto plant = plant_of(plant_text("", block));
    std::string text;
    for (const std::uint16_t order : tree_of(*plant).strahler)
        text += order > 0 ? std::to_string(order) : "-";
    return text;
}

TEST(PlantTree, OrdersOfStrahler) {
    EXPECT_EQ(orders("axiom F"), "1");
    EXPECT_EQ(orders("axiom FFF"), "111");
    EXPECT_EQ(orders("axiom F[+F]F"), "211");
    EXPECT_EQ(orders("axiom F[+F]F[-F]F"), "21211");
    EXPECT_EQ(orders("axiom F[+F[+F]F][-F[+F]F]"), "3211211");
    EXPECT_EQ(orders("axiom F[+F[+F]F][-F]"), "22111");
    EXPECT_EQ(orders("axiom F[+F][-F]F"), "2111") << "three of one order make one more, as two do";
}

TEST(PlantTree, OnlySegmentsWithALengthCount) {
    EXPECT_EQ(orders("axiom F[+A@O(1)F]L[-F(0)]F"), "2--1--1");
    EXPECT_EQ(orders("axiom A[F]F"), "-11") << "two segments at the root bear nothing";
}

// The whole stands for its parts: what follows it goes on from the last of them.
TEST(PlantTree, GoesThroughModulesThatAreDrawnAsOthers) {
    EXPECT_EQ(orders("axiom I[+F]F\n interpret I -> FF"), "22211");

    const auto plant = plant_of(plant_text("", "axiom I[+F(5)]F(1)\n interpret I -> F(2)[-F(7)]F(3)"));
    const PlantTree tree = tree_of(*plant);
    ASSERT_EQ(plant->modules.size(), 6u); // I, its three parts, two more
    EXPECT_EQ(plant->modules[0].last_part, 3u);
    EXPECT_EQ(tree.path, (std::vector<double>{5, 2, 9, 5, 10, 6}));
    EXPECT_EQ(tree.bearer[4], 3u);
    EXPECT_EQ(tree.bearer[5], 3u);
    EXPECT_EQ(tree.strahler, (std::vector<std::uint16_t>{2, 2, 1, 2, 1, 1}));
}

/// A random bracketed word of segments and letters.
std::string random_word(std::uint64_t seed) {
    const CounterRandom random(seed);
    std::string word = "F(1)";
    int open = 0;
    for (std::uint64_t i = 0; i < 120; ++i) {
        const std::uint64_t draw = random(i) % 10;
        if (draw < 3) {
            word += "[+(20)";
            ++open;
        } else if (draw < 5 && open > 0) {
            word += "]";
            --open;
        } else {
            word += draw % 2 ? "F(0.5)" : "A";
        }
    }
    return word + std::string(static_cast<std::size_t>(open), ']');
}

/// Strahler's definition, by recursion from the rows' parents alone.
class PlainTree {
  public:
    explicit PlainTree(const Plant& plant) {
        for (std::uint32_t i = 0; i < plant.modules.size(); ++i) {
            std::uint32_t bearer = plant.modules[i].parent;
            while (bearer != PlantModule::none && plant.modules[bearer].organ != Organ::segment)
                bearer = plant.modules[bearer].parent;
            if (plant.modules[i].organ == Organ::segment && bearer != PlantModule::none)
                children_[bearer].push_back(i);
        }
    }
    int order(std::uint32_t segment) {
        std::vector<int> orders;
        for (const std::uint32_t child : children_[segment])
            orders.push_back(order(child));
        if (orders.empty()) return 1;
        const int most = std::ranges::max(orders);
        return most + (std::ranges::count(orders, most) > 1 ? 1 : 0);
    }

  private:
    std::map<std::uint32_t, std::vector<std::uint32_t>> children_;
};

TEST(PlantTree, OrdersOfRandomTrees) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const auto plant = plant_of(plant_text("", "axiom " + random_word(seed)));
        const PlantTree tree = tree_of(*plant);
        PlainTree plain(*plant);
        for (std::uint32_t i = 0; i < plant->modules.size(); ++i) {
            const bool segment = plant->modules[i].organ == Organ::segment;
            EXPECT_EQ(tree.strahler[i], segment ? plain.order(i) : 0) << seed << " row " << i;
        }
    }
}

TEST(PlantTree, RatioOfHorton) {
    EXPECT_FALSE(horton_ratio({5}));
    EXPECT_NEAR(*horton_ratio({27, 9, 3, 1}), 3, 1e-12);
    EXPECT_NEAR(*horton_ratio({10, 2}), 5, 1e-12);
}

} // namespace
} // namespace graftal
