// graftal's own memory has a limit: every command ends within it, with a message that says what to do.

#include "tests/golden/command_line.h"

#include <gmock/gmock.h>

namespace graftal {
namespace {

using testing::HasSubstr;

class Memory : public CommandLine {};

/// Each takes over 300 bytes.
const char* const many_spheres = R"(
canonical object dot { instance: sphere scale: 0.01 }
object bed { scatter dot count 1800000 over -60, -60, 60, 60 by jitter turn y }
)";

/// The shell's limit stands in for that of --memory, which is 2 GiB at least.
TEST_F(Memory, WhatDoesNotSufficeIsSaidWithTheStage) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "sanitizers end a program whose memory ends";
#endif
    write("bed.inst", many_spheres);
    for (const std::string command :
         {"check", "stats", "compile -o a.pov", "render --engine native -o a.png"}) {
        const RunResult result = shell("ulimit -d 400000; \"$graftal\" " + command + " bed.inst");
        EXPECT_EQ(result.status, 1) << command << result.err;
        EXPECT_THAT(result.err,
                    HasSubstr("out of memory in the stage lower: graftal may use 2048 MiB itself; "
                              "allow more with --memory"))
            << command;
        EXPECT_EQ(files(), "bed.inst") << command;
    }
}

/// POV-Ray's memory has its own estimate, and its process the limit that graftal was started with.
TEST_F(Memory, OfOtherProgramsIsTheirs) {
    write("ball.inst", "object ball { sphere }\n");
    shell("mkdir bin");
    write("bin/povray", "#!/bin/sh\nulimit -d >limit.txt\nexit 1\n");
    shell("chmod +x bin/povray");
    const RunResult result = shell("PATH=$PWD/bin:$PATH \"$graftal\" render --engine povray --unconfined "
                                   "ball.inst --size 8x8 --keep kept");
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_EQ(shell("cat kept/limit.txt limit.txt").out, shell("ulimit -d").out);
}

} // namespace
} // namespace graftal
