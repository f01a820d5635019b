#include "compiler/povray/cut/grouping.h"

#include <array>
#include <string>
#include <utility>

#include <algorithm>
#include <bit>
#include <functional>
#include <string>
#include <utility>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/bake.h"
#include "compiler/detail/mesh/builder.h"
#include "compiler/primitives/part_size.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// The numbers of a shape are too many for a name.
std::string body_name(const Primitive& primitive) {
    return primitive.shape() ? std::string(name_of(primitive.kind())) : name_of(primitive);
}

/// Grain of tints: a difference that no picture shows makes no textures of its own.
constexpr double tint_grain = 1.0 / (1 << 24);

bool share_finish(const Material& a, const Material& b) {
    return same_finish(a, b) && a.texture == b.texture && a.pattern == b.pattern &&
           (!a.pattern || a.rgb == b.rgb) && interior_of(a) == interior_of(b);
}

} // namespace

Grouping::Grouping(const DetailGraph& cut, const PlacedPieces& pieces, std::vector<Baked>& baked)
    : cut_(cut), baked_(baked), primitives_(pieces.primitives) {
    for (const TexturedPrimitive& shape : pieces.textured)
        add_textured_body(shape);
    for (std::size_t r = 0; r < baked.size(); ++r) {
        first_body_.push_back(static_cast<std::uint32_t>(result_.bodies.size()));
        palette_.emplace_back();
        for (BakedPart& part : baked[r].parts) {
            result_.triangle_count += part.mesh.triangles.size();
            box_.push_back(box_of(part.mesh));
            result_.bodies.push_back(
                {cut.nodes[pieces.requests[r].representative].name, std::move(part.mesh)});
            palette_.back().emplace_back(part.palettes.size(), no_palette);
        }
    }
}

void Grouping::add(const Placed& thing) {
    if (thing.textured) return add_textured(thing);
    if (thing.request == Placed::no_request) return add_primitive(thing);
    const Baked& baked = baked_[thing.request];
    for (std::uint32_t p = 0; p < baked.parts.size(); ++p) {
        const Palette& palette = baked.parts[p].palettes[thing.painter];
        const std::uint32_t body = first_body_[thing.request] + p;
        const Affine world_from_body = thing.world_from_thing * baked.representative_from_body;
        const Finish finish{baked.parts[p].material, thing.light_share * baked.parts[p].light_share};
        if (baked.parts[p].textured)
            place_painted(body, world_from_body, thing.tint * baked.parts[p].tint, finish,
                          baked.parts[p].size * norm(thing.world_from_thing.linear));
        else if (palette.size() == 1)
            place(body, world_from_body, colour(thing.tint.over(palette[0])), {}, finish);
        else
            place(body, world_from_body, palette_id(thing.request, p, thing.painter), thing.tint, finish);
        include(transformed(world_from_body, box_[body]));
    }
}

void Grouping::add(const PlacedRuns::Range& range) {
    const Run& run = *range.source->run;
    PackedPlacements parts{range.source->run,           range.first, range.count,   0,
                           range.piece.world_from_node, {},          range.left_out};
    std::vector<bool> colours(range.source->materials.size());
    std::array<bool, RunShape::count> known{}; // of parts.body
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
        const RunItem& item = run[i];
        colours[item.colour] = true;
        for (const RunShape shape : {item.shape, item.ball ? PrimitiveKind::sphere : item.shape})
            if (!std::exchange(known[shape.index()], true))
                parts.body[shape.index()] = body_of(shape.primitive());
        include(transformed(range.piece.world_from_node, box_of(item)));
    }
    for (std::size_t colour_number = 0; colour_number < colours.size(); ++colour_number) {
        if (!colours[colour_number]) continue;
        const std::optional<MaterialId>& own = range.source->materials[colour_number];
        const Rgb base = own ? cut_.materials[*own].rgb : range.piece.inherited;
        parts.colour = static_cast<std::uint16_t>(colour_number);
        const Finish finish{own ? own : range.piece.material, range.piece.light_share};
        group_of(colour(range.piece.tint.over(base)), {}, finish).packed.push_back(parts);
        result_.placement_count += parts.size();
    }
}

Cut Grouping::take() && {
    result_.palettes = std::move(palettes_);
    return std::move(result_);
}

void Grouping::include(const Box& box) {
    if (box.empty()) return;
    result_.bounds.include(box);
    result_.largest_part = std::max(result_.largest_part, largest_entry(box.size()));
}

void Grouping::add_textured_body(const TexturedPrimitive& shape) {
    MeshBuilder builder(true);
    builder.add_textured(shape.primitive, shape.fineness, {}, {shape.around, shape.along}, 0);
    builder.finish();
    result_.triangle_count += builder.mesh.triangles.size();
    box_.push_back(box_of(builder.mesh));
    result_.bodies.push_back({body_name(shape.primitive), std::move(builder.mesh)});
}

void Grouping::add_textured(const Placed& thing) {
    place_painted(*thing.textured, thing.world_from_thing, thing.tint,
                  {thing.material, thing.light_share, thing.operand},
                  part_size(thing.painted, thing.world_from_thing.linear));
    include(transformed(thing.world_from_thing, box_[*thing.textured]));
}

void Grouping::place_painted(std::uint32_t body, const Affine& world_from_body, const PathTint& tint,
                             const Finish& finish, double size) {
    const Material material = material_of(finish);
    group_of(colour(Rgb(1.0)), rounded(tint, texture_tint_grain), material,
             material.pattern ? pattern_size(size) : 1, finish.operand)
        .placements.push_back({body, world_from_body});
    ++result_.placement_count;
}

void Grouping::add_primitive(const Placed& thing) {
    const std::uint32_t body = body_of(primitives_[thing.primitive]);
    place(body, thing.world_from_thing, colour(thing.rgb), {},
          {thing.material, thing.light_share, thing.operand});
    include(transformed(thing.world_from_thing, box_[body]));
}

std::uint32_t Grouping::body_of(const Primitive& primitive) {
    const auto [place, added] =
        primitive_body_.emplace(primitive, static_cast<std::uint32_t>(result_.bodies.size()));
    if (added) {
        box_.push_back(primitive_bounds(primitive).box);
        result_.bodies.push_back({body_name(primitive), primitive});
    }
    return place->second;
}

void Grouping::place(std::uint32_t body, const Affine& world_from_body, std::uint32_t palette,
                     const PathTint& exact_tint, const Finish& finish) {
    group_of(palette, exact_tint, finish).placements.push_back({body, world_from_body});
    ++result_.placement_count;
}

PlacementGroup& Grouping::group_of(std::uint32_t palette, const PathTint& exact_tint, const Finish& finish) {
    Material material = material_of(finish);
    material.texture.clear(); // place_painted() places those that have one
    material.pattern = {};
    return group_of(palette, rounded(exact_tint, tint_grain), material, 1, finish.operand);
}

Material Grouping::material_of(const Finish& finish) const {
    Material material;
    if (finish.material) material = cut_.materials[*finish.material];
    material.diffuse *= finish.light_share;
    material.translucency *= finish.light_share;
    material.specular *= finish.light_share;
    return material;
}

PlacementGroup& Grouping::group_of(std::uint32_t palette, const PathTint& tint, const Material& finish,
                                   double size, std::uint32_t operand) {
    std::uint64_t hash = mixed(mixed(0, palette), operand);
    const auto mix = [&](double number) { hash = mixed(hash, std::bit_cast<std::uint64_t>(number)); };
    for (int c = 0; c < 3; ++c)
        mix(tint.premultiplied[c]);
    mix(tint.alpha);
    for (const FinishNumber& row : finish_numbers)
        mix(finish.*row.value);
    mix(size);
    hash = mixed(hash, std::hash<std::string>()(finish.texture));
    const auto next = static_cast<std::uint32_t>(result_.groups.size());
    const std::uint32_t id = group_ids_.find_or_add(hash, next, [&](std::uint32_t other) {
        const PlacementGroup& group = result_.groups[other];
        return group.palette == palette && group.operand == operand && group.tint == tint &&
               group.pattern_size == size && share_finish(group.material, finish);
    });
    if (id == next) result_.groups.push_back({palette, tint, finish, size, operand, {}, {}});
    return result_.groups[id];
}

std::uint32_t Grouping::colour(const Rgb& rgb) {
    const auto [palette, added] =
        colour_palette_.emplace(as_array(rgb), static_cast<std::uint32_t>(palettes_.size()));
    if (added) palettes_.push_back({rgb});
    return palette->second;
}

std::uint32_t Grouping::palette_id(std::uint32_t request, std::uint32_t part, std::uint32_t painter) {
    std::uint32_t& id = palette_[request][part][painter];
    if (id == no_palette) {
        id = static_cast<std::uint32_t>(palettes_.size());
        palettes_.push_back(std::move(baked_[request].parts[part].palettes[painter]));
    }
    return id;
}

} // namespace graftal
