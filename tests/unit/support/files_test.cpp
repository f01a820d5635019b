#include "compiler/support/files.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::string text_of(const Files& files, const std::string& path) {
    std::string text;
    const Status status = files.read(path, text);
    return status.ok() ? text : status.message();
}

TEST(MemoryFiles, HoldTextsByTheirPaths) {
    MemoryFiles files;
    files.set("models/tree.inst", "object tree { sphere }");
    EXPECT_TRUE(files.check("models/./tree.inst").ok());
    EXPECT_EQ(text_of(files, "models/leaves/../tree.inst"), "object tree { sphere }");
    EXPECT_EQ(text_of(files, "tree.inst"), "cannot open 'tree.inst': there is no such file");
    files.remove("models/tree.inst");
    EXPECT_FALSE(files.check("models/tree.inst").ok());
}

TEST(MemoryFiles, LieOverOthers) {
    MemoryFiles disk;
    disk.set("a", "on the disk");
    disk.set("b", "on the disk");
    MemoryFiles editors(&disk);
    editors.set("a", "in the editor");
    EXPECT_EQ(text_of(editors, "a"), "in the editor");
    EXPECT_EQ(text_of(editors, "b"), "on the disk");
    editors.remove("a");
    EXPECT_EQ(text_of(editors, "a"), "on the disk");
}

TEST(MemoryFiles, StampsChangeWithTheText) {
    MemoryFiles files;
    EXPECT_EQ(files.stamp("a"), FileStamp());
    files.set("a", "1");
    const FileStamp first = files.stamp("a");
    EXPECT_NE(first, FileStamp());
    EXPECT_EQ(files.stamp("a"), first);
    files.set("a", "2");
    EXPECT_NE(files.stamp("a"), first);
}

TEST(MemoryFiles, KnowWhatLiesInAFolder) {
    const MemoryFiles files;
    EXPECT_TRUE(files.lies_in("models/a", "models"));
    EXPECT_TRUE(files.lies_in("models/../models/a", "models/"));
    EXPECT_FALSE(files.lies_in("models/../a", "models"));
    EXPECT_FALSE(files.lies_in("models2/a", "models"));
    EXPECT_TRUE(files.lies_in("a/b", "."));
    EXPECT_FALSE(files.lies_in("../a", "."));
    EXPECT_FALSE(files.lies_in("/a", "."));
    EXPECT_TRUE(files.lies_in("/a", "/"));
}

/// A disk on which the folder "." is "/models".
class StartedInModels final : public Files {
  public:
    Status check(const std::string&) const override { return Status::failure("none"); }
    Status read(const std::string&, std::string&) const override { return Status::failure("none"); }
    FileStamp stamp(const std::string&) const override { return {}; }
    bool lies_in(const std::string& path, const std::string& folder) const override {
        return folder == "." && path.starts_with("/models/");
    }
};

TEST(MemoryFiles, ATextOverADiskLiesWhereItsPathLeads) {
    const StartedInModels disk;
    MemoryFiles texts(&disk);
    texts.set("/models/a", "");
    texts.set("/b", "");
    EXPECT_TRUE(texts.lies_in("/models/a", "."));
    EXPECT_TRUE(texts.lies_in("/models/c", "."));
    EXPECT_FALSE(texts.lies_in("/b", "."));
    EXPECT_TRUE(texts.lies_in("/b", "/")) << "a text of no disk";
}

} // namespace
} // namespace graftal
