// The modules of words as plants: parents, orders, places; and files that read back.

#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "compiler/lower/plant.h"
#include "compiler/support/counter_random.h"
#include "runtime/export/plant_files.h"

namespace graftal {
namespace {

std::shared_ptr<const Plant> plant_of(const std::string& text) {
    LowerOptions options;
    options.in_place = LowerOptions::InPlace::plant;
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText lowered = lower_text("m.lsys", text, options, sources, diagnostics);
    EXPECT_TRUE(lowered.notes.plant) << diagnostics.render(sources);
    return lowered.notes.plant;
}

/// "F(1) A<0 B+0:1": each module, its parent, the order of a branch.
std::string shape_of(const Plant& plant) {
    std::string text;
    for (const PlantModule& module : plant.modules) {
        text += (text.empty() ? "" : " ") + plant.names[module.name];
        if (module.parent == PlantModule::none) continue;
        text +=
            fmt::format("{}{}:{}.{}", module.branches ? "+" : "<", module.parent, module.order, module.rank);
    }
    return text;
}

TEST(Plants, HaveParentsOrdersAndRanks) {
    const auto shape = [](const std::string& word) {
        const auto plant = plant_of("lsys a {\n  steps 0\n  axiom " + word + "\n}\n");
        return plant ? shape_of(*plant) : "";
    };
    EXPECT_EQ(shape("FA"), "F A<0:0.1");
    EXPECT_EQ(shape("F[+A][-B]C"), "F A+0:1.0 B+0:1.0 C<0:0.1");
    EXPECT_EQ(shape("F[+F[-A]F]F"), "F F+0:1.0 A+1:2.0 F<1:1.1 F<0:0.1");
    EXPECT_EQ(shape("F[[A]B]"), "F A+0:1.0 B+0:1.0");
    EXPECT_EQ(shape("[A]F"), "A F");
    EXPECT_EQ(shape("F(1)+(30)!(0.2)f(1)G(1)"), "F G<0:0.1"); // moves and turns are no parts
}

TEST(Plants, StandWhereTheTurtleDoes) {
    const auto plant = plant_of("lsys a {\n  width 0.1\n  steps 1\n  axiom F(2)[+(90)A(1)]B\n"
                                "  A(l) -> !(0.05)F(l)C\n  interpret C -> F(0.5)\n}\n");
    ASSERT_TRUE(plant);
    ASSERT_EQ(shape_of(*plant), "F F+0:1.0 C<1:1.1 B<0:0.1");
    const std::vector<PlantModule>& m = plant->modules;
    EXPECT_LT(glm::length(m[0].end - Vec3(0, 2, 0)), 1e-12);
    EXPECT_LT(glm::length(m[1].start - Vec3(0, 2, 0)), 1e-12);
    EXPECT_LT(glm::length(m[1].end - Vec3(-1, 2, 0)), 1e-12);
    EXPECT_LT(glm::length(m[2].end - Vec3(-1.5, 2, 0)), 1e-12); // as it is drawn
    EXPECT_LT(glm::length(m[2].heading - Vec3(-1, 0, 0)), 1e-12);
    EXPECT_LT(glm::length(m[3].start - Vec3(0, 2, 0)), 1e-12);
    EXPECT_DOUBLE_EQ(m[0].width, 0.1);
    EXPECT_DOUBLE_EQ(m[1].width, 0.05);
    EXPECT_EQ(m[1].parameters, std::vector<double>{1});
    EXPECT_EQ(plant->steps, 1u);
}

/// A random bracketed word of letters.
std::string random_word(const CounterRandom& random, int length) {
    std::string word = "F";
    int open = 0;
    for (int i = 0; i < length; ++i) {
        const std::uint64_t draw = random(static_cast<std::uint64_t>(i)) % 10;
        if (draw < 3) {
            word += "[+(" + std::to_string(10 * draw + 5) + ")";
            ++open;
        } else if (draw < 6 && open > 0) {
            word += "]";
            --open;
        } else {
            word += draw % 2 ? "F(0.5)" : "A";
        }
    }
    return word + std::string(static_cast<std::size_t>(open), ']');
}

/// Parents by the rules of the coding alone: a code stands in the column of its order, `^<` follows the last
/// vertex of that column, and `+` leaves the last of the column before.
std::vector<std::uint32_t> parents_in_mtg(const std::string& text) {
    std::istringstream lines(text.substr(text.find("\nMTG:\n") + 6));
    std::string line;
    std::getline(lines, line); // the header
    std::vector<std::uint32_t> parents, last;
    while (std::getline(lines, line)) {
        const std::size_t column = line.find_first_not_of('\t');
        const std::string code = line.substr(column, line.find('\t', column) - column);
        last.resize(column + 1, PlantModule::none);
        std::uint32_t parent = PlantModule::none;
        if (code.starts_with("^<"))
            parent = last[column];
        else if (code.starts_with("+"))
            parent = last.at(column - 1);
        last[column] = static_cast<std::uint32_t>(parents.size());
        parents.push_back(parent);
    }
    return parents;
}

TEST(Plants, FilesHoldTheSameTree) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const auto plant =
            plant_of("lsys a {\n  steps 0\n  axiom " + random_word(CounterRandom(seed), 60) + "\n}\n");
        ASSERT_TRUE(plant);
        std::vector<std::uint32_t> parents;
        for (const PlantModule& module : plant->modules) {
            parents.push_back(module.parent);
            if (module.parent == PlantModule::none) continue;
            const PlantModule& parent = plant->modules[module.parent];
            EXPECT_EQ(module.order, parent.order + (module.branches ? 1 : 0));
            EXPECT_LT(glm::length(module.start - parent.end), 1e-12);
            EXPECT_EQ(module.rank, module.branches ? 0 : parent.rank + 1);
        }
        EXPECT_EQ(parents_in_mtg(find_plant_format("a.mtg")->text(*plant)), parents) << seed;
        const std::string csv = find_plant_format("a.csv")->text(*plant);
        EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), parents.size() + 1);
    }
    EXPECT_EQ(find_plant_format("a.obj"), nullptr);
}

} // namespace
} // namespace graftal
