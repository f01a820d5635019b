#include "runtime/export/formats/renderer_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "runtime/export/formats/flat_files.h"
#include "runtime/export/held_parts.h"

namespace graftal {

namespace {

constexpr std::size_t most_renderer_nodes = 1'000'000;
constexpr double most_renderer_places = 2e6;

} // namespace

std::optional<RendererScene> RendererScene::make(const ExportJob& job, double bytes_of_triangle,
                                                 double bytes_of_place) {
    std::optional<UnfoldedScene> resolved =
        resolve_looks(job.scene, {most_renderer_nodes}, job.model, job.diagnostics);
    job.too_large = !resolved;
    if (!resolved) return std::nullopt;
    RendererScene made;
    made.scene_ = std::move(*resolved);
    std::optional<std::vector<bool>> held =
        hold_parts(made.scene_, job.options.parts, job.model, job.diagnostics);
    if (!held) return std::nullopt;
    made.groups_ = group_meshes(made.scene_, {.most_nodes = most_renderer_places,
                                              .triangles_of_node = bytes_of_place / bytes_of_triangle,
                                              .held = std::move(*held)});
    const double bytes = made.groups_.triangles * bytes_of_triangle + made.groups_.nodes * bytes_of_place;
    if (bytes > static_cast<double>(job.options.most_bytes)) {
        refuse_as_too_large(
            job,
            fmt::format("with one level of instances, '{}' would have {:.3g} triangles in {:.3g} "
                        "places, about {:.3g} bytes",
                        job.options.output, made.groups_.triangles, made.groups_.nodes, bytes),
            "allow it with --limit, or leave out more with a larger --error or fewer --steps");
        return std::nullopt;
    }
    made.places_ = places_of(made.scene_, made.groups_);
    // Looks by what is drawn: that of each leaf.
    for (const SceneNode& node : made.scene_.nodes) {
        if (!node.shape) continue;
        const Rgb colour = node.look.colour();
        const std::int64_t material =
            node.look.material ? static_cast<std::int64_t>(*node.look.material) : -1;
        const auto [known, is_new] =
            made.number_of_.try_emplace({material, srgb_bytes(colour)}, made.looks_.size());
        if (is_new)
            made.looks_.push_back(
                {node.look.material, colour,
                 node.look.material && !made.scene_.materials[*node.look.material].texture.empty()});
    }
    return made;
}

std::vector<GroupSurface> RendererScene::surfaces(SceneId mesh, ShapeMeshes& meshes) const {
    return surfaces_of(scene_, mesh, meshes, ColoursOf::surfaces);
}

std::string RendererScene::summary() const {
    return fmt::format("{} meshes of {:.0f} triangles, {} instances", groups_.meshes.size(),
                       groups_.triangles, places_.size());
}

std::size_t RendererScene::look_of(const GroupSurface& surface) const {
    const Rgb colour = surface.coloured ? surface.colours.front() : plain_colour(scene_, surface.material);
    const std::int64_t material = surface.material ? static_cast<std::int64_t>(*surface.material) : -1;
    const auto known = number_of_.find({material, srgb_bytes(colour)});
    if (known != number_of_.end()) return known->second;
    // Rounded another way: the nearest of the material.
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < looks_.size(); ++i) {
        const double away =
            glm::length(looks_[i].colour - colour) + (looks_[i].material == surface.material ? 0 : 10);
        if (away < least) {
            least = away;
            best = i;
        }
    }
    return best;
}

double shorter_angle_deg(const View& view) {
    constexpr double degree = std::numbers::pi / 180;
    const double across = std::tan(0.5 * view.camera.angle_deg * degree);
    const double up = across * view.size.height / view.size.width;
    return 2 * std::atan(std::min(across, up)) / degree;
}

double lamp_at_model(const UnfoldedScene& scene, const Light& light) {
    const Vec3 middle = scene.bounds.empty() ? Vec3(0.0) : scene.bounds.centre();
    const Vec3 away = light.location - middle;
    return glm::dot(away, away);
}

} // namespace graftal
