#include "tools/graftal/commands/farm_job.h"

#include <filesystem>

#include <fmt/format.h>

#include "compiler/session/shared_framing.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options/animate.h"
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
    if (!path.has_filename()) path = path.parent_path(); // the path ended in a slash
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
    std::optional<Options> planned = parse_command_line(std::move(words), job.kind == JobKind::tiles).options;
    if (!planned) return std::nullopt;
    std::string problem = refusal_of_tasks(*planned);
    if (problem.empty() && planned->render.unconfined && !folder.is_at_home(job))
        problem = "--unconfined: a job may ask for it only in the very folder that it was planned in: plan "
                  "it again";
    if (problem.empty()) return planned;
    complain(fmt::format("'{}': {}", folder.manifest(), problem));
    return std::nullopt;
}

std::string refusal_of_tasks(const Options& planned) {
    const RenderOptions& render = planned.render;
    if (planned.operands.front() == "-") return "give the model as a file: its tasks read it again";
    if (planned.watch || render.progressive)
        return fmt::format("a task draws once, at its finest: leave out {}",
                           planned.watch ? "--watch" : "--progressive");
    if (!render.keep.empty() || !planned.dump_after.empty())
        return "--keep and --dump-after are for one run: leave them out";
    return {};
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
