#include "runtime/render/scene_files.h"

#include <cerrno>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "compiler/povray/emit/scene.h"
#include "runtime/image_files/image_files.h"
#include "runtime/image_files/sky_file.h"
#include "runtime/image_files/texture_store.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

namespace {

/// The palettes of a scene, which appear with it or not at all.
class PendingPalettes {
  public:
    PendingPalettes(TextureStore& textures, const CancelFlag& cancel)
        : textures_(textures), cancel_(cancel) {}

    Status write(const std::filesystem::path& folder, const std::vector<PaletteImage>& palettes) {
        for (const PaletteImage& palette : palettes) {
            if (cancel_.raised()) return Status::failure("interrupted");
            const Status status = write(folder, palette);
            if (!status.ok()) return status;
        }
        return {};
    }

    Status commit_with(PendingFile& scene) {
        std::vector<PendingFile*> all;
        for (PendingFile& file : files_)
            all.push_back(&file);
        all.push_back(&scene);
        return commit_together(all);
    }

  private:
    Status write(const std::filesystem::path& folder, const PaletteImage& palette) {
        const PendingFile& file = files_.emplace_back((folder / palette.file_name).string());
        if (!file.status().ok()) return file.status();
        if (palette.sky) return write_sky_picture(file, *palette.sky, palette.sky_brightness);
        if (palette.texture.empty())
            return write_palette(file, palette.width, palette.height, palette.pixels);
        Status status;
        const std::shared_ptr<const Texture> texture = textures_.load(palette.texture, status);
        return texture ? write_texture(file, *texture) : status;
    }

    TextureStore& textures_;
    const CancelFlag& cancel_;
    std::deque<PendingFile> files_;
};

/// Emits to an open file. `name` is the file's, for messages; `on_text` is called before each piece is
/// written.
Status emit_to(std::FILE* file, const std::string& name, const CompiledModel& model,
               const PovrayOptions& options, std::vector<PaletteImage>& palettes, const CancelFlag& cancel,
               const std::function<void()>& on_text) {
    int reason = 0;
    const auto sink = [&](std::string_view text) {
        if (cancel.raised()) return false;
        on_text();
        errno = 0;
        if (std::fwrite(text.data(), 1, text.size(), file) == text.size()) return true;
        reason = errno;
        return false;
    };
    const bool complete = emit_povray(model.cut, model.view, options, sink, palettes);
    if (cancel.raised()) return Status::failure("interrupted");
    if (!complete) return system_failure("write", name, reason);
    return std::fflush(file) == 0 ? Status() : system_failure("write", name);
}

std::string model_name(const CompiledModel& model) {
    const std::string& path = model.model->path;
    return path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
}

Status copy_to_standard_output(std::FILE* file) {
    if (std::fseek(file, 0, SEEK_SET) != 0) return system_failure("write", "a temporary file");
    char buffer[1 << 16];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file)) {
        const Status status = write_text("-", std::string_view(buffer, count));
        if (!status.ok()) return status;
    }
    return std::ferror(file) ? system_failure("write", "standard output") : Status();
}

} // namespace

Status write_scene(const CompiledModel& model, const std::string& path, const SceneForm& form,
                   TextureStore& textures, const CancelFlag& cancel, std::vector<std::string>* pictures) {
    const PovrayOptions options{.scene_name = model_name(model),
                                .include = form.include,
                                .file_name = std::filesystem::path(path).filename().string(),
                                .progress = form.progress,
                                .identifier = form.identifier,
                                .lights = form.lights};
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    const OpenFile file(std::fopen(pending.temporary_path().c_str(), "wb"));
    if (!file) return system_failure("write", path);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::vector<PaletteImage> palettes;
    PendingPalettes pending_palettes(textures, cancel);
    std::future<Status> written; // meanwhile
    const auto on_text = [&] {
        if (written.valid() || palettes.empty()) return;
        written = std::async(std::launch::async | std::launch::deferred,
                             [&] { return pending_palettes.write(folder, palettes); });
    };
    Status status = emit_to(file.get(), path, model, options, palettes, cancel, on_text);
    if (written.valid()) {
        const Status palettes_status = written.get();
        if (status.ok()) status = palettes_status;
    }
    if (status.ok() && cancel.raised()) status = Status::failure("interrupted");
    if (pictures)
        for (const PaletteImage& palette : palettes)
            pictures->push_back(palette.file_name);
    return status.ok() ? pending_palettes.commit_with(pending) : status;
}

Status print_scene(const CompiledModel& model, bool include, Diagnostics& diagnostics,
                   const CancelFlag& cancel) {
    // A file holds the text first, since only its end tells whether palettes are needed.
    const OpenFile file(open_temporary_file());
    if (!file) return system_failure("write", "a temporary file");
    std::vector<PaletteImage> palettes;
    const Status status =
        emit_to(file.get(), "a temporary file", model, {.scene_name = model_name(model), .include = include},
                palettes, cancel, [] {});
    if (!status.ok()) return status;
    if (!palettes.empty()) {
        const Graph& graph = model.model->graph;
        diagnostics
            .error(graph.objects[graph.root].span,
                   fmt::format("the scene needs {} palette picture{} beside it, and standard output has no "
                               "place for pictures",
                               palettes.size(), palettes.size() == 1 ? "" : "s"))
            .with_hint("write the scene to a file with '-o SCENE.pov'");
        return {};
    }
    return copy_to_standard_output(file.get());
}

Status check_writable(const std::string& path) {
    std::string target;
    if (Status status = output_target(path, target); !status.ok()) return status;
    const std::filesystem::path folder = std::filesystem::path(target).parent_path();
    std::error_code error;
    if (std::filesystem::is_directory(target, error)) return system_failure("write", path, EISDIR);
    const std::string place = folder.empty() ? "." : folder.string();
    if (::access(place.c_str(), W_OK | X_OK) != 0) return system_failure("write", path);
    return {};
}

} // namespace graftal
