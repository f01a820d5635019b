#include "tests/image/drawing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "runtime/povray/povray.h"
#include "runtime/render/scene_files.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

namespace {

std::optional<CompiledModel> compile_path(const std::string& path, const StageOptions& options,
                                          const CutOptions& cut) {
    Compilation compilation;
    const auto model = [&] {
        Session session(path, disk_files());
        return compile_scene(session, options, compilation, cut);
    }();
    EXPECT_TRUE(model) << compilation.diagnostics.render(compilation.sources) << compilation.status.message();
    return model ? std::optional(*model) : std::nullopt;
}

Image picture_of(const std::string& directory, ImageSize size, SampleFormat format,
                 std::optional<int> antialias = {}) {
    PovrayJob job;
    job.directory = directory;
    job.width = size.width;
    job.height = size.height;
    if (format == SampleFormat::linear16) job.format = PovrayJob::Format::linear16;
    job.antialias = antialias;
    const PovrayResult result = run_povray(job);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    Image image;
    if (!result.status.ok()) return image;
    const Status status = read_image(directory + "/" + job.picture, image);
    EXPECT_TRUE(status.ok()) << status.message();
    return image;
}

} // namespace

std::optional<CompiledModel> compile_text(const std::string& name, const std::string& text,
                                          const StageOptions& options, const CutOptions& cut) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    const std::string path = directory.path() + "/" + name;
    EXPECT_TRUE(write_text(path, text).ok());
    return compile_path(path, options, cut);
}

std::optional<CompiledModel> compile_file(const std::string& path, const StageOptions& options,
                                          const CutOptions& cut) {
    return compile_path(GRAFTAL_SOURCE_DIR "/" + path, options, cut);
}

Image draw(const CompiledModel& model, SampleFormat format, std::optional<int> antialias) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    TextureStore textures;
    const Status status = write_scene(model, directory.path() + "/scene.pov", {}, textures);
    EXPECT_TRUE(status.ok()) << status.message();
    return picture_of(directory.path(), model.view.size, format, antialias);
}

Image draw_by_hand(const CompiledModel& model, const std::string& scene, SampleFormat format) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    TextureStore textures;
    const Status status = write_scene(model, directory.path() + "/model.inc", {.include = true}, textures);
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_TRUE(write_text(directory.path() + "/scene.pov", scene).ok());
    return picture_of(directory.path(), model.view.size, format);
}

double share_covered(const Image& image) {
    const auto channels = static_cast<std::size_t>(image.channels);
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += channels)
        count += !std::equal(image.pixels.begin(), image.pixels.begin() + image.channels,
                             image.pixels.begin() + static_cast<std::ptrdiff_t>(i));
    return static_cast<double>(count * channels) / static_cast<double>(image.pixels.size());
}

void show_pigments(CompiledModel& model) {
    for (PlacementGroup& group : model.cut.groups) {
        group.material.ambient = 1;
        group.material.diffuse = group.material.specular = group.material.reflection = 0;
    }
}

StageOptions whole(ImageSize size, std::optional<unsigned> steps) {
    StageOptions options;
    options.view.size = size;
    options.view.light = DefaultLight::plain;
    options.detail.error_px = 0;
    options.lower.steps = steps;
    return options;
}

} // namespace graftal
