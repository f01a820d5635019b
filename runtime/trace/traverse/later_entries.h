#pragma once

// Entries that rays are to look into later, the nearest at the end; only traversal.cpp and
// packets.cpp include this.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/trace/model/lanes.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

/// A ray's stack in memory that outlives it.
struct Traversal::LaterEntries {
    std::vector<Later>& memory;
    Later* first = memory.data();
    Later* top = first;                            ///< behind the last in use
    Later* limit = first + memory.size() - spared; ///< up to where there is room for a node's

    static constexpr std::size_t spared = 8;

    GRAFTAL_INLINE void reserve() {
        if (top > limit) grow();
    }

    void grow() {
        const std::ptrdiff_t count = top - first;
        memory.resize(2 * memory.size());
        first = memory.data();
        top = first + count;
        limit = first + memory.size() - spared;
    }

    /// Where an entry is, and its number, in one: the nearer, the less.
    static GRAFTAL_INLINE std::int64_t key_of(float at, std::uint32_t entry) {
        return static_cast<std::int64_t>(std::bit_cast<std::int32_t>(at)) << 32 | entry;
    }
    static GRAFTAL_INLINE float at_in(std::int64_t key) {
        return std::bit_cast<float>(static_cast<std::int32_t>(key >> 32));
    }
    static GRAFTAL_INLINE std::uint32_t entry_in(std::int64_t key) { return static_cast<std::uint32_t>(key); }

    /// Key of the nearest box that a ray meets; the others are kept, the farthest first. Requires some
    /// lanes; `key_of_lane`: by the least bit of some.
    template<typename KeyOfLane>
    GRAFTAL_INLINE std::int64_t nearest_of(std::uint32_t lanes, std::uint32_t frame,
                                           const KeyOfLane& key_of_lane) {
        std::int64_t nearest = key_of_lane(lanes);
        lanes &= lanes - 1;
        if (lanes == 0) return nearest;
        reserve();
        Later* const begin = top;
        do {
            const std::int64_t one = key_of_lane(lanes), farther = one < nearest ? nearest : one;
            nearest = one < nearest ? one : nearest;
            Later* place = top++;
            for (; place > begin && place[-1].key < farther; --place)
                *place = place[-1];
            *place = {farther, frame};
        } while ((lanes &= lanes - 1) != 0);
        return nearest;
    }
};

} // namespace graftal
