// The modules of words as plants: parents, orders, places; and files that read back.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/components.h"
#include "compiler/graph/unfold.h"
#include "compiler/languages/lower.h"
#include "compiler/lower/plant.h"
#include "compiler/support/counter_random.h"
#include "runtime/export/plant_files.h"

namespace graftal {
namespace {

std::shared_ptr<const Plant> plant_of(const std::string& text, LowerOptions options = {}) {
    options.in_place = LowerOptions::InPlace::plant;
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText lowered = lower_text("m.lsys", text, options, sources, diagnostics);
    EXPECT_TRUE(lowered.notes.plant) << diagnostics.render(sources);
    return lowered.notes.plant;
}

std::string file_of(const Plant& plant, const char* ending) {
    return find_plant_format(ending)->text({plant, tree_of(plant)}, UINT64_MAX).value_or("");
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
    ASSERT_EQ(shape_of(*plant), "F F+0:1.0 C<1:1.1 F<1:1.1 B<0:0.1"); // C, and what it is drawn as
    const std::vector<PlantModule>& m = plant->modules;
    EXPECT_LT(glm::length(m[0].end - Vec3(0, 2, 0)), 1e-12);
    EXPECT_LT(glm::length(m[1].start - Vec3(0, 2, 0)), 1e-12);
    EXPECT_LT(glm::length(m[1].end - Vec3(-1, 2, 0)), 1e-12);
    EXPECT_LT(glm::length(m[2].end - Vec3(-1.5, 2, 0)), 1e-12); // as it is drawn
    EXPECT_LT(glm::length(m[2].heading - Vec3(-1, 0, 0)), 1e-12);
    EXPECT_EQ(m[3].part_of, 2u);
    EXPECT_DOUBLE_EQ(m[2].length, 0.5);
    EXPECT_LT(glm::length(m[2].left - Vec3(0, -1, 0)), 1e-12);
    EXPECT_LT(glm::length(m[2].up - Vec3(0, 0, 1)), 1e-12);
    EXPECT_LT(glm::length(m[4].start - Vec3(0, 2, 0)), 1e-12);
    EXPECT_DOUBLE_EQ(m[0].width, 0.1);
    EXPECT_DOUBLE_EQ(m[1].width, 0.05);
    EXPECT_EQ(m[1].parameters, std::vector<double>{1});
    EXPECT_EQ(plant->steps, 1);
    EXPECT_EQ(m[0].age, 1); // whether rules ask for ages or not
    EXPECT_EQ(m[1].age, 0);
}

/// Numbers that tell two sets of segments apart: how many, their radii, lengths and places.
using Moments = std::array<double, 6>;

void add_segment(Moments& moments, Vec3 start, Vec3 end, double radius) {
    const Moments more = {1,
                          radius,
                          glm::length(end - start),
                          glm::dot(start, Vec3(0.3, 0.7, 1.1)),
                          glm::dot(end, end),
                          radius * glm::dot(end, Vec3(1, 2, 3)) * glm::length(end - start)};
    for (std::size_t i = 0; i < moments.size(); ++i)
        moments[i] += more[i];
}

Moments drawn_segments(const std::string& text, const LowerOptions& options) {
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText lowered = lower_text("m.lsys", text, options, sources, diagnostics);
    Moments moments{};
    EXPECT_TRUE(lowered.graph) << diagnostics.render(sources);
    if (!lowered.graph) return moments;
    const Components components = strong_components(*lowered.graph);
    unfold(*lowered.graph, components, {}, 1'000'000, [&](const UnfoldedLeaf& leaf) {
        if (leaf.primitive != PrimitiveKind::cylinder) return true;
        const Affine& place = leaf.world_from_object;
        add_segment(moments, place.translation, place.translation + place.linear[1],
                    glm::length(place.linear[0]));
        return true;
    });
    return moments;
}

Moments segments_of(const Plant& plant) {
    Moments moments{};
    for (const PlantModule& module : plant.modules)
        if (module.organ == Organ::segment && module.length > 0 && module.width > 0)
            add_segment(moments, module.start, module.end, module.width / 2);
    return moments;
}

// Each kind of chance, and each way to look parts up, must give the plant that the graph draws.
TEST(Plants, AreThoseThatAreDrawn) {
    const std::string models[] = {
        "lsys a {\n width 0.1\n steps 7\n axiom A\n A -> F[+(30)A]A : 0.5\n A -> FA : 0.5\n}\n",
        "lsys a {\n steps 6\n axiom A(1,0.2)\n" // sizes
        " A(l,w) -> !(w)F(l)[+(40)A(l*0.7,w*0.6)][-(30)A(l*0.8,w*0.7)] : 0.7\n A(l,w) -> !(w)F(l)A(l*0.9,w) "
        ": 0.3\n}\n",
        "lsys a {\n steps 6\n axiom A\n A -> BF[+(30)A][-(20)A]\n" // lines as thick as the figure asks
        " interpret B -> F(random(0.2, 1))+(normal(0, 9))\n}\n",
        "lsys a {\n width 0.1\n steps 6\n axiom T(0.2)/(20)A\n" // directions
        " A -> F[&(40)$A]/(137)A : 0.6\n A -> F&(10)A : 0.4\n}\n",
        "lsys a {\n thickness 0.1\n steps 4\n axiom A(4)\n A(n) -> F[@Di(0.8)+(25)A(n)]A(n)\n"
        " decompose B(n) : n > 0 -> FB(n-1)\n A(n) -> B(n)A(n) : 0.5\n A(n) -> [-(40)F]A(n) : 0.5\n}\n",
        "lsys a {\n width 0.1\n steps 5\n axiom SA\n A -> F[+(30)A]B : 0.5\n A -> FA : 0.5\n" // contexts
        " A < B -> F\n B -> FA\n interpret F -> F(random(0.5, 1))\n}\n",
        "lsys a {\n width 0.1\n steps 5\n axiom A\n A -> I[+(40)A]A : 0.5\n A -> I : 0.5\n" // a film
        " interpret I -> F(0.2 + age/4)%\n}\n",
        "lsys a {\n width 0.1\n steps 5\n axiom A\n A -> IA\n interpret I -> F(0.2 + "
        "age/4)[+(60)F(age/5)]F\n}\n",
    };
    for (const std::string& model : models)
        for (std::uint64_t seed = 1; seed <= 6; ++seed)
            for (const bool exact : {false, true}) {
                LowerOptions options;
                options.seed = seed;
                options.exact = exact;
                if (seed > 4) options.time = 4.5;
                const auto plant = plant_of(model, options);
                ASSERT_TRUE(plant) << model;
                const Moments table = segments_of(*plant), drawn = drawn_segments(model, options);
                EXPECT_GT(table[0], 0);
                for (std::size_t i = 0; i < table.size(); ++i)
                    EXPECT_NEAR(table[i], drawn[i], 1e-7 * (1 + std::abs(drawn[i])))
                        << model << " seed " << seed << " exact " << exact << " moment " << i;
            }
}

// Lines of polygons are no wood, and what is drawn in the place of a module counts once for it.
TEST(Plants, HaveARowForEachOrgan) {
    const auto plant =
        plant_of("material blade { color: 0, 1, 0 }\nlsys a {\n colors blade\n width 0.2\n steps 0\n"
                 " axiom F(2)[{.F(1)+(120)F(1)+(120).}]A@O(0.5)@o(2)~sphere(0.1)@GsF(3)!(0.1)@Ge\n"
                 " interpret A -> F(1)[+(30)F(1)]F(1)\n}\n");
    ASSERT_TRUE(plant);
    const std::vector<PlantModule>& m = plant->modules;
    ASSERT_EQ(shape_of(*plant),
              "F {+0:1.0 A<0:0.1 F<0:0.1 F+3:1.0 F<3:0.2 @O<2:0.2 @o<6:0.3 ~sphere<7:0.4 @Ge<8:0.5");
    const double pi = std::numbers::pi;
    EXPECT_EQ(m[1].organ, Organ::polygon);
    EXPECT_EQ(plant->materials.at(m[1].material), "blade");
    EXPECT_EQ(m[1].length, 0);
    EXPECT_NEAR(m[1].area, std::sqrt(3) / 4, 1e-12);
    EXPECT_NEAR(m[2].length, 3, 1e-12);
    EXPECT_NEAR(m[2].volume, 3 * pi * 0.01, 1e-12);
    for (const std::size_t part : {3u, 4u, 5u})
        EXPECT_EQ(m[part].part_of, 2u);
    EXPECT_NEAR(m[6].volume, pi / 6 * 0.125, 1e-12);
    EXPECT_NEAR(m[7].area, pi, 1e-12);
    EXPECT_FALSE(m[8].is_measured);
    EXPECT_EQ(m[8].organ, Organ::model);
    EXPECT_LT(glm::length(m[9].start - m[8].end), 1e-12);
    EXPECT_NEAR(m[9].length, 3, 1e-12);
    EXPECT_NEAR(m[9].volume, pi * (0.01 + 0.005 + 0.0025), 1e-12); // a frustum from 0.2 to 0.1 wide
}

// A blade of 0.5 x 1 that a plant places at twice its length and half its size.
TEST(Plants, HaveTheAreaOfTheirLeaves) {
    const auto plant = plant_of("lsys leaf {\n steps 0\n axiom {.f(1)+(90)f(0.5)+(90)f(1)}\n}\n"
                                "main lsys a {\n width 0.1\n steps 0\n axiom F[+~leaf(1,2)]~leaf(0.5)L\n"
                                " interpret L -> ~leaf~leaf\n}\n");
    ASSERT_TRUE(plant);
    ASSERT_EQ(shape_of(*plant), "F ~leaf+0:1.0 ~leaf<0:0.1 L<2:0.2 ~leaf<2:0.2 ~leaf<4:0.3");
    EXPECT_NEAR(plant->modules[1].area, 1, 1e-12);
    EXPECT_NEAR(plant->modules[2].area, 0.125, 1e-12);
    EXPECT_NEAR(plant->modules[3].area, 1, 1e-12);
    EXPECT_TRUE(plant->modules[3].is_measured);
}

TEST(Plants, HaveNoMoreRowsThanAllowed) {
    for (const char* model : {"lsys a {\n width 1\n steps 8\n axiom A\n A -> F[+A]A\n}\n",
                              "lsys a {\n width 1\n steps 0\n axiom A(12)\n"
                              " interpret A(n) : n > 0 -> A(n-1)FA(n-1)\n}\n"}) {
        LowerOptions options;
        options.in_place = LowerOptions::InPlace::plant;
        options.max_modules = 100;
        SourceMap sources;
        Diagnostics diagnostics;
        EXPECT_FALSE(lower_text("m.lsys", model, options, sources, diagnostics).notes.plant);
        EXPECT_NE(diagnostics.render(sources).find("more than 100 modules"), std::string::npos)
            << diagnostics.render(sources);
    }
}

TEST(Plants, AreWrittenInDecimals) {
    const auto plant = plant_of("lsys a {\n steps 0\n width 1\n axiom F(1)[+F(2e16)]F(1e-9)\n}\n");
    ASSERT_TRUE(plant);
    const std::string mtg = file_of(*plant, ".mtg");
    EXPECT_EQ(mtg.find("e+", mtg.find("\nMTG:")), std::string::npos);
    EXPECT_EQ(mtg.find("e-", mtg.find("\nMTG:")), std::string::npos);
    EXPECT_NE(mtg.find("\t20000000000000000\t"), std::string::npos);
    EXPECT_NE(mtg.find("\t0.000000001\n"), std::string::npos);
    EXPECT_FALSE(find_plant_format(".mtg")->text({*plant, tree_of(*plant)}, 100));
    EXPECT_FALSE(find_plant_format(".csv")->text({*plant, tree_of(*plant)}, 100));
    EXPECT_FALSE(find_plant_format(".json")->text({*plant, tree_of(*plant)}, 100));
}

/// Classes are letters: of many names that differ in digits alone, each pair would be a line longer than the
/// one before.
TEST(Plants, NamesThatDifferInDigitsAreFewEnoughForTheFile) {
    const auto named = [](int count) {
        std::string names, axiom;
        for (int i = 0; i < count; ++i) {
            names += (i == 0 ? " A" : ", A") + std::to_string(i);
            axiom += " A" + std::to_string(i);
        }
        return plant_of("lsys a {\n modules" + names + "\n steps 0\n axiom F" + axiom + "\n}\n");
    };
    const auto few = named(4);
    ASSERT_TRUE(few);
    const std::string mtg = file_of(*few, ".mtg");
    for (const char* const symbol : {"\nA\t2", "\nAx\t2", "\nAxx\t2", "\nAxxx\t2"})
        EXPECT_NE(mtg.find(symbol), std::string::npos) << symbol << mtg;
    const auto many = named(2000);
    ASSERT_TRUE(many);
    EXPECT_FALSE(find_plant_format(".mtg")->text({*many, tree_of(*many)}, 1u << 20));
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

/// Names of what has no letters would say nothing by themselves.
TEST(Plants, OfGraphsSayWhichClassStandsForWhichModule) {
    const PlantFormat* const format = find_plant_format(".mtg");
    const auto plant =
        plant_of("lsys a {\n modules 0, 1, _, P, A7, Bud\n steps 0\n axiom F 0 1 0 _ P A7 Bud {f+f-f}\n}\n");
    ASSERT_TRUE(plant);
    EXPECT_EQ(format->note(*plant),
              "the classes of an .mtg have letters only: Zero is '0', One is '1', Part is "
              "'_', PPart is 'P', A is 'A7', Polygon is '{'");
    const std::string mtg = file_of(*plant, ".mtg");
    for (const char* const symbol :
         {"\nF\t2", "\nZero\t2", "\nOne\t2", "\nPart\t2", "\nPolygon\t2", "\nBud\t2"})
        EXPECT_NE(mtg.find(symbol), std::string::npos) << symbol << mtg;
    const auto plain = plant_of("lsys a {\n steps 0\n axiom F[+F]F\n}\n");
    ASSERT_TRUE(plain);
    EXPECT_EQ(format->note(*plain), "");
}

TEST(Plants, OfGraphsHaveNoRowsForWhatDrawsTheirModules) {
    const auto plant = plant_of("lsys a {\n steps 0\n axiom A A\n interpret A -> F[+F]F\n}\n");
    ASSERT_TRUE(plant);
    EXPECT_EQ(plant->modules.size(), 8u);
    EXPECT_EQ(find_plant_format(".mtg")->rows(*plant), 2u);
    EXPECT_EQ(parents_in_mtg(file_of(*plant, ".mtg")).size(), 2u);
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
        EXPECT_EQ(parents_in_mtg(file_of(*plant, "a.mtg")), parents) << seed;
        const std::string csv = file_of(*plant, "a.csv");
        EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), parents.size() + 1);
    }
    EXPECT_EQ(find_plant_format("a.obj"), nullptr);
}

} // namespace
} // namespace graftal
