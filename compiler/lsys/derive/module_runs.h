#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "compiler/lsys/compile/module_table.h"

namespace graftal {

/// A run of modules that is copied as a whole: what replaces a module.
using RunId = std::uint32_t;

/// All successors of a derivation side by side, each with its length before it, so that replacing a module
/// touches little memory.
class ModuleRuns {
  public:
    /// The ids are less than this; those above are free for other uses.
    static constexpr std::size_t most_modules = 1u << 31;

    ModuleRuns() { clear(); }

    /// Requires room for the run.
    RunId add(std::span<const ModuleId> run);
    bool has_room(std::size_t length) const { return length + 1 + store_.size() <= most_modules; }
    std::size_t size() const { return store_.size(); }
    void clear();

    std::uint32_t length(RunId run) const { return store_[run]; }

    /// Appends the runs `run_of(0)`, `run_of(1)` to `run_of(count - 1)` to `word`. Reserve what they take.
    template<typename RunOf> void append(std::size_t count, const RunOf& run_of, ModuleString& word) const;

  private:
    /// Short runs are copied in blocks of this many modules, their end with what follows.
    static constexpr std::size_t block = 8;

    std::vector<ModuleId> store_; ///< with a block to spare
};

/// Runs are gathered where they stay in the cache, since a vector would write all its room twice.
template<typename RunOf>
void ModuleRuns::append(std::size_t count, const RunOf& run_of, ModuleString& word) const {
    constexpr std::size_t longest = 256;
    ModuleId gathered[4096 + longest + block];
    ModuleId* const full = gathered + 4096;
    ModuleId* end = gathered;
    const ModuleId* const store = store_.data();
    for (std::size_t i = 0; i < count; ++i) {
        const ModuleId* from = store + run_of(i);
        const std::size_t length = *from++;
        if (length > longest || end >= full) {
            word.insert(word.end(), gathered, end);
            end = gathered;
        }
        if (length > longest) {
            word.insert(word.end(), from, from + length);
            continue;
        }
        std::memcpy(end, from, block * sizeof(ModuleId));
        for (std::size_t done = block; done < length; done += block)
            std::memcpy(end + done, from + done, block * sizeof(ModuleId));
        end += length;
    }
    word.insert(word.end(), gathered, end);
}

} // namespace graftal
