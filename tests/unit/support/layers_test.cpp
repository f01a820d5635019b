// Includes go only to the layers that CMakeLists.txt says a layer uses.

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;
using Layers = std::map<std::string, std::set<std::string>>; // folder -> folders that it may include

/// The table of graftal_layer() calls. A layer stands below all that it uses, so one read is enough.
Layers layers_of(const fs::path& root) {
    static const std::regex call(R"(^graftal_layer\((\S+)\s*(?:USES ([a-z/ ]+))?)");
    Layers layers;
    std::ifstream lists(root / "CMakeLists.txt");
    for (std::string line; std::getline(lists, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, call)) continue;
        const std::string folder = match[1];
        std::set<std::string>& allowed = layers[folder] = {folder};
        std::istringstream uses(match[2]);
        for (std::string used; uses >> used;) {
            EXPECT_TRUE(layers.count(used)) << folder << " uses " << used << ", which stands below it";
            allowed.merge(std::set(layers[used]));
        }
    }
    return layers;
}

TEST(Layers, IncludesGoDownTheListOnly) {
    static const std::regex include(R"(^\s*#\s*include\s+"([^"]+)\")");
    const fs::path root = GRAFTAL_SOURCE_DIR;
    const Layers layers = layers_of(root);
    ASSERT_GT(layers.size(), 10u);
    int includes = 0;
    for (const auto& [folder, allowed] : layers) {
        if (!fs::exists(root / folder)) continue;
        for (const fs::directory_entry& file : fs::directory_iterator(root / folder)) {
            if (!file.is_regular_file() ||
                (file.path().extension() != ".cpp" && file.path().extension() != ".h"))
                continue;
            std::ifstream text(file.path());
            for (std::string line; std::getline(text, line);) {
                std::smatch match;
                if (!std::regex_search(line, match, include)) continue;
                const fs::path included = match[1].str();
                EXPECT_TRUE(allowed.count(included.parent_path())) << file.path() << " includes " << included;
                EXPECT_TRUE(fs::exists(root / included)) << file.path() << " includes " << included;
                ++includes;
            }
        }
    }
    EXPECT_GT(includes, 50);
}

} // namespace
} // namespace graftal
