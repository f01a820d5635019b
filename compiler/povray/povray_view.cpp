#include "compiler/povray/povray_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr int view_digits = 12;
constexpr double sun_distance = 1e6;

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
    out.vector(units(camera.location), view_digits) << "\n  direction ";
    out.vector(depth * camera.direction, view_digits) << "\n  right ";
    out.vector(width * camera.right, view_digits) << "\n  up ";
    out.vector(width / aspect * camera.up, view_digits) << "\n}\n";
}

void write_light(SdlWriter& out, const Light& light, const PovrayUnits& units, Vec3 centre) {
    const Vec3 target = units(centre);
    out << "light_source { ";
    out.vector(light.sun ? target + sun_distance * light.location : units(light.location), view_digits)
        << " ";
    write_rgb(out, light.rgb);
    if (light.sun) {
        out << " parallel point_at ";
        out.vector(target, view_digits);
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
        out.number(slope * sky.axis[i], view_digits) << ") + ";
    }
    out << "(";
    out.number(-slope * sky.from, view_digits) << "))) }\n  color_map { [0 ";
    write_rgb(out, sky.horizon);
    out << "] [1 ";
    write_rgb(out, sky.zenith);
    out << "] }\n} }\n";
}

} // namespace

void write_view(SdlWriter& out, const View& view, const PovrayUnits& units, Vec3 centre,
                const std::string& ground_texture) {
    write_camera(out, view.camera, view.size, units);
    for (const Light& light : view.lights)
        write_light(out, light, units, centre);
    write_sky(out, view.sky);
    if (view.ground) {
        out << "plane { y, ";
        out.number(units(Vec3(0, view.ground->height, 0)).y, view_digits)
            << "\n  " << ground_texture << " }\n";
    }
}

} // namespace graftal
