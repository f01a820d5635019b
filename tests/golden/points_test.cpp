#include "tests/golden/command_line.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace graftal {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string fern = "'" + source_path("scenes/ifs/fern.rifs") + "'";
const std::string flower = "'" + source_path("scenes/orbits/gumowski_mira.rifs") + "'";
const std::string few_points = " --size 80x60 --points 20000 ";

TEST_F(CommandLine, PointsUsage) {
    const struct {
        std::string arguments, message;
    } cases[] = {
        {"points", "Try 'graftal points --help' for more information.\n"},
        {"points a.rifs --points 0", "--points: '0' is not a whole number from 1 to 1e15, such as 1e9"},
        {"points a.rifs --points 1.5", "--points: '1.5' is not"},
        {"points a.rifs --points 1e16", "--points: '1e16' is not"},
        {"points a.rifs --color red", "--color: 'red' is not tint, map or density"},
        {"points a.rifs --exposure 0", "--exposure: '0' is not a number above 0"},
        {"points a.rifs --gamma nan", "--gamma: 'nan' is not a number above 0"},
        {"points a.rifs --palette red", "--palette: 'red' is not a palette (viridis, gold, "},
        {"points a.rifs --ground red", "--ground: 'red' is not black, white or a colour such as #102040"},
        {"points a.rifs --glow 2", "--glow: '2' is not a number from 0 to 1"},
        {"points a.rifs --light --transparent", "--light and --transparent exclude each other"},
        {"points a.rifs --card a.inst --glow 0.5",
         "--card: a card is no light: leave --light and --glow out"},
        {"points a.rifs -o a.jpg", "'a.jpg': the name must end in .png, .exr or .ply"},
        {"points a.rifs -o a.ply --color density", "a cloud has no pixels to count points in"},
        {"points -", "standard input has no name"},
        {"points a.rifs --error 1", "--error"},
        {"points a.rifs --engine povray", "--engine: 'povray' is not auto, native or gpu"},
        {"collage a.png", "Try 'graftal collage --help'"},
        {"collage a.png b.rifs --threshold 2", "--threshold: '2' is not a number from 0 to 1"},
        {"collage a.png b.rifs --size 10x10", "--size"},
        {"fit", "'fit' needs TARGET: 'graftal fit TARGET'"},
        {"fit a.png -o b.png", "'b.png': the name of the model must end in .rifs"},
        {"fit a.svg -o b.rifs", "'b.rifs': the name of the model must end in .lsys"},
        {"fit a.lsys", "'a.lsys' is the drawing: name another file by -o"},
        {"fit a.svg --maps 3", "--maps, --similar, --objective, --color and --start are for pictures"},
        {"fit a.svg --objective occupancy", "--objective, --color and --start are for pictures"},
        {"fit a.ply --light", "--threshold and --light are for pictures, and not for clouds and meshes"},
        {"fit a.obj --color", "--objective and --color are for pictures, and not for clouds and meshes"},
        {"fit a.png --objective far", "--objective: 'far' is not near or occupancy"},
        {"fit a.png --tolerance 0.1", "--tolerance is for drawings"},
        {"fit a.svg --tolerance 0.5", "--tolerance: '0.5' is not a number from 1e-06 to 0.2"},
        {"fit a.png --maps 1", "--maps: '1' is not a whole number from 2 to 24"},
    };
    for (const auto& [arguments, message] : cases) {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, 2) << arguments;
        EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    }
}

TEST_F(CommandLine, PointsMakePicturesAndClouds) {
    const RunResult result = graftal("points " + fern + few_points);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, StartsWith("fern.png: 20000 points, in "));
    EXPECT_EQ(picture("fern.png").width, 80);
    EXPECT_EQ(graftal("points " + fern + few_points + "-q --transparent -o a.exr").err, "");
    EXPECT_EQ(picture("a.exr").channels, 4);
    EXPECT_EQ(graftal("points " + flower + few_points + "--color density -o b.png").status, 0);
    EXPECT_EQ(graftal("points " + fern + few_points + "--palette gold --glow 0.3 --bits 16 -o b.png").status,
              0);
    const Image gold = picture("b.png");
    EXPECT_LT(gold.pixels[0], 0.2) << "the ground of light is black";
    EXPECT_TRUE(std::ranges::any_of(gold.pixels, [](float x) { return x * 255 != std::round(x * 255); }));
    EXPECT_EQ(graftal("points " + fern + few_points + "--ground white -o b.png").status, 0);
    EXPECT_EQ(picture("b.png").pixels[0], 1);
    EXPECT_EQ(graftal("points " + fern + " --points 1000 -o c.ply").status, 0);
    EXPECT_THAT(read("c.ply"), StartsWith("ply\nformat binary_little_endian 1.0\ncomment graftal "));
    EXPECT_EQ(graftal("points - -o d.png" + few_points + "< " + fern).status, 0);
    EXPECT_EQ(graftal("points - -o e.png" + few_points + "< " + flower).status, 0);
    EXPECT_EQ(files(), "a.exr b.png c.ply d.png e.png fern.png");
}

TEST_F(CommandLine, PointsThatFailLeaveNothing) {
    RunResult result = graftal("points " + fern + " --points 1e15 -o a.ply");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err,
                HasSubstr("no room for 'a.ply': 1000000000000000 points take 13.3 PiB, but only "));
    result = graftal("points " + fern + few_points + "-o nowhere/a.png");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("cannot write 'nowhere/a.png'"));
    write("o.rifs", "orbit o { x = x + 1\n  y = z }\n");
    EXPECT_EQ(graftal("points o.rifs" + few_points).status, 0);
    write("o.rifs", "orbit o { x = 3*x + 1\n  y = 0 }\n");
    result = graftal("points o.rifs -o b.png");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, StartsWith("o.rifs:1:11: error: the orbit diverges: in step 22 it goes from <"));
    write("p.rifs", "rifs p { map a { scale 1/2 probability 0 } }\n");
    result = graftal("points p.rifs");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("p.rifs:1:40: error: the probabilities of 'rifs p' are all 0"));
    write("p.rifs", "rifs p { map a { scale 1/2 probability -0.1 } map b { scale 1/2 probability 0/0 } }\n");
    result = graftal("points p.rifs");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("a probability must lie between 0 and 1, not -0.1"));
    EXPECT_THAT(result.err, HasSubstr("division by zero"));
    EXPECT_EQ(files(), "o.png o.rifs p.rifs");
}

TEST_F(CommandLine, OrbitsAreForPointsOnly) {
    EXPECT_THAT(graftal("check " + flower).out,
                HasSubstr(": ok, an orbit of 1 map: 'graftal points' draws it\n"));
    for (const char* command : {"render", "stats", "print", "animate"}) {
        const RunResult result = graftal(command + (" " + flower));
        EXPECT_EQ(result.status, 1) << command;
        EXPECT_THAT(result.err, HasSubstr("consists of formulas, not of instances")) << command;
        EXPECT_THAT(result.err, HasSubstr("'graftal points' draws it")) << command;
    }
    EXPECT_EQ(files(), "");
}

TEST_F(CommandLine, FunctionsOfOrbitsReadTheConstantsOfTheBlock) {
    write("a.rifs",
          "orbit o { let a = 2  g(t) = a*t/9  map { let a = 10*x  x = g(y) + a/40  y = 1 - x } }\n");
    write("b.rifs",
          "orbit o { let a = 2  g(t) = a*t/9  map { let b = 10*x  x = g(y) + b/40  y = 1 - x } }\n");
    for (const char* const name : {"a", "b"})
        ASSERT_EQ(
            graftal(fmt::format("points {0}.rifs -o {0}.png --points 1e4 -q --size 64x64", name)).status, 0);
    EXPECT_EQ(graftal("compare a.png b.png").out, graftal("compare a.png a.png").out);
    write("c.rifs", "orbit o { g(t, t) = t  x = g(x, y)/2  y = 0 }\n");
    EXPECT_THAT(graftal("points c.rifs").err, HasSubstr("'g' has two parameters 't'"));
}

TEST_F(CommandLine, Collage) {
    ASSERT_EQ(graftal("points " + fern + " --size 200x200 --points 1e6 --transparent -o t.png -q").status, 0);
    const RunResult text = graftal("collage t.png " + fern + " --threshold 0.01");
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("contractivity  0.850941\n"));
    const auto json =
        nlohmann::json::parse(graftal("collage t.png " + fern + " --threshold 0.01 --json").out);
    EXPECT_EQ(json["maps"], 4);
    EXPECT_EQ(json["norm"], "euclidean");
    EXPECT_LT(json["epsilon"], 3 * json["pixel"].get<double>());
    EXPECT_LT(json["distance"], json["bound"]);
    EXPECT_EQ(graftal("collage none.png " + fern).status, 3);
    EXPECT_EQ(graftal("collage t.png none.rifs").status, 3);
    EXPECT_EQ(graftal("collage t.png '" + source_path("scenes/hart/pound_sign.rifs") + "'").status, 1);
    EXPECT_EQ(files(), "t.png");
}

TEST_F(CommandLine, Fit) {
    write("g.rifs", "rifs g { codes 2d {\n.5 0 0 .5 0 0\n.5 0 0 .5 .5 0\n.5 0 0 .5 .25 .5\n} }\n"
                    "camera { orthographic look_at: 0.5,0.5,0 width: 1.2 }\n");
    ASSERT_EQ(graftal("points g.rifs --size 150x150 --points 1e6 --transparent -o t.png -q").status, 0);
    const RunResult text = graftal("fit t.png --work 3");
    EXPECT_EQ(text.status, 0);
    EXPECT_THAT(text.err, HasSubstr("t.rifs: 3 maps, each shortens to 0."));
    EXPECT_THAT(text.err, HasSubstr("so the model is proven to contract\n"));
    EXPECT_THAT(read("t.rifs"), HasSubstr("\n#   graftal fit t.png --work 3\n"));
    EXPECT_THAT(graftal("check t.rifs").out, HasSubstr("t.rifs: ok"));
    const auto json =
        nlohmann::json::parse(graftal("fit t.png --work 3 --threads 1 -o u.rifs --json -q").out);
    EXPECT_EQ(json["maps"].size(), 3);
    EXPECT_GE(json["iou_within_a_cell"], 0.99);
    EXPECT_EQ(read("u.rifs"), read("t.rifs"));
    EXPECT_EQ(graftal("fit none.png").status, 3);
    EXPECT_EQ(graftal("fit g.rifs").status, 3);
    EXPECT_EQ(graftal("fit t.png --start none.rifs -o v.rifs").status, 3);
    EXPECT_EQ(graftal("fit t.png --threshold 0.5 -o nowhere/v.rifs --work 0.01").status, 3);
    // An interruption keeps the best so far, and says so by its status.
    const RunResult stopped =
        shell("timeout -s INT 2 \"$graftal\" fit t.png --similar --maps 2 --work 1e6 -o w.rifs -q");
    EXPECT_EQ(stopped.status, 124) << "timeout's own";
    EXPECT_THAT(read("w.rifs"), HasSubstr("codes 2d"));
    EXPECT_EQ(files(), "g.rifs t.png t.rifs u.rifs w.rifs");
}

TEST_F(CommandLine, FitInSpace) {
    const std::string model = "'" + source_path("scenes/ifs/sierpinski_tetrahedron.rifs") + "'";
    ASSERT_EQ(graftal("points " + model + " --points 1e5 -o t.ply -q").status, 0);
    const RunResult text = graftal("fit t.ply --work 8");
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.err, HasSubstr("t.rifs: 4 maps, each shortens to 0.5"));
    EXPECT_THAT(text.err, HasSubstr("those with some of 100000 points; a cell is "));
    EXPECT_THAT(read("t.rifs"),
                HasSubstr("found for the cloud t.ply of 100000 points:\n#   graftal fit t.ply"));
    // The model has the coordinates of the target: the box from -1 to 1.
    const auto stats = nlohmann::json::parse(graftal("stats t.rifs --json").out);
    for (const double low : stats["bounds"]["min"])
        EXPECT_NEAR(low, -1, 0.15);
    for (const double high : stats["bounds"]["max"])
        EXPECT_NEAR(high, 1, 0.15);
    EXPECT_EQ(graftal("render t.rifs --size 64x64 -q").status, 0);
    const auto json = nlohmann::json::parse(
        graftal("fit t.ply --work 8 --threads 1 -o u.rifs --json -q --start t.rifs").out);
    EXPECT_EQ(json["maps"].size(), 4);
    EXPECT_EQ(json["maps"][0].size(), 12);
    EXPECT_GE(json["iou_within_a_cell"], 0.99);
    EXPECT_EQ(graftal("fit none.ply").status, 3);
    write("empty.ply", "");
    const RunResult empty = graftal("fit empty.ply");
    EXPECT_EQ(empty.status, 1);
    EXPECT_THAT(empty.err, HasSubstr("error: the target 'empty.ply' is of no use: it has no points"));
    const RunResult stopped =
        shell("timeout -s INT 2 \"$graftal\" fit t.ply --similar --maps 2 --work 1e6 -o w.rifs -q");
    EXPECT_EQ(stopped.status, 124) << "timeout's own";
    EXPECT_THAT(read("w.rifs"), HasSubstr("codes 3d"));
}

TEST_F(CommandLine, FitDrawings) {
    write("bush.lsys", "lsys bush {\n angle 25.7\n steps 4\n axiom X\n X -> F[+X][-X]FX\n F -> FF\n}\n");
    ASSERT_EQ(graftal("export bush.lsys -o bush.svg -q").status, 0);
    ASSERT_EQ(graftal("export bush.lsys --plotter -o pen.svg -q").status, 0);
    const RunResult text = graftal("fit bush.svg -o found.lsys");
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.err, StartsWith("found.lsys: an L-system of 8 letters, for 130 lines\n"
                                     "agreement      it draws 130 of 130 lines, no farther than "));
    EXPECT_THAT(read("found.lsys"), HasSubstr("\n#   graftal fit bush.svg\n"));
    EXPECT_THAT(read("found.lsys"), HasSubstr("\n  angle 25.7\n  steps 4\n  axiom X\n  F -> FF\n  X -> F"));
    EXPECT_THAT(graftal("check found.lsys").out, HasSubstr("found.lsys: ok"));
    const auto json = nlohmann::json::parse(graftal("fit bush.lsys -o again.lsys --json -q").out);
    EXPECT_EQ(json["lines"], 130);
    EXPECT_EQ(json["redrawn"], 130);
    EXPECT_EQ(json["steps"], 4);
    write("\xff.lsys", "lsys a {\n angle 60\n steps 3\n axiom F\n F -> F+F--F+F\n}\n");
    EXPECT_EQ(nlohmann::json::parse(graftal("fit \xff.lsys -o koch.lsys --json -q").out)["lines"], 64);
    const RunResult cut = graftal("fit pen.svg --work 1");
    EXPECT_EQ(cut.status, 1) << "a pen draws each line once, in any direction";
    EXPECT_THAT(cut.err, HasSubstr("error: "));
    write("two.csv", "x1,y1,x2,y2\n0,0,1,0\n1,0,1,1\n");
    EXPECT_EQ(graftal("fit two.csv").status, 1);
    write("broken.svg", "<svg><path d='M0 0");
    EXPECT_EQ(graftal("fit broken.svg").status, 1);
    EXPECT_EQ(graftal("fit none.svg").status, 3);
    EXPECT_EQ(graftal("fit bush.svg -o nowhere/a.lsys").status, 3);
    EXPECT_EQ(files(),
              "again.lsys broken.svg bush.lsys bush.svg found.lsys koch.lsys pen.svg two.csv \xff.lsys");
}

} // namespace
} // namespace graftal
