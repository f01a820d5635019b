#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace graftal {

/// Every node once, and after the nodes it leads to except those that lead back to it. `edges_of(node)`: a
/// vector of its edges, or what can be asked so, of which each has a `child` below `count`. O(graph).
template<typename EdgesOf>
std::vector<std::uint32_t> masters_first(std::size_t count, const EdgesOf& edges_of) {
    std::vector<std::uint32_t> order;
    std::vector<bool> met(count, false);
    std::vector<std::pair<std::uint32_t, std::size_t>> path;
    for (std::uint32_t start = 0; start < count; ++start) {
        if (!met[start]) path.emplace_back(start, 0);
        met[start] = true;
        while (!path.empty()) {
            const auto& edges = edges_of(path.back().first);
            if (path.back().second == edges.size()) {
                order.push_back(path.back().first);
                path.pop_back();
                continue;
            }
            const std::uint32_t child = edges[path.back().second++].child;
            if (!met[child]) path.emplace_back(child, 0);
            met[child] = true;
        }
    }
    return order;
}

} // namespace graftal
