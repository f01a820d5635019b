#include "compiler/lsys/turtle/skin.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/primitives/limb_sweep.h"
#include "compiler/primitives/swept_ring.h"

namespace graftal {

namespace {

constexpr int digits = 6;
constexpr double grain = 1e-6;

double rounded(double x, int places) {
    const double unit = std::pow(10.0, places);
    return std::round(x * unit) / unit + 0.0; // no negative zeros
}

Vec3 rounded(Vec3 v) {
    return {rounded(v.x, digits), rounded(v.y, digits), rounded(v.z, digits)};
}

/// A collar is wider than its limb by so much, where the limb that it leaves has room for it.
constexpr double most_flare = 1.8;
/// The share of that limb's thickness that a collar takes up.
constexpr double sunk = 0.98;

/// Turned so that the limb begins along y, and then turns towards x.
Mat3 frame_of(const std::vector<LimbNode>& nodes, double size) {
    const Vec3 origin = nodes.front().place;
    const auto far = [&](const LimbNode& node) { return glm::distance(node.place, origin) > grain * size; };
    const auto first = std::ranges::find_if(nodes, far);
    const Vec3 y = glm::normalize((first == nodes.end() ? nodes.back() : *first).place - origin);
    for (const LimbNode& node : nodes) {
        const Vec3 way = node.place - origin;
        const Vec3 across = way - glm::dot(way, y) * y;
        if (!(glm::length(across) > 10 * grain * size)) continue;
        const Vec3 x = glm::normalize(across);
        return Mat3(x, y, glm::cross(x, y));
    }
    const Vec3 x = some_side(y);
    return Mat3(x, y, glm::cross(x, y));
}

} // namespace

std::optional<LimbSkin> skin_of(const Limb& limb, int sides) {
    double length = 0, thickest = 0;
    for (std::size_t i = 0; i < limb.nodes.size(); ++i) {
        if (i > 0) length += glm::distance(limb.nodes[i].place, limb.nodes[i - 1].place);
        thickest = std::max(thickest, limb.nodes[i].radius);
    }
    if (!(length > 0) || !(thickest > 0)) return std::nullopt;
    const double size = std::max(length, thickest);
    // Radii have as many digits as coordinates, however thin the limb is.
    const int places = std::min(15, digits - static_cast<int>(std::floor(std::log10(thickest / size))) - 1);
    const auto radius = [&](double r) { return rounded(r / size, places); };

    LimbSkin skin;
    const double own = limb.nodes.front().radius;
    double collar = 0;
    if (limb.base == Limb::Base::limb)
        collar = std::max(own, std::min(most_flare * own, sunk * (1 - limb_dent(sides)) * limb.base_radius));
    const Mat3 frame = frame_of(limb.nodes, size);
    // The axis leaves the other limb at this depth; where it goes along with that, no deeper than twice.
    const double sine = glm::length(glm::cross(limb.base_way, frame[1]));
    const double depth = collar > own ? limb.base_radius / std::clamp(sine, 0.5, 1.0) : 0;
    skin.numbers = {double(sides), radius(collar), rounded(depth / size, digits)};
    std::optional<Vec3> last;
    for (const LimbNode& node : limb.nodes) {
        const Vec3 place = rounded(glm::transpose(frame) * (node.place - limb.nodes.front().place) / size);
        if (last && *last == place) {
            skin.numbers.back() = radius(node.radius);
            continue;
        }
        skin.numbers.insert(skin.numbers.end(), {place.x, place.y, place.z, radius(node.radius)});
        last = place;
    }
    skin.start_from_skin = {size * frame, limb.nodes.front().place};
    if (skin.numbers.size() < 11) return std::nullopt;
    return skin;
}

} // namespace graftal
