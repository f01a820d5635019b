#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "compiler/support/control.h"
#include "runtime/farm/job.h"

namespace graftal {

// The texts that go to Slurm's own programs and come from them. Slurm queues, starts, limits and repeats;
// graftal only says what, and what is missing.

/// The largest array that Slurm takes where nobody has set MaxArraySize: indices from 1 to 1000.
inline constexpr std::uint64_t usual_array_size = 1000;

/// Number of tasks in a group of a minute or so, by the estimate of one.
std::uint64_t minute_of_tasks(double task_seconds);

/// Cuts tasks into the groups of an array job, of `group` tasks each: pieces of the list. There are at most
/// `most_groups`, so groups may be larger.
std::vector<std::vector<std::uint64_t>> group_tasks(const std::vector<std::uint64_t>& tasks,
                                                    std::uint64_t most_groups, std::uint64_t group);

/// The time that one group may take, as Slurm has it, in minutes: ten times the estimate, and ten minutes
/// more, since tiles differ and machines too.
std::uint64_t minutes_for(std::uint64_t tasks, double task_seconds);

/// The jobs of one submission: an array job of groups, and the merge that waits for it.
struct SlurmArray {
    std::string id, merge_id;
    std::vector<std::vector<std::uint64_t>> groups;
};

/// All that were, the oldest first; kept in the job's folder.
std::vector<SlurmArray> read_arrays(const JobFolder& folder);
Status write_arrays(const JobFolder& folder, const std::vector<SlurmArray>& arrays);

std::string slurm_folder(const JobFolder& folder);

/// Writes the lines of an array job and its script; returns the path of the script. `command`: runs the tasks
/// that its last word names.
Status write_array_script(const JobFolder& folder, std::size_t number,
                          const std::vector<std::vector<std::uint64_t>>& groups, const std::string& command,
                          std::string& script);

/// The number in "1234" or "1234;cluster", as `sbatch --parsable` prints it; "" for anything else.
std::string parse_job_id(const std::string& printed);

/// The indices of an array that `squeue -h -r -o %K` lists: they wait or are at work.
std::set<std::uint64_t> parse_indices(const std::string& printed);

/// MaxArraySize from `scontrol show config`; usual_array_size where it says nothing.
std::uint64_t parse_array_size(const std::string& printed);

} // namespace graftal
