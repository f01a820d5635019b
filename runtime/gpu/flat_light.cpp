#include "runtime/gpu/flat_light.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/detail/least_width.h"
#include "compiler/detail/projection.h"
#include "compiler/support/axes_across.h"
#include "runtime/gpu/flat_words.h"
#include "runtime/trace/pixel_filter.h"

namespace graftal {

namespace {

using kernel_layout::Lamp;
using kernel_layout::Scene;

/// Boxes and parts that one ray may go to, and those that it may go to when all that can be is culled.
constexpr std::uint32_t most_steps = 1 << 16, more_steps = 1 << 12;

/// The first of a picture's texels among the kernel's; each is a word of three levels and whether it is
/// clear.
std::uint32_t add_texture(const Texture& texture, FlatModel& flat) {
    const auto first = static_cast<std::uint32_t>(flat.texels.size());
    for (const Texture::Texel& texel : texture.texels)
        flat.texels.push_back(flat_bits(texel.srgb[0] | texel.srgb[1] << 8 | texel.srgb[2] << 16 |
                                        (texel.clear ? 1u : 0u) << 24));
    if (texture.coverage < 1) flat.scene.tables.y = 1;
    return first;
}

/// Where a pattern begins among the texels, as kernel/pattern.glsl reads it.
std::uint32_t add_pattern(const SolidPattern& pattern, FlatModel& flat) {
    const auto first = static_cast<std::uint32_t>(flat.texels.size());
    const auto add = [&](std::initializer_list<double> numbers) {
        for (const double number : numbers)
            flat.texels.push_back(static_cast<float>(number));
    };
    add({static_cast<double>(pattern.layers.size()), pattern.bump * relief_depth});
    add({pattern.low.r, pattern.low.g, pattern.low.b, pattern.high.r, pattern.high.g, pattern.high.b});
    for (const PatternLayer& layer : pattern.layers)
        add({static_cast<double>(layer.kind), static_cast<double>(layer.octaves), layer.warp,
             flat_length(layer.scale), layer.of_world ? 1.0 : 0.0, layer.stretch.x, layer.stretch.y,
             layer.stretch.z, layer.share});
    return first;
}

void add_waves(FlatModel& flat) {
    static_assert(pattern_levels == PATTERN_LEVELS && pattern_waves == PATTERN_WAVES);
    flat.scene.tables.z = static_cast<std::uint32_t>(flat.texels.size());
    for (const auto& level : pattern_table())
        for (const PatternWave& wave : level)
            for (const double number : {wave.direction.x, wave.direction.y, wave.direction.z, wave.phase})
                flat.texels.push_back(static_cast<float>(number));
}

void add_material(const Material& material, const Texture* texture, FlatModel& flat) {
    const Interior interior = interior_of(material);
    const auto add = [&](double x, double y, double z, double w) {
        flat.materials.push_back(flat_four({x, y, z}, w));
    };
    flat.materials.push_back(flat_four(material.rgb, material.ambient));
    add(material.diffuse, material.specular, material.roughness, material.reflection);
    add(material.translucency, material.emission, material.metallic, material.transparency);
    const std::uint32_t pattern = material.pattern ? add_pattern(material.pattern, flat) : NONE;
    flat.features.patterned = flat.features.patterned || material.pattern;
    flat.materials.emplace_back(material.filter, material.ior, material.blur, flat_bits(pattern));
    flat.materials.push_back(flat_four(glm::min(interior.absorbed, Rgb(1e30)), interior.ior));
    if (texture)
        flat.materials.emplace_back(flat_bits(add_texture(*texture, flat)),
                                    static_cast<float>(texture->width), static_cast<float>(texture->height),
                                    static_cast<float>(material.around));
    else
        flat.materials.emplace_back(flat_bits(NONE), 0, 0, 0);
}

std::uint32_t last_material(const FlatModel& flat) {
    return static_cast<std::uint32_t>(flat.materials.size() / MATERIAL_SIZE) - 1;
}

/// Lights as the shader has them (Shader::Shader()).
void add_lamps(const View& view, Scene& scene) {
    constexpr double least_light = 1e-10;
    std::uint32_t count = 0;
    const auto add = [&](const Light& light, bool area) {
        Lamp& lamp = scene.lamps[count];
        const Vec3 at = light.sun ? glm::normalize(light.location) : light.location - view.camera.location;
        lamp.at = flat_four(at, light.sun ? 1 : 0);
        lamp.rgb = flat_four(light.rgb, light.shadowless ? 1 : 0);
        if (!area) return;
        Vec3 a = light.a, b = light.b;
        bool round = light.round;
        if (light.sun) {
            const AxesAcross axes = axes_across(at);
            const double radius = std::tan(0.5 * light.angle_deg * std::numbers::pi / 180);
            a = radius * axes.a;
            b = radius * axes.b;
            round = true;
        }
        lamp.a = flat_four(a, round ? 1 : 0);
        lamp.b = flat_four(b, 1);
    };
    // Points come first, as in the shader: random numbers are taken in the order of the areas.
    for (const bool area : {false, true})
        for (const Light& light : view.lights)
            if ((light.is_area() || light.is_disc()) == area && count < MOST_LAMPS &&
                std::max({light.rgb.r, light.rgb.g, light.rgb.b}) >= least_light) {
                add(light, area);
                ++count;
            }
    scene.counts.x = count;
    if (const Light* const sun = view.sun_of_haze()) add(*sun, true);
}

void add_sky(const View& view, FlatModel& flat) {
    Scene& scene = flat.scene;
    scene.sky_zenith = flat_four(view.sky.zenith, view.sky.from);
    scene.sky_horizon = flat_four(view.sky.horizon, 1 / (view.sky.to - view.sky.from));
    scene.sky_axis = flat_four(view.sky.axis, view.shows_sky_light ? 1 : 0);
    if (!view.sky_light) {
        scene.ambient = flat_four(Rgb(1.0));
        return;
    }
    const SkyLight& light = *view.sky_light;
    const bool bounces = light.bounces > 0;
    scene.ambient = flat_four(bounces ? Rgb(0.0) : view.ambient_light());
    scene.counts.w = bounces ? light.bounces : 0;
    scene.light_up = flat_four(light.up, light.picture ? LIGHT_PICTURE
                                         : light.clear ? LIGHT_CLEAR
                                                       : LIGHT_GRADIENT);
    scene.light_zenith = flat_four(light.zenith, light.brightness);
    scene.light_horizon = flat_four(light.horizon, SkyLight::full_height);
    scene.light_below = flat_four(light.below);
    if (light.clear && !light.picture) {
        scene.light_zenith.w = static_cast<float>(light.brightness / ClearSky::kcd_of_paper);
        scene.clear_sun = flat_four(light.clear->to_sun, ClearSky::least_height);
        scene.clear_zenith = flat_four(light.clear->zenith_yxy);
        int number = 0;
        for (const auto& row : light.clear->perez)
            for (const double value : row) {
                scene.perez[number / 4][number % 4] = static_cast<float>(value);
                ++number;
            }
    }
    if (!light.picture) return;
    const SkyPicture& picture = *light.picture;
    for (int i = 0; i < 3; ++i)
        scene.picture_from_world[i] = flat_four(light.picture_from_world[i]);
    scene.picture_from_world[0].w = static_cast<float>(picture.width());
    scene.picture_from_world[1].w = static_cast<float>(picture.height());
    scene.picture_from_world[2].w = picture.sampling().any() ? 1 : 0;
    for (const SkyPicture::Texel& texel : picture.texels())
        flat.texels.insert(flat.texels.end(), texel.begin(), texel.end());
    for (const double sum : picture.sampling().rows())
        flat.texels.push_back(static_cast<float>(sum));
    const std::span<const float> columns = picture.sampling().columns();
    flat.texels.insert(flat.texels.end(), columns.begin(), columns.end());
}

/// Where the whole model is a set in a plane, rays need not look for the nearest of thousands of parts.
void add_plane(const FlatRequest& request, const TraceBasis& basis, double most_half_width, double error_px,
               Scene& scene) {
    static_assert(NEAR_ENOUGH_SHARE == near_enough_share &&
                  PLENTY_SHARE == static_cast<float>(plenty_share) && PATIENCE == most_patience);
    const NearEnough plane(request.prepared, basis, most_half_width, error_px);
    if (plane.axis < 0) return;
    Vec3 normal(0.0);
    normal[plane.axis] = 1;
    scene.plane = flat_four(normal, plane.middle - request.view.camera.location[plane.axis]);
    scene.plane_parts = flat_four({most_half_width, plane.widened_reach, plane.terminal_reach});
}

void add_camera(const FlatRequest& request, const TraceBasis& basis, Scene& scene) {
    const View& view = request.view;
    const Camera& camera = view.camera;
    const double half_width =
        camera.orthographic ? 0.5 * camera.width : std::tan(camera.angle_deg * std::numbers::pi / 360);
    const double shape = static_cast<double>(view.size.height) / view.size.width;
    scene.eye = flat_four(camera.location);
    scene.right = flat_four(camera.right, half_width);
    scene.up = flat_four(camera.up, half_width * shape);
    scene.direction = flat_four(camera.direction, camera.orthographic ? 1 : 0);
    const double pixel = 2 * half_width / view.size.width;
    scene.lens = {static_cast<float>(view.lens.radius), static_cast<float>(view.lens.depth),
                  static_cast<float>(pixel), 0};
    const DetailOptions& detail = request.detail;
    const double unit_px = camera.orthographic ? view.size.width / camera.width : 1 / pixel;
    scene.projection = {static_cast<float>(unit_px / std::max(detail.error_px, 1e-30)),
                        static_cast<float>(nearest_to_eye(request.prepared.cut)),
                        static_cast<float>(detail.error_world.value_or(0)), detail.culls() ? 1.0f : 0.0f};
    const DetailGraph& cut = request.prepared.cut;
    double widest = 1;
    for (const DetailNode& node : cut.nodes)
        if (node.primitive) widest = std::max(widest, widened_reach(*node.primitive));
    const DetailNode& root = cut.nodes[cut.root];
    const Projection projection(view, detail, detail.error_px, nearest_to_eye(cut));
    const double most_half_width = root.widens ? projection.most_half_width(root.ball) : 0;
    scene.widths =
        flat_four({std::min(least_half_width_px, detail.error_px) / std::max(detail.error_px, 1e-30), widest,
                   widest * most_half_width});
    add_plane(request, basis, most_half_width, projection.error_px(), scene);
    const auto edge = [&](double tangent) {
        return std::pair(tangent / std::hypot(1, tangent), 1 / std::hypot(1, tangent));
    };
    if (camera.orthographic) {
        scene.edges = flat_four({half_width, 1, half_width * shape}, 1);
    } else {
        const auto across = edge(half_width), above = edge(half_width * shape);
        scene.edges = flat_four({across.first, across.second, above.first}, above.second);
    }
    constexpr double infinite = 1e30;
    const ShaderLimits& limits = request.limits;
    scene.limits = {static_cast<float>(std::min(limits.farthest, infinite)),
                    static_cast<float>(limits.least_weight), static_cast<float>(request.sampling.noise_255),
                    static_cast<float>(limits.most_surfaces)};
    scene.visits.x = most_steps;
    scene.visits.y = more_steps;
}

} // namespace

void add_light(const FlatRequest& request, const TraceBasis& basis, FlatModel& flat) {
    const View& view = request.view;
    Scene& scene = flat.scene;
    add_sky(view, flat); // its picture comes first among the texels
    add_material(Material(), nullptr, flat);
    const std::vector<Material>& materials = request.prepared.cut.materials;
    for (std::size_t i = 0; i < materials.size(); ++i)
        add_material(
            materials[i],
            i < request.textures.of_material.size() ? request.textures.of_material[i].get() : nullptr, flat);
    add_lamps(view, scene);
    add_camera(request, basis, scene);
    bool opaque = std::ranges::none_of(request.prepared.cut.materials, &Material::is_transparent);
    if (view.ground) {
        const bool clear = view.ground->material.is_transparent();
        add_material(view.ground->material, nullptr, flat);
        scene.visits.z = last_material(flat);
        scene.ground = flat_four({view.ground->height - view.camera.location.y, 1, clear ? 1.0 : 0.0});
        opaque = opaque && !clear;
    }
    if (view.catcher) {
        Material paper;
        paper.rgb = view.catcher->rgb;
        paper.ambient = 0;
        paper.diffuse = 1;
        paper.specular = 0;
        add_material(paper, nullptr, flat);
        scene.visits.w = last_material(flat);
        scene.catcher = flat_four(view.catcher->centre - view.camera.location, view.catcher->radius);
    }
    if (view.haze) {
        scene.haze = flat_four({flat_length(view.haze->distance), view.haze->base - view.camera.location.y,
                                view.haze->is_even() ? 0 : flat_length(view.haze->height)},
                               view.sun_of_haze() ? view.haze->sun : 0);
        scene.haze_rgb = flat_four(view.haze->rgb);
    }
    scene.ambient.w = static_cast<float>(view.film.exposure);
    flat.features.glassy = !opaque;
    flat.features.translucent =
        std::ranges::any_of(materials, [](const Material& material) { return material.translucency > 0; });
    scene.looks = {view.film.soft ? 1 : 0, 2, 0, 0};
    if (flat.features.patterned) add_waves(flat);
    scene.tables.x = static_cast<std::uint32_t>(flat.texels.size());
    const PixelFilter filter;
    static_assert(PixelFilter::steps == FILTER_STEPS);
    for (const double offset : filter.offsets())
        flat.texels.push_back(static_cast<float>(offset));
}

} // namespace graftal
