// Bytes -> a valid graph and a view -> the cut -> POV-Ray's text: no graph and no view may break it, and what
// it gives is finite and the same twice.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/analysis/model_range.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/povray/cut/cut.h"
#include "compiler/povray/emit/scene.h"
#include "compiler/support/check.h"
#include "tests/property/random_graph.h"
#include "tests/unit/povray/cut/cut_graph.h"

using namespace graftal;

namespace {

DetailOptions random_options(testing::Choices& choices) {
    DetailOptions options;
    options.error_px = choices.one_in(3) ? 0 : choices.one_in(2) ? 4 : 0.5;
    if (options.error_px == 0 || choices.one_in(3)) options.steps = choices.below(5);
    if (choices.one_in(6)) options.error_world = 0.01 * choices.below(100);
    options.memory_bytes = choices.one_in(4) ? 1u << 20 : 16u << 20;
    options.work_seconds = choices.one_in(3) ? 1e-3 : 0.02;
    options.visible_only = choices.one_in(4);
    return options;
}

CameraOverride random_camera(testing::Choices& choices) {
    CameraOverride camera;
    const auto number = [&] { return choices.below(4001) / 1000.0 - 2; };
    if (choices.one_in(3)) camera.location = Vec3(number(), number(), number());
    if (choices.one_in(3)) camera.look_at = Vec3(number(), number(), number());
    if (choices.one_in(4)) camera.angle_deg = 1 + choices.below(178);
    return camera;
}

std::string scene_of(const Cut& cut, const View& view, bool include) {
    std::string text;
    std::vector<PaletteImage> palettes;
    PovrayOptions options;
    options.scene_name = "fuzz";
    options.include = include;
    options.file_name = "fuzz.inc";
    emit_povray(
        cut, view, options, [&](std::string_view piece) { return text += piece, true; }, palettes);
    return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    testing::Choices choices(std::span(data, size));
    const bool runs = choices.one_in(4);
    const Graph graph =
        drop_unreachable(
            testing::random_graph(choices,
                                  {.max_objects = 5, .runs = runs, .huge = choices.one_in(4) ? 1e100 : 10}))
            .graph;
    const Components components = strong_components(graph);
    const Contraction contraction = decide_contraction(graph, components);
    if (contraction.verdict != Verdict::acyclic && contraction.verdict != Verdict::proved) return 0;
    const std::vector<ObjectBounds> bounds = bound_objects(graph, components, contraction);
    Diagnostics diagnostics;
    if (!check_range(graph, components, bounds, diagnostics)) return 0;
    const DetailOptions options = random_options(choices);
    const bool flatten = choices.one_in(6);
    const CameraOverride camera = random_camera(choices);
    if (bounds[graph.root].box.empty()) return 0;
    const View view = frame(graph, bounds[graph.root].box, {48, 32}, camera);
    const bool include = choices.one_in(4);
    const auto cut_once = [&] {
        return test::cut_graph(graph, components, bounds, view, options, diagnostics, {.flatten = flatten});
    };
    const std::optional<Cut> cut = cut_once();
    GRAFTAL_CHECK(cut.has_value() != diagnostics.has_errors(), "cut fuzzer: a cut or errors");
    if (!cut) return 0;
    GRAFTAL_CHECK(std::isfinite(cut->error_px) && std::isfinite(cut->largest_part), "cut fuzzer: finite");
    const std::string scene = scene_of(*cut, view, include);
    if (!choices.one_in(8)) return 0;
    GRAFTAL_CHECK(scene == scene_of(*cut_once(), view, include), "cut fuzzer: the same twice");
    return 0;
}
