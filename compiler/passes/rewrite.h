#pragma once

// Helpers of passes that drop and renumber objects.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/graph/graph.h"

namespace graftal {

/// Calls `visit` on every instance and terminal of the graph.
template<typename Visit> void for_each_instance(Graph& graph, const Visit& visit) {
    for (Object& object : graph.objects) {
        for (Instance& instance : object.instances)
            visit(instance);
        if (object.terminal) visit(*object.terminal);
    }
}

/// Calls `visit` on the material of every instance, terminal and packed edge that has one.
template<typename Visit> void for_each_material(Graph& graph, const Visit& visit) {
    for_each_instance(graph, [&](Instance& instance) {
        if (instance.material) visit(*instance.material);
    });
    for (Object& object : graph.objects)
        for (std::optional<MaterialId>& material : object.packed.materials)
            if (material) visit(*material);
}

/// Keeps the marked elements in their order. Returns the new index by old index, UINT32_MAX for the dropped
/// (Renumbering::dropped).
template<typename T> std::vector<std::uint32_t> compact(std::vector<T>& all, const std::vector<bool>& keep) {
    std::vector<std::uint32_t> new_index(all.size(), UINT32_MAX);
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!keep[i]) continue;
        if (kept != i) all[kept] = std::move(all[i]);
        new_index[i] = kept++;
    }
    all.erase(all.begin() + kept, all.end());
    return new_index;
}

/// Old indices by new index: the first that became it.
inline std::vector<std::uint32_t> origins(const std::vector<std::uint32_t>& new_index, std::size_t count) {
    std::vector<std::uint32_t> origin(count);
    for (std::size_t old = new_index.size(); old-- > 0;)
        if (new_index[old] != UINT32_MAX) origin[new_index[old]] = static_cast<std::uint32_t>(old);
    return origin;
}

} // namespace graftal
