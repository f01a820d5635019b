#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <set>

#include <fmt/format.h>

#include "compiler/support/shell_words.h"
#include "runtime/farm/job_status.h"
#include "runtime/farm/slurm.h"
#include "runtime/farm/task_records.h"
#include "runtime/render/frame_clock.h"
#include "runtime/render/stopwatch.h"
#include "runtime/system/interruption.h"
#include "runtime/system/process.h"
#include "runtime/system/worker_threads.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/farm_job.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// Runs the lines of JOB/commands.txt that are missing, several at a time.
int submit_here(const Options& options, const JobFolder& folder, const Job& job,
                const std::vector<std::uint64_t>& missing) {
    const Interruption interruption;
    ProgressBar bar(!options.quiet);
    std::mutex mutex; // of all below
    std::set<std::string> said;
    std::size_t ended = 0, failed = 0;
    const Stopwatch watch;
    const WorkerThreads workers(*options.farm.local);
    // Tasks that run at once share the processors.
    const int threads = std::max(1, WorkerThreads(0).count() / workers.count());
    workers.for_each(missing.size(), [&](int, std::uint64_t i) {
        if (interruption.signal()) return;
        ProcessOptions process;
        process.arguments = task_command(folder, std::to_string(missing[i]));
        process.arguments.insert(process.arguments.end(), {"--quiet", "--threads", std::to_string(threads)});
        process.cancel = interruption.flag();
        std::string text;
        process.on_error_text = [&](std::string_view piece) { text += piece; };
        const ProcessResult result = run_process(process);
        const std::lock_guard lock(mutex);
        ++ended;
        if (!result.succeeded() && !result.cancelled) {
            ++failed;
            if (!result.status.ok()) text = "graftal: " + result.status.message() + "\n";
            if (text.empty())
                text = fmt::format("graftal: task {} was killed by signal {}\n", missing[i], result.signal);
            bar.clear();
            if (said.insert(text).second) say(text);
        }
        const double left =
            watch.seconds() * static_cast<double>(missing.size() - ended) / static_cast<double>(ended);
        bar.show(fmt::format("{} of {} tasks, {} left", job.tasks - missing.size() + ended - failed,
                             job.tasks, duration_text(left)));
    });
    bar.clear();
    if (interruption.signal()) {
        say(fmt::format("graftal: {} of {} tasks are done; the same command goes on from there\n",
                        job.tasks - missing_tasks(folder, job).size(), job.tasks));
        return 128 + interruption.signal();
    }
    if (!options.quiet) say(status_text(folder, job, look_at_job(folder, job)));
    return failed == 0 ? exit_done : exit_fault;
}

class SlurmSubmission {
  public:
    SlurmSubmission(const Options& options, const JobFolder& folder, const Job& job)
        : options_(options), folder_(folder), job_(job), arrays_(read_arrays(folder)) {}

    int run(std::vector<std::uint64_t> missing) {
        if (!find_program("sbatch")) {
            complain(
                "cannot find the program 'sbatch' of Slurm; 'graftal farm submit JOB --local N' needs none");
            return exit_environment;
        }
        if (!arrays_.empty() && !options_.farm.resume) {
            complain(
                fmt::format("the job was submitted as Slurm's job {}: --resume submits again what is missing",
                            arrays_.back().id));
            return exit_fault;
        }
        leave_out_active(missing);
        if (!missing.empty() && !submit(missing)) return exit_environment;
        if (missing.empty() && !options_.quiet) say("all missing tasks wait or are at work in Slurm\n");
        return exit_done;
    }

  private:
    /// The text that a program of Slurm prints; nothing after a complaint, if it must succeed.
    std::optional<std::string> ask(const std::vector<std::string>& words, bool must_succeed = true) const {
        ProcessOptions process;
        process.arguments = words;
        process.output_with_errors = true;
        std::string text;
        process.on_error_text = [&](std::string_view piece) { text += piece; };
        const ProcessResult result = run_process(process);
        if (result.succeeded()) return text;
        if (!must_succeed) return std::string();
        complain(result.status.ok() ? fmt::format("'{}' failed: {}", words.front(), text)
                                    : result.status.message());
        return std::nullopt;
    }

    /// Tasks of groups that Slurm still has are on their way.
    void leave_out_active(std::vector<std::uint64_t>& missing) {
        std::set<std::uint64_t> active;
        for (const SlurmArray& array : arrays_) {
            // Slurm does not know a job that ended long ago, which is no failure.
            const auto printed = ask({"squeue", "-h", "-r", "-j", array.id, "-o", "%K"}, false);
            const std::set<std::uint64_t> indices = parse_indices(*printed);
            if (!indices.empty()) active_ids_.push_back(array.id);
            for (const std::uint64_t index : indices)
                if (index >= 1 && index <= array.groups.size())
                    active.insert(array.groups[index - 1].begin(), array.groups[index - 1].end());
        }
        std::erase_if(missing, [&](std::uint64_t task) { return active.contains(task); });
    }

    std::string log_pattern(const std::string& name) const { return slurm_folder(folder_) + "/" + name; }

    bool submit(const std::vector<std::uint64_t>& missing) {
        const auto config = ask({"scontrol", "show", "config"}, false);
        SlurmArray array;
        array.groups =
            group_tasks(missing, parse_array_size(*config),
                        options_.farm.group > 0 ? options_.farm.group : minute_of_tasks(job_.task_seconds));
        std::vector<std::string> command = task_command(folder_, "");
        command.pop_back(); // the tasks come from the script
        std::string script;
        const std::size_t number = arrays_.size() + 1;
        if (Status status = write_array_script(folder_, number, array.groups, shell_quoted(command), script);
            !status.ok()) {
            complain(status.message());
            return false;
        }
        std::uint64_t longest = 0;
        for (const auto& group : array.groups)
            longest = std::max<std::uint64_t>(longest, group.size());
        const std::string name = std::filesystem::path(folder_.path()).filename().string();
        std::string indices = fmt::format("1-{}", array.groups.size());
        if (options_.farm.at_once > 0) indices += fmt::format("%{}", options_.farm.at_once);
        std::vector<std::string> words = {"sbatch",
                                          "--parsable",
                                          "--job-name=" + name,
                                          "--array=" + indices,
                                          "--cpus-per-task=1",
                                          "--requeue",
                                          "--open-mode=append",
                                          fmt::format("--time={}", minutes_for(longest, job_.task_seconds)),
                                          fmt::format("--mem={}M", (job_.task_bytes >> 20) + 1),
                                          "--output=" + log_pattern("%A_%a.out")};
        words.insert(words.end(), options_.farm.words.begin(), options_.farm.words.end());
        words.insert(words.end(), {script, fmt::format("{}/groups_{}.txt", slurm_folder(folder_), number)});
        const auto printed = ask(words);
        if (!printed) return false;
        array.id = parse_job_id(*printed);
        if (array.id.empty()) {
            complain(fmt::format("'sbatch' printed no number of a job: {}", *printed));
            return false;
        }
        // From here on the job is Slurm's, whatever else fails.
        arrays_.push_back(array);
        if (!save() || !submit_merge(command.front(), name)) return false;
        if (!options_.quiet)
            say(fmt::format("Slurm's job {}: {} tasks in {} groups; job {} merges them\n"
                            "'graftal farm status {}' says how far they are\n",
                            arrays_.back().id, missing.size(), array.groups.size(), arrays_.back().merge_id,
                            shell_quoted({options_.farm.folder})));
        return true;
    }

    bool submit_merge(const std::string& program, const std::string& name) {
        active_ids_.push_back(arrays_.back().id);
        std::string after = "--dependency=afterok";
        for (const std::string& id : active_ids_)
            after += ":" + id;
        const std::string script = slurm_folder(folder_) + "/merge.sh";
        const Status status =
            folder_.write_file(script, fmt::format("#!/bin/sh\nexec {} --quiet\n",
                                                   shell_quoted({program, "farm", "merge", folder_.path()})));
        if (!status.ok()) {
            complain(status.message());
            return false;
        }
        std::vector<std::string> words = {"sbatch",
                                          "--parsable",
                                          "--job-name=" + name + "-merge",
                                          after,
                                          "--kill-on-invalid-dep=yes",
                                          "--cpus-per-task=1",
                                          "--mem=1G",
                                          "--output=" + log_pattern("merge_%j.out")};
        words.insert(words.end(), options_.farm.words.begin(), options_.farm.words.end());
        words.push_back(script);
        const auto printed = ask(words);
        if (!printed) return false;
        arrays_.back().merge_id = parse_job_id(*printed);
        return save();
    }

    bool save() const {
        const Status status = write_arrays(folder_, arrays_);
        if (!status.ok()) complain(status.message());
        return status.ok();
    }

    const Options& options_;
    const JobFolder& folder_;
    const Job& job_;
    std::vector<SlurmArray> arrays_;
    std::vector<std::string> active_ids_;
};

} // namespace

int run_farm_submit(const Options& options) {
    const JobFolder folder = job_folder(options);
    Job job;
    if (!open_job(folder, job)) return exit_environment;
    const std::vector<std::uint64_t> missing = missing_tasks(folder, job);
    if (missing.empty()) {
        if (!options.quiet) say(status_text(folder, job, look_at_job(folder, job)));
        return exit_done;
    }
    if (options.farm.slurm) return SlurmSubmission(options, folder, job).run(missing);
    return submit_here(options, folder, job, missing);
}

} // namespace graftal
