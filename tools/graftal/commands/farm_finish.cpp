#include <filesystem>

#include <fmt/format.h>

#include "runtime/farm/contact_sheet.h"
#include "runtime/farm/job_status.h"
#include "runtime/farm/join_tiles.h"
#include "runtime/farm/sweep_table.h"
#include "runtime/farm/task_records.h"
#include "runtime/render/frame_store.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/file.h"
#include "runtime/system/interruption.h"
#include "runtime/system/process_memory.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/farm_job.h"
#include "tools/graftal/options/values.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

namespace fs = std::filesystem;

class Merging {
  public:
    Merging(const Options& options, const JobFolder& folder, const Job& job, const Options& planned)
        : folder_(folder), job_(job), planned_(planned), bar_(!options.quiet) {}

    Status run(const CancelFlag& cancel) {
        if (Status status = check_results(); !status.ok()) return status;
        if (Status status = check_parts(cancel); !status.ok()) return status;
        switch (job_.kind) {
        case JobKind::tiles:
            return join_tiles(
                folder_, job_, planned_.render.format, planned_.render.metadata, cancel, [this](int row) {
                    bar_.show("joining tiles", static_cast<double>(row) / job_.fit->size.height);
                });
        case JobKind::frames:
            return join_frames(cancel);
        case JobKind::sweep:
            return join_sweep(cancel);
        }
        return {};
    }

    std::vector<std::string> results() const {
        std::vector<std::string> paths = {folder_.result(job_)};
        if (job_.kind == JobKind::sweep) paths.push_back(table());
        return paths;
    }

  private:
    Status check_results() const {
        Status status = folder_.check_result(job_);
        if (!status.ok() || job_.kind != JobKind::sweep) return status;
        Job beside = job_;
        beside.result = fs::path(job_.result).replace_extension(".csv").string();
        return folder_.check_result(beside);
    }

    /// Each part is still the one that its task has checked.
    Status check_parts(const CancelFlag& cancel) {
        std::vector<std::uint64_t> missing;
        for (std::uint64_t task = 1; task <= job_.tasks; ++task) {
            if (cancel.raised()) return Status::failure("interrupted");
            bar_.show("checking parts", static_cast<double>(task - 1) / static_cast<double>(job_.tasks));
            if (!is_done(folder_, job_, task)) missing.push_back(task);
        }
        if (missing.empty()) return {};
        constexpr std::size_t most_shown = 20;
        const bool more = missing.size() > most_shown;
        const std::size_t count = missing.size();
        missing.resize(std::min(count, most_shown));
        return Status::failure(
            fmt::format("{} of {} tasks are missing: {}{}; 'graftal farm submit' runs them", count,
                        job_.tasks, task_list_text(missing), more ? ",..." : ""));
    }

    Status join_frames(const CancelFlag& cancel) {
        AnimateOptions animate = frame_options(folder_, job_, planned_);
        if (*animation_kind(animate.output) == AnimationKind::frames) return copy_frames(cancel);
        animate.on_progress = [&](const AnimationProgress& progress) {
            bar_.show("putting together",
                      static_cast<double>(progress.frame) / static_cast<double>(progress.frames));
        };
        CommandSession session(planned_, planned_.operands.front(), Keep::for_views);
        session.set_control({cancel, {}});
        const AnimationOutcome outcome = animate_model(session, animate);
        if (!outcome.done && outcome.compilation.status.ok())
            return Status::failure("the frames are not those of the model");
        return outcome.compilation.status;
    }

    /// A folder of frames, as `animate` names it.
    Status copy_frames(const CancelFlag& cancel) {
        FrameStore store(frames_directory(folder_.result(job_)), job_.tasks);
        if (Status status = store.create(); !status.ok()) return status;
        for (std::uint64_t task = 1; task <= job_.tasks; ++task) {
            if (cancel.raised()) return Status::failure("interrupted");
            std::string bytes;
            Status status = folder_.read_file(folder_.part(job_, task), bytes, job_.most_part_bytes());
            if (status.ok()) status = write_text(store.path(task - 1), bytes);
            if (!status.ok()) return status;
        }
        return {};
    }

    std::string table() const { return fs::path(folder_.result(job_)).replace_extension(".csv").string(); }

    Status join_sweep(const CancelFlag& cancel) {
        std::vector<SheetPicture> pictures;
        for (std::uint64_t task = 1; task <= job_.tasks; ++task)
            pictures.push_back({folder_.part(job_, task), label_at(job_.axes, task - 1)});
        Status status = write_contact_sheet(
            folder_.result(job_), pictures, column_count(job_.axes), planned_.render.metadata, cancel,
            [&](std::size_t done) {
                bar_.show("contact sheet", static_cast<double>(done) / static_cast<double>(pictures.size()));
            });
        return status.ok() ? write_sweep_table(table(), folder_, job_) : status;
    }

    const JobFolder& folder_;
    const Job& job_;
    const Options& planned_;
    ProgressBar bar_;
};

} // namespace

int run_farm_status(const Options& options) {
    const JobFolder folder = job_folder(options);
    Job job;
    if (!open_job(folder, job)) return exit_environment;
    const JobStatus status = look_at_job(folder, job);
    const int printed =
        options.json ? print_output(status_json(status)) : print_output(status_text(folder, job, status));
    return printed != exit_done || status.failures.empty() ? printed : exit_fault;
}

int run_farm_merge(const Options& options) {
    const JobFolder folder = job_folder(options);
    Job job;
    if (!open_job(folder, job)) return exit_environment;
    const std::optional<Options> planned = planned_options(folder, job);
    if (!planned) return exit_environment;
    const Interruption interruption;
    const Stopwatch watch;
    std::vector<std::string> results;
    Status status;
    {
        Merging merging(options, folder, job, *planned);
        status = merging.run(interruption.flag());
        results = merging.results();
    }
    if (!status.ok()) complain(status.message());
    if (interruption.signal()) return 128 + interruption.signal();
    if (!status.ok()) return exit_environment;
    if (!options.quiet)
        for (const std::string& result : results)
            say(fmt::format("{}: of {} tasks, in {:.1f} s and {} MiB\n", result, job.tasks, watch.seconds(),
                            memory_of("self", "VmHWM:") >> 20));
    return exit_done;
}

int run_farm_clean(const Options& options) {
    const JobFolder folder = job_folder(options);
    Job job;
    if (!open_job(folder, job)) return exit_environment;
    std::error_code error;
    if (!options.farm.everything && !folder.has_result(job)) {
        complain(
            fmt::format("'{}' is not there yet: merge the job first, or give --all", folder.result(job)));
        return exit_fault;
    }
    // Only what graftal has made; the manifest last, so that a clean that was cut short can go on.
    for (const std::string& path : {folder.parts(), folder.tasks(), folder.model_folder(),
                                    folder.path() + "/slurm", folder.commands(), folder.manifest()})
        if (!error) fs::remove_all(path, error);
    if (error) {
        complain(fmt::format("cannot empty '{}': {}", folder.path(), error.message()));
        return exit_environment;
    }
    fs::remove(folder.path(), error); // stays if the result is in it, or anything else
    return exit_done;
}

} // namespace graftal
