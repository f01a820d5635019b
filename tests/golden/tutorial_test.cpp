// The models of README.md and docs/tutorial.md stand there whole, and the commands beside them draw them
// without a word. The pages' pictures are drawn by the same commands (tools/tutorial).

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "runtime/system/file.h"
#include "tests/golden/command_line.h"

namespace graftal {
namespace {

class PagesThatTeach : public CommandLine {
  protected:
    void read_page(const std::string& name) { ASSERT_TRUE(read_text(source_path(name), page_).ok()); }

    /// Writes each model that a page tells the reader to save, and returns their names.
    std::vector<std::string> save_models() {
        static const std::regex model("Save\\s+this\\s+as\\s+`([a-z_]+\\.[a-z]+)`");
        std::vector<std::string> names;
        for (std::sregex_iterator found(page_.begin(), page_.end(), model), none; found != none; ++found) {
            const std::size_t opening = page_.find("\n```", static_cast<std::size_t>(found->position()));
            const std::size_t begin = page_.find('\n', opening + 1) + 1;
            const std::size_t end = page_.find("\n```\n", begin);
            names.push_back((*found)[1]);
            write(names.back(), page_.substr(begin, end + 1 - begin));
        }
        return names;
    }

    std::string page_;
};

TEST_F(PagesThatTeach, TheTutorialsModelsAreDrawnByItsCommands) {
    read_page("docs/tutorial.md");
    const std::vector<std::string> models = save_models();
    EXPECT_EQ(models.size(), 11u) << "one a step";
    std::set<std::string> drawn;
    for (const std::string& command : commands_of("docs/tutorial.md")) {
        const RunResult result = graftal(command + " --size 24x18 --antialias off -q");
        EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
        EXPECT_EQ(result.err, "") << command;
        std::smatch model;
        if (std::regex_search(command, model, std::regex("render ([a-z_]+)\\."))) drawn.insert(model[1]);
    }
    for (const std::string& model : models) {
        const std::string name = std::filesystem::path(model).stem().string();
        EXPECT_TRUE(drawn.contains(name)) << model << " is not drawn";
        EXPECT_EQ(picture(name + ".png").width, 24);
        EXPECT_NE(page_.find("](tutorial/" + name + ".png)"), std::string::npos) << "no picture of " << model;
        EXPECT_TRUE(std::filesystem::exists(source_path("docs/tutorial/" + name + ".png"))) << name;
    }
}

TEST_F(PagesThatTeach, TheReadmesModelsAreDrawn) {
    read_page("README.md");
    const std::vector<std::string> models = save_models();
    EXPECT_EQ(models.size(), 2u);
    for (const std::string& model : models) {
        EXPECT_NE(page_.find("`graftal render " + model + "`"), std::string::npos) << model;
        const RunResult result = graftal("render " + model + " --engine native --size 24x18 -q");
        EXPECT_EQ(result.status, 0) << model << "\n" << result.err;
        EXPECT_EQ(result.err, "") << model;
    }
    const RunResult counted = graftal("stats crystal.rifs --steps 12");
    EXPECT_THAT(counted.out, testing::HasSubstr("2176782336")) << "as the page says";
}

} // namespace
} // namespace graftal
