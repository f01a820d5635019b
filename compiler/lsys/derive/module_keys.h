#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compiler/lsys/compile/module_table.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Facts about combinations of modules: a `Value` for each tag and list of modules.
template<typename Value> class ModuleKeys {
  public:
    /// The value of the combination, for the caller to fill in if it is new; it equals `fresh` then. Valid
    /// until the next call.
    Value& find_or_add(std::uint32_t tag, std::span<const ModuleId> modules, const Value& fresh);

    std::size_t size() const { return entries_.size(); }
    /// Number of modules in the lists of all combinations.
    std::size_t module_count() const { return modules_.size(); }
    void clear();

  private:
    struct Entry {
        std::uint32_t tag;
        std::uint32_t first; ///< of modules_
        std::uint32_t count;
        Value value;
    };

    std::vector<Entry> entries_;
    ModuleString modules_;
    IdTable ids_;
};

template<typename Value>
Value& ModuleKeys<Value>::find_or_add(std::uint32_t tag, std::span<const ModuleId> modules,
                                      const Value& fresh) {
    std::uint64_t hash = mixed(0, tag);
    for (const ModuleId module : modules)
        hash = mixed(hash, module);
    const auto next = static_cast<std::uint32_t>(entries_.size());
    const std::uint32_t id = ids_.find_or_add(hash, next, [&](std::uint32_t other) {
        const Entry& entry = entries_[other];
        if (entry.tag != tag || entry.count != modules.size()) return false;
        // Lists are short: calling memcmp(), as std::ranges::equal() does, takes longer than comparing.
        std::size_t same = 0;
        while (same < modules.size() && modules_[entry.first + same] == modules[same])
            ++same;
        return same == modules.size();
    });
    if (id == next) {
        entries_.push_back({tag, static_cast<std::uint32_t>(modules_.size()),
                            static_cast<std::uint32_t>(modules.size()), fresh});
        modules_.insert(modules_.end(), modules.begin(), modules.end());
    }
    return entries_[id].value;
}

template<typename Value> void ModuleKeys<Value>::clear() {
    if (entries_.empty()) return;
    entries_.clear();
    modules_.clear();
    ids_.clear();
}

} // namespace graftal
