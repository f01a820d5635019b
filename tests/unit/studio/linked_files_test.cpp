// Links hold the files that their models use, and open with them; none of theirs leads out of the root.

#include "runtime/studio/files/linked_files.h"

#include <gtest/gtest.h>

#include "runtime/studio/files/file_asks.h"
#include "tests/unit/studio/page.h"

namespace graftal {
namespace {

using nlohmann::json;

const std::string row = "use leaf = \"leaf.inst\"\nobject row { leaf }\n";
const std::string leaf = "object leaf { sphere }\n";

json row_link(json files) {
    return {{"name", "plants/row.inst"}, {"text", row}, {"files", std::move(files)}};
}

/// A page that shows a model without files.
class LinkedFiles : public ::testing::Test {
  protected:
    void SetUp() override { show({{"text", crystal}}); }
    void show(const json& state) {
        page.show(state);
        page.work();
    }
    json findings() const { return page.last("findings")["findings"]; }

    Page page;
};

TEST_F(LinkedFiles, ALinkHoldsTextsOfFilesAndNamesTheOthers) {
    page.home.texts.set("plants/leaf.inst", "use vein = \"parts/vein.inst\"\nobject leaf { vein }\n");
    page.home.texts.set("plants/parts/vein.inst",
                        "material bark { texture: \"bark.png\" }\nobject vein { sphere  material: bark }\n");
    page.home.texts.set("plants/parts/bark.png", std::string("\x89PNG\0", 5));
    show({{"name", "plants/row.inst"}, {"text", row}});
    const json link = page.ask("link");
    EXPECT_EQ(link["name"], "plants/row.inst") << link;
    ASSERT_EQ(link["files"].size(), 2u) << link;
    EXPECT_TRUE(link["files"].contains("plants/leaf.inst"));
    EXPECT_TRUE(link["files"].contains("plants/parts/vein.inst"));
    EXPECT_EQ(link["lacks"], json::array({"plants/parts/bark.png"}));
}

TEST_F(LinkedFiles, AModelWithErrorsGivesNoFileAway) {
    page.home.texts.set("notes.txt", "nobody's business");
    show({{"name", "row.inst"}, {"text", "object row { mesh \"notes.txt\" }\n"}});
    ASSERT_EQ(findings().size(), 1u);
    const json link = page.ask("link");
    EXPECT_EQ(link["files"], json::object()) << link;
    EXPECT_EQ(link["lacks"], json::array({"notes.txt"}));
}

TEST_F(LinkedFiles, ALinkKeepsTheWayToTheModelToItself) {
    page.home.texts.set("/home/someone/leaf.inst", leaf);
    show({{"name", "/home/someone/rows/row.inst"},
          {"text", "use leaf = \"../leaf.inst\"\nobject row { leaf }\n"}});
    const json link = page.ask("link");
    EXPECT_EQ(link["name"], "rows/row.inst");
    EXPECT_EQ(link["files"], (json{{"leaf.inst", leaf}}));
}

TEST_F(LinkedFiles, ALinkOpensWithItsFiles) {
    const json opened = page.ask("open", row_link({{"plants/leaf.inst", leaf}}));
    EXPECT_EQ(opened["name"], "plants/row.inst") << opened;
    EXPECT_EQ(opened["files"], (json{{"plants/leaf.inst", leaf}}));
    show(row_link(opened["files"]));
    EXPECT_EQ(findings(), json::array());
    EXPECT_EQ(page.last("pass")["done"], true);
    const std::string picture = page.picture();
    show(row_link({{"plants/leaf.inst", "object leaf { cylinder }\n"}}));
    EXPECT_NE(page.picture(), picture) << "another link, with another leaf";
    EXPECT_FALSE(page.ask("pick", {{"x", 32}, {"y", 18}}).contains("error"));
    EXPECT_FALSE(page.ask("thumbnail", {{"width", 16}, {"height", 9}}).contains("error"));
    show(row_link(json::object()));
    EXPECT_EQ(findings().size(), 1u) << "the files go with the link";
}

TEST_F(LinkedFiles, ALinkThatLacksAFileSaysWhichAndChangesNothing) {
    const std::size_t told = page.count("findings");
    const json opened = page.ask("open", row_link(json::object()));
    ASSERT_TRUE(opened.contains("error")) << opened;
    EXPECT_NE(opened["error"].get<std::string>().find("'plants/leaf.inst'"), std::string::npos) << opened;
    EXPECT_EQ(page.count("findings"), told);
    EXPECT_EQ(page.ask("hover", {{"offset", 0}}).count("error"), 0u);
    const json faulty = page.ask("open", {{"name", "x.rifs"}, {"text", "rifs x { map }"}});
    EXPECT_EQ(faulty["name"], "x.rifs") << "a text with errors opens, and shows them";
}

TEST_F(LinkedFiles, AFileThatTheHomeHasAsTheLinkStaysTheHomes) {
    page.home.texts.set("plants/leaf.inst", leaf);
    EXPECT_EQ(page.ask("open", row_link({{"plants/leaf.inst", leaf}}))["files"], json::object());
    const json other{{"plants/leaf.inst", "object leaf { cylinder }\n"}};
    EXPECT_EQ(page.ask("open", row_link(other))["files"], other);
    EXPECT_EQ(page.ask("open", row_link(json::object()))["name"], "plants/row.inst")
        << "a link without files finds those that are here";
}

TEST_F(LinkedFiles, TheModelThatTheHomeWasOpenedWithKeepsItsPlace) {
    page.home.model.name = "/home/someone/rows/row.inst";
    page.home.folder = "/home/someone/rows";
    page.home.texts.set("/home/someone/rows/leaf.inst", leaf);
    const json link{{"name", "row.inst"}, {"text", row}};
    EXPECT_EQ(page.ask("open", link)["name"], "/home/someone/rows/row.inst");
    EXPECT_EQ(page.ask("open", {{"name", "two.inst"}, {"text", row}})["name"], "/home/someone/rows/two.inst");
}

TEST_F(LinkedFiles, NoFileOfALinkLeadsOutOfTheRoot) {
    page.home.folder = "garden";
    page.home.texts.set("secret.inst", leaf);
    const std::string prying = "use leaf = \"../secret.inst\"\nobject row { leaf }\n";
    const json opened = page.ask(
        "open",
        {{"name", "../../etc/row.inst"}, {"text", prying}, {"files", {{"/etc/x", ""}, {"../x", ""}}}});
    EXPECT_EQ(opened["name"], "garden/row.inst") << opened;
    EXPECT_EQ(opened["files"], json::object());
    for (const char* const name : {"secret.inst", "garden/../secret.inst"}) {
        show({{"name", "garden/row.inst"}, {"text", prying}, {"files", {{name, leaf}}}});
        ASSERT_EQ(findings().size(), 1u);
        EXPECT_NE(findings()[0]["text"].get<std::string>().find("leads out"), std::string::npos);
    }
}

TEST(LinkedFilesState, AFileThatIsMadeIsOfTheLinksFilesToo) {
    StudioState state;
    state.name = "row.inst";
    state.text = row;
    state.files = {{"leaf.inst", leaf}};
    EXPECT_EQ(file_job(state, {{"suffix", ".obj"}}).files, state.files);
}

} // namespace
} // namespace graftal
