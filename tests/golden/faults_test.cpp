// Calls to the system that fail, by tests/bench/fault_shim.cpp. tools/bench/faults lets each call fail in
// turn; here stands what it has found once.

#include <algorithm>
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/image_files/image_files.h"
#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::AnyOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;

class Faults : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
#ifndef GRAFTAL_FAULT_SHIM
        GTEST_SKIP() << "sanitizers have their own malloc()";
#endif
        write("m.rifs", "rifs m {\n map a { scale 1/2 }\n map b { scale 1/2 translate <1,0,0> }\n"
                        " map c { scale 1/2 translate <0,1,0> }\n}\n");
    }

    /// `fault` as the library takes it, such as "open:3:stay".
    RunResult with(const std::string& fault, const std::string& arguments) const {
#ifdef GRAFTAL_FAULT_SHIM
        const std::string shim = GRAFTAL_FAULT_SHIM;
#else
        const std::string shim;
#endif
        return shell("head -c 4096 /dev/zero >../record\ntimeout 60 env LD_PRELOAD='" + shim +
                     "' FAULTS_RECORD=../record FAULTS=" + fault + " \"$graftal\" " + arguments);
    }

    /// A POV-Ray that fails at once.
    void make_failing_povray() const {
        shell("mkdir bin");
        write("bin/povray", "#!/bin/sh\nexit 1\n");
        shell("chmod +x bin/povray");
    }
};

const std::string m_of_few_pixels = " m.rifs -q --size 16x12 ";

TEST_F(Faults, NoMemoryIsSaidWithoutTakingAny) {
    for (const std::string& command : {std::string("check m.rifs"), "compile" + m_of_few_pixels + "-o a.pov",
                                       "points" + m_of_few_pixels + "-o a.png"})
        for (const int number : {1, 10, 100, 1000, 3000, 5000}) {
            const RunResult result = with("alloc:" + std::to_string(number) + ":stay", command);
            EXPECT_THAT(result.status, AnyOf(Eq(1), Eq(3))) << command << number << result.err;
            EXPECT_THAT(result.err, HasSubstr("graftal: ")) << command << number;
            EXPECT_EQ(files(), "m.rifs") << command << number;
        }
}

/// Colours are mixed on a thread of their own: what stopped it was lost, and the model was black.
TEST_F(Faults, AnotherSceneForWantOfMemoryIsNotSilent) {
    const std::string command = "compile -q --size 48x28 -o - m.rifs";
    const std::string good = graftal(command).out;
    constexpr int first = 4000, step = 12, run_to_end = 40; // the fault had 13 calls
    int others = 0, equal = 0;
    for (int number = first; equal < run_to_end; number += step) {
        const RunResult result = with("alloc:" + std::to_string(number), command);
        const bool same = result.status == 0 && result.out == good;
        equal = same ? equal + 1 : 0;
        others += !same;
        EXPECT_TRUE(same || !result.err.empty()) << number;
    }
    EXPECT_GT(others, 10) << "the faults are behind all calls";
}

TEST_F(Faults, NoThreadsAreFewerThreads) {
    for (const std::string fault : {"thread:1", "thread:1:stay", "thread:3:stay"}) {
        const RunResult result =
            with(fault, "render --engine native --threads 4 m.rifs -q --size 16x12 -o a.png");
        EXPECT_THAT(result.status, AnyOf(Eq(0), Eq(3))) << fault << result.err;
        EXPECT_EQ(result.status == 3, !result.err.empty()) << fault;
    }
}

TEST_F(Faults, APaletteThatCannotBeRenamedTakesTheOthersBack) {
    const auto paint = [&](float level) {
        for (const char* name : {"a.png", "b.png"})
            ASSERT_TRUE(
                write_image(path(name), Image{1, 1, 3, {level, level, level}}, SampleFormat::srgb8).ok());
    };
    write("t.inst", "material a { texture: \"a.png\" }\nmaterial b { texture: \"b.png\" }\n"
                    "object m {\n cube material: a\n sphere material: b\n}\n");
    const std::string compile = "compile t.inst -q --size 16x12 -o t.pov";
    paint(0.5f);
    const std::string before = files();
    // Twice for each file: what is there would be kept, then plainly.
    for (const char* fault :
         {"rename:2", "rename:4", "rename:6", "rename:1:stay", "rename:3:stay", "rename:5:stay"}) {
        const RunResult result = with(fault, compile);
        EXPECT_EQ(result.status, 3) << fault;
        EXPECT_THAT(result.err, HasSubstr("graftal: cannot write 't")) << fault;
        EXPECT_EQ(files(), before) << fault << ": neither palettes nor a scene";
    }
    // A folder in the scene's place: the palettes that were there stay as they are.
    ASSERT_EQ(graftal(compile).status, 0);
    ASSERT_EQ(shell("rm t.pov; mkdir t.pov").status, 0);
    const std::string sums = shell("md5sum t_I_*").out;
    ASSERT_THAT(sums, HasSubstr("t_I_2.png"));
    paint(0.25f);
    EXPECT_EQ(graftal(compile).status, 2) << "usage: a folder is no file";
    EXPECT_EQ(shell("md5sum t_I_*").out, sums);
    EXPECT_EQ(shell("ls -A | grep '^[.]'").out, "");
}

TEST_F(Faults, ACardThatCannotBeWrittenTakesThePictureBack) {
    for (const char* fault : {"rename:4", "rename:3:stay", "write:1", "write:2"}) {
        const RunResult result = with(fault, "points m.rifs -q --size 16x12 --points 100 --card a.inst");
        EXPECT_EQ(result.status, 3) << fault;
        EXPECT_THAT(result.err, HasSubstr("graftal: cannot write ")) << fault;
        EXPECT_EQ(files(), "m.rifs") << fault;
    }
}

TEST_F(Faults, FramesGoWithoutALookAtThem) {
    const std::string animate =
        "animate --engine native --antialias off --frames 2 m.rifs -q --size 16x12 -o a.png";
    ASSERT_EQ(graftal(animate).status, 0);
    for (int number = 18; number <= 26; ++number) {
        const RunResult result = with("open:" + std::to_string(number), animate);
        if (result.status == 0)
            EXPECT_EQ(files(), "a.png m.rifs") << number;
        else
            EXPECT_THAT(result.err, HasSubstr("graftal: ")) << number;
        shell("rm -rf a.*");
    }
}

TEST_F(Faults, FramesThatCannotBeReadAgainGoToo) {
    const std::string animate =
        "animate --engine native --antialias off --frames 2 m.rifs -q --size 16x12 -o a.png";
    for (int number = 15; number <= 40; ++number)
        if (with("read:" + std::to_string(number) + ":stay", animate).status == 0) {
            EXPECT_EQ(files(), "a.png m.rifs") << number;
            shell("rm -rf a.*");
        }
}

// A library that cannot have a thread may wait for another one for ever while it is loaded: here for a FIFO.
TEST_F(Faults, ALibraryThatDoesNotLoadIsGivenUp) {
    shell("mkdir lib; for i in $(ldconfig -p | grep -o 'libIex-[^ ]*' | sort -u); do mkfifo lib/$i; done");
    ASSERT_NE(shell("ls lib").out, "");
    ASSERT_TRUE(write_image(path("a.exr"), Image{1, 1, 3, {0, 0, 0}}, SampleFormat::srgb8).ok());
    const RunResult result = shell("LD_LIBRARY_PATH=lib timeout 60 \"$graftal\" compare a.exr a.exr");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("graftal: a library does not load"));
    shell("rm -r lib a.exr");
    EXPECT_EQ(files(), "m.rifs");
}

/// Memory that does not suffice makes frames coarser, and a warning.
TEST_F(Faults, CoarserFramesAreSaid) {
    const std::string animate =
        "animate --engine native --threads 1 --antialias off --frames 2 m.rifs -q --size 16x12 -o a.png";
    ASSERT_EQ(graftal(animate).status, 0);
    const std::string good = shell("md5sum a.png").out;
    int coarser = 0;
    // Allocations of the cut come after those of the start, whose number nobody knows.
    for (int number = 20000; number <= 60000 && coarser < 3; number += 200) {
        const RunResult result = with("alloc:" + std::to_string(number), animate);
        EXPECT_THAT(result.status, AnyOf(Eq(0), Eq(1), Eq(3))) << number;
        if (result.status != 0 || shell("md5sum a.png").out == good) continue;
        EXPECT_THAT(result.err, HasSubstr("of memory allow an error of")) << number;
        ++coarser;
    }
    EXPECT_GT(coarser, 0) << "some of these allocations are the cut's";
}

TEST_F(Faults, ATemporaryThatCannotBeLookedAtIsNotLeft) {
    for (int number = 1; number <= 20; ++number) {
        const RunResult result =
            with("stat:" + std::to_string(number) + ":stay", "compile" + m_of_few_pixels + "-o a.pov");
        EXPECT_THAT(result.status, AnyOf(Eq(0), Eq(1), Eq(3))) << number;
        EXPECT_EQ(result.status == 0, result.err.empty()) << number << result.err;
        EXPECT_EQ(shell("rm -f a.pov; ls -A").out, "m.rifs\n") << number;
    }
}

TEST_F(Faults, ScratchGoesWhereNothingCanBeOpened) {
    make_failing_povray();
    for (const std::string kind : {"open", "seek", "alloc"})
        for (int number = 1; number <= 61; number += kind == "alloc" ? 15 : 4) {
            const int at = kind == "alloc" ? 6000 + 60 * number : number;
            shell("rm -f a.png");
            const RunResult result =
                with(kind + ":" + std::to_string(at) + ":stay", "render" + m_of_few_pixels + "-o a.png");
            EXPECT_THAT(result.status, AnyOf(Eq(0), Eq(1), Eq(3))) << kind << at << result.err;
            EXPECT_EQ(temporary_files(), "") << kind << at << result.err;
        }
}

TEST_F(Faults, ATemporaryFileThatCannotBeReadAgainIsSaid) {
    const RunResult result = with("seek:1:stay", "compile" + m_of_few_pixels + "-o -");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("graftal: cannot write 'a temporary file': Input/output error"));
}

TEST_F(Faults, APictureThatCannotBeOpenedIsNotTakenForAnother) {
    ASSERT_TRUE(write_image(path("a.png"), Image{1, 1, 3, {0, 0, 0}}, SampleFormat::srgb8).ok());
    const RunResult result = with("open:1:stay", "compare a.png a.png");
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(result.err, "graftal: cannot read picture 'a.png': Too many open files\n");
}

/// A library behind OpenImageIO aborts where it cannot open a file of the system's.
TEST_F(Faults, LibrariesThatGiveUpAreSaid) {
    ASSERT_TRUE(write_image(path("a.exr"), Image{1, 1, 3, {0, 0, 0}}, SampleFormat::srgb8).ok());
    const RunResult result = with("open:2:stay", "compare a.exr a.exr");
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr("graftal: "));
    EXPECT_THAT(result.err, Not(HasSubstr("internal error")));
}

/// As libraries do; GLib with a trap, in the middle of loading others.
TEST_F(Faults, SignalsOfLibrariesThatGiveUpAreSaid) {
    for (const std::string signal : {"ABRT", "TRAP", "SEGV", "BUS"}) {
        const RunResult result =
            shell("mkfifo pipe; \"$graftal\" check - <>pipe & child=$!; "
                  // SIGABRT is bit 5 of the signals that the program catches.
                  "for i in $(seq 3000); do grep -q 'SigCgt.*[2367abef].$' /proc/$child/status && break; "
                  "sleep 0.01; done; kill -" +
                  signal + " $child; wait $child; status=$?; rm pipe; exit $status");
        EXPECT_EQ(result.status, 3) << signal;
        EXPECT_THAT(result.err, HasSubstr("graftal: internal error: graftal or one of its libraries"))
            << signal;
    }
}

} // namespace
} // namespace graftal
