#include "tools/graftal/studio_home.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>

#include "compiler/import/importers.h"
#include "compiler/languages/languages.h"
#include "compiler/support/check.h"
#include "compiler/support/text_encoding.h"
#include "runtime/export/export_animation.h"
#include "runtime/export/export_model.h"
#include "runtime/image_files/image_files.h"
#include "runtime/render/animate.h"
#include "runtime/render/file_film.h"
#include "runtime/render/native_engine.h"
#include "runtime/studio/example.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options/animate.h"
#include "tools/graftal/options/export.h"
#include "tools/graftal/report.h"

namespace graftal {

Status read_studio_model(const std::string& path, StudioModel& model) {
    if (path.empty()) {
        model = {example_model(), "."};
        return {};
    }
    std::string bytes;
    if (Status status = disk_files().read(path, bytes); !status.ok()) return status;
    model.opened = {path, decoded_text(std::move(bytes), OtherBytes::windows_1252)};
    // A model from elsewhere may be shown to a page: it names files beside it, or below where we started.
    const std::string folder = std::filesystem::path(path).parent_path().string();
    model.root = lies_in(path, ".") ? "." : folder;
    return {};
}

std::string ProgramHome::version() const {
    return GRAFTAL_VERSION;
}

std::vector<std::string> ProgramHome::formats() const {
    std::vector<std::string> endings;
    for (const ExportFormat& format : export_formats())
        endings.emplace_back(format.extension);
    return endings;
}

std::string ProgramHome::deflated(std::string_view bytes) const {
    constexpr int fast = 1;
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string packed(size, '\0');
    const int done =
        compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), fast);
    GRAFTAL_CHECK(done == Z_OK, "studio: zlib has refused a message");
    packed.resize(size);
    return packed;
}

const Files& ProgramHome::files() const {
    return disk_files();
}

const Workers& ProgramHome::workers(int threads) {
    workers_ = WorkerThreads(threads);
    return workers_;
}

Translator ProgramHome::translator() const {
    return importing_translator();
}

void ProgramHome::equip(Session& session) {
    session.translate_with(translator());
    session.look_at_textures(
        [this](const std::string& name, TextureFacts& facts) { return textures_.look_at(name, facts); });
    session.load_sky_pictures([this](const std::string& name, LoadedSkyPicture& loaded) {
        return textures_.load_sky(name, loaded);
    });
}

Status ProgramHome::load_textures(const Graph& graph, const View& view, ModelTextures& textures) {
    return graftal::load_textures(graph.materials, view, textures_, textures);
}

namespace {

/// Whether files may go there: below the folder where the program was started.
bool may_write(const std::string& path) {
    return lies_in(path, ".");
}

constexpr const char* refused_words = "graftal refuses these options, and says why where it was started";

/// The words of a job as the command line takes them, over the texts of the page.
class JobCommand {
  public:
    JobCommand(const FileJob& job, const std::string& output, const std::string& root)
        : files_(&disk_files()) {
        std::vector<std::string> words = job.words;
        words.insert(words.end(), {"-o", output});
        options = parse_command_line(std::move(words)).options;
        if (options) options->render.compile.lower.root = root;
        for (const auto& [path, text] : job.files)
            files_.set(path, text);
        files_.set(job.model.name, job.model.text);
    }
    /// Requires options.
    CommandSession& session(Keep keep, const CancelFlag& cancel) {
        session_.emplace(*options, options->operands.front(), keep, files_);
        session_->set_control({cancel, {}});
        return *session_;
    }

    std::optional<Options> options; ///< nothing if they are refused

  private:
    MemoryFiles files_;
    std::optional<CommandSession> session_;
};

const char* stage_name(AnimationProgress::Stage stage) {
    switch (stage) {
    case AnimationProgress::Stage::measuring:
        return "measure";
    case AnimationProgress::Stage::drawing:
        return "draw";
    case AnimationProgress::Stage::assembling:
        return "assemble";
    }
    return "";
}

/// Does what the command line does with the job's words.
void run_words(const FileJob& job, const std::string& output, const std::string& root,
               const CancelFlag& cancel, const StudioHome::OnShare& on_share, Compilation& compilation) {
    JobCommand command(job, output, root);
    if (!command.options) {
        compilation.status = Status::failure(refused_words);
        return;
    }
    Options& options = *command.options;
    CommandSession& session = command.session(Keep::for_views, cancel);
    if (options.command->run == run_export) {
        export_model(session, export_options(options), compilation);
        return;
    }
    if (options.command->run == run_animate) {
        AnimateOptions animate = animate_options(options);
        animate.on_progress = [&](const AnimationProgress& progress) {
            const double done = static_cast<double>(progress.frame) + progress.fraction.value_or(0);
            on_share({stage_name(progress.stage),
                      done / static_cast<double>(std::max<std::size_t>(progress.frames, 1))});
        };
        AnimationOutcome outcome = animation_kind(output) == AnimationKind::usd
                                       ? export_animation(session, animate, export_options(options))
                                       : animate_model(session, animate);
        compilation = std::move(outcome.compilation);
        if (!outcome.done && compilation.status.ok() && !compilation.diagnostics.has_errors())
            compilation.status = Status::failure("interrupted");
        return;
    }
    options.render.on_progress = [&](const DrawProgress& progress) {
        on_share({stage_name(AnimationProgress::Stage::drawing), progress.fraction.value_or(0)});
    };
    if (options.engine->compile(session, options.render.compile, compilation))
        options.engine->draw(session, options.render, compilation);
}

std::string first_error(const Compilation& compilation) {
    for (const Diagnostic& finding : compilation.diagnostics.all())
        if (finding.severity == Severity::error) return finding.message;
    return compilation.status.message();
}

FileResult made_file(const FileJob& job, const std::string& root, const CancelFlag& cancel,
                     const StudioHome::OnShare& on_share) {
    if (!job.path.empty() && !may_write(job.path))
        return {fmt::format("'{}' does not lie below the folder where graftal studio was started", job.path)};
    TemporaryDirectory temporary;
    FileResult result;
    Compilation compilation;
    std::string output = job.path;
    if (output.empty()) {
        result.name = std::filesystem::path(job.model.name).stem().string() + job.suffix;
        compilation.status = temporary.create();
        output = temporary.path() + "/" + result.name;
    }
    if (compilation.status.ok()) {
        if (language_with_ending(job.suffix, languages()))
            compilation.status = write_text(output, job.model.text);
        else
            run_words(job, output, root, cancel, on_share, compilation);
    }
    if (compilation.status.ok() && !compilation.diagnostics.has_errors() && job.path.empty())
        compilation.status = read_text(output, result.contents);
    result.path = job.path;
    if (!compilation.status.ok() || compilation.diagnostics.has_errors())
        result.error = first_error(compilation);
    return result;
}

/// The error that `body` returns or throws, or "".
template<typename Body> std::string guarded(const char* what, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return fmt::format("graftal has too little memory for this {}", what);
    } catch (const std::exception& fault) {
        return fault.what();
    }
}

} // namespace

void ProgramHome::make_file(FileJob job, CancelFlag cancel, OnShare on_share, OnResult on_result) {
    if (file_maker_.joinable()) file_maker_.join();
    file_maker_ =
        std::thread([job = std::move(job), cancel = std::move(cancel), on_share = std::move(on_share),
                     on_result = std::move(on_result), model = model_] {
            FileResult result;
            result.error = guarded("file", [&] {
                result = made_file(job, model->root, cancel, on_share);
                return result.error;
            });
            on_result(std::move(result));
        });
}

/// The session's flag ends a job that is still running.
void ProgramHome::end_jobs() {
    for (std::thread* const thread : {&file_maker_, &drawer_})
        if (thread->joinable()) thread->join();
}

std::vector<std::string> ProgramHome::engines() const {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> available;
        for (const Engine& engine : graftal::engines())
            if (engine.available().ok()) available.emplace_back(engine.name);
        return available;
    }();
    return names;
}

namespace {

/// Hands each pass on.
class HandingFilm final : public DevelopedFilm {
  public:
    HandingFilm(const RenderOptions& options, const StudioHome::OnPicture& on_picture)
        : DevelopedFilm(options), on_picture_(on_picture) {}

  private:
    Status take(const Image& developed, const AovPicture*) override {
        on_picture_(developed);
        return {};
    }

    const StudioHome::OnPicture& on_picture_;
};

/// Draws the job's picture. The error, or "".
std::string draw(const FileJob& job, const std::string& root, const CancelFlag& cancel,
                 const StudioHome::OnPicture& on_picture) {
    TemporaryDirectory temporary;
    if (const Status status = temporary.create(); !status.ok()) return status.message();
    const std::string output = temporary.path() + "/picture.png";
    JobCommand command(job, output, root);
    if (!command.options) return refused_words;
    Options& options = *command.options;
    options.render.progressive = options.engine->progressive;
    HandingFilm film(options.render, on_picture);
    if (options.engine->progressive) options.render.film = &film;
    CommandSession& session = command.session(Keep::nothing, cancel);
    Compilation compilation;
    const bool is_drawn = options.engine->compile(session, options.render.compile, compilation) &&
                          options.engine->draw(session, options.render, compilation);
    if (cancel.raised()) return {};
    if (!is_drawn) return first_error(compilation);
    if (options.render.film) return {};
    Image image;
    if (const Status status = read_image(output, image); !status.ok()) return status.message();
    on_picture(image);
    return {};
}

} // namespace

void ProgramHome::draw_picture(FileJob job, CancelFlag cancel, OnPicture on_picture, OnEnd on_end) {
    if (drawer_.joinable()) drawer_.join(); // it was for a state before this one
    drawer_ = std::thread([job = std::move(job), cancel = std::move(cancel),
                           on_picture = std::move(on_picture), on_end = std::move(on_end), model = model_] {
        on_end(guarded("picture", [&] { return draw(job, model->root, cancel, on_picture); }));
    });
}

} // namespace graftal
