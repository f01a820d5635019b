// The pipeline as a whole: text -> analysed model -> cut.

#include "compiler/povray/cut/compile.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "compiler/session/stages.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class Compile : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("graftal_compile_" + std::string(test->name()) + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        std::filesystem::current_path(folder_);
    }
    void TearDown() override {
        std::filesystem::current_path("/");
        std::filesystem::remove_all(folder_);
    }

    std::shared_ptr<const AnalysedModel> analyse(const std::string& text, bool for_report = false) {
        EXPECT_TRUE(write_text("model.inst", text).ok());
        return Session("model.inst", disk_files()).analysed(options_, compilation_, for_report);
    }
    std::shared_ptr<const CompiledModel> compile(Compilation& compilation) {
        Session session("model.inst", disk_files());
        return compile_scene(session, options_, compilation);
    }
    std::string messages() const { return compilation_.diagnostics.render(compilation_.sources); }

    std::filesystem::path folder_;
    StageOptions options_;
    Compilation compilation_;
};

const char* const gasket = "object gasket {\n"
                           "  instance: gasket scale: 0.5 translate: 0, 0.5, 0\n"
                           "  instance: gasket scale: 0.5 translate: -0.4, -0.3, 0\n"
                           "  instance: gasket scale: 0.5 translate: 0.4, -0.3, 0\n"
                           "}\n";

TEST_F(Compile, AModelThatContractsIsAnalysed) {
    const std::shared_ptr<const AnalysedModel> model = analyse(gasket);
    ASSERT_TRUE(model) << messages();
    EXPECT_EQ(messages(), "");
    EXPECT_EQ(model->contraction.verdict, Verdict::proved);
    EXPECT_NEAR(model->contraction.rate(), 0.5, 1e-12);
    ASSERT_EQ(model->bounds.size(), model->graph.objects.size());
    const Box& box = model->bounds[model->graph.root].box;
    EXPECT_NEAR(box.max.y, 1, 1e-9);
    EXPECT_NEAR(box.min.x, -0.8, 1e-9);
    EXPECT_EQ(levels_of(*model, std::nullopt), std::nullopt);
}

TEST_F(Compile, StagesAreTimedInTheirOrder) {
    ASSERT_TRUE(analyse(gasket));
    std::vector<std::string> stages;
    for (const StageTime& time : compilation_.times) {
        stages.push_back(time.stage);
        EXPECT_GE(time.seconds, 0);
    }
    EXPECT_EQ(stages, (std::vector<std::string>{"lower", "drop_unreachable", "merge_equivalent", "components",
                                                "contraction", "bounding"}));
}

TEST_F(Compile, StepsOfTheCommandLineComeBeforeTheModels) {
    const std::string text = "steps: 4\n" + std::string(gasket);
    EXPECT_EQ(levels_of(*analyse(text), std::nullopt), 4u);
    EXPECT_EQ(levels_of(*analyse(text), 7u), 7u);
}

const char* const growing = "object tree {\n"
                            "  instance: sphere\n"
                            "  instance: branch scale: 0.5 translate: 0, 1, 0\n"
                            "}\n"
                            "canonical object branch {\n"
                            "  instance: tree scale: 3\n"
                            "}\n";

TEST_F(Compile, ACycleThatGrowsIsAnErrorThatNamesIt) {
    EXPECT_FALSE(analyse(growing));
    EXPECT_THAT(messages(), HasSubstr("does not contract: each time around, it grows 1.5 times\n"));
    EXPECT_THAT(messages(), HasSubstr("tree -> branch -> tree"));
    EXPECT_THAT(messages(), StartsWith("model.inst:3:"));
    EXPECT_THAT(messages(), HasSubstr("hint: an object may contain itself only if every way around the cycle "
                                      "makes it smaller: scale down an instance of the cycle\n"));
}

TEST_F(Compile, ForAReportTheVerdictIsTheResult) {
    const std::shared_ptr<const AnalysedModel> model = analyse(growing, true);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->contraction.verdict, Verdict::refuted);
    EXPECT_TRUE(model->bounds.empty());
    EXPECT_EQ(messages(), "");
}

TEST_F(Compile, ARotationAloneDoesNotContract) {
    EXPECT_FALSE(analyse("object a { instance: a rotate: y, 30  instance: sphere }\n"));
    EXPECT_EQ(
        messages(),
        "model.inst:1:22: error: the cycle a -> a does not contract: each time around, it keeps its size\n"
        "    object a { instance: a rotate: y, 30  instance: sphere }\n"
        "                         ^\n"
        "    hint: an object may contain itself only if every way around the cycle makes it smaller: "
        "scale down an instance of the cycle\n");
}

TEST_F(Compile, AModelBeyondNumbersIsAnErrorNotAHang) {
    std::string text = "object a0 { instance: a1 scale: 1e60 }\n";
    for (int i = 1; i < 4; ++i)
        text += "canonical object a" + std::to_string(i) + " { instance: a" + std::to_string(i + 1) +
                " scale: 1e60 }\n";
    EXPECT_FALSE(analyse(text + "canonical object a4 { instance: sphere }\n"));
    EXPECT_THAT(messages(), HasSubstr("error: 'a2' reaches farther than 1e+100 units from the origin\n"));
}

TEST_F(Compile, AnUnknownPassIsReportedWithTheKnownOnes) {
    options_.stop_after = "merge";
    EXPECT_FALSE(analyse(gasket));
    EXPECT_EQ(messages(), "graftal: error: there is no pass 'merge'\n"
                          "    hint: the passes are drop_unreachable, merge_equivalent\n");
}

TEST_F(Compile, AFileThatCannotBeReadIsTheEnvironmentsFault) {
    EXPECT_FALSE(Session("none.inst", disk_files()).analysed(options_, compilation_));
    EXPECT_FALSE(compilation_.diagnostics.has_errors());
    EXPECT_EQ(compilation_.status.message(), "cannot open 'none.inst': No such file or directory");
}

TEST_F(Compile, ABadModelStopsBeforeAnalysis) {
    EXPECT_FALSE(analyse("object a { instance: b }\n"));
    EXPECT_THAT(messages(), HasSubstr("unknown object 'b'"));
    EXPECT_FALSE(compile(compilation_));
}

TEST_F(Compile, CompilesToACutForTheView) {
    ASSERT_TRUE(write_text("model.inst", gasket).ok());
    options_.view.size = {320, 240};
    options_.lower.steps = 3;
    const auto model = compile(compilation_);
    ASSERT_TRUE(model) << messages();
    EXPECT_EQ(model->view.size, options_.view.size);
    EXPECT_EQ(model->cut.leaf_count, 27);
    EXPECT_FALSE(model->cut.bounds.empty());
    const auto timed = [&](const char* stage) {
        return std::any_of(compilation_.times.begin(), compilation_.times.end(),
                           [&](const StageTime& time) { return time.stage == stage; });
    };
    EXPECT_TRUE(timed("frame"));
    EXPECT_TRUE(timed("cut"));
}

TEST_F(Compile, AModelOfPlanesOnlyHasAView) {
    ASSERT_TRUE(write_text("model.inst", "object floor { instance: plane }\n").ok());
    EXPECT_TRUE(compile(compilation_)) << messages();
}

TEST_F(Compile, PointsAndSpecksAreNoCrash) {
    const std::string models[] = {
        "object a { instance: a scale: 0.5 }\n",
        "object a { instance: b scale: 1e-300 }\ncanonical object b { instance: sphere scale: 1e-300 }\n",
        "object a { instance: sphere translate: 1e99, 0, 0 }\n",
        "object a { instance: sphere scale: 1e-30 }\n",
    };
    for (const std::string& text : models) {
        ASSERT_TRUE(write_text("model.inst", text).ok());
        Compilation compilation;
        const bool compiled = compile(compilation) != nullptr;
        EXPECT_NE(compiled, compilation.diagnostics.has_errors()) << text;
    }
}

} // namespace
} // namespace graftal
