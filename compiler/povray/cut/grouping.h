#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/povray/cut/placed.h"
#include "compiler/povray/cut_parts.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Sorts what was placed into bodies, palettes and groups of one texture.
class Grouping {
  public:
    /// Takes the meshes, and keeps references. The bodies of primitives with pictures are the first.
    Grouping(const DetailGraph& cut, const PlacedPieces& pieces, std::vector<Baked>& baked);

    void add(const Placed& thing);
    void add(const PlacedRuns::Range& range);

    Cut take() &&;

  private:
    static constexpr std::uint32_t no_palette = UINT32_MAX;

    /// Finish of a material, with the share of light that its own shade leaves.
    struct Finish {
        std::optional<MaterialId> material;
        double light_share = 1;
        std::uint32_t operand = no_operand;
    };

    void include(const Box& box);
    void add_textured_body(const TexturedPrimitive& shape);
    void add_textured(const Placed& thing);
    /// Places what has a picture or a pattern. `size`: part_size().
    void place_painted(std::uint32_t body, const Affine& world_from_body, const PathTint& tint,
                       const Finish& finish, double size);
    Material material_of(const Finish& finish) const;
    void add_primitive(const Placed& thing);
    std::uint32_t body_of(const Primitive& primitive);
    void place(std::uint32_t body, const Affine& world_from_body, std::uint32_t palette,
               const PathTint& exact_tint, const Finish& finish);
    PlacementGroup& group_of(std::uint32_t palette, const PathTint& exact_tint, const Finish& finish);
    PlacementGroup& group_of(std::uint32_t palette, const PathTint& tint, const Material& finish, double size,
                             std::uint32_t operand);
    std::uint32_t colour(const Rgb& rgb);
    std::uint32_t palette_id(std::uint32_t request, std::uint32_t part, std::uint32_t painter);

    const DetailGraph& cut_;
    std::vector<Baked>& baked_;
    const PrimitiveNumbers& primitives_;
    Cut result_;
    std::vector<Box> box_;                                         ///< by body
    std::vector<std::uint32_t> first_body_;                        ///< by request
    std::vector<std::vector<std::vector<std::uint32_t>>> palette_; ///< by request, part, painter
    std::vector<Palette> palettes_;
    std::unordered_map<Primitive, std::uint32_t> primitive_body_;
    struct ArrayHash {
        std::size_t operator()(const std::array<double, 3>& numbers) const {
            std::uint64_t h = 0;
            for (const double x : numbers)
                h = (std::rotl(h, 23) ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ull;
            return h ^ (h >> 32);
        }
    };
    std::unordered_map<std::array<double, 3>, std::uint32_t, ArrayHash> colour_palette_;
    IdTable group_ids_;
};

} // namespace graftal
