// What POV-Ray, or a program in its place, can reach and use.

#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/povray/povray.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::HasSubstr;
using testing::Not;

class Confined : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(job_directory_.create().ok());
        ASSERT_TRUE(bin_.create().ok());
        ASSERT_TRUE(elsewhere_.create().ok());
        job_.directory = job_directory_.path();
        job_.width = 16;
        job_.height = 12;
        std::ofstream(secret()) << "sphere { 0, 1 }\n";
    }
    std::string secret() const { return elsewhere_.path() + "/secret.inc"; }
    void scene(const std::string& text) const {
        std::ofstream(job_.directory + "/scene.pov")
            << "#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location <0,0,-5> look_at 0 }\n"
            << text;
    }
    /// What a script in POV-Ray's place says.
    std::string said(const std::string& script) {
        job_.program = bin_.path() + "/povray";
        std::ofstream(job_.program) << "#!/bin/sh\n" << script << "\nexit 1\n";
        std::filesystem::permissions(job_.program, std::filesystem::perms::owner_all);
        return run_povray(job_).status.message();
    }

    TemporaryDirectory job_directory_, bin_, elsewhere_;
    PovrayJob job_;
};

TEST_F(Confined, ASceneReadsOnlyWhatIsItsOwn) {
    if (!can_confine_files()) GTEST_SKIP() << "this kernel has no Landlock";
    scene("#include \"" + secret() + "\"\n");
    const PovrayResult result = run_povray(job_);
    EXPECT_FALSE(result.status.ok());
    EXPECT_THAT(result.status.message(), HasSubstr("secret.inc"));
    job_.unconfined = true;
    EXPECT_TRUE(run_povray(job_).status.ok());
}

TEST_F(Confined, ItsOwnFilesAreRead) {
    scene("#include \"part.inc\"\n");
    std::ofstream(job_.directory + "/part.inc") << "sphere { 0, 1 }\n";
    const PovrayResult result = run_povray(job_);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
}

TEST_F(Confined, NothingElseIsReadOrWritten) {
    if (!can_confine_files()) GTEST_SKIP() << "this kernel has no Landlock";
    for (const std::string& script :
         {"cat " + secret(), "echo x >" + elsewhere_.path() + "/new", "rm " + secret(),
          "ls " + elsewhere_.path(), std::string("cat /proc/$PPID/environ"), std::string("cat /etc/passwd"),
          "(cat " + secret() + ") & wait $!"})
        EXPECT_THAT(said("(" + script + ") >&2 && echo open >&2"), HasSubstr("ermission denied")) << script;
    EXPECT_TRUE(std::filesystem::exists(secret()));
    EXPECT_THAT(said("echo mine >own && cat own >&2"), HasSubstr("mine"));
}

TEST_F(Confined, ItsEnvironmentIsClean) {
    ::setenv("GRAFTAL_TEST_SECRET", "do_not_tell", 1);
    EXPECT_THAT(said("env | cut -d= -f1 | sort | tr '\\n' ' ' >&2; echo \"home $HOME\" >&2"),
                testing::AllOf(HasSubstr("HOME "), HasSubstr("PATH "), HasSubstr("POVINI "),
                               Not(HasSubstr("GRAFTAL_TEST_SECRET")), HasSubstr("home " + job_.directory)));
    job_.unconfined = true;
    EXPECT_THAT(said("echo $GRAFTAL_TEST_SECRET >&2"), HasSubstr("do_not_tell"));
    ::unsetenv("GRAFTAL_TEST_SECRET");
}

TEST_F(Confined, ItHasLimits) {
    job_.memory_bytes = 64 << 20;
    job_.cpu_seconds = 7;
    const std::string limits = said("ulimit -c >&2; ulimit -d >&2; ulimit -t >&2; ulimit -f >&2");
    EXPECT_THAT(limits, HasSubstr("0\n    65536\n    7\n    1310"));
    EXPECT_THAT(said("kill -XCPU $$"), HasSubstr("it took more than 7 seconds of processor time"));
    EXPECT_THAT(said("head -c 100000000 /dev/zero >big; kill -XFSZ $$"),
                HasSubstr("a file larger than any picture"));
    EXPECT_LE(std::filesystem::file_size(job_.directory + "/big"), 80'000'000u);
}

TEST_F(Confined, ASceneThatFillsMemoryEnds) {
    job_.memory_bytes = 256 << 20;
    scene("#declare A = array[1000]\n#for (I, 0, 999) #declare A[I] = array[100000] #for (J, 0, 99999) "
          "#declare A[I][J] = "
          "<I,J,0>; #end #end\n");
    const PovrayResult result = run_povray(job_);
    EXPECT_FALSE(result.status.ok());
    EXPECT_LT(result.process.peak_bytes, 400u << 20);
}

} // namespace
} // namespace graftal
