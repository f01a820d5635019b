#include "compiler/support/path_text.h"

#include <filesystem>
#include <random>

#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;

TEST(PathText, SaysWhatTheLibraryOfTheLanguageSays) {
    static constexpr const char* pieces[] = {"a",   "b.inst", ".",        "..", "/",   "//",
                                             ".rc", "a.b.c",  "été.lsys", "/",  "x y", "/"};
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
        std::string path;
        for (unsigned k = random() % 8; k > 0; --k)
            path += pieces[random() % std::size(pieces)];
        const fs::path theirs(path);
        EXPECT_EQ(is_absolute_path(path), theirs.is_absolute()) << path;
        EXPECT_EQ(file_name_of(path), theirs.filename().string()) << path;
        EXPECT_EQ(extension_of(path), theirs.extension().string()) << path;
        EXPECT_EQ(stem_of(path), theirs.stem().string()) << path;
        fs::path normal = theirs.lexically_normal();
        if (!normal.has_relative_path()) normal = theirs.is_absolute() ? "/" : ".";
        if (!normal.has_filename() && normal.has_relative_path())
            normal = normal.parent_path(); // a final slash
        EXPECT_EQ(normalised_path(path), normal.string()) << path;
    }
}

TEST(PathText, NamesAreLookedUpBesideTheFileThatNamesThem) {
    EXPECT_EQ(path_beside("models/tree.inst", "leaf.inst"), "models/leaf.inst");
    EXPECT_EQ(path_beside("models/tree.inst", "../leaf.inst"), "leaf.inst");
    EXPECT_EQ(path_beside("tree.inst", "parts/./leaf.inst"), "parts/leaf.inst");
    EXPECT_EQ(path_beside("tree.inst", "/parts/leaf.inst"), "/parts/leaf.inst");
    EXPECT_EQ(path_beside("/tree.inst", "../../leaf.inst"), "/leaf.inst");
}

} // namespace
} // namespace graftal
