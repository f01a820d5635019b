#pragma once

// Results of unfolding a cut, before its meshes exist.

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "compiler/detail/baked.h"
#include "compiler/detail/primitive_numbers.h"
#include "compiler/graph/graph.h"
#include "compiler/povray/cut/placed_runs.h"
#include "compiler/povray/cut_parts.h"
#include "compiler/support/tint.h"

namespace graftal {

/// One thing at its place, before the meshes exist.
struct Placed {
    static constexpr std::uint32_t no_request = UINT32_MAX;

    std::uint32_t request = no_request; ///< which mesh; none: a primitive
    std::uint32_t painter = 0;
    std::uint32_t primitive = 0; ///< by PlacedPieces::primitives
    Affine world_from_thing;     ///< the request's representative, or the primitive
    PathTint tint;               ///< of a mesh
    Rgb rgb{0.8};                ///< of a primitive, tints in front
    std::optional<MaterialId> material;
    double light_share = 1;                    ///< Piece's
    std::optional<std::uint32_t> textured;     ///< one of the primitives with pictures or patterns
    Primitive painted = PrimitiveKind::sphere; ///< then: this
    std::uint32_t operand = no_operand;        ///< that it is a part of
};

/// A primitive as a mesh with a picture round it.
struct TexturedPrimitive {
    Primitive primitive = PrimitiveKind::sphere;
    int fineness = 0;
    double around = 1, along = 1;
    auto operator<=>(const TexturedPrimitive&) const = default;
};

struct PlacedPieces {
    PrimitiveNumbers primitives; ///< of the placed parts
    std::deque<Placed> things;   ///< no room for twice as many while it grows
    PlacedRuns runs;
    std::vector<BakeRequest> requests;
    std::vector<TexturedPrimitive> textured;
    std::vector<CombinedPart> combined;
    std::vector<double> seen_detail; ///< by request, of shells: the detail of a unit at the middle
    double culled_detail = 0;
    double finest = std::numeric_limits<double>::infinity();

    /// Size of a request's details in its middle, as a share of their size where they look largest.
    double seen_share(std::size_t request) const {
        if (!requests[request].shell) return 1;
        return std::min(1.0, seen_detail[request] / requests[request].detail_per_unit);
    }
};

/// A colour that maps are keyed by.
inline std::array<double, 3> as_array(const Rgb& rgb) {
    return {rgb.r, rgb.g, rgb.b};
}

} // namespace graftal
