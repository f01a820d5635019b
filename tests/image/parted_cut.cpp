#include "tests/image/parted_cut.h"

#include <gtest/gtest.h>

#include "compiler/detail/graph/build_detail_graph.h"
#include "compiler/detail/shadow/coverage.h"
#include "compiler/detail/shell/store.h"
#include "compiler/passes/pipeline.h"
#include "compiler/povray/cut/assemble.h"

namespace graftal {

CompiledModel parted_at(const CompiledModel& model, double mesh_triangles) {
    BoundedGraph passed = run_passes(detail_passes(), {model.model->graph, model.model->bounds});
    DetailGraph cut = build_detail_graph(std::move(passed.graph), passed.bounds);
    const Symmetry symmetry = find_symmetry(cut);
    fit_proxies(cut, symmetry);
    const DetailOptions options;
    const Projection projection(model.view, options, 0, 1e-5);
    Piece root;
    root.node = cut.root;
    root.steps = model.steps.value_or(unlimited_steps);
    Weights weights(cut);
    Choice choice;
    choice.threshold = mesh_triangles;
    AssemblyLimits limits{1e9, 60};
    ShellStore shells;
    std::optional<Cut> result =
        assemble(cut, symmetry, projection, root, choice, weights, false, shells, limits);
    EXPECT_TRUE(result.has_value());
    CompiledModel parted = model;
    if (result) parted.cut = std::move(*result);
    return parted;
}

} // namespace graftal
