// Rays at random graphs: no ray, no graph may break the traversal, and both kinds of instructions agree.

#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/prepare.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/support/check.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/property/random_graph.h"

using namespace graftal;

namespace {

double number(testing::Choices& choices) {
    constexpr double odd[] = {0, -0.0, 1, -1, 1e-300, 1e300, 5e-324, INFINITY, NAN};
    if (choices.one_in(8)) return odd[choices.below(std::size(odd))];
    return choices.below(2001) / 1000.0 - 1;
}

Vec3 vector(testing::Choices& choices) {
    return {number(choices), number(choices), number(choices)};
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    testing::Choices choices(std::span(data, size));
    const Graph graph = drop_unreachable(testing::random_graph(choices, {.max_objects = 5})).graph;
    const Components components = strong_components(graph);
    const Contraction contraction = decide_contraction(graph, components);
    if (contraction.verdict != Verdict::acyclic && contraction.verdict != Verdict::proved) return 0;
    const std::vector<ObjectBounds> bounds = bound_objects(graph, components, contraction);
    const Box& box = bounds[graph.root].box;
    DetailOptions options;
    options.error_px = choices.one_in(2) ? 4 : 0;
    if (options.error_px == 0 || choices.one_in(2)) options.steps = choices.below(4);
    View view;
    view.size = {64, 48};
    const double reach = box.empty() ? 1 : std::max(glm::length(box.size()), 1e-6);
    const Vec3 centre = box.empty() ? Vec3(0.0) : box.centre();
    view.camera.location = centre + Vec3(0, 0, 2 * reach);
    const TraceModel model(
        std::make_shared<const PreparedGraph>(prepare_graph(graph, components, bounds, options.preparing())),
        view, options);
    Traversal traversal(model), portable(model, Instructions::portable);
    for (int i = 0; i < 16; ++i) {
        const Ray ray{centre + reach * vector(choices), vector(choices)};
        SurfaceHit hit, twin;
        const bool found = traversal.closest(ray, {1e-9 * reach, 1e300}, hit);
        GRAFTAL_CHECK(portable.closest(ray, {1e-9 * reach, 1e300}, twin) == found, "trace fuzzer");
        GRAFTAL_CHECK(traversal.meets_any(ray, {1e-9 * reach, 1e300}) == found, "trace fuzzer");
        if (!found) continue;
        GRAFTAL_CHECK(std::isfinite(hit.t) && hit.t == twin.t && hit.normal == twin.normal, "trace fuzzer");
        GRAFTAL_CHECK(std::abs(glm::length(hit.normal) - 1) < 1e-6, "trace fuzzer");
    }
    return 0;
}
