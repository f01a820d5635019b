// The public face of the library. It is the only header of graftal here, apart from a folder for the test.

#include <graftal/model.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/system/temporary_directory.h"

namespace graftal::v1 {
namespace {

const char* const crystal = "let share = 1/2\n"
                            "rifs crystal {\n"
                            "  map n { scale share  translate <0, 1/2, 0> }\n"
                            "  map e { scale 1/2  translate <1/2, 0, 0> }\n"
                            "  terminal sphere\n"
                            "}\n";

Model small_crystal() {
    Model model = Model::from_text("crystal.rifs", crystal);
    model.size(24, 16);
    model.threads(1);
    return model;
}

TEST(LibraryModel, AParameterChangesThePictureAndBackAgain) {
    Model model = small_crystal();
    const auto thin = model.render();
    ASSERT_TRUE(thin) << thin.text();
    EXPECT_EQ(thin->width, 24);
    EXPECT_EQ(thin->rgb.size(), 3u * 24 * 16);
    model.set("share", 0.7);
    const auto thick = model.render();
    ASSERT_TRUE(thick) << thick.text();
    EXPECT_NE(thick->rgb, thin->rgb);
    model.unset("share");
    const auto again = model.render();
    ASSERT_TRUE(again) << again.text();
    EXPECT_EQ(again->rgb, thin->rgb);
}

TEST(LibraryModel, SmoothsByDepthsFromOneToNine) {
    const auto drawn = [](int depth) {
        Model model = Model::from_text("disc.inst", "light { sun: 1,2,3 }\nobject disc { sphere }\n");
        model.size(1, 1);
        model.threads(1);
        model.antialias(depth);
        const auto picture = model.render();
        EXPECT_TRUE(picture) << picture.text();
        return picture ? picture->rgb : std::vector<std::uint8_t>();
    };
    for (const int depth : {0, -1, -2'000'000'000})
        EXPECT_EQ(drawn(depth), drawn(1)) << depth;
    for (const int depth : {10, 33, 2'000'000'000})
        EXPECT_EQ(drawn(depth), drawn(9)) << depth;
}

/// Nothing of the library is shared between models: the thread sanitizer sees to it.
TEST(LibraryModel, TwoModelsWorkInTwoThreads) {
    const char* const tree = "lsys tree {\n  angle 25\n  steps 5\n  axiom A(1)\n"
                             "  A(s) -> F(s)[+A(s*0.8)][-A(s*0.7)]\n}\nsky { bounces: 1 }\n";
    const auto pictures_of = [](const char* name, const char* text) {
        Model model = Model::from_text(name, text);
        model.size(24, 16);
        model.threads(2);
        std::vector<std::vector<std::uint8_t>> pictures;
        for (const double angle : {20.0, 30.0, 40.0}) {
            model.camera({.location = {}, .look_at = {}, .up = {}, .angle_deg = angle});
            const auto picture = model.render();
            EXPECT_TRUE(picture) << picture.text();
            if (picture) pictures.push_back(picture->rgb);
            EXPECT_TRUE(model.stats());
        }
        return pictures;
    };
    const auto crystals = pictures_of("crystal.rifs", crystal), trees = pictures_of("tree.lsys", tree);
    std::vector<std::vector<std::uint8_t>> found;
    std::thread other([&] { found = pictures_of("crystal.rifs", crystal); });
    EXPECT_EQ(pictures_of("tree.lsys", tree), trees);
    other.join();
    EXPECT_EQ(found, crystals);
}

TEST(LibraryModel, TilesCoverThePictureInEachPass) {
    Model model = small_crystal();
    std::vector<int> seen; // by pixel, in the last pass
    int pass = -1;
    const auto drawn = model.draw([&](const Tile& tile) {
        if (tile.pass != pass) {
            EXPECT_TRUE(pass < 0 || seen == std::vector<int>(24 * 16, 1)) << pass;
            seen.assign(24 * 16, 0);
            pass = tile.pass;
        }
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x) {
                ++seen[static_cast<std::size_t>((tile.y + y) * 24 + tile.x + x)];
                EXPECT_GE(tile.rgb[static_cast<std::size_t>(y) * tile.row_floats + 3 * x], 0);
            }
    });
    ASSERT_TRUE(drawn) << drawn.text();
    EXPECT_GE(pass, 0);
    EXPECT_EQ(seen, std::vector<int>(24 * 16, 1));
}

TEST(LibraryModel, FilesInMemoryLieOverThoseOfTheDisk) {
    Model model = Model::from_text("m.inst", "use part = \"nowhere/part.inst\"\nobject m { part }\n");
    EXPECT_FALSE(model.stats());
    model.put_file("nowhere/part.inst", "object part { sphere scale: 3 }\n");
    model.reload();
    const auto stats = model.stats();
    ASSERT_TRUE(stats) << stats.text();
    EXPECT_NEAR(stats->most->x, 3, 1e-9);
    EXPECT_EQ(model.runs().parsed, 2u);
}

TEST(LibraryModel, ParametersHaveTheirValuesAndPlaces) {
    const std::string text =
        "let a = 2, b = -a/2\n"
        "lsys tree {\n  inner k = 0.25\n  angle 20 + a\n  steps 3\n  axiom F\n  F -> F[+F]F\n}\n";
    Model model = Model::from_text("tree.lsys", text);
    model.set("a", 5);
    const auto parameters = model.parameters();
    ASSERT_TRUE(parameters) << parameters.text();
    std::string found;
    for (const Parameter& parameter : *parameters)
        found += parameter.name + "=" + std::to_string(parameter.value).substr(0, 5) + " '" +
                 text.substr(parameter.begin, parameter.end - parameter.begin) + "' " +
                 (parameter.literal ? "literal" : "computed") + (parameter.most ? " in a range" : "") + "\n";
    EXPECT_EQ(found, "a=5.000 '2' literal\n"
                     "b=-2.50 '-a/2' computed\n"
                     "k=0.250 '0.25' literal in a range\n"
                     "angle=25.00 '20 + a' computed\n"
                     "steps=3.000 '3' literal\n");
    EXPECT_EQ(parameters->at(2).line, 3u);
}

TEST(LibraryModel, SaysWhatItKnowsOfAModel) {
    Model model = small_crystal();
    const auto stats = model.stats();
    ASSERT_TRUE(stats) << stats.text();
    EXPECT_EQ(stats->objects, 4u); // n, e, crystal and the sphere
    ASSERT_TRUE(stats->dimension);
    EXPECT_NEAR(*stats->dimension, 1, 1e-9);
    EXPECT_NE(stats->json.find("\"objects\""), std::string::npos);
}

TEST(LibraryModel, AMessageHasItsPlace) {
    Model model = Model::from_text("m.inst", "object m { instance: sphre }\n");
    const auto picture = model.render();
    EXPECT_FALSE(picture);
    EXPECT_FALSE(picture.cancelled);
    ASSERT_EQ(picture.messages.size(), 1u);
    const Message& message = picture.messages.front();
    EXPECT_EQ(message.file, "m.inst");
    EXPECT_EQ(message.line, 1u);
    EXPECT_EQ(message.column, 22u);
    EXPECT_EQ(picture.text().find("m.inst:1:22: error: unknown object 'sphre'\n"), 0u) << picture.text();
    model.edit("object m { instance: sphere }\n");
    EXPECT_TRUE(model.stats());
}

TEST(LibraryModel, WhatIsCancelledLeavesNoFileAndCanBeAskedAgain) {
    TemporaryDirectory folder;
    ASSERT_TRUE(folder.create().ok());
    Model model = small_crystal();
    bool cancels = true;
    model.on_progress([&](std::string_view, std::optional<double>) {
        if (cancels) model.cancel();
    });
    const std::string path = folder.path() + "/a.png";
    const auto given_up = model.render_to(path);
    EXPECT_FALSE(given_up);
    EXPECT_TRUE(given_up.cancelled);
    EXPECT_TRUE(given_up.messages.empty()) << given_up.text();
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    cancels = false;
    const auto drawn = model.render_to(path);
    ASSERT_TRUE(drawn) << drawn.text();
    EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(LibraryModel, WritesFilesForOtherPrograms) {
    TemporaryDirectory folder;
    ASSERT_TRUE(folder.create().ok());
    Model model = small_crystal();
    model.steps(3);
    const std::string path = folder.path() + "/a.stl";
    const auto whole = model.export_to(path);
    ASSERT_TRUE(whole) << whole.text();
    EXPECT_EQ(std::filesystem::file_size(path) % 50, 84 % 50); // a head, and 50 bytes a triangle
    EXPECT_EQ(model.export_to(path, {.plotter = true}).text(), "error: plotter is for .svg, not for .stl\n");
    EXPECT_FALSE(model.export_to(folder.path() + "/a.usda", {.levels = 1}));
    const auto refused = model.export_to(folder.path() + "/b.stl", {.most_bytes = 100});
    EXPECT_NE(refused.text().find("would have"), std::string::npos) << refused.text();
    EXPECT_FALSE(std::filesystem::exists(folder.path() + "/b.stl"));
}

TEST(LibraryModel, AFileThatWouldBeTooLargeIsWrittenCoarser) {
    TemporaryDirectory folder;
    ASSERT_TRUE(folder.create().ok());
    Model model = small_crystal();
    const std::uint64_t most = 20'000;
    const std::string path = folder.path() + "/a.stl";
    const auto fitted = model.export_to(path, {.most_bytes = most});
    ASSERT_TRUE(fitted) << fitted.text();
    EXPECT_LE(std::filesystem::file_size(path), most);
    EXPECT_NE(fitted.text().find("graftal leaves out parts smaller than "), std::string::npos);
    // Messages name the library's functions, never options of the command line.
    EXPECT_NE(fitted.text().find("choose with error_px() how much"), std::string::npos) << fitted.text();
    EXPECT_EQ(fitted.text().find("--"), std::string::npos) << fitted.text();
    // Whoever asks for an error gets that one, or nothing.
    model.error_px(0.01);
    EXPECT_FALSE(model.export_to(path, {.most_bytes = most}));
}

TEST(LibraryModel, StepsMayLieBetweenTwo) {
    const char* const growing = "lsys g {\n axiom A\n A -> F A\n interpret {\n F -> f(age)@O(1)\n }\n}\n";
    Model model = Model::from_text("g.lsys", growing);
    model.time(7.5);
    const auto stats = model.stats();
    ASSERT_TRUE(stats) << stats.text();
    EXPECT_NE(stats->json.find("\"time\": 7.5"), std::string::npos) << stats->json;
    model.time(7);
    const auto whole = model.stats();
    ASSERT_TRUE(whole) << whole.text();
    EXPECT_NE(whole->json.find("\"time\": 7.0"), std::string::npos) << whole->json;
}

TEST(LibraryModel, TheLensBlursWhatIsOutOfFocus) {
    Model model = small_crystal();
    model.camera({.location = Vector{0, 0, 4}, .look_at = Vector{0, 0, 0}, .angle_deg = 40});
    const auto sharp = model.render();
    model.lens(0.5, Vector{0, 0, 3});
    const auto blurred = model.render();
    ASSERT_TRUE(sharp && blurred) << blurred.text();
    EXPECT_NE(sharp->rgb, blurred->rgb);
}

TEST(LibraryModel, RefusesNamesOfNoPicture) {
    Model model = small_crystal();
    EXPECT_FALSE(model.render_to("a.bmp"));
    EXPECT_FALSE(model.compile_to("a.scene"));
    EXPECT_FALSE(model.export_to("a.png"));
    EXPECT_EQ(model.render_to("a.bmp").text(), "error: 'a.bmp' ends neither in .png nor in .exr\n");
}

} // namespace
} // namespace graftal::v1
