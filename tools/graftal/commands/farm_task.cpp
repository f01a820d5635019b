#include <algorithm>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
#include "runtime/farm/model_copy.h"
#include "runtime/farm/task_records.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/files_below.h"
#include "runtime/system/interruption.h"
#include "runtime/system/memory_limit.h"
#include "runtime/system/process_memory.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/farm_job.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// While it lives, standard error goes to a file: what the task says, its libraries and the system too.
class ErrorLog {
  public:
    ErrorLog(const JobFolder& folder, const std::string& path) {
        const int file = open_below(folder.path(), folder.name_of(path), O_WRONLY | O_CREAT | O_TRUNC);
        if (file < 0) return;
        saved_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
        if (saved_ >= 0) ::dup2(file, STDERR_FILENO);
        ::close(file);
    }
    ~ErrorLog() {
        if (saved_ < 0) return;
        ::dup2(saved_, STDERR_FILENO);
        ::close(saved_);
    }
    ErrorLog(const ErrorLog&) = delete;
    ErrorLog& operator=(const ErrorLog&) = delete;

  private:
    int saved_ = -1;
};

std::string last_line(const JobFolder& folder, const std::string& path) {
    std::string text;
    if (!folder.read_file(path, text, 64u << 20).ok()) return {};
    while (!text.empty() && text.back() == '\n')
        text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

double processor_seconds() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Reads a whole picture, and keeps nothing of it.
class PictureCheck : public RowSink {
  public:
    explicit PictureCheck(const std::optional<Tile>& tile) : tile_(tile) {}
    std::string begin(int width, int height, int) override {
        if (tile_ && (width != tile_->width || height != tile_->height)) return "it has another size";
        return {};
    }
    void take(const float*) override {}

  private:
    std::optional<Tile> tile_;
};

/// Draws tasks one after the other; the model's analysis is shared where it is the same.
class TaskRunner {
  public:
    TaskRunner(const Options& options, const JobFolder& folder, const Job& job)
        : options_(options), folder_(folder), job_(job) {}

    /// The exit status of the task.
    int run(std::uint64_t task) {
        const Stopwatch watch;
        const double processor_before = processor_seconds();
        note_start(folder_, task);
        TaskRecord record;
        int status = exit_done;
        {
            const ErrorLog log(folder_, folder_.log(task));
            status = check_place(task) ? draw(task, record) : exit_environment;
            if (status == exit_done) status = check(task, record);
        }
        record.done = status == exit_done;
        record.seconds = watch.seconds();
        record.processor_seconds = processor_seconds() - processor_before;
        record.peak_bytes = memory_of("self", "VmHWM:");
        record.ended = now_seconds();
        if (status > 128) return status; // interrupted, which is no result
        if (!record.done) {
            record.message = last_line(folder_, folder_.log(task));
            complain(fmt::format("task {} failed: {}", task, record.message));
        }
        if (const Status written = write_record(folder_, task, record); !written.ok()) {
            complain(written.message());
            return exit_environment;
        }
        return status;
    }

  private:
    /// Whether the part may be written where it belongs.
    bool check_place(std::uint64_t task) const {
        const Status status = folder_.check_file(folder_.part(job_, task));
        if (!status.ok()) complain("cannot write the picture: " + status.message());
        return status.ok();
    }

    int draw(std::uint64_t task, TaskRecord& record) {
        std::vector<std::string> more;
        if (job_.kind == JobKind::sweep) {
            const std::vector<std::string> values = values_at(job_.axes, task - 1);
            for (std::size_t i = 0; i < job_.axes.size(); ++i)
                for (std::string& word : job_.axes[i].words(values[i]))
                    more.push_back(std::move(word));
        }
        if (!planned_ || job_.kind == JobKind::sweep) {
            planned_ = planned_options(folder_, job_, more);
            if (!planned_) return exit_environment;
            planned_->quiet = true;
            if (options_.render.threads > 0) planned_->render.threads = options_.render.threads;
            constexpr std::uint64_t least_memory_bytes = 2ull << 30;
            limit_memory(std::max(planned_->render.compile.detail.memory_bytes, least_memory_bytes));
            session_.emplace(*planned_, planned_->operands.front(), Keep::for_views);
        }
        const Interruption interruption;
        session_->set_control({interruption.flag(), {}});
        const int status =
            job_.kind == JobKind::frames ? draw_frame(task, record) : draw_picture(task, record);
        return interruption.signal() ? 128 + interruption.signal() : status;
    }

    int draw_picture(std::uint64_t task, TaskRecord& record) {
        RenderOptions render = planned_->render;
        render.output = folder_.part(job_, task);
        if (job_.kind == JobKind::tiles) {
            render.tile = job_.tile_of(task);
            render.fit = job_.fit;
        }
        Compilation compilation;
        std::optional<DrawReport> report;
        const Stopwatch watch;
        if (planned_->engine->compile(*session_, render.compile, compilation))
            report = planned_->engine->draw(*session_, render, compilation);
        if (report) note_drawing(*report, watch.seconds(), record);
        if (report && job_.kind == JobKind::sweep) {
            const auto model = session_->analysed(render.compile, compilation, true);
            if (model)
                record.stats =
                    stats_json(*model, levels_of(*model, render.compile.lower.steps), compilation.sources);
        }
        return conclude(*planned_, compilation);
    }

    int draw_frame(std::uint64_t task, TaskRecord& record) {
        AnimateOptions animate = frame_options(folder_, job_, *planned_);
        animate.only = std::vector<std::size_t>{task - 1};
        if (!animate.measured->framing) {
            complain(fmt::format("'{}' is damaged", folder_.manifest()));
            return exit_environment;
        }
        const Stopwatch watch;
        const AnimationOutcome outcome = animate_model(*session_, animate);
        note_drawing(outcome.report, watch.seconds(), record);
        return conclude(*planned_, outcome.compilation);
    }

    static void note_drawing(const DrawReport& report, double seconds, TaskRecord& record) {
        record.draw_seconds = report.trace_seconds > 0 ? report.trace_seconds : seconds;
    }

    /// Whether what is on the disk is a whole picture.
    int check(std::uint64_t task, TaskRecord& record) const {
        const std::string path = folder_.part(job_, task);
        PictureCheck sink(job_.kind == JobKind::tiles ? std::optional(job_.tile_of(task)) : std::nullopt);
        if (const Status status = read_rows(path, sink); !status.ok()) {
            complain(status.message());
            return exit_environment;
        }
        record.bytes = bytes_below(folder_.path(), folder_.name_of(path)).value_or(0);
        record.digest = folder_.digest(path, job_.most_part_bytes());
        if (!record.digest.empty()) return exit_done;
        complain(
            fmt::format("'{}' is larger than the {} bytes that a part may have: draw it in tiles, or smaller",
                        path, job_.most_part_bytes()));
        return exit_fault;
    }

    const Options& options_;
    const JobFolder& folder_;
    const Job& job_;
    std::optional<Options> planned_;
    std::optional<CommandSession> session_;
};

/// Fails where this program or these files are not those that the job was planned with.
Status check_job(const JobFolder& folder, const Job& job) {
    const std::string own = own_identity();
    if (job.program != own)
        return Status::failure(fmt::format("the job in '{}' was planned by '{}', and this is '{}': pictures "
                                           "of two builds may differ. Run that "
                                           "one, or plan the job again",
                                           folder.path(), job.program, own));
    return check_files(folder.model_folder(), job.files);
}

} // namespace

int run_farm_task(const Options& options) {
    const JobFolder folder = job_folder(options);
    Job job;
    if (!open_job(folder, job)) return exit_environment;
    const auto tasks = parse_task_list(options.farm.tasks, job.tasks);
    if (!tasks) {
        complain(fmt::format("TASKS: '{}' is not a list such as 7 or 1-3,7 of tasks from 1 to {}",
                             options.farm.tasks, job.tasks));
        return exit_usage;
    }
    if (const Status status = check_job(folder, job); !status.ok()) {
        complain(status.message());
        return exit_environment;
    }
    TaskRunner runner(options, folder, job);
    int worst = exit_done;
    for (const std::uint64_t task : *tasks) {
        if (is_done(folder, job, task)) {
            if (!options.quiet) say(fmt::format("task {} is done already\n", task));
            continue;
        }
        const int status = runner.run(task);
        if (status > 128) return status;
        worst = std::max(worst, status);
    }
    return worst;
}

} // namespace graftal
