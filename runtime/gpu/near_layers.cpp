#include "runtime/gpu/near_layers.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace graftal {

namespace {

/// Parts thinner than this share of their other extents are layers.
constexpr double thickest = 1e-3;
/// Layers whose faces are nearer than this share of a ray's length are one to the kernel: there rays begin
/// anew that pass a face.
constexpr double nearest = 5e-6;
/// The length of a ray to an object that is seen well, in sizes of the object.
constexpr double sizes_away = 10;
/// Faces that are apart by less, likewise, are so by rounding errors of double precision.
constexpr double rounding = 1e-14;
/// Layers that each is held against, at most: thousands may lie side by side.
constexpr std::size_t most_neighbours = 100;

bool is_layer(const Box& part, int axis) {
    if (part.empty()) return false; // a plane's
    const Vec3 size = part.size();
    return size[axis] <= thickest * std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]);
}

/// Whether the boxes cover each other, seen along the axis.
bool cover(const Box& a, const Box& b, int axis, double least) {
    for (int other = 0; other < 3; ++other)
        if (other != axis &&
            !(std::min(a.max[other], b.max[other]) - std::max(a.min[other], b.min[other]) > least))
            return false;
    return true;
}

/// `size`: of the object that the parts are of; `least`: by which faces are apart, for the kernel.
bool has_near_layers(std::span<const Box> parts, int axis, double size, double least) {
    std::vector<const Box*> layers;
    for (const Box& part : parts)
        if (is_layer(part, axis)) layers.push_back(&part);
    std::ranges::sort(layers, {}, [axis](const Box* layer) { return layer->max[axis]; });
    for (std::size_t i = 0; i < layers.size(); ++i)
        for (std::size_t j = i + 1; j < layers.size() && j <= i + most_neighbours; ++j) {
            const double apart = layers[j]->max[axis] - layers[i]->max[axis];
            if (!(apart < least)) break;
            if (apart > rounding * size && cover(*layers[i], *layers[j], axis, least)) return true;
        }
    return false;
}

} // namespace

bool has_near_layers(const DrawnBounds& bounds, double ray_length) {
    for (std::size_t node = 0; node < bounds.edge.size(); ++node) {
        if (bounds.edge[node].size() < 2 || bounds.node[node].empty()) continue;
        const Vec3 extent = bounds.node[node].size();
        const double size = std::max({extent.x, extent.y, extent.z});
        const double least = nearest * std::max(sizes_away * size, ray_length);
        for (int axis = 0; axis < 3; ++axis)
            if (has_near_layers(bounds.edge[node], axis, size, least)) return true;
    }
    return false;
}

} // namespace graftal
