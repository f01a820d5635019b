#include "runtime/trace/traverse/traversal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "compiler/primitives/part_size.h"
#include "compiler/primitives/sheet.h"
#include "compiler/primitives/solid.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stretch.h"
#include "runtime/trace/mattes.h"
#include "runtime/trace/model/surface_normal.h"
#include "runtime/trace/shade/patterns.h"
#include "runtime/trace/traverse/even.h"
#include "runtime/trace/traverse/kernel.h"
#include "runtime/trace/traverse/leaves.h"
#include "runtime/trace/traverse/packet_room.h"
#include "runtime/trace/traverse/runs.h"
#include "runtime/trace/traverse/specks.h"

namespace graftal {

Instructions best_instructions() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return Instructions::avx2;
#endif
    return Instructions::portable;
}

Traversal::Traversal(const TraceModel& model, Instructions instructions)
    : model_(model), instructions_(instructions) {
    frames_.resize(16);
    later_.resize(128);
    if (!model.even) return;
    even_frames_.resize(16);
    EvenPlaces{*this, model, {}}.find_root();
    packet_ = std::make_unique<PacketRoom>();
    packet_->has_textures = std::ranges::any_of(model.textures.of_material,
                                                [](const auto& texture) { return texture != nullptr; });
    packet_->has_patterns = std::ranges::any_of(
        model.prepared.cut.materials, [](const Material& material) { return bool(material.pattern); });
}

Traversal::~Traversal() = default;

namespace {

// The kernel is made in here: what nobody else has the address of stays in registers.
template<typename Kernel, typename... From>
bool run_portable(Traversal& traversal, const TraceModel& model, const RayRange& range, const Ray& ray,
                  const From*... from) {
    return Kernel{traversal, model, range}.run(ray, from...);
}

template<typename Kernel, typename... From>
GRAFTAL_AVX2 bool run_avx2(Traversal& traversal, const TraceModel& model, const RayRange& range,
                           const Ray& ray, const From*... from) {
    return Kernel{traversal, model, range}.run(ray, from...);
}

Rgb colour_of(const Texture::Texel& texel) {
    static const std::array<double, 256> linear = [] {
        std::array<double, 256> levels;
        for (std::size_t level = 0; level < levels.size(); ++level)
            levels[level] = srgb_decoded(static_cast<std::uint8_t>(level));
        return levels;
    }();
    return {linear[texel.srgb[0]], linear[texel.srgb[1]], linear[texel.srgb[2]]};
}

} // namespace

template<template<Instructions, bool> typename AnyKernel, bool any, typename... From>
bool Traversal::run(const Ray& ray, const RayRange& range, const From*... from) {
    if constexpr (knows_avx2)
        if (instructions_ == Instructions::avx2)
            return run_avx2<AnyKernel<Instructions::avx2, any>>(*this, model_, range, ray, from...);
    return run_portable<AnyKernel<Instructions::portable, any>>(*this, model_, range, ray, from...);
}

template<bool any> bool Traversal::run(const Ray& ray, const RayRange& range) {
    if (model_.even) return run<EvenKernel, any>(ray, range);
    return run<Kernel, any>(ray, range);
}

bool Traversal::ask_operands(const Ray& ray, const Frame& frame, std::uint32_t first, std::uint32_t end,
                             std::uint32_t tree, const RayRange& range) {
    const Ray copy = ray;
    return run<Kernel, false>(copy, range, &frame, &first, &end, &tree);
}

bool Traversal::meet_asked(const Primitive& primitive, const Ray& ray, const RayRange& range,
                           PrimitiveHit& hit) {
    if (search_ == Search::surface) return meet(primitive, ray, range, hit);
    RayRange left{range.least, search_ == Search::inside ? INFINITY : range.most};
    while (meet(primitive, ray, left, hit)) {
        if (leaves_solid(primitive, ray, hit) == (search_ == Search::inside)) return true;
        if (search_ == Search::inside) return false;
        left.least = hit.t;
    }
    // A half space may be entered and never left.
    if (search_ != Search::inside || primitive != PrimitiveKind::plane) return false;
    hit.t = INFINITY;
    return ray(range.least).y < 0;
}

bool Traversal::goes_on() {
    if (visits_ <= visit_limit_) return true;
    if (hurries_) return false;
    hurries_ = true;
    ++given_up_;
    if (best_.found) return false;
    visit_limit_ = visits_ + model_.more_visits();
    return true;
}

bool Traversal::closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) {
    if (!run<false>(ray, range)) return false;
    show_best(hit);
    return true;
}

void Traversal::show_best(SurfaceHit& hit) {
    path_.clear();
    std::size_t length = 0;
    for (const std::uint32_t edge : way_)
        length += model_.looks[edge & ~from_cut].length;
    more_work_ += RayWork::shaded * length;
    if (tells_instances_ || best_.proxy_node != no_edge ||
        model_.projection.error_px() > SelfShadows::lit_as_px)
        for (const std::uint32_t edge : way_)
            append_to_path(edge);
    surface_at_best(hit);
    if (tells_instances_) hit.instance = instance_at_best();
    more_work_ += RayWork::pattern_wave * hit.material->pattern.waves();
}

bool Traversal::meets_any(const Ray& ray, const RayRange& range) {
    return run<true>(ray, range);
}

bool Traversal::all_opaque() const {
    return std::ranges::none_of(model_.prepared.cut.materials, &Material::is_transparent);
}

void Traversal::append_to_path(std::uint32_t edge) {
    const TraceLook& whole = model_.looks[edge & ~from_cut];
    if (whole.before == no_edge) {
        path_.push_back(edge);
        return;
    }
    append_to_path(whole.before);
    append_to_path(whole.last);
}

/// The id of the way to the last object, by the place of each instance in its object. An object's own
/// primitives, and a node that stands for some of its instances, are no new object.
std::uint32_t Traversal::instance_at_best() {
    instance_way_.clear();
    std::size_t length = 0;
    std::uint32_t object = TraceLook::none;
    for (const std::uint32_t step : path_) {
        const TraceLook& look = model_.looks[step & ~from_cut];
        instance_way_.push_back(model_.places[step & ~from_cut] | (step & from_cut));
        if (look.node == TraceLook::none || (look.node == object && look.levels == 0)) continue;
        object = look.node;
        length = instance_way_.size();
    }
    return matte_id(std::span(instance_way_).first(length));
}

const TraceMesh& Traversal::shell_of(const Frame& frame) {
    const TraceNode& node = model_.nodes[frame.node];
    const Affine world_from_node = frame.world_from_node.affine();
    const Ball ball{world_from_node(vec3_of(node.ball_centre)), frame.scale * node.ball_radius};
    const Affine& graph_from_frame = model_.graph_from_frame[frame.node];
    const double detail_per_unit = frame.scale * model_.projection.detail_per_unit(ball);
    const PieceKind key =
        model_.meshes.key(model_.layers.source[frame.node], graph_from_frame, frame.steps, detail_per_unit);
    const auto hash = static_cast<std::size_t>(key.unit_step) * 31 + key.node * 13 + key.steps;
    auto& [known, mesh] = meshes_[hash % meshes_.size()];
    if (!mesh || known != key) {
        mesh = &model_.meshes.mesh(key, graph_from_frame);
        known = key;
    }
    return *mesh;
}

std::optional<MaterialId> Traversal::material_of(std::uint32_t edge) const {
    return model_.looks[edge & ~from_cut].material;
}

const Texture::Texel& Traversal::texel(MaterialId material, std::uint32_t edge, double turns,
                                       Vec3 point) const {
    const TraceEdge& way = model_.edges[edge & ~from_cut];
    const Primitive& primitive = model_.nodes[way.child].primitive;
    const double around = model_.prepared.cut.materials[material].around;
    const auto [u, v] = texture_coordinates(primitive, texture_space(primitive, around, turns), point);
    return model_.textures.of_material[material]->at(u, v);
}

bool Traversal::is_clear(std::uint32_t edge, std::uint32_t frame, double turns, Vec3 point) const {
    std::optional<MaterialId> material = material_of(edge);
    for (std::uint32_t i = frame; i > 0 && !material; --i)
        material = material_of(frames_[i].edge);
    if (!material || !model_.textures.of_material[*material] ||
        model_.textures.of_material[*material]->coverage == 1)
        return false;
    return texel(*material, edge, turns, point).clear;
}

Vec3 Traversal::normal_at_best() const {
    const bool limit = best_.proxy_node != no_edge && model_.options.limit_normals && !best_.crushed;
    if (!limit && best_.is_upright) return glm::normalize(best_.normal);
    if (!limit) return transformed_normal(best_.world_from_leaf, best_.normal);
    if (!best_.in_world) return limit_normal(model_, path_, best_.proxy_node, best_.normal);
    const Vec3 normal = transformed_normal(best_.world_from_leaf, best_.normal);
    return limit_normal_in_world(model_, path_, normal, ray_(best_.t));
}

const Primitive& Traversal::primitive_at_best() const {
    return model_.nodes[model_.edges[way_.back() & ~from_cut].child].primitive;
}

Vec3 Traversal::to_far_side_at_best() const {
    if (best_.mesh_colour || best_.is_upright) return Vec3(0.0);
    const bool is_proxy = best_.proxy_node != no_edge;
    const Primitive primitive = is_proxy ? Primitive(PrimitiveKind::sphere) : primitive_at_best();
    const auto sheet = sheet_of(primitive, best_.world_from_leaf.affine().linear, best_.in_world);
    if (!sheet) return Vec3(0.0);
    return std::copysign(sheet->thickness, glm::dot(sheet->normal, ray_.direction)) * sheet->normal;
}

/// Share of light at a hit that stands for a culled part.
double Traversal::light_share_at_best() const {
    const double error_px = model_.projection.error_px();
    if (!(error_px > SelfShadows::lit_as_px)) return 1;
    const auto from_culled = [](std::uint32_t step) { return (step & from_cut) != 0; };
    const auto end = std::ranges::find_if(path_, from_culled);
    if (end == path_.begin() || (end == path_.end() && best_.proxy_node == no_edge)) return 1;
    Affine world_from_node;
    for (auto step = path_.begin(); step != end; ++step)
        world_from_node = world_from_node * model_.edges[*step & ~from_cut].parent_from_child.affine();
    const std::uint32_t number = model_.edges[end[-1] & ~from_cut].child;
    const TraceNode& node = model_.nodes[number];
    const Ball ball{world_from_node(vec3_of(node.ball_centre)),
                    largest_stretch(world_from_node.linear) * node.ball_radius};
    const double detail = 2 * ball.radius * model_.projection.detail_per_unit(ball);
    if (!(detail <= 1)) return 1; // no level was left, or the model names a shape
    return model_.self_shadows().share(model_.layers.source[number], detail * error_px);
}

/// One step further: several edges at once where an unrolling knows their result.
void Traversal::look_along(std::uint32_t step, WayLook& look, SurfaceHit& hit) const {
    const TraceLook& edge = model_.looks[step & ~from_cut];
    if (!edge.as_one) {
        look_along(edge.before, look, hit);
        return look_along(edge.last, look, hit);
    }
    const bool at_terminal = step & from_cut && look.has_mean;
    look.descend(look_step(edge, at_terminal ? &model_.source(look.parent).mean : nullptr,
                           model_.prepared.cut.materials));
    look.parent = edge.child;
    look.has_mean = edge.child_has_mean;
    if (edge.node != TraceLook::none) hit.node = edge.node;
    hit.levels += edge.levels;
}

void Traversal::surface_at_best(SurfaceHit& hit) const {
    static const Material plain;
    const std::vector<Material>& materials = model_.prepared.cut.materials;
    hit.material = &plain;
    hit.node = SurfaceHit::no_node;
    hit.levels = 0;
    WayLook look;
    for (const std::uint32_t step : way_)
        look_along(step, look, hit);
    if (look.material) hit.material = &materials[*look.material];
    const PathTint& tint = look.tint;
    Rgb inherited = look.inherited;
    const std::optional<MaterialId> material = look.material;
    if (best_.mesh_colour) {
        inherited = best_.mesh_colour->fixed + best_.mesh_colour->open * inherited;
        if (best_.mesh_colour->material) hit.material = &materials[*best_.mesh_colour->material];
        if (model_.projection.culls())
            model_.meshes.note(best_.cell * model_.projection.detail_per_unit({ray_(best_.t), 0}));
    } else if (best_.proxy_node == no_edge && material && model_.textures.of_material[*material])
        inherited = colour_of(texel(*material, way_.back(), best_.turns, best_.point));
    if (best_.proxy_node != no_edge) {
        const DetailNode& stands_for = model_.source(best_.proxy_node);
        inherited = colour_of_proxy(stands_for).over(inherited);
        if (stands_for.finish) hit.material = &materials[*stands_for.finish];
    }
    hit.t = best_.t;
    hit.normal = best_.inverted ? -normal_at_best() : normal_at_best();
    hit.light_share = light_share_at_best();
    hit.faded = 0;
    hit.to_far_side = hit.material->translucency > 0 ? to_far_side_at_best() : Vec3(0.0);
    if (best_.proxy_node == no_edge && !best_.mesh_colour && hit.material->pattern) {
        const double size = part_size(primitive_at_best(), best_.world_from_leaf.affine().linear);
        inherited = pattern_at_best(pattern_size(size), hit);
    }
    hit.rgb = tint.over(inherited);
}

/// The colour that the material's pattern has where the ray meets it. Its relief tilts the normal.
Rgb Traversal::pattern_at_best(double size, SurfaceHit& hit) const {
    const Vec3 place = ray_(best_.t);
    const SolidPattern& pattern = hit.material->pattern;
    const PatternValue at =
        pattern_at(pattern, size, 1 / model_.projection.pixels_per_unit({place, 0}), place);
    if (pattern.bump != 0) show_relief(at, pattern.bump, glm::normalize(ray_.direction), hit);
    return pattern_colour(pattern, hit.material->rgb, at.value);
}

} // namespace graftal
