// The asks about the text reach compiler/editing, in units of UTF-16. What they answer is tested there.

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/studio/page.h"

namespace graftal {
namespace {

using nlohmann::json;

/// A comment of 3 units and 7 bytes stands before all.
const std::string text = "//\xf0\x9f\x8c\xbf\n" + std::string(crystal);
constexpr int shift = 5; // units in front of `crystal`

int place_of(const std::string& word) {
    return shift + static_cast<int>(std::string(crystal).find(word));
}

class TextAsks : public ::testing::Test {
  protected:
    TextAsks() {
        page.show({{"text", text}});
        page.work();
    }
    Page page;
};

TEST_F(TextAsks, CompleteHoverDefinitionRename) {
    const json completions = page.ask("complete", {{"offset", place_of("spread, 0>") + 3}});
    EXPECT_EQ(completions["from"], place_of("spread, 0>")) << completions;
    EXPECT_EQ(completions["items"][0]["text"], "spread");
    const json hovered = page.ask("hover", {{"offset", place_of("spread, 0>") + 3}});
    EXPECT_EQ(hovered["from"], place_of("spread, 0>")) << hovered;
    EXPECT_FALSE(hovered["text"].get<std::string>().empty());
    EXPECT_EQ(page.ask("definition", {{"offset", place_of("spread, 0>")}})["from"], place_of("spread"));
    const json renamed = page.ask("rename", {{"offset", place_of("spread")}, {"name", "width_of"}});
    EXPECT_EQ(renamed["edits"].size(), 4u) << renamed;
    EXPECT_TRUE(page.ask("rename", {{"offset", place_of("spread")}, {"name", "1 x"}}).contains("error"));
    EXPECT_TRUE(page.ask("format")["edits"].is_array());
    EXPECT_TRUE(page.ask("hover", {{"offset", 1000000}}).contains("id")) << "beyond the end";
}

TEST_F(TextAsks, MapsAreToldAndMoved) {
    const json maps = page.last("model")["maps"];
    ASSERT_EQ(maps.size(), 3u) << page.last("model");
    EXPECT_EQ(maps[0]["name"], "n");
    EXPECT_EQ(maps[0]["matrix"], (json{0.5, 0, 0, 0, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0}));
    EXPECT_EQ(maps[0]["from"], place_of("map n"));
    EXPECT_EQ(maps[0]["movable"], true);
    EXPECT_NEAR(maps[0]["contraction"].get<double>(), 0.5, 1e-12);
    const json moved =
        page.ask("map", {{"name", "e"}, {"matrix", {0.25, 0, 0, 0.5, 0, 0.25, 0, 0, 0, 0, 0.25, 0}}});
    ASSERT_TRUE(moved.contains("edits")) << moved;
    EXPECT_EQ(moved["contracts"], true);
    EXPECT_NEAR(moved["ratio"].get<double>(), 0.25, 1e-9);
    EXPECT_GE(moved["edits"].size(), 1u);
    const json large = page.ask("map", {{"name", "e"}, {"matrix", {2, 0, 0, 0.5, 0, 2, 0, 0, 0, 0, 2, 0}}});
    EXPECT_EQ(large["contracts"], false) << large;
    EXPECT_TRUE(page.ask("map", {{"name", "e"}, {"matrix", {1, 2}}}).contains("error"));
}

TEST_F(TextAsks, Vary) {
    const json varied =
        page.ask("vary", {{"kind", "parameters"}, {"count", 3}, {"spread", 0.2}, {"seed", 1}});
    ASSERT_EQ(varied["children"].size(), 3u) << varied;
    EXPECT_TRUE(varied["children"][0]["set"].contains("spread"));
    EXPECT_TRUE(page.ask("vary", {{"kind", "luck"}}).contains("error"));
}

TEST_F(TextAsks, StepsAreWrittenIntoTheText) {
    const json written = page.ask("setting", {{"name", "steps"}, {"value", 4}});
    const auto end = static_cast<int>(shift + std::string(crystal).size());
    EXPECT_EQ(written["edits"], (json::array({{{"from", end}, {"to", end}, {"text", "steps: 4\n"}}})))
        << written;
    EXPECT_TRUE(page.ask("setting", {{"name", "seed"}, {"value", 4}}).contains("error")) << "of a .rifs";
    EXPECT_TRUE(page.ask("setting", {{"name", "angle"}, {"value", 4}}).contains("error"));
    EXPECT_TRUE(page.ask("setting", {{"name", "steps"}, {"value", 0.5}}).contains("error"));
}

/// The text after an ask `setting`, which the state then draws without a choice of its own.
std::string text_with(Page& page, const std::string& text, const std::string& name, int value) {
    page.show({{"name", "plant.lsys"}, {"text", text}, {name, value}});
    page.work();
    const json written = page.ask("setting", {{"name", name}, {"value", value}});
    std::string after = text;
    const json& edits = written["edits"];
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
        const auto from = (*edit)["from"].get<std::size_t>(), to = (*edit)["to"].get<std::size_t>();
        after.replace(from, to - from, (*edit)["text"].get<std::string>());
    }
    return after;
}

TEST_F(TextAsks, AWrittenSeedGivesThePictureOfTheChosenOne) {
    const std::string twig =
        "lsys twig {\n  steps 3\n  axiom F(1)\n  F(l) -> F(l)[+(normal(40,20))F(l/2)]F(l)\n}\n";
    const std::string plant = twig + "main lsys plant {\n  steps 0\n  axiom ~twig\n}\n";
    const std::string after = text_with(page, plant, "seed", 71);
    EXPECT_NE(after.find("  steps 3\n  seed 71\n  axiom F(1)"), std::string::npos) << after;
    EXPECT_NE(after.find("  steps 0\n  axiom ~twig"), std::string::npos) << "no chance there: " << after;
    const std::string chosen = page.picture();
    page.show({{"name", "plant.lsys"}, {"text", plant}});
    page.work();
    EXPECT_NE(page.picture(), chosen);
    page.show({{"name", "plant.lsys"}, {"text", after}});
    page.work();
    EXPECT_EQ(page.picture(), chosen);
    EXPECT_NE(text_with(page, after, "seed", 5).find("\n  seed 5\n"), std::string::npos);
}

TEST_F(TextAsks, StepsOfAnLSystemAreThoseOfItsMainBlock) {
    const std::string twig = "lsys twig { steps 2 axiom F F -> FF }\nlsys plant { axiom ~twig F }\n";
    EXPECT_EQ(text_with(page, twig, "steps", 1),
              "lsys twig { steps 2 axiom F F -> FF }\nlsys plant { steps 1  axiom ~twig F }\n");
    EXPECT_EQ(text_with(page, "lsys a {\n  steps: infinite\n  axiom F\n}\n", "steps", 7),
              "lsys a {\n  steps: 7\n  axiom F\n}\n");
}

} // namespace
} // namespace graftal
