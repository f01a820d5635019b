#pragma once

#include <string>

#include "runtime/farm/job.h"

namespace graftal {

/// Writes the table of a sweep as CSV: a line a task, with the values of the axes, the name of its picture
/// and its seconds. Numbers, texts and truths in the `stats` of its model follow. Requires that all tasks
/// are done.
Status write_sweep_table(const std::string& path, const JobFolder& folder, const Job& job);

} // namespace graftal
