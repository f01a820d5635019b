#include "compiler/lsys/derive/module_runs.h"

#include <algorithm>

namespace graftal {

RunId ModuleRuns::add(std::span<const ModuleId> run) {
    const std::size_t at = store_.size() - block;
    store_.resize(store_.size() + run.size() + 1);
    store_[at] = static_cast<ModuleId>(run.size());
    std::ranges::copy(run, store_.begin() + static_cast<std::ptrdiff_t>(at + 1));
    return static_cast<RunId>(at);
}

void ModuleRuns::clear() {
    store_.assign(block, 0);
}

} // namespace graftal
