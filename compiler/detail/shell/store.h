#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>

#include "compiler/detail/shell/points.h"

namespace graftal {

/// The points of shells that were made already, for one graph: a try of several errors asks for the same
/// grids again and again. Results are those of point_set(), with the work that it was; only time is saved.
/// Keeps those that were asked for last. Threads may ask at once.
class ShellStore {
  public:
    static constexpr std::size_t default_bytes = 64 << 20;

    /// `most_bytes`: kept at most, of all shells together.
    explicit ShellStore(std::size_t most_bytes = default_bytes) : most_bytes_(most_bytes) {}

    /// point_set() of the node, never null. Requires the same graph each time.
    std::shared_ptr<const PointSet> points(const DetailGraph& cut, NodeId node, std::uint32_t steps,
                                           double detail_per_unit, const PointLimits& limits);

    /// Number of shells that had to be made.
    std::uint64_t made() const;

  private:
    struct Key {
        NodeId node = 0;
        std::uint32_t steps = 0;
        std::uint64_t most_work = 0;
        std::size_t most_points = 0;
        double cell = 0; ///< the coarsest that is served
        auto operator<=>(const Key&) const = default;
    };
    struct Entry {
        Key key;
        std::shared_ptr<const PointSet> set;
    };

    std::shared_ptr<const PointSet> find(const Key& asked);
    void keep(Key key, const std::shared_ptr<const PointSet>& set);

    mutable std::mutex mutex_;
    const std::size_t most_bytes_;
    std::size_t kept_bytes_ = 0;
    std::uint64_t made_ = 0;
    std::list<Entry> entries_; ///< asked for last first
    std::map<Key, std::list<Entry>::iterator> entry_of_;
};

} // namespace graftal
