// The frames of an animation go through one session: what does not move is made once.

#include <algorithm>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/render/animate.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

class Turntable : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(directory_.create().ok());
        options_.engine = find_engine("native");
        options_.output = directory_.path() + "/frames/";
        options_.frames = 60;
        options_.turn_deg = 360;
        options_.render.compile.view.size = {16, 12};
        options_.render.antialias.reset();
        options_.render.threads = 1;
    }

    /// How often the stages ran.
    StageRuns animated(const std::string& name, const std::string& text) {
        const std::string path = directory_.path() + "/" + name;
        EXPECT_TRUE(write_text(path, text).ok());
        PictureSession session(path, Keep::for_views);
        const AnimationOutcome outcome = animate_model(session, options_);
        EXPECT_TRUE(outcome.done) << outcome.compilation.diagnostics.render(outcome.compilation.sources)
                                  << outcome.compilation.status.message();
        EXPECT_EQ(outcome.drawn, options_.frames);
        return session.runs();
    }

    TemporaryDirectory directory_;
    AnimateOptions options_;
};

const char* const gasket = "object gasket {\n"
                           "  instance: gasket scale: 0.5 translate: 0, 0.5, 0\n"
                           "  instance: gasket scale: 0.5 translate: -0.4, -0.3, 0.2\n"
                           "  instance: gasket scale: 0.5 translate: 0.4, -0.3, 0\n"
                           "}\n";

TEST_F(Turntable, ACameraThatMovesLowersAnalysesAndPreparesOnce) {
    const StageRuns runs = animated("gasket.inst", gasket);
    EXPECT_EQ(runs.source, 1u);
    EXPECT_EQ(runs.lowered, 1u);
    EXPECT_EQ(runs.analysed, 1u);
    EXPECT_EQ(runs.prepared, 1u);
    EXPECT_EQ(runs.viewed, 60u);
    EXPECT_EQ(runs.parsed, 1u);
}

TEST_F(Turntable, SoItIsForAnLSystem) {
    const StageRuns runs = animated("koch.lsys", "lsys koch {\n  angle 60\n  steps 3\n  axiom F--F--F\n"
                                                 "  F -> F+F--F+F\n}\n");
    EXPECT_EQ(runs.lowered, 1u);
    EXPECT_EQ(runs.analysed, 1u);
    EXPECT_EQ(runs.prepared, 1u);
}

/// Levels that grow are no matter of the text.
TEST_F(Turntable, LevelsThatGrowLowerOnce) {
    options_.frames = 12;
    options_.turn_deg = 0;
    options_.sweeps.push_back({"--steps", [](double t, StageOptions& options) {
                                   options.lower.steps = static_cast<unsigned>(1 + 3 * t);
                                   return std::string("--steps");
                               }});
    const StageRuns runs = animated("gasket.inst", gasket);
    EXPECT_EQ(runs.lowered, 1u);
    EXPECT_EQ(runs.analysed, 1u);
    EXPECT_EQ(runs.prepared, 4u);
}

/// The flag is asked between frames, and within each: no further frame is drawn.
TEST_F(Turntable, EndsSoonWhereItIsCancelled) {
    const std::string path = directory_.path() + "/gasket.inst";
    ASSERT_TRUE(write_text(path, gasket).ok());
    PictureSession session(path, Keep::for_views);
    std::size_t drawing = 0;
    bool raised = false;
    options_.on_progress = [&](const AnimationProgress& progress) {
        if (progress.stage != AnimationProgress::Stage::drawing) return;
        drawing = progress.frame;
        raised |= progress.frame == 3;
    };
    session.set_control({CancelFlag([&] { return raised; }), {}});
    const AnimationOutcome outcome = animate_model(session, options_);
    EXPECT_FALSE(outcome.done);
    EXPECT_EQ(outcome.compilation.status.message(), "interrupted");
    EXPECT_EQ(outcome.drawn, 3u);
    EXPECT_EQ(drawing, 3u);
}

/// A film that grows is estimated by its first frame, one in the middle and its last.
TEST_F(Turntable, AFilmIsEstimatedAfterThreeFrames) {
    options_.frames = 20;
    options_.turn_deg = 0;
    std::vector<double> drawn; // at what time of the sweep
    options_.sweeps.push_back({"--steps", [&](double t, StageOptions& options) {
                                   options.lower.steps = static_cast<unsigned>(1 + 3 * t);
                                   drawn.push_back(t);
                                   return std::string("--steps");
                               }});
    std::vector<std::size_t> shown;
    options_.on_progress = [&](const AnimationProgress& progress) {
        if (progress.stage != AnimationProgress::Stage::drawing || progress.fraction) return;
        if (progress.frame == 0) drawn.clear(); // all before was measured
        shown.push_back(progress.frame);
    };
    std::vector<std::size_t> estimates; // how many frames were drawn then
    options_.on_estimate = [&](const AnimationEstimate& estimate) {
        EXPECT_EQ(estimate.frames, 20u);
        EXPECT_GT(estimate.seconds, 0);
        estimates.push_back(shown.size());
    };
    animated("gasket.inst", gasket);
    EXPECT_EQ(estimates, std::vector<std::size_t>{3});
    ASSERT_GE(drawn.size(), 4u);
    EXPECT_EQ(drawn[0], 0);
    EXPECT_NEAR(drawn[1], 0.5, 0.05);
    EXPECT_EQ(drawn[2], 1);
    EXPECT_NEAR(drawn[3], 1.0 / 19, 1e-12);
    EXPECT_EQ(shown.size(), 20u);
    EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end())) << "whoever looks on sees frames counted";
}

} // namespace
} // namespace graftal
