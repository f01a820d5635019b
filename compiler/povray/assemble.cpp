#include "compiler/povray/assemble.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/alike_set.h"
#include "compiler/detail/bake.h"
#include "compiler/detail/mesh_builder.h"
#include "compiler/detail/placed_set.h"
#include "compiler/detail/run_cells.h"
#include "compiler/detail/shell_shares.h"
#include "compiler/detail/tessellate.h"
#include "compiler/detail/texture_space.h"
#include "compiler/detail/work.h"
#include "compiler/povray/placed_runs.h"
#include "compiler/support/id_table.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// One thing at its place, before the meshes exist.
struct Placed {
    static constexpr std::uint32_t no_request = UINT32_MAX;

    std::uint32_t request = no_request; ///< which mesh; none: a primitive
    std::uint32_t painter = 0;
    PrimitiveKind kind = PrimitiveKind::sphere;
    Affine world_from_thing; ///< the request's representative, or the primitive
    PathTint tint;           ///< of a mesh
    Rgb rgb{0.8};            ///< of a primitive, tints in front
    std::optional<MaterialId> material;
    std::optional<std::uint32_t> textured; ///< one of the primitives with pictures
};

/// A primitive as a mesh with a picture round it.
struct TexturedPrimitive {
    PrimitiveKind kind = PrimitiveKind::sphere;
    int fineness = 0;
    double around = 1, along = 1;
    auto operator<=>(const TexturedPrimitive&) const = default;
};

using PainterKey = std::tuple<std::uint32_t, std::uint32_t, std::array<double, 3>>;
/// Meshes with pictures have one painter each, others any number.
using RequestKey = std::tuple<NodeId, std::uint32_t, std::int32_t, std::int64_t, std::optional<PainterKey>>;

/// Places whose maps differ by no more than this factor in any direction share a mesh whose parts are drawn
/// wider than they are, so that these come out as wide to within it.
constexpr double most_width_ratio = 1.3;

bool nearly_as_wide(const Mat3& a, const Mat3& b) {
    const Mat3 a_from_b = a * glm::inverse(b);
    constexpr double most_volume = most_width_ratio * most_width_ratio * most_width_ratio;
    const double volume = std::abs(glm::determinant(a_from_b));
    if (!(volume <= most_volume && volume >= 1 / most_volume)) return false; // most differ by far
    const Vec3 sigma = singular_values(a_from_b);
    return sigma.x <= most_width_ratio && sigma.z >= 1 / most_width_ratio;
}

std::array<double, 3> as_array(const Rgb& rgb) {
    return {rgb.r, rgb.g, rgb.b};
}

/// Depth-first unfolding down to the pieces that become meshes.
class Unfolding {
  public:
    Unfolding(const CutGraph& cut, const Symmetry& symmetry, const Projection& projection,
              const Choice& choice, Weights& weights)
        : cut_(cut), symmetry_(symmetry), projection_(projection), choice_(choice), weights_(weights),
          seen_(cut.nodes[cut.root].ball.radius) {}

    bool run(const Piece& root, AssemblyLimits& limits) {
        std::vector<Piece> stack = {root};
        std::vector<Piece> children;
        while (!stack.empty()) {
            const Piece piece = stack.back();
            stack.pop_back();
            limits.work_seconds -= (1 + more_work_) / WorkRates::leaves;
            more_work_ = 0;
            if (limits.meter) limits.meter->add();
            if (placed.size() + runs.part_count() > limits.max_placements || limits.work_seconds < 0)
                return false;
            const std::size_t before = runs.part_count();
            visit(piece, children);
            limits.work_seconds -= static_cast<double>(runs.part_count() - before) / WorkRates::leaves;
            stack.insert(stack.end(), children.rbegin(), children.rend());
        }
        return true;
    }

    /// How large the details of a request look in its middle, as a share of where they are largest.
    double seen_share(const BakeRequest& request) const {
        if (!request.shell) return 1;
        const auto number = static_cast<std::size_t>(&request - requests.data());
        return std::min(1.0, seen_share_[number] / request.detail_per_unit);
    }

    std::deque<Placed> placed; ///< no room for twice as many while it grows
    PlacedRuns runs;
    std::vector<BakeRequest> requests;
    std::vector<TexturedPrimitive> textured;
    double culled_detail = 0;
    double finest = std::numeric_limits<double>::infinity();

  private:
    /// Of pieces that may lie alike, in leaves; and of what is placed: it waits for memory, as leaves do not.
    static constexpr double work_of_comparison = 2, work_of_widening = 3, work_of_placing = 2;

    void visit(const Piece& piece, std::vector<Piece>& children) {
        children.clear();
        const CutNode& node = cut_.nodes[piece.node];
        if (!node.unbounded && projection_.drops(world_ball(cut_, piece))) return;
        if (node.primitive && !node.unbounded && piece.material && has_picture(*piece.material))
            return place_textured(*node.primitive, piece);
        if (node.primitive)
            return place_primitive(*node.primitive, piece.world_from_node, piece, piece.inherited);
        const double detail = detail_of(cut_, projection_, piece);
        const bool cut = is_cut(node, piece.steps, detail, projection_.error_px());
        const PieceKind kind = weights_.normalised(kind_of(cut_, projection_, piece));
        if (cut && detail <= 1) culled_detail = std::max(culled_detail, detail);
        const bool hair = is_hair(piece);
        const bool bakes = !hair && !choice_.spelt_out;
        if (node.sealed && bakes && place_mesh(piece, kind)) return;
        if (edge_count(node, cut) == 0 && node.unbounded) return; // of a plane that became a line
        if (edge_count(node, cut) == 0) return place_proxy(node, piece);
        const Weights::Weight weight = weights_.of(kind);
        if (!node.unbounded && !piece.faint && !hair && weight.leaves > 1 &&
            (weight.triangles <= choice_.threshold || weights_.is_shell(kind)) && place_mesh(piece, kind))
            return;
        if (!cut && PlacedRuns::can_hold(cut_, piece)) return runs.add(piece, *node.cell);
        bool placeable = true;
        for_each_edge(node, cut, [&](const CutEdge& edge) {
            children.push_back(descend(cut_, piece, edge, cut));
            children.back().faint = piece.faint || (cut && detail <= 1 && node.shadowless);
            placeable = placeable && (edge.similarity || is_placeable(children.back()));
        });
        if (!placeable && !node.unbounded && bakes && place_mesh(piece, kind)) return children.clear();
        if (!hair && !spells_out_specks_) return;
        more_work_ += work_of_comparison * static_cast<double>(children.size());
        std::erase_if(children, [&](const Piece& child) { return !is_new(child); });
    }

    /// Whether the piece is drawn wider than it is, and so much flatter than its node that few would share
    /// its mesh. It is spelt out.
    bool is_hair(const Piece& piece) const {
        constexpr double flattest_shape = 1e-2;
        return cut_.nodes[piece.node].widens && projection_.culls() && !choice_.spelt_out &&
               is_singular(piece.world_from_node, flattest_shape);
    }

    /// Whether POV-Ray can place it, or what it becomes.
    bool is_placeable(const Piece& piece) const {
        const bool widens = piece.faint || cut_.nodes[piece.node].widens;
        return (widens && projection_.culls()) || !is_singular(piece.world_from_node, flattest_placement);
    }

    /// Where parts of sets without area pile up, one of those that lie alike to a quarter of a pixel stands
    /// for all.
    bool is_new(const Piece& piece) {
        if (!cut_.nodes[piece.node].widens) return true;
        const Ball ball = world_ball(cut_, piece);
        const double cell = 0.5 * projection_.least_half_width(ball);
        const double size = std::max(cut_.nodes[piece.node].ball.radius, 1e-280);
        const Affine cells{(size / cell) * piece.world_from_node.linear, ball.centre / cell};
        return specks_.insert(alike_kind(piece.node, piece.steps, piece.faint), cells, piece.scale);
    }

    void keep(const Placed& thing) {
        placed.push_back(thing);
        more_work_ += work_of_placing;
    }

    void place_proxy(const CutNode& node, const Piece& piece) {
        Piece proxy = piece;
        proxy.faint = piece.faint || node.shadowless;
        place_primitive(PrimitiveKind::sphere, piece.world_from_node * node.node_from_proxy, proxy,
                        node.mean.over(piece.inherited));
    }

    void place_primitive(PrimitiveKind kind, const Affine& world_from_primitive, const Piece& piece,
                         Rgb base) {
        Placed thing;
        thing.kind = kind;
        const Ball ball = world_ball(cut_, piece);
        if (kind == PrimitiveKind::plane && is_singular(world_from_primitive, flattest_plane)) {
            const std::optional<Affine> place = place_of_plane(world_from_primitive);
            if (!place) return;
            thing.world_from_thing = *place;
        } else {
            thing.world_from_thing = drawn(kind, world_from_primitive, piece);
        }
        if (thing.world_from_thing != world_from_primitive) more_work_ += work_of_widening;
        const double half_width = projection_.least_half_width(ball);
        const bool speck =
            piece.faint && !choice_.spelt_out && largest_stretch(world_from_primitive.linear) <= half_width;
        const Affine mark = speck ? speck_mark(thing.world_from_thing, half_width) : thing.world_from_thing;
        if (!seen_.insert(static_cast<std::uint32_t>(kind), mark)) return;
        note_finest(ball);
        thing.rgb = piece.tint.over(base);
        thing.material = piece.material;
        keep(thing);
    }

    Affine drawn(PrimitiveKind kind, const Affine& world_from_primitive, const Piece& piece) const {
        if (kind == PrimitiveKind::plane) return world_from_primitive;
        return drawn_leaf(kind, world_from_primitive, piece.faint,
                          projection_.least_half_width(world_ball(cut_, piece)))
            .place;
    }

    void place_textured(PrimitiveKind kind, const Piece& piece) {
        const Ball ball = world_ball(cut_, piece);
        Placed thing;
        thing.world_from_thing = drawn(kind, piece.world_from_node, piece);
        const double px = norm(thing.world_from_thing.linear) * projection_.pixels_that_matter(ball);
        const TextureSpace space = texture_space(kind, cut_.materials[*piece.material].around, piece.turns);
        const TexturedPrimitive shape{kind,
                                      fineness_for(kind, tessellation_tolerance_px / std::max(px, 1e-300)),
                                      space.around, space.along};
        const auto [place, added] = textured_of_.emplace(shape, static_cast<std::uint32_t>(textured.size()));
        if (added) textured.push_back(shape);
        if (!seen_.insert(static_cast<std::uint32_t>(kind), thing.world_from_thing)) return;
        note_finest(ball);
        thing.textured = place->second;
        thing.tint = piece.tint;
        thing.material = piece.material;
        keep(thing);
    }

    /// The mesh that serves the piece, and whether it is a new one. As for parts that are drawn wider than
    /// they are, one that lies alike; nothing where there are too many that do not, and a mesh would not be
    /// shared.
    std::optional<std::pair<std::uint32_t, bool>> request_for(const RequestKey& key, const Piece& piece,
                                                              bool shell) {
        std::vector<std::uint32_t>& alike = request_of_[key];
        Mat3 shape(0.0);
        if (cut_.nodes[piece.node].widens && projection_.culls() && !shell) {
            const Affine place = piece.world_from_node * symmetry_.node_from_representative[piece.node];
            const Mat3 linear = is_singular(place, flattest_leaf) ? Mat3(piece.scale) : place.linear;
            shape = linear / projection_.least_half_width(world_ball(cut_, piece));
        }
        more_work_ += work_of_comparison * static_cast<double>(alike.size());
        for (const std::uint32_t request : alike)
            if (shape == Mat3(0.0) || nearly_as_wide(shape, requests[request].half_widths_from_unit))
                return std::pair(request, false);
        constexpr std::size_t most_shapes = 8;
        if (alike.size() == most_shapes) return std::nullopt;
        alike.push_back(static_cast<std::uint32_t>(requests.size()));
        requests.emplace_back();
        requests.back().half_widths_from_unit = shape;
        return std::pair(alike.back(), true);
    }

    /// False where the piece is to be spelt out.
    bool place_mesh(const Piece& piece, const PieceKind& kind) {
        const bool shell = weights_.of(kind).crowded;
        const NodeId representative = shell ? piece.node : symmetry_.representative[piece.node];
        const std::int64_t finish = piece.material ? static_cast<std::int64_t>(*piece.material) : -1;
        const RequestKey key{representative, kind.steps, weights_.mesh_bin(kind), finish, own_painter(piece)};
        const auto found = request_for(key, piece, shell);
        if (!found) {
            spells_out_specks_ = true;
            return false;
        }
        const auto [request, added] = *found;
        if (added) {
            requests[request].representative = representative;
            requests[request].steps = kind.steps;
            requests[request].material = piece.material;
            requests[request].error_px = projection_.error_px();
            requests[request].expected_leaves = weights_.of(kind).leaves;
            requests[request].shell = shell;
        }
        BakeRequest& bake = requests[request];
        const Ball ball = world_ball(cut_, piece);
        bake.detail_per_unit =
            std::max(bake.detail_per_unit, projection_.detail_per_unit(ball) * piece.scale);
        if (shell) {
            // The eye may lie within its ball, where a unit looks as large as can be.
            const double here = projection_.detail_per_unit({ball.centre, 0}) * piece.scale;
            seen_share_.resize(requests.size());
            seen_share_[request] = std::max(seen_share_[request], here);
        }
        bake.pixels_per_unit =
            std::max(bake.pixels_per_unit, projection_.pixels_that_matter(ball) * piece.scale);

        Placed thing;
        thing.request = request;
        thing.world_from_thing = piece.world_from_node;
        if (!shell)
            thing.world_from_thing = thing.world_from_thing * symmetry_.node_from_representative[piece.node];
        if (!seen_.insert(thing.request + primitive_kind_count, thing.world_from_thing)) return true;
        note_finest(ball);
        thing.painter = painter(request, shell ? 0 : symmetry_.pair[piece.node], piece.inherited);
        thing.tint = piece.tint;
        thing.material = piece.material;
        keep(thing);
        return true;
    }

    bool has_picture(MaterialId material) const { return !cut_.materials[material].texture.empty(); }

    void note_finest(const Ball& ball) {
        if (projection_.culls() && projection_.sees(ball))
            finest = std::min(finest, 1 / projection_.detail_per_unit(ball));
    }

    std::optional<PainterKey> own_painter(const Piece& piece) const {
        if (!cut_.nodes[piece.node].textured && !(piece.material && has_picture(*piece.material)))
            return std::nullopt;
        return PainterKey{0, symmetry_.pair[piece.node], as_array(piece.inherited)};
    }

    std::uint32_t painter(std::uint32_t request, std::uint32_t pair, const Rgb& inherited) {
        std::vector<Painter>& painters = requests[request].painters;
        const auto [place, added] = painter_of_.emplace(PainterKey{request, pair, as_array(inherited)},
                                                        static_cast<std::uint32_t>(painters.size()));
        if (added) painters.push_back({pair, inherited});
        return place->second;
    }

    const CutGraph& cut_;
    const Symmetry& symmetry_;
    const Projection& projection_;
    const Choice& choice_;
    Weights& weights_;
    std::map<TexturedPrimitive, std::uint32_t> textured_of_;
    PlacedSet seen_;
    std::vector<double> seen_share_; ///< by request, of shells: the detail of a unit at the middle
    AlikeSet specks_;                ///< parts of sets without area
    bool spells_out_specks_ = false;
    double more_work_ = 0; ///< in leaves, for the piece under way
    std::map<RequestKey, std::vector<std::uint32_t>> request_of_;
    std::map<PainterKey, std::uint32_t> painter_of_;
};

/// Sorts what was placed into bodies, palettes and groups of one texture.
class Grouping {
  public:
    Grouping(const CutGraph& cut, const std::vector<BakeRequest>& requests, std::vector<Baked>& baked,
             const std::vector<TexturedPrimitive>& textured)
        : cut_(cut), baked_(baked) {
        for (const TexturedPrimitive& shape : textured)
            add_textured_body(shape);
        for (std::size_t r = 0; r < baked.size(); ++r) {
            first_body_.push_back(static_cast<std::uint32_t>(result_.bodies.size()));
            palette_.emplace_back();
            for (BakedPart& part : baked[r].parts) {
                result_.triangle_count += part.mesh.triangles.size();
                box_.push_back(box_of(part.mesh));
                result_.bodies.push_back({cut.nodes[requests[r].representative].name, std::move(part.mesh)});
                palette_.back().emplace_back(part.palettes.size(), no_palette);
            }
        }
    }

    void add(const Placed& thing) {
        if (thing.textured) return add_textured(thing);
        if (thing.request == Placed::no_request) return add_primitive(thing);
        const Baked& baked = baked_[thing.request];
        for (std::uint32_t p = 0; p < baked.parts.size(); ++p) {
            const Palette& palette = baked.parts[p].palettes[thing.painter];
            const std::uint32_t body = first_body_[thing.request] + p;
            const Affine world_from_body = thing.world_from_thing * baked.representative_from_body;
            const auto& material = baked.parts[p].material;
            if (baked.parts[p].textured)
                place_picture(body, world_from_body, thing.tint * baked.parts[p].tint, *material);
            else if (palette.size() == 1)
                place(body, world_from_body, colour(thing.tint.over(palette[0])), {}, material);
            else
                place(body, world_from_body, palette_id(thing.request, p, thing.painter), thing.tint,
                      material);
            include(transformed(world_from_body, box_[body]));
        }
    }

    void add(const PlacedRuns::Range& range) {
        const Run& run = *range.source->run;
        RunPlacements parts{range.source->run,           range.first, range.count,   0,
                            range.piece.world_from_node, {},          range.left_out};
        std::vector<bool> colours(range.source->materials.size());
        for (std::size_t i = range.first; i < range.first + range.count; ++i) {
            const RunItem& item = run[i];
            colours[item.colour] = true;
            parts.body[static_cast<std::size_t>(item.kind)] = body_of(item.kind);
            if (item.ball)
                parts.body[static_cast<std::size_t>(PrimitiveKind::sphere)] = body_of(PrimitiveKind::sphere);
            include(transformed(range.piece.world_from_node, box_of(item)));
        }
        for (std::size_t colour_number = 0; colour_number < colours.size(); ++colour_number) {
            if (!colours[colour_number]) continue;
            const std::optional<MaterialId>& own = range.source->materials[colour_number];
            const Rgb base = own ? cut_.materials[*own].rgb : range.piece.inherited;
            parts.colour = static_cast<std::uint16_t>(colour_number);
            group_of(colour(range.piece.tint.over(base)), {}, own ? own : range.piece.material)
                .runs.push_back(parts);
            result_.placement_count += part_count(parts);
        }
    }

    Cut take() {
        result_.palettes = std::move(palettes_);
        return std::move(result_);
    }

  private:
    static constexpr std::uint32_t no_palette = UINT32_MAX;

    static bool share_finish(const Material& a, const Material& b) {
        return a.ambient == b.ambient && a.diffuse == b.diffuse && a.specular == b.specular &&
               a.roughness == b.roughness && a.reflection == b.reflection && a.texture == b.texture;
    }

    void include(const Box& box) {
        if (box.empty()) return;
        result_.bounds.include(box);
        result_.largest_part = std::max(result_.largest_part, largest_entry(box.size()));
    }

    /// The bodies of primitives with pictures are the first.
    void add_textured_body(const TexturedPrimitive& shape) {
        MeshBuilder builder(true);
        builder.add_textured(shape.kind, shape.fineness, {}, {shape.around, shape.along}, 0);
        builder.finish();
        result_.triangle_count += builder.mesh.triangles.size();
        box_.push_back(box_of(builder.mesh));
        result_.bodies.push_back({name_of(shape.kind), std::move(builder.mesh)});
    }

    void add_textured(const Placed& thing) {
        place_picture(*thing.textured, thing.world_from_thing, thing.tint, *thing.material);
        include(transformed(thing.world_from_thing, box_[*thing.textured]));
    }

    void place_picture(std::uint32_t body, const Affine& world_from_body, const PathTint& tint,
                       MaterialId material) {
        group_of(colour(Rgb(1.0)), rounded(tint, texture_tint_grain), cut_.materials[material])
            .placements.push_back({body, world_from_body});
        ++result_.placement_count;
    }

    void add_primitive(const Placed& thing) {
        const std::uint32_t body = body_of(thing.kind);
        place(body, thing.world_from_thing, colour(thing.rgb), {}, thing.material);
        include(transformed(thing.world_from_thing, box_[body]));
    }

    std::uint32_t body_of(PrimitiveKind primitive) {
        const auto kind = static_cast<std::size_t>(primitive);
        if (primitive_body_[kind] == no_palette) {
            primitive_body_[kind] = static_cast<std::uint32_t>(result_.bodies.size());
            box_.push_back(primitive == PrimitiveKind::plane ? Box() : primitive_bounds(primitive).box);
            result_.bodies.push_back({name_of(primitive), primitive});
        }
        return primitive_body_[kind];
    }

    /// What no picture shows makes no textures of its own.
    static constexpr double tint_grain = 1.0 / (1 << 24);

    void place(std::uint32_t body, const Affine& world_from_body, std::uint32_t palette,
               const PathTint& exact_tint, const std::optional<MaterialId>& material) {
        group_of(palette, exact_tint, material).placements.push_back({body, world_from_body});
        ++result_.placement_count;
    }

    PlacementGroup& group_of(std::uint32_t palette, const PathTint& exact_tint,
                             const std::optional<MaterialId>& material) {
        Material finish;
        if (material) finish = cut_.materials[*material];
        finish.texture.clear(); // pictures are placed by place_picture()
        return group_of(palette, rounded(exact_tint, tint_grain), finish);
    }

    PlacementGroup& group_of(std::uint32_t palette, const PathTint& tint, const Material& finish) {
        std::uint64_t hash = mixed(0, palette);
        for (const double number :
             {tint.premultiplied.r, tint.premultiplied.g, tint.premultiplied.b, tint.alpha, finish.ambient,
              finish.diffuse, finish.specular, finish.roughness, finish.reflection})
            hash = mixed(hash, std::bit_cast<std::uint64_t>(number));
        hash = mixed(hash, std::hash<std::string>()(finish.texture));
        const auto next = static_cast<std::uint32_t>(result_.groups.size());
        const std::uint32_t id = group_ids_.find_or_add(hash, next, [&](std::uint32_t other) {
            const PlacementGroup& group = result_.groups[other];
            return group.palette == palette && group.tint == tint && share_finish(group.material, finish);
        });
        if (id == next) result_.groups.push_back({palette, tint, finish, {}, {}});
        return result_.groups[id];
    }

    std::uint32_t colour(const Rgb& rgb) {
        const auto [palette, added] =
            colour_palette_.emplace(as_array(rgb), static_cast<std::uint32_t>(palettes_.size()));
        if (added) palettes_.push_back({rgb});
        return palette->second;
    }

    std::uint32_t palette_id(std::uint32_t request, std::uint32_t part, std::uint32_t painter) {
        std::uint32_t& id = palette_[request][part][painter];
        if (id == no_palette) {
            id = static_cast<std::uint32_t>(palettes_.size());
            palettes_.push_back(std::move(baked_[request].parts[part].palettes[painter]));
        }
        return id;
    }

    const CutGraph& cut_;
    std::vector<Baked>& baked_;
    Cut result_;
    std::vector<Box> box_;                                         ///< by body
    std::vector<std::uint32_t> first_body_;                        ///< by request
    std::vector<std::vector<std::vector<std::uint32_t>>> palette_; ///< by request, part, painter
    std::vector<Palette> palettes_;
    std::array<std::uint32_t, primitive_kind_count> primitive_body_ = [] {
        std::array<std::uint32_t, primitive_kind_count> none;
        none.fill(no_palette);
        return none;
    }();
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

std::optional<Cut> assemble_within(AssemblyLimits& limits, const CutGraph& cut, const Symmetry& symmetry,
                                   const Projection& projection, const Piece& root, const Choice& choice,
                                   Weights& weights, bool limit_normals, ShellStore& shells) {
    Unfolding unfolding(cut, symmetry, projection, choice, weights);
    if (!unfolding.run(root, limits)) return std::nullopt;
    ShellShares shell_shares(cut, unfolding.requests);
    std::vector<Baked> baked;
    std::size_t triangles = 0;
    double culled_detail = unfolding.culled_detail;
    double tessellation_px = 0;
    for (BakeRequest& request : unfolding.requests) {
        request.limit_normals = limit_normals;
        request.shells = &shells;
        std::size_t most_triangles = limits.max_triangles - triangles;
        if (request.shell) {
            const ShellShare share = shell_shares.take(request, limits.work_seconds, most_triangles);
            request.most_shell_work = share.work;
            most_triangles = share.triangles;
        }
        request.most_visits = static_cast<std::uint64_t>(std::min(limits.work_seconds, 1e6) *
                                                         WorkRates::visits / limits.slowness);
        baked.push_back(bake(cut, symmetry, request, most_triangles));
        if (limits.meter) limits.meter->add(baked.back().visits);
        triangles += baked.back().triangles;
        limits.work_seconds -=
            limits.slowness * static_cast<double>(baked.back().visits) / WorkRates::visits +
            static_cast<double>(baked.back().triangles) / WorkRates::baked_triangles +
            static_cast<double>(baked.back().shell_work) / WorkRates::shell_points;
        if (limits.work_seconds < 0) return std::nullopt;
        if (!baked.back().complete || triangles > limits.max_triangles) return std::nullopt;
        culled_detail = std::max(culled_detail, baked.back().culled_detail * unfolding.seen_share(request));
        tessellation_px = std::max(tessellation_px, baked.back().tessellation_px);
    }
    Grouping grouping(cut, unfolding.requests, baked, unfolding.textured);
    for (const Placed& thing : unfolding.placed)
        grouping.add(thing);
    const double finest_of_runs = unfolding.runs.sift(cut, projection);
    for (const PlacedRuns::Range& range : unfolding.runs.ranges())
        grouping.add(range);
    Cut result = grouping.take();
    result.error_px = culled_detail;
    result.tessellation_px = tessellation_px;
    result.finest = std::min(unfolding.finest, finest_of_runs);
    result.leaf_count = choice.leaves;
    return result;
}

} // namespace

std::optional<Cut> assemble(const CutGraph& cut, const Symmetry& symmetry, const Projection& projection,
                            const Piece& root, const Choice& choice, Weights& weights, bool limit_normals,
                            ShellStore& shells, AssemblyLimits& limits) {
    try {
        return assemble_within(limits, cut, symmetry, projection, root, choice, weights, limit_normals,
                               shells);
    } catch (const std::bad_alloc&) {
        return std::nullopt; // the work is taken off nevertheless
    }
}

} // namespace graftal
