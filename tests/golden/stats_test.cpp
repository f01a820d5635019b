#include "tests/golden/command_line.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace graftal {
namespace {

using Json = nlohmann::json;

std::string read_file(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Stats : public CommandLine {
  protected:
    Json stats(const std::string& arguments) const {
        const RunResult result = graftal("stats --json " + arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return Json::parse(result.out, nullptr, false);
    }
};

TEST_F(Stats, HaveTheirDocumentedKeys) {
    const Json json = stats(pound_sign);
    for (const char* key : {"model", "language", "objects", "instances", "steps", "primitives", "contraction",
                            "dimension", "bounds", "error"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key : {"verdict", "rate", "cycle"})
        EXPECT_TRUE(json["contraction"].contains(key)) << key;
    EXPECT_EQ(json["language"], "rifs");
    EXPECT_TRUE(json["steps"].is_null());
    EXPECT_TRUE(json["primitives"].is_null());
    EXPECT_EQ(json["error"], 0);
}

TEST_F(Stats, OfThePoundSignAreThoseOfThePaper) {
    const Json json = stats(pound_sign + " --steps 3");
    EXPECT_EQ(json["contraction"]["verdict"], "proved");
    EXPECT_NEAR(json["contraction"]["rate"].get<double>(), 0.5, 1e-9);
    EXPECT_NEAR(json["dimension"].get<double>(), 2.807354922, 1e-8);
    EXPECT_EQ(json["steps"], 3);
    EXPECT_EQ(json["primitives"], "392");
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(json["bounds"]["min"][axis].get<double>(), -1, 1e-9);
        EXPECT_NEAR(json["bounds"]["max"][axis].get<double>(), 1, 1e-9);
    }
}

/// A model as a recurrent IFS has the same limit: dimension, bounds, rate and picture.
TEST_F(Stats, OfModelsPrintedAsRifsAreTheirs) {
    for (const char* scene :
         {"hart/pound_sign.rifs", "ifs/fern.rifs", "ifs/graph_directed.rifs", "ifs/expanding_edge.rifs",
          "limits/tree.lsys", "limits/gosper.lsys", "hart/sierpinski.inst", "ifs/koch_curve.rifs"}) {
        SCOPED_TRACE(scene);
        const std::string model = GRAFTAL_SOURCE_DIR "/scenes/" + std::string(scene);
        const RunResult printed = graftal("print --as rifs " + model);
        ASSERT_EQ(printed.status, 0) << printed.err;
        write("copy.rifs", printed.out);
        const Json before = stats(model), after = stats(path("copy.rifs"));
        if (before["dimension"].is_null())
            EXPECT_TRUE(after["dimension"].is_null());
        else
            EXPECT_NEAR(before["dimension"].get<double>(), after["dimension"].get<double>(), 1e-9);
        for (const char* corner : {"min", "max"})
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(before["bounds"][corner][axis].get<double>(),
                            after["bounds"][corner][axis].get<double>(), 1e-9);
        EXPECT_EQ(after["contraction"]["verdict"], "proved");
    }
    // Four maps again, and the digraph of the paper.
    const std::string sign = graftal("print --as rifs " + pound_sign).out;
    EXPECT_THAT(sign, ::testing::HasSubstr("follow {"));
    const std::string fern = graftal("print --as rifs " GRAFTAL_SOURCE_DIR "/scenes/ifs/fern.rifs").out;
    EXPECT_EQ(std::count(fern.begin(), fern.end(), '{'), 5) << fern;
    // A terminal of four faces was left out without a word.
    const RunResult many =
        graftal("print --as rifs " GRAFTAL_SOURCE_DIR "/scenes/ifs/sierpinski_tetrahedron.rifs");
    EXPECT_EQ(many.status, 1);
    EXPECT_THAT(many.err, ::testing::HasSubstr("shapes, and a block takes one"));
    const RunResult elm = graftal("print --as rifs " GRAFTAL_SOURCE_DIR "/scenes/hart/elm.inst");
    EXPECT_EQ(elm.status, 1);
    EXPECT_THAT(elm.err,
                ::testing::HasSubstr("no recurrent iterated function system: nothing in it contains itself"));
}

/// The box of a few levels was that of the limit, beyond which terminals reached.
TEST_F(Stats, BoundsHoldTerminals) {
    write("a.rifs", "rifs a {\n  map l { scale 1/2 }\n  map r { scale 1/2  translate <1/2, 0, 0> }\n"
                    "  terminal cube scale 5\n}\n");
    for (const int steps : {0, 1, 2, 6}) {
        SCOPED_TRACE(steps);
        const Json json = stats(path("a.rifs") + " --steps " + std::to_string(steps));
        const double size = std::pow(0.5, steps);
        EXPECT_NEAR(json["bounds"]["min"][0].get<double>(), -5 * size, 1e-9);
        EXPECT_NEAR(json["bounds"]["max"][0].get<double>(), 1 - size + 5 * size, 1e-9);
        EXPECT_NEAR(json["bounds"]["max"][1].get<double>(), 5 * size, 1e-9);
    }
}

/// Found by a reader of the papers: a tree whose limbs shrink was scaled as one that grows.
TEST_F(Stats, LimitsThatConvergeKeepTheirSize) {
    for (const double ratio : {0.62, 0.9, 0.95}) {
        write("limit.lsys",
              fmt::format("lsys t {{\n  steps infinite\n  width 0.1\n  axiom A(1,0.1)\n  A(l,w) -> "
                          "!(w)F(l)[+(30)A(l*0.4,w*0.4)]A(l*{},w*{})\n}}\n",
                          ratio, ratio));
        EXPECT_NEAR(stats(path("limit.lsys"))["bounds"]["max"][1].get<double>(), 1 / (1 - ratio), 1e-6)
            << ratio;
    }
    write("grows.lsys",
          "lsys t {\n  steps infinite\n  width 0.01\n  axiom F\n  F -> F+(60)F-(120)F+(60)F\n}\n");
    EXPECT_NEAR(stats(path("grows.lsys"))["bounds"]["max"][1].get<double>(), 1, 0.02);
    for (const double ratio : {0.2, 0.3, 0.333}) { // less than a third: it shrinks to a point
        write("shrinks.lsys", fmt::format("lsys t {{\n  steps infinite\n  axiom F(1)\n  F(l) -> "
                                          "F(l*{0})+(60)F(l*{0})-(120)F(l*{0})+(60)F(l*{0})\n}}\n",
                                          ratio));
        EXPECT_NEAR(stats(path("shrinks.lsys"))["bounds"]["max"][1].get<double>(), 1, 0.02) << ratio;
    }
    EXPECT_EQ(stats(pound_sign)["volume"]["most"], 0) << "its 7 cubes of 8 are less each level";
}

/// Boxes that the unfolding meets, against dimensions that are known.
TEST_F(Stats, BoxesHaveTheDimensionOfTheSet) {
    struct Known {
        const char* scene;
        double dimension, slack;
    };
    for (const auto& [scene, dimension, slack] :
         {Known{"ifs/koch_curve.rifs", 1.2618595, 0.015}, Known{"hart/sierpinski.inst", 1.5849625, 0.01},
          Known{"ifs/fern.rifs", 1.825, 0.02}, Known{"ifs/sierpinski_carpet.rifs", 1.8927893, 0.03},
          Known{"limits/tree.lsys", 2.55, 0.06}}) {
        const Json boxes = stats(GRAFTAL_SOURCE_DIR "/scenes/" + std::string(scene) + " --boxes")["boxes"];
        EXPECT_NEAR(boxes["dimension"].get<double>(), dimension, slack) << scene;
        EXPECT_LT(boxes["error"].get<double>(), slack) << scene;
        EXPECT_GE(boxes["counts"].size(), 3u) << scene;
        EXPECT_GT(boxes["sides"][0].get<double>(), boxes["sides"][1].get<double>()) << scene;
        EXPECT_LE(boxes["least"], boxes["dimension"]) << scene;
        EXPECT_GE(boxes["most"], boxes["dimension"]) << scene;
    }
    EXPECT_FALSE(stats(pound_sign).contains("boxes"));
    write("die.inst", "object die {\n  difference: cube, sphere scale: 1.2\n}\n");
    const RunResult die = graftal("stats --boxes " + path("die.inst"));
    EXPECT_EQ(die.status, 0) << die.err;
    EXPECT_THAT(die.err, ::testing::HasSubstr("no boxes are counted"));
}

TEST_F(Stats, CountsAreExactAtAHundredLevels) {
    // 8 * 7^99
    EXPECT_EQ(stats(pound_sign + " --steps 100")["primitives"],
              "3696544582428294847251026021828819212408232227319571886781594664447647382442203497144");
}

TEST_F(Stats, AbsurdDepthIsNoCountButNoCrash) {
    EXPECT_TRUE(stats(pound_sign + " --steps 4000000000")["primitives"].is_null());
}

TEST_F(Stats, OfAnEndingModel) {
    write("cube.inst", "object top {\n    union: cube, cube\n    translate: 0, 3, 0\n}\n");
    const Json json = stats("cube.inst");
    EXPECT_EQ(json["language"], "inst");
    EXPECT_EQ(json["contraction"]["verdict"], "acyclic");
    EXPECT_TRUE(json["contraction"]["rate"].is_null());
    EXPECT_TRUE(json["dimension"].is_null());
    EXPECT_EQ(json["primitives"], "2");
}

TEST_F(Stats, SayWhatIsWrittenAndWhatIsLeftWhenEqualObjectsAreMerged) {
    // Hart 1992, Figures 1 to 3: a tree grows as fast as the picture, levels by three objects, a cycle not at
    // all.
    const std::string tree = "'" + source_path("scenes/hart/sierpinski_tree.inst") + "'";
    for (const auto& [levels, objects, instances] : {std::tuple{2, 14, 21}, {3, 41, 66}}) {
        const Json json = stats(tree + " --set levels=" + std::to_string(levels));
        EXPECT_EQ(json["written"]["objects"], objects) << levels;
        EXPECT_EQ(json["written"]["instances"], instances) << levels;
        EXPECT_EQ(json["objects"], 2 + levels);
    }
    const Json by_levels = stats("'" + source_path("scenes/hart/sierpinski_levels.inst") + "'");
    EXPECT_EQ(by_levels["written"], Json({{"objects", 8}, {"instances", 15}}));
    EXPECT_EQ(by_levels["objects"], 8);
}

TEST_F(Stats, NameTheCycleThatDoesNotContract) {
    write("grow.inst", "canonical object grow {\n    instance: grow\n    scale: 1.5\n    instance: cube\n}\n"
                       "object top {\n    instance: grow\n}\n");
    const Json json = stats("grow.inst");
    EXPECT_EQ(json["contraction"]["verdict"], "refuted");
    EXPECT_NEAR(json["contraction"]["rate"].get<double>(), 1.5, 1e-9);
    EXPECT_EQ(json["contraction"]["cycle"], Json::array({"grow"}));
    EXPECT_TRUE(json["bounds"].is_null());
    EXPECT_EQ(graftal("check grow.inst").status, 1);
}

// A tree of ABOP whose branchings are known: each segment but the last bears two, at 45 degrees.
TEST_F(Stats, OfAPlant) {
    const std::string tree = "'" + source_path("scenes/abop/fig2_6a.lsys") + "' --plant";
    const Json json = stats(tree + " --ground-area 10");
    EXPECT_EQ(json["segments"], 1023);
    EXPECT_EQ(json["tips"], 512);
    EXPECT_EQ(json["leaves"], 3072);
    EXPECT_EQ(json["strahler"].size(), 10u);
    EXPECT_NEAR(json["branching_ratio"].get<double>(), 2, 1e-12);
    EXPECT_NEAR(json["angle"]["mean"].get<double>(), 45, 1e-9);
    EXPECT_NEAR(json["leaf_area_index"].get<double>(), json["leaf"]["area"].get<double>() / 10, 1e-12);
    EXPECT_FALSE(json.contains("light"));
    EXPECT_THAT(graftal("stats " + tree).out,
                testing::HasSubstr("\nleaf area                      70.4629\n"));
    EXPECT_THAT(graftal("stats --help").out, testing::HasSubstr("\n  branching_ratio "));
    EXPECT_EQ(graftal("stats " + pound_sign + " --plant").status, 1);
    for (const char* vain :
         {" --irradiance", " --ground-area 2", " --plant --ground-area 0", " --plant --boxes"})
        EXPECT_EQ(graftal("stats " + pound_sign + vain).status, 2) << vain;
}

TEST_F(Stats, OfTheLightOnAPlant) {
    const std::string tree =
        "'" + source_path("scenes/abop/fig2_6a.lsys") + "' --plant --irradiance --steps 6 --samples 64";
    const Json light = stats(tree)["light"];
    EXPECT_EQ(light["samples"], 64);
    const auto of = [&](const char* key) { return light[key].get<double>(); };
    EXPECT_NEAR(of("taken") + of("to_sky") + of("to_ground") + of("left"), of("falls"), 1e-9 * of("falls"));
    EXPECT_NEAR(of("absorbed"), of("taken"), 4 * of("absorbed_error"));
    EXPECT_TRUE(light["sunlit_leaf_area"].is_null());
    EXPECT_EQ(stats(tree + " --threads 3")["light"], light);
    EXPECT_THAT(graftal("stats " + tree + " --work 0.001").err, testing::HasSubstr("seconds of work"));
}

TEST_F(Stats, OfAWordThatDrawsNothing) {
    write("word.lsys", "lsys word {\nsteps 3\nmodules A, 4\naxiom A4\nA -> AA\n}\n");
    const Json json = stats("word.lsys");
    EXPECT_EQ(json["modules"], "9");
    EXPECT_EQ(json["segments"], "0");
    EXPECT_EQ(json["primitives"], "0");
    EXPECT_EQ(json["objects"], 0);
    EXPECT_TRUE(json["bounds"].is_null());
    EXPECT_THAT(graftal("stats word.lsys").err,
                ::testing::HasSubstr("note: 'lsys word' draws nothing after 3 steps"));
    EXPECT_EQ(graftal("check word.lsys").status, 1);
    EXPECT_EQ(graftal("print word.lsys").status, 1);
}

TEST_F(Stats, DriftIsThatOfAllThatIsDrawn) {
    for (const char* body : {"~sphere(0.5)", "@O", "@o(2)", "{f.+f.+f.}", "F"}) {
        write("rare.lsys", std::string("lsys rare {\nsteps 40\naxiom S\nS -> ") + body +
                               "f S : 0.9\nS -> [+S]S : 0.1\n}\n");
        EXPECT_GT(stats("rare.lsys")["compiled"]["drift"].get<double>(), 0) << body;
    }
}

TEST_F(Stats, CountTheMembersOfFamilies) {
    write("leaf.inst", "inner k = 0 members 5\nobject leaf { sphere scale: 1, lerp(1, 2, k), 1 }\n");
    write("a.lsys", "use leaf = \"leaf.inst\"\nlsys a { steps 0\naxiom ~leaf(0.26)~leaf(0.3)~leaf(1)\n}\n");
    const Json family = stats("a.lsys")["families"]["leaf"];
    EXPECT_EQ(family["parameters"], Json({"k"}));
    EXPECT_EQ(family["members"], 2);
    EXPECT_EQ(family["possible"], 5);
    EXPECT_NEAR(family["error"].get<double>(), 0.05, 1e-12); // of 0.3, rounded to 1/4
}

TEST_F(Stats, LanguageOfStandardInputFollowsTheText) {
    EXPECT_EQ(stats("- <" + pound_sign)["language"], "rifs");
    EXPECT_EQ(stats("- <'" + source_path("scenes/hart/sierpinski.inst") + "'")["language"], "inst");
}

TEST_F(Stats, NamesThatAreNoUtf8AreStillJson) {
    write("\xff.inst", "object top {\n    union: cube\n}\n");
    EXPECT_TRUE(stats("\xff.inst").contains("model"));
}

TEST_F(Stats, EachKeyIsExplainedInTheHelpAndOnThePage) {
    write("leaf.inst", "inner k = 0 members 5\nobject leaf { sphere scale: 1, lerp(1, 2, k), 1 }\n");
    write("family.lsys", "use leaf = \"leaf.inst\"\nlsys a {\n steps 0\n axiom ~leaf(0.26)\n}\n");
    const std::string help = graftal("stats --help").out, page = read_file(source_path("docs/language.md"));
    const std::size_t table = page.find("### How a model is compiled");
    const std::string section = page.substr(table, page.find("*Composed.*", table) - table);
    std::set<std::string> keys;
    for (const std::string& model :
         {pound_sign, std::string("family.lsys"), "'" + source_path("scenes/plants/growing_herb.lsys") + "'",
          "'" + source_path("scenes/plants/autumn_tree.lsys") + "'"}) {
        const RunResult result = graftal("stats " + model);
        ASSERT_EQ(result.status, 0) << result.err;
        std::istringstream lines(result.out);
        for (std::string line; std::getline(lines, line);) {
            std::string key = line.substr(0, line.find("  "));
            if (line.size() > 28 && key.size() > 28) key = line.substr(0, line.rfind(' '));
            std::istringstream words(key);
            std::string first, name, last;
            words >> first;
            if (first == "families") words >> name; // the model's own
            std::string known = first;
            while (words >> last)
                known += " " + last;
            keys.insert(known);
        }
    }
    EXPECT_GE(keys.size(), 30u);
    for (const std::string& key : keys) {
        EXPECT_THAT(help, testing::HasSubstr("\n  " + key + " ")) << key;
        EXPECT_THAT(section, testing::HasSubstr("`" + key.substr(key.rfind(' ') + 1) + "`")) << key;
    }
}

TEST_F(Stats, JsonKeepsTheFormerNameOfPrimitives) {
    const Json json = stats(pound_sign + " --steps 3");
    EXPECT_EQ(json["leaves"], json["primitives"]);
}

TEST_F(Stats, PlainTextHasTheSameFigures) {
    const RunResult result = graftal("stats " + pound_sign + " --steps 3");
    EXPECT_THAT(result.out, testing::HasSubstr("primitives                   392\n"));
    EXPECT_THAT(result.out, testing::HasSubstr("contraction verdict          proved\n"));
}

} // namespace
} // namespace graftal
