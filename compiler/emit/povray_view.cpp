#include "compiler/emit/povray_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr int digits = 12;
constexpr double extent = 1000;
constexpr double largest_extent = 3e4;
constexpr double largest_part = 2000;
constexpr double farthest_camera = 5e6;
constexpr double sun_distance = 4e6;
/// POV-Ray loses what is closer than about a thousandth (its SMALL_TOLERANCE).
constexpr double least_length = 0.02;

/// The largest of 1, 2, 5 times a power of ten that is not above the value.
double round_down(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {5.0, 2.0})
        if (step * power <= value) return step * power;
    return power;
}

double largest(Vec3 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

void write_rgb(SdlWriter& out, Rgb rgb) {
    out << "rgb ";
    out.vector(rgb, 7);
}

void write_camera(SdlWriter& out, const Camera& camera, ImageSize size, const PovrayUnits& units) {
    const double aspect = static_cast<double>(size.width) / size.height;
    const double width = camera.orthographic ? units.scale * camera.width : aspect;
    const double depth =
        camera.orthographic ? width : 0.5 * width / std::tan(camera.angle_deg * std::numbers::pi / 360);
    out << "camera {\n  " << (camera.orthographic ? std::string_view("orthographic") : "perspective")
        << "\n  location ";
    out.vector(units(camera.location), digits) << "\n  direction ";
    out.vector(depth * camera.direction, digits) << "\n  right ";
    out.vector(width * camera.right, digits) << "\n  up ";
    out.vector(width / aspect * camera.up, digits) << "\n}\n";
}

void write_light(SdlWriter& out, const Light& light, const PovrayUnits& units, Vec3 centre) {
    const Vec3 target = units(centre);
    out << "light_source { ";
    out.vector(light.sun ? target + sun_distance * light.location : units(light.location), digits) << " ";
    write_rgb(out, light.rgb);
    if (light.sun) {
        out << " parallel point_at ";
        out.vector(target, digits);
    }
    out << (light.shadowless ? std::string_view(" shadowless }\n") : " }\n");
}

void write_sky(SdlWriter& out, const Sky& sky) {
    if (sky.zenith == sky.horizon) {
        out << "background { ";
        write_rgb(out, sky.zenith);
        out << " }\n";
        return;
    }
    // A pattern of exactly 1 would wrap round to 0.
    const double slope = 1 / (sky.to - sky.from);
    out << "sky_sphere { pigment {\n  function { min(0.999999, max(0, ";
    const std::string_view axes[] = {"x*(", "y*(", "z*("};
    for (int i = 0; i < 3; ++i) {
        out << axes[i];
        out.number(slope * sky.axis[i], digits) << ") + ";
    }
    out << "(";
    out.number(-slope * sky.from, digits) << "))) }\n  color_map { [0 ";
    write_rgb(out, sky.horizon);
    out << "] [1 ";
    write_rgb(out, sky.zenith);
    out << "] }\n} }\n";
}

} // namespace

PovrayUnits choose_units(const Cut& cut, const Camera& camera) {
    const Box& bounds = cut.bounds;
    PovrayUnits units;
    if (bounds.empty()) return units;
    const double distance = largest(camera.location - bounds.centre());
    double size = 2 * largest(0.5 * bounds.max - 0.5 * bounds.min);
    if (size == 0) size = camera.orthographic ? camera.width : distance;
    if (size == 0) size = 1;
    const double usual = extent / size;
    const double most = std::min(largest_extent / size, largest_part / std::max(cut.largest_part, 1e-3 * size));
    const double wanted = std::clamp(least_length / cut.finest, usual, std::max(most, usual));
    units.scale = round_down(std::min(wanted, farthest_camera / std::max(distance, size)));
    if (largest(bounds.centre()) > 2 * size) units.origin = bounds.centre();
    GRAFTAL_CHECK(std::isfinite(units.scale) && units.scale > 0, "emit_povray: a scene beyond all scales");
    return units;
}

void write_view(SdlWriter& out, const View& view, const PovrayUnits& units, Vec3 centre,
                const std::string& ground_texture) {
    write_camera(out, view.camera, view.size, units);
    for (const Light& light : view.lights)
        write_light(out, light, units, centre);
    write_sky(out, view.sky);
    if (view.ground) {
        out << "plane { y, ";
        out.number(units(Vec3(0, view.ground->height, 0)).y, digits) << "\n  " << ground_texture << " }\n";
    }
}

} // namespace graftal
