#include "runtime/render/fit_work.h"

#include <new>

#include <gtest/gtest.h>

#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

class FitWork : public testing::Test {
  protected:
    /// What fits where a model with an error of less than so many pixels takes too much memory.
    FittedModel fitted(double too_fine_px, const CutOptions& options) {
        const Graph graph = test::tetrahedron();
        const Components components = strong_components(graph);
        const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
        View view;
        view.size = {64, 48};
        view.camera.location = Vec3(0, 0, 5);
        const auto prepare = [&] {
            if (++prepared_ > most_prepared_) throw std::bad_alloc();
            return prepare_cut(graph, components, bounds, options);
        };
        const auto limits = [&](const TraceModel& model) {
            if (model.options.error_px < too_fine_px) throw std::bad_alloc();
            return ShaderLimits();
        };
        return fit_work(prepare, view, options, 1, limits, 1, [] { return false; });
    }

    int prepared_ = 0;
    int most_prepared_ = 100;
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
    const FittedModel model = fitted(1, options);
    EXPECT_EQ(model.error_px, 1.5 * 1.5 * 1.5 * options.error_px);
    EXPECT_EQ(model.model->options.error_px, model.error_px);
    EXPECT_TRUE(model.out_of_memory);
    EXPECT_EQ(prepared_, 2);
    EXPECT_THROW(fitted(1000, options), std::bad_alloc);
    EXPECT_EQ(prepared_, 6);
}

/// A coarser picture would need all of it too.
TEST_F(FitWork, GivesUpWhatCannotBePrepared) {
    most_prepared_ = 0;
    EXPECT_THROW(fitted(0, CutOptions()), std::bad_alloc);
    EXPECT_EQ(prepared_, 1);
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
