#include "tests/golden/command_line.h"

#include <algorithm>
#include <csignal>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/png_chunks.h"
#include "runtime/system/file.h"

namespace graftal {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string two_steps = pound_sign + "--steps 2 ";
const std::string weed = "'" + source_path("scenes/abop/fig1_24f.lsys") + "' ";
const std::string tree = "'" + source_path("scenes/hart/ternary_tree.inst") + "' ";
const std::string few_pixels = " --size 48x36 --antialias off --plain-light --engine povray ";

/// A cycle that contracts while k < 1.
const std::string dust = "let k = 0.5\n"
                         "canonical object dust {\n"
                         "    instance: dust scale: k translate: 1, 0, 0\n"
                         "    instance: dust scale: k\n"
                         "    terminal: sphere\n"
                         "}\n"
                         "object all {\n    union: dust\n}\n";

class Animate : public CommandLine {
  protected:
    Image frame(const std::string& folder, int number) const {
        return picture(fmt::format("{}/frame_{:04}.png", folder, number));
    }
    std::uint64_t differing(const Image& a, const Image& b) const { return compare_images(a, b).differing; }
    std::string files_in(const std::string& folder) const {
        return shell("cd " + folder + " && echo $(ls -A)").out;
    }

    /// A POV-Ray that draws, but at its nth call does something else first. The wrapper's parent is graftal.
    void write_povray(int nth, const std::string& instead) const {
        std::filesystem::create_directory(path("bin"));
        write("bin/povray", fmt::format("#!/bin/sh\necho >>'{0}'\n[ $(wc -l <'{0}') -ne {1} ] || {{ {2}; }}\n"
                                        "PATH=${{PATH#*:}} exec povray \"$@\"\n",
                                        path("bin/calls"), nth, instead));
        shell("chmod +x bin/povray; rm -f bin/calls");
    }
    /// A POV-Ray that takes no time and always draws the same 48 x 36 pixels, for what is not about pictures.
    void write_quick_povray() const {
        std::filesystem::create_directory(path("bin"));
        ASSERT_TRUE(write_image(path("bin/still.png"),
                                Image{48, 36, 3, std::vector<float>(3 * 48 * 36, 0.5f)}, SampleFormat::srgb8)
                        .ok());
        write("bin/povray",
              "#!/bin/sh\ncp '" + path("bin/still.png") + "' picture.png\necho 'POV-Ray finished' >&2\n");
        shell("chmod +x bin/povray");
    }
    RunResult with_povray(const std::string& arguments) const {
        return shell("PATH=\"$PWD/bin:$PATH\" \"$graftal\" animate --unconfined " + arguments);
    }
    /// The two animations agree frame by frame.
    void expect_same_frames(const std::string& a, const std::string& b, int frames) const {
        for (int i = 1; i <= frames; ++i)
            EXPECT_EQ(differing(frame(a, i), frame(b, i)), 0u) << i;
    }
};

TEST_F(Animate, TurntableGoesRoundOnceAndCloses) {
    const RunResult once = graftal("animate " + two_steps + few_pixels + "--frames 12 -o once/");
    ASSERT_EQ(once.status, 0) << once.err;
    EXPECT_THAT(once.err, HasSubstr("once/: 12 frames, 25 per second; error at most "));
    EXPECT_EQ(once.out, "");
    for (int a = 1; a <= 12; ++a)
        for (int b = 1; b < a; ++b)
            EXPECT_GT(differing(frame("once", a), frame("once", b)), 50u) << a << " " << b;

    // Twice round: the frame after the last of the first turn is the first.
    ASSERT_EQ(graftal("animate -q " + two_steps + few_pixels + "--frames 4 --turn 720 -o twice").status, 0);
    for (int i = 1; i <= 2; ++i) {
        EXPECT_EQ(differing(frame("twice", i), frame("twice", i + 2)), 0u) << i;
        EXPECT_EQ(differing(frame("twice", i), frame("once", 6 * i - 5)), 0u) << "framed alike";
    }
    EXPECT_EQ(files(), "once twice");
    EXPECT_EQ(temporary_files(), "");
}

TEST_F(Animate, PlantGrowsInThePicture) {
    ASSERT_EQ(
        graftal("animate -q " + weed + few_pixels + "--steps 1..4 --frames 4 -o growth.png --keep-frames")
            .status,
        0);
    EXPECT_EQ(files(), "growth.frames growth.png");
    std::uint64_t covered = 0;
    for (int i = 1; i <= 4; ++i) {
        const Image image = frame("growth.frames", i);
        Image empty = image; // the corner shows the background
        for (std::size_t sample = 0; sample < empty.pixels.size(); ++sample)
            empty.pixels[sample] = image.pixels[sample % 3];
        const std::uint64_t now = differing(image, empty);
        EXPECT_GT(now, covered + covered / 2) << i;
        covered = now;
    }
    const std::string animation = read("growth.png");
    const auto chunks = png_chunks(animation);
    ASSERT_TRUE(chunks);
    EXPECT_EQ(std::count_if(chunks->begin(), chunks->end(), [](auto& chunk) { return chunk.type == "fcTL"; }),
              4);
    EXPECT_THAT(animation, HasSubstr("--steps 1..4")) << "says which command made it";
    EXPECT_EQ(differing(picture("growth.png"), frame("growth.frames", 1)), 0u);
}

/// Four times as many frames are far less apart each, those at whole steps too, where parts are born.
TEST_F(Animate, PlantsWithAgesGrowWithoutJumps) {
    const std::string herb = "'" + source_path("scenes/plants/growing_herb.lsys") + "' ";
    const auto largest_change = [&](int frames) {
        EXPECT_EQ(graftal(fmt::format(
                              "animate -q {}--steps 4..7 --frames {} --size 96x72 --engine native -o herb{}",
                              herb, frames, frames))
                      .status,
                  0);
        double most = 0;
        for (int i = 1; i < frames; ++i)
            most = std::max(most, compare_images(frame(fmt::format("herb{}", frames), i),
                                                 frame(fmt::format("herb{}", frames), i + 1))
                                      .rms);
        return most;
    };
    const double coarse = largest_change(13);
    EXPECT_GT(coarse, 0.01);
    EXPECT_LT(largest_change(49), 0.45 * coarse);
}

TEST_F(Animate, ValuesOfModelsAreSwept) {
    write("weed.lsys",
          "let a = 20\nlsys weed {\n  angle a\n  steps 3\n  axiom F\n  F -> FF-[-F+F]+[+F-F]\n}\n");
    ASSERT_EQ(graftal("animate -q weed.lsys --set a=10..40 --frames 3 -o weed" + few_pixels).status, 0);
    ASSERT_EQ(graftal("animate -q " + tree + "--set levels=1..2:1 --frames 4 -o tree" + few_pixels).status,
              0);
    EXPECT_GT(differing(frame("weed", 1), frame("weed", 2)), 10u);
    EXPECT_GT(differing(frame("weed", 2), frame("weed", 3)), 10u);
    for (const int i : {1, 3})
        EXPECT_EQ(differing(frame("tree", i), frame("tree", i + 1)), 0u)
            << "each whole number has two frames";
    EXPECT_GT(differing(frame("tree", 2), frame("tree", 3)), 10u);
}

TEST_F(Animate, SweepsRunTogetherWithTheCamera) {
    write("dust.inst", dust);
    const RunResult result =
        graftal("animate -q dust.inst --steps 1..2 --set k=0.2..0.3 --turn 90 --ease smooth "
                "--camera 'angle=60..30 look_at=0,0,0..1,0,0' --frames 3 -o a" +
                few_pixels);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_GT(differing(frame("a", 1), frame("a", 2)), 10u);
    EXPECT_GT(differing(frame("a", 2), frame("a", 3)), 10u);
    // From A to A, and more frames than whole numbers.
    ASSERT_EQ(graftal("animate -q dust.inst --steps 2..2 --frames 2 -o b" + few_pixels).status, 0);
    EXPECT_EQ(differing(frame("b", 1), frame("b", 2)), 0u);
    ASSERT_EQ(graftal("animate -q dust.inst --steps 1..9 --frames 1 -o c" + few_pixels).status, 0);
    EXPECT_EQ(files_in("c"), "frame_0001.png\n");
    const RunResult shorter = graftal("animate dust.inst --steps 2..2 --frames 1 -o b" + few_pixels);
    EXPECT_THAT(shorter.err, HasSubstr("graftal: 'b' also holds 1 frame of another animation\n"));
}

TEST_F(Animate, TheLensOpensAndItsFocusMoves) {
    write("ball.inst", "object a { sphere }\n");
    const std::string film = "animate -q ball.inst --frames 2 --engine native -o ";
    const std::string at = " --camera 'location=0,0,9 look_at=0,0,0 angle=30 ";
    ASSERT_EQ(graftal(film + "a" + at + "aperture=0..2 focus=0,0,5'" + few_pixels).status, 0);
    EXPECT_GT(differing(frame("a", 1), frame("a", 2)), 10u);
    ASSERT_EQ(graftal(film + "b" + at + "aperture=2 focus=0,0,1..0,0,7'" + few_pixels).status, 0);
    EXPECT_GT(differing(frame("b", 1), frame("b", 2)), 10u);
    const RunResult flat =
        graftal("render ball.inst -q --engine native -o c.png --camera 'width=3 aperture=1'" + small);
    EXPECT_THAT(flat.err, HasSubstr("warning: the camera has no lens here: all of the picture is sharp"));
}

TEST_F(Animate, ShutterShowsTheMeanOfItsMoments) {
    // A bright bar goes a quarter of the picture in a frame: exposed all the time, it leaves an even trace.
    write("bar.inst",
          "let x = 0\nlet speed = 1\ncamera { location: 2, 0, 9  look_at: 2, 0, 0  orthographic  width: 4 }\n"
          "background { zenith: 0, 0, 0  horizon: 0, 0, 0 }\n"
          "material lamp { color: 1, 1, 1  ambient: 0  diffuse: 0  specular: 0  emission: 0.8 }\n"
          "object a { cube  scale: 0.125, 2, 0.1  translate: x + 0.14, 0, 0  material: lamp }\n");
    const std::string bar =
        "bar.inst --engine native --plain-light -q --antialias off --size 32x8 --frames 5 --set x=0..4 ";
    EXPECT_EQ(graftal("animate " + bar + "-o sharp/").status, 0);
    EXPECT_EQ(graftal("animate " + bar + "--shutter 1 -o blurred/").status, 0);
    EXPECT_EQ(graftal("animate " + bar + "--shutter 1 --threads 1 -o again/").status, 0);
    const auto at = [](const Image& image, int x) {
        return image.pixels[static_cast<std::size_t>(3 * (4 * image.width + x))];
    };
    const Image sharp = picture("sharp/frame_0002.png"), blurred = picture("blurred/frame_0002.png");
    EXPECT_EQ(at(sharp, 8), at(sharp, 9));
    EXPECT_GT(at(sharp, 8), 0.8);
    EXPECT_EQ(at(sharp, 10), 0);
    EXPECT_EQ(at(blurred, 7), 0);
    for (int x = 10; x < 16; ++x) // 0.8 of the light, a fourth of the time
        EXPECT_NEAR(at(blurred, x), srgb_encoded(0.2f), 0.01) << x;
    EXPECT_EQ(read("blurred/frame_0002.png"), read("again/frame_0002.png"));
    EXPECT_EQ(graftal("animate bar.inst --shutter 2").status, 2);
}

TEST_F(Animate, GifIsTheDefaultAndQuietIsSilent) {
    const RunResult result = shell("\"$graftal\" animate --quiet --frames 2 " + two_steps + few_pixels);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out + result.err, "");
    EXPECT_EQ(files(), "pound_sign.gif");
    EXPECT_EQ(picture("pound_sign.gif").width, 48);
}

TEST_F(Animate, KilledPovrayIsStatusThreeAndTheNextRunGoesOn) {
    ASSERT_EQ(graftal("animate -q " + two_steps + few_pixels + "--frames 4 -o whole").status, 0);
    write_povray(3, "kill -9 $$");
    const std::string command = two_steps + few_pixels + "--frames 4 -o a.png --keep-frames";
    const RunResult killed = with_povray(command);
    EXPECT_EQ(killed.status, 3);
    EXPECT_EQ(killed.err, "graftal: at frame 3 of 4:\n"
                          "graftal: the system killed POV-Ray; it may have run out of memory (use a smaller "
                          "--memory for a smaller scene)\n"
                          "graftal: 2 of 4 frames are in 'a.frames'; the same command goes on from there\n");
    EXPECT_EQ(files(), "a.frames bin whole");
    EXPECT_EQ(files_in("a.frames"), "frame_0001.png frame_0002.png\n");
    EXPECT_EQ(temporary_files(), "");
    const RunResult rest = graftal("animate " + command);
    EXPECT_EQ(rest.status, 0);
    EXPECT_THAT(rest.err, HasSubstr("; 2 were there before; "));
    expect_same_frames("whole", "a.frames", 4);
    const RunResult again = graftal("animate " + command + " --fps 10");
    EXPECT_THAT(again.err, HasSubstr("4 frames, 10 per second; 4 were there before; "));
}

TEST_F(Animate, SignalsStopCleanlyAndTheNextRunGoesOn) {
    for (const auto& [name, number] : {std::pair("INT", SIGINT), {"TERM", SIGTERM}}) {
        write_povray(2, fmt::format("kill -{} $PPID; exec sleep 20", name));
        const RunResult stopped = with_povray(two_steps + few_pixels + "--frames 2 -o a.gif");
        EXPECT_EQ(stopped.status, 128 + number);
        EXPECT_THAT(stopped.err, AllOf(HasSubstr("graftal: interrupted\n"),
                                       HasSubstr("1 of 2 frames are in 'a.frames'; the "
                                                 "same command goes on from there\n")));
        EXPECT_EQ(files(), "a.frames bin");
        EXPECT_EQ(temporary_files(), "");
        const RunResult rest = graftal("animate " + two_steps + few_pixels + "--frames 2 -o a.gif");
        EXPECT_EQ(rest.status, 0);
        EXPECT_THAT(rest.err, HasSubstr("; 1 were there before; "));
        EXPECT_EQ(files(), "a.gif bin");
        std::filesystem::remove(path("a.gif"));
    }
}

TEST_F(Animate, OnlyFramesOfTheSameMakingCount) {
    write("leaf.inst", "object leaf {\n    union: sphere scale: 0.5\n}\n");
    write("dust.inst",
          "use leaf = \"leaf.inst\"\nobject dust {\n    union: leaf, cube translate: 1, 0, 0\n}\n");
    write_quick_povray();
    const auto redrawn = [&](const std::string& options) {
        const RunResult result = with_povray("dust.inst --frames 3 -o a" + few_pixels + options);
        EXPECT_EQ(result.status, 0) << result.err;
        const std::size_t at = result.err.find(" were there before");
        return at == std::string::npos ? 3 : 3 - (result.err[at - 1] - '0');
    };
    EXPECT_EQ(redrawn(""), 3);
    EXPECT_EQ(redrawn(""), 0);
    EXPECT_EQ(redrawn("--threads 1 --fps 5 --time"), 0) << "no difference to the frames";
    EXPECT_EQ(redrawn("--turn 180 --error 2"), 3);
    EXPECT_EQ(redrawn(""), 3);
    write("leaf.inst", "object leaf {\n    union: sphere scale: 0.6\n}\n");
    EXPECT_EQ(redrawn(""), 3) << "a used file was changed";
    const std::string whole = read("a/frame_0002.png");
    write("a/frame_0002.png", whole.substr(0, whole.size() / 2));
    EXPECT_EQ(redrawn(""), 1) << "a frame is half a file";
    EXPECT_EQ(read("a/frame_0002.png"), whole);
    std::filesystem::remove(path("a/frame_0001.png"));
    EXPECT_EQ(redrawn(""), 1);
}

TEST_F(Animate, FaultOfOneFrameNamesIt) {
    write("dust.inst", dust);
    const RunResult result = graftal("animate dust.inst --set k=0.2..1.1 --frames 10 -o a" + few_pixels);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err,
                AllOf(StartsWith("graftal: at frame 9 of 10 (--set k=1):\ndust.inst:3:15: error: "),
                      HasSubstr("does not contract")));
    EXPECT_EQ(files(), "dust.inst") << "found before anything is drawn";
    // Frames of an earlier run stay.
    ASSERT_EQ(graftal("animate -q dust.inst --set k=0.2..0.3 --frames 2 -o a" + few_pixels).status, 0);
    EXPECT_EQ(graftal("animate dust.inst --set k=0.2..1.1 --frames 2 -o a" + few_pixels).status, 1);
    EXPECT_EQ(files_in("a"), "frame_0001.png frame_0002.png\n");
    EXPECT_EQ(graftal("animate dust.inst --set nothing=1..2 --frames 2" + few_pixels).status, 1);
}

TEST_F(Animate, EnvironmentIsStatusThree) {
    write("taken", "mine");
    write("b.frames", "mine");
    std::filesystem::create_directory(path("c.gif"));
    const std::string before = files();
    for (const std::string output : {"taken", "taken/", "taken/a.gif", "no/such/a.gif", "b.gif", "c.gif"}) {
        const RunResult result = graftal("animate " + two_steps + few_pixels + "--frames 2 -o " + output);
        EXPECT_EQ(result.status, 3) << output;
        EXPECT_THAT(result.err, AllOf(StartsWith("graftal: cannot "), HasSubstr(output.substr(0, 1))))
            << output;
        EXPECT_EQ(files(), before) << output;
    }
    EXPECT_EQ(read("taken") + read("b.frames"), "minemine");
    EXPECT_EQ(graftal("animate none.inst").status, 3);
    EXPECT_EQ(shell("PATH=/nowhere \"$graftal\" animate --engine povray " + two_steps + "-o a.gif").status,
              3);
    EXPECT_EQ(files(), before);
}

TEST_F(Animate, VideosAreMadeByTheProgramFfmpeg) {
    std::filesystem::create_directory(path("bin"));
    ASSERT_EQ(shell("ln -s $(command -v povray) bin/povray").status, 0);
    const std::string run =
        "PATH=\"$PWD/bin\" \"$graftal\" animate " + two_steps + few_pixels + "--frames 2 -o a.mp4";
    const RunResult missing = shell(run);
    EXPECT_EQ(missing.status, 3);
    EXPECT_EQ(missing.err,
              "graftal: cannot find the program 'ffmpeg'; install it with 'apt-get install ffmpeg', or make "
              "an animated .png or .gif\n");
    EXPECT_EQ(files(), "bin");
    write("bin/ffmpeg",
          "#!/bin/sh\necho broken >&2; for name; do :; done; echo half >\"${name#file:}\"; exit 4\n");
    const RunResult broken = shell("/bin/chmod +x bin/ffmpeg; " + run);
    EXPECT_EQ(broken.status, 3);
    EXPECT_THAT(broken.err, HasSubstr("graftal: 'ffmpeg' failed with status 4: broken\n"
                                      "graftal: 2 of 2 frames are in 'a.frames'; the same command goes on"));
    EXPECT_EQ(files(), "a.frames bin");
    write("bin/ffmpeg", "#!/bin/sh\nfor name; do :; done; echo \"$*\" >\"${name#file:}\"\n");
    const RunResult made = shell("/bin/chmod +x bin/ffmpeg; " + run);
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_THAT(read("a.mp4"), AllOf(HasSubstr("-framerate 2500/100"), HasSubstr("-i frame_%04d.png")));
    EXPECT_EQ(files(), "a.mp4 bin");
}

TEST_F(Animate, VideosPlay) {
    for (const std::string name : {"a.mp4", "b%d.webm"}) {
        ASSERT_EQ(graftal("animate -q " + two_steps + few_pixels + "--frames 2 --fps 12.5 -o " + name).status,
                  0);
        const RunResult probe = shell(
            "ffprobe -v error -count_frames -show_entries stream=r_frame_rate,nb_read_frames,width " + name);
        EXPECT_THAT(probe.out, AllOf(HasSubstr("width=48\n"), HasSubstr("r_frame_rate=25/2\n"),
                                     HasSubstr("nb_read_frames=2\n")));
    }
    ASSERT_EQ(graftal("animate -q " + two_steps + few_pixels + "--frames 2 -o c.png --keep-frames").status,
              0);
    ASSERT_EQ(shell("ffmpeg -v error -i c.png -vsync passthrough c_%d.png").status, 0);
    for (int i = 1; i <= 2; ++i)
        EXPECT_EQ(differing(picture(fmt::format("c_{}.png", i)), frame("c.frames", i)), 0u) << i;
}

/// Every command of docs/animate.md works; one small frame of each is enough.
TEST_F(Animate, CommandsOfThePageWork) {
    const std::string mark = "\n    graftal animate ";
    std::string page;
    ASSERT_TRUE(read_text(source_path("docs/animate.md"), page).ok());
    ASSERT_EQ(shell("ln -s '" + source_path("scenes") + "' scenes").status, 0);
    write_quick_povray();
    int count = 0;
    for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1), ++count) {
        const std::size_t begin = at + mark.size();
        const std::string words = page.substr(begin, page.find('\n', begin) - begin);
        const RunResult result =
            with_povray("-q " + words + " --frames 2" + few_pixels + "--error 4" +
                        (words.find("--engine") == std::string::npos ? " --engine auto" : ""));
        EXPECT_EQ(result.status, 0) << words << "\n" << result.err;
    }
    EXPECT_GE(count, 8);
}

} // namespace
} // namespace graftal
