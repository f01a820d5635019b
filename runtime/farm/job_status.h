#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/farm/job.h"

namespace graftal {

/// Progress of a job, by the records of its tasks.
struct JobStatus {
    struct Failure {
        std::uint64_t task = 0;
        std::string message;
    };

    std::uint64_t tasks = 0, done = 0;
    std::uint64_t begun = 0;       ///< started, and without a record: at work, or killed
    std::vector<Failure> failures; ///< of tasks whose last run failed, or whose part is damaged
    std::uint64_t runs = 0;        ///< of all tasks together, those that were killed too
    double mean_seconds = 0;       ///< of a task that is done
    double slowest_seconds = 0;
    std::uint64_t slowest_task = 0;
    double share_beside_pixels = 0;       ///< of the tasks' time: start, load, compile, write, check
    std::uint64_t peak_bytes = 0;         ///< of the task that took the most memory
    std::optional<double> tasks_a_second; ///< in the last while, if two have ended
    std::optional<double> seconds_left;   ///< at that pace
    bool merged = false;                  ///< the result is there
};

JobStatus look_at_job(const JobFolder& folder, const Job& job);

/// For people: several lines.
std::string status_text(const JobFolder& folder, const Job& job, const JobStatus& status);
/// One JSON object, its keys in a fixed order.
std::string status_json(const JobStatus& status);

} // namespace graftal
