#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

Imported cpfg(const std::string& lines) {
    return Imported("plant.l", lines);
}

TEST(Cpfg, KeepsNamesCommentsAndStructure) {
    const Imported model = cpfg("#define R 0.5 /* the ratio */\n#define N 3\n/* a tree */\nLsystem: 1\n"
                                "derivation length: N\nAxiom: A(1)\n\n/* it branches */\n"
                                "A(x) : x > R/4 {y = x*R; z = y;} --> F(x)[+A(y)]\n\t[-A(z)]\nhomomorphism\n"
                                "A(x) --> F(x)\nendlsystem\n");
    EXPECT_EQ(model.translation, "# the ratio\n"
                                 "# a tree\n"
                                 "lsys Plant {\n"
                                 "  let R = 0.5\n"
                                 "  let N = 3\n"
                                 "  angle 45\n"
                                 "  steps N\n"
                                 "  axiom A(1)\n"
                                 "  # it branches\n"
                                 "  A(x) : x > R/4 with y = x*R, z = y -> F(x)[+A(y)][-A(z)]\n"
                                 "  interpret {\n"
                                 "    A(x) -> F(x)\n"
                                 "  }\n"
                                 "}\n");
    EXPECT_EQ(model.derivation->segments, "15") << model.said();
}

TEST(Cpfg, WritesOutMacrosWithParametersAndConditions) {
    const Imported model =
        cpfg("#define twice(a) (2*(a))\n#define LEAVES 1\n#if LEAVES\n#define END F(twice(x))\n#else\n"
             "#define END\n#endif\nLsystem: 1\nderivation length: 1\nAxiom: A(3)\n"
             "A(x) --> END[+(x > 2 ? 10 : 20)F(1)]\nendlsystem\n");
    EXPECT_THAT(model.translation, HasSubstr("A(x) -> F((2*(x)))[+(choose(x > 2, 10, 20))F(1)]"));
    EXPECT_EQ(model.segments().size(), 2u) << model.said();
}

TEST(Cpfg, ReadsTheViewFileAndItsFunctionsAndSurfaces) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "graftal_cpfg_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "p.v") << "angle increment: 30\ninitial line width: 0.1\nline style: cylinder\n"
                                     "function: grow.func 3\nsurface: l leaf.s 2\n";
    std::ofstream(folder / "grow.func")
        << "fver 1 1\nname: grow\nsamples: 3\nflip: off\npoints: 2\n0 1\n1 5\n";
    std::ofstream(folder / "leaf.s")
        << "CONTACT POINT  X: 0 Y: 0 Z: 0\nHEADING  X: 0 Y: 1 Z: 0\nUP X: 0 Y: 0 Z: 1\npatch\n"
           "0 0 0 1 0 0 2 0 0 3 0 0\n0 1 0 1 1 0 2 1 0 3 1 0\n0 2 0 1 2 0 2 2 0 3 2 0\n"
           "0 3 0 1 3 0 2 3 0 3 3 0\n";
    const Imported model((folder / "p.l").string(), "Lsystem: 1\nderivation length: 0\n"
                                                    "Axiom: F(func(1, 0.25))+F(1)~l(0.5)\nendlsystem\n");
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("table grow_of = 1, 3, 5"));
    EXPECT_THAT(model.translation, HasSubstr("use surface_l = \"leaf.s\""));
    const auto segments = model.segments();
    ASSERT_EQ(segments.size(), 2u);
    EXPECT_NEAR(segments[0].second.y, 2, 1e-6);
    EXPECT_NEAR(segments[1].second.x, -0.5, 1e-9);
}

TEST(Cpfg, ChoosesByTheSharesOfProbabilities) {
    const Imported model = cpfg("Lsystem: 1\nseed: 7\nderivation length: 8\nAxiom: A\nA --> F(1)A : 30\n"
                                "A --> F(1)[+A]A : 60\nendlsystem\n");
    EXPECT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr(": 30/90"));
}

TEST(Cpfg, AHomomorphismOfDepthOneIsNotAppliedToItself) {
    const Imported model =
        cpfg("Lsystem: 1\nderivation length: 0\nAxiom: F(2)\nhomomorphism\nF(x) --> F(x)F(x)\n"
             "endlsystem\n");
    EXPECT_EQ(model.segments().size(), 2u) << model.said();
}

TEST(Cpfg, ReadsContexts) {
    const Imported model =
        cpfg("Lsystem: 1\nderivation length: 2\nconsider: AB[]\nAxiom: B[+A]A[-A]A\nB < A --> B\n"
             "homomorphism\nB --> F(1)\nendlsystem\n");
    EXPECT_EQ(model.derivation->segments, "5") << model.said();
}

TEST(Cpfg, NamesWhatHasNoTranslation) {
    const auto said = [](const std::string& lines) {
        return cpfg("Lsystem: 1\nderivation length: 1\n" + lines + "endlsystem\n").said();
    };
    EXPECT_THAT(said("Axiom: F?P(0,0,0)\n"), HasSubstr("plant.l:3:1: error: queries"));
    EXPECT_THAT(said("StartEach: {n = n+1;}\nAxiom: F\n"),
                HasSubstr("plant.l:3:1: error: variables that change"));
    EXPECT_THAT(said("Axiom: A\nA B --> F\n"), HasSubstr("a production for 2 modules"));
    EXPECT_THAT(said("Axiom: F@M(1,2,3)\n"), HasSubstr("the directive '@M' has no translation"));
    EXPECT_THAT(said("Axiom: ~l(1)\n"), HasSubstr("the view file names no surface for '~l'"));
    EXPECT_THAT(said("Axiom: F(func(1, 2))\n"), HasSubstr("there is no function 1"));
    EXPECT_THAT(said("Axiom: F(a[1])\n"), HasSubstr("arrays have no translation"));
    EXPECT_THAT(said("derivation length: 1\nfoo\nAxiom: F\n"),
                HasSubstr("plant.l:4:1: error: this is no statement"));
}

} // namespace
} // namespace graftal::testing
