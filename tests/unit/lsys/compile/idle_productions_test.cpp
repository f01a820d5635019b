// Productions that never apply: each is named once, with its reason; and no other is.

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// "LINE:COLUMN reason" of each remark about a block of these statements, the first of them on line 1.
std::vector<std::string> remarks(const std::string& statements, const LowerOptions& options = {}) {
    SourceMap sources;
    Diagnostics diagnostics;
    static_cast<void>(
        lower_text("m.lsys", "lsys test { " + statements + "\n}\n", options, sources, diagnostics));
    std::vector<std::string> said;
    for (const Diagnostic& finding : diagnostics.all()) {
        EXPECT_NE(finding.hint, "");
        const Position at = sources.position(finding.span.file, finding.span.begin);
        said.push_back(fmt::format("{}:{} {}", at.line, at.column, finding.message));
    }
    return said;
}

std::string never(const std::string& place, const std::string& reason) {
    return place + " this production never applies: " + reason;
}

TEST(LsysIdleProductions, noSuchModule) {
    EXPECT_THAT(remarks("steps 2\naxiom F\nA -> F"),
                ElementsAre(never("3:1", "no axiom or successor has a module 'A'")));
    EXPECT_THAT(remarks("steps 2\naxiom F\nF B -> F\nA > F -> F"),
                ElementsAre(never("3:3", "no axiom or successor has a module 'B'"),
                            never("4:1", "no axiom or successor has a module 'A'")));
    EXPECT_THAT(remarks("steps 2\naxiom I(0)+I[I]\nB < I(n) > C -> I(1)\ninterpret I(n) -> F\n"
                        "interpret I -> F"),
                ElementsAre(never("3:1", "no axiom or successor has a module 'B'")));
    EXPECT_THAT(remarks("steps 2\nignore +\naxiom I(0)+I[I]\nI(n) > +I -> I(1)\ninterpret I(n) -> F\n"
                        "interpret I -> F"),
                ElementsAre(never("4:8", "contexts skip '+'")));
}

TEST(LsysIdleProductions, anotherNumberOfParameters) {
    EXPECT_THAT(remarks("steps 2\naxiom F\nF(x) -> F(x/2)[+F(x/2)]F(x/2)"),
                ElementsAre(never("3:1", "no 'F' with 1 parameter appears")));
    EXPECT_THAT(remarks("steps 2\naxiom F(1)+(30)F(2)\n+ -> -"),
                ElementsAre(never("3:1", "no '+' with no parameters appears")));
    // The axiom's 'A' has no production because of it: one remark says so.
    EXPECT_THAT(remarks("steps 3\naxiom FA\nA(n) -> F(n)A(n+1)"),
                ElementsAre(never("3:1", "no 'A' with 1 parameter appears")));
    EXPECT_THAT(remarks("steps 3\naxiom F\ninterpret F(l) -> G(l)"),
                ElementsAre(never("3:11", "no 'F' with 1 parameter appears")));
}

TEST(LsysIdleProductions, onlyOthersThatNeverApplyLeadToIt) {
    EXPECT_THAT(remarks("steps 3\naxiom F\nA -> B\nB -> FB\nF -> FF"),
                ElementsAre(never("3:1", "no axiom or successor has a module 'A'"),
                            never("4:1", "only productions that never apply make 'B'")));
    EXPECT_THAT(remarks("steps 3\naxiom F\nA -> A"),
                ElementsAre(never("3:1", "only productions that never apply make 'A'")));
}

TEST(LsysIdleProductions, hiddenByAnother) {
    const std::string earlier = "an earlier one applies to each such module";
    EXPECT_THAT(remarks("steps 2\naxiom F\nF -> FF\nF -> F[+F]F"), ElementsAre(never("4:1", earlier)));
    EXPECT_THAT(remarks("steps 2\naxiom F(1)\nF(x) : 1 > 0 -> F(x)F(x)\nF(y) : y > 1 -> F(y)"),
                ElementsAre(never("4:1", earlier)));
    EXPECT_THAT(remarks("steps 2\naxiom F\ninterpret F -> G\ninterpret F -> G[+G]"),
                ElementsAre(never("4:11", earlier)));
    EXPECT_THAT(remarks("steps 2\naxiom F\nF -> FF : 0.5\nF -> F : 0.5\nF -> G"),
                ElementsAre(never("5:1", "those with probabilities apply to each such module")));
    EXPECT_THAT(remarks("steps 2\nprecedence text\naxiom FF\nF -> F\nF < F -> G"),
                ElementsAre(never("5:1", earlier)));
    EXPECT_THAT(remarks("steps 2\naxiom A\nA -> FA\ndecompose A -> F"),
                ElementsAre(never("3:1", "'decompose' replaces each 'A' before")));
}

TEST(LsysIdleProductions, wrongPart) {
    EXPECT_THAT(remarks("steps 2\naxiom FA\nB -> F\ninterpret A -> FB"),
                ElementsAre(never("3:1", "only 'interpret' makes 'B'")));
}

TEST(LsysIdleProductions, neverTrue) {
    EXPECT_THAT(remarks("steps 2\naxiom F(1)\nF(x) : 1 > 2 -> F(x)F(x)"),
                ElementsAre(never("3:8", "its condition is never true")));
    EXPECT_THAT(remarks("steps 2\naxiom F\nF -> FF : 1\nF -> G : 0"),
                ElementsAre(never("4:10", "its probability is 0")));
}

TEST(LsysIdleProductions, noSteps) {
    const std::string text = "axiom FA\nA -> F";
    const std::string zero = "'lsys test' takes 0 steps, so its productions never apply";
    EXPECT_THAT(remarks("steps 0\n" + text), ElementsAre("1:13 " + zero));
    EXPECT_THAT(remarks("steps 0\naxiom A\nA -> F"),
                ElementsAre("1:6 'lsys test' draws nothing after 0 steps"));
    EXPECT_THAT(remarks("steps 0\naxiom FA\ninterpret A -> F"), IsEmpty());
    LowerOptions three;
    three.steps = 3;
    EXPECT_THAT(remarks("steps 0\n" + text, three), IsEmpty());
    LowerOptions none; // asked for, as an animation does for its first frame
    none.steps = 0;
    EXPECT_THAT(remarks("steps 3\n" + text, none), IsEmpty());
}

TEST(LsysIdleProductions, allOfThemApply) {
    for (const char* statements : {
             "steps 2\naxiom F\nF -> F+F : 0.5\nF -> F : 0.5",
             "steps 2\naxiom FF\nF -> G\nF < F -> F", // contexts come first
             "steps 2\naxiom F(1)F\nF(x) : x > 1 -> F(x)\nF(x) -> F(x)F\nF -> F(2)",
             "steps 2\naxiom A[F]\nA [ F -> F[\nA -> F\n] -> F]",
             "steps 2\nlet p = 0\naxiom F\nF -> FF : p\nF -> F : 1-p", // --set p=0.5
             "steps 2\nlet on = 0\naxiom F\nF : on -> FF\nF -> F",
             "steps 2\naxiom A(2)\nA(n) -> FA(n)\ndecompose A(n) : n > 2 -> A(n-1)\n"
             "interpret A(n) -> F",
             "steps 2\naxiom F\nF : random(0, 1) < 0 -> FF\nF -> FG",
             "steps 1\naxiom A\nA -> FB\nB -> FC\nC -> F\ninterpret A -> F\ninterpret C -> F",
             "steps 0\naxiom A\ndecompose A -> FB\ndecompose B -> F",
         })
        EXPECT_THAT(remarks(statements), IsEmpty()) << statements;
}

TEST(LsysIdleProductions, hintsNameModulesThatCanBeDeclared) {
    const auto hint = [](const std::string& letters) {
        SourceMap sources;
        Diagnostics diagnostics;
        static_cast<void>(lower_text("m.lsys", "lsys t {\nsteps 1\naxiom F[" + letters + "]F\n}\n", {},
                                     sources, diagnostics));
        return diagnostics.all().empty() ? std::string() : diagnostics.all().front().hint;
    };
    EXPECT_EQ(hint("DE"), "write 'modules DE' to make one name of them, or 'modules D E' if you mean this");
    EXPECT_EQ(hint("F[DE]"), hint("DE"));
    EXPECT_EQ(hint("end"), "write 'modules e n d' if you mean this"); // a word of the language
    EXPECT_EQ(hint("2D"), "write 'modules 2 D' if you mean this");    // no name
    EXPECT_EQ(hint(std::string(40, 'D') + std::string(40, 'E')), "write 'modules D E' if you mean this");
}

} // namespace
} // namespace graftal
