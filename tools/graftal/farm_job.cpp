#include "tools/graftal/farm_job.h"

#include <filesystem>

#include "compiler/session/shared_framing.h"
#include "tools/graftal/animate_options.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

std::string own_program() {
    std::error_code error;
    const auto path = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? "graftal" : path.string();
}

} // namespace

int run_farm(const Options& options) {
    switch (options.farm.action) {
    case FarmAction::plan:
        return run_farm_plan(options);
    case FarmAction::submit:
        return run_farm_submit(options);
    case FarmAction::status:
        return run_farm_status(options);
    case FarmAction::merge:
        return run_farm_merge(options);
    case FarmAction::clean:
        return run_farm_clean(options);
    case FarmAction::task:
        return run_farm_task(options);
    }
    return exit_usage;
}

JobFolder job_folder(const Options& options) {
    std::filesystem::path path = std::filesystem::absolute(options.farm.folder).lexically_normal();
    if (!path.has_filename()) path = path.parent_path(); // it ended in a slash
    return JobFolder(path.string());
}

bool open_job(const JobFolder& folder, Job& job) {
    const Status status = folder.read(job);
    if (!status.ok()) complain(status.message());
    return status.ok();
}

std::optional<Options> planned_options(const JobFolder& folder, const Job& job,
                                       const std::vector<std::string>& more) {
    std::vector<std::string> words = {"graftal"};
    words.insert(words.end(), job.words.begin(), job.words.end());
    words[2] = folder.model_folder() + "/" + words[2];
    words.insert(words.end(), {"--root", folder.model_folder()});
    words.insert(words.end(), more.begin(), more.end());
    return parse_command_line(std::move(words), job.kind == JobKind::tiles).options;
}

std::string own_identity() {
    return program_identity(GRAFTAL_VERSION);
}

std::vector<std::string> task_command(const JobFolder& folder, const std::string& tasks) {
    return {own_program(), "farm", "task", folder.path(), tasks};
}

AnimateOptions frame_options(const JobFolder& folder, const Job& job, const Options& planned) {
    AnimateOptions animate = animate_options(planned);
    animate.output = folder.result(job);
    animate.frames_folder = folder.parts();
    animate.keep_frames = true;
    if (!job.framing.empty())
        animate.measured = MeasuredAnimation{SharedFraming::from_json(job.framing), job.sources};
    return animate;
}

} // namespace graftal
