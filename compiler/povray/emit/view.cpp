#include "compiler/povray/emit/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/light/blackbody.h"
#include "compiler/scene/light_list.h"

namespace graftal {

namespace {

constexpr int view_digits = 12;
constexpr double sun_distance = 1e6;

void write_rgb(SdlWriter& out, Rgb rgb) {
    out << "rgb ";
    out.vector(rgb, 7);
}

void write_camera(SdlWriter& out, const View& view, const PovrayUnits& units) {
    const Camera& camera = view.camera;
    const ImageSize size = view.size;
    const double aspect = static_cast<double>(size.width) / size.height;
    const double width = camera.orthographic ? units.scale * camera.width : aspect;
    const double depth =
        camera.orthographic ? width : 0.5 * width / std::tan(camera.angle_deg * std::numbers::pi / 360);
    out << "camera {\n  " << (camera.orthographic ? std::string_view("orthographic") : "perspective")
        << "\n  location ";
    out.vector(units(camera.location), view_digits) << "\n  direction ";
    out.vector(depth * camera.direction, view_digits) << "\n  right ";
    out.vector(width * camera.right, view_digits) << "\n  up ";
    out.vector(width / aspect * camera.up, view_digits);
    if (view.lens.radius > 0) {
        constexpr double povray_aperture = 4; // of a lens of radius 1
        out << "\n  focal_point ";
        out.vector(units(camera.location + view.lens.depth * camera.direction), view_digits) << " aperture ";
        out.number(povray_aperture * units.scale * view.lens.radius, view_digits)
            << fmt::format(" blur_samples {} variance 0", by_quality(view.quality, 16, 64, 256));
    }
    out << "\n}\n";
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

/// "x*(a) + y*(b) + z*(c)"
void write_dot(SdlWriter& out, Vec3 v) {
    const std::string_view axes[] = {"x*(", " + y*(", " + z*("};
    for (int i = 0; i < 3; ++i) {
        out << axes[i];
        out.number(v[i], view_digits) << ")";
    }
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
    write_dot(out, slope * sky.axis);
    out << " + (";
    out.number(-slope * sky.from, view_digits) << "))) }\n  color_map { [0 ";
    write_rgb(out, sky.horizon);
    out << "] [1 ";
    write_rgb(out, sky.zenith);
    out << "] }\n} }\n";
}

/// Perez's formula times the zenith's value: a number of the height c and the cosine s to the sun.
void write_perez(SdlWriter& out, std::string_view name, const std::array<double, 5>& a, double zenith) {
    out << "#declare " << name << " = function(c, s) { ";
    out.number(zenith, view_digits) << "*(1 + (";
    out.number(a[0], view_digits) << ")*exp((";
    out.number(a[1], view_digits) << ")/max(c, ";
    out.number(ClearSky::least_height, view_digits) << ")))*(1 + (";
    out.number(a[2], view_digits) << ")*exp((";
    out.number(a[3], view_digits) << ")*acos(max(-1, min(1, s)))) + (";
    out.number(a[4], view_digits) << ")*s*s) }\n";
}

/// The largest component of what the sky shows: about the sun, or where the horizon is bright.
double brightest(const SkyLight& sky) {
    const Rgb at_sun = sky.radiance(sky.clear->to_sun);
    double most = std::max({at_sun.r, at_sun.g, at_sun.b, sky.below.r, sky.below.g, sky.below.b});
    View listed;
    listed.sky_light = sky;
    constexpr unsigned directions = 4000;
    for (const Light& light : listed_lights(listed, {1, directions})) {
        const Rgb rgb = sky.radiance(light.location);
        most = std::max({most, rgb.r, rgb.g, rgb.b});
    }
    constexpr double between_directions = 1.5;
    return between_directions * most;
}

/// Three pigments, one for each component, whose mean is a third of their sum.
void write_clear_sky(SdlWriter& out, const SkyLight& sky) {
    const ClearSky& clear = *sky.clear;
    const std::string_view names[] = {"sky_Y", "sky_x", "sky_y"};
    for (int i = 0; i < 3; ++i)
        write_perez(out, names[i], clear.perez[static_cast<std::size_t>(i)], clear.zenith_yxy[i]);
    const double most = brightest(sky);
    if (!(most > 0)) {
        out << "background { rgb 0 }\n";
        return;
    }
    const double scale = sky.brightness / ClearSky::kcd_of_paper / most;
    out << "sky_sphere { pigment { average pigment_map {\n";
    for (int component = 0; component < 3; ++component) {
        Rgb only(0.0);
        only[component] = 1;
        // The row of the matrix from XYZ: X = Y x / y, Z = Y (1 - x - y) / y.
        const Rgb row(rgb_from_xyz({1, 0, 0})[component], rgb_from_xyz({0, 1, 0})[component],
                      rgb_from_xyz({0, 0, 1})[component]);
        const std::string name = fmt::format("sky_{}", component);
        out << "  #declare " << name << " = function(c, s) { max(0, sky_Y(c, s)/sky_y(c, s)*((";
        out.number(row.x, view_digits) << ")*sky_x(c, s) + (";
        out.number(row.y, view_digits) << ")*sky_y(c, s) + (";
        out.number(row.z, view_digits)
            << ")*(1 - sky_x(c, s) - sky_y(c, s)))) }\n  [1 function { min(0.999999, ";
        out << "select(";
        write_dot(out, sky.up);
        out << ", ";
        out.number(sky.below[component] / most, view_digits) << ", ";
        out.number(scale, view_digits) << "*" << name << "(";
        write_dot(out, sky.up);
        out << ", ";
        write_dot(out, clear.to_sun);
        out << "))) } color_map { [0 rgb 0] [1 ";
        write_rgb(out, 3 * most * only);
        out << "] }]\n";
    }
    out << "} } }\n";
}

/// POV-Ray's map_type 1 has -x in the middle of the picture. It wraps the picture from pole to pole, too:
/// within half a row of a pole the colours differ.
void write_sky_picture(SdlWriter& out, const SkyLight& sky, const std::string& file) {
    const Mat3 world_from_pov =
        glm::transpose(sky.picture_from_world) * Affine::rotate({0, 1, 0}, 180).linear;
    out << "sky_sphere { pigment { image_map { exr \"" << file << "\" map_type 1 interpolate 2 } } matrix <";
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            out.number(world_from_pov[column][row], view_digits) << ",";
    out << "0,0,0> }\n";
}

/// Writes the sky as a colour that runs along a pattern of the height, from below to the zenith.
void write_sky_light(SdlWriter& out, const SkyLight& sky, const std::string& file) {
    if (sky.picture) return write_sky_picture(out, sky, file);
    if (sky.clear) return write_clear_sky(out, sky);
    out << "sky_sphere { pigment {\n  function { min(0.999999, 0.5 + 0.5*(";
    write_dot(out, sky.up);
    out << ")) }\n  color_map { [0 ";
    write_rgb(out, sky.below);
    out << "] [0.5 ";
    write_rgb(out, sky.below);
    out << "] [0.5 ";
    write_rgb(out, sky.horizon);
    out << "] [";
    out.number(0.5 + 0.5 * SkyLight::full_height, view_digits) << " ";
    write_rgb(out, sky.zenith);
    out << "] [1 ";
    write_rgb(out, sky.zenith);
    out << "] }\n} }\n";
}

void write_haze(SdlWriter& out, const Haze& haze, const PovrayUnits& units) {
    out << "fog { fog_type " << (haze.is_even() ? "1" : "2") << " distance ";
    out.number(units.scale * haze.distance, view_digits) << " ";
    write_rgb(out, haze.rgb);
    if (!haze.is_even()) {
        out << " fog_offset ";
        out.number(units.scale * (haze.base - units.origin.y), view_digits) << " fog_alt ";
        out.number(units.scale * haze.height, view_digits) << " up <0,1,0>";
    }
    out << " }\n";
}

/// Its opacity is a pattern of x and z; its light is that of paper.
void write_catcher(SdlWriter& out, const ShadowCatcher& catcher, const PovrayUnits& units) {
    const Vec3 centre = units(catcher.centre);
    const double radius = units.scale * catcher.radius;
    out << "plane { y, ";
    out.number(centre.y, view_digits) << "\n  pigment { function { min(0.999999, pow(max(0, 1 - (pow((x - (";
    out.number(centre.x, view_digits) << "))/";
    out.number(radius, view_digits) << ", 2) + pow((z - (";
    out.number(centre.z, view_digits) << "))/";
    out.number(radius, view_digits) << ", 2))), 2)) }\n  color_map { [0 ";
    write_rgb(out, catcher.rgb);
    out << " transmit 1] [1 ";
    write_rgb(out, catcher.rgb);
    out << "] } }\n  finish { ambient 0 diffuse 1 } no_shadow }\n";
}

} // namespace

void write_view(SdlWriter& out, const View& view, const PovrayUnits& units, Vec3 centre,
                const LightListSize& lights, const std::string& ground_texture, const std::string& sky_file) {
    write_camera(out, view, units);
    for (const Light& light : listed_lights(view, lights))
        write_light(out, light, units, centre);
    if (view.shows_sky_light)
        write_sky_light(out, *view.sky_light, sky_file);
    else
        write_sky(out, view.sky);
    if (view.haze) write_haze(out, *view.haze, units);
    if (view.ground) {
        out << "plane { y, ";
        out.number(units(Vec3(0, view.ground->height, 0)).y, view_digits)
            << "\n  " << ground_texture << " }\n";
    }
    if (view.catcher) write_catcher(out, *view.catcher, units);
}

} // namespace graftal
