#include "compiler/lsys/parse/parser.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/texts.h"

namespace graftal {
namespace {

using testing::parse;
using testing::ParsedLsys;

/// Trees as text: modules are separated by blanks, parameters are written as they stand in the source.
class Printer {
  public:
    explicit Printer(const SourceMap& sources) : sources_(sources) {}

    std::string of(const std::vector<LsysModule>& modules) const {
        std::string out;
        for (const LsysModule& m : modules) {
            out += fmt::format("{}{}{}", out.empty() ? "" : " ", m.symbol, m.model);
            for (std::size_t i = 0; i < m.parameters.size(); ++i)
                out += fmt::format("{}{}", i == 0 ? "(" : ",", sources_.text(m.parameters[i].span));
            if (!m.parameters.empty()) out += ")";
        }
        return out;
    }
    std::string of(const std::vector<LsysFormal>& modules) const {
        std::string out;
        for (const LsysFormal& m : modules) {
            out += fmt::format("{}{}", out.empty() ? "" : " ", m.symbol);
            for (std::size_t i = 0; i < m.parameters.size(); ++i)
                out += fmt::format("{}{}", i == 0 ? "(" : ",", m.parameters[i].text);
            if (!m.parameters.empty()) out += ")";
        }
        return out;
    }
    std::string of(const LsysProduction& p) const {
        std::string out;
        if (!p.label.text.empty()) out += fmt::format("{}: ", p.label.text);
        if (!p.left.empty()) out += of(p.left) + " < ";
        out += of(std::vector{p.predecessor});
        if (!p.right.empty()) out += " > " + of(p.right);
        if (p.condition) out += fmt::format(" : {}", sources_.text(p.condition->span));
        out += " -> " + (p.successor.modules.empty() ? "*" : of(p.successor.modules));
        if (p.probability) out += fmt::format(" : {}", sources_.text(p.probability->span));
        return out;
    }

  private:
    const SourceMap& sources_;
};

/// The productions of a block with these statements, each on a line, after the axiom.
std::string read(const std::string& statements) {
    ParsedLsys parsed;
    parse("lsys test {\n" + statements + "\n}\n", parsed);
    EXPECT_EQ(parsed.diagnostics.render(parsed.sources), "") << statements;
    if (parsed.file.blocks.size() != 1) return "no block";
    const LsysBlock& block = parsed.file.blocks[0];
    const Printer print(parsed.sources);
    std::string out = block.axiom ? print.of(block.axiom->modules) : "no axiom";
    for (const LsysProduction& p : block.productions)
        out += "\n" + print.of(p);
    for (const LsysProduction& p : block.interpret)
        out += "\ninterpret " + print.of(p);
    for (const LsysProduction& p : block.decompose)
        out += "\ndecompose " + print.of(p);
    return out;
}

std::string read_production(const std::string& text) {
    const std::string out = read("axiom F\n" + text);
    return out.substr(out.find('\n') + 1);
}

std::string read_axiom(const std::string& text) {
    return read("axiom " + text);
}

TEST(LsysParser, plantsOfAbopFigure124) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"axiom: F\nF -> F[+F]F[-F]F", "F\nF -> F [ + F ] F [ - F ] F"},
        {"axiom: F\nF -> F[+F]F[-F][F]", "F\nF -> F [ + F ] F [ - F ] [ F ]"},
        {"axiom: F\nF -> FF-[-F+F+F]+[+F-F-F]", "F\nF -> F F - [ - F + F + F ] + [ + F - F - F ]"},
        {"axiom: X\nX -> F[+X]F[-X]+X\nF -> FF", "X\nX -> F [ + X ] F [ - X ] + X\nF -> F F"},
        {"axiom: X\nX -> F[+X][-X]FX\nF -> FF", "X\nX -> F [ + X ] [ - X ] F X\nF -> F F"},
        {"axiom: X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF",
         "X\nX -> F - [ [ X ] + X ] + F [ + F X ] - X\nF -> F F"},
    };
    for (const auto& [text, tree] : cases)
        EXPECT_EQ(read(text), tree);
}

TEST(LsysParser, strings) {
    EXPECT_EQ(read_axiom("F F\tF"), "F F F");
    EXPECT_EQ(read_axiom("/////'[&FL!A]"), "/ / / / / ' [ & F L ! A ]");
    EXPECT_EQ(read_axiom("[ ^^ { - f + f + f - | - f + f + f } ] # leaf"),
              "[ ^ ^ { - f + f + f - | - f + f + f } ]");
    EXPECT_EQ(read_axiom("[{.}{.}]\\|$%;,\"\\(3)"), "[ { . } { . } ] \\ | $ % ; , \" \\(3)");
    EXPECT_EQ(read_axiom("!(1)F(200) /(45) A"), "!(1) F(200) /(45) A");
    EXPECT_EQ(read_axiom("F(l*0.5, max(w, (1+2)))+(-a)F (2)"), "F(l*0.5,max(w, (1+2))) +(-a) F(2)");
    EXPECT_EQ(read_axiom("F(1, // first\n 2 /* ) */ )//F"), "F(1,2) / / F");
    EXPECT_EQ(read_axiom("F1F0_"), "F 1 F 0 _");
    EXPECT_EQ(read_axiom("@o(2)@cF@Gs@GeF@Gc(3)"), "@o(2) @c F @Gs @Ge F @Gc(3)");
    EXPECT_EQ(read_axiom("~leaf(2, k)~a.b[~a.]~L F"), "~leaf(2,k) ~a.b [ ~a . ] ~L F");
    EXPECT_EQ(read_axiom("F[\n  +F   # a branch\n\n  [ -F\n ] ]F"), "F [ + F [ - F ] ] F");
}

TEST(LsysParser, declaredNamesAreReadBeforeTheirCharacters) {
    EXPECT_EQ(read("axiom BudBuds(1)Bu\nBud -> Leaf[Bud]L\nmodules: Bud, Buds Leaf"),
              "Bud Buds(1) B u\nBud -> Leaf [ Bud ] L");
}

TEST(LsysParser, productions) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"A(l,w) -> !(w)F(l)[&(a0)B(l*r2,w*wr)]/(d)A(l*r1,w*wr)",
         "A(l,w) -> !(w) F(l) [ &(a0) B(l*r2,w*wr) ] /(d) A(l*r1,w*wr)"},
        {"A(l,w) : l > 0.1 -> F(l) : 0.4", "A(l,w) : l > 0.1 -> F(l) : 0.4"},
        {"A(x) : x>-1 && (x<2)-->B(x-1)", "A(x) : x>-1 && (x<2) -> B(x-1)"},
        {"A : * --> B", "A -> B"},
        {"p1 : A(t) : t == 7 -> B", "p1: A(t) : t == 7 -> B"},
        {"p12: F -> F", "p12: F -> F"},
        {"rule_1:F>A:1->F", "rule_1: F > A : 1 -> F"},
        {"p : q -> F", "p : q -> F"},
        {"0 < 0 > 0 -> 0", "0 < 0 > 0 -> 0"},
        {"0 < 1 > 1 -> 1[+F1F1]", "0 < 1 > 1 -> 1 [ + F 1 F 1 ]"},
        {"F0<F>F1 -> F1F1", "F 0 < F > F 1 -> F 1 F 1"},
        {"* < + > * -> -", "+ -> -"},
        {"A(x) B(y) < C(z) > [D(u)]E(v) : x+y<z -> C(x)", "A(x) B(y) < C(z) > [ D(u) ] E(v) : x+y<z -> C(x)"},
        {"A -> *", "A -> *"},
        {"A ->", "A -> *"},
        {"A -> : 1/2", "A -> * : 1/2"},
        {"A -> * : 1/2", "A -> * : 1/2"},
        {"A -> [+A{.].C.}", "A -> [ + A { . ] . C . }"},
        {"A -> .G.[+B{.]A\nB -> B&.G.}", "A -> . G . [ + B { . ] A\nB -> B & . G . }"},
        {"A -> B-C", "A -> B - C"},
        {"A->-F", "A -> - F"},
        {"A-->-F", "A -> - F"},
        {"A -> - -F", "A -> - - F"},
        {"- -> +", "- -> +"},
        {"--->+", "- -> +"},
        {"-(x) --> -(2*x)", "-(x) -> -(2*x)"},
        {"A > B- -> C", "A > B - -> C"},
        {"A > B--> C", "A > B -> C"},
        {"!(w) -> !(w*vr)", "!(w) -> !(w*vr)"},
        {"/(d) -> /(d)/(d)", "/(d) -> /(d) /(d)"},
        {"A ->\n  F[+A]", "A -> F [ + A ]"},
        {"A --> # first a branch\n  # then more\n  F[+A\n  ]", "A -> F [ + A ]"},
        {"A ->\n\nB -> F", "A -> *\nB -> F"},
        {"A ->\nB -> F", "A -> *\nB -> F"},
        {"A(x,\n  y) -> F", "A(x,y) -> F"},
        {"L -> [{.-FG.+FG.\n+FG.}]", "L -> [ { . - F G . + F G . + F G . } ]"},
        {"L -> [{\n.F\n}]\nA -> L", "L -> [ { . F } ]\nA -> L"},
    };
    for (const auto& [text, tree] : cases)
        EXPECT_EQ(read_production(text), tree);
}

TEST(LsysParser, ternaryTree) {
    EXPECT_EQ(read(R"(  let d1 = 94.74, d2 = 132.63, a = 18.95, lr = 1.109, vr = 1.732
  steps 10
  axiom !(1) F(200) /(45) A
  A    -> !(vr) F(50) [ &(a) F(50) A ] /(d1) [ &(a) F(50) A ] /(d2) [ &(a) F(50) A ]
  F(l) -> F(l*lr)
  !(w) -> !(w*vr))"),
              "!(1) F(200) /(45) A\n"
              "A -> !(vr) F(50) [ &(a) F(50) A ] /(d1) [ &(a) F(50) A ] /(d2) [ &(a) F(50) A ]\n"
              "F(l) -> F(l*lr)\n"
              "!(w) -> !(w*vr)");
}

TEST(LsysParser, hilbertCurve) {
    EXPECT_EQ(read("axiom A\n"
                   "A -> B-F+CFC+F-D&F^D-F+&&CFC+F+B//\n"
                   "B -> A&F^CFB^F^D^^-F-D^|F^B|FC^F^A//"),
              "A\n"
              "A -> B - F + C F C + F - D & F ^ D - F + & & C F C + F + B / /\n"
              "B -> A & F ^ C F B ^ F ^ D ^ ^ - F - D ^ | F ^ B | F C ^ F ^ A / /");
}

TEST(LsysParser, sections) {
    EXPECT_EQ(read("axiom A\n"
                   "interpret { A -> F }\n"
                   "homomorphism:\n{\n  B -> {.F.}\n  // no module\n}\n"
                   "interpret C(n) : n > 1 -> F(n)\n"
                   "decompose { I(n) : n > 1 -> I(n-1)F }\n"
                   "decomposition: J -> K\n"
                   "A -> B"),
              "A\nA -> B\ninterpret A -> F\ninterpret B -> { . F . }\ninterpret C(n) : n > 1 -> F(n)\n"
              "decompose I(n) : n > 1 -> I(n-1) F\ndecompose J -> K");
}

TEST(LsysParser, statementsOfAFile) {
    ParsedLsys parsed;
    parse(R"(# lsys comment {
use leaf = "maple.rifs" // lsys comment {
let s = 2
camera { location: 1, 2, 3
         look_at: 0, 0, 0 }
main lsys plant { # the model
  let a = 60 /* degrees
     of arc */
  let b = (a +
    1), c = 3,
      d = 4
  angle: a   // a remark
  step 2  # $
  width: 0.1
  seed 3
  steps infinite
  ignore: + - F ~
  axiom F
}
/* lsys comment { */
material bark { color: 1, 1, 1 }
lsys
other
{
  consider ABC
  steps: 2*3
  axiom '
} lsys third { axiom F }
light { sun: 1, 2, 3 })",
          parsed);
    ASSERT_EQ(parsed.diagnostics.render(parsed.sources), "");
    ASSERT_EQ(parsed.file.blocks.size(), 3u);
    EXPECT_EQ(parsed.file.uses.at(0).name.text, "leaf");
    EXPECT_EQ(parsed.file.statements.size(), 4u);
    const LsysBlock& block = parsed.file.blocks[0];
    EXPECT_EQ(block.name.text, "plant");
    EXPECT_TRUE(block.is_main);
    ASSERT_EQ(block.lets.size(), 2u);
    EXPECT_EQ(block.lets[1].fields.size(), 3u);
    EXPECT_EQ(block.angle->value.text, "a");
    EXPECT_EQ(block.step->value.number, 2);
    EXPECT_EQ(block.width->value.number, 0.1);
    EXPECT_EQ(block.seed->value.number, 3);
    EXPECT_FALSE(block.steps.value().value);
    ASSERT_EQ(block.filter->symbols.size(), 4u);
    EXPECT_FALSE(block.filter->consider);
    EXPECT_EQ(block.filter->symbols[3].text, "~");
    EXPECT_FALSE(parsed.file.blocks[1].is_main);
    EXPECT_TRUE(parsed.file.blocks[1].filter->consider);
    EXPECT_TRUE(parsed.file.blocks[1].steps->value);
    EXPECT_EQ(parsed.file.blocks[1].axiom->modules.size(), 1u);
    EXPECT_EQ(parsed.file.blocks[2].name.text, "third");
}

TEST(LsysParser, spansPointIntoTheFile) {
    ParsedLsys parsed;
    const std::string text = "lsys a {\n axiom F\n p1: A(x) < F(y) : x > y -> ~leaf.b(x*2, y) : 1/2\n}";
    parse(text, parsed);
    ASSERT_EQ(parsed.diagnostics.render(parsed.sources), "");
    const LsysProduction& p = parsed.file.blocks.at(0).productions.at(0);
    const auto source = [&](Span span) { return parsed.sources.text(span); };
    EXPECT_EQ(source(p.span), "p1: A(x) < F(y) : x > y ->");
    EXPECT_EQ(source(p.left.at(0).span), "A(x)");
    EXPECT_EQ(source(p.predecessor.parameters.at(0).span), "y");
    EXPECT_EQ(source(p.condition->span), "x > y");
    EXPECT_EQ(source(p.successor.span), "->");
    EXPECT_EQ(source(p.successor.modules.at(0).span), "~leaf.b(x*2, y)");
    EXPECT_EQ(source(p.successor.modules.at(0).parameters.at(0).span), "x*2");
    EXPECT_EQ(source(p.probability->span), "1/2");
}

} // namespace
} // namespace graftal
