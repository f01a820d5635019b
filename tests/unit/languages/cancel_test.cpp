// Lowering asks the cancel flag wherever it may take long, and leaves nothing behind.

#include <string>

#include <gtest/gtest.h>

#include "compiler/languages/lower.h"

namespace graftal {
namespace {

struct LongModel {
    const char* what;
    const char* name;
    std::string text;
    bool exact = false;
};

std::string many_definitions() {
    std::string text = "object o0 { sphere }\n";
    for (int i = 1; i < 20'000; ++i)
        text += "object o" + std::to_string(i) + " { instance: o" + std::to_string(i - 1) + " scale: 0.9 }\n";
    return text;
}

class LoweringIsCancelled : public ::testing::TestWithParam<LongModel> {
  protected:
    /// Lowers the model under a flag that is raised once it has been asked so often. False: it was cancelled.
    bool lower(std::uint64_t most) {
        const LongModel& model = GetParam();
        LowerOptions options;
        options.exact = model.exact;
        asked_ = 0;
        SourceMap sources;
        Diagnostics diagnostics;
        const LowerHelp help{{}, {CancelFlag([&] { return ++asked_ > most; }), {}}};
        try {
            const std::optional<Graph> graph =
                lower_text(model.name, model.text, options, sources, diagnostics, help).graph;
            EXPECT_TRUE(graph) << diagnostics.render(sources);
            return true;
        } catch (const Cancelled&) {
            return false;
        }
    }

    std::uint64_t asked_ = 0;
};

TEST_P(LoweringIsCancelled, WhereverItAsks) {
    ASSERT_TRUE(lower(UINT64_MAX));
    const std::uint64_t all = asked_;
    EXPECT_GE(all, 5u) << "it works long without asking";
    for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1}, all / 2, all - 1}) {
        EXPECT_FALSE(lower(most));
        EXPECT_EQ(asked_, most + 1) << "it went on";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Models, LoweringIsCancelled,
    ::testing::Values(
        LongModel{"composed", "m.lsys",
                  "lsys m {\n steps 200\n axiom A(1)\n A(n) : n < 150 -> F[+(n)A(n + 1)]A(n + 2)\n}\n"},
        LongModel{"derived", "m.lsys", "lsys m {\n steps 10\n angle 60\n axiom F\n F -> F+F--F+F\n}\n", true},
        LongModel{"in_context", "m.lsys",
                  "lsys m {\n steps 15\n angle 9\n axiom A\n A < F -> F+F\n A -> AAF\n}\n"},
        LongModel{"enumerated", "m.inst", many_definitions()},
        LongModel{"scattered", "m.inst",
                  "object m { scatter sphere over -60, -60, 60, 60 count 60000 by poisson }\n"}),
    [](const auto& param) { return std::string(param.param.what); });

/// Members of a family are imported one after the other.
TEST(ImportIsCancelled, BetweenMembers) {
    std::string part;
    for (int i = 0; i < 200; ++i)
        part += "object o" + std::to_string(i) + " { sphere translate: k, " + std::to_string(i) + ", 0 }\n";
    part += "object all {\n";
    for (int i = 0; i < 200; ++i)
        part += "  instance: o" + std::to_string(i) + "\n";
    MemoryFiles files;
    files.set("part.inst", "inner k = 0 members 256\n" + part + "}\n");
    std::string text = "use part = \"part.inst\"\nobject m {\n";
    for (int i = 0; i < 100; ++i)
        text += "  instance: part(" + std::to_string(i) + "/100)\n";
    std::uint64_t asked = 0;
    const LowerHelp help{.control = {CancelFlag([&] { return ++asked > 4; }), {}}, .files = &files};
    SourceMap sources;
    Diagnostics diagnostics;
    EXPECT_THROW(lower_text("m.inst", text + "}\n", {}, sources, diagnostics, help), Cancelled)
        << diagnostics.render(sources);
    EXPECT_EQ(asked, 5u);
}

} // namespace
} // namespace graftal
