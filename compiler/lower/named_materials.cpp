#include "compiler/lower/named_materials.h"

namespace graftal {

const std::vector<Material>& named_materials() {
    static const std::vector<Material> materials = {
        {.name = "leaf",
         .rgb = {0.2, 0.45, 0.05},
         .diffuse = 0.55,
         .specular = 0.25,
         .roughness = 0.06,
         .translucency = 0.4},
        {.name = "bark", .rgb = {0.2, 0.13, 0.08}, .diffuse = 0.9, .specular = 0.02, .roughness = 0.3},
        {.name = "stone", .rgb = {0.4, 0.38, 0.35}, .diffuse = 0.9, .specular = 0.05, .roughness = 0.2},
        {.name = "water",
         .rgb = {0.75, 0.93, 0.96},
         .ambient = 0,
         .diffuse = 0,
         .specular = 0.9,
         .roughness = 0.001,
         .reflection = 1,
         .transparency = 1,
         .ior = 1.333},
        {.name = "glass",
         .rgb = {0.95, 0.985, 0.97},
         .ambient = 0,
         .diffuse = 0,
         .specular = 0.9,
         .roughness = 0.001,
         .reflection = 1,
         .transparency = 1,
         .ior = 1.52},
        {.name = "gold",
         .rgb = {1, 0.71, 0.29},
         .ambient = 0.05,
         .diffuse = 0.1,
         .specular = 0.9,
         .roughness = 0.02,
         .reflection = 0.85,
         .metallic = 1},
        {.name = "snow", .rgb = {0.93, 0.95, 0.98}, .diffuse = 0.95, .specular = 0.05, .roughness = 0.15},
        {.name = "wax",
         .rgb = {0.92, 0.78, 0.5},
         .diffuse = 0.8,
         .specular = 0.4,
         .roughness = 0.1,
         .reflection = 0.5,
         .translucency = 0.2,
         .ior = 1.45},
    };
    return materials;
}

} // namespace graftal
