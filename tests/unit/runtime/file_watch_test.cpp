#include "runtime/system/file_watch.h"

#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

namespace fs = std::filesystem;

class FileWatches : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(directory_.create().ok());
        add("last");
    }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }
    void write(const std::string& name) const { std::ofstream(path(name)) << "text"; }
    void add(const std::string& name) { watch_.add(path(name)); }

    /// What has changed since the last call. The kernel tells of changes in their order, and of a file that
    /// takes another's place once.
    std::set<std::string> changes() {
        write("new");
        fs::rename(path("new"), path("last"));
        std::set<std::string> names;
        while (!names.contains("last")) {
            pollfd news{watch_.descriptor(), POLLIN, 0};
            if (::poll(&news, 1, 60'000) <= 0) break;
            for (const std::string& file : watch_.take())
                names.insert(fs::path(file).lexically_relative(directory_.path()).string());
        }
        EXPECT_TRUE(watch_.status().ok()) << watch_.status().message();
        EXPECT_EQ(names.erase("last"), 1u);
        return names;
    }

    TemporaryDirectory directory_;
    FileWatch watch_;
};

TEST_F(FileWatches, SeeWhatIsWrittenReplacedMadeAndRemoved) {
    write("a");
    changes();
    add("a");
    EXPECT_THAT(changes(), IsEmpty());
    write("a");
    EXPECT_THAT(changes(), ElementsAre("a"));
    write("b");
    fs::rename(path("b"), path("a"));
    EXPECT_THAT(changes(), ElementsAre("a"));
    fs::remove(path("a"));
    EXPECT_THAT(changes(), ElementsAre("a"));
    write("a");
    EXPECT_THAT(changes(), ElementsAre("a"));
    fs::rename(path("a"), path("c"));
    EXPECT_THAT(changes(), ElementsAre("a"));
}

TEST_F(FileWatches, LeaveAloneWhatIsBeside) {
    add("a");
    write("b");
    fs::create_directory(path("folder"));
    fs::remove(path("b"));
    std::ifstream(path("a")).get();
    EXPECT_THAT(changes(), IsEmpty());
}

TEST_F(FileWatches, WaitForAFileThatIsOnlyOpened) {
    add("a");
    std::ofstream file(path("a"));
    EXPECT_THAT(changes(), IsEmpty());
    file << "text";
    file.close();
    EXPECT_THAT(changes(), ElementsAre("a"));
}

TEST_F(FileWatches, LetFoldersComeGoAndMove) {
    add("one/two/a");
    fs::create_directories(path("one/two"));
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    write("one/two/a");
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    fs::rename(path("one"), path("other"));
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    fs::create_directories(path("one/two"));
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    write("one/two/a");
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    fs::remove_all(path("one"));
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    fs::rename(path("other"), path("one"));
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
    write("one/two/a");
    EXPECT_THAT(changes(), ElementsAre("one/two/a"));
}

TEST_F(FileWatches, FollowLinksWhichMayChange) {
    fs::create_directories(path("real"));
    write("real/a");
    write("real/b");
    fs::create_symlink("real/a", path("link"));
    fs::create_directory_symlink("real", path("folder"));
    changes();
    add("link");
    add("folder/b");
    write("real/a");
    EXPECT_THAT(changes(), ElementsAre("link"));
    write("real/b");
    EXPECT_THAT(changes(), ElementsAre("folder/b"));
    fs::create_symlink("real/b", path("other"));
    fs::rename(path("other"), path("link"));
    EXPECT_THAT(changes(), ElementsAre("link"));
    write("real/b");
    EXPECT_THAT(changes(), ElementsAre("folder/b", "link"));
    fs::remove(path("folder"));
    EXPECT_THAT(changes(), ElementsAre("folder/b"));
}

TEST_F(FileWatches, AreNotLedAstrayByRingsOfLinksAndLongNames) {
    fs::create_symlink("b", path("a"));
    fs::create_symlink("a", path("b"));
    add("a");
    add(std::string(300, 'x'));
    add(std::string(5000, 'x') + "/" + std::string(5000, 'y'));
    fs::remove(path("b"));
    write("b");
    EXPECT_THAT(changes(), ElementsAre("a"));
}

} // namespace
} // namespace graftal
