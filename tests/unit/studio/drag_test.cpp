// A part of an L-system is dragged: the number that moves it changes in the text, and nothing else.

#include <cmath>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/studio/page.h"

namespace graftal {
namespace {

using nlohmann::json;

/// The twig leaves the stem at (0, 1), 40 degrees to the left, and is as long as `reach`.
const std::string twig = "camera { location: 0, 1, 6  look_at: 0, 1, 0  angle: 40 } // \xf0\x9f\x8c\xbf\n"
                         "let reach = 1\n"
                         "lsys twig {\n"
                         "  steps 1\n"
                         "  angle 90 // for turns without a number\n"
                         "  axiom A\n"
                         "  A -> F(1)[+(40)F(reach)]  F(0.5) // a stem\n"
                         "}\n";
constexpr double height_px = 360, middle_x_px = 320, middle_y_px = 180;

Vec3 part_place(const json& numbers) {
    return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

/// The place of the text where it has it, in units of UTF-16: the leaf in the first line has two units.
int place_in_twig(const std::string& word) {
    return static_cast<int>(twig.find(word)) - 2;
}

class Drag : public ::testing::Test {
  protected:
    void show(const std::string& text) {
        page.show({{"text", text}, {"name", "twig.lsys"}, {"width", 640}, {"height", height_px}});
        page.work();
    }

    /// The part that the picture shows at a place of the plane z = 0.
    json picked(double x, double y) {
        const double unit_px = middle_x_px / (6 * std::tan(glm::radians(20.0)));
        return page.ask("pick", {{"x", middle_x_px + x * unit_px}, {"y", middle_y_px - (y - 1) * unit_px}});
    }

    json dragged(const json& part, Vec3 to, const json& number = nullptr) {
        return page.ask("drag", {{"part", part["part"]},
                                 {"from", part["point"]},
                                 {"to", {to.x, to.y, to.z}},
                                 {"number", number}});
    }

    /// Where the middle of the twig lies at this angle and length.
    static Vec3 middle(double angle_deg, double length) {
        const double angle = glm::radians(angle_deg);
        return {-0.5 * length * std::sin(angle), 1 + 0.5 * length * std::cos(angle), 0};
    }

    Page page;
};

TEST_F(Drag, ATurnOfATwigChangesItsAngle) {
    show(twig);
    const json part = picked(middle(40, 1).x, middle(40, 1).y);
    ASSERT_TRUE(part.contains("part")) << part;
    EXPECT_EQ(twig.substr(part["from"].get<std::size_t>() + 2, 4), "A ->") << "the rule that made it";
    const Vec3 way = middle(55, 1) - middle(40, 1);
    const json change = dragged(part, part_place(part["point"]) + way);
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], place_in_twig("40)F"));
    EXPECT_EQ(change["edits"][0]["to"], place_in_twig("40)F") + 2) << "the comments stay";
    EXPECT_NEAR(std::stod(change["edits"][0]["text"].get<std::string>()), 55, 1);
    EXPECT_EQ(change["number"], place_in_twig("40)F"));
    EXPECT_LT(glm::distance(part_place(change["point"]), part_place(part["point"]) + way), 0.02);
}

TEST_F(Drag, AStretchOfATwigChangesTheLetThatItsLengthComesFrom) {
    show(twig);
    const json part = picked(middle(40, 1).x, middle(40, 1).y);
    const json change = dragged(part, part_place(part["point"]) + middle(40, 1.5) - middle(40, 1));
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], place_in_twig("1\nlsys"));
    EXPECT_NEAR(std::stod(change["edits"][0]["text"].get<std::string>()), 1.5, 0.05);
}

TEST_F(Drag, ANumberHasTheDigitsThatAPixelTells) {
    show(twig);
    json part = picked(middle(40, 1).x, middle(40, 1).y);
    const Vec3 way = middle(41, 1) - middle(40, 1);
    const Vec3 to = part_place(part["point"]) + way;
    const json change = page.ask(
        "drag",
        {{"part", part["part"]}, {"from", part["point"]}, {"to", {to.x, to.y, to.z}}, {"grain", 0.01}});
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["text"], "41") << "a pixel is a degree wide";
    const json finely = page.ask(
        "drag",
        {{"part", part["part"]}, {"from", part["point"]}, {"to", {to.x, to.y, to.z}}, {"grain", 0.01 / 50}});
    EXPECT_LE(finely["edits"][0]["text"].get<std::string>().size(), 5u) << finely;
}

TEST_F(Drag, ADragGoesOnWithTheNumberThatItBeganWith) {
    show(twig);
    const json part = picked(middle(40, 1).x, middle(40, 1).y);
    const Vec3 along = part_place(part["point"]) + middle(40, 1.5) - middle(40, 1);
    EXPECT_TRUE(dragged(part, along, place_in_twig("40)F")).contains("error"))
        << "an angle makes nothing longer";
    const Vec3 slanting = part_place(part["point"]) + middle(60, 1.2) - middle(40, 1);
    EXPECT_EQ(dragged(part, slanting, place_in_twig("40)F"))["edits"][0]["from"], place_in_twig("40)F"));
}

TEST_F(Drag, ATurnWithoutANumberReadsTheAngleOfTheBlock) {
    std::string text = twig;
    text.replace(text.find("+(40)"), 5, "+");
    text.replace(text.find("90 //"), 2, "45");
    show(text);
    const json part = picked(middle(45, 1).x, middle(45, 1).y);
    const json change = dragged(part, part_place(part["point"]) + middle(65, 1) - middle(45, 1));
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], place_in_twig("90 //"));
    EXPECT_NEAR(std::stod(change["edits"][0]["text"].get<std::string>()), 65, 1);
}

/// A twig that leaves its stem at (0, 1), and leans as its rules say.
std::string leaning_twig(const std::string& rules, const std::string& let = "") {
    return "camera { location: 0, 1, 6  look_at: 0, 1, 0  angle: 40 }\n" + let +
           "lsys twig {\n  steps 2\n  axiom A\n" + rules + "}\n";
}

class ChanceDrag : public Drag {
  protected:
    /// Shows a model whose twig leans by chance, and drags it to lean by 15 degrees more.
    json leant(const std::string& text) {
        show(text);
        for (int angle_deg = -20; angle_deg <= 20; ++angle_deg) {
            const json part = picked(middle(angle_deg, 1).x, middle(angle_deg, 1).y);
            if (!part.contains("part")) continue;
            const Vec3 point = part_place(part["point"]);
            const double leans_deg = glm::degrees(std::atan2(-point.x, point.y - 1));
            const double more_deg = leans_deg < 0 ? -15 : 15;
            return dragged(part, point + middle(leans_deg + more_deg, 1) - middle(leans_deg, 1));
        }
        ADD_FAILURE() << "the twig is nowhere";
        return {};
    }
    static double size_of(const json& change) {
        return std::abs(std::stod(change["edits"][0]["text"].get<std::string>()));
    }
};

TEST_F(ChanceDrag, TheMeanOfAChanceChangesAndNotItsDeviation) {
    const std::string text = leaning_twig("  A -> F(1)[+(normal(0, 5))F(1)]\n");
    const json change = leant(text);
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], text.find("0, 5)"));
    EXPECT_NEAR(size_of(change), 15, 1);
}

TEST_F(ChanceDrag, ALetThatIsADeviationStays) {
    const std::string text = leaning_twig("  A -> F(1)[+(normal(0, wide))F(1)]\n", "let wide = 5\n");
    const json change = leant(text);
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], text.find("0, wide"));
}

TEST_F(ChanceDrag, ANumberThatRulesHandOnToADeviationStays) {
    const std::string text = leaning_twig("  A -> F(1)[B(5)]\n  B(s) -> [+(normal(0, s))F(1)]\n");
    const json change = leant(text);
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], text.find("0, s)"));
}

TEST_F(ChanceDrag, AFactorOfAChanceWithoutAMeanStays) {
    const std::string text = leaning_twig("  A -> F(1)[+(5*normal(0, 1))F(1)]\n");
    const json change = leant(text);
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    EXPECT_EQ(change["edits"][0]["from"], text.find("0, 1)")) << "the mean of the chance";
    EXPECT_NEAR(size_of(change), 3, 0.2);
}

TEST_F(ChanceDrag, BoundsOfAChanceFollowWhereNothingElseDoes) {
    const std::string text = leaning_twig("  A -> F(1)[+(random(-5, 5))F(1)]\n");
    const json change = leant(text);
    ASSERT_EQ(change["edits"].size(), 1u) << change;
    const auto from = change["edits"][0]["from"].get<std::size_t>();
    EXPECT_GE(from, text.find("-5, 5)"));
    EXPECT_LE(from, text.find("5))F"));
}

TEST_F(Drag, WhatTheRulesCannotDoIsRefused) {
    show(twig);
    const json part = picked(0, 0.5);
    ASSERT_TRUE(part.contains("part")) << part;
    EXPECT_TRUE(dragged(part, part_place(part["point"]) + Vec3(0, 0, 1)).contains("error"))
        << "nothing turns the stem";
    EXPECT_TRUE(
        page.ask("drag", {{"part", {99, 99}}, {"from", {0, 0, 0}}, {"to", {1, 0, 0}}}).contains("error"));
    EXPECT_TRUE(page.ask("drag", {{"part", {-1}}, {"from", {0, 0, 0}}, {"to", {1, 0, 0}}}).contains("error"));
    EXPECT_TRUE(page.ask("drag", {{"from", {0, 0, 0}}, {"to", {1, 0, 0}}}).contains("error"));
}

} // namespace
} // namespace graftal
