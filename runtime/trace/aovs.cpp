#include "runtime/trace/aovs.h"

#include <cmath>
#include <unordered_map>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr std::string_view ground_name = "(ground)";

} // namespace

AovSample::AovSample(const SurfaceHit& hit, const Ray& ray, const View& view, const DetailGraph* named) {
    if (!hit.material) return;
    depth = glm::dot(ray(hit.t) - view.camera.location, view.camera.direction);
    normal = glm::dot(hit.normal, ray.direction) > 0 ? -hit.normal : hit.normal;
    albedo = hit.rgb;
    met = std::isfinite(depth + normal.x + normal.y + normal.z + albedo.x + albedo.y + albedo.z);
    if (!met) return;
    levels = hit.levels;
    node = view.ground && hit.material == &view.ground->material ? ground_node : hit.node;
    if (!named) return;
    const std::uint32_t object = matte_id(object_name(*named, node));
    mattes = {object, node == ground_node ? object : hit.instance, matte_id(material_name(*hit.material))};
}

void AovSum::add(const AovSample& sample, double weight, double off_middle) {
    weight_ += weight;
    if (off_middle < nearest_) {
        nearest_ = off_middle;
        node_ = sample.node;
        levels_ = sample.levels;
    }
    if (!sample.met) return;
    met_weight_ += weight;
    mattes_.add(sample.mattes, weight);
    depth_ += weight * sample.depth;
    normal_ += weight * sample.normal;
    albedo_ += weight * sample.albedo;
}

AovPixel AovSum::pixel() const {
    AovPixel pixel;
    pixel.node = node_;
    pixel.levels = levels_;
    if (!(met_weight_ > 0)) return pixel;
    pixel.coverage = static_cast<float>(met_weight_ / weight_);
    pixel.depth = static_cast<float>(depth_ / met_weight_);
    for (int c = 0; c < 3; ++c) {
        pixel.normal[c] = static_cast<float>(normal_[c] / met_weight_);
        pixel.albedo[c] = static_cast<float>(albedo_[c] / met_weight_);
    }
    return pixel;
}

std::string_view object_name(const DetailGraph& cut, std::uint32_t node) {
    return node < cut.nodes.size() ? std::string_view(cut.nodes[node].name) : ground_name;
}

std::string_view material_name(const Material& material) {
    return material.name.empty() ? "(plain)" : std::string_view(material.name);
}

ObjectNumbers::ObjectNumbers(const DetailGraph& cut) {
    std::unordered_map<std::string_view, std::uint32_t> known;
    for (const DetailNode& node : cut.nodes) {
        const auto [place, added] = known.emplace(node.name, static_cast<std::uint32_t>(names_.size() + 1));
        if (added) names_.push_back(node.name);
        number_of_node_.push_back(place->second);
    }
    names_.emplace_back(ground_name);
}

std::uint32_t ObjectNumbers::of(std::uint32_t node) const {
    if (node == ground_node) return static_cast<std::uint32_t>(names_.size());
    return node < number_of_node_.size() ? number_of_node_[node] : 0;
}

} // namespace graftal
