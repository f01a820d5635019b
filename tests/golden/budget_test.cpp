// What --memory allows is used: a coarser picture than it asks for is a fault too.

#include "tests/golden/command_line.h"

#include <string>

#include <gmock/gmock.h>

namespace graftal {
namespace {

using testing::HasSubstr;

class Budget : public CommandLine {
  protected:
    /// What `compile` says of a model.
    std::string compiled(const std::string& options) {
        const RunResult run = graftal("compile a.inst -o a.pov " + options);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.err;
    }
};

/// The near patch asks for a finer mesh than the far ones, until it is spelt out.
TEST_F(Budget, AMeshIsAsFineAsThePiecesThatAreLeftAsk) {
    write("a.inst", "camera { location: 0,0,0 look_at: 0,0,-1 angle: 50 }\n"
                    "canonical object patch {\n"
                    "  scatter: sphere count: 700 over: disc 1 by: uniform size: 0.02..0.04 seed: 1 }\n"
                    "canonical object far {\n"
                    "  scatter: patch count: 4000 over: -60,-300,60,-200 by: uniform seed: 2 turn: y }\n"
                    "object all { far translate: 0,-4,0\n patch translate: 0,-0.3,-1.2 }\n");
    EXPECT_THAT(compiled("--memory 150M"), HasSubstr("nothing left out"));
}

/// The edge from a root into a cycle is no part of it, and need not contract.
TEST_F(Budget, AnObjectAroundAModelCostsNothing) {
    const std::string camera = "camera { location: 0.5,0.5,2.6 look_at: 0.5,0.46,0 angle: 32 }\n";
    const std::string body = "instance: t scale: 0.5,0.25,0.35\n"
                             "instance: t scale: 0.5,0.25,0.35 translate: 0.5,0,0\n"
                             "instance: t scale: 0.25,0.5,0.35 translate: 0.25,0.5,0\n"
                             "instance: t scale: 0.25,0.5,0.35 translate: 0.5,0.5,0\n"
                             "terminal: sphere }\n";
    write("a.inst", camera + "object t { " + body);
    const std::string direct = compiled("");
    write("a.inst", camera + "canonical object t { " + body + "object r { t }\n");
    EXPECT_EQ(compiled(""), direct);
    EXPECT_THAT(direct, HasSubstr("meshes"));
}

/// Seven hundred trees of 64 kinds of each limb, at as many distances: more kinds of details than are told
/// apart.
TEST_F(Budget, WoodsShareMeshesHoweverManyKindsTheyAre) {
    const RunResult run = graftal("compile '" + source_path("scenes/plants/autumn.inst") +
                                  "' -o a.pov --memory 1G --size 640x360");
    ASSERT_EQ(run.status, 0) << run.err;
    const std::size_t at = run.err.find(", error ");
    ASSERT_NE(at, std::string::npos) << run.err;
    EXPECT_LT(std::stod(run.err.substr(at + 8)), 5) << "85 where they were not counted";
}

/// One placement more or one triangle less: where half of the text is meshes it is shortest. Placements
/// double from one choice to the next here, and triangles halve.
TEST_F(Budget, NeitherMeshesNorPlacementsMakeMostOfTheText) {
    for (const int steps : {10, 13}) {
        const RunResult run = graftal("compile '" + source_path("scenes/ifs/sierpinski_tetrahedron.rifs") +
                                      "' --error 0 -o a.pov --steps " + std::to_string(steps));
        ASSERT_EQ(run.status, 0) << run.err;
        const std::string text = read("a.pov");
        const std::size_t begin = text.find("mesh2 {"), end = text.find("\n}\n", begin);
        ASSERT_NE(end, std::string::npos);
        const double share = static_cast<double>(end - begin) / static_cast<double>(text.size());
        EXPECT_GT(share, 0.3) << steps;
        EXPECT_LT(share, 0.7) << steps;
    }
}

} // namespace
} // namespace graftal
