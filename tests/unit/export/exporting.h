#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "runtime/export/export_model.h"
#include "runtime/image_files/texture_store.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

/// A model's text on its way to a scene or a file, in a folder of its own.
class Exporting {
  public:
    Exporting(const std::string& name, const std::string& text) {
        EXPECT_TRUE(folder_.create().ok());
        EXPECT_TRUE(write_text(path(name), text).ok());
        session_.emplace(path(name), Keep::for_views);
        options.compile.view.light = DefaultLight::plain;
    }

    std::string path(const std::string& name) const { return folder_.path() + "/" + name; }

    /// As the command would make it, with the error only if `options.error_asked`.
    std::optional<UnfoldedScene> scene(SceneMeshes meshes, const SceneLimits& limits = {}) {
        StageOptions stages = options.compile;
        stages.detail.keeps_objects = true;
        if (!options.error_asked) stages.detail.error_px = 0;
        viewed = session_->viewed(stages, compilation);
        const auto prepared = viewed ? session_->prepared(stages, compilation) : nullptr;
        if (!prepared) return std::nullopt;
        return build_scene(*prepared, viewed->view, resolved(stages.detail, *viewed), meshes, {}, limits,
                           no_control(), compilation.diagnostics);
    }

    void set_cancel(CancelFlag cancel) { session_->set_control({std::move(cancel), {}}); }

    /// The names in the folder, separated by blanks.
    std::string files() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            names.insert(entry.path().filename().string());
        std::string text;
        for (const std::string& name : names)
            text += (text.empty() ? "" : " ") + name;
        return text;
    }

    /// What was written, or nothing.
    std::optional<std::string> to(const std::string& name) {
        options.file.output = path(name);
        return export_model(*session_, options, compilation);
    }

    std::string read(const std::string& name) const {
        std::string text;
        EXPECT_TRUE(read_text(path(name), text).ok()) << name;
        return text;
    }

    std::string said() const {
        return compilation.diagnostics.render(compilation.sources) + compilation.status.message();
    }

    ExportModelOptions options;
    Compilation compilation;
    std::shared_ptr<const ViewedModel> viewed;

  private:
    TemporaryDirectory folder_;
    std::optional<PictureSession> session_;
};

inline const std::string cubes = // without end, tinted; one map shears
    "rifs m {\n"
    "  map a { scale 1/2 translate <-1/2, -1/2, 0> tint rgb <1, 0, 0> 0.5 }\n"
    "  map b { scale 1/3 rotate z 30 translate <1/2, 0, 1/2> tint rgb <0, 1, 0> 0.25 }\n"
    "  map c { rotate x 50 scale <0.4, 0.3, 0.5> rotate y 20 translate <0, 1/2, 0> }\n"
    "  terminal cube\n"
    "}\n";

inline const std::string shrub = // ends, with materials and tints
    "material bark { color: 0.4, 0.3, 0.2 }\n"
    "material leaf { color: 0.1, 0.6, 0.2 }\n"
    "object twig {\n"
    "  cylinder scale: 0.05, 1, 0.05 material: bark\n"
    "  sphere scale: 0.2, 0.05, 0.1 translate: 0.2, 1, 0 material: leaf tint: 1, 0, 0, 0.3\n"
    "  torus scale: 0.1 translate: 0, 0.5, 0\n"
    "}\n"
    "object branch {\n"
    "  twig\n"
    "  twig scale: 0.5, 0.7, 0.5 rotate: z, 40 translate: 0, 0.4, 0\n"
    "  twig scale: -0.5, 0.7, 0.5 rotate: x, 40 translate: 0, 0.7, 0 tint: 0, 0, 1, 0.5\n"
    "}\n"
    "object shrub {\n"
    "  branch\n"
    "  branch rotate: y, 120 scale: 1, 1.2, 0.8\n"
    "  branch rotate: y, 240 scale: 0.7\n"
    "}\n";
constexpr int leaves_of_shrub = 3 + 9 + 27; // all that nobody else places

/// Puts the picture bark.png beside the model.
inline void write_bark(const Exporting& exporting) {
    Texture picture;
    picture.width = picture.height = 1;
    picture.texels = {{{200, 100, 50}, false}};
    PendingFile file(exporting.path("bark.png"));
    EXPECT_TRUE(write_texture(file, picture).ok());
    EXPECT_TRUE(file.commit().ok());
}

} // namespace graftal
