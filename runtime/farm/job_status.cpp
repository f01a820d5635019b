#include "runtime/farm/job_status.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/support/printable.h"
#include "runtime/farm/task_records.h"
#include "runtime/render/frame_clock.h"

namespace graftal {

namespace {

/// The last ends of tasks, by which the pace is told.
constexpr std::size_t last_ends = 200;

constexpr std::size_t most_failures_shown = 10;

std::string bar_text(double share) {
    constexpr int width = 40;
    const int full = static_cast<int>(share * width);
    return fmt::format("[{:<{}}]", std::string(static_cast<std::size_t>(full), '='), width);
}

} // namespace

JobStatus look_at_job(const JobFolder& folder, const Job& job) {
    JobStatus status;
    status.tasks = job.tasks;
    std::vector<double> ends;
    double seconds = 0, draw_seconds = 0;
    for (std::uint64_t task = 1; task <= job.tasks; ++task) {
        const std::uint64_t runs = count_starts(folder, task);
        status.runs += runs;
        const std::optional<TaskRecord> record = read_record(folder, task);
        if (!record) {
            status.begun += runs > 0;
            continue;
        }
        if (!record->done) {
            status.failures.push_back({task, record->message});
            continue;
        }
        if (!has_part(folder, job, task, *record)) {
            status.failures.push_back(
                {task, fmt::format("its part '{}' is gone, or not as long as it was: 'graftal farm submit' "
                                   "makes it again",
                                   folder.part(job, task))});
            continue;
        }
        ++status.done;
        seconds += record->seconds;
        draw_seconds += record->draw_seconds;
        ends.push_back(record->ended);
        status.peak_bytes = std::max(status.peak_bytes, record->peak_bytes);
        if (record->seconds > status.slowest_seconds) {
            status.slowest_seconds = record->seconds;
            status.slowest_task = task;
        }
    }
    if (status.done > 0) status.mean_seconds = seconds / static_cast<double>(status.done);
    if (seconds > 0) status.share_beside_pixels = 1 - draw_seconds / seconds;
    std::sort(ends.begin(), ends.end());
    if (ends.size() > last_ends) ends.erase(ends.begin(), ends.end() - last_ends);
    if (ends.size() > 1 && ends.back() > ends.front()) {
        status.tasks_a_second = static_cast<double>(ends.size() - 1) / (ends.back() - ends.front());
        status.seconds_left = static_cast<double>(status.tasks - status.done) / *status.tasks_a_second;
    }
    status.merged = folder.has_result(job);
    return status;
}

std::string status_text(const JobFolder& folder, const Job& job, const JobStatus& status) {
    const double share = static_cast<double>(status.done) / static_cast<double>(status.tasks);
    std::string text = fmt::format("{} {:3.0f} %  {} of {} tasks done", bar_text(share), 100 * share,
                                   status.done, status.tasks);
    if (status.begun > 0) text += fmt::format(", {} begun", status.begun);
    if (!status.failures.empty()) text += fmt::format(", {} failed", status.failures.size());
    text += "\n";
    if (status.done < status.tasks && status.tasks_a_second)
        text += fmt::format("pace: {:.3g} tasks a minute; about {} left\n", 60 * *status.tasks_a_second,
                            duration_text(*status.seconds_left));
    if (status.done > 0)
        text += fmt::format("a task takes {:.2f} s, {:.0f} % of it beside the pixels; the slowest, {}, took "
                            "{:.2f} s; the largest {} MiB\n",
                            status.mean_seconds, 100 * status.share_beside_pixels, status.slowest_task,
                            status.slowest_seconds, status.peak_bytes >> 20);
    if (const auto ended = status.done + status.begun; status.runs > ended)
        text +=
            fmt::format("runs: {}, {} of them ended without a result\n", status.runs, status.runs - ended);
    for (std::size_t i = 0; i < std::min(status.failures.size(), most_failures_shown); ++i)
        text += fmt::format("task {} failed: {} (all of it: {})\n", status.failures[i].task,
                            escaped(status.failures[i].message), folder.log(status.failures[i].task));
    if (status.failures.size() > most_failures_shown)
        text += fmt::format("and {} more\n", status.failures.size() - most_failures_shown);
    if (status.merged)
        text += fmt::format("{} is there\n", folder.result(job));
    else if (status.done == status.tasks)
        text += fmt::format("'graftal farm merge {}' makes {}\n", folder.path(), folder.result(job));
    return text;
}

std::string status_json(const JobStatus& status) {
    using Json = nlohmann::ordered_json;
    const auto or_null = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    Json failures = Json::array();
    for (const JobStatus::Failure& failure : status.failures)
        failures.push_back({{"task", failure.task}, {"message", failure.message}});
    const Json json = {{"tasks", status.tasks},
                       {"done", status.done},
                       {"begun", status.begun},
                       {"failures", failures},
                       {"runs", status.runs},
                       {"mean_seconds", status.mean_seconds},
                       {"slowest_seconds", status.slowest_seconds},
                       {"slowest_task", status.slowest_task},
                       {"share_beside_pixels", status.share_beside_pixels},
                       {"peak_bytes", status.peak_bytes},
                       {"tasks_a_second", or_null(status.tasks_a_second)},
                       {"seconds_left", or_null(status.seconds_left)},
                       {"merged", status.merged}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace graftal
