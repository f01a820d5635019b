// A job gives the very files that one run gives, whatever happens to its tasks on the way.

#include <csignal>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/golden/background_run.h"
#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string farm_pixels = "--size 90x50 --plain-light ";
const std::string weed_of_farm = "'" + source_path("scenes/abop/fig1_27.lsys") + "' ";

class Farm : public CommandLine {
  protected:
    void succeed(const std::string& arguments) const {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, 0) << arguments << "\n" << result.err;
    }
    void expect_same(const std::string& a, const std::string& b) const {
        EXPECT_TRUE(read(a) == read(b)) << a << " and " << b << " differ";
    }
    /// How often tasks were started.
    std::string starts() const { return shell("cat job/tasks/*.starts | wc -l").out; }
};

TEST_F(Farm, TilesMakeTheFileOfOneRun) {
    for (const std::string& look : {gasket + farm_pixels, gasket + "--size 90x50 --samples 3 ",
                                    pound_sign + farm_pixels + "--bits 16 "}) {
        SCOPED_TRACE(look);
        succeed("farm plan " + look + "--tiles 37x20 -o job -q");
        succeed("farm submit job --local 2 -q");
        succeed("farm merge job -q");
        succeed("render " + look + "--engine native -q -o one.png");
        expect_same(read("job/job.json").find("sierpinski") != std::string::npos ? "job/sierpinski.png"
                                                                                 : "job/pound_sign.png",
                    "one.png");
        EXPECT_EQ(starts(), "9\n");
        succeed("farm submit job --local 2 -q"); // nothing is left to do
        EXPECT_EQ(starts(), "9\n");
        succeed("farm clean job --all");
        EXPECT_FALSE(exists("job/job.json"));
        shell("rm -rf job");
    }
}

TEST_F(Farm, FramesMakeTheFilmOfOneRun) {
    const std::string film = gasket + farm_pixels + "--steps 1..4 --turn 30 --frames 5 ";
    succeed("farm plan " + film + "-o job -q --result film.png");
    succeed("farm submit job --local 2 -q");
    succeed("farm merge job -q");
    succeed("animate " + film + "--engine native -q -o one.png --keep-frames");
    expect_same("film.png", "one.png");
    for (int i = 1; i <= 5; ++i)
        expect_same(fmt::format("job/parts/frame_{:04}.png", i),
                    fmt::format("one.frames/frame_{:04}.png", i));
    // The result may be the frames themselves.
    succeed("farm plan " + film + "-o frames_job -q --result frames/");
    succeed("farm submit frames_job --local 2 -q");
    succeed("farm merge frames_job -q");
    for (int i = 1; i <= 5; ++i)
        expect_same(fmt::format("frames/frame_{:04}.png", i), fmt::format("one.frames/frame_{:04}.png", i));
}

TEST_F(Farm, FramesAreExposedAlike) {
    const std::string film =
        gasket + "--size 24x16 --plain-light --turn 30 --frames 2 --shutter 0.5 --quality draft ";
    succeed("farm plan " + film + "-o job -q --result film.png");
    succeed("farm submit job --local 2 -q");
    succeed("farm merge job -q");
    succeed("animate " + film + "--engine native -q -o one.png");
    expect_same("film.png", "one.png");
}

TEST_F(Farm, SweepsMakeASheetAndATable) {
    succeed("farm plan " + weed_of_farm +
            "--size 40x60 --plain-light --sweep seed=1..2 --sweep \"angle=20..30 by 5\" -o job -q");
    succeed("farm submit job --local 2 -q");
    succeed("farm merge job -q");
    const std::string table = read("job/fig1_27.csv");
    EXPECT_THAT(table, StartsWith("task,seed,angle,picture,seconds,language,"));
    EXPECT_THAT(table, HasSubstr("\r\n6,2,30,picture_000006.png,"));
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7);
    const Image sheet = picture("job/fig1_27.png");
    EXPECT_EQ(sheet.width, 3 * (40 + 4) + 4);
    EXPECT_EQ(sheet.height, 2 * (60 + 4 + 12) + 4);
    succeed("render " + weed_of_farm +
            "--size 40x60 --plain-light --seed 2 --set angle=30 --engine native -q -o one.png");
    expect_same("job/parts/picture_000006.png", "one.png");
}

TEST_F(Farm, TheLinesOfAJobRunAnywhereInAnyOrderAndTwice) {
    succeed("farm plan " + gasket + farm_pixels + "--tiles 50x50 -o 'a job' -q");
    EXPECT_EQ(shell("wc -l < 'a job/commands.txt'").out, "2\n");
    EXPECT_EQ(shell("mkdir elsewhere && cd elsewhere && tac '../a job/commands.txt' | sh").status, 0);
    succeed("farm merge 'a job' -q");
    succeed("render " + gasket + farm_pixels + "--engine native -q -o one.png");
    expect_same("a job/sierpinski.png", "one.png");
    const RunResult again = shell("sh 'a job/commands.txt'");
    EXPECT_EQ(again.status, 0);
    EXPECT_EQ(again.err, "task 1 is done already\ntask 2 is done already\n");
    // At the same time.
    shell("rm 'a job/tasks/'*");
    EXPECT_EQ(shell("(cat 'a job/commands.txt' 'a job/commands.txt'; echo wait) | sed 's/1$/& \\&/; s/2$/& "
                    "\\&/' | sh")
                  .status,
              0);
    succeed("farm merge 'a job' -q");
    expect_same("a job/sierpinski.png", "one.png");
    EXPECT_EQ(shell("ls -A 'a job/parts' | wc -l").out, "2\n");
}

TEST_F(Farm, AKilledTaskLeavesNothingThatCounts) {
    const std::string look =
        gasket + "--size 400x300 --antialias 6 --error 0 --steps 9 --plain-light --work 1e6 ";
    succeed("farm plan " + look + "--tiles 400x300 -o job -q");
    for (const int signal : {SIGKILL, SIGTERM}) {
        BackgroundRun run(path(""), {"farm", "task", "job", "1", "--threads", "1"});
        ASSERT_TRUE(run.wait_until([&] { return exists("job/tasks/000001.log") && run.catches(SIGTERM); }));
        run.send(signal);
        EXPECT_NE(run.wait(), 0);
        EXPECT_FALSE(exists("job/tasks/000001.json"));
        EXPECT_FALSE(exists("job/parts/tile_000001.png"));
    }
    EXPECT_THAT(graftal("farm status job").out, HasSubstr("0 of 1 tasks done, 1 begun"));
    const RunResult merged = graftal("farm merge job");
    EXPECT_EQ(merged.status, 3);
    EXPECT_THAT(merged.err, HasSubstr("1 of 1 tasks are missing: 1;"));
    EXPECT_EQ(starts(), "2\n");
}

TEST_F(Farm, DamagedPartsAreDrawnAgain) {
    succeed("farm plan " + gasket + farm_pixels + "--tiles 50x50 -o job -q");
    succeed("farm submit job --local 1 -q");
    const std::string whole = read("job/parts/tile_000002.png");
    write("job/parts/tile_000002.png", whole.substr(0, whole.size() / 2));
    const RunResult status = graftal("farm status job");
    EXPECT_EQ(status.status, 1);
    EXPECT_THAT(status.out, AllOf(HasSubstr(", 1 failed"), HasSubstr("task 2 failed: its part ")));
    EXPECT_EQ(graftal("farm merge job").status, 3);
    EXPECT_FALSE(exists("job/sierpinski.png"));
    succeed("farm submit job --local 1 -q");
    EXPECT_TRUE(read("job/parts/tile_000002.png") == whole);
    EXPECT_EQ(starts(), "3\n");
    succeed("farm merge job -q");
}

TEST_F(Farm, AnotherBuildAndAChangedModelAreRefused) {
    write("leaf.inst", "object leaf {\n    sphere\n}\n");
    write("tree.inst",
          "use leaf = \"leaf.inst\"\nobject tree {\n    instance: leaf translate: 1, 0, 0\n    sphere\n}\n");
    succeed("farm plan tree.inst " + farm_pixels + "--tiles 50x50 -o job -q");
    // The copy counts, not what it was copied from.
    write("leaf.inst", "object leaf {\n    cube\n}\n");
    succeed("farm task job 1 -q");
    shell("sed -i s/sphere/cube/ job/model/leaf.inst");
    RunResult refused = graftal("farm task job 2");
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("model/leaf.inst"), HasSubstr("is not the file")));
    shell("sed -i s/cube/sphere/ job/model/leaf.inst");
    shell("sed -i 's/\"program\": \"graftal [^ ]*/\"program\": \"graftal 9.9/' job/job.json");
    refused = graftal("farm task job 2");
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr("was planned by 'graftal 9.9"));
    EXPECT_FALSE(exists("job/parts/tile_000002.png"));
}

TEST_F(Farm, FailuresAreShownWithTheirLastLine) {
    succeed("farm plan " + weed_of_farm + "--size 40x60 --plain-light --sweep steps=3,4 -o job -q");
    shell("rmdir job/parts && touch job/parts"); // no part can be written
    const RunResult failed = graftal("farm submit job --local 1");
    EXPECT_EQ(failed.status, 1);
    const RunResult status = graftal("farm status job");
    EXPECT_EQ(status.status, 1);
    EXPECT_THAT(status.out, AllOf(HasSubstr("2 failed"), HasSubstr("task 2 failed: graftal: cannot write"),
                                  HasSubstr("job/tasks/000002.log")));
    EXPECT_THAT(graftal("farm status job --json").out, HasSubstr("\"done\": 0"));
    shell("rm job/parts && mkdir job/parts");
    succeed("farm submit job --local 1 -q");
    EXPECT_THAT(graftal("farm status job").out, HasSubstr("2 of 2 tasks done\n"));
}

TEST_F(Farm, TheFolderThatAModelMayReadIsThatOfItsCopy) {
    shell("mkdir garden");
    write("garden/leaf.inst", "object leaf {\n    sphere\n}\n");
    write("garden/tree.inst",
          "use leaf = \"leaf.inst\"\nobject tree {\n    instance: leaf translate: 1, 0, 0\n    sphere\n}\n");
    succeed("farm plan garden/tree.inst " + farm_pixels + "--root garden --tiles 50x50 -o job -q");
    shell("rm -r garden");
    EXPECT_EQ(shell("sh job/commands.txt").status, 0);
    succeed("farm merge job -q");
}

/// Every command of docs/farm.md works, of small pictures; Slurm's need Slurm, and say so.
TEST_F(Farm, CommandsOfThePageWork) {
    const std::vector<std::string> commands = commands_of("docs/farm.md");
    for (const std::string& words : commands) {
        const bool slurm = words.find("--slurm") != std::string::npos;
        std::string more;
        if (words.starts_with("farm plan")) more = " -q --size 48x27 --plain-light --antialias off";
        if (words.find("--tiles") != std::string::npos) more += " --tiles 20x20";
        const RunResult result =
            slurm ? shell("PATH=/nowhere '" GRAFTAL_PROGRAM "' " + words) : graftal(words + more);
        EXPECT_EQ(result.status, slurm ? 3 : 0) << words << "\n" << result.err;
        EXPECT_EQ(result.err.find("cannot find the program 'sbatch'") != std::string::npos, slurm) << words;
    }
    EXPECT_GE(commands.size(), 6u);
    EXPECT_TRUE(exists("poster/elm.png"));
}

TEST_F(Farm, AFaultyPlanLeavesNothing) {
    write("bad.inst", "object top {\n    union: nowhere\n}\n");
    EXPECT_EQ(graftal("farm plan bad.inst --tiles 50x50 -o job").status, 1);
    EXPECT_EQ(graftal("farm plan none.inst --tiles 50x50 -o job").status, 3);
    EXPECT_EQ(graftal("farm plan " + weed_of_farm + "--sweep nothing=1..3 -o job").status, 1);
    EXPECT_EQ(files(), "bad.inst");
    succeed("farm plan " + gasket + farm_pixels + "--tiles 50x50 -o job -q");
    const RunResult again = graftal("farm plan " + gasket + farm_pixels + "--tiles 50x50 -o job");
    EXPECT_EQ(again.status, 3);
    EXPECT_THAT(again.err, HasSubstr("holds a job already"));
    EXPECT_TRUE(exists("job/job.json"));
    const RunResult other = graftal("farm plan " + gasket + farm_pixels + "--tiles 50x50 -o .");
    EXPECT_EQ(other.status, 3);
    EXPECT_THAT(other.err, HasSubstr("holds other files"));
}

TEST_F(Farm, CleanLeavesTheResult) {
    succeed("farm plan " + gasket + farm_pixels + "--tiles 50x50 -o job -q");
    const RunResult early = graftal("farm clean job");
    EXPECT_EQ(early.status, 1);
    EXPECT_THAT(early.err, HasSubstr("merge the job first, or give --all"));
    succeed("farm submit job --local 1 -q");
    succeed("farm merge job -q");
    succeed("farm clean job");
    EXPECT_EQ(shell("cd job && echo $(ls -A)").out, "sierpinski.png\n");
    EXPECT_EQ(graftal("farm clean job").status, 3); // it is no job any more
}

TEST_F(Farm, PovrayDrawsFramesAndSweepsAndNoTiles) {
    EXPECT_THAT(graftal("farm plan " + gasket + farm_pixels + "--engine povray --tiles 50x50 -o job").err,
                HasSubstr("tiles need '--engine native'"));
    succeed("farm plan " + gasket + farm_pixels +
            "--engine povray --frames 2 --turn 20 -o job --result film.png -q");
    succeed("farm submit job --local 2 -q");
    succeed("farm merge job -q");
    succeed("animate --engine povray " + gasket + farm_pixels + "--frames 2 --turn 20 -o one.png -q");
    expect_same("film.png", "one.png");
}

TEST_F(Farm, EachMillionPixelsOfAPosterHasTheWorkOfAPicture) {
    const struct {
        std::string size, work, planned;
    } cases[] = {{"2000x1500", "", "27"}, {"2000x1500", "--work 2 ", "6"}, {"900x500", "", ""}};
    for (const auto& [size, work, planned] : cases) {
        succeed("farm plan " + gasket + "--plain-light --tiles 500x500 -o job -q " + work + "--size " + size);
        const std::string manifest = read("job/job.json");
        const std::size_t at = manifest.rfind("\"--work\"");
        EXPECT_EQ(at == std::string::npos, planned.empty()) << size;
        if (!planned.empty()) {
            EXPECT_THAT(manifest.substr(at), StartsWith("\"--work\",\n  \"" + planned + "\"\n"));
        }
        shell("rm -r job");
    }
    // Many hours are not for a picture that shows less than was asked for.
    const std::string poor = "farm plan '" + source_path("scenes/hart/ternary_tree_limit.inst") +
                             "' --size 200x150 --plain-light --work 0.01 --tiles 100x100 -o job -q";
    const RunResult refused = graftal(poor);
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("graftal: this picture would show nothing smaller than "),
                                   HasSubstr("--work"), HasSubstr("--coarse")));
    EXPECT_FALSE(exists("job"));
    succeed(poor + " --coarse");
}

TEST_F(Farm, UsageErrors) {
    const struct {
        std::string arguments, message;
    } cases[] = {
        {"farm", "farm: name a step: plan, submit, status, merge or clean"},
        {"farm plan a.inst -o job", "give one of --tiles WxH, --frames N and --sweep NAME=VALUES"},
        {"farm plan a.inst -o job --tiles 9x9 --sweep seed=1..3", "give one of --tiles WxH, --frames N"},
        {"farm plan a.inst --tiles 9x9", "--output"},
        {"farm plan -o job --tiles 9x9", "no model given: try 'graftal farm plan MODEL'"},
        {"farm plan a.inst -o job --tiles 9", "--tiles: '9' is not a size such as 512x512"},
        {"farm plan a.inst -o job --sweep seed", "--sweep: 'seed' is not of the form NAME=A..B"},
        {"farm plan a.inst -o job --sweep k=1 --sweep k=2", "--sweep: 'k' is given twice"},
        {"farm plan a.inst -o job --sweep j=1..1000 --sweep k=1..1000", "more than 100000 pictures"},
        {"farm plan a.inst -o job --tiles 9x9 --siez 3x3", "'render' has no option '--siez'"},
        {"farm plan - -o job --tiles 9x9 --result a.png", "give the model as a file"},
        {"farm plan a.inst -o job --tiles 9x9 --progressive", "leave out --progressive"},
        {"farm plan a.inst -o job --tiles 9x9 --aovs --result a.exr", "tiles hold colours only"},
        {"farm plan a.inst -o job --sweep k=1..3 --result a.exr", "contact sheet must end in .png"},
        {"farm plan " + gasket + " -o job --size 40000x3000 --work 1 --tiles 1000x900",
         "--tiles: the merge of a picture 40000 wide holds at most 192 MiB of rows: tiles may be 419 high"},
        {"farm plan " + gasket + " -o job --size 9000x9000 --work 1 --tiles 9x9",
         "--tiles: 9x9 makes 1000000 tiles of a picture of 9000x9000, more than 100000"},
        {"farm submit job", "give one of --local N and --slurm"},
        {"farm submit job --local 2 --slurm", "give one of --local N and --slurm"},
        {"farm submit job --local 2 --resume", "go with --slurm"},
        {"farm submit job --local 0", "--local: '0' is not a whole number"},
        {"farm status ''", "JOB: name a folder"},
        {"farm status", "no job given: try 'graftal farm status JOB'"},
        {"farm task job", "no tasks given: try 'graftal farm task JOB TASKS'"},
    };
    for (const auto& [arguments, message] : cases) {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, 2) << arguments;
        EXPECT_THAT(result.err,
                    AllOf(StartsWith("graftal: "), HasSubstr(message), HasSubstr("\nTry 'graftal")))
            << arguments;
    }
    EXPECT_EQ(files(), "");
}

TEST_F(Farm, HelpTeaches) {
    for (const char* step : {"", "plan ", "submit ", "status ", "merge ", "clean ", "task "}) {
        const RunResult result = graftal(std::string("farm ") + step + "--help");
        EXPECT_EQ(result.status, 0) << step;
        EXPECT_THAT(result.out, AllOf(HasSubstr("xample"), HasSubstr("graftal farm"))) << step;
        EXPECT_EQ(result.err, "") << step;
    }
}

TEST_F(Farm, SlurmIsAskedForOneArrayAndAMergeAfterIt) {
    // Programs that write down what they are asked, and answer as Slurm does.
    std::filesystem::create_directory(path("bin"));
    write("bin/sbatch", "#!/bin/sh\necho \"$@\" >>asked\necho $((40 + $(wc -l <asked)))\n");
    write("bin/squeue", "#!/bin/sh\n[ -e ended ] || echo 2\n");
    write("bin/scontrol", "#!/bin/sh\necho 'MaxArraySize            = 3'\n");
    shell("chmod +x bin/*");
    const auto farm = [&](const std::string& arguments) {
        return shell("PATH=\"$PWD/bin:$PATH\" '" GRAFTAL_PROGRAM "' farm " + arguments);
    };
    succeed("farm plan " + gasket + farm_pixels + "--tiles 20x20 -o job -q");
    // Each of its 15 tasks would take some minutes: groups are as many as Slurm takes.
    shell("sed -i 's/\"task_seconds\": .*/\"task_seconds\": 300.0,/' job/job.json");
    RunResult submitted = farm("submit job --slurm --at-once 1 -- --partition=short");
    EXPECT_EQ(submitted.status, 0) << submitted.err;
    EXPECT_THAT(submitted.err, HasSubstr("Slurm's job 41: 15 tasks in 2 groups; job 42 merges them"));
    const std::string asked = read("asked");
    EXPECT_THAT(asked, AllOf(HasSubstr("--array=1-2%1 "), HasSubstr("--time=410 "), HasSubstr("--mem="),
                             HasSubstr("--partition=short "), HasSubstr("job/slurm/array_1.sh"),
                             HasSubstr("--dependency=afterok:41 ")));
    EXPECT_EQ(read("job/slurm/groups_1.txt"), "1-7\n8-15\n");
    // What the array runs.
    EXPECT_EQ(shell("SLURM_ARRAY_TASK_ID=1 sh job/slurm/array_1.sh job/slurm/groups_1.txt").status, 0);
    EXPECT_THAT(graftal("farm status job").out, HasSubstr("7 of 15 tasks done"));

    // Not twice by mistake; the second group still waits, and is left to Slurm.
    submitted = farm("submit job --slurm");
    EXPECT_EQ(submitted.status, 1);
    EXPECT_THAT(submitted.err, HasSubstr("was submitted as Slurm's job 41: --resume submits again"));
    submitted = farm("submit job --slurm --resume");
    EXPECT_EQ(submitted.status, 0);
    EXPECT_EQ(submitted.err, "all missing tasks wait or are at work in Slurm\n");
    // It has ended, and did nothing.
    write("ended", "");
    submitted = farm("submit job --slurm --resume");
    EXPECT_EQ(submitted.status, 0) << submitted.err;
    EXPECT_THAT(submitted.err, HasSubstr("Slurm's job 43: 8 tasks in 2 groups; job 44 merges them"));
    EXPECT_EQ(read("job/slurm/groups_2.txt"), "8-11\n12-15\n");
    for (const char* index : {"1", "2"})
        EXPECT_EQ(
            shell(fmt::format("SLURM_ARRAY_TASK_ID={} sh job/slurm/array_2.sh job/slurm/groups_2.txt", index))
                .status,
            0);
    EXPECT_EQ(shell("sh job/slurm/merge.sh").status, 0);
    succeed("render " + gasket + farm_pixels + "--engine native -q -o one.png");
    expect_same("job/sierpinski.png", "one.png");
    EXPECT_EQ(starts(), "15\n");
}

} // namespace
} // namespace graftal
