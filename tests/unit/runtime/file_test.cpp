#include "runtime/system/file.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of its own, removed afterwards.
class FilesOnDisk : public testing::Test {
  protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ =
            fs::temp_directory_path() / ("graftal_" + std::string(test->name()) + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string contents(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    fs::path folder_;
};

TEST_F(FilesOnDisk, WriteThenReadGivesTheSameBytes) {
    const std::string text("a\r\n\0\xFF end", 9);
    ASSERT_TRUE(write_text(path("x.inst"), text).ok());
    std::string back = "old";
    ASSERT_TRUE(read_text(path("x.inst"), back).ok());
    EXPECT_EQ(back, text);
    EXPECT_EQ(file_count(), 1u) << "no temporary is left";
}

TEST_F(FilesOnDisk, ReadingSaysWhatWasTriedAndWhatTheSystemAnswered) {
    std::string text;
    EXPECT_EQ(read_text(path("none.inst"), text).message(),
              "cannot open '" + path("none.inst") + "': No such file or directory");
    EXPECT_EQ(read_text(folder_.string(), text).message(),
              "cannot read '" + folder_.string() + "': it is a folder, not a file: name a file in it");
}

TEST_F(FilesOnDisk, ReadingStopsAtTheLimit) {
    ASSERT_TRUE(write_text(path("big"), std::string(1000, 'x')).ok());
    std::string text;
    EXPECT_TRUE(read_text(path("big"), text, 1000).ok());
    EXPECT_EQ(read_text(path("big"), text, 999).message(),
              "'" + path("big") + "' is too long: more than 999 bytes");
    const Status endless = read_text("/dev/zero", text, 1 << 20);
    EXPECT_FALSE(endless.ok()) << "an endless device must not fill the memory";
    EXPECT_LE(text.size(), std::size_t{1} << 20);
}

TEST_F(FilesOnDisk, ReadingAPipeThatNobodyWritesDoesNotHang) {
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    std::string text;
    EXPECT_EQ(read_text(path("pipe"), text).message(),
              "cannot read '" + path("pipe") + "': it is not a regular file");
}

TEST_F(FilesOnDisk, APendingFileAppearsByCommitOnly) {
    std::string temporary;
    {
        PendingFile pending(path("out.png"));
        temporary = pending.temporary_path();
        EXPECT_EQ(fs::path(temporary).parent_path(), folder_) << "renaming needs the same file system";
        EXPECT_EQ(fs::path(temporary).extension(), ".png");
        std::ofstream(temporary) << "half";
        EXPECT_FALSE(fs::exists(path("out.png")));
    }
    EXPECT_EQ(file_count(), 0u) << "without commit nothing stays";

    PendingFile pending(path("out.png"));
    std::ofstream(pending.temporary_path()) << "whole";
    ASSERT_TRUE(pending.commit().ok());
    EXPECT_EQ(contents(path("out.png")), "whole");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(FilesOnDisk, AFailureLeavesTheOldFileWhole) {
    ASSERT_TRUE(write_text(path("out.pov"), "old").ok());
    {
        PendingFile pending(path("out.pov"));
        std::ofstream(pending.temporary_path()) << "half of the ne";
    }
    EXPECT_EQ(contents(path("out.pov")), "old");
    ASSERT_TRUE(write_text(path("out.pov"), "new").ok());
    EXPECT_EQ(contents(path("out.pov")), "new");
}

TEST_F(FilesOnDisk, TwoOutputsOfOneStemDoNotShareATemporary) {
    PendingFile first(path("a.png")), second(path("b.png")), third(path("a.png"));
    EXPECT_NE(first.temporary_path(), second.temporary_path());
    EXPECT_NE(first.temporary_path(), third.temporary_path()) << "two writers of one file";
}

TEST_F(FilesOnDisk, WhereNothingCanBeWrittenSaysSo) {
    EXPECT_EQ(write_text(path("no/such/folder/x"), "text").message(),
              "cannot write '" + path("no/such/folder/x") + "': No such file or directory");
    fs::create_directory(path("taken"));
    EXPECT_THAT(write_text(path("taken"), "text").message(),
                HasSubstr("cannot write '" + path("taken") + "'"));
    EXPECT_EQ(file_count(), 1u) << "no temporary is left after a failed rename";
    PendingFile never_written(path("y"));
    EXPECT_FALSE(never_written.commit().ok());
}

TEST_F(FilesOnDisk, AFullDiskIsAFailure) {
    // SIGXFSZ is ignored by main().
    const auto before = std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit = {};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
    const rlimit small = {1000, limit.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const Status status = write_text(path("full"), std::string(2000, 'x'));
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, before);
    EXPECT_EQ(status.message(), "cannot write '" + path("full") + "': File too large");
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(FilesOnDisk, ALinkStaysAndItsTargetIsReplacedWhole) {
    fs::create_directory(path("far"));
    ASSERT_TRUE(write_text(path("far/real.txt"), "old").ok());
    fs::create_symlink("far/real.txt", path("near.txt"));
    fs::create_symlink("near.txt", path("link"));
    ASSERT_TRUE(write_text(path("link"), "new").ok());
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_TRUE(fs::is_symlink(path("near.txt")));
    EXPECT_EQ(contents(path("far/real.txt")), "new");
    fs::create_symlink("far/none_yet.txt", path("dangling"));
    ASSERT_TRUE(write_text(path("dangling"), "born").ok());
    EXPECT_EQ(contents(path("far/none_yet.txt")), "born");
    fs::create_symlink("ring", path("ring"));
    EXPECT_THAT(write_text(path("ring"), "x").message(), HasSubstr("cannot write '" + path("ring") + "'"));
    EXPECT_TRUE(fs::is_symlink(path("ring")));
}

TEST_F(FilesOnDisk, PipesAndDevicesAreNotReplaced) {
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    fs::create_symlink("/dev/null", path("null.png"));
    for (const std::string name : {"pipe", "null.png"}) {
        const PendingFile pending(path(name));
        EXPECT_THAT(pending.status().message(),
                    HasSubstr("cannot write '" + path(name) + "': it is not a regular file"));
        EXPECT_FALSE(write_text(path(name), "text").ok());
    }
    EXPECT_TRUE(fs::is_fifo(path("pipe")));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(file_count(), 2u);
}

TEST_F(FilesOnDisk, WhatAKilledRunLeftIsSweptByTheNext) {
    for (const std::string name :
         {".a.1.2.pov", ".a.77.1.pov", ".a.1.pov", ".a.1.x.pov", ".b.1.2.pov", ".a.1.2.inc"})
        std::ofstream(path(name)) << "half";
    const PendingFile at_work(path("a.pov"));
    std::ofstream(at_work.temporary_path()) << "more than half";
    ASSERT_TRUE(write_text(path("a.pov"), "whole").ok());
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
        names.push_back(entry.path().filename().string());
    EXPECT_THAT(names,
                ::testing::UnorderedElementsAre("a.pov", ".a.1.pov", ".a.1.x.pov", ".b.1.2.pov", ".a.1.2.inc",
                                                fs::path(at_work.temporary_path()).filename().string()));
}

} // namespace
} // namespace graftal
