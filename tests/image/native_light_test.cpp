// The shader's picture lies over POV-Ray's of the same scene, pixel by pixel. What is found along a ray is
// left to the plainest code there is, so that only rays and light are under test.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/povray/emit/view.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/shade/shade.h"
#include "tests/image/brute_force.h"
#include "tests/image/drawing.h"
#include "tests/image/povray_samples.h"

namespace graftal {
namespace {

/// Both round to 16 bits; POV-Ray computes colours in single precision and reads 9 digits of a place.
constexpr double last_bits = 2.001 / 65535;
/// A background that no surface shows by chance.
constexpr Rgb magenta(0.93, 0.07, 0.91);
const std::string on_magenta = "background: 0.93, 0.07, 0.91\n";

struct LitScene {
    const char* name;
    ImageSize size;
    std::string text;
    bool plain_background = true; ///< on_magenta: then POV-Ray's picture shows what was hit
    double roundings = 1;         ///< how many times as far the last bits may be off

    friend std::ostream& operator<<(std::ostream& out, const LitScene& scene) { return out << scene.name; }
};

const std::string balls_and_blocks = R"(
    material rough { ambient: 0.2 diffuse: 0.5 specular: 0.6 roughness: 1 }
    material satin { ambient: 0.05 diffuse: 0.7 specular: 0.5 roughness: 0.05 }
    material gloss { ambient: 0 diffuse: 0.4 specular: 1 roughness: 0.005 }
    material glass { ambient: 0.1 diffuse: 0 specular: 1 roughness: 0.0002 }
    object things {
        sphere translate: -3, 1, 0 material rough tint: 0.9, 0.3, 0.2, 1
        sphere translate: -0.6, 1, 0.4 material satin tint: 0.2, 0.8, 0.3, 0.75
        sphere scale: 1.3, 0.9, 0.8 rotate: z, 25 translate: 2, 1.2, -0.3
            material gloss tint: 0.1, 0.2, 0.9, 0.5
        sphere scale: 0.6 translate: 0.8, 2.6, 0.6 material glass
        cube scale: 0.7 rotate: <1, 2, 0.5>, 40 translate: -2, 3, -1 material gloss
        cube scale: 0.5, 1.5, 0.4 translate: 3.6, 1.5, 0.8 material satin tint: 0.8, 0.8, 0.1, 1
    }
)";

const std::string mirrors = R"(
    material mirror { ambient: 0.02 diffuse: 0.1 specular: 0.4 roughness: 0.01 reflection: 0.9 }
    material perfect { ambient: 0.05 diffuse: 0 specular: 0 reflection: 1 }
    material faint { ambient: 0.1 diffuse: 0.6 reflection: 0.05 }
    material dust { ambient: 0.1 diffuse: 0.6 reflection: 0.003 }
    object things {
        sphere translate: -1.1, 1, 0 material mirror tint: 0.9, 0.3, 0.2, 1
        sphere translate: 1.1, 1, 0 material perfect
        sphere translate: 0, 1, 1.95 scale: 0.9 material mirror
        cube scale: 0.3 translate: 0, 0.3, 2.5 material faint tint: 0.2, 0.8, 0.3, 1
        cube scale: 3, 2, 0.1 translate: 0, 2, -2 material mirror
        cube scale: 0.2 translate: 1.6, 0.2, 2.5 material dust
    }
)";

const std::string glassware = R"(
    material glass { color: 0.95, 0.97, 0.9 ambient: 0 diffuse: 0 specular: 0.8 roughness: 0.005
                     transparency: 0.95 ior: 1.5 }
    material jade { color: 0.3, 0.8, 0.5 ambient: 0.1 diffuse: 0.5 specular: 0.3 transparency: 0.7
                    ior: 1.3 reflection: 0.8 absorption: 1.5 }
    material film { color: 0.9, 0.5, 0.2 ambient: 0.1 diffuse: 0.6 transparency: 0.6 filter: 0.4 }
    material tile { ambient: 0.1 diffuse: 0.7 specular: 0 }
    object things {
        sphere translate: -1.3, 1.05, 0.4 material glass
        cube scale: 0.7, 1, 0.4 rotate: y, 25 translate: 1, 1.02, 0.3 material jade
        sphere scale: 0.4 translate: -0.1, 0.5, 1.7 material film
        cube scale: 0.3 rotate: y, 40 translate: -1.2, 0.35, -1.2 material tile tint: 0.9, 0.2, 0.1, 1
        cube scale: 0.4 rotate: <1, 2, 3>, 40 translate: 0.9, 2.6, 0 material glass
        sphere scale: 0.5 translate: 2.3, 0.51, 0.5 material jade tint: 0.8, 0.2, 0.3, 0.5
    }
)";

const LitScene scenes[] = {
    {"Perspective", {160, 120}, balls_and_blocks + on_magenta + R"(
        camera { location: 2, 4, 9 look_at: 0, 1.4, 0 angle: 50 }
        light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
        light { location: 3, 5, 4 color: 0.3, 0.4, 0.6 }
        light { sun: 1, 0.3, 1 color: 0.2, 0.1, 0.3 shadowless }
        light { location: -6, 1, 5 color: 0.15, 0.15, 0.1 shadowless }
        ground { height: 0 }
    )"},
    {"ParallelAndTilted", {120, 170}, balls_and_blocks + on_magenta + R"(
        camera { orthographic location: 3, 6, 5 look_at: 0.3, 1.4, 0 up: 0.5, 1, -0.2 width: 9 }
        light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
        light { location: 0.2, 4, 1 color: 0.5, 0.5, 0.5 }
    )"},
    {"TiltedAndWide", {200, 90}, balls_and_blocks + on_magenta + R"(
        camera { location: -2, 0.7, 4 look_at: 0.5, 1.8, 0 up: 1, 2, 0.3 angle: 110 }
        light { location: 0, 3, 6 color: 1, 1, 1 }
        ground { height: -0.5 material: satin color: 0.3, 0.5, 0.2 }
    )"},
    {"AutomaticLights", {160, 120}, balls_and_blocks + on_magenta, false},
    {"AutomaticLightsOnGround",
     {150, 130},
     balls_and_blocks + on_magenta + "ground { height: 0 material: rough }"},
    {"AutomaticSky", {140, 100}, balls_and_blocks, false},
    {"FlatFigure", {100, 140}, on_magenta + R"(
        object things {
            triangle tint: 0.3, 0.6, 0.9, 1
            triangle scale: 0.5 translate: 0.4, 0.9 tint: 0.9, 0.2, 0.1, 0.5
        }
    )"},
    {"Mirrors", {160, 120}, mirrors + on_magenta + R"(
        camera { location: 1, 2.5, 7 look_at: 0, 1, 0 angle: 45 }
        light { sun: 1, 2, 2 color: 0.7, 0.7, 0.7 }
        light { location: -3, 4, 3 color: 0.5, 0.4, 0.3 }
        ground { height: 0 material: mirror color: 0.3, 0.3, 0.4 }
    )"},
    {"MirrorsUnderASky",
     {130, 130},
     mirrors + R"(
        camera { location: 2, 3, 7 look_at: 0, 1, 0 up: 0.2, 1, 0 angle: 60 }
        background { zenith: 0.2, 0.4, 0.9 horizon: 0.9, 0.8, 0.7 }
        light { sun: -1, 2, 2 color: 1, 0.9, 0.8 }
    )",
     false},
    {"ParallelMirrors", {130, 100}, mirrors + on_magenta + R"(
        camera { orthographic location: 2, 3, 7 look_at: 0, 1, 0 width: 6 }
        light { sun: -1, 2, 2 }
        ground { height: 0 material: faint }
    )"},
    {"SkyToTheZenith",
     {151, 101},
     balls_and_blocks + R"(
        camera { location: 0, 2, 3 look_at: 0, 5, 3 up: 0.2, 0, -1 angle: 150 }
        background { zenith: 0.1, 0.3, 0.95 horizon: 1, 0.9, 0.6 }
        light { sun: 0, 1, 0 }
    )",
     false},
    {"HorizonOfTheGround", {150, 100}, balls_and_blocks + on_magenta + R"(
        camera { location: 1, 30, 9 look_at: 3, 29.93, 0 up: 0.3, 1, 0 angle: 70 }
        light { sun: -2, 1, 1 }
        ground { height: 0 }
    )"},
    {"FromBelowTheGround", {150, 100}, balls_and_blocks + on_magenta + R"(
        camera { location: 1, -3, 9 look_at: 0, 0, 0 angle: 60 }
        light { sun: -2, -1, 1 color: 0.5, 0.6, 0.7 }
        light { location: -1, 2, 2 color: 0.7, 0.6, 0.5 }
        light { location: 1, -2, 3 color: 0.4, 0.4, 0.5 }
        ground { height: 1 material: gloss }
    )"},
    {"SmallAndFarOff", {130, 110}, on_magenta + R"(
        material gloss { ambient: 0.1 diffuse: 0.5 specular: 0.7 roughness: 0.02 reflection: 0.4 }
        object things {
            sphere scale: 0.001 translate: 5, -7, 9 material gloss tint: 0.9, 0.8, 0.6, 1
            cube scale: 0.0005 rotate: y, 30 translate: 5.0015, -7.0005, 9.0002
        }
        camera { location: 5.002, -6.999, 9.004 look_at: 5.0005, -7, 9 angle: 50 }
        light { location: 5.001, -6.997, 9.003 }
        light { sun: -1, 2, 0 color: 0.4, 0.4, 0.5 }
        ground { height: -7.001 material: gloss }
    )"},
    {"InsideABallWithPlanes", {150, 100}, on_magenta + R"(
        material gloss { ambient: 0.1 diffuse: 0.5 specular: 0.7 roughness: 0.02 reflection: 0.2 }
        object things {
            sphere scale: 20 material gloss tint: 0.9, 0.8, 0.6, 1
            plane rotate: x, 20 translate: 0, -2, 0 material gloss tint: 0.2, 0.5, 0.4, 1
            plane rotate: z, -70 translate: 6, 0, 0 tint: 0.5, 0.2, 0.4, 0.5
            sphere translate: 0.5, 0.5, -2
            cube scale: 0.5 translate: -1.5, 2, -1 material gloss
        }
        camera { location: 0, 1, 8 look_at: 0, 0, 0 angle: 75 }
        light { location: 0, 6, 4 color: 0.9, 0.9, 0.9 }
        light { location: 0.5, 0.5, -2 color: 1, 0, 0 }
        light { sun: 0, 1, 1 color: 1, 0, 1 }
    )"},
    {"GradientSkyAndWideSun",
     {110, 90},
     balls_and_blocks + R"(
        camera { location: 2, 4, 9 look_at: 0, 1.4, 0 angle: 80 }
        sky { zenith: 0.1, 0.2, 0.45 horizon: 0.5, 0.45, 0.4 below: 0.1, 0.07, 0.05 }
        light { sun: -1, 2, 1.5 angle: 6 temperature: 4500 brightness: 0.5 }
    )",
     false},
    {"ClearSkyOverGround",
     {110, 90},
     balls_and_blocks + R"(
        camera { location: 2, 4, 9 look_at: 0, 3, 0 up: 0.1, 1, 0 angle: 90 }
        sky { clear: 4 }
        light { sun: -1, 0.4, -1.5 angle: 2 brightness: 0.5 }
        ground { height: 0 material: satin color: 0.3, 0.2, 0.1 }
    )",
     false},
    {"SkyBehindABackground", {110, 90}, balls_and_blocks + on_magenta + R"(
        sky { zenith: 0.5, 0.6, 0.7 bounces: 3 }
    )"},
    {"HazeOverGround",
     {130, 90},
     mirrors + R"(
        camera { location: 2, 3, 7 look_at: 0, 2, 0 up: 0.1, 1, 0 angle: 70 }
        background { zenith: 0.2, 0.4, 0.9 horizon: 0.9, 0.8, 0.7 }
        light { sun: -1, 2, 2 color: 1, 0.9, 0.8 }
        haze { distance: 20 base: 0.7 height: 3 color: 0.6, 0.65, 0.7 }
        ground { height: 0 material: faint }
    )",
     false,
     2},
    {"HazeFromAbove",
     {130, 90},
     balls_and_blocks + R"(
        camera { location: 2, 9, 7 look_at: 0, 0.5, 0 angle: 60 }
        light { sun: -1, 2, 2 color: 1, 0.9, 0.8 }
        haze { distance: 6 base: -2 height: 1 color: 0.6, 0.65, 0.7 }
        ground { height: -3 }
    )",
     false},
    {"HazeAllOver",
     {130, 90},
     balls_and_blocks + R"(
        camera { location: 2, 4, 9 look_at: 0, 1.4, 0 angle: 50 }
        light { sun: -1, 2, 2 color: 1, 0.9, 0.8 }
        haze { distance: 30 }
    )",
     false},
    {"LampsWithAreas", {140, 110}, balls_and_blocks + on_magenta + R"(
        camera { location: 2, 4, 9 look_at: 0, 1.4, 0 angle: 60 }
        light { location: -2, 6, 3 size: 3, 1 look_at: 0, 1, 0 color: 0.6, 0.5, 0.4 }
        light { location: 4, 2, 5 radius: 0.7 look_at: 0, 1, 0 color: 0.3, 0.4, 0.6 }
        light { location: 1, 9, 1 radius: 0.5 look_at: 1, 0, 1 color: 0.2, 0.2, 0.2 }
        ground { height: 0 }
    )"},
    {"Metals", {130, 110}, on_magenta + R"(
        material gold { color: 1, 0.7, 0.3 ambient: 0.05 diffuse: 0.2 specular: 0.9 roughness: 0.03
                        reflection: 0.8 metallic: 1 }
        material tin { color: 0.4, 0.5, 0.9 diffuse: 0.4 specular: 0.7 roughness: 0.1 reflection: 0.3
                       metallic: 0.5 }
        material cloth { color: 0.7, 0.1, 0.1 specular: 0.8 roughness: 0.2 metallic: 0.8 }
        object things {
            sphere translate: -1.1, 1, 0 material gold
            sphere translate: 1.1, 1, 0 material tin tint: 0.9, 0.4, 0.2, 0.5
            cube scale: 0.4 rotate: y, 30 translate: 0, 0.4, 1.6 material cloth
            cube scale: 3, 2, 0.1 translate: 0, 2, -2 material gold
        }
        camera { location: 1, 2.5, 7 look_at: 0, 1, 0 angle: 45 }
        light { sun: 1, 2, 2 color: 0.7, 0.7, 0.7 }
        light { location: -3, 4, 3 color: 0.5, 0.4, 0.3 }
        ground { height: 0 material: tin }
    )"},
    {"FresnelsGloss", {130, 110}, on_magenta + R"(
        material lacquer { color: 0.7, 0.1, 0.05 diffuse: 0.8 specular: 0.6 roughness: 0.01 ior: 1.5 }
        material wet { diffuse: 0.6 specular: 0 ior: 1.33 reflection: 0.7 emission: 0.1 translucency: 0.2 }
        object things {
            sphere translate: -1.1, 1, 0 material lacquer
            sphere translate: 1.1, 1, 0 material wet tint: 0.2, 0.6, 0.3, 0.8
            cube scale: 3, 2, 0.1 translate: 0, 2, -2 material wet
        }
        camera { location: 1, 1.5, 7 look_at: 0, 1, 0 angle: 45 }
        light { sun: 1, 2, 2 color: 0.7, 0.7, 0.7 }
        light { location: -3, 4, 3 color: 0.5, 0.4, 0.3 }
        ground { height: 0 material: lacquer color: 0.3, 0.35, 0.4 }
    )"},
    {"GlassOverGround",
     {150, 110},
     glassware + R"(
        camera { location: 1, 3.5, 7 look_at: 0.2, 1, 0 angle: 45 }
        background { zenith: 0.2, 0.4, 0.9 horizon: 0.9, 0.8, 0.7 }
        light { sun: 1, 2, -0.7 color: 0.8, 0.8, 0.7 }
        light { location: -3, 5, 4 color: 0.4, 0.4, 0.4 }
        ground { height: 0 material: tile color: 0.6, 0.6, 0.5 }
    )",
     false},
    {"GlassUnderASkyInHaze",
     {100, 80},
     glassware + R"(
        camera { location: -2, 2.5, 7 look_at: 0.2, 1, 0 angle: 45 }
        sky { zenith: 0.3, 0.5, 0.9 horizon: 0.9, 0.9, 0.9 below: 0.2, 0.2, 0.2 }
        light { sun: 1, 2, 1 angle: 3 brightness: 0.5 }
        haze { distance: 30 color: 0.6, 0.65, 0.7 }
        ground { height: 0 material: tile color: 0.6, 0.6, 0.5 }
    )",
     false,
     2},
    {"WaterWithAFloor",
     {150, 100},
     R"(
        material water { color: 0.3, 0.7, 0.8 ambient: 0 diffuse: 0 specular: 0.5 roughness: 0.002
                         transparency: 1 ior: 1.33 absorption: 2 }
        material sand { color: 0.8, 0.7, 0.5 specular: 0 }
        material glass { transparency: 0.9 ior: 1.5 diffuse: 0 ambient: 0 }
        object things {
            plane translate: 0, -2, 0 material sand
            sphere translate: -1.5, -0.3, 0 material sand tint: 0.9, 0.2, 0.1, 1
            cube scale: 0.5 rotate: <1, 1, 0>, 30 translate: 1, 0.1, 0.5 material glass
            sphere scale: 0.4 translate: 0.2, -1, 1.5 material glass
        }
        camera { location: 0, 1.7, 7 look_at: 0, -0.3, 0 angle: 45 }
        background { zenith: 0.2, 0.4, 0.9 horizon: 0.9, 0.8, 0.7 }
        light { sun: 0.5, 1, 0.4 color: 0.9, 0.9, 0.8 }
        light { location: -2, 3, 2 color: 0.3, 0.3, 0.3 }
        ground { height: 0 material: water }
    )",
     false},
    {"UnderWater",
     {110, 100},
     R"(
        material water { color: 0.3, 0.7, 0.8 ambient: 0 diffuse: 0 transparency: 1 ior: 1.33 absorption: 4 }
        material sand { color: 0.8, 0.7, 0.5 specular: 0 }
        object things {
            sphere translate: 0, -1.5, 0 material sand
            cube translate: 0.5, 2, -2 material sand
        }
        camera { location: 0, -2, 6 look_at: 0, -0.8, 0 angle: 70 }
        background { zenith: 0.2, 0.4, 0.9 horizon: 0.9, 0.8, 0.7 }
        light { sun: 0.5, 1, 0.4 color: 0.9, 0.9, 0.8 }
        ground { height: 0 material: water }
    )",
     false},
    {"PanesInARow", {130, 90}, on_magenta + R"(
        material pane { color: 0.9, 0.4, 0.3 ambient: 0.05 diffuse: 0.6 transparency: 0.8 reflection: 0.2 }
        material gauze { transparency: 0.5 filter: 0 translucency: 0.3 diffuse: 0.4 specular: 0.4 }
        material foil { color: 0.9, 0.8, 0.3 transparency: 0.4 metallic: 1 reflection: 0.6 }
        object things {
            triangle scale: 2 rotate: y, 20 translate: -1, 0, 0 material pane tint: 0.2, 0.7, 0.9, 0.7
            triangle scale: 2 rotate: y, -30 translate: 0.2, 0, 0.8 material gauze tint: 0.7, 0.5, 0.1, 1
            triangle scale: 2 rotate: <0, 1, 1>, 30 translate: 0.9, 0, -0.8 material foil
            sphere scale: 0.4 translate: 0.2, 0.5, -1.5
        }
        camera { location: 0.4, 1.5, 6 look_at: 0, 0.8, 0 angle: 50 }
        light { sun: 0.3, 0.8, -1 color: 0.7, 0.7, 0.6 }
        light { location: 3, 2, 4 color: 0.5, 0.4, 0.6 }
        ground { height: 0 }
    )"},
    {"LightThroughLeaves", {130, 110}, on_magenta + R"(
        material leaf { ambient: 0.05 diffuse: 0.5 translucency: 0.4 specular: 0.2 roughness: 0.1 }
        material ember { ambient: 0 diffuse: 0.2 emission: 0.6 }
        object things {
            triangle scale: 2 rotate: y, 20 translate: -1, 0, 0 material leaf tint: 0.4, 0.7, 0.1, 1
            triangle scale: 2 rotate: <1, 2, 0>, 70 translate: 1, 0.5, 0 material leaf tint: 0.7, 0.5, 0.1, 1
            sphere scale: 0.3 translate: 0.4, 1.5, -1 material ember tint: 1, 0.3, 0.1, 1
        }
        camera { location: 0, 1.5, 6 look_at: 0, 0.8, 0 angle: 50 }
        light { sun: 0.3, 0.8, -1 color: 0.7, 0.7, 0.6 }
        light { location: 3, 2, 4 color: 0.5, 0.4, 0.6 }
    )"},
};

/// Unlike Image, not rounded to single precision.
struct NativePicture {
    std::vector<Rgb> pixels;
    std::vector<bool> hit;
};

NativePicture shade(const CompiledModel& model, const std::vector<PixelSample>& samples) {
    BruteForce surfaces(model.cut);
    const PovrayUnits units = choose_units(model.cut, model.view.camera);
    Shader shader(model.view, surfaces,
                  {.farthest = 1e7 / units.scale, .list = list_size(model.view.quality)});
    const CameraRays rays(model.view);
    NativePicture picture;
    for (int y = 0; y < model.view.size.height; ++y)
        for (int x = 0; x < model.view.size.width; ++x) {
            Rgb sum(0.0);
            SurfaceHit hit;
            for (const PixelSample& sample : samples)
                sum += sample.weight * shader.radiance(rays.through(x + sample.x, y + sample.y));
            picture.pixels.push_back(sum);
            picture.hit.push_back(shader.first_hit(rays.through(x + 0.5, y + 0.5), hit));
        }
    return picture;
}

struct LightAgreement {
    double max = 0;
    double mean = 0;
    int off = 0;        ///< pixels farther apart than the last bits
    int other_hits = 0; ///< pixels that are background in one of the pictures
    int hits = 0;
};

LightAgreement compare(const NativePicture& native, const Image& povray, double roundings = 1) {
    LightAgreement agreement;
    const auto channels = static_cast<std::size_t>(povray.channels);
    for (std::size_t i = 0; i < native.pixels.size(); ++i) {
        double farthest = 0, from_magenta = 0;
        for (int c = 0; c < 3; ++c) {
            const double theirs = povray.pixels[i * channels + static_cast<std::size_t>(c)];
            const double apart = std::abs(std::clamp(native.pixels[i][c], 0.0, 1.0) - theirs);
            agreement.mean += apart / 3 / static_cast<double>(native.pixels.size());
            farthest = std::max(farthest, apart);
            from_magenta = std::max(from_magenta, std::abs(theirs - magenta[c]));
        }
        agreement.max = std::max(agreement.max, farthest);
        agreement.off += farthest > roundings * last_bits;
        agreement.hits += native.hit[i];
        agreement.other_hits += native.hit[i] != (from_magenta > last_bits);
    }
    return agreement;
}

class NativeLight : public testing::TestWithParam<LitScene> {};

TEST_P(NativeLight, IsPovrays) {
    const LitScene& scene = GetParam();
    StageOptions options = whole(scene.size);
    options.view.light = DefaultLight::studio;
    const std::optional<CompiledModel> model =
        compile_text("lit.inst", scene.text, options, {.flatten = true});
    ASSERT_TRUE(model);
    const NativePicture native = shade(*model, {povray_sample_of_pixel});
    const Image povray = draw(*model, SampleFormat::linear16);
    ASSERT_EQ(povray.pixels.size(), native.pixels.size() * static_cast<std::size_t>(povray.channels));
    const LightAgreement agreement = compare(native, povray, scene.roundings);
    RecordProperty("max_of_65535", std::to_string(65535 * agreement.max));
    RecordProperty("mean_of_255", std::to_string(255 * agreement.mean));
    EXPECT_GT(agreement.hits, scene.size.width * scene.size.height / 40);
    if (scene.plain_background) {
        EXPECT_EQ(agreement.other_hits, 0);
    }
    EXPECT_EQ(agreement.off, 0) << "by up to " << 65535 * agreement.max << "/65535";
    EXPECT_LE(255 * agreement.mean, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Scenes, NativeLight, testing::ValuesIn(scenes),
                         [](const auto& scene) { return std::string(scene.param.name); });

/// Smooth, with a sun, in numbers that half floats hold.
std::shared_ptr<const SkyPicture> sky_picture() {
    constexpr int width = 1024, height = 512;
    std::vector<SkyPicture::Texel> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto step = [](int i, int n) { return static_cast<float>(i * 64 / n) / 64; };
            texels.push_back({step(x, width), 1 - step(y, height), y < height / 2 ? 0.75f : 0.125f});
        }
    texels[100 * width + 700] = {4096, 4096, 2048};
    return std::make_shared<SkyPicture>(width, height, std::move(texels));
}

/// Both have the same list of lights; POV-Ray mixes the texels of the background by itself.
TEST(NativeLightPicture, OfTheSkyIsPovrays) {
    const ImageSize size{150, 110};
    for (const std::string ground : {"", "ground { height: 0 material: faint }"}) {
        StageOptions options = whole(size);
        std::optional<CompiledModel> model = compile_text("lit.inst", mirrors + ground + R"(
            sky { zenith: 1, 1, 1 }
            film { hard }
            camera { location: 2, 4, 9 look_at: 0, 3.4, 0 angle: 100 }
        )",
                                                          options, {.flatten = true});
        ASSERT_TRUE(model);
        SkyLight& sky = *model->view.sky_light;
        sky.picture = sky_picture();
        sky.picture_from_world = Affine::rotate({0, 1, 0}, -130).linear;
        sky.brightness = 0.5;
        const NativePicture native = shade(*model, {povray_sample_of_pixel});
        const Image povray = draw(*model, SampleFormat::linear16);
        ASSERT_EQ(povray.pixels.size(), native.pixels.size() * static_cast<std::size_t>(povray.channels));
        const LightAgreement agreement = compare(native, povray);
        EXPECT_GT(agreement.hits, size.width * size.height / 40);
        EXPECT_LT(agreement.hits, size.width * size.height);
        EXPECT_EQ(agreement.off, 0) << "by up to " << 65535 * agreement.max << "/65535";
    }
}

TEST(NativeLightSamples, ArePovraysOfAnAntialiasedPixel) {
    const LitScene& scene = scenes[1];
    StageOptions options = whole(scene.size);
    options.view.light = DefaultLight::studio;
    const std::optional<CompiledModel> model =
        compile_text("lit.inst", scene.text, options, {.flatten = true});
    ASSERT_TRUE(model);
    for (const int depth : {1, 2, 3}) {
        SCOPED_TRACE(depth);
        const NativePicture native = shade(*model, povray_samples_of_pixel(depth));
        const LightAgreement agreement = compare(native, draw(*model, SampleFormat::linear16, depth));
        EXPECT_EQ(agreement.off, 0) << "by up to " << 65535 * agreement.max << "/65535";
    }
}

} // namespace
} // namespace graftal
