#include "compiler/detail/shell/store.h"

#include <utility>

namespace graftal {

namespace {

std::size_t bytes_of(const PointSet& set) {
    return sizeof set + set.points.size() * sizeof set.points[0] + set.paints.size() * sizeof(PointPaint) +
           (set.inside ? set.inside->bytes() : 0);
}

} // namespace

std::shared_ptr<const PointSet> ShellStore::points(const DetailGraph& cut, NodeId node, std::uint32_t steps,
                                                   double detail_per_unit, const PointLimits& limits) {
    const Key key{node, steps, limits.work, limits.points, 1 / detail_per_unit};
    if (auto set = find(key)) return set;
    // Others may find or make theirs meanwhile.
    auto shared = std::make_shared<const PointSet>(point_set(cut, node, steps, detail_per_unit, limits));
    keep(key, shared);
    return shared;
}

std::uint64_t ShellStore::made() const {
    const std::scoped_lock lock(mutex_);
    return made_;
}

std::shared_ptr<const PointSet> ShellStore::find(const Key& asked) {
    const std::scoped_lock lock(mutex_);
    const auto found = entry_of_.lower_bound(asked);
    if (found == entry_of_.end()) return nullptr;
    Key same = asked;
    same.cell = found->first.cell;
    if (found->first != same || asked.cell < found->second->set->finest_asked) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->set;
}

void ShellStore::keep(Key key, const std::shared_ptr<const PointSet>& set) {
    const std::scoped_lock lock(mutex_);
    ++made_;
    key.cell = set->coarsest_asked;
    const std::size_t bytes = bytes_of(*set);
    if (bytes > most_bytes_ || entry_of_.contains(key)) return;
    entries_.push_front({key, set});
    entry_of_[key] = entries_.begin();
    kept_bytes_ += bytes;
    while (kept_bytes_ > most_bytes_) {
        kept_bytes_ -= bytes_of(*entries_.back().set);
        entry_of_.erase(entries_.back().key);
        entries_.pop_back();
    }
}

} // namespace graftal
