#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/farm/job.h"

namespace graftal {

/// The end of a task, as JobFolder::record() keeps it.
struct TaskRecord {
    bool done = false;
    std::string message;     ///< of a failure: its last line
    std::string host;        ///< where it ran
    double seconds = 0;      ///< from its start to its end
    double draw_seconds = 0; ///< of them, those that went into pixels
    double processor_seconds = 0;
    std::uint64_t peak_bytes = 0; ///< of memory
    std::uint64_t bytes = 0;      ///< of its part
    std::string digest;           ///< of its part: file_digest()
    std::string stats;            ///< of a sweep's model: a JSON object, or ""
    double ended = 0;             ///< seconds since 1970
};

Status write_record(const JobFolder& folder, std::uint64_t task, const TaskRecord& record);

/// Nothing where there is none, or none that can be read: the task is to be run again then.
std::optional<TaskRecord> read_record(const JobFolder& folder, std::uint64_t task);

/// Whether the part of a task that is done is there, by its size alone.
bool has_part(const JobFolder& folder, const Job& job, std::uint64_t task, const TaskRecord& record);

/// Whether the record says that the task is done, and its part is what the record says.
bool is_done(const JobFolder& folder, const Job& job, std::uint64_t task);

/// Adds a line to JobFolder::starts(). Nothing depends on it but reports.
void note_start(const JobFolder& folder, std::uint64_t task);

/// Number of times that the task was started.
std::uint64_t count_starts(const JobFolder& folder, std::uint64_t task);

/// All that are not done, by the word of their records alone.
std::vector<std::uint64_t> missing_tasks(const JobFolder& folder, const Job& job);

/// "1-3,7": lists of numbers in growing order, as Slurm has them. Reading gives nothing for what is
/// malformed, 0, or above `most`.
std::string task_list_text(const std::vector<std::uint64_t>& tasks);
std::optional<std::vector<std::uint64_t>> parse_task_list(std::string_view text, std::uint64_t most);

/// Seconds since 1970.
double now_seconds();

} // namespace graftal
