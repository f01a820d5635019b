#include "runtime/render/fit_work.h"

#include <new>

#include <gtest/gtest.h>

#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

class FitWork : public testing::Test {
  protected:
    /// What fits after the model was too large for the memory that many times.
    FittedModel fitted(int failures, const CutOptions& options) const {
        const Graph graph = test::tetrahedron();
        const Components components = strong_components(graph);
        const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
        View view;
        view.size = {64, 48};
        view.camera.location = Vec3(0, 0, 5);
        const auto prepare = [&] {
            if (failures-- > 0) throw std::bad_alloc();
            return prepare_cut(graph, components, bounds, options);
        };
        return fit_work(
            prepare, view, options, 1, [](const TraceModel&) { return ShaderLimits(); }, 1,
            [] { return false; });
    }
};

TEST_F(FitWork, KeepsWhatFits) {
    const CutOptions options;
    const FittedModel model = fitted(0, options);
    EXPECT_EQ(model.error_px, options.error_px);
    EXPECT_FALSE(model.out_of_memory);
    EXPECT_FALSE(model.rays_cut);
    EXPECT_EQ(model.seconds, model.whole_seconds);
}

TEST_F(FitWork, CoarsensWhatTakesTooMuchMemory) {
    const CutOptions options;
    const FittedModel model = fitted(2, options);
    EXPECT_EQ(model.error_px, 1.5 * 1.5 * options.error_px);
    EXPECT_EQ(model.model->options.error_px, model.error_px);
    EXPECT_TRUE(model.out_of_memory);
    EXPECT_THROW(fitted(100, options), std::bad_alloc);
}

TEST_F(FitWork, CoarsensNothingOfWhichNothingIsLeftOut) {
    CutOptions options;
    options.error_px = 0;
    options.steps = 3;
    EXPECT_NO_THROW(fitted(0, options));
    EXPECT_THROW(fitted(1, options), std::bad_alloc);
}

} // namespace
} // namespace graftal
