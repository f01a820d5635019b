#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A model with these rules, whose first lines are Python's and the axiom.
Imported lpy(const std::string& axiom, const std::string& rules, const std::string& before = "",
             LowerOptions options = {}) {
    return Imported("plant.lpy",
                    before + "Axiom: " + axiom + "\n\nderivation length: 4\nproduction:\n" + rules, options);
}

std::vector<Vec3> lpy_ends(const std::string& axiom) {
    const Imported model = lpy(axiom, "");
    return model.ends();
}

TEST(Lpy, KeepsNamesAndStructure) {
    const Imported model("tree.lpy",
                         "# A tree\nfrom math import *\nR = 0.5\nmodule Apex(size)\n"
                         "Axiom: Apex(1)\nderivation length: 3\nproduction:\n"
                         "# it branches\nApex(s) :\n  if s > R/4 :\n"
                         "    produce F(s)[+(40)Apex(s*R)][Right(40)Apex(s*R)]\n  else:\n"
                         "    produce F(s) # the end\ninterpretation:\nApex(s) --> @O(s/2)\n"
                         "endlsystem\n###### INITIALISATION ######\n\n__lpy_code_version__ = 1.1\n");
    const std::string begin = model.translation.substr(0, model.translation.find("material"));
    EXPECT_EQ(begin, "# A tree\n");
    EXPECT_THAT(model.translation, HasSubstr("lsys Tree {\n"
                                             "  modules Apex\n"
                                             "  let R = 0.5\n"
                                             "  angle 60\n"
                                             "  width 0.2\n"
                                             "  colors colour0, "));
    EXPECT_THAT(model.translation, HasSubstr("  steps 3\n"
                                             "  axiom ;(1)Apex(1)\n"
                                             "  # it branches\n"
                                             "  Apex(s) : (s > R/4) -> F(s)[+(40)Apex(s*R)][-(40)Apex(s*R)]\n"
                                             "  Apex(s) : !(s > R/4) -> F(s)\n"
                                             "  interpret {\n"
                                             "    Apex(s) -> @O(2*(s/2))\n"
                                             "  }\n"
                                             "}\n"));
    EXPECT_EQ(model.segment_count(), "7");
}

TEST(Lpy, ComputesAsPythonDoes) {
    // The remainder has the sign of the divisor.
    const Imported remainder = lpy("F((0-1) % 4)", "");
    ASSERT_EQ(remainder.ends().size(), 1u) << remainder.said();
    EXPECT_NEAR(glm::length(remainder.ends()[0]), 3, 1e-9);
    // A name may begin with a word of L-Py.
    const Imported external = lpy("F(external_length)", "", "external_length = 3\n");
    ASSERT_EQ(external.ends().size(), 1u) << external.said();
    EXPECT_NEAR(glm::length(external.ends()[0]), 3, 1e-9);
    // A local keeps its value when what it was read from changes: no translation, and it is said.
    const Imported swap =
        lpy("F(a)F(b)", "", "a = 1\nb = 2\ndef StartEach():\n  global a, b\n  t = a\n  a = b\n  b = t\n");
    EXPECT_THAT(swap.said(), HasSubstr("left out"));
}

TEST(Lpy, HasTheCountsOfTheSameSystemByHand) {
    const Imported model("a.lpy",
                         "Axiom: A(0)\nderivation length: 6\nproduction:\nA(n) :\n"
                         "  if n % 2 == 0 : produce F[+A(n+1)]A(n+1)\n  produce FF[-A(n+1)]\nendlsystem\n");
    const Imported by_hand("a.lsys",
                           "lsys a {\n steps 6\n axiom A(0)\n A(n) : n % 2 == 0 -> F[+A(n+1)]A(n+1)\n"
                           " A(n) -> FF[-A(n+1)]\n}\n");
    EXPECT_EQ(model.segment_count(), by_hand.segment_count());
}

TEST(Lpy, TurnsAreThoseOfItsTurtle) {
    const double sine = std::sqrt(0.75);
    expect_near(lpy_ends("+F(2)").back(), {-2 * sine, 1, 0});
    expect_near(lpy_ends("Right(90)F(2)").back(), {2, 0, 0});
    expect_near(lpy_ends("&(90)F").back(), {0, 0, -1});
    expect_near(lpy_ends("Up(90)F").back(), {0, 0, 1});
    expect_near(lpy_ends("/(90)^(90)F").back(), {1, 0, 0}); // up leans to the right
    expect_near(lpy_ends("RollR(90)^(90)F").back(), {-1, 0, 0});
    expect_near(lpy_ends("|F").back(), {0, -1, 0});
    expect_near(lpy_ends("f(2)F(1)").back(), {0, 3, 0});
    expect_near(lpy_ends("[+(90)F(1)]@Di(0.5)F(4)").back(), {0, 2, 0});
    // The axes x, y, z are our z, x, y.
    expect_near(lpy_ends("@M(1, 2, 3)F(1)").back(), {2, 4, 1});
    expect_near(lpy_ends("SetHead(1, 0, 0, 0, 0, 1)F(1)").back(), {0, 0, 1});
    expect_near(lpy_ends("F(1)nF(2, 0.1)").back(), {0, 3, 0});
    EXPECT_THAT(lpy("{.F.+F.+F}(True)F", "").translation, HasSubstr("{.F.+F.+F}F"));
}

TEST(Lpy, WidthsAreRadii) {
    const Imported model = lpy("F(1)_(0.3)F(1)SetWidth(0.05)F(1)", "");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<double> radii = model.radii();
    ASSERT_EQ(radii.size(), 3u);
    std::ranges::sort(radii);
    EXPECT_NEAR(radii[0], 0.05, 1e-9);
    EXPECT_NEAR(radii[1], 0.1, 1e-9);
    EXPECT_NEAR(radii[2], 0.3, 1e-9);
    EXPECT_THAT(lpy("F(2, 0.05)F(1)", "").translation, HasSubstr("@GsF(2)!(2*(0.05))@GeF(1)"));
}

TEST(Lpy, RulesDecideByIf) {
    EXPECT_EQ(lpy("A(0)", "A(n):\n  if n < 2: produce FA(n+1)\n  elif n < 3:\n    produce FFA(n+1)\n")
                  .segment_count(),
              "4");
    EXPECT_EQ(
        lpy("A(0)", "A(n):\n\tm = n + 1\n\tif m < 3 and not m == 9:\n\t\tm += 1\n\t\tproduce F(m)A(m)\n")
            .segment_count(),
        "1");
    EXPECT_EQ(lpy("A(0)", "A(n):\n  nproduce F\n  if n > 1:\n    nproduce [+F]\n  produce A(n+1)\n")
                  .segment_count(),
              "6");
    EXPECT_EQ(lpy("A(0)B", "A(0) --> FFB\nB --> A(1)\nA(n) --> F\n").segment_count(), "4");
    const Imported model = lpy("A(1)", "A(x) :\n  y = x if 0 < x < 2 else 7\n  produce F(y**2 % 3)\n");
    EXPECT_THAT(model.translation, HasSubstr("F(mod(mod((choose((0 < x && x < 2), x, 7))^2, 3) + (3), 3))"));
}

TEST(Lpy, FunctionsOfOneExpressionAreWrittenOut) {
    const Imported model =
        lpy("A(3)", "A(n) --> F(length(n))F(half(n, 4))\n",
            "import math as m\ndef length(x):\n  \"\"\"long\"\"\"\n  y = 2*x\n  if x > 2:\n    return y\n"
            "  else:\n    return m.sqrt(x)\nhalf = lambda x, k: x/k\n");
    EXPECT_THAT(model.translation, HasSubstr("F((choose(((n) > 2), (2*(n)), sqrt((n)))))F(((n)/(4)))"));
    EXPECT_NEAR(model.segments().back().second.y, 6.75, 1e-9) << model.said();
}

TEST(Lpy, AParameterHidesANumberOfTheFile) {
    const Imported model = lpy("A(3)", "A(a) --> F(twice(a))F(a)\n", "a = 5\ndef twice(x): return a*x\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_NEAR(model.segments().back().second.y, 18, 1e-9) << model.translation;
}

TEST(Lpy, ChanceHasItsShares) {
    const Imported one =
        lpy(std::string(2000, 'A'), "A :\n  if random() <= 0.3: produce F\n  else: produce FF\n");
    EXPECT_THAT(one.translation, HasSubstr("  A -> F : (0.3)\n  A -> FF : max(0, 1 - (0.3))\n"));
    EXPECT_NEAR(std::stod(one.segment_count()), 600 + 2 * 1400, 120) << one.said();
    const Imported three =
        lpy(std::string(2000, 'A'),
            "A :\n  r = rd.random()\n  if r < 0.2: produce F\n  elif r < 0.5: produce FF\n  else: "
            "produce FFF\n",
            "import random as rd\n");
    EXPECT_THAT(three.translation, HasSubstr("  A -> F : (0.2)\n  A -> FF : max(0, 0.5 - (0.2))\n"
                                             "  A -> FFF : max(0, 1 - (0.5))\n"));
    EXPECT_NEAR(std::stod(three.segment_count()), 400 + 2 * 600 + 3 * 1000, 200) << three.said();
    EXPECT_THAT(lpy("A", "A --> F(uniform(1, 2))\n").translation, HasSubstr("F(random(1, 2))"));
    EXPECT_THAT(lpy("A", "A :\n  x = uniform(0, 1)\n  produce F(x)F(x)\n").said(),
                HasSubstr("a number of chance is used twice"));
    EXPECT_THAT(lpy("A", "A :\n  if uniform(0, 2) < 1: produce F\n").said(),
                HasSubstr("a condition of chance is written"));
}

TEST(Lpy, NumbersOfTheFileMayChangeEachStep) {
    const std::string before = "age = 0\ndef StartEach():\n  global age\n  age = age + 1\n";
    const Imported model = lpy("A", "A :\n  if age < 3: produce FA\n", before);
    EXPECT_EQ(model.segment_count(), "2") << model.translation;
    EXPECT_THAT(lpy("A", "A :\n  if age < 3: produce FA\n",
                    "age = 0\ndef StartEach():\n  global age\n  age = read('file')\n")
                    .said(),
                HasSubstr("error: 'age' is Python that has no translation"));
    EXPECT_EQ(lpy("A", "A --> FA\n", "def End(string):\n  print(string)\n  string.save()\n").segment_count(),
              "4");
}

TEST(Lpy, ContextsAreThoseOfTheFile) {
    EXPECT_EQ(lpy("B+A+A", "ignore: +\nB < A --> B\ninterpretation:\nB --> F\n").segment_count(), "3");
    EXPECT_EQ(lpy("BA+A", "B < A --> B\ninterpretation:\nB --> F\n").segment_count(), "2");
    EXPECT_EQ(lpy("A(1)A(2)", "A(x) > A(y) : produce F(y)B\n").segment_count(), "1");
}

TEST(Lpy, InterpretationsAreAppliedAsOftenAsTheySay) {
    EXPECT_EQ(lpy("A", "interpretation:\nA --> FB\nB --> FF\n").segment_count(), "1");
    EXPECT_EQ(lpy("A", "interpretation:\nmaximum depth: 2\nA --> FB\nB --> FF\n").segment_count(), "3");
    EXPECT_EQ(lpy("A", "A --> BA\ndecomposition:\nB --> FF\n").segment_count(), "8");
}

/// The message about loops advises this.
TEST(Lpy, AModuleCountsTheTurnsOfALoop) {
    EXPECT_EQ(lpy("A(5)", "A(n):\n  produce L(0, n)F(2)\ndecomposition:\nmaximum depth: 20\nL(i, n):\n"
                          "  if i < n: produce F(1)[+(60)F(0.5)]L(i + 1, n)\n")
                  .segment_count(),
              "11");
}

TEST(Lpy, RefusesPythonByItsLine) {
    const auto said = [](const std::string& rules, const std::string& before = "") {
        return lpy("A(1)", rules, before).said();
    };
    EXPECT_THAT(said("A(n) :\n  for i in range(3):\n    nproduce F\n"),
                ::testing::AllOf(HasSubstr("plant.lpy:6:3: error: 'for i in range(3)' is a loop of Python"),
                                 HasSubstr("below 'decomposition:'")));
    EXPECT_THAT(said("A(n) :\n  while n < 3: n += 1\n  produce F\n"),
                HasSubstr("'while n < 3' is a loop of Python, which has no translation"));
    EXPECT_THAT(said("A(n) :\n  global m\n  produce F\n"), HasSubstr("'global' is Python"));
    EXPECT_THAT(said("A(n) --> F(sizes[0])\n", "sizes = [1, 2]\n"),
                HasSubstr("'sizes[...]' has no translation"));
    EXPECT_THAT(said("A(n) --> F(sizes)\n", "sizes = [1, 2]\n"),
                HasSubstr("plant.lpy:6:1: error: 'sizes' is Python that has no translation"));
    EXPECT_THAT(said("A(n) --> F(n.size)\n"), HasSubstr("'n' is an object of Python"));
    EXPECT_THAT(said("A(n) --> F(grow(n))\n", "def grow(x):\n  while x < 3: x += 1\n  return x\n"),
                HasSubstr("the function 'grow' is Python that has no translation"));
    EXPECT_THAT(said("A(n) --> F(grow(n))\n", "def grow(x): return grow(x)\n"),
                HasSubstr("'grow' calls itself"));
    EXPECT_THAT(said("A(n) --> F(m)\n"), HasSubstr("'m' has no value"));
    EXPECT_THAT(said("group 1:\nA(n) --> F\n"), HasSubstr("groups of rules have no translation"));
    EXPECT_THAT(said("*(n) --> F\n"), HasSubstr("'*' in what a rule looks for has no translation"));
    EXPECT_THAT(said("A(n) --> LineTo(1, 2, 3)\n"), HasSubstr("'LineTo' has no translation"));
    EXPECT_THAT(said("A(n) --> Sweep(path, section, 2, 0.1, 1)\n"), HasSubstr("it is straight"));
    EXPECT_THAT(said("A(n) --> F~w(2)\n"), HasSubstr("surfaces that are not in the file are left out"));
    EXPECT_THAT(Imported("a.lpy", "derivation length: 3\nproduction:\nA --> F\n").said(),
                HasSubstr("the model has no axiom"));
    EXPECT_THAT(said("A(n) --> F\n"), Not(HasSubstr("error")));
}

TEST(Lpy, NumbersOfTheEditorAreThoseOfTheFile) {
    const Imported model =
        lpy("A(N)", "A(n) --> F(n*size)\nendlsystem\n###### INITIALISATION ######\n"
                    "def __initialiseContext__(context):\n"
                    "\tscalars = [('All','Category'),('N','Integer',3,0,9),('size', 'Float', 0.5, 0, 1, 2)]\n"
                    "\tcontext[\"__scalars__\"] = scalars\n");
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_NEAR(model.segments().back().second.y, 1.5, 1e-9) << model.translation;
}

TEST(Lpy, MaterialsAreThoseOfTheFile) {
    const Imported model = lpy(
        "F",
        "endlsystem\n###### INITIALISATION ######\ndef __initialiseContext__(context):\n"
        "\timport openalea.plantgl.all as pgl\n"
        "\tColor_1 = pgl.Material(\"Color_1\" , ambient = (0,51,0) , diffuse = 5 , specular = (4,4,4) , )\n"
        "\tcontext.turtle.setMaterial(1,Color_1)\n"
        "\tcontext.turtle.setMaterial(8,Material('eight',Color3(0,0,255),1,Color3(40,40,40)))\n");
    EXPECT_THAT(model.translation, HasSubstr("material colour1 { color: 0, 1, 0 }\n"));
    EXPECT_THAT(model.translation, HasSubstr("material colour8 { color: 0, 0, 1 }\n"));
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(lpy("~l(2)", "").said(), Not(HasSubstr("error")));
}

} // namespace
} // namespace graftal::testing
