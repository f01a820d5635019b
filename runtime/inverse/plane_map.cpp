#include "runtime/inverse/plane_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graftal {

PlaneStretch stretch_of(const PlaneMap& map) {
    const double e = (map.a + map.d) / 2, f = (map.a - map.d) / 2;
    const double g = (map.c + map.b) / 2, h = (map.c - map.b) / 2;
    const double turned = std::sqrt(e * e + h * h), mirrored = std::sqrt(f * f + g * g);
    const double difference = std::atan2(g, f), sum = std::atan2(h, e);
    return {turned + mirrored, turned - mirrored, (sum + difference) / 2, (sum - difference) / 2};
}

PlaneMap map_of(const PlaneStretch& s, Vec2 from, Vec2 to) {
    const double cl = std::cos(s.left_rad), sl = std::sin(s.left_rad);
    const double cr = std::cos(s.right_rad), sr = std::sin(s.right_rad);
    const PlaneMap map{cl * s.largest * cr - sl * s.least * sr,
                       -cl * s.largest * sr - sl * s.least * cr,
                       sl * s.largest * cr + cl * s.least * sr,
                       -sl * s.largest * sr + cl * s.least * cr,
                       0,
                       0};
    return map.taking(from, to);
}

PlaneMap PlaneMap::taking(Vec2 from, Vec2 to) const {
    const PlaneMap linear{a, b, c, d, 0, 0};
    const Vec2 shift = to - linear(from);
    return {a, b, c, d, shift.x, shift.y};
}

std::array<double, 6> PlaneMap::log_slope() const {
    double size = determinant();
    if (std::abs(size) < 1e-7) size = 1e-7;
    return {d / size, -c / size, 0, -b / size, a / size, 0};
}

std::array<std::array<double, 6>, 4> PlaneMap::similar_steps() const {
    const double mirror = determinant() < 0 ? -1 : 1;
    return {{{1, 0, 0, 0, mirror, 0}, {0, -mirror, 0, 1, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1}}};
}

PlaneMap PlaneMap::random(bool missed, bool similar, Draws& draws) {
    constexpr double pi = std::numbers::pi;
    PlaneStretch stretch;
    stretch.largest = std::exp(draws.between(std::log(missed ? 0.05 : 0.12), std::log(0.85)));
    stretch.least = stretch.largest * std::exp(-0.3 * std::abs(draws.normal()));
    if (missed && draws.unit() < 0.15) stretch.least *= 0.02; // such as the stem of a fern
    if (similar) stretch.least = stretch.largest;
    if (draws.unit() < 0.5) stretch.least = -stretch.least;
    stretch.left_rad = draws.between(-pi, pi);
    stretch.right_rad = draws.between(-pi, pi);
    return map_of(stretch, Vec2(0.0), Vec2(0.0));
}

double largest_stretch(const PlaneMaps& maps) {
    double largest = 0;
    for (const PlaneMap& map : maps)
        largest = std::max(largest, stretch_of(map).largest);
    return largest;
}

PlaneMap moved(const PlaneMap& map, const double* step, Vec2 centre, double most) {
    const Vec2 image = map(centre) + Vec2(step[2], step[5]);
    const PlaneMap result{map.a + step[0], map.b + step[1], map.c + step[3], map.d + step[4], 0, 0};
    PlaneStretch stretch = stretch_of(result);
    if (stretch.largest > most) {
        stretch.largest = most;
        stretch.least = std::clamp(stretch.least, -most, most);
        return map_of(stretch, centre, image);
    }
    return result.taking(centre, image);
}

PlaneMap nearest_similarity(const PlaneMap& map, Vec2 centre) {
    const double mirror = map.determinant() < 0 ? -1 : 1;
    const double p = (map.a + mirror * map.d) / 2, q = (map.c - mirror * map.b) / 2;
    return PlaneMap{p, -mirror * q, q, mirror * p, 0, 0}.taking(centre, map(centre));
}

PlaneMap bounded_inverse(const PlaneMap& map, Vec2 centre, double least) {
    const PlaneStretch s = stretch_of(map);
    const double wide = std::max(s.largest, least);
    const double narrow = std::copysign(std::max(std::abs(s.least), least), s.least);
    return map_of({1 / wide, 1 / narrow, -s.right_rad, -s.left_rad}, map(centre), centre);
}

Vec2 fixed_point(const PlaneMap& map) {
    const double a = 1 - map.a, d = 1 - map.d;
    const double determinant = a * d - map.b * map.c;
    return {(map.e * d + map.b * map.f) / determinant, (a * map.f + map.c * map.e) / determinant};
}

double Draws::normal() {
    const double radius = std::sqrt(-2 * std::log(1 - unit()));
    return radius * std::cos(2 * std::numbers::pi * unit());
}

} // namespace graftal
