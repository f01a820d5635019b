#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "compiler/import/importers.h"
#include "compiler/session/shared_framing.h"
#include "compiler/support/printable.h"
#include "compiler/support/shell_words.h"
#include "runtime/farm/join_tiles.h"
#include "runtime/farm/model_copy.h"
#include "runtime/fit/fit_picture.h"
#include "runtime/render/frame_clock.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/scene_files.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/interruption.h"
#include "runtime/system/made_folders.h"
#include "runtime/system/process_memory.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/farm_job.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

namespace fs = std::filesystem;

bool has_option(const std::vector<std::string>& words, const std::string& name) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return word == name || word.starts_with(name + "="); });
}

void drop_root(std::vector<std::string>& words) {
    for (std::size_t i = 0; i < words.size();)
        if (words[i] == "--root" && i + 1 < words.size())
            words.erase(words.begin() + static_cast<std::ptrdiff_t>(i),
                        words.begin() + static_cast<std::ptrdiff_t>(i + 2));
        else if (words[i].starts_with("--root="))
            words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
        else
            ++i;
}

JobKind kind_of(const FarmOptions& farm) {
    if (farm.tile) return JobKind::tiles;
    return farm.sweeps.empty() ? JobKind::frames : JobKind::sweep;
}

/// The one command that does the same, with its engine named.
std::vector<std::string> whole_command(const FarmOptions& farm) {
    std::vector<std::string> words = {"graftal", kind_of(farm) == JobKind::frames ? "animate" : "render"};
    words.insert(words.end(), farm.words.begin(), farm.words.end());
    if (!has_option(words, "--engine")) words.insert(words.end(), {"--engine", "native"});
    return words;
}

/// The problem with options that are right for one run, or "".
std::string refusal(const FarmOptions& farm, const Options& planned) {
    const RenderOptions& render = planned.render;
    if (std::string problem = refusal_of_tasks(planned); !problem.empty()) return problem;
    if (farm.tile && render.tile) return "give --tiles or --tile, not both";
    if (farm.tile && planned.engine->name != native_engine.name)
        return "tiles need '--engine native': POV-Ray smooths the edges of a part otherwise than those of "
               "the "
               "whole";
    if (farm.tile && render.aovs) return "--aovs: tiles hold colours only; leave it out, or draw frames";
    if (farm.tile && render.denoise.value_or(false))
        return "--denoise: tiles are drawn apart, and noise is taken out of whole pictures: leave it out";
    if (!farm.sweeps.empty() && !farm.result.ends_with(".png") && !farm.result.empty())
        return fmt::format("--result: '{}': the name of a contact sheet must end in .png", farm.result);
    if (!farm.sweeps.empty() && (render.aovs || render.format == SampleFormat::linear16))
        return "the pictures of a sweep are PNGs for people: leave out --aovs and --test-linear";
    const auto unwritable = [](const std::string& word) { return !is_printable(word); };
    if (const auto word = std::ranges::find_if(farm.words, unwritable); word != farm.words.end())
        return fmt::format("'{}': the words of a job are in UTF-8, without line ends and other control "
                           "characters: rename the file",
                           *word);
    return {};
}

class Planning {
  public:
    explicit Planning(const Options& options) : options_(options), folder_(job_folder(options)) {}
    ~Planning() {
        if (began_ && !planned_) discard();
    }
    Planning(const Planning&) = delete;
    Planning& operator=(const Planning&) = delete;

    int run() {
        const FarmOptions& farm = options_.farm;
        std::vector<std::string> command = whole_command(farm);
        if (!farm.result.empty()) command.insert(command.end(), {"-o", farm.result});
        const ParsedCommandLine parsed = parse_command_line(std::move(command), farm.tile.has_value());
        if (!parsed.options) return parsed.exit_status;
        if (const std::string problem = refusal(farm, *parsed.options); !problem.empty())
            return usage_error(problem);
        const Interruption interruption;
        cancel_ = interruption.flag();
        const int status = plan(*parsed.options);
        planned_ = status == exit_done;
        return interruption.signal() ? 128 + interruption.signal() : status;
    }

  private:
    static int usage_error(const std::string& problem) {
        complain(problem);
        say("Try 'graftal farm plan --help' for more information.\n");
        return exit_usage;
    }

    int plan(const Options& asked) {
        ProgressBar bar(!asked.quiet);
        if (Status status = make_folder(); !status.ok()) return fail(status);
        job_.kind = kind_of(options_.farm);
        job_.program = own_identity();
        job_.home = folder_.identity();
        bar.show("copying the model...");
        if (const int status = copy(asked); status != exit_done) return status;
        name_result(asked);
        job_.axes = options_.farm.sweeps;
        std::optional<Options> planned = planned_options(folder_, job_, first_words());
        if (!planned) return exit_usage;
        planned->quiet = asked.quiet;
        bar.show("measuring...");
        if (const int status = measure(*planned, bar); status != exit_done) return status;
        bar.clear();
        if (Status status = write(); !status.ok()) return fail(status);
        if (!asked.quiet) say(summary());
        return exit_done;
    }

    static int fail(const Status& status) {
        complain(status.message());
        return exit_environment;
    }

    Status make_folder() {
        std::error_code error;
        if (fs::exists(folder_.manifest(), error))
            return Status::failure(fmt::format(
                "'{0}' holds a job already: 'graftal farm clean {0} --all' removes it", folder_.path()));
        if (fs::exists(folder_.path(), error) && !fs::is_empty(folder_.path(), error))
            return Status::failure(fmt::format(
                "'{}' holds other files: name a folder that is empty or not there", folder_.path()));
        began_ = true;
        for (const std::string& path : {folder_.parts(), folder_.tasks(), folder_.model_folder()})
            if (Status status = made_.make(path); !status.ok()) return status;
        return {};
    }

    /// Nothing stays of a job that was not planned to its end.
    void discard() {
        std::error_code ignored;
        for (const std::string& path : {folder_.parts(), folder_.tasks(), folder_.model_folder(),
                                        folder_.commands(), folder_.manifest()})
            fs::remove_all(path, ignored);
        made_.take_back();
    }

    /// The session of the model itself tells what it is made of.
    int copy(const Options& asked) {
        const std::string& model = asked.operands.front();
        std::vector<std::string> used;
        Compilation compilation;
        const HeardFiles files(disk_files(), [&](const std::string& path) {
            if (disk_files().check(path).ok()) used.push_back(path);
        });
        CommandSession session(asked, model, Keep::nothing, files);
        session.set_control({cancel_, {}});
        StageOptions stages = asked.render.compile;
        if (!session.lowered(stages, compilation)) return conclude(asked, compilation);
        ModelCopy copy;
        if (Status status = copy_model(model, used, folder_.model_folder(), copy); !status.ok())
            return fail(status);
        job_.files = copy.files;
        job_.words = whole_command(options_.farm);
        job_.words.erase(job_.words.begin()); // graftal
        drop_root(job_.words);                // the copy has its own
        const auto named = std::find(job_.words.begin() + 1, job_.words.end(), model);
        job_.words.erase(named);
        job_.words.insert(job_.words.begin() + 1, copy.model);
        return exit_done;
    }

    void name_result(const Options& asked) {
        const std::string& given = options_.farm.result;
        const std::string ending = job_.kind == JobKind::frames ? ".gif" : ".png";
        job_.result = given.empty() ? model_stem(asked.operands.front()) + ending
                                    : fs::absolute(given).lexically_normal().string();
        job_.words.insert(job_.words.end(), {"-o", folder_.result(job_)});
    }

    /// Words of the first task of a sweep.
    std::vector<std::string> first_words() const {
        std::vector<std::string> words;
        const std::vector<std::string> values = values_at(job_.axes, 0);
        for (std::size_t i = 0; i < job_.axes.size(); ++i)
            for (std::string& word : job_.axes[i].words(values[i]))
                words.push_back(std::move(word));
        return words;
    }

    int measure(const Options& planned, ProgressBar& bar) {
        if (job_.kind == JobKind::frames) return measure_frames(planned, bar);
        const ViewOptions& view = planned.render.compile.view;
        if (job_.kind == JobKind::tiles && !view.shaped) // then the size is known before all work
            if (const int status = divide(view.size); status != exit_done) return status;
        CommandSession session(planned, planned.operands.front());
        constexpr const char* fitting = "fitting the picture to the work";
        if (job_.kind == JobKind::tiles) bar.say_at_once(std::string(fitting) + "...");
        ShownTime time(bar, fitting, cancel_);
        session.set_control({time.flag(), {}});
        Compilation compilation;
        RenderOptions render = planned.render;
        if (job_.kind == JobKind::tiles) allow_work(session, render, compilation);
        std::optional<PictureFit> fit;
        if (compilation.status.ok() && !compilation.diagnostics.has_errors())
            fit = fit_natively(session, render, compilation);
        bar.clear();
        if (const int status = conclude(planned, compilation); status != exit_done) return status;
        job_.task_seconds = fit->seconds;
        std::uint64_t pixels = whole_of(fit->size).pixels();
        if (job_.kind == JobKind::sweep) job_.tasks = point_count(job_.axes);
        if (job_.kind == JobKind::tiles) {
            job_.fit = fit;
            if (const int status = divide(fit->size); status != exit_done) return status;
            if (refuse_coarse(*fit, render)) return exit_fault;
            pixels = whole_of(job_.tile).pixels();
            job_.task_seconds /= static_cast<double>(job_.tasks);
        }
        estimate_memory(pixels);
        return exit_done;
    }

    /// The work that `render` gives a picture goes to each million pixels of a large one. The one run that
    /// does the same is told so.
    void allow_work(CommandSession& session, RenderOptions& render, Compilation& compilation) {
        constexpr double pixels_of_work = 1e6;
        PreparedView view;
        view.viewed = session.viewed(render.compile, compilation);
        if (!view.viewed) return;
        const double share = static_cast<double>(whole_of(view.viewed->view.size).pixels()) / pixels_of_work;
        if (!(share > 1)) return;
        view.detail = render.compile.detail;
        const double seconds = std::ceil(share * plan_picture(view, render).detail.work_seconds);
        render.limit_work(seconds);
        job_.words.insert(job_.words.end(), {"--work", fmt::format("{}", seconds)});
    }

    /// Many hours of a farm are not for a picture that shows less than was asked for.
    bool refuse_coarse(const PictureFit& fit, const RenderOptions& render) const {
        constexpr double coarse_px = 2;
        const double wanted_px = render.compile.detail.error_px;
        const double shown_px = std::max<double>(fit.error_px, fit.sampling.block);
        if (options_.farm.coarse || !(shown_px > std::max(coarse_px, wanted_px))) return false;
        complain(
            fmt::format("this picture would show nothing smaller than {:.2g} pixels, for the work that it "
                        "may take: allow each million pixels more with --work, plan a smaller picture, or "
                        "allow this with --coarse",
                        shown_px));
        return true;
    }

    int divide(ImageSize size) {
        const ImageSize asked = *options_.farm.tile;
        job_.tile = {std::min(asked.width, size.width), std::min(asked.height, size.height)};
        if (band_bytes(size, job_.tile.height) > most_band_bytes)
            return usage_error(fmt::format(
                "--tiles: the merge of a picture {} wide holds at most {} MiB of rows: tiles may be {} high",
                size.width, most_band_bytes >> 20,
                std::max<std::uint64_t>(1, most_band_bytes / band_bytes(size, 1))));
        const auto count = [](int whole, int part) {
            return static_cast<std::uint64_t>((whole + part - 1) / part);
        };
        job_.tasks = count(size.height, job_.tile.height) * count(size.width, job_.tile.width);
        if (job_.tasks > most_tasks)
            return usage_error(fmt::format(
                "--tiles: {}x{} makes {} tiles of a picture of {}x{}, more than {}", job_.tile.width,
                job_.tile.height, job_.tasks, size.width, size.height, most_tasks));
        return exit_done;
    }

    int measure_frames(const Options& planned, ProgressBar& bar) {
        CommandSession session(planned, planned.operands.front(), Keep::for_views);
        session.set_control({cancel_, {}});
        AnimateOptions animate = frame_options(folder_, job_, planned);
        animate.on_progress = [&](const AnimationProgress& progress) {
            bar.show("measuring", static_cast<double>(progress.frame) / static_cast<double>(progress.frames));
        };
        std::set<std::string> said;
        animate.on_compiled = [&](const Compilation& compilation) {
            const std::string text = compilation.diagnostics.render(compilation.sources, planned.quiet);
            if (!said.insert(text).second) return;
            bar.clear();
            say(text);
        };
        MeasuredAnimation measured;
        const AnimationOutcome outcome = measure_animation(session, animate, measured);
        bar.clear();
        if (!outcome.done) {
            if (!outcome.frame.empty()) complain("at " + outcome.frame + ":");
            return conclude(planned, outcome.compilation);
        }
        job_.tasks = animate.frames;
        job_.framing = measured.framing->json();
        job_.sources = measured.sources;
        job_.task_seconds = planned.render.compile.detail.work_seconds;
        estimate_memory(whole_of(planned.render.compile.view.size).pixels());
        return exit_done;
    }

    /// This process has held what a task holds, except for the pixels: as light, and as they are shown.
    void estimate_memory(std::uint64_t pixels) {
        constexpr std::uint64_t bytes_a_pixel = 6 * sizeof(float), reserve = 256u << 20;
        job_.task_bytes = memory_of("self", "VmHWM:") * 3 / 2 + bytes_a_pixel * pixels + reserve;
    }

    /// The manifest last: without it there is no job.
    Status write() const {
        std::string lines;
        for (std::uint64_t task = 1; task <= job_.tasks; ++task)
            lines += shell_quoted(task_command(folder_, std::to_string(task))) + "\n";
        const Status status = write_text(folder_.commands(), lines);
        return status.ok() ? folder_.write(job_) : status;
    }

    std::string summary() const {
        std::string what = fmt::format("{} frames", job_.tasks);
        if (job_.kind == JobKind::sweep) what = fmt::format("{} pictures", job_.tasks);
        if (job_.kind == JobKind::tiles)
            what = fmt::format("{} tiles of {}x{} for a picture of {}x{}", job_.tasks, job_.tile.width,
                               job_.tile.height, job_.fit->size.width, job_.fit->size.height);
        std::string text = fmt::format("{}: {}", folder_.path(), what);
        text +=
            job_.kind == JobKind::frames
                ? fmt::format("; --work lets each take {} of one processor", duration_text(job_.task_seconds))
                : fmt::format("; about {:.2g} s of one processor each", job_.task_seconds);
        text += fmt::format(", and up to {} MiB\n", job_.task_bytes >> 20);
        return text + fmt::format("'graftal farm submit {}' with --local N or --slurm runs them\n",
                                  shell_quoted({options_.farm.folder}));
    }

    const Options& options_;
    JobFolder folder_;
    CancelFlag cancel_;
    Job job_;
    MadeFolders made_;
    bool began_ = false, planned_ = false;
};

} // namespace

int run_farm_plan(const Options& options) {
    return Planning(options).run();
}

} // namespace graftal
