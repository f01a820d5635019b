#include "compiler/import/importers.h"

#include <array>
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
using ::testing::Not;

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

TEST(Importers, NameAForeignLanguageThatTheyDoNotRead) {
    const std::string lpfg = "#include <cmath>\n#include <lpfgall.h>\nmodule A(float);\nAxiom: A(1);\n"
                             "derivation length: 10;\nvoid f() { if (1) { } }\nint angle { 3 };\n"
                             "production:\nA(x) : { produce F(x) A(x); }\n";
    for (const char* const name : {"a.l", "a.lpy", "a.cfdg", "a.txt", "a.lsystem"}) {
        const Imported program(name, lpfg);
        EXPECT_FALSE(program.graph);
        EXPECT_THAT(program.said(), HasSubstr(std::string(name) + ":2:1: error: '" + name +
                                              "' is an L+C program for lpfg, which is C++, and graftal does "
                                              "not read that"));
        EXPECT_THAT(program.said(), HasSubstr("graftal reads L-systems of cpfg"));
        EXPECT_EQ(program.said().find("error:"), program.said().rfind("error:")) << program.said();
    }
    const std::vector<std::array<std::string, 3>> programs = {
        {"a.l", "module A(float); // age\nA(x) : { produce F(x) A(x); }\n",
         ":1:1: error: 'a.l' is an L+C program"},
        {"a.l", "#include \"modules.h\"\nA(x) : {\n  produce F(x) A(x);\n}\n",
         ":1:1: error: 'a.l' is an L+C program"},
        {"a.txt", "\n module A(float x) extends Sphere(x);\npublic void run() [ A(x) ==> F(x) A(x); ]\n",
         ":2:2: error: 'a.txt' is an XL program for GroIMP"},
        {"a.cfdg", "<!DOCTYPE html>\n<html></html>\n", ":1:1: error: 'a.cfdg' is XML or HTML"},
        {"a.es", "{\n \"rules\": 1 }", ":1:1: error: 'a.es' is JSON"},
        {"a.txt", "\"\"\"A tree\"\"\"\nimport turtle\n", ":2:1: error: 'a.txt' is a Python program"},
        {"a.ls", "#include <stdio.h>\nint main() {}\n", ":1:1: error: 'a.ls' is a C or C++ program"},
        {"a.txt", "#include \"colors.inc\"\n", ":1:1: error: 'a.txt' is a scene of POV-Ray"}};
    for (const auto& [name, text, error] : programs) {
        const Imported program(name, text);
        EXPECT_FALSE(program.graph) << text;
        EXPECT_THAT(program.said(), HasSubstr(error));
    }
    // L-Py has modules and 'produce' too, and is Python; cpfg runs the preprocessor of C; flames are XML.
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"a.lpy", "import math\nmodule A\n"},
             {"a.flame", "<flames></flames>"},
             {"a.lpy", "module A\nAxiom: F\nderivation length: 1\nproduction:\nF:\n  produce F-F\n"},
             {"a.l",
              "#include <math.h>\nLsystem: 1\nderivation length: 2\nAxiom: F\nF --> F-F\nendlsystem\n"}})
        EXPECT_THAT(Imported(name, text).said(), Not(HasSubstr("does not read that"))) << text;
}

TEST(Importers, AForeignTextUnderANameOfOursIsToldItsEnding) {
    const std::vector<std::array<std::string, 3>> misnamed = {
        {"a.inst", "startshape A\nrule A { CIRCLE { s 0.5 } A { x 1 s 0.9 } }\n", "ending .cfdg"},
        {"a.lsys", "set maxdepth 100\nr1\nrule r1 { { x 1 ry 3 } r1\n box }\n", "ending .es"},
        {"a.inst", "10 * { x 1 } box\n", "ending .es"},
        {"a.lsys", two_models, "ending .l,"}};
    for (const auto& [name, text, ending] : misnamed) {
        const Imported model(name, text);
        EXPECT_FALSE(model.graph);
        EXPECT_EQ(model.diagnostics.error_count(), 1u) << model.said();
        EXPECT_THAT(model.said(), HasSubstr(ending));
    }
    // Models in our languages, with a fault, keep their own messages.
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"a.lsys", "lsys a {\n axiom F\n F=F+F\n}\n"},
             {"a.inst", "object a { sphere } # startshape\ncube\n"},
             {"a.inst", "object a {\n3 * { x 1 } box\n"},
             {"a.lsys", "lsyst a {\n axiom F\n F -> F+F\n}\n"}}) {
        const Imported model(name, text);
        EXPECT_GT(model.diagnostics.error_count(), 0u) << text;
        EXPECT_THAT(model.said(), Not(HasSubstr("looks like"))) << text;
    }
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

TEST(Importers, FlamesOfOneNameGetNamesThatNoOtherHas) {
    const std::string map = "<xform weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 0 0\"/></flame>";
    const std::string text = "<flames><flame name=\"a\">" + map + "<flame name=\"a_3\">" + map +
                             "<flame name=\"a\">" + map + "</flames>";
    const Imported third("b.flame:a_4", text);
    EXPECT_TRUE(third.graph) << third.said();
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

/// Texts of each format that draws something, by an ending of its own.
const std::vector<std::pair<std::string, std::string>> texts = {
    {"l", "Koch {\n Angle 6\n Axiom F\n F=F-F\n}\n"},
    {"l", "Lsystem: 1\nderivation length: 2\nAxiom: F\nF --> F-F\nendlsystem\n"},
    {"ls", "2\n90\n10\nF\nF=F-F\n@\n"},
    {"ls", "recursion 2\nangle 90\naxiom F\nrule F = F-F\n"},
    {"ifs", "dust {\n .5 0 0 .5 -1 0 .5\n .5 0 0 .5 1 0 .5\n}\n"},
    {"flame", "<flame name=\"a\"><xform weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 -1 0\"/></flame>\n"},
    {"es", "set maxdepth 3\nr\nrule r {\n box\n { x -1 s 0.9 } r\n}\n"},
    {"lpy", "Axiom: F\nderivation length: 2\nproduction:\nF --> F-F\nendlsystem\n"},
    {"txt", "Premise: F\nGenerations: 2\nRule 1: F=F-F\n"},
    {"txt", "axiom = F\niterations = 2\nangle = 90\nF -> F-F\n"},
    {"cfdg", "startshape a\nshape a { SQUARE [x -1] }\n"}};

TEST(Importers, TheBytesOfATextDoNotMatter) {
    for (const auto& [ending, text] : texts) {
        const Imported plain("a." + ending, text);
        ASSERT_TRUE(plain.graph) << text << plain.said();
        std::string dos, mac, wide = "\xff\xfe", wide_swapped = "\xfe\xff";
        for (const char c : text) {
            dos += c == '\n' ? "\r\n" : std::string(1, c);
            mac += c == '\n' ? '\r' : c;
            wide += std::string{c, '\0'};
            wide_swapped += std::string{'\0', c};
        }
        for (const std::string& bytes : {"\xef\xbb\xbf" + text, dos, dos + "\x1a", mac, wide, wide_swapped}) {
            const Imported other("a." + ending, bytes);
            EXPECT_EQ(other.translation, plain.translation) << ending;
            EXPECT_EQ(other.said(), plain.said()) << ending;
        }
    }
}

TEST(Importers, ATypographicMinusIsReadOrRefused) {
    for (const std::string minus : {"\u2212", "\u2013", "\u2014", "\x96"})
        for (const auto& [ending, text] : texts) {
            std::string typographic = text;
            typographic.replace(typographic.rfind('-'), 1, minus);
            const Imported plain("a." + ending, text), other("a." + ending, typographic);
            if (!other.graph) {
                EXPECT_TRUE(other.diagnostics.has_errors()) << typographic;
                continue;
            }
            EXPECT_EQ(other.translation, plain.translation) << typographic;
            EXPECT_THAT(other.said(), HasSubstr("it is read as -")) << typographic;
        }
    const Imported model("a.l:K", "K {\n Angle 6\n Axiom F\n F=F\u2212F\n}\n");
    ASSERT_TRUE(model.graph);
    EXPECT_THAT(model.said(), HasSubstr("a.l:4:5: warning: '\u2212' is a minus sign: it is read as -\n"));
    EXPECT_THAT(Imported("a.l:K", "K {\n Angle 6\n Axiom F\n F=F\u0394F\n}\n").said(),
                HasSubstr("a.l:4:5: error: unexpected character '\u0394'"));
    // Letters of Latin-1 are symbols, in either encoding.
    for (const std::string letter : {"\xe9", "\u00e9"})
        EXPECT_EQ(
            Imported("a.l:K", "K {\n Angle 6\n Axiom " + letter + "\n " + letter + "=F+F\n}\n", {.steps = 1})
                .derivation->segments,
            "2");
}

TEST(Importers, TheContentDecides) {
    for (const auto& [own, text] : texts) {
        const Imported plain("a." + own, text);
        for (const std::string ending :
             {"l", "ls", "ifs", "flame", "es", "cfdg", "lpy", "s", "txt", "lsystem", "LS"}) {
            const Imported other("a." + ending, text);
            EXPECT_EQ(other.translation, plain.translation) << own << " as " << ending << other.said();
        }
    }
    EXPECT_EQ(Imported("a.ls:Koch", two_models).said(),
              "graftal: note: 'a.ls' is read as Fractint L-system: its content is not L-Parser\n");
}

TEST(Importers, WhatDoesNotFitIsNamedByItsLine) {
    EXPECT_THAT(
        Imported("a.l", "\n# old\nAxiom: F\n").said(),
        HasSubstr("a.l:2:1: error: 'a.l' is no cpfg L-system or Fractint L-system: these words begin none"));
    EXPECT_THAT(Imported("a.ifs", "fern\n.5 0 0 .5 0 0\n").said(),
                HasSubstr("a.ifs:1:1: error: 'a.ifs' is no Fractint IFS"));
    EXPECT_THAT(Imported("a.txt", std::string("a\n\0", 3)).said(), HasSubstr("its line 2 has a byte 0"));
    EXPECT_THAT(Imported("a.ls", " \n").said(), HasSubstr("the file has no axiom"));
    EXPECT_THAT(Imported("a.lsystem", " \n").said(), HasSubstr("it is empty"));
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
