// The same model gives the same scene to the last byte, and the same picture whatever the threads.

#include <filesystem>

#include <gtest/gtest.h>

#include "compiler/povray/emit/scene.h"
#include "tests/image/drawing.h"
#include "tests/image/random_model.h"
#include "tests/image/render_helpers.h"

namespace graftal {
namespace {

/// All that is written: the text, then the palettes.
std::string written(const std::optional<CompiledModel>& model, bool include) {
    if (!model) return {};
    std::string text;
    std::vector<PaletteImage> palettes;
    const TextSink sink = [&](std::string_view piece) {
        text += piece;
        return true;
    };
    EXPECT_TRUE(
        emit_povray(model->cut, model->view, {.scene_name = "model", .include = include}, sink, palettes));
    for (const PaletteImage& palette : palettes) {
        text += palette.file_name;
        text.append(reinterpret_cast<const char*>(palette.pixels.data()),
                    palette.pixels.size() * sizeof(Rgb));
    }
    return text;
}

TEST(Determinism, ScenesOfTheProject) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(GRAFTAL_SOURCE_DIR "/scenes")) {
        if (!entry.is_regular_file() ||
            (entry.path().extension() != ".rifs" && entry.path().extension() != ".inst"))
            continue;
        const auto folder = entry.path().parent_path().filename();
        // Orbits have no graph; whole landscapes take minutes, and are made of what is here.
        if (folder == "orbits" || folder == "plants" || folder == "showpieces") continue;
        const std::string path = std::filesystem::relative(entry.path(), GRAFTAL_SOURCE_DIR).string();
        SCOPED_TRACE(path);
        StageOptions options;
        options.view.size = {160, 90};
        const std::string first = written(compile_file(path, options), false);
        EXPECT_FALSE(first.empty());
        EXPECT_TRUE(first == written(compile_file(path, options), false)) << "the scenes differ";
        ++scenes;
    }
    EXPECT_GT(scenes, 10);
}

TEST(Determinism, ModelsAtRandom) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const StageOptions options = whole({160, 90}, 5);
        for (const bool include : {false, true}) {
            const auto rifs = [&] {
                return written(compile_text("a.rifs", random_rifs(seed), options), include);
            };
            const auto inst = [&] {
                return written(compile_text("a.inst", random_inst(seed), options), include);
            };
            EXPECT_TRUE(rifs() == rifs());
            EXPECT_TRUE(inst() == inst());
            EXPECT_FALSE(inst().empty());
        }
    }
}

TEST(Determinism, PicturesDoNotDependOnThreads) {
    RenderOptions options = measured(160, 120);
    options.antialias = 2;
    options.compile.lower.steps = 6;
    options.threads = 1;
    const Image one = render_model_file("scenes/hart/elm.inst", options);
    for (const int threads : {2, 5}) {
        options.threads = threads;
        EXPECT_EQ(compare_images(one, render_model_file("scenes/hart/elm.inst", options)).differing, 0u);
    }
}

} // namespace
} // namespace graftal
