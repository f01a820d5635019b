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
    PlaneMap map{cl * s.largest * cr - sl * s.least * sr,
                 -cl * s.largest * sr - sl * s.least * cr,
                 sl * s.largest * cr + cl * s.least * sr,
                 -sl * s.largest * sr + cl * s.least * cr,
                 0,
                 0};
    const Vec2 shift = to - map(from);
    map.e = shift.x;
    map.f = shift.y;
    return map;
}

double largest_stretch(const PlaneMaps& maps) {
    double largest = 0;
    for (const PlaneMap& map : maps)
        largest = std::max(largest, stretch_of(map).largest);
    return largest;
}

PlaneMap moved(const PlaneMap& map, const double* step, Vec2 centre, double most) {
    const Vec2 image = map(centre) + Vec2(step[2], step[5]);
    PlaneMap result{map.a + step[0], map.b + step[1], map.c + step[3], map.d + step[4], 0, 0};
    PlaneStretch stretch = stretch_of(result);
    if (stretch.largest > most) {
        stretch.largest = most;
        stretch.least = std::clamp(stretch.least, -most, most);
        return map_of(stretch, centre, image);
    }
    const Vec2 shift = image - result(centre);
    result.e = shift.x;
    result.f = shift.y;
    return result;
}

PlaneMap nearest_similarity(const PlaneMap& map, Vec2 centre) {
    const double mirror = map.determinant() < 0 ? -1 : 1;
    const double p = (map.a + mirror * map.d) / 2, q = (map.c - mirror * map.b) / 2;
    PlaneMap result{p, -mirror * q, q, mirror * p, 0, 0};
    const Vec2 shift = map(centre) - result(centre);
    result.e = shift.x;
    result.f = shift.y;
    return result;
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
