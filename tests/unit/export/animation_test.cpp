// Models that change, as USD: each state once, in the frames that show it.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/export/export_animation.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

constexpr std::size_t film_frames = 12;

/// The numbers of the frames that begin a state, in a film of the steps from 1 to 4. `whole`: as
/// --steps 1..4; else as a command between steps has it.
std::vector<std::size_t> states(const std::string& model, bool whole) {
    TemporaryDirectory folder;
    EXPECT_TRUE(folder.create().ok());
    const std::string path = folder.path() + "/m.lsys";
    EXPECT_TRUE(write_text(path, model).ok());
    AnimateOptions animate;
    animate.render.compile.view.light = DefaultLight::plain;
    animate.output = folder.path() + "/film.usda";
    animate.frames = film_frames;
    animate.sweeps.push_back({"--steps", [whole](double t, StageOptions& options) {
                                  options.lower.time = swept(1, whole ? 4 : 4.999, t);
                                  options.lower.steps.reset();
                                  if (whole)
                                      options.lower.steps = static_cast<unsigned>(swept_whole(1, 4, t));
                                  return fmt::format("--steps {:.6g}", *options.lower.time);
                              }});
    PictureSession session(path, Keep::for_views);
    const AnimationOutcome outcome = export_animation(session, animate, {});
    EXPECT_TRUE(outcome.done) << outcome.frame
                              << outcome.compilation.diagnostics.render(outcome.compilation.sources)
                              << outcome.compilation.status.message();
    std::string film;
    EXPECT_TRUE(read_text(animate.output, film).ok());
    std::vector<std::size_t> begins;
    for (std::size_t frame = 1; frame <= film_frames; ++frame) {
        const std::string name = fmt::format("film.frames/frame_{:04}.usda", frame);
        std::string state;
        const bool is_shown =
            film.find("references = @" + name + "@\n )\n {\n  token visibility") != std::string::npos;
        EXPECT_EQ(read_text(folder.path() + "/" + name, state).ok(), is_shown) << name;
        if (is_shown) begins.push_back(frame);
    }
    EXPECT_EQ(begins.size(), outcome.drawn);
    return begins;
}

/// Frames of its pictures differ so, too.
TEST(ExportedAnimation, GrowsEvenlyWhereTheDrawingReadsItsAge) {
    const std::string plant = "lsys m {\n axiom A\n A -> F(1)[+(30)A]A\n"
                              " interpret F(l) -> !(0.1)f(0)@O(0.1 + age/8)\n}\n";
    std::vector<std::size_t> all;
    for (std::size_t frame = 1; frame <= film_frames; ++frame)
        all.push_back(frame);
    EXPECT_EQ(states(plant, true), all);
    EXPECT_EQ(states(plant, false), all);
}

TEST(ExportedAnimation, HasEachStateOnce) {
    const std::string plant = "lsys m {\n axiom A\n width 0.1\n A -> F(1)[+(30)A]A\n}\n";
    EXPECT_EQ(states(plant, true), (std::vector<std::size_t>{1, 4, 7, 10}));
    EXPECT_EQ(states(plant, false), (std::vector<std::size_t>{1, 4, 7, 10})); // steps that are done by then
}

/// The drawing reads the age and shows the same until it is over 2.
TEST(ExportedAnimation, HasAStateOnceThatTheModelComesToInTwoWays) {
    const std::string plant =
        "lsys m {\n axiom F(1)\n F(l) -> F(l)\n interpret F(l) -> @O(0.1 + max(step, 2)/8)\n}\n";
    EXPECT_EQ(states(plant, false), (std::vector<std::size_t>{1, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

} // namespace
} // namespace graftal
