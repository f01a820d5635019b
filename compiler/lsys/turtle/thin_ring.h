#pragma once

#include <cstddef>
#include <vector>

namespace graftal {

/// Leaves out the corners of a ring for whose place `is_left_out` is true, until two are left. It is asked
/// again for the neighbours of those that go.
template<typename Corner, typename IsLeftOut>
void thin_ring(std::vector<Corner>& ring, const IsLeftOut& is_left_out) {
    std::size_t at = 0, since_drop = 0;
    while (ring.size() > 2 && since_drop < ring.size()) {
        if (is_left_out(at)) {
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
            since_drop = 0;
            at = (at + ring.size() - 1) % ring.size(); // its neighbour may go now
        } else {
            ++since_drop;
            at = (at + 1) % ring.size();
        }
    }
}

} // namespace graftal
