// Rooms within a layer include each other in one direction, and few of them are large.

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;
/// Folders that the files of a folder include, each with one such file and its include.
using Arrows = std::map<fs::path, std::map<fs::path, std::string>>;

bool is_source(const fs::path& file) {
    return file.extension() == ".cpp" || file.extension() == ".h";
}

/// True if one lies in the other: a layer's own folder holds what its rooms share and what uses them.
bool is_nested(const fs::path& a, const fs::path& b) {
    const std::string one = a.string() + "/", other = b.string() + "/";
    return one.starts_with(other) || other.starts_with(one);
}

Arrows arrows_between_rooms(const fs::path& root) {
    static const std::regex include(R"re(^\s*#\s*include\s+"([^"]+)/[^/"]+")re");
    Arrows arrows;
    for (const char* const top : {"compiler", "runtime"})
        for (const fs::directory_entry& file : fs::recursive_directory_iterator(root / top)) {
            if (!file.is_regular_file() || !is_source(file.path())) continue;
            const fs::path name = fs::relative(file.path(), root), room = name.parent_path();
            std::ifstream text(file.path());
            for (std::string line; std::getline(text, line);) {
                std::smatch match;
                if (!std::regex_search(line, match, include)) continue;
                const fs::path other = match[1].str();
                if (!is_nested(room, other)) arrows[room].emplace(other, name.string() + ": " + line);
            }
        }
    return arrows;
}

/// A way from one room to another, as the includes that it takes; "" if there is none.
std::string way_back(const Arrows& arrows, const fs::path& from, const fs::path& to,
                     std::set<fs::path>& seen) {
    const auto next = arrows.find(from);
    if (next == arrows.end()) return "";
    for (const auto& [room, line] : next->second) {
        if (room == to) return line;
        if (!seen.insert(room).second) continue;
        if (const std::string rest = way_back(arrows, room, to, seen); !rest.empty())
            return line + "\n" + rest;
    }
    return "";
}

std::string circles(const Arrows& arrows) {
    std::string found;
    for (const auto& [room, others] : arrows) {
        std::set<fs::path> seen;
        if (const std::string way = way_back(arrows, room, room, seen); !way.empty())
            found += room.string() + ":\n" + way + "\n";
    }
    return found;
}

TEST(Rooms, IncludesGoInOneDirection) {
    const Arrows arrows = arrows_between_rooms(GRAFTAL_SOURCE_DIR);
    EXPECT_GT(arrows.size(), 30u);
    EXPECT_EQ(circles(arrows), "");
}

TEST(Rooms, ACircleIsFound) {
    const Arrows circle = {{"compiler/a/x", {{"compiler/a/y", "1"}}},
                           {"compiler/a/y", {{"compiler/a/z", "2"}}},
                           {"compiler/a/z", {{"compiler/a/x", "3"}}}};
    EXPECT_NE(circles(circle), "");
    EXPECT_EQ(circles({{"compiler/a/x", {{"compiler/a/y", "1"}}}}), "");
}

TEST(Rooms, FewAreLarge) {
    const fs::path root = GRAFTAL_SOURCE_DIR;
    std::map<std::string, int> sources;
    for (const char* const top : {"compiler", "runtime", "tools/graftal"})
        for (const fs::directory_entry& file : fs::recursive_directory_iterator(root / top))
            if (file.is_regular_file() && is_source(file.path()))
                ++sources[fs::relative(file.path().parent_path(), root).string()];
    std::string large;
    int count = 0;
    for (const auto& [room, files] : sources)
        if (files > 30) {
            large += room + " ";
            ++count;
        }
    EXPECT_LE(count, 4) << "a room of more than 30 files wants rooms of its own: " << large;
}

} // namespace
} // namespace graftal
