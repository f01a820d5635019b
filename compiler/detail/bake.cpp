#include "compiler/detail/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <numbers>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/detail/leaf_walk.h"
#include "compiler/detail/least_width.h"
#include "compiler/detail/mesh/builder.h"
#include "compiler/detail/mesh/slot_table.h"
#include "compiler/detail/placed_set.h"
#include "compiler/detail/primitive_numbers.h"
#include "compiler/detail/shell/shell.h"
#include "compiler/primitives/part_size.h"
#include "compiler/primitives/sheet.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/check.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// Cost of widening a leaf, and of keeping one, measured, in visits of the walk: where leaves are many, each
/// that is kept waits for memory.
constexpr std::uint64_t visits_of_widening = 10, visits_of_keeping = 5;
/// Most leaves for which room is made beforehand.
constexpr double most_expected_leaves = 1 << 20;

struct KeptLeaf {
    Affine place;
    std::uint32_t primitive = 0; ///< by Baker::primitives_
    NormalField normals;
    double turns = 1;
    bool wide = false; ///< drawn wider than it is
};

/// Attributes that the leaves of one part share.
struct PartKey {
    std::int64_t material = -1; ///< none: -1
    bool textured = false;
    std::array<double, 4> tint{}; ///< of textured leaves
    double size = 1;              ///< of leaves with a pattern
    double light_share = 1;
    auto operator<=>(const PartKey&) const = default;
};

/// The leaves of one finish.
struct BakedPart {
    std::optional<MaterialId> material;
    bool textured = false;
    PathTint tint;
    double size = 1; ///< of a pattern
    double light_share = 1;
    bool smooth = false; ///< some leaf is curved
    std::vector<KeptLeaf> leaves;
    SlotTable slots; ///< of the leaves' colours
    Mesh mesh;
    std::vector<std::uint32_t> leaf_of_triangle;
};

/// One of 16 turns spread evenly over all (M. Alexa, "Super-Fibonacci Spirals", CVPR 2022). The shadows of
/// an octahedron differ by a quarter with the direction; those of many that are turned so hardly do.
Affine spread_turn(std::size_t number) {
    constexpr int turns = 16;
    static const std::array<Affine, turns> all = [] {
        std::array<Affine, turns> result;
        for (int i = 0; i < turns; ++i) {
            const double s = i + 0.5, first = std::sqrt(s / turns), second = std::sqrt(1 - s / turns);
            const double alpha = 2 * std::numbers::pi * s / std::numbers::sqrt2;
            const double beta = 2 * std::numbers::pi * s / 1.533751168755204288;
            const Vec3 axis(first * std::sin(alpha), first * std::cos(alpha), second * std::sin(beta));
            const double cosine = std::clamp(second * std::cos(beta), -1.0, 1.0);
            result[static_cast<std::size_t>(i)] =
                Affine::rotate(axis, 360 / std::numbers::pi * std::acos(cosine));
        }
        return result;
    }();
    return all[number % turns];
}

class Baker {
  public:
    Baker(const DetailGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
          std::size_t max_triangles)
        : cut_(cut), symmetry_(symmetry), request_(request), max_triangles_(max_triangles) {}

    Baked bake() {
        try {
            unfold();
        } catch (const std::bad_alloc&) {
            // Visits count as work: tries that end for their memory have a price.
            baked_.complete = false;
        }
        if (baked_.complete) return std::move(baked_);
        Baked stopped;
        stopped.visits = baked_.visits;
        stopped.made_triangles = baked_.made_triangles;
        stopped.complete = false;
        return stopped;
    }

  private:
    void unfold() {
        place_body();
        gather_leaves();
        if (!baked_.complete) return;
        colour_leaves();
        for (BakedPart& part : parts_)
            if (baked_.complete) build(part);
        if (!baked_.complete) return;
        for (BakedPart& part : parts_)
            finish(part);
    }

    void place_body() {
        const Ball& ball = cut_.nodes[request_.representative].ball;
        const double size = std::exp2(std::ceil(std::log2(std::max(ball.radius, 1e-200))));
        const Vec3 centre(std::round(ball.centre.x / size * 4) * size / 4,
                          std::round(ball.centre.y / size * 4) * size / 4,
                          std::round(ball.centre.z / size * 4) * size / 4);
        baked_.representative_from_body = Affine::translate(centre) * Affine::scale(Vec3(size));
    }

    void gather_leaves() {
        const Control control{request_.cancel, {}};
        WorkMeter meter(control, "bake", leaves_a_look);
        PlacedSet seen(cut_.nodes[request_.representative].ball.radius, expected_leaves());
        LeafWalk walk(cut_, symmetry_, request_, std::span(request_.painters).first(1));
        WalkedLeaf leaf;
        std::size_t triangles = 0;
        for (std::uint64_t number = 0; walk.next(leaf); ++number) {
            meter.add();
            baked_.visits =
                walk.visits() + visits_of_widening * widened_ + visits_of_keeping * numbers_.size();
            if (baked_.visits > request_.most_visits) {
                baked_.complete = false;
                return;
            }
            Affine mark;
            const Affine place = drawn(leaf, mark);
            const std::uint32_t primitive = primitives_.of(leaf.primitive);
            if (!seen.insert(primitive, mark)) continue;
            const auto [place_of_part, added] = part_of_.emplace(key_of(leaf), parts_.size());
            if (added) add_part(leaf);
            BakedPart& part = parts_[place_of_part->second];
            const TessellatedPrimitive& coarsest = tessellated(leaf.primitive, 0);
            part.smooth = part.smooth || part.textured || !coarsest.normals.empty();
            const bool wide = place.linear != leaf.representative_from_leaf.linear;
            part.leaves.push_back({place, primitive, leaf.normals, leaf.turns, wide});
            numbers_.push_back(number);
            baked_.culled_detail = std::max(baked_.culled_detail, leaf.culled_detail);
            // A solid may have no face left where others touch it; it counts when the mesh is built.
            triangles += traits_of(leaf.primitive).solid ? 1 : coarsest.triangles.size();
            if (triangles > max_triangles_) {
                baked_.complete = false;
                return;
            }
        }
    }

    /// The place of the leaf, as wide as it is drawn, and what it has in common with those that it stands
    /// for.
    Affine drawn(const WalkedLeaf& leaf, Affine& mark) {
        const Affine& place = leaf.representative_from_leaf;
        const bool culls = request_.half_widths_from_unit != Mat3(0.0);
        if (!leaf.faint && !is_singular(place, flattest_leaf)) return mark = place;
        ++widened_;
        const Affine seen_from_unit{culls ? request_.half_widths_from_unit : Mat3(1.0), Vec3(0.0)};
        const Affine seen = seen_from_unit * place;
        const auto [wide, half_width] = drawn_leaf(leaf.primitive, seen, leaf.faint, culls ? 1 : 0);
        if (!(half_width > 0)) return mark = place;
        const Affine unit_from_seen = inverse(seen_from_unit);
        // Leaves that a singular map crushes onto a line or a sheet pile up there, and specks do: one leaf a
        // cell is enough.
        const bool speck = leaf.faint && largest_stretch(seen.linear) <= half_width;
        mark = unit_from_seen * wide;
        if (leaf.crushed || speck)
            mark = Affine::scale(Vec3(largest_stretch(unit_from_seen.linear))) * speck_mark(wide, half_width);
        return unit_from_seen * wide;
    }

    /// Walks once more, for all painters.
    void colour_leaves() {
        LeafWalk walk(cut_, symmetry_, request_, request_.painters);
        WalkedLeaf leaf;
        std::size_t next = 0;
        for (std::uint64_t number = 0; next < numbers_.size() && walk.next(leaf); ++number) {
            if (number != numbers_[next]) continue;
            parts_[part_of_.at(key_of(leaf))].slots.add(leaf.colours);
            ++next;
        }
    }

    std::size_t expected_leaves() const {
        return static_cast<std::size_t>(std::min(request_.expected_leaves, most_expected_leaves));
    }

    bool textured(const WalkedLeaf& leaf) const {
        return request_.pictures && !leaf.proxy && leaf.material &&
               cut_.materials[*leaf.material].is_painted();
    }

    /// Parts of about one size may share a pattern's.
    double size_of(const WalkedLeaf& leaf) const {
        if (!textured(leaf) || !cut_.materials[*leaf.material].pattern) return 1;
        constexpr double grains_an_octave = 8;
        const double size = part_size(leaf.primitive, leaf.representative_from_leaf.linear);
        return std::exp2(std::round(std::log2(size) * grains_an_octave) / grains_an_octave);
    }

    PartKey key_of(const WalkedLeaf& leaf) const {
        PartKey key;
        if (leaf.material) key.material = static_cast<std::int64_t>(*leaf.material);
        key.textured = textured(leaf);
        key.light_share = leaf.light_share;
        if (!key.textured) return key;
        const PathTint tint = rounded(leaf.tint, texture_tint_grain);
        key.tint = {tint.premultiplied.r, tint.premultiplied.g, tint.premultiplied.b, tint.alpha};
        key.size = size_of(leaf);
        return key;
    }

    void add_part(const WalkedLeaf& leaf) {
        parts_.push_back({.material = leaf.material,
                          .textured = textured(leaf),
                          .tint = rounded(leaf.tint, texture_tint_grain),
                          .size = size_of(leaf),
                          .light_share = leaf.light_share,
                          .slots = SlotTable(request_.painters.size())});
        if (parts_.size() > 1) return;
        parts_.back().leaves.reserve(expected_leaves());
        parts_.back().slots.reserve(expected_leaves());
    }

    void build(BakedPart& part) {
        MeshBuilder builder(part.smooth);
        counted_ = 0;
        const bool translucent = lets_light_through(part);
        const Affine body_from_representative = inverse(baked_.representative_from_body);
        for (std::uint32_t number = 0; number < part.leaves.size(); ++number) {
            const KeptLeaf& leaf = part.leaves[number];
            const Primitive& primitive = primitives_[leaf.primitive];
            const int level = fineness(primitive, leaf);
            Affine place = body_from_representative * leaf.place;
            if (translucent) builder.leave_out(face_of_sheet(primitive, place, leaf.wide));
            if (part.textured) {
                const double around = cut_.materials[*part.material].around;
                builder.add_textured(primitive, level, place, texture_space(primitive, around, leaf.turns),
                                     number);
                if (!goes_on(part, builder)) return;
                continue;
            }
            if (primitive == PrimitiveKind::sphere && level == 0) place = place * spread_turn(number);
            builder.add(primitive, level, place, number,
                        leaf.normals.seen_from(baked_.representative_from_body.linear[0][0],
                                               baked_.representative_from_body.translation));
            if (!goes_on(part, builder)) return;
        }
        part.leaves = {};
        builder.finish();
        part.mesh = std::move(builder.mesh);
        part.leaf_of_triangle = std::move(builder.leaf_of_triangle);
        baked_.triangles += part.mesh.triangles.size();
    }

    bool lets_light_through(const BakedPart& part) const {
        const std::optional<MaterialId> id = part.material ? part.material : request_.material;
        return id && cut_.materials[*id].translucency > 0 && !cut_.materials[*id].is_transparent();
    }

    /// The side to which one of the two faces of a sheet looks; 0 if it is none.
    static Vec3 face_of_sheet(const Primitive& primitive, const Affine& place, bool wide) {
        const auto sheet = sheet_of(primitive, place.linear, wide);
        return sheet ? sheet->normal : Vec3(0.0);
    }
    /// Counts what the last leaf has brought. False where that is too much: triangles of pictures have
    /// corners of their own, and a flat mesh may lose what other faces hide.
    bool goes_on(const BakedPart& part, const MeshBuilder& builder) {
        const std::size_t price = part.textured ? 2 : 1, most_hidden = part.smooth ? 1 : 4;
        const std::size_t here = builder.triangle_count();
        baked_.made_triangles += price * (here - std::exchange(counted_, here));
        baked_.complete = baked_.triangles + price * here <= most_hidden * max_triangles_ &&
                          baked_.made_triangles <= request_.most_made_triangles;
        return baked_.complete;
    }

    void finish(BakedPart& part) {
        if (part.mesh.triangles.empty()) return;
        if (part.textured) {
            GRAFTAL_CHECK(request_.painters.size() == 1, "bake: a picture has one painter");
            baked_.parts.push_back({part.material,
                                    std::move(part.mesh),
                                    {{Rgb(1.0)}},
                                    true,
                                    part.tint,
                                    part.size,
                                    part.light_share});
            return;
        }
        part.mesh.slot_count = part.slots.slot_count();
        if (part.mesh.slot_count > 1) {
            part.mesh.slot_of_triangle.reserve(part.leaf_of_triangle.size());
            for (const std::uint32_t leaf : part.leaf_of_triangle)
                part.mesh.slot_of_triangle.push_back(part.slots.slot_of(leaf));
        }
        baked_.parts.push_back({part.material,
                                std::move(part.mesh),
                                part.slots.take_palettes(),
                                false,
                                {},
                                1,
                                part.light_share});
    }

    int fineness(const Primitive& primitive, const KeptLeaf& leaf) {
        if (max_fineness(primitive) == 0) return 0;
        const double px = norm(leaf.place.linear) * request_.pixels_per_unit;
        const double error_px = request_.pixels_per_unit / request_.detail_per_unit;
        const int level = fineness_for(primitive, tessellation_tolerance(error_px) / std::max(px, 1e-300));
        baked_.tessellation_px = std::max(baked_.tessellation_px, px * tessellation_error(primitive, level));
        return level;
    }

    static constexpr std::uint64_t leaves_a_look = 1 << 10;

    const DetailGraph& cut_;
    const Symmetry& symmetry_;
    const BakeRequest& request_;
    std::size_t max_triangles_;
    std::uint64_t widened_ = 0; ///< leaves
    std::size_t counted_ = 0;   ///< triangles of the part that is being built
    PrimitiveNumbers primitives_;
    Baked baked_;
    std::vector<BakedPart> parts_;
    std::map<PartKey, std::size_t> part_of_;
    std::vector<std::uint64_t> numbers_; ///< of the leaves that are kept, in the order of the walk
};

} // namespace

PathTint rounded(const PathTint& tint, double grain) {
    return {glm::round(tint.premultiplied / grain) * grain, std::round(tint.alpha / grain) * grain};
}

Baked bake(const DetailGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
           std::size_t max_triangles) {
    if (!request.shell) return Baker(cut, symmetry, request, max_triangles).bake();
    ShellRequest shell;
    shell.node = request.representative;
    shell.steps = request.steps;
    shell.detail_per_unit = request.detail_per_unit;
    shell.most_work = std::min(shell.most_work, request.most_shell_work);
    shell.material = request.material;
    shell.store = request.shells;
    shell.cancel = request.cancel;
    for (const Painter& painter : request.painters)
        shell.inherited.push_back(painter.inherited);
    return bake_shell(cut, shell, max_triangles);
}

} // namespace graftal
