#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "compiler/support/control.h"
#include "compiler/support/files.h"
#include "runtime/studio/studio_home.h"
#include "runtime/studio/studio_state.h"

namespace graftal {

/// The files of a home, and over them the texts that came with a link. The home's outlive it.
class LaidFiles {
  public:
    explicit LaidFiles(const Files& below) : texts_(&below) {}

    /// These are the link's from now on. Whether that changes anything.
    bool lay(const std::map<std::string, std::string>& files);
    const Files& files() const { return texts_; }

  private:
    MemoryFiles texts_;
    std::map<std::string, std::string> laid_; ///< what was laid over them
};

/// Leaves out those of the state's files that lead out of the home's root, with symbolic links resolved.
void confine_files(StudioState& state, const StudioHome& home);

/// The answer to `link` (docs/studio.md): the model's name as other homes understand it, the texts of the
/// files that it uses, and the names of those that a link cannot hold. `used`: files that the model names,
/// there or not.
nlohmann::json link_parts(const StudioState& state, const std::map<std::string, FileStamp>& used,
                          const Files& files);

/// The answer to `open`: the name under which the home shows the model of a link, and those of its files that
/// the home does not have as they are. Lowers the model to find them. Throws BadMessage where files are
/// lacking, or where `cancel` ends it.
nlohmann::json opened_link(const nlohmann::json& link, StudioHome& home, const CancelFlag& cancel);

} // namespace graftal
