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

} // namespace
} // namespace graftal
