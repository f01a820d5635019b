#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compiler/support/status.h"
#include "runtime/farm/job.h"

namespace graftal {

/// A model with all files that it uses, in a folder of its own, where they lie to each other as before.
struct ModelCopy {
    std::string model; ///< its name within the folder
    std::vector<JobFile> files;
};

/// Copies the model and the files that it uses, whose paths are as HeardFiles hears them, into the
/// folder. Nothing else is done to it: whether the copy works, its first compilation shows.
Status copy_model(const std::string& model, const std::vector<std::string>& used, const std::string& folder,
                  ModelCopy& copy);

/// Fails for the first file that is not what it was when it was copied.
Status check_files(const std::string& folder, const std::vector<JobFile>& files);

} // namespace graftal
