#include "compiler/import/importers.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>

#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"
#include "compiler/support/srgb.h"
#include "tests/unit/comma_locale.h"
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

TEST(Importers, NoNameBeginsALineOfItsOwn) {
    Translation translation;
    translation.line("# leaf\nrifs evil {\r}", {});
    EXPECT_EQ(translation.text, "# leaf rifs evil { }\n");
    EXPECT_EQ(translation.origins.size(), 1u);
    const Imported flame("a.flame",
                         "<flame name=\"a&#10;rifs evil {&#13;\" scale=\"80\">"
                         "<xform name=\"x&#10;}\" weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 0 0\"/>"
                         "<xform weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 1 1\"/></flame>");
    ASSERT_TRUE(flame.graph) << flame.said();
    for (const char* const name : {"p\nlsys Evil { axiom F }\n.ls", "p\rlsys Evil { axiom F }.ls"}) {
        const Imported plant(name, "3\n90\n10\nF\n@\n");
        ASSERT_TRUE(plant.graph) << plant.said();
        EXPECT_EQ(plant.translation.find("\nlsys Evil"), std::string::npos) << plant.translation;
    }
}

TEST(Importers, NumbersReadBackToTheLastBit) {
    const Imported script("a.es", "set background #804020\n{ color #808080 x 0.1 } box\n");
    EXPECT_THAT(script.translation, HasSubstr(shortest(128.0 / 255)));
    EXPECT_THAT(script.translation, HasSubstr("background: " + shortest(linear_from_srgb(128.0 / 255)) +
                                              ", " + shortest(linear_from_srgb(64.0 / 255))));
    const Imported flame("a.flame",
                         "<flame name=\"a\"><xform weight=\"1\" color=\"0\" linear=\"1\" "
                         "coefs=\".5 0 0 .5 0 0\"/><xform weight=\"1\" color=\"0\" linear=\"1\" "
                         "coefs=\".5 0 0 .5 1 1\"/><color index=\"0\" rgb=\"128 64 32\"/></flame>");
    EXPECT_THAT(flame.translation, HasSubstr("rgb <" + shortest(linear_from_srgb(128.0 / 255)) + ", "));
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

TEST(ForeignText, ANumberIsReadAsByTheCLibraryWithAPoint) {
    std::vector<std::string> texts = {"",       " ",    "x",   "1",   " 2.5 m", "+.5",    "-.5e",
                                      "+-3",    "--1",  "- 1", "1e5", "1e-320", "1e-999", "1e999",
                                      "-1e999", "0x1A", "0x",  "0xg", "-0x1p4", "inf",    "nan",
                                      "1.2.3",  "5e+",  ".",   "e5",  "\t7",    "1,5"};
    std::mt19937 random(3);
    for (int k = 0; k < 20'000; ++k) {
        std::string& text = texts.emplace_back();
        for (unsigned length = random() % 12; length > 0; --length)
            text += "0123456789+-.eE xX"[random() % 18];
    }
    const auto both = [&] {
        for (const std::string& text : texts) {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            const LeadingNumber read = leading_number(text);
            ASSERT_EQ(read.length, static_cast<std::size_t>(end - text.c_str())) << text;
            if (std::isnan(value)) continue;
            ASSERT_EQ(read.value, value) << text;
        }
    };
    both();
    const CommaLocale locale;
    ASSERT_TRUE(locale.installed());
    EXPECT_EQ(leading_number("2.5").value, 2.5);
}

} // namespace
} // namespace graftal::testing
