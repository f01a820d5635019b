#include "tests/image/render_helpers.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

namespace {

Image render_path(const std::string& path, RenderOptions options, const std::string& folder,
                  PovrayReport* report) {
    options.output = folder + "/picture.exr";
    if (options.format == SampleFormat::srgb8) options.output = folder + "/picture.png";
    Compilation compilation;
    PictureSession session(path);
    const std::optional<PovrayReport> rendered = render_by_povray(session, options, compilation);
    Image image;
    EXPECT_TRUE(rendered.has_value())
        << compilation.diagnostics.render(compilation.sources) << compilation.status.message();
    if (!rendered) return image;
    if (report) *report = *rendered;
    const Status status = read_image(options.output, image);
    EXPECT_TRUE(status.ok()) << status.message();
    return image;
}

} // namespace

RenderOptions measured(int width, int height) {
    RenderOptions options;
    options.compile.view.size = {width, height};
    options.format = SampleFormat::linear16;
    options.antialias = std::nullopt;
    return options;
}

Image render_model_text(const std::string& name, const std::string& text, const RenderOptions& options,
                        PovrayReport* report) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    std::error_code ignored;
    std::filesystem::create_directory_symlink(GRAFTAL_SOURCE_DIR "/scenes", directory.path() + "/scenes",
                                              ignored);
    const std::string path = directory.path() + "/" + std::filesystem::path(name).filename().string();
    EXPECT_TRUE(write_text(path, text).ok());
    return render_path(path, options, directory.path(), report);
}

Image render_model_file(const std::string& path, const RenderOptions& options, PovrayReport* report) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    return render_path(GRAFTAL_SOURCE_DIR "/" + path, options, directory.path(), report);
}

} // namespace graftal
