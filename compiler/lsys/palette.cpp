#include "compiler/lsys/palette.h"

#include <array>
#include <span>

#include "compiler/lower/lower_settings.h"
#include "compiler/lsys/width.h"

namespace graftal {

namespace {

struct Paint {
    const char* name;
    Rgb rgb;
};

/// The colours of the indices 0, 1, 2, ... where the model names none.
constexpr std::array<Paint, 8> default_paints = {{
    {"wood", {0.30, 0.17, 0.08}},
    {"leaf", {0.12, 0.33, 0.05}},
    {"shoot", {0.33, 0.50, 0.10}},
    {"yellow", {0.85, 0.62, 0.06}},
    {"red", {0.60, 0.05, 0.04}},
    {"violet", {0.30, 0.12, 0.45}},
    {"white", {0.85, 0.82, 0.78}},
    {"blue", {0.07, 0.18, 0.50}},
}};

// Colours of figures that use none: light, to stand before a dark background.
constexpr Paint curve_paint = {"curve", {0.90, 0.62, 0.22}};
constexpr Paint stalk_paint = {"stalk", {0.50, 0.66, 0.24}};

std::vector<Material> materials_of(std::span<const Paint> paints) {
    std::vector<Material> palette;
    for (const Paint& paint : paints) {
        Material& material = palette.emplace_back();
        material.name = paint.name;
        material.rgb = paint.rgb;
    }
    return palette;
}

} // namespace

std::optional<std::vector<Material>> palette_of(const LsysGrammar& grammar, const Graph& graph,
                                                Diagnostics& diagnostics) {
    std::vector<Material> palette;
    for (const Name& name : grammar.source->colors) {
        const Material* const material = find_material(name.text, name.span, graph.materials, diagnostics);
        if (!material) return std::nullopt;
        palette.push_back(*material);
    }
    if (!palette.empty()) return palette;
    const bool coloured =
        grammar.uses({TurtleCommand::colour_up, TurtleCommand::colour_down, TurtleCommand::close_polygon});
    const Paint& paint = grammar.uses({TurtleCommand::open_branch}) ? stalk_paint : curve_paint;
    return draws_lines(grammar) && !coloured ? materials_of({&paint, 1}) : materials_of(default_paints);
}

} // namespace graftal
