#include "tests/golden/command_line.h"

#include <filesystem>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

namespace graftal {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string bad_model = "object top {\n    union: nowhere\n}\n";

TEST_F(CommandLine, UsageErrorsAreStatusTwoAndPointAtTheHelp) {
    const struct {
        std::string arguments, message;
    } cases[] = {
        {"", "graftal: no command given: try 'graftal render MODEL'\nTry 'graftal --help' for more "
             "information.\n"},
        {"rendr x.inst",
         "graftal: there is no command 'rendr' (did you mean 'render'? known here: render, animate,"},
        {"fern.rifs", "graftal: name a command first, such as 'graftal render fern.rifs'\n"},
        {"draw x.inst",
         "there is no command 'draw' (known here: render, animate, points, collage, fit, compile, export"},
        {"render", "graftal: no model given: try 'graftal render MODEL'\n"},
        {"check", "graftal: no model given: try 'graftal check MODEL'\n"},
        {"compare", "graftal: 'compare' takes two pictures: 'graftal compare A B'\n"},
        {"compare one.png two.png three.png",
         "graftal: 'compare' takes two pictures: 'graftal compare A B'\n"},
        {"render a.inst b.inst",
         "graftal: 'b.inst' is one word too many: 'render' takes MODEL; put a name with spaces in quotes"},
        {"render a.inst --no-such-option", "graftal: 'render' has no option '--no-such-option'\n"},
        {"render a.inst --siez 3x4", "graftal: 'render' has no option '--siez' (did you mean '--size'?)\n"},
        {"render a.inst --size=3x4 --stesp=4",
         "'render' has no option '--stesp' (did you mean '--steps'?)\n"},
        {"render a.inst -x", "graftal: 'render' has no option '-x'\n"},
        {"render a.inst --size", "graftal: --size needs a value: --size WxH\n"},
        {"render a.inst --set", "graftal: --set needs a value: --set NAME=VALUE\n"},
        {"compile a.inst --name A", "graftal: --name names what an .inc declares: give '-o FILE.inc' too\n"},
        {"compile a.inst -o a.inc --name fern", "--name: 'fern' is not a name of at most 24 letters"},
        {"render a.inst --size 0x100", "--size: '0x100' is not a size such as 1280x720"},
        {"render a.inst --size 100", "--size: '100' is not"},
        {"render a.inst --size 199999x2", "--size: '199999x2' is not"},
        {"render a.inst --size 99999x2",
         "--size: a picture of 99999x2 is too large to be drawn at once (at most 32768 a side, and 2^28 "
         "pixels): draw it in tiles with 'graftal farm plan', or a part of it with --tile"},
        {"animate a.inst --size 99999x2", "--size: '99999x2' is not"},
        {"render a.inst --size 99x99 --engine native --tile 0,0,10x100",
         "--tile: this part is not within the 99x99 pixels of the picture"},
        {"render a.inst --size 99x99 --engine native --tile 0,0,10x0", "--tile: '0,0,10x0' is not a part"},
        {"render a.inst --size 99x99 --engine native --tile 0,0", "--tile: '0,0' is not a part"},
        {"render a.inst --engine povray --size 99x99 --tile 0,0,10x10", "--tile needs '--engine native'"},
        {"render a.inst --size 99x99 --engine native --tile 0,0,10x10 --denoise on",
         "--denoise: a part of a picture lacks its neighbours"},
        {"render a.inst --denoise never", "--denoise: 'never' is not on or off"},
        {"farm plan a.inst --tiles 20x20 -o job --denoise on", "--denoise: tiles are drawn apart"},
        {"render a.inst --size 99x99 --engine native --tile 0,0,10x10 --progressive",
         "--tile draws once, at its finest: leave out --progressive"},
        {"render a.inst --memory 2X", "--memory: '2X' is not"},
        {"render a.inst --memory 0", "--memory: '0' is not"},
        {"render a.inst --memory 10", "--memory: '10' is 10 bytes: give a unit, such as 10M or 10G\n"},
        {"studio --memory 1048575", "--memory: '1048575' is 1048575 bytes: give a unit, such as 1023K\n"},
        {"export a.inst -o a.ply --limit 1", "--limit: '1' is 1 byte: give a unit, such as 1M or 1G\n"},
        {"render a.inst --quality high", "--quality: 'high' is not draft, normal or best\n"},
        {"animate a.inst --quality nromal",
         "--quality: 'nromal' is not draft, normal or best (did you mean 'normal'?)\n"},
        {"render a.inst --quality 2", "--quality: '2' is not draft, normal or best\n"},
        {"completion zhs", "graftal: SHELL: 'zhs' is not bash, fish or zsh (did you mean 'zsh'?)\n"},
        {"render a.inst --samples 0", "--samples: '0' is not a whole number from 1 to 65536\n"},
        {"render a.inst --noise 256", "--noise: '256' is not a number from 0 to 255\n"},
        {"render a.inst --device first",
         "--device: 'first' is not a list of whole numbers, such as 0 or 0,1\n"},
        {"render a.inst --device 0,", "--device: '0,' is not a list of whole numbers, such as 0 or 0,1\n"},
        {"points a.rifs --device 0,1", "--device: '0,1' is not a whole number, 0 or more\n"},
        {"stats a.inst --steps infinite",
         "--steps: 'infinite' is for the model's file: write 'steps infinite'"},
        {"render a.inst --width 300",
         "'render' has no option '--width' (width and height are one option, such "
         "as '--size 640x480')\n"},
        {"points a.inst --height=300", "'points' has no option '--height' (width and height are one option"},
        {"render a.inst -w 300", "(width and height are one option"},
        {"animate a.inst +W300 +H200", "'animate' has no option '+W300' (width and height are one option"},
        {"render a.inst --memory 99999999999999G", "is not a number of bytes"},
        {"render a.inst --error -1", "--error: '-1' is not"},
        {"render a.inst --error 1e-320", "--error: '1e-320' is not 0, or a number of pixels from 1e-100"},
        {"render a.inst --error nan", "--error: 'nan' is not"},
        {"render a.inst --error 1 --error-world 1",
         "graftal: --error and --error-world exclude each other: give only one of them\n"},
        {"render a.inst --steps -3", "--steps: '-3' is not"},
        {"render a.inst --steps 1e3", "--steps: '1e3' is not"},
        {"render a.inst --set x", "--set: 'x' is not of the form NAME=NUMBER"},
        {"render a.inst --set x=inf", "--set: 'x=inf' is not"},
        {"render a.inst --seed x", "--seed: 'x' is not"},
        {"render a.inst --bits 12", "--bits: '12' is not 8 or 16"},
        {"render a.inst --threads 0", "--threads: '0' is not"},
        {"render a.inst --antialias 12", "--antialias: '12' is neither"},
        {"render a.inst --engine luxury", "--engine: 'luxury' is not auto, native, gpu or povray"},
        {"animate a.inst --engine ''", "--engine: '' is not auto, native, gpu or povray"},
        {"stats a.inst --engine native", "--engine"},
        {"render a.inst --engine povray --progressive",
         "graftal: --progressive needs '--engine native': POV-Ray shows"},
        {"render a.inst --progressive --no-progressive", "exclude each other"},
        {"render a.inst --engine native --engine povray --progressive", "--progressive needs"},
        {"animate a.inst --engine native --progressive", "--progressive"},
        {"render a.inst --engine povray --aovs -o a.exr",
         "--aovs needs '--engine native': POV-Ray gives colours only"},
        {"render a.inst --aovs --engine native", "--aovs: only an EXR has room for more channels: name"},
        {"render a.inst --aovs --engine native -o a.png", "with '-o FILE.exr'"},
        {"render a.inst --engine native --keep here", "--keep: the native engine writes no scene"},
        {"render a.inst --engine native --visible-only", "--visible-only: the native engine follows every"},
        {"animate a.inst --engine native --visible-only", "--visible-only: the native engine follows every"},
        {"render - --engine native", "standard input has no name"},
        {"render a.inst --engine native -o a.jpg", "'a.jpg': the name of a picture must end in .png or .exr"},
        {"render a.inst --camera location=1,2", "--camera: 'location=1,2' is not of the form location=X,Y,Z"},
        {"render a.inst --camera 'angle=180'", "--camera: angle must lie between 0 and 180 degrees"},
        {"render a.inst --camera 'angle=30,location=1,2'",
         "--camera: 'location=1,2' is not of the form location=X,Y,Z, without blanks\n"},
        {"render a.inst --camera 'angle=180,location=1,2,3'", "--camera: angle must lie between 0 and 180"},
        {"render a.inst --camera 'zoom=2'", "--camera: 'zoom=2' is none of"},
        {"render a.inst --camera aperture=-1",
         "--camera: aperture must be 0, or a radius from 1e-100 to 1e100"},
        {"points a.inst --camera aperture=x", "--camera: aperture must be 0, or"},
        {"animate a.inst --camera aperture=0..-1", "--camera: aperture must be 0, or"},
        {"export a.inst --camera focus=1,2", "--camera: 'focus=1,2' is not of the form focus=X,Y,Z"},
        {"render a.inst -o a.jpg", "graftal: 'a.jpg': the name of a picture must end in .png or .exr\n"},
        {"render -", "standard input has no name"},
        {"animate a.inst --frames 0", "--frames: '0' is not a whole number from 1 to 100000"},
        {"animate a.inst --frames 1000000000", "--frames: '1000000000' is not"},
        {"animate a.inst --steps 1..x", "'1..x' is not a number from 0 to 4000000000, or two as A..B"},
        {"animate a.inst --steps ..", "--steps: '..' is not"},
        {"animate a.inst --steps 1..5000000000", "--steps: '1..5000000000' is not"},
        {"animate a.inst --seed 1..-1", "--seed: '1..-1' is not"},
        {"animate a.inst --set k=1..", "--set: 'k=1..' is not of the form NAME=NUMBER or NAME=A..B[:STEP]"},
        {"animate a.inst --set k=1..9:0", "--set: 'k=1..9:0' is not"},
        {"animate a.inst --set =1..9", "--set: '=1..9' is not"},
        {"animate a.inst --camera angle=10..200", "--camera: angle must lie between 0 and 180 degrees"},
        {"animate a.inst --camera location=1,2,3..4,5", "'location=4,5' is not of the form location=X,Y,Z"},
        {"animate a.inst --camera orthographic=1..2", "is none of"},
        {"animate a.inst --turn 10..20", "--turn: '10..20' is not"},
        {"animate a.inst --fps 0", "--fps: '0' is not a number from 0.01 to 240"},
        {"animate a.inst --fps 60", "--fps: a GIF shows at most 50 frames per second"},
        {"animate a.inst --ease fast", "--ease: 'fast' is not linear or smooth"},
        {"animate a.inst -o a.mp4 --size 63x48", "a video needs an even width and height, such as 64x48"},
        {"animate a.inst -o a.jpg",
         "'a.jpg': the name of an animation must end in .gif, .png, .apng, .mp4, .webm or .usda"},
        {"animate -", "give the model as a file, not on standard input"},
        {"render a.inst --steps 1..3", "--steps: '1..3' is not a number from 0 to 4000000000\n"},
        {"compile a.inst -o a.png", "'a.png': the name of a scene must end in .pov or .inc"},
        {"graph a.inst -o a.pdf", "'a.pdf': the name of a graph's drawing must end in .dot or .svg"},
        {"print a.inst --after drop_unreachabel", "did you mean 'drop_unreachable'?"},
        {"stats a.inst --dump-after nothing", "there is no pass 'nothing' (known here: "},
        {"compare one.png", "graftal: 'compare' takes two pictures: 'graftal compare A B'\n"},
        {"compare a.png b.png --threshold x", "--threshold: 'x' is not"},
    };
    for (const auto& [arguments, message] : cases) {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, 2) << arguments;
        EXPECT_THAT(result.err,
                    AllOf(StartsWith("graftal: "), HasSubstr(message), HasSubstr("\nTry 'graftal")))
            << arguments;
        EXPECT_EQ(result.out, "") << arguments;
    }
    EXPECT_EQ(files(), "");
}

/// Every option that has a value is asked about a word that none takes: no answer is a library's.
TEST_F(CommandLine, OptionsRefuseWordsInPlainEnglish) {
    std::set<std::string> asked;
    for (const std::string command :
         {"render", "animate", "points", "collage", "fit", "compile", "export", "stats", "print", "graph",
          "import", "compare", "format", "farm plan", "farm submit"}) {
        std::istringstream help(graftal(command + " --help").out);
        for (std::string line; std::getline(help, line);) {
            std::string name, value;
            std::istringstream words(line);
            words >> name >> value;
            if (!name.starts_with("--") || !line.starts_with("  ") || !asked.insert(name + value).second)
                continue;
            const bool chooses =
                value.find('|') != std::string::npos && value.find_first_of("[NDC") == std::string::npos;
            const RunResult result = graftal(command + " a.inst " + name + " drfat");
            EXPECT_THAT(result.err, Not(AnyOf(HasSubstr("FAILED"), HasSubstr("{"), HasSubstr("Could not"))))
                << command << ' ' << name;
            if (!chooses) continue;
            EXPECT_EQ(result.status, 2) << command << ' ' << name;
            EXPECT_THAT(result.err, AllOf(StartsWith("graftal: " + name + ": 'drfat' is "),
                                          HasSubstr(" or " + value.substr(value.rfind('|') + 1))))
                << command << ' ' << name;
        }
    }
    EXPECT_GT(asked.size(), 60u);
}

TEST_F(CommandLine, SettingsOfACameraStandApartByBlanksOrCommas) {
    write("a.inst", "object a { instance: sphere }\n");
    const std::string look = "render a.inst --size 24x16 --quality draft -q ";
    ASSERT_EQ(graftal(look + "--camera 'location=0,1,9 look_at=0,0,0 angle=30' -o a.png").status, 0);
    for (const std::string words :
         {"location=0,1,9,look_at=0,0,0,angle=30", "location=0,1,9, look_at=0,0,0, angle=30,"}) {
        ASSERT_EQ(graftal(look + "--camera '" + words + "' -o b.png").status, 0) << words;
        EXPECT_EQ(graftal("compare a.png b.png").status, 0) << words;
    }
    ASSERT_EQ(graftal(look + "--camera location=0,2,9,look_at=0,0,0,angle=30 -o b.png").status, 0);
    EXPECT_EQ(graftal("compare a.png b.png").status, 1) << "the camera counts";
}

TEST_F(CommandLine, AFolderIsNoModel) {
    std::filesystem::create_directory(path("models"));
    for (const char* command : {"render models", "stats models/", "check models", "format models",
                                "fit models", "compare models models", "import models"})
        EXPECT_THAT(graftal(command).err, HasSubstr("a folder, not a file: name a file in it")) << command;
}

TEST_F(CommandLine, ModelsOfOtherProgramsAreNamed) {
    write("a.txt.old", "a model\n");
    const std::string hint = graftal("stats a.txt.old").err, known = graftal("import --help").out;
    for (const std::string ending : {".cfdg", ".es", ".l", ".ifs", ".flame"}) {
        EXPECT_THAT(hint, HasSubstr(ending)) << ending;
        EXPECT_THAT(known, HasSubstr(ending)) << ending;
        EXPECT_THAT(graftal("render --help").out, HasSubstr(ending)) << ending;
    }
    EXPECT_THAT(graftal("--help").out, HasSubstr("graftal import --help"));
    EXPECT_THAT(graftal("render --help").out, HasSubstr("5, 9 or 600"));
}

TEST_F(CommandLine, CompilingNamesThePicturesBesideAScene) {
    const RunResult result = graftal("compile " + pound_sign + " --steps 5 -o hash.pov");
    EXPECT_THAT(result.err,
                HasSubstr("; 8 pictures beside it: hash_P_1.png, hash_P_2.png, hash_P_3.png, ...\n"));
    EXPECT_TRUE(exists("hash_P_8.png"));
    EXPECT_EQ(files().find("rifs"), std::string::npos) << files();
}

TEST_F(CommandLine, HelpGoesToStandardOutput) {
    for (const std::string command :
         {"", "render ", "animate ", "compile ", "check ", "stats ", "print ", "graph ", "compare "}) {
        const RunResult result = graftal(command + "--help");
        EXPECT_EQ(result.status, 0) << command;
        EXPECT_THAT(result.out, HasSubstr(command.empty() ? "Exit status" : "xample")) << command;
        EXPECT_EQ(result.err, "") << command;
    }
    EXPECT_THAT(graftal("--version").out, StartsWith("graftal 0."));
    EXPECT_THAT(graftal("--help-passes").out, HasSubstr("merge_equivalent"));
}

TEST_F(CommandLine, BadModelIsStatusOneAndTouchesNoFile) {
    write("bad.inst", bad_model);
    for (const char* name : {"bad.png", "bad.pov", "bad.dot", "bad.svg"})
        write(name, "old");
    const std::string before = files();
    for (const std::string arguments :
         {"render bad.inst", "render bad.inst -o bad.png", "compile bad.inst -o bad.pov", "compile bad.inst",
          "check bad.inst", "stats bad.inst --json", "print bad.inst", "graph bad.inst -o bad.dot",
          "graph bad.inst -o bad.svg", "render - -o bad.png <bad.inst"}) {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, 1) << arguments;
        EXPECT_THAT(result.err, HasSubstr(":2:12: error: ")) << arguments;
        EXPECT_EQ(result.out, "") << arguments;
    }
    EXPECT_EQ(files(), before);
    EXPECT_EQ(read("bad.png") + read("bad.pov") + read("bad.dot") + read("bad.svg"), "oldoldoldold");
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(CommandLine, EnvironmentIsStatusThree) {
    for (const std::string& arguments : std::vector<std::string>{
             "render none.inst", "check none.inst", "render " + gasket + " -o no/such/folder.png",
             "compile " + gasket + " -o no/such/folder.pov", "print " + gasket + " >&-",
             "print " + gasket + " >/dev/full", "stats " + gasket + " --json >&-",
             "compile " + gasket + " >/dev/full", "graph " + gasket + " >/dev/full", "--help >&-",
             "compare none.png none.png"}) {
        const RunResult result = graftal(arguments);
        EXPECT_EQ(result.status, 3) << arguments;
        EXPECT_THAT(result.err, StartsWith("graftal: ")) << arguments;
    }
    EXPECT_EQ(files(), "");
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(CommandLine, AFileThatMayNotGrowIsAFullDisk) {
    for (const std::string& arguments :
         {"render " + gasket + " --engine native -o x.png", "compile " + pound_sign + " -o x.pov",
          "points " + gasket + " --points 1e5 -o x.ply"}) {
        const RunResult result = shell("ulimit -f 1; \"$graftal\" " + arguments);
        EXPECT_EQ(result.status, 3) << arguments << result.err;
        EXPECT_THAT(result.err, HasSubstr("File too large")) << arguments;
        EXPECT_EQ(files(), "") << arguments;
    }
}

TEST_F(CommandLine, PicturesToReadAreRegularFiles) {
    shell("mkfifo pipe.png; ln -s /dev/zero zero.png");
    for (const char* name : {"pipe.png", "zero.png"}) {
        const RunResult result = graftal(std::string("compare pipe.png ") + name);
        EXPECT_EQ(result.status, 3) << name;
        EXPECT_THAT(result.err, HasSubstr("not a regular file")) << name;
        EXPECT_EQ(graftal("collage " + std::string(name) + " " + gasket).status, 3) << name;
    }
}

TEST_F(CommandLine, MissingProgramsAreNamedWithTheirPackages) {
    const RunResult povray =
        shell("PATH=/nowhere \"$graftal\" render --engine povray " + gasket + " -o a.png");
    EXPECT_EQ(povray.status, 3);
    EXPECT_EQ(povray.err,
              "graftal: cannot find the program 'povray'; install it with 'apt-get install povray'\n");
    const RunResult dot = shell("PATH=/nowhere \"$graftal\" graph " + gasket + " -o a.svg");
    EXPECT_EQ(dot.status, 3);
    EXPECT_EQ(dot.err,
              "graftal: cannot find the program 'dot'; install it with 'apt-get install graphviz'\n");
    EXPECT_EQ(files(), "");
}

TEST_F(CommandLine, ClosedPipeIsNoCrash) {
    const RunResult result =
        shell("{ \"$graftal\" print " + gasket + "; echo $? >status; } | sleep 0; cat status >&2");
    // The reader may be gone before or after the text is written; a signal would show as 141.
    EXPECT_EQ(result.err, "0\n");
    for (const std::string& command : {"compile " + gasket, "print " + gasket, std::string("render --help")})
        EXPECT_EQ(shell("\"$graftal\" " + command + " | true").err, "") << command;
    const RunResult many = shell("for i in 1 2 3 4 5; do { \"$graftal\" print " + gasket +
                                 "; echo $? >&3; } 2>/dev/null | true; done 3>&2");
    EXPECT_EQ(many.err.find("141"), std::string::npos);
}

TEST_F(CommandLine, SettingsCanBeSetLikeLets) {
    write("koch.lsys",
          "let size = 2\nlsys koch {\n  angle 60\n  step size\n  steps 1\n  axiom F\n  F -> F+F\n}\n");
    write("late.lsys", "lsys late {\n  angle 60\n  width 0.1\n  steps 1\n  axiom F\n  F -> F+F\n}\n");
    const std::string plain = graftal("print koch.lsys").out;
    for (const std::string set : {"angle=40", "step=3", "width=1", "steps=2", "size=4"})
        EXPECT_NE(graftal("print koch.lsys --set " + set).out, plain) << set;
    EXPECT_EQ(graftal("print koch.lsys --set angle=60 --set step=2 --set steps=1").out, plain);
    EXPECT_EQ(graftal("print koch.lsys --set steps=3").out, graftal("print koch.lsys --steps 3").out);
    const RunResult wrong = graftal("print koch.lsys --set angel=40");
    EXPECT_EQ(wrong.status, 1);
    EXPECT_EQ(
        wrong.err,
        "graftal: error: the model has no 'let angel' to set\n"
        "    hint: did you mean 'angle'? known here: size, angle, step, width, thickness, steps, seed\n");
    EXPECT_THAT(graftal("print koch.lsys --set step=-1").err,
                HasSubstr("graftal: error: 'step' must be positive, not -1\n"));
    write("set.inst", "object set { union: set, sphere  scale: 0.5 }\n");
    EXPECT_EQ(graftal("stats set.inst --json --set steps=3").out,
              graftal("stats set.inst --json --steps 3").out);
    EXPECT_THAT(graftal("check set.inst --set steps=2.5").err,
                HasSubstr("'steps' as it is set must be a whole number"));
    EXPECT_THAT(graftal("check set.inst --set angle=4").err, HasSubstr("hint: known here: steps\n"));
}

/// What is written says neither where nor with how many threads it was made.
TEST_F(CommandLine, TheSamePictureHasTheSameBytes) {
    write("a model.inst", "object set { union: set, sphere  scale: 0.5 }\n");
    std::filesystem::create_directory(path("there"));
    const std::string there = "'" + path("a model.inst") + "'";
    const std::string options = " -q --steps 3 --seed 7 --size 32x24 ";
    for (const auto& [command, ending] : {std::pair("render", ".png --engine native"),
                                          std::pair("points", ".ply"), std::pair("points", ".png")}) {
        const std::string begin = command + std::string(" ");
        ASSERT_EQ(graftal(begin + "'a model.inst'" + options + "--threads 1 -o a" + ending).status, 0);
        ASSERT_EQ(graftal(begin + there + " --threads 2" + options + "-o '" + path("there/b") + "'" + ending)
                      .status,
                  0);
        const std::string suffix = std::string(ending).substr(0, 4), bytes = read("a" + suffix);
        EXPECT_EQ(bytes, read("there/b" + suffix)) << command << ending;
        EXPECT_EQ(bytes.find(path("")), std::string::npos);
        if (suffix == ".ply") {
            EXPECT_THAT(bytes, HasSubstr("graftal points 'a model.inst' --size 32x24 --steps 3 --seed 7\n"));
        }
    }
}

TEST_F(CommandLine, WhatIsNoModelIsNotShown) {
    write("secret", "root:x:0:0:secret:/root:/bin/bash\n-----BEGIN PRIVATE KEY-----\n");
    for (const std::string name : {"a.inst", "a.rifs", "a.lsys", "a"}) {
        ASSERT_EQ(shell("ln -s secret " + name).status, 0);
        write("user.inst", "use a = \"" + name + "\"\nobject o { a }\n");
        for (const std::string& model : {name, std::string("user.inst")}) {
            const RunResult result = graftal("check " + model);
            EXPECT_EQ(result.status, 1) << model;
            EXPECT_THAT(result.err, HasSubstr("'" + name + "' is no model")) << model;
            EXPECT_THAT(result.out + result.err, Not(HasSubstr("root"))) << model;
        }
    }
}

TEST_F(CommandLine, AUsedModelsOwnUseIsReachedByItsName) {
    write("ball.inst", "inner size = 0.5\nobject ball { sphere scale: 1 + size }\n");
    write("pair.inst", "use small = \"ball.inst\"\nobject pair { small }\n");
    const auto printed = [this](const std::string& master) {
        write("a.inst", "use pair = \"pair.inst\"\nobject a { " + master + " }\n");
        return graftal("print a.inst");
    };
    EXPECT_THAT(printed("pair.small").out, HasSubstr("matrix: 1.5, 0"));
    EXPECT_THAT(printed("pair.small(0.25)").out, HasSubstr("matrix: 1.25, 0"));
    EXPECT_THAT(printed("pair.small(3)").err, HasSubstr("'size' of 'small' lies between 0 and 1, not at 3"));
    EXPECT_THAT(printed("pair.small(0, 0)").err, HasSubstr("unknown object 'pair.small(0, 0)'"));
    for (const char* wrong : {"pair.small(3)", "pair.small(0, 0)"})
        EXPECT_EQ(printed(wrong).status, 1) << wrong;
}

TEST_F(CommandLine, ProbabilitiesGoThroughThePrintedGraph) {
    const std::string fern = "'" + source_path("scenes/ifs/fern.rifs") + "'";
    const RunResult printed = graftal("print " + fern);
    EXPECT_THAT(printed.out, HasSubstr("chance: "));
    write("fern.inst", printed.out);
    EXPECT_EQ(graftal("print fern.inst").out, printed.out);
    const std::string draw = " --points 1e5 --size 60x80 -q -o ";
    ASSERT_EQ(graftal("points " + fern + draw + "a.png").status, 0);
    ASSERT_EQ(graftal("points fern.inst" + draw + "b.png").status, 0);
    EXPECT_EQ(compare_images(picture("a.png"), picture("b.png")).differing, 0u);
}

TEST_F(CommandLine, UnwritableTemporaryFolderIsStatusThree) {
    const RunResult result =
        shell("TMPDIR=/nowhere/at/all \"$graftal\" render --engine povray " + gasket + " -o a.png");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("temporary directory"));
    EXPECT_EQ(files(), "");
}

TEST_F(CommandLine, CheckNotesObjectsThatAreDrawnTwice) {
    const std::string flower = "object flower { 12 * { rotate: y, 30 } petal }\n";
    const std::string petal = "object petal { sphere scale: 1, 0.1, 0.4 translate: 1.2, 0, 0 }\n";
    write("twice.inst", flower + petal);
    write("once.inst", flower + "canonical " + petal);
    write("itself.inst",
          "object a { sphere scale: 0.5\n2 * { rotate: y, 90 } a scale: 0.5 translate: 1, 0, 0 }\n"
          "object b { cube translate: 5, 0, 0 }\n");
    EXPECT_EQ(graftal("check twice.inst").err,
              "twice.inst:2:8: note: 'petal' is drawn by itself, and again inside 'flower'\n"
              "    object petal { sphere scale: 1, 0.1, 0.4 translate: 1.2, 0, 0 }\n"
              "           ^~~~~\n"
              "    hint: write 'canonical object petal' to draw it only inside others\n"
              "twice.inst:1:40: note: it is used here\n"
              "    object flower { 12 * { rotate: y, 30 } petal }\n"
              "                                           ^~~~~\n");
    EXPECT_EQ(graftal("check once.inst itself.inst").err, "");
}

TEST_F(CommandLine, CheckReportsEachModelAndTheWorstStatus) {
    write("bad.inst", bad_model);
    const RunResult good = graftal("check " + gasket + " " + pound_sign);
    EXPECT_EQ(good.status, 0);
    EXPECT_THAT(good.out, AllOf(HasSubstr("sierpinski.inst: ok, it contains itself and shrinks: "
                                          "to 0.5 of its size or less per instance"),
                                HasSubstr("pound_sign.rifs: ok, it contains itself")));
    EXPECT_EQ(good.err, "");
    EXPECT_EQ(graftal("check bad.inst none.inst").status, 1);
    EXPECT_EQ(graftal("check none.inst bad.inst").status, 1);
    EXPECT_EQ(graftal("check " + gasket + " none.inst").status, 3);
    EXPECT_EQ(graftal("check --quiet " + gasket).out, "");
}

TEST_F(CommandLine, PrintedGraphReadsBackAsItself) {
    ASSERT_EQ(graftal("print " + pound_sign + " >a.inst").status, 0);
    ASSERT_EQ(graftal("print - <a.inst >b.inst").status, 0);
    EXPECT_EQ(read("a.inst"), read("b.inst"));
    EXPECT_THAT(read("a.inst"), HasSubstr("canonical object"));
}

TEST_F(CommandLine, DumpAfterGoesToStandardError) {
    const RunResult one = graftal("check -q " + gasket + " --dump-after drop_unreachable");
    EXPECT_THAT(one.err, StartsWith("// after drop_unreachable\n"));
    EXPECT_EQ(one.err.find("after merge_equivalent"), std::string::npos);
    EXPECT_THAT(graftal("check -q " + gasket + " --dump-after all").err,
                HasSubstr("// after merge_equivalent\n"));
    EXPECT_THAT(graftal("check -q --time " + gasket).err, HasSubstr(" s  bounding\n"));
}

TEST_F(CommandLine, GraphIsDotOnStandardOutputOrInAFile) {
    const RunResult result = graftal("graph " + gasket);
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.out, StartsWith("digraph"));
    ASSERT_EQ(graftal("graph " + gasket + " -o g.dot").status, 0);
    EXPECT_EQ(read("g.dot"), result.out);
}

TEST_F(CommandLine, GraphIsDrawnBeforeEqualObjectsAreMergedToo) {
    const std::string tree = "'" + source_path("scenes/hart/sierpinski_tree.inst") + "'";
    EXPECT_THAT(graftal("graph " + tree).out, Not(HasSubstr("piece(0, 8)")));
    EXPECT_THAT(graftal("graph " + tree + " --after drop_unreachable").out, HasSubstr("piece(0, 8)"));
    EXPECT_EQ(graftal("graph " + tree + " --after nothing").status, 2);
}

TEST_F(CommandLine, SvgIsDrawnByTheProgramDot) {
    std::filesystem::create_directory(path("bin"));
    write("bin/dot", "#!/bin/sh\n[ \"$1\" = -Tsvg ] && [ \"$2\" = -o ] && cp \"$4\" \"$3\"\n");
    ASSERT_EQ(
        shell("chmod +x bin/dot; PATH=\"$PWD/bin:$PATH\" \"$graftal\" graph " + gasket + " -o g.svg").status,
        0);
    EXPECT_THAT(read("g.svg"), StartsWith("digraph"));
    write("bin/dot", "#!/bin/sh\necho broken >&2; echo half >\"$3\"; exit 4\n");
    const RunResult result =
        shell("chmod +x bin/dot; PATH=\"$PWD/bin:$PATH\" \"$graftal\" graph " + gasket + " -o h.svg");
    EXPECT_EQ(result.status, 3);
    EXPECT_THAT(result.err, HasSubstr("'dot' failed with status 4: broken"));
    EXPECT_EQ(files(), "bin g.svg");
}

TEST_F(CommandLine, ModelNamesCannotBecomeOptionsOfOtherPrograms) {
    EXPECT_EQ(graftal("render -- -D.inst").status, 3);
    EXPECT_EQ(files(), "");
}

} // namespace
} // namespace graftal
