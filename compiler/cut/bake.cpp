#include "compiler/cut/bake.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include <Eigen/SVD>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tsl/robin_map.h>

#include "compiler/cut/leaf_walk.h"
#include "compiler/cut/mesh_builder.h"
#include "compiler/cut/placed_set.h"
#include "compiler/cut/tessellate.h"

namespace graftal {

namespace {

/// A map flatter than this is given a thickness before it is drawn.
constexpr double flattest_leaf = 1e-6;

struct KeptLeaf {
    PrimitiveKind kind = PrimitiveKind::sphere;
    Affine place;
    std::size_t number = 0; ///< in the order of the walk
    std::size_t part = 0;
    Rgb rgb{0.0}; ///< as the first painter has it
};

/// The same for all crushed leaves in one cell of half a thickness, of one size to a factor of 2.
Affine crushed_mark(const Affine& place, double thickness) {
    Affine mark{Mat3(std::exp2(std::round(std::log2(norm(place.linear))))), {}};
    for (int k = 0; k < 3; ++k)
        mark.translation[k] = 0.5 * thickness * std::round(place.translation[k] / (0.5 * thickness));
    return mark;
}

std::int64_t part_key(const std::optional<MaterialId>& material) {
    return material ? static_cast<std::int64_t>(*material) : -1;
}

struct RgbHash {
    std::size_t operator()(const Rgb& rgb) const {
        std::uint64_t h = 0;
        for (int k = 0; k < 3; ++k)
            h = (std::rotl(h, 21) ^ std::bit_cast<std::uint64_t>(rgb[k])) * 0x9E3779B97F4A7C15ull;
        return h;
    }
};

struct Mix {
    std::size_t operator()(std::uint64_t value) const {
        const std::uint64_t h = value * 0x9E3779B97F4A7C15ull;
        return h ^ (h >> 32);
    }
};

/// Numbers the distinct tuples of colours that leaves take over all painters, one painter at a time.
class SlotTable {
  public:
    explicit SlotTable(std::size_t leaves) : slot_of_leaf(leaves, 0), count(leaves > 0 ? 1 : 0) {}

    void refine(const std::vector<Rgb>& colours) {
        // One colour refines nothing, and neither does anything once each leaf has its own slot.
        if (count == colours.size() ||
            std::all_of(colours.begin(), colours.end(), [&](const Rgb& c) { return c == colours[0]; }))
            return;
        tsl::robin_map<Rgb, std::uint32_t, RgbHash> numbers;
        tsl::robin_map<std::uint64_t, std::uint32_t, Mix> refined;
        for (std::size_t leaf = 0; leaf < colours.size(); ++leaf) {
            const auto colour =
                numbers.emplace(colours[leaf], static_cast<std::uint32_t>(numbers.size())).first->second;
            const std::uint64_t pair = static_cast<std::uint64_t>(slot_of_leaf[leaf]) << 32 | colour;
            slot_of_leaf[leaf] =
                refined.emplace(pair, static_cast<std::uint32_t>(refined.size())).first->second;
        }
        count = static_cast<std::uint32_t>(refined.size());
    }

    Palette palette(const std::vector<Rgb>& colours) const {
        Palette palette(count);
        for (std::size_t leaf = 0; leaf < colours.size(); ++leaf)
            palette[slot_of_leaf[leaf]] = colours[leaf];
        const bool plain =
            std::all_of(palette.begin(), palette.end(), [&](const Rgb& c) { return c == palette[0]; });
        if (plain) palette.resize(1);
        return palette;
    }

    std::vector<std::uint32_t> slot_of_leaf;
    std::uint32_t count;
};

class Baker {
  public:
    Baker(const CutGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
          std::size_t max_triangles)
        : cut_(cut), symmetry_(symmetry), request_(request), max_triangles_(max_triangles) {}

    Baked bake() {
        place_body();
        gather_leaves();
        if (!baked_.complete) return std::move(baked_);
        for (std::size_t part = 0; part < materials_.size(); ++part)
            build_part(part);
        return std::move(baked_);
    }

  private:
    void place_body() {
        const Ball& ball = cut_.nodes[request_.representative].ball;
        const double size = std::exp2(std::ceil(std::log2(std::max(ball.radius, 1e-200))));
        const Vec3 centre(std::round(ball.centre.x / size * 4) * size / 4,
                          std::round(ball.centre.y / size * 4) * size / 4,
                          std::round(ball.centre.z / size * 4) * size / 4);
        baked_.representative_from_body = Affine::translate(centre) * Affine::scale(Vec3(size));
    }

    void gather_leaves() {
        std::map<std::int64_t, std::size_t> part_of;
        PlacedSet seen(cut_.nodes[request_.representative].ball.radius);
        LeafWalk walk(cut_, symmetry_, request_, request_.painters.front());
        WalkedLeaf leaf;
        std::size_t triangles = 0;
        for (std::size_t number = 0; walk.next(leaf); ++number) {
            const double thickness = leaf_thickness(leaf.representative_from_leaf, request_.detail_per_unit);
            const Affine place = thickened(leaf.representative_from_leaf, thickness);
            // What a singular map crushes onto a line or a sheet piles up there: one leaf a thickness will
            // do.
            const Affine mark = thickness > 0 ? crushed_mark(place, thickness) : place;
            if (!seen.insert(static_cast<std::uint32_t>(leaf.kind), mark)) continue;
            const auto [part, added] = part_of.emplace(part_key(leaf.material), materials_.size());
            if (added) {
                materials_.push_back(leaf.material);
                smooth_.push_back(false);
            }
            const bool flat = tessellated(leaf.kind, 0).normals.empty();
            if (!flat) smooth_[part->second] = true;
            baked_.culled_detail = std::max(baked_.culled_detail, leaf.culled_detail);
            leaves_.push_back({leaf.kind, place, number, part->second, leaf.rgb});
            // Of a cube no face may be left where others touch it; it counts when the mesh is built.
            triangles += leaf.kind == PrimitiveKind::cube ? 1 : tessellated(leaf.kind, 0).triangles.size();
            if (triangles > max_triangles_) {
                baked_.complete = false;
                return;
            }
        }
    }

    void build_part(std::size_t part) {
        MeshBuilder builder(smooth_[part]);
        const Affine body_from_representative = inverse(baked_.representative_from_body);
        std::vector<std::size_t> kept_number;
        std::vector<Rgb> first_colours;
        for (const KeptLeaf& leaf : leaves_) {
            if (leaf.part != part) continue;
            builder.add(leaf.kind, fineness(leaf), body_from_representative * leaf.place, kept_number.size());
            kept_number.push_back(leaf.number);
            first_colours.push_back(leaf.rgb);
            if (baked_.triangles + builder.triangle_count() > 4 * max_triangles_) {
                baked_.complete = false;
                return;
            }
        }
        builder.finish();
        if (builder.mesh.triangles.empty()) return;
        BakedPart result;
        result.material = materials_[part];
        result.mesh = std::move(builder.mesh);
        paint(result, kept_number, std::move(first_colours), builder.leaf_of_triangle);
        baked_.triangles += result.mesh.triangles.size();
        baked_.parts.push_back(std::move(result));
    }

    int fineness(const KeptLeaf& leaf) {
        const double px = norm(leaf.place.linear) * request_.pixels_per_unit;
        const int level = fineness_for(leaf.kind, tessellation_tolerance_px / std::max(px, 1e-300));
        baked_.tessellation_px = std::max(baked_.tessellation_px, px * tessellation_error(leaf.kind, level));
        return level;
    }

    void paint(BakedPart& part, const std::vector<std::size_t>& kept_number, std::vector<Rgb> first_colours,
               const std::vector<std::size_t>& leaf_of_triangle) {
        std::vector<std::vector<Rgb>> colours = {std::move(first_colours)};
        for (std::size_t i = 1; i < request_.painters.size(); ++i)
            colours.push_back(colours_by(request_.painters[i], kept_number));
        SlotTable slots(kept_number.size());
        for (const auto& by_leaf : colours)
            slots.refine(by_leaf);
        for (const auto& by_leaf : colours)
            part.palettes.push_back(slots.palette(by_leaf));
        part.mesh.slot_count = slots.count;
        if (slots.count > 1)
            for (const std::size_t leaf : leaf_of_triangle)
                part.mesh.slot_of_triangle.push_back(slots.slot_of_leaf[leaf]);
    }

    std::vector<Rgb> colours_by(const Painter& painter, const std::vector<std::size_t>& kept_number) const {
        std::vector<Rgb> colours;
        colours.reserve(kept_number.size());
        LeafWalk walk(cut_, symmetry_, request_, painter);
        WalkedLeaf leaf;
        for (std::size_t number = 0; colours.size() < kept_number.size() && walk.next(leaf); ++number)
            if (number == kept_number[colours.size()]) colours.push_back(leaf.rgb);
        return colours;
    }

    const CutGraph& cut_;
    const Symmetry& symmetry_;
    const BakeRequest& request_;
    std::size_t max_triangles_;
    Baked baked_;
    std::vector<KeptLeaf> leaves_;
    std::vector<std::optional<MaterialId>> materials_; ///< by part
    std::vector<bool> smooth_;                         ///< by part
};

} // namespace

double leaf_thickness(const Affine& place, double detail_per_unit) {
    if (!is_singular(place, flattest_leaf)) return 0;
    constexpr double thinnest_share = 1e-3;
    return std::isfinite(detail_per_unit) ? 1 / detail_per_unit : thinnest_share * norm(place.linear);
}

Affine thickened(const Affine& place, double thickness) {
    if (!(thickness > 0)) return place;
    Eigen::Matrix3d linear;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            linear(row, column) = place.linear[column][row];
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d sigma = svd.singularValues().cwiseMax(thickness);
    const Eigen::Matrix3d thick = svd.matrixU() * sigma.asDiagonal() * svd.matrixV().transpose();
    Affine result = place;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            result.linear[column][row] = thick(row, column);
    return result;
}

Baked bake(const CutGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
           std::size_t max_triangles) {
    return Baker(cut, symmetry, request, max_triangles).bake();
}

} // namespace graftal
