#include "runtime/system/process.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "runtime/system/interruption.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

struct Outcome {
    ProcessResult result;
    std::string text;
};

Outcome shell(const std::string& script, double grace_seconds = 10, const CancelFlag& cancel = {}) {
    Outcome outcome;
    ProcessOptions options;
    options.arguments = {"sh", "-c", script};
    options.grace_seconds = grace_seconds;
    options.cancel = cancel;
    options.environment = {{"GRAFTAL_TEST", "a b'c"}};
    options.on_error_text = [&](std::string_view text) { outcome.text += text; };
    outcome.result = run_process(options);
    return outcome;
}

/// Sends a signal to ourselves once the child says that it is ready.
Outcome interrupt_shell(const std::string& script, int number, double grace_seconds,
                        const CancelFlag& cancel) {
    Outcome outcome;
    ProcessOptions options;
    options.cancel = cancel;
    options.arguments = {"sh", "-c", script};
    options.grace_seconds = grace_seconds;
    options.on_error_text = [&](std::string_view text) {
        if (outcome.text.empty()) ::kill(::getpid(), number);
        outcome.text += text;
    };
    outcome.result = run_process(options);
    return outcome;
}

/// Not even as what nobody has waited for.
bool runs(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state;
    return (file >> number >> name >> state) && state != "Z" && state != "X";
}

TEST(Process, StandardOutputComesWithTheErrorsWhereItIsWanted) {
    ProcessOptions options;
    std::string text;
    options.arguments = {"sh", "-c", "echo out; echo err >&2"};
    options.on_error_text = [&](std::string_view piece) { text += piece; };
    EXPECT_TRUE(run_process(options).succeeded());
    EXPECT_EQ(text, "err\n");
    text.clear();
    options.output_with_errors = true;
    EXPECT_TRUE(run_process(options).succeeded());
    EXPECT_EQ(text, "out\nerr\n");
}

TEST(Process, ReportsTheExitStatusAndStandardError) {
    const Outcome outcome = shell("printf 'one\\rtwo\\n' >&2; echo lost; exit 7");
    EXPECT_TRUE(outcome.result.status.ok());
    EXPECT_EQ(outcome.result.exit_code, 7);
    EXPECT_EQ(outcome.result.signal, 0);
    EXPECT_FALSE(outcome.result.succeeded());
    EXPECT_EQ(outcome.text, "one\rtwo\n");
}

TEST(Process, ReportsTheSignalThatEndedIt) {
    const ProcessResult result = shell("kill -SEGV $$").result;
    EXPECT_EQ(result.signal, SIGSEGV);
    EXPECT_EQ(result.exit_code, -1);
    EXPECT_FALSE(result.succeeded());
}

TEST(Process, EnvironmentReachesTheChildUnchanged) {
    EXPECT_EQ(shell("printf %s \"$GRAFTAL_TEST\" >&2").text, "a b'c");
}

TEST(Process, StandardInputIsEmpty) {
    EXPECT_EQ(shell("cat >&2; echo end >&2").text, "end\n");
}

TEST(Process, WhatTheChildStartedGoesWithIt) {
    // It holds standard error, and was waited for.
    const Outcome outcome = shell("sleep 1000 & echo $! >&2; exit 5");
    EXPECT_EQ(outcome.result.exit_code, 5);
    const pid_t grandchild = std::stoi(outcome.text);
    for (int i = 0; i < 400 && runs(grandchild); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(runs(grandchild));
    EXPECT_LT(outcome.result.wall_seconds, 500);
}

TEST(Process, WhatWasSaidLastIsRead) {
    EXPECT_EQ(shell("sleep 1000 & head -c 60000 /dev/zero | tr '\\0' x >&2").text, std::string(60000, 'x'));
}

TEST(Process, RunsInItsDirectory) {
    TemporaryDirectory directory;
    ASSERT_TRUE(directory.create().ok());
    std::string text;
    ProcessOptions options;
    options.arguments = {"sh", "-c", "pwd -P >&2"};
    options.directory = directory.path();
    options.on_error_text = [&](std::string_view piece) { text += piece; };
    EXPECT_TRUE(run_process(options).succeeded());
    EXPECT_EQ(text, std::filesystem::canonical(directory.path()).string() + "\n");
    options.directory = directory.path() + "/none";
    EXPECT_FALSE(run_process(options).status.ok());
}

TEST(Process, MissingProgramIsAFailureOfTheEnvironment) {
    ProcessOptions options;
    options.arguments = {"graftal-no-such-program"};
    EXPECT_THAT(run_process(options).status.message(), testing::HasSubstr("graftal-no-such-program"));
    EXPECT_FALSE(find_program("graftal-no-such-program"));
    EXPECT_FALSE(find_program("/"));
    EXPECT_TRUE(find_program("sh"));
}

TEST(Process, MegabytesOfTextDoNotBlock) {
    const Outcome outcome = shell("head -c 3000000 /dev/zero >&2");
    EXPECT_TRUE(outcome.result.succeeded());
    EXPECT_EQ(outcome.text.size(), 3'000'000u);
}

TEST(Process, ClosedStandardErrorIsNotTheEnd) {
    const ProcessResult result = shell("exec 2>&-; sleep 0.1; exit 5").result;
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_GE(result.wall_seconds, 0.1);
}

TEST(Process, MeasuresMemory) {
    const ProcessResult result =
        shell("head -c 50000000 /dev/zero | tail -c 49000000 >/dev/null; exit 0").result;
    EXPECT_GT(result.peak_bytes, 1'000'000u);
}

// What the kernel says of a child includes what it was before: a copy of us.
TEST(Process, MeasuresTheMemoryOfAChildSmallerThanUs) {
    const std::vector<char> ballast(100'000'000, 1);
    const ProcessResult result = shell("sleep 0.3; exit 0").result;
    EXPECT_GT(result.peak_bytes, 100'000u);
    EXPECT_LT(result.peak_bytes, ballast.size() / 2 * static_cast<std::size_t>(ballast.back()));
}

TEST(Process, InterruptionIsPassedOnAndWaitedFor) {
    const Interruption interruption;
    const Outcome outcome =
        interrupt_shell("trap 'echo cleaned >&2; exit 2' TERM; echo ready >&2; while :; do sleep 0.05; done",
                        SIGINT, 10, interruption.flag());
    EXPECT_TRUE(outcome.result.cancelled);
    EXPECT_EQ(outcome.result.exit_code, 2);
    EXPECT_THAT(outcome.text, testing::HasSubstr("cleaned"));
    EXPECT_EQ(interruption.signal(), SIGINT);
}

TEST(Process, AFlagWithoutADescriptorEndsTheChildToo) {
    bool raised = false;
    ProcessOptions options;
    options.arguments = {"sh", "-c", "echo ready >&2; sleep 30"};
    options.grace_seconds = 0.2;
    options.cancel = CancelFlag([&] { return raised; });
    options.on_error_text = [&](std::string_view) { raised = true; };
    const ProcessResult result = run_process(options);
    EXPECT_TRUE(result.cancelled);
    EXPECT_EQ(result.signal, SIGTERM);
}

TEST(Process, ChildThatIgnoresTheInterruptionIsKilled) {
    const Interruption interruption;
    const Outcome outcome = interrupt_shell("trap '' TERM INT; echo ready >&2; while :; do sleep 0.05; done",
                                            SIGTERM, 0.2, interruption.flag());
    EXPECT_TRUE(outcome.result.cancelled);
    EXPECT_EQ(outcome.result.signal, SIGKILL);
    EXPECT_LT(outcome.result.wall_seconds, 5);
}

TEST(Process, InterruptionBeforeTheStartEndsTheChildToo) {
    const Interruption interruption;
    ::raise(SIGHUP);
    const ProcessResult result = shell("sleep 30", 0.5, interruption.flag()).result;
    EXPECT_TRUE(result.cancelled);
    EXPECT_LT(result.wall_seconds, 5);
}

TEST(Interruptions, ANewOneForgetsTheLast) {
    {
        const Interruption first;
        EXPECT_FALSE(first.flag().raised());
        ::raise(SIGINT);
        EXPECT_EQ(first.signal(), SIGINT);
        EXPECT_TRUE(first.flag().raised());
    }
    const Interruption second;
    EXPECT_EQ(second.signal(), 0);
    EXPECT_FALSE(second.flag().raised());
    {
        const Interruption nested;
        ::raise(SIGTERM);
    }
    EXPECT_EQ(second.signal(), SIGTERM);
}

TEST(TemporaryDirectories, HonourTmpdirAndDisappear) {
    TemporaryDirectory around; // locked itself
    ASSERT_TRUE(around.create().ok());
    const std::string outer = around.path() + "/tmp";
    std::filesystem::create_directory(outer);
    const char* old = std::getenv("TMPDIR");
    const std::string saved = old ? old : "";
    ::setenv("TMPDIR", outer.c_str(), 1);
    std::string inner_path;
    {
        TemporaryDirectory inner;
        ASSERT_TRUE(inner.create().ok());
        inner_path = inner.path();
        EXPECT_EQ(inner_path.find(outer), 0u);
        std::filesystem::create_directories(inner_path + "/a/b");
    }
    EXPECT_FALSE(std::filesystem::exists(inner_path));
    std::filesystem::create_directories(outer + "/graftal-AAAAAA/graftal-scratch/left");
    std::filesystem::create_directories(outer + "/graftal-of-mine");
    std::filesystem::create_directories(outer + "/graftal-thesis/chapters"); // six letters, too
    {
        TemporaryDirectory at_work, next;
        ASSERT_TRUE(at_work.create().ok());
        ASSERT_TRUE(next.create().ok());
        EXPECT_TRUE(std::filesystem::exists(at_work.path()));
        EXPECT_FALSE(std::filesystem::exists(outer + "/graftal-AAAAAA")) << "left by a killed run";
        EXPECT_TRUE(std::filesystem::exists(outer + "/graftal-of-mine"));
        EXPECT_TRUE(std::filesystem::exists(outer + "/graftal-thesis/chapters")) << "somebody else's";
        std::FILE* file = open_temporary_file();
        ASSERT_TRUE(file);
        EXPECT_EQ(std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(::fileno(file)))
                      .string()
                      .find(outer),
                  0u);
        std::fclose(file);
    }
    ::setenv("TMPDIR", (outer + "/none").c_str(), 1);
    EXPECT_FALSE(open_temporary_file());
    TemporaryDirectory impossible;
    EXPECT_FALSE(impossible.create().ok());
    if (old)
        ::setenv("TMPDIR", saved.c_str(), 1);
    else
        ::unsetenv("TMPDIR");
}

} // namespace
} // namespace graftal
