// Models of the papers, held to what the papers print.

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/system/file.h"
#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using Json = nlohmann::json;

class Papers : public CommandLine {
  protected:
    Json stats(const std::string& arguments) const {
        const RunResult result = graftal("stats -q --json " + arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return Json::parse(result.out, nullptr, false);
    }
};

/// The L-systems of a scene as far as its `main` one, or all of them, the last one with another axiom. They
/// find the files that the scene finds.
std::string with_axiom(const std::string& scene, const std::string& axiom) {
    std::string text;
    EXPECT_TRUE(read_text(source_path(scene), text).ok()) << scene;
    if (const std::size_t whole = text.find("\nmain lsys scene"); whole != std::string::npos)
        text.resize(whole);
    const std::size_t line = text.rfind("\n  axiom ");
    text.replace(line, text.find('\n', line + 1) - line, "\n  axiom " + axiom);
    text = std::regex_replace(text, std::regex("\nuse setting [^\n]*"), "");
    const std::string folder = source_path(scene.substr(0, scene.rfind('/') + 1));
    return std::regex_replace(text, std::regex("\"([a-z_./]+\\.(png|rifs|inst))\""), "\"" + folder + "$1\"");
}

TEST_F(Papers, FigureThreeStandsAsItsTurtleDrawsIt) {
    // FFF+F+F-F+F-F+F-FFF from the left below: three to the right, a stair back to the left, three up.
    ASSERT_EQ(graftal("render -q --engine native --size 90x90 -o a.png '" +
                      source_path("scenes/papers/figure_3.lsys") + "'")
                  .status,
              0);
    const Image image = picture("a.png");
    const auto drawn_in_row = [&](int y) {
        int count = 0;
        for (int x = 0; x < image.width; ++x)
            count += image.pixels[image.channels * (y * image.width + x) + 2] < 0.5f; // the paper is light
        return count;
    };
    int top = 0, bottom = image.height - 1;
    while (top < bottom && drawn_in_row(top) == 0)
        ++top;
    while (top < bottom && drawn_in_row(bottom) == 0)
        --bottom;
    int widest_above = 0, widest_below = 0; // of the few rows that a stroke takes
    for (int i = 0; i < 5; ++i) {
        widest_above = std::max(widest_above, drawn_in_row(top + i));
        widest_below = std::max(widest_below, drawn_in_row(bottom - i));
    }
    EXPECT_GT(widest_below, 5 * widest_above);
}

TEST_F(Papers, TuftsOfBambooHaveThreeLeaves) {
    // P7: one tuft, two, or three.
    write("leaf.lsys", with_axiom("scenes/papers/bamboo.lsys", "S"));
    write("tuft.lsys", with_axiom("scenes/papers/bamboo.lsys", "Y"));
    const long leaf = std::stol(stats("leaf.lsys --steps 0")["primitives"].get<std::string>());
    std::set<long> leaves;
    for (int seed = 1; seed <= 12; ++seed) {
        const Json json = stats("tuft.lsys --exact --steps 1 --seed " + std::to_string(seed));
        leaves.insert(std::stol(json["primitives"].get<std::string>()) / leaf);
    }
    EXPECT_EQ(leaves, (std::set<long>{3, 6, 9}));
}

TEST_F(Papers, OrgansOfBambooAreFrusta) {
    // Section 3.2: a node B is two equal frusta that join at their wide ends, C a long one, D and D0 two
    // unlike ones.
    struct Organ {
        const char* axiom;
        std::vector<std::string> frusta; ///< the ratios of their radii
    };
    for (const Organ& organ : {Organ{"B(0,1,0)", {"0.75", "0.75"}}, Organ{"C(1)", {"0.625"}},
                               Organ{"D(1)", {"0.5", "0.875"}}, Organ{"D0(1)", {"0.5", "0.875"}}}) {
        write("organ.lsys", with_axiom("scenes/papers/bamboo.lsys", organ.axiom));
        const std::string printed = graftal("print organ.lsys --steps 0").out;
        std::vector<std::string> frusta;
        static const std::regex line("instance: frustum\\(([^)]*)\\)");
        for (std::sregex_iterator at(printed.begin(), printed.end(), line), end; at != end; ++at)
            frusta.push_back((*at)[1].str());
        EXPECT_EQ(frusta, organ.frusta) << organ.axiom << "\n" << printed;
    }
}

TEST_F(Papers, StretchesOfTheCulmGrow) {
    write("culm.lsys", with_axiom("scenes/plants/bamboo_culm.lsys", "A(3)"));
    const auto height = [&](int steps) {
        return stats("culm.lsys --steps " + std::to_string(steps))["bounds"]["max"][1].get<double>();
    };
    EXPECT_GT(height(10), 1.4 * height(0)); // 1.05^10 = 1.63, less what the end's thickness adds
}

TEST_F(Papers, TreeWithoutChanceIsSymmetric) {
    write("tree.inst", "use tree = \"" + source_path("scenes/plants/tree_plain.lsys") +
                           "\"\nobject top { tree.tree_plain }\n");
    const Json bounds = stats("tree.inst")["bounds"];
    for (const int axis : {0, 2})
        EXPECT_NEAR(bounds["min"][axis].get<double>(), -bounds["max"][axis].get<double>(), 1e-9);
}

TEST_F(Papers, BranchesOfAPlantWearTheSquareOfTableOne) {
    // Han 2007: trunk(x, y, r, k1, k2). A branch 0.2 wide and 0.9 long, at the origin, upright.
    write("branch.inst", "use trunk = \"" + source_path("scenes/plants/trunk_block.inst") +
                             "\"\nobject branch { trunk  scale: 0.2, 0.9 }\n");
    const Json bounds = stats("branch.inst")["bounds"];
    const double slack = 0.002; // the tile is a little larger than its square
    EXPECT_NEAR(bounds["min"][0].get<double>(), -0.1, slack);
    EXPECT_NEAR(bounds["max"][0].get<double>(), 0.1, slack);
    EXPECT_NEAR(bounds["min"][1].get<double>(), 0, slack);
    EXPECT_NEAR(bounds["max"][1].get<double>(), 0.9, 2 * slack);
    // Its four maps halve the square, in the proportions of the table.
    const std::string printed = graftal("print branch.inst").out;
    for (const char* const chance : {"0.15", "0.35"})
        EXPECT_NE(printed.find(fmt::format("chance: {}", chance)), std::string::npos) << printed;
    // The plant's first stretch: half a unit long, a tenth wide.
    write("plant.inst", "use plant = \"" + source_path("scenes/plants/leafy_plant.lsys") +
                            "\"\nobject whole { plant(0, 1) }\n");
    EXPECT_NE(graftal("print --exact plant.inst").out.find("matrix: 0.1, 0, 0, 0, 0, 0.5, 0, 0,"),
              std::string::npos);
}

TEST_F(Papers, LeavesOfTheTreeWithoutChanceMirrorToo) {
    // A whorl of leaves, and a bough with its twigs: either side of the bough's plane, which is that of x =
    // 0.
    for (const char* part : {"K(0.1)", "B(1,0.1)"}) {
        write("part.lsys", with_axiom("scenes/plants/tree_plain.lsys", part));
        const Json bounds = stats("part.lsys --steps 3")["bounds"];
        const double left = bounds["min"][0].get<double>(), right = bounds["max"][0].get<double>();
        EXPECT_GT(right, 0.05) << part;
        EXPECT_NEAR(left, -right, 1e-4 * right) << part;
    }
}

/// x and y of the image of (0, 1/2) under each map of a used model, in its printed graph.
std::set<std::pair<std::string, std::string>> images_of_the_middle(const std::string& printed) {
    static const std::regex line("(instance|union): leaf[^\n]*\n +matrix: ([^\n]*)");
    std::set<std::pair<std::string, std::string>> images;
    for (std::sregex_iterator at(printed.begin(), printed.end(), line), end; at != end; ++at) {
        std::vector<double> row; // a b . e, c d . f
        std::istringstream numbers(std::regex_replace((*at)[2].str(), std::regex(","), " "));
        for (double number; numbers >> number;)
            row.push_back(number);
        images.emplace(fmt::format("{:.9f}", row.at(3) + row[1] / 2 + 1),
                       fmt::format("{:.9f}", row.at(7) + row[5] / 2 + 1));
    }
    return images;
}

TEST_F(Papers, LeafFamiliesKeepWhereTheirMapsTakeTheMiddle) {
    // Fang and Li, section 3.2: e + b/2 and f + d/2 are those of the original parameters.
    for (const char* const leaf : {"maple_leaf", "arbor_leaf", "bamboo_leaf"}) {
        std::string before;
        std::set<std::pair<std::string, std::string>> expected;
        for (const char* const k : {"0.5", "0", "0.15", "0.8", "1"}) {
            write("one.inst", fmt::format("use leaf = \"{}\"\nobject one {{ leaf({}{}) }}\n",
                                          source_path(fmt::format("scenes/plants/{}.rifs", leaf)), k,
                                          std::string_view(leaf) == "maple_leaf" ? ", 0.6" : ""));
            const std::string printed = graftal("print one.inst").out;
            EXPECT_NE(printed, before) << leaf << " " << k;
            before = printed;
            if (expected.empty()) expected = images_of_the_middle(printed);
            EXPECT_EQ(expected.size(), 4u) << leaf;
            EXPECT_EQ(images_of_the_middle(printed), expected) << leaf << " " << k;
        }
    }
}

TEST_F(Papers, PlanesDivideSpaceAsABinaryTree) {
    // Each space has a plane with two halves, and each half the space of the next plane.
    const std::string dot =
        graftal("graph --set planes=7 '" + source_path("scenes/plants/space_partition.inst") + "'").out;
    std::map<std::string, std::string> number; // by label
    static const std::regex node("(n[0-9]+) \\[label=\"([^\"]*)\"");
    for (std::sregex_iterator at(dot.begin(), dot.end(), node), end; at != end; ++at)
        number[(*at)[2]] = (*at)[1];
    const auto leads = [&](const std::string& from, const std::string& to) {
        EXPECT_TRUE(number.contains(from) && number.contains(to)) << from << " " << to;
        return dot.find(fmt::format("{} -> {};", number[from], number[to])) != std::string::npos;
    };
    for (int i = 1; i <= 7; ++i)
        for (const auto& [side, next] : {std::pair("left", 2 * i), std::pair("right", 2 * i + 1)}) {
            const std::string half = fmt::format("{}({})", side, i), rest = fmt::format("subtree({})", next);
            EXPECT_TRUE(leads(fmt::format("space({})", i), half)) << half;
            EXPECT_TRUE(leads(half, fmt::format("{}_half", side))) << half;
            EXPECT_TRUE(leads(half, rest)) << half;
            if (next <= 7) {
                EXPECT_TRUE(leads(rest, fmt::format("space({})", next))) << half;
            }
        }
    EXPECT_TRUE(leads("left_half", "plane"));
    EXPECT_FALSE(number.contains("subtree(16)"));
}

TEST_F(Papers, BoxesOfHalvesEndAtTheirPlanes) {
    // A half's box is within its half space, on its plane where the subtree crosses that.
    for (const auto& [half, sign] : {std::pair("left", -1.0), std::pair("right", 1.0)}) {
        write("half.inst", fmt::format("use p = \"{}\"\nobject half {{ p.{}(1) }}\n",
                                       source_path("scenes/plants/space_partition.inst"), half));
        const Json bounds = stats("half.inst")["bounds"];
        EXPECT_NEAR(bounds[sign < 0 ? "max" : "min"][0].get<double>(), 0.02 * sign, 1e-9);
        EXPECT_GT(bounds[sign < 0 ? "min" : "max"][0].get<double>() * sign, 1);
    }
    // A plane askew: what it leaves of a cube is a corner.
    write("corner.inst", "object corner { intersection: cube\n"
                         "plane rotate: z, -45 translate: -1, -0.5, 0 }\n");
    const Json bounds = stats("corner.inst")["bounds"];
    for (const int axis : {0, 1}) {
        EXPECT_NEAR(bounds["max"][axis].get<double>(), -0.5, 1e-9);
        EXPECT_NEAR(bounds["min"][axis].get<double>(), -1, 1e-9);
    }
}

TEST_F(Papers, LeavesAreMirrorImagesOfThemselves) {
    // A leaf that is one polygon about its midrib: a wrong turn at its tip makes it a gull.
    int leaves = 0;
    for (const char* folder : {"abop", "papers", "plants"})
        for (const auto& entry :
             std::filesystem::directory_iterator(source_path("scenes/" + std::string(folder)))) {
            std::string text;
            ASSERT_TRUE(read_text(entry.path().string(), text).ok());
            const std::size_t begin = text.find("lsys blade {");
            if (entry.path().extension() != ".lsys" || begin == std::string::npos) continue;
            const std::size_t end = text.find("\n}", begin);
            const std::string block = text.substr(begin, end + 2 - begin);
            if (block.find("random") != std::string::npos || block.find("inner") != std::string::npos)
                continue;
            write("leaf.lsys", std::regex_replace(block, std::regex("\n *colors [^\n]*"), "") + "\n");
            const Json bounds = stats("leaf.lsys")["bounds"];
            const double left = bounds["min"][0].get<double>(), right = bounds["max"][0].get<double>();
            EXPECT_NEAR(left, -right, 0.05 * (right - left)) << entry.path();
            ++leaves;
        }
    EXPECT_GE(leaves, 10);
}

/// In some rows of a picture what lies between each row's first dark pixel and its last.
struct Trunk {
    double dark_share = 0;
    int narrowest = 0, widest = 0; ///< rows, in pixels
};
Trunk trunk_in(const Image& image, int first_row, int last_row) {
    Trunk trunk{.narrowest = image.width};
    int dark = 0, between = 0;
    for (int y = first_row; y < last_row; ++y) {
        int begin = image.width, end = 0;
        for (int x = 0; x < image.width; ++x) {
            if (image.pixels[image.channels * (y * image.width + x) + 2] >= 0.4f) continue;
            begin = std::min(begin, x);
            end = x + 1;
            ++dark;
        }
        const int width = std::max(end - begin, 0);
        between += width;
        trunk.narrowest = std::min(trunk.narrowest, width);
        trunk.widest = std::max(trunk.widest, width);
    }
    trunk.dark_share = between == 0 ? 0 : static_cast<double>(dark) / between;
    return trunk;
}

class Trunks : public Papers {
  protected:
    /// Of the rows between two heights of a used model's object; the background is white.
    Trunk trunk(const std::string& scene, const std::string& instance, double low, double high) {
        write("tree.inst",
              "use m = \"" + source_path(scene) +
                  "\"\ncamera { location: 0, 0.5, 9  look_at: 0, 0.5, 0  orthographic  width: 1 }\n"
                  "background: 1, 1, 1\nlight { sun: 0, 0, 1  color: 0.5, 0.5, 0.5 }\n"
                  "object top { instance: m." +
                  instance + " }\n");
        const int size = 120;
        EXPECT_EQ(
            graftal("render -q --engine native --antialias off --size 120x120 -o a.png tree.inst").status, 0);
        return trunk_in(picture("a.png"), static_cast<int>(size * (1 - high)),
                        static_cast<int>(size * (1 - low)));
    }
};

TEST_F(Trunks, OfElmsAreNoThreads) {
    for (int kind = 1; kind <= 5; ++kind)
        EXPECT_GT(trunk("scenes/plants/fractal_forest.inst", "elm(" + std::to_string(kind) + ")", 0.05, 0.2)
                      .dark_share,
                  0.95);
}

TEST_F(Trunks, OfTheTreeOfFiveMapsHasNoStubs) {
    const Trunk rows = trunk("scenes/plants/five_map_tree.rifs", "scene.it  scale: 0.2, 0.2, 0.2", 0.05, 0.4);
    EXPECT_GT(rows.dark_share, 0.97);
    EXPECT_LT(rows.widest, 1.5 * rows.narrowest);
}

} // namespace
} // namespace graftal
