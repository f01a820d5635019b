// The folder of a job comes from a stranger: every command ends soon, says what is wrong, and writes nothing
// outside of the folder.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using testing::AnyOf;
using testing::Eq;
using testing::HasSubstr;
using testing::StartsWith;

class HostileFarm : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        const RunResult planned =
            shell("\"$graftal\" farm plan " + gasket +
                  "--size 40x20 --plain-light --tiles 20x20 -o good -q && \"$graftal\" "
                  "farm submit good --local 1 -q && mkdir outside && echo mine >outside/mine");
        ASSERT_EQ(planned.status, 0) << planned.err;
    }

    /// Makes the folder `job`: a copy of a good one, in which `spoil` then runs.
    void spoil(const std::string& spoil) const {
        const RunResult made = shell("rm -rf job && cp -r good job && cd job && " + spoil);
        ASSERT_EQ(made.status, 0) << spoil << made.err;
    }

    RunResult farm(const std::string& words) const { return shell("timeout 20 \"$graftal\" farm " + words); }

    void expect_nothing_outside(const std::string& what) const {
        EXPECT_EQ(shell("cd outside && ls -A && cat mine").out, "mine\nmine\n") << what;
        EXPECT_EQ(files(), "good job outside") << what;
    }
};

/// A text of a manifest in place of another.
std::string with(const std::string& from, const std::string& to) {
    return "sed -i 's|" + from + "|" + to + "|' job.json && ! cmp -s job.json ../good/job.json";
}

TEST_F(HostileFarm, ManifestsAreRefused) {
    const auto deep = [](int levels) {
        return fmt::format("python3 -c 'print(\"[\" * {0} + \"]\" * {0})'", levels);
    };
    const std::string cases[] = {
        "rm job.json && mkfifo job.json",
        "rm job.json && ln -s /dev/zero job.json",
        "rm job.json && ln -s ../good/job.json job.json",
        "rm job.json && mkdir job.json",
        "truncate -s 1T job.json",
        "truncate -s 0 job.json",
        deep(100'000) + " >job.json",
        with("\"tasks\": 2", "\"tasks\": '\"$(" + deep(30'000) + ")\"'"),
        with("\"tasks\": 2", "\"tasks\": NaN"),
        with("\"tasks\": 2", "\"tasks\": 1e300"),
        with("\"tasks\": 2", "\"tasks\": -2"),
        with("\"tasks\": 2", "\"tasks\": 1000000000000"),
        with("\"tasks\": 2", "\"tasks\": \"2\""),
        with("\"most_visits\": .*", "\"most_visits\": {},"),
        with("\"block\": .*", "\"block\": 1e30,"),
        with("\"render\"", "\"farm\""),
        with("\"render\"", "[[]]"),
        with("\"result\": .*", "\"result\": \"../outside/a.png\","),
        with("\"result\": .*", "\"result\": \"/tmp/outside.png\","),
        with("\"result\": .*", "\"result\": \"model/../../outside/a.png\","),
        with("\"result\": .*", "\"result\": \"a\\\\nb.png\","),
        with("\"result\": .*", "\"result\": \"parts\","),
        with("\"result\": .*", "\"result\": [1],"),
    };
    for (const std::string& change : cases) {
        spoil(change);
        for (const std::string command : {"status", "merge", "clean", "submit", "task"}) {
            const RunResult result = farm(command + " job" +
                                          (command == "submit"  ? " --local 1"
                                           : command == "clean" ? " --all"
                                           : command == "task"  ? " 1"
                                                                : ""));
            EXPECT_EQ(result.status, 3) << command << ": " << change.substr(0, 200);
            EXPECT_THAT(result.err, StartsWith("graftal: ")) << command << ": " << change.substr(0, 200);
        }
        expect_nothing_outside(change.substr(0, 200));
    }
}

TEST_F(HostileFarm, PartsAndRecordsDoNotCount) {
    const std::string cases[] = {
        "mv parts away && ln -s away parts",
        "rm parts/tile_000001.png && ln -s /dev/zero parts/tile_000001.png",
        "rm parts/tile_000001.png && ln -s ../../good/parts/tile_000001.png parts/tile_000001.png",
        "rm parts/tile_000001.png && mkfifo parts/tile_000001.png",
        "truncate -s 1T parts/tile_000001.png",
        "truncate -s 1T parts/tile_000001.png && sed -i 's|\"bytes\": .*|\"bytes\": 1099511627776,|' "
        "tasks/000001.json",
        "truncate -s 2G parts/tile_000001.png && sed -i 's|\"bytes\": .*|\"bytes\": 2147483648,|; "
        "s|\"digest\": .*|\"digest\": \"\",|' tasks/000001.json",
        "rm tasks/000001.json && mkfifo tasks/000001.json",
        "rm tasks/000001.json && ln -s /dev/zero tasks/000001.json",
        "truncate -s 1T tasks/000001.json",
        "python3 -c 'print(\"{\\\"stats\\\":\" + \"[\" * 100000 + \"]\" * 100000 + \"}\")' "
        ">tasks/000001.json",
        "sed -i 's|\"seconds\": .*|\"seconds\": \"long\",|' tasks/000001.json",
        "sed -i 's|\"seconds\": .*|\"seconds\": NaN,|' tasks/000001.json",
        "mv tasks away && ln -s away tasks",
    };
    for (const std::string& change : cases) {
        spoil(change);
        const RunResult merged = farm("merge job");
        EXPECT_EQ(merged.status, 3) << change;
        EXPECT_THAT(merged.err, HasSubstr("tasks are missing")) << change;
        EXPECT_THAT(farm("status job").status, AnyOf(Eq(0), Eq(1))) << change;
        EXPECT_EQ(farm("clean job --all").status, 0) << change;
        EXPECT_THAT(shell("ls job 2>/dev/null").out, AnyOf(Eq(""), Eq("away\n"))) << change;
        shell("mkdir -p job");
        expect_nothing_outside(change);
    }
}

TEST_F(HostileFarm, NothingIsWrittenThroughALink) {
    const struct {
        std::string change, command;
        int status;
    } cases[] = {
        {"ln -s ../outside/mine sierpinski.png", "merge job", 3},
        {"ln -s ../outside/new sierpinski.png", "merge job", 3},
        {"rm -r parts && ln -s ../outside parts", "submit job --local 1", 1},
        {"rm -r tasks && ln -s ../outside tasks", "submit job --local 1", 1},
        {"rm tasks/000001.json && ln -s ../../outside/new tasks/000001.json", "submit job --local 1", 1},
        {"rm tasks/000001.* && ln -s ../../outside/mine tasks/000001.log", "submit job --local 1", 0},
        {"rm tasks/000001.* && ln -s ../../outside/mine tasks/000001.starts", "submit job --local 1", 0},
        {"rm tasks/*.json parts/* && ln -s ../../outside/new parts/tile_000001.png", "submit job --local 1",
         1},
        {"rm tasks/*.json && rm model/* && ln -s ../../outside/mine model/sierpinski.inst",
         "submit job --local 1", 1},
        {"rm tasks/*.json && rm model/* && ln -s /dev/zero model/sierpinski.inst", "submit job --local 1", 1},
        {"rm tasks/*.json && rm model/* && mkfifo model/sierpinski.inst", "submit job --local 1", 1},
        {"rm tasks/*.json && " + with("\"name\": \"sierpinski.inst\"", "\"name\": \"../../outside/mine\""),
         "submit job --local 1", 1},
        {"rm tasks/*.json && " + with("\"name\": \"sierpinski.inst\"", "\"name\": \"/dev/zero\""),
         "submit job --local 1", 1},
        {"rm tasks/*.json && " + with("\"--size\",", "\"--keep\", \"../outside/kept\", \"--size\","),
         "submit job --local 1", 1},
        {with("\"--size\",", "\"--keep\", \"../outside/kept\", \"--size\","), "merge job", 3},
        {with("\"--size\",", "\"--unconfined\", \"--size\","), "merge job", 3},
        {with("\"--size\",", "\"--siez\","), "merge job", 3},
    };
    for (const auto& [change, command, status] : cases) {
        spoil(change);
        const RunResult result = farm(command);
        EXPECT_EQ(result.status, status) << change << "\n" << result.err;
        EXPECT_NE(result.err, "") << change;
        expect_nothing_outside(change);
    }
}

TEST_F(HostileFarm, SlurmIsAskedNothingForAHostileFolder) {
    shell("mkdir good/bin");
    write("good/bin/sbatch", "#!/bin/sh\necho 41\n");
    write("good/bin/squeue", "#!/bin/sh\necho \"$@\" >>../asked\n");
    write("good/bin/scontrol", "#!/bin/sh\n");
    shell("chmod +x good/bin/*");
    for (const std::string change :
         {"ln -s ../outside slurm", "mkdir slurm && ln -s ../../outside/mine slurm/groups_1.txt",
          "mkdir slurm && ln -s ../../outside/new slurm/array_1.sh",
          "mkdir slurm && ln -s ../../outside/new slurm/arrays.json"}) {
        spoil("rm tasks/*.json && " + change);
        const RunResult result =
            shell("PATH=\"$PWD/job/bin:$PATH\" timeout 20 \"$graftal\" farm submit job --slurm");
        EXPECT_EQ(result.status, 3) << change << result.err;
        expect_nothing_outside(change);
    }
    // Lists of arrays that say one task a million times, or another program's options.
    for (const std::string& arrays :
         {std::string("python3 -c 'print([{\"id\": \"1\", \"merge\": \"\", \"groups\": [\"1-100000\"] * "
                      "1000000}])' | tr \"'\" '\"'"),
          std::string("echo '[{\"id\": \"-o/tmp/x\", \"merge\": \"\", \"groups\": []}]'")}) {
        spoil("rm tasks/*.json && mkdir slurm && " + arrays + " >slurm/arrays.json");
        const RunResult result =
            shell("PATH=\"$PWD/job/bin:$PATH\" timeout 20 \"$graftal\" farm submit job --slurm");
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_FALSE(exists("asked"));
        expect_nothing_outside(arrays);
    }
}

/// The user says where the result goes, and a copy of the folder does not.
TEST_F(HostileFarm, OnlyTheFolderOfThePlanWritesItsResultElsewhere) {
    const std::string look = gasket + "--size 20x20 --plain-light --tiles 20x20 ";
    ASSERT_EQ(graftal("farm plan " + look + "-o job --result there.png -q").status, 0);
    ASSERT_EQ(graftal("farm submit job --local 1 -q").status, 0);
    shell("cp -a job copy");
    const RunResult refused = farm("merge copy");
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr("there.png' lies outside of"));
    EXPECT_FALSE(exists("there.png"));
    EXPECT_EQ(farm("merge job -q").status, 0);
    EXPECT_TRUE(exists("there.png"));
}

TEST_F(HostileFarm, FramesOfAnotherModelAreNotDrawnByTheMerge) {
    shell("rm -rf good");
    ASSERT_EQ(graftal("farm plan " + gasket + "--size 20x20 --plain-light --frames 3 -o good -q").status, 0);
    ASSERT_EQ(graftal("farm submit good --local 1 -q").status, 0);
    spoil(with("\"sources\": .*", "\"sources\": \"0\","));
    const RunResult merged = farm("merge job");
    EXPECT_EQ(merged.status, 3);
    EXPECT_THAT(merged.err, HasSubstr("not of the job's model"));
    for (const std::string& change : {with("\"turning\": .*", "\"turning\": [],"),
                                      with("\"size\": .", "\"size\": [1e30, -1], \"was\": ["),
                                      with("\"outline\": .*", "\"outline\": [[")}) {
        spoil(change);
        EXPECT_EQ(farm("merge job").status, 3) << change;
    }
    expect_nothing_outside("frames");
}

TEST_F(HostileFarm, NamesThatNoManifestHoldsAreRefusedAtOnce) {
    const std::string model = "'" + source_path("scenes/hart/sierpinski.inst") + "'";
    const std::string no_text = "\"$(printf 'a\\377.inst')\"", two_lines = "\"$(printf 'a\\nb.inst')\"";
    shell("cp " + model + " " + no_text + "; cp " + model + " " + two_lines);
    for (const std::string& words : {no_text + " --tiles 9x9 -o new", two_lines + " --tiles 9x9 -o new",
                                     model + " --tiles 9x9 -o " + two_lines + ".new",
                                     model + " --tiles 9x9 -o new --result " + no_text + ".png"}) {
        const RunResult result = farm("plan " + words);
        EXPECT_EQ(result.status, 2) << words << result.err;
        EXPECT_THAT(result.err, HasSubstr("control characters")) << words;
        EXPECT_FALSE(exists("new")) << words;
    }
    // A file that the model uses.
    shell("cp " + model + " tree.inst && printf 'use leaf = \"a\\377.inst\"\\n' >>tree.inst");
    EXPECT_THAT(farm("plan tree.inst --tiles 9x9 -o new").status, AnyOf(Eq(1), Eq(3)));
    EXPECT_FALSE(exists("new"));
}

} // namespace
} // namespace graftal
