#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

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

/// At the median of beta(5, 5) Newton's steps, by which Boost finds quantiles, give up.
TEST(Cpfg, BetaIsATableOfItsQuantiles) {
    for (const std::string shape : {"5, 5", "0.01, 0.01", "1, 1", "0.5, 999", "999, 999", "2, 3"}) {
        const Imported model =
            cpfg("Lsystem: 1\nderivation length: 1\nAxiom: A\nA --> F(bran(" + shape + "))\nendlsystem\n");
        ASSERT_TRUE(model.graph) << shape << model.said();
        EXPECT_THAT(model.translation, HasSubstr("(random(0, 1))"));
        std::istringstream numbers(model.translation.substr(model.translation.find(" = ") + 3));
        std::vector<double> quantiles;
        for (double number; numbers >> number; numbers.ignore(1, ','))
            quantiles.push_back(number);
        ASSERT_EQ(quantiles.size(), 65u) << model.translation;
        EXPECT_EQ(quantiles.front(), 0);
        EXPECT_EQ(quantiles.back(), 1);
        EXPECT_TRUE(std::ranges::is_sorted(quantiles)) << shape;
        const bool symmetric = shape.substr(0, shape.find(',')) == shape.substr(shape.find(' ') + 1);
        EXPECT_TRUE(!symmetric || std::abs(quantiles[32] - 0.5) < 1e-9) << shape << ": " << quantiles[32];
    }
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

TEST(Cpfg, AContextOfAnythingIsNone) {
    const Imported model = cpfg("Lsystem: 1\nseed: 7\nderivation length: 8\nAxiom: A\n"
                                "* < A > * --> F(1)A : 30\nA --> F(1)[+A]A : 60\nendlsystem\n");
    EXPECT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("  A -> F(1)A : 30/90\n"));
}

TEST(Cpfg, CommentsAskNoEnvironment) {
    const Imported model = cpfg("Lsystem: 1\nderivation length: 1\nAxiom: F\n/* no ?E here */\nF --> F+F\n"
                                "endlsystem\n");
    EXPECT_TRUE(model.graph);
    EXPECT_EQ(model.said(), "");
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

TEST(Cpfg, RollsTheOtherWay) {
    // In cpfg '/' takes the left away from the viewer: '+' then bends away.
    const Imported model = cpfg("Lsystem: 1\nderivation length: 0\nAxiom: /(90)+(90)F(1)\nendlsystem\n");
    ASSERT_EQ(model.segments().size(), 1u) << model.said();
    EXPECT_NEAR(model.segments()[0].second.z, -1, 1e-9);
}

TEST(Cpfg, TakesStrictPredecessorsOfSeveralModules) {
    const Imported model = cpfg("Lsystem: 1\nderivation length: 2\nAxiom: AB[C]D\nAB --> FB\nB[C] --> F[F]\n"
                                "endlsystem\n");
    EXPECT_EQ(model.derivation->segments, "3") << model.said();
}

TEST(Cpfg, KeepsVariablesThatChangeAndThoseThatDoNot) {
    const Imported model =
        cpfg("Lsystem: 1\nStart: {n = 1; len = 2; m = len*2;}\nStartEach: {n = n+1; printf(\"%f;\", n);}\n"
             "derivation length: 3\nAxiom: A\nA --> F(n)A\nendlsystem\n");
    EXPECT_THAT(model.translation, HasSubstr("  let len = 2\n  let m = len*2\n"));
    EXPECT_THAT(model.translation, HasSubstr("  variable n = 1\n  start each { n = n+1 }\n"));
    ASSERT_EQ(model.segments().size(), 3u) << model.said();
    EXPECT_NEAR(model.segments()[2].second.y, 2 + 3 + 4, 1e-9);
    EXPECT_THAT(model.said(), HasSubstr("what the model prints is left out"));
}

TEST(Cpfg, KeepsArraysConditionsAndLoops) {
    const Imported model =
        cpfg("Lsystem: 1\ndefine: { array len[2][2] = {1,2,3,4}; }\nderivation length: 1\nAxiom: A(1)\n"
             "A(x) : { y = 0; i = 0; while (i < 2) { y = y + len[x][i]; i = i+1; }\n\tif (y > 6) y = 10; "
             "else y = 1; } 1\n"
             "\t--> F(y)\nendlsystem\n");
    EXPECT_THAT(model.translation, HasSubstr("  array len[2][2] = 1, 2, 3, 4\n"));
    ASSERT_EQ(model.segments().size(), 1u) << model.said();
    EXPECT_NEAR(model.segments()[0].second.y, 10, 1e-9);
}

TEST(Cpfg, DecomposesInStepsOnly) {
    const std::string lines =
        "Axiom: A(3)\nB --> F\ndecomposition\nmaximum depth: 9\nA(n) : n > 0 --> BA(n-1)\n"
        "endlsystem\n";
    EXPECT_EQ(cpfg("Lsystem: 1\nderivation length: 1\n" + lines).segments().size(), 0u);
    EXPECT_EQ(cpfg("Lsystem: 1\nderivation length: 2\n" + lines).segments().size(), 3u);
}

TEST(Cpfg, JoinsModulesThatAreOneName) {
    const Imported model =
        cpfg("Lsystem: 1\nderivation length: 1\nAxiom: AXIOM\nO(x) --> F(x)\ndecomposition\n"
             "AXIOM --> O(2)\nhomomorphism\nO(x) --> F(x)F(x)\nendlsystem\n");
    EXPECT_EQ(model.segments().size(), 2u) << model.said();
}

TEST(Cpfg, CutsOneStepLater) {
    const std::string lines = "Axiom: A[F]B\nA --> F%\nB --> FF\nendlsystem\n";
    EXPECT_EQ(cpfg("Lsystem: 1\nderivation length: 1\n" + lines).segments().size(), 4u);
    EXPECT_EQ(cpfg("Lsystem: 1\nderivation length: 2\n" + lines).segments().size(), 1u);
}

TEST(Cpfg, AsksQueriesBeforeEachStep) {
    const Imported model = cpfg(
        "Lsystem: 1\nderivation length: 9\nconsider: A?P[]\nAxiom: A?P(0,0)\nA > ?P(x,y) : y < 2.5 --> FA\n"
        "endlsystem\n");
    EXPECT_EQ(model.segments().size(), 3u) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("  precedence text\n"));
}

/// After these lines, a condition gives a segment the length 2 where it holds, else 1.
void expect_condition(const std::string& lines, const std::string& condition, bool holds) {
    const Imported model = cpfg(lines + "#if " + condition +
                                "\n#define L 2\n#else\n#define L 1\n#endif\nLsystem: 1\n"
                                "derivation length: 0\nAxiom: F(L)\nendlsystem\n");
    ASSERT_EQ(model.segments().size(), 1u) << condition << "\n" << model.said();
    EXPECT_NEAR(model.segments()[0].second.y, holds ? 2 : 1, 1e-9) << condition;
}

TEST(Cpfg, WritesBooleanConditionsOfThePreprocessorOut) {
    expect_condition("#define A 3\n", "A > 2 && (defined(B) || A*2 == 6) && !defined(C)", true);
}

TEST(Cpfg, WritesMacrosOutThatStandForStatements) {
    const Imported model =
        cpfg("#define INIT a = 1; b = 2;\n#define INC(x) x = x + 3\nLsystem: 1\nStart: { INIT INC(a); }\n"
             "derivation length: 0\nAxiom: F(a)F(b)\nendlsystem\n");
    ASSERT_EQ(model.segments().size(), 2u) << model.said();
    EXPECT_NEAR(model.segments()[0].second.y, 4, 1e-9);
    EXPECT_NEAR(model.segments()[1].second.y, 6, 1e-9);
}

TEST(Cpfg, DoesNotComputeWhatAConditionDoesNotNeed) {
    for (const char* const condition : {"N && 10/N > 2", "!(N == 0 || 10/N > 2)", "0 && (1 || 1/0)"})
        expect_condition("#define N 0\n", condition, false);
}

/// Files beside a model, in a folder of their own.
class Companions {
  public:
    explicit Companions(const std::map<std::string, std::string>& files) {
        std::filesystem::create_directories(folder_);
        for (const auto& [name, text] : files)
            std::ofstream(folder_ / name) << text;
    }
    ~Companions() { std::filesystem::remove_all(folder_); }

    Imported model(const std::string& lines) const { return Imported((folder_ / "p.l").string(), lines); }

  private:
    std::filesystem::path folder_ = std::filesystem::temp_directory_path() / "graftal_cpfg_companions";
};

TEST(Cpfg, FindsWhatTheSpecificationsName) {
    const Companions files({{"specifications", "model:\n\tcpfg -e world.e p.l other.v p.a\n"},
                            {"other.v", "angle increment: 20\ninitial line width: 0.1\nline style: cylinder\n"
                                        "line width increment: 0.02\ntropism direction: 1,0,0\n"
                                        "elasticity increment: 0.1\nfunction set: all.fset\n"},
                            {"all.fset", "funcgalleryver 1 1\nitems: 1\nfver 1 1\nname: GROWTH\nsamples: 3\n"
                                         "flip: off\npoints: 2\n0 0\n1 4\n"},
                            {"world.e", "executable: honda81 -e world.e near.spec\n"},
                            {"near.spec", "radius: 0.5\n3d case: on\n"}});
    const Imported model =
        files.model("Lsystem: 1\nderivation length: 1\n"
                    "Axiom: F_F#F(func(GROWTH, 0.5))?E(1)\n?E(x) : x == 1 --> FFF\nendlsystem\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("angle 20"));
    EXPECT_THAT(model.translation, HasSubstr("table GROWTH_of = 0, 2, 4"));
    EXPECT_THAT(model.translation, HasSubstr("environment crowd 0.5\n"));
    EXPECT_THAT(model.translation, HasSubstr("bending after moves"));
    EXPECT_THAT(model.translation, HasSubstr("F@K(0.1)F@I(0.02)F(GROWTH_of(0.5))"));
    EXPECT_EQ(model.segments().size(), 6u) << model.said();
}

TEST(Cpfg, KnowsTheEnvironmentsThatItTranslates) {
    const auto translated = [](const std::string& executable, const std::string& specification) {
        const Companions files({{"specifications", "m:\n\tcpfg -e w.e p.l\n"},
                                {"w.e", "executable: " + executable + " s.spec\n"},
                                {"s.spec", specification}});
        const Imported model = files.model("Lsystem: 1\nderivation length: 1\nAxiom: F?E(1)\nendlsystem\n");
        return model.translation.empty() ? model.said() : model.translation;
    };
    EXPECT_THAT(translated("honda81", "radius: 2\n"), HasSubstr("environment crowd 2, 0, 1, 0\n"));
    EXPECT_THAT(translated("honda81", "radius: 1.5 metres\n"), HasSubstr("environment crowd 1.5, 0, 1, 0\n"));
    EXPECT_THAT(translated("honda81", "radius: wide\n"), HasSubstr("has no translation"));
    EXPECT_THAT(translated("ecosystem -e w.e", "3d case: on\n"), HasSubstr("environment rivals\n"));
    EXPECT_THAT(translated("chiba",
                           "transmittance: 0.5\nestimate intersection area: on\nsource direction: 0 1 0 2\n"),
                HasSubstr("environment shade 0.5,  0, 1, 0, 2\n"));
    EXPECT_THAT(translated("clover", ""), HasSubstr("the environment program 'clover' has no translation"));
}

TEST(Cpfg, SurfacesAreAsLargeAsTheirSizeSays) {
    const Companions files(
        {{"p.v", "surface: l leaf.s 2\n"},
         {"leaf.s", "CONTACT POINT  X: 0 Y: 0 Z: 0\nHEADING  X: 0 Y: 2 Z: 0\nUP X: 0 Y: 0 Z: -1\n"
                    "SIZE: 10\nBLADE\nTOP COLOR: 0 DIFFUSE: 0\nAL: ~ A: ~ AR: ~\nL: ~ R: ~\n"
                    "0 0 0 1 0 0 2 0 0 3 0 0\n0 1 0 1 1 0 2 1 0 3 1 0\n"
                    "0 2 0 1 2 0 2 2 0 3 2 0\n0 3 5 1 3 5 2 3 5 3 3 5\n"}});
    const Imported model = files.model("Lsystem: 1\nderivation length: 0\nAxiom: F~l(1,2,3)\nendlsystem\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("~surface_l(2*(1), 2*(2), 2*(3))"));
    const SourceMap& sources = model.sources;
    std::string surface;
    for (FileId file = 0; file < sources.size(); ++file)
        if (sources.original(file) && sources.text(file).find("bicubic") != std::string_view::npos)
            surface = sources.text(file);
    EXPECT_THAT(surface, HasSubstr("0, 0.3, 0.5"));
}

TEST(Cpfg, NamesWhatHasNoTranslation) {
    const auto said = [](const std::string& lines) {
        return cpfg("Lsystem: 1\nderivation length: 1\n" + lines + "endlsystem\n").said();
    };
    EXPECT_THAT(said("Axiom: F?Q(0,0,0,0)\n"),
                HasSubstr("plant.l:3:1: error: the query '?Q' has no translation"));
    EXPECT_THAT(said("Axiom: ?(2,1)F$\n"), HasSubstr("sub-L-systems (?) have no translation"));
    EXPECT_THAT(said("Axiom: A\nA --> F[&(30)$A]\n"), // as ABOP writes a roll
                ::testing::AllOf(HasSubstr("plant.l:4:1: error: sub-L-systems ($) have no translation"),
                                 HasSubstr("in cpfg '@v' rolls the turtle to the horizontal")));
    EXPECT_THAT(said("EndEach: {stop(1);}\nAxiom: F\n"),
                HasSubstr("plant.l:3:1: error: 'stop' has no translation"));
    EXPECT_THAT(said("Axiom: F@PS(1)\n"), HasSubstr("the directive '@PS' has no translation"));
    EXPECT_THAT(said("Axiom: ~l(1)\n"), HasSubstr("names no surface for '~l', so it draws nothing"));
    EXPECT_THAT(said("Axiom: F(func(1, 2))\n"), HasSubstr("there is no function 1"));
    EXPECT_THAT(said("Axiom: F(curveX(1, 2))\n"), HasSubstr("curve 1 of the view file is no spline"));
    EXPECT_THAT(said("Axiom: A[B]\nA > [B] --> F\n"), HasSubstr("must end (without '=')"));
    EXPECT_THAT(said("Axiom: [AB]C\nA > B=]C --> F\n"), HasSubstr("leaves its branch"));
    EXPECT_THAT(said("consider: AB\nAxiom: A[B]\nA > B --> F\n"), HasSubstr("sees through ignored brackets"));
    EXPECT_THAT(said("ring lsystem\nAxiom: A\n"), HasSubstr("a ring L-system has no translation"));
    EXPECT_THAT(said("derivation length: 1\nfoo\nAxiom: F\n"),
                HasSubstr("plant.l:4:1: error: this is no statement"));
}

} // namespace
} // namespace graftal::testing
