// Scenes of models that look around them, held to what the surroundings allow.

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

class Surroundings : public CommandLine {
  protected:
    /// Counts by `stats` of a scene that draws without a warning.
    nlohmann::json size_of(const std::string& scene) const {
        const RunResult result =
            graftal("stats --json '" + source_path("scenes/surroundings/" + scene + ".lsys") + "'");
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "") << scene;
        return nlohmann::json::parse(result.out, nullptr, false);
    }
};

double corner(const nlohmann::json& size, const char* which, int axis) {
    return size["bounds"][which][axis].get<double>();
}

TEST_F(Surroundings, EveryCellOfEveryLineOfAShellIsDrawn) {
    // Three shells of 1100 lines of 90 cells, two triangles each, and the ball at the apex.
    EXPECT_EQ(size_of("textile_cone")["primitives"], std::to_string(3 * (2 * 1100 * 90 + 1)));
}

TEST_F(Surroundings, EveryStitchOfAChartIsKnitted) {
    // 48 lines of 49 stitches of two legs, each in three pieces with the balls at their ends.
    EXPECT_EQ(size_of("ski_sweater")["primitives"], std::to_string(48 * 49 * 2 * 2 * 3));
}

TEST_F(Surroundings, IvyKeepsToTheStoneAndClimbsIt) {
    const nlohmann::json size = size_of("ivy");
    for (const int axis : {0, 2}) { // the plinth ends at 1
        EXPECT_LT(corner(size, "max", axis), 1.4);
        EXPECT_GT(corner(size, "min", axis), -1.4);
    }
    EXPECT_GT(corner(size, "max", 1), 4.2); // the ball ends at 4.2
    EXPECT_LT(corner(size, "max", 1), 4.5);
}

TEST_F(Surroundings, TwigsFillTheAnimalAndNothingBesides) {
    const nlohmann::json size = size_of("elephant");
    const double lowest[] = {-2.35, 0, -1.38}, highest[] = {3.87, 4.70, 1.38}; // of the regions
    for (const int axis : {0, 1, 2}) {
        EXPECT_NEAR(corner(size, "min", axis), lowest[axis], 0.3) << axis;
        EXPECT_NEAR(corner(size, "max", axis), highest[axis], 0.3) << axis;
    }
}

TEST_F(Surroundings, OthersDrawWithoutAWarning) {
    for (const char* scene : {"cherry", "houseleeks", "sea_lace", "window_cress"})
        EXPECT_GT(std::stoll(size_of(scene)["primitives"].get<std::string>()), 4000) << scene;
}

} // namespace
} // namespace graftal
