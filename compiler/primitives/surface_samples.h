#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/primitives/tessellate.h"
#include "compiler/support/affine.h"

namespace graftal {

/// Calls `add` for points of a placed primitive's surface, no point of which is farther than `spacing` from
/// one of them, nearly; curved surfaces are meshed to half of that. Stops, and returns false, once `add`
/// does. Requires another kind than plane.
template<typename Add>
bool sample_surface(const Primitive& primitive, const Affine& place, double spacing, const Add& add) {
    const double size = norm(place.linear);
    if (!(2 * size > spacing)) return add(place(Vec3(0.0)));
    const TessellatedPrimitive& mesh = tessellated(primitive, fineness_for(primitive, 0.5 * spacing / size));
    for (const auto& triangle : mesh.triangles) {
        const Vec3 a = place(mesh.vertices[triangle[0]]);
        const Vec3 b = place(mesh.vertices[triangle[1]]) - a, c = place(mesh.vertices[triangle[2]]) - a;
        const double longest = std::max({glm::length(b), glm::length(c), glm::length(c - b)});
        // Rows along the longest side would do with fewer points for slivers; this is simpler.
        const double rows_wanted = std::ceil(glm::length(b) / spacing),
                     columns_wanted = std::ceil(glm::length(c) / spacing);
        if (!(longest < 1e9 * spacing)) return false;
        const auto rows = static_cast<std::int64_t>(std::max(1.0, rows_wanted));
        for (std::int64_t i = 0; i <= rows; ++i) {
            const double u = static_cast<double>(i) / static_cast<double>(rows);
            const auto columns =
                static_cast<std::int64_t>(std::max(1.0, std::ceil(columns_wanted * (1 - u))));
            for (std::int64_t j = 0; j <= columns; ++j)
                if (!add(a + u * b + (1 - u) * (static_cast<double>(j) / static_cast<double>(columns)) * c))
                    return false;
        }
    }
    return true;
}

} // namespace graftal
