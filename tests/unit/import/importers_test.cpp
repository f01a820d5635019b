#include "compiler/import/importers.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

const std::string two_models = "Koch { ; a curve\n Angle 6\n Axiom F\n F=F+F--F+F\n}\n"
                               "comment { not a model }\n"
                               "Line {\n Angle 4\n Axiom F\n}\n";

TEST(Importers, APathNamesAModelBehindAColon) {
    EXPECT_EQ(model_path("lib/trees.l:Tree1").file, "lib/trees.l");
    EXPECT_EQ(model_path("lib/trees.l:Tree1").model, "Tree1");
    EXPECT_EQ(model_path("TREES.L:a:b").model, "a:b");
    EXPECT_EQ(model_path("a:b/fern.rifs").file, "a:b/fern.rifs");
    EXPECT_EQ(model_stem("lib/trees.l:Tree1"), "Tree1");
    EXPECT_EQ(model_stem("lib/fern.rifs"), "fern");
    EXPECT_EQ(plain_name("5-fold tree"), "m_5_fold_tree");
}

TEST(Importers, AModelIsFoundByItsName) {
    EXPECT_EQ(Imported("a.l:Koch", two_models, {.steps = 2}).derivation->segments, "16");
    EXPECT_EQ(Imported("a.l:koch", two_models, {.steps = 1}).derivation->segments, "4") << "capitals";
    EXPECT_THAT(Imported("a.l", two_models).said(), HasSubstr("'a.l' holds 2 models"));
    EXPECT_THAT(Imported("a.l:Kock", two_models).said(), HasSubstr("did you mean 'Koch'?"));
    EXPECT_THAT(Imported("a.l:Koch", "no model here").said(),
                HasSubstr("is no cpfg L-system or Fractint L-system"));
    EXPECT_THAT(Imported("a.l", "").said(), HasSubstr("is no"));
}

TEST(Importers, AnErrorInATranslationNamesTheForeignLine) {
    const Imported model("a.ls", "3\n90\n10\nA\nA=F(1e90)A[A\n@\n");
    EXPECT_FALSE(model.graph);
    EXPECT_THAT(model.said(), HasSubstr("a.ls:5:1: note: translated from here"));
}

TEST(Importers, UsedModelsMayBeForeign) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "graftal_importers_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "curves.l") << two_models;
    const std::string text = "use koch = \"curves.l:Koch\"\nuse line = \"curves.l:Line\"\n"
                             "object both {\n    koch\n    line translate: 0, 1, 0\n}\n";
    const Imported model((folder / "m.inst").string(), text);
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_EQ(model.sources.size(), 4u) << "the file is read once: itself, and two translations";
}

TEST(Importers, HostileFilesEndWithADiagnostic) {
    const std::string nul("Koch {\0 Axiom F\n}", 17);
    const std::string longest = "A { Angle 4\n Axiom " + std::string(2'000'000, 'F') + "\n}";
    std::string rules = "A {\n Angle 4\n Axiom F\n";
    for (int i = 0; i < 2000; ++i)
        rules += " F=FF[F][F\n";
    const std::string deep = "A {\n Angle 4\n Axiom " + std::string(5000, '[') + "F\n}";
    for (const std::string& text : {nul, longest, rules + "}", deep})
        for (const char* name : {"a.l:A", "a.ls", "a.s"}) {
            const Imported model(name, text, {.steps = 50, .max_modules = 100'000, .max_objects = 1000});
            EXPECT_TRUE(model.graph || model.diagnostics.has_errors() || model.derivation) << name;
        }
    const Imported macros("a.l",
                          "#define A BB\n#define B CC\n#define C DDDDDDDD\n#define D EEEEEEEE\nLsystem: 1\n"
                          "derivation length: 1000000000\nAxiom: A(1)\nA(x) --> A(x)A(x)\nendlsystem\n");
    EXPECT_TRUE(macros.diagnostics.has_errors());
    const Imported cycle("a.l",
                         "#define X Y(1)\n#define Y(a) X\nLsystem: 1\nderivation length: 1\nAxiom: F(X)\n"
                         "endlsystem\n");
    EXPECT_TRUE(cycle.diagnostics.has_errors());
}

} // namespace
} // namespace graftal::testing
