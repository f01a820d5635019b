#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/farm/job.h"
#include "runtime/render/animate.h"
#include "tools/graftal/options.h"

namespace graftal {

/// The folder that the options name, by its whole path.
JobFolder job_folder(const Options& options);

/// Reads the job, or complains.
bool open_job(const JobFolder& folder, Job& job);

/// The problem with options for a task that are right for one run, or "".
std::string refusal_of_tasks(const Options& planned);

/// The options of the one command that does what the job does, read from its words and `more` of them; its
/// model is the copy in the folder. Nothing after a complaint.
std::optional<Options> planned_options(const JobFolder& folder, const Job& job,
                                       const std::vector<std::string>& more = {});

/// Identity of this very program: version and build.
std::string own_identity();

/// The words that run these tasks of the job, wherever they are given.
std::vector<std::string> task_command(const JobFolder& folder, const std::string& tasks);

/// Options that draw the frames of a job, or put them together.
AnimateOptions frame_options(const JobFolder& folder, const Job& job, const Options& planned);

} // namespace graftal
