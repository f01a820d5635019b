// A model of many parts is made ready for rays, and somebody no longer wants it: little is done after that.

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/detail/detail_options.h"
#include "compiler/session/session.h"
#include "runtime/fit/fit_picture.h"
#include "runtime/trace/model/trace_model.h"

namespace graftal {
namespace {

struct ManyParts {
    const char* what;
    const char* name;
    std::string text;
};

/// Instances that are all different.
std::string many_instances() {
    std::string text = "object m {\n";
    for (int i = 0; i < 30'000; ++i)
        text += fmt::format("  instance: o{} rotate: z, {} translate: {}, {}, 0\n", i % 7, i % 360, i % 173,
                            i / 173);
    text += "}\n";
    for (int i = 0; i < 7; ++i)
        text +=
            "object o" + std::to_string(i) + " { cube scale: 0.3, 0.4, 0." + std::to_string(i + 1) + " }\n";
    return text;
}

class TracingIsCancelled : public ::testing::TestWithParam<ManyParts> {
  protected:
    void SetUp() override {
        session_ = std::make_unique<Session>(GetParam().name, GetParam().text);
        stages_.view.size = {640, 360};
        Compilation compilation;
        prepared_.viewed = session_->viewed(stages_, compilation);
        ASSERT_TRUE(prepared_.viewed) << compilation.diagnostics.render(compilation.sources);
        prepared_.detail = resolved(stages_.detail, *prepared_.viewed);
        prepared_.prepared = session_->prepared(stages_, compilation);
        ASSERT_TRUE(prepared_.prepared);
    }

    /// Makes it ready under a flag that is raised once it has been asked so often. False: it was cancelled.
    bool make(std::uint64_t most) {
        asked_ = 0;
        const CancelFlag cancel([&] { return ++asked_ > most; });
        try {
            const auto ground =
                std::make_shared<TraceBasis>(*prepared_.prepared, prepared_.detail.work_seconds, cancel);
            const TraceModel model(prepared_.prepared, prepared_.viewed->view, prepared_.detail, {}, ground,
                                   cancel);
            edges_ = model.edges.size();
            model.self_shadows(cancel);
            return true;
        } catch (const Cancelled&) {
            return false;
        }
    }

    std::unique_ptr<Session> session_;
    StageOptions stages_;
    PreparedView prepared_;
    std::uint64_t asked_ = 0;
    std::size_t edges_ = 0;
};

TEST_P(TracingIsCancelled, WhereverItAsks) {
    constexpr std::size_t most_edges_between = 1000;
    ASSERT_TRUE(make(UINT64_MAX));
    const std::uint64_t all = asked_;
    EXPECT_GE(all, edges_ / most_edges_between) << "it works long without asking";
    for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1}, all / 3, all / 2, all - 1}) {
        EXPECT_FALSE(make(most));
        EXPECT_EQ(asked_, most + 1) << "it went on";
    }
}

TEST_P(TracingIsCancelled, AFitGivesNothingThen) {
    const PicturePlan plan = plan_picture(prepared_, {});
    for (const std::uint64_t most : {0, 3, 20}) {
        asked_ = 0;
        EXPECT_FALSE(fit_picture(prepared_, {}, plan, SerialWorkers(), [&] { return ++asked_ > most; }));
        EXPECT_LE(asked_, most + 2) << "it went on";
    }
}

INSTANTIATE_TEST_SUITE_P(Models, TracingIsCancelled,
                         ::testing::Values(ManyParts{"instances", "m.inst", many_instances()},
                                           ManyParts{"a_long_word", "m.lsys",
                                                     "lsys m {\n steps 7\n angle 25.7\n axiom X\n"
                                                     " X -> F[+(random(10, 40))X][-(random(10, 40))X]FX\n"
                                                     " F -> FF\n}\n"}),
                         [](const auto& param) { return std::string(param.param.what); });

} // namespace
} // namespace graftal
