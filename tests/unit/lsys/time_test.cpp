// Productions that read the time, against a derivation in the plainest code there is.

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/lower/plant.h"
#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using testing::CompiledLsys;
using testing::derived;
using testing::Figure;
using ::testing::HasSubstr;
using testing::LsysModel;
using testing::PlainTurtle;
using testing::Stroke;
using testing::Unfolding;

constexpr double width = 0.25;

/// Each module with the step in which it came into being.
class AgedReference {
  public:
    explicit AgedReference(const std::string& statements)
        : model_("width 0.25\n" + statements), grammar_(model_.rewriter().grammar()) {}

    Figure figure(unsigned steps, double share) {
        Word word = instantiate(grammar_.axiom, {}, 0);
        finish(word, 0);
        for (unsigned step = 1; step <= steps; ++step) {
            Word next;
            for (const Module& module : word)
                append(RuleKind::produce, module, step, next);
            word = std::move(next);
            finish(word, step);
        }
        Word drawn;
        for (const Module& module : word)
            interpret(module, steps + share, drawn);
        cut(drawn);
        ModuleTable table;
        ModuleString string;
        for (const Module& module : drawn)
            string.push_back(table.intern(module.symbol, module.parameters));
        Figure figure = PlainTurtle(grammar_, table, width).draw(string);
        figure.modules = word.size();
        return figure;
    }

  private:
    struct Module {
        SymbolId symbol;
        std::vector<double> parameters;
        double birth;
    };
    using Word = std::vector<Module>;

    static Word instantiate(const std::vector<LsysTemplate>& string, const std::vector<double>& slots,
                            double birth) {
        Word word;
        for (const LsysTemplate& module : string) {
            Module& added = word.emplace_back(Module{module.symbol, {}, birth});
            for (const ExpressionCode& code : module.parameters)
                added.parameters.push_back(code.value(slots).value());
        }
        return word;
    }

    /// What the first production that fits gives; nothing: none fits.
    std::optional<Word> rewritten(RuleKind kind, const Module& module, double step, double birth) const {
        for (const std::uint32_t id : grammar_.candidates(kind, module.symbol)) {
            const LsysRule& rule = grammar_.rules[id];
            if (rule.predecessor.arity != module.parameters.size()) continue;
            std::vector<double> slots = module.parameters;
            slots.insert(slots.end(), {step, step - module.birth});
            if (rule.condition && rule.condition->code.value(slots).value() == 0) continue;
            return instantiate(rule.successor, slots, birth);
        }
        return std::nullopt;
    }

    void append(RuleKind kind, const Module& module, double step, Word& word) const {
        const std::optional<Word> successor = rewritten(kind, module, step, step);
        if (!successor) return word.push_back(module);
        word.insert(word.end(), successor->begin(), successor->end());
    }

    void finish(Word& word, double step) const {
        Word decomposed;
        for (const Module& module : word)
            decompose(module, step, decomposed);
        word = std::move(decomposed);
        cut(word);
    }

    void decompose(const Module& module, double step, Word& out) const {
        const std::optional<Word> parts = rewritten(RuleKind::decompose, module, step, step);
        if (!parts) return out.push_back(module);
        for (const Module& part : *parts)
            decompose(part, step, out);
    }

    void interpret(const Module& module, double step, Word& out) const {
        const std::optional<Word> parts = rewritten(RuleKind::interpret, module, step, module.birth);
        if (!parts) return out.push_back(module);
        for (const Module& part : *parts)
            interpret(part, step, out);
    }

    void cut(Word& word) const {
        Word kept;
        std::size_t open = 0; // brackets since the cut
        bool cutting = false;
        for (const Module& module : word) {
            const std::string& symbol = grammar_.symbols[module.symbol];
            if (cutting && symbol == "[") ++open;
            if (cutting && symbol == "]" && open-- == 0) cutting = false;
            if (!cutting) kept.push_back(module);
            if (!cutting && symbol == "%") cutting = true, open = 0;
        }
        word = std::move(kept);
    }

    LsysModel model_;
    const LsysGrammar& grammar_;
};

void expect_same(const Figure& wanted, const CompiledLsys& compiled, const std::string& what) {
    const Unfolding found(compiled.graph);
    ASSERT_EQ(found.strokes.size(), wanted.strokes.size()) << what;
    double worst = 0;
    for (std::size_t i = 0; i < wanted.strokes.size(); ++i)
        worst = std::max({worst, glm::distance(wanted.strokes[i].from, found.strokes[i].from),
                          glm::distance(wanted.strokes[i].to, found.strokes[i].to)});
    EXPECT_LE(worst, 1e-8) << what;
    EXPECT_EQ(compiled.derivation->modules, std::to_string(wanted.modules)) << what;
}

/// At whole steps and between them, composed and derived. The number of models that drew something.
int expect_as_reference(const std::string& statements, unsigned most_steps) {
    AgedReference reference(statements);
    int drawn = 0;
    for (unsigned steps = 0; steps <= most_steps; ++steps)
        for (const double share : {0.0, 0.375}) {
            LowerOptions options;
            options.time = steps + share;
            for (const bool exact : {false, true}) {
                options.exact = exact;
                const std::string what = fmt::format("{}\n{} steps, {} of the next{}", statements, steps,
                                                     share, exact ? ", derived" : "");
                const LsysModel model(statements);
                const bool timed = LsysModel(statements).rewriter().grammar().time(RuleKind::interpret) != 0;
                const Figure wanted = reference.figure(steps, timed ? share : 0);
                if (wanted.strokes.empty()) continue;
                const CompiledLsys compiled("width 0.25\n" + statements, steps, options);
                expect_same(wanted, compiled, what);
                ++drawn;
            }
        }
    return drawn;
}

TEST(LsysTime, productionsReadStepAndAge) {
    EXPECT_EQ(derived("axiom A\nA -> AB(step, age)", 3), "AB(3,1)B(2,1)B(1,1)");
    EXPECT_EQ(derived("axiom AB\nA : step < 3 -> FA\nB : age >= 2 -> G\nB : age == 1 -> C", 4), "FFAC");
    EXPECT_EQ(derived("axiom AL\nA -> LA\nL : age >= 3 -> X", 5), "XXLLLAX");
    EXPECT_EQ(derived("axiom A\nA : step % 2 == 0 -> B\nB : step % 2 == 1 -> AA", 4), "BB");
    EXPECT_EQ(derived("axiom A\nA -> B\ndecompose B -> C(step, age)", 2), "C(1,0)");
    EXPECT_EQ(derived("axiom B\nA -> A\ndecompose B : age >= 2 -> C(step)", 5), "C(2)");
}

TEST(LsysTime, namesOfTheModelHideThem) {
    EXPECT_EQ(derived("let step = 7\naxiom A(2)\nA(age) -> A(age+1)B(step)", 2), "A(4)B(7)B(7)");
    EXPECT_THAT(derived("axiom A(step)\nA -> A", 2), HasSubstr("unknown name 'step'"));
}

TEST(LsysTime, contextsAndChanceSeeIt) {
    EXPECT_EQ(derived("axiom BA\nB < A : age >= 3 -> C(age)", 3), "BC(3)");
    EXPECT_EQ(derived("axiom A\nA -> B : step < 3\nA -> C : step >= 3\nB -> A", 3), "C");
}

TEST(LsysTime, drawingReadsTheAgeOfWhatIsDrawn) {
    const std::string leaves = "axiom A\nA -> F(1)[+(90)L]A\n"
                               "interpret {\nL -> M\nM : age > 0 -> F(age/10)\n}";
    const CompiledLsys compiled("width 0.25\n" + leaves, 3, {.time = 3.5});
    const Unfolding found(compiled.graph);
    ASSERT_EQ(found.strokes.size(), 6u);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(glm::distance(found.strokes[2 * i + 1].from, found.strokes[2 * i + 1].to), (2.5 - i) / 10,
                    1e-12);
    EXPECT_TRUE(compiled.derivation->timed);
    EXPECT_EQ(compiled.derivation->time, 3.5);
}

TEST(LsysTime, composedAndDerivedAreTheReference) {
    const char* const texts[] = {
        "axiom A\nA : step < 4 -> F[+A]A\nA : step >= 4 -> F(0.3)",
        "axiom A\nA -> F[+(50)L]/(137)A\nL : age >= 3 -> %F\ninterpret L : age > 0 -> F(0.3*age)",
        "axiom A\nA -> F[+A]B\nB : age == 2 -> [-F(0.5)A]\ninterpret B -> F(0.1*(age+1))",
        "axiom A(1)\nA(l) -> F(l)[+(30)B(l*0.7)]A(l*0.9)\nB(l) : age > 1 && step % 2 == 0 -> "
        "F(l)[-(20)B(l*0.7)]\n"
        "interpret B(l) -> F(l*smooth(0, 2, age))",
        "axiom A\nA -> CA\ndecompose C -> D[+D]\nD : age >= 2 -> FC\ninterpret D -> F(logistic(age, 1, 2, "
        "2))",
        "axiom A\nA -> FCA\ndecompose C : age >= 2 -> D[+D]\ninterpret {\nD -> F(0.2+0.1*age)\nC -> "
        "F(0.05*age+0.01)\n}",
        "axiom F(1)A\nF(l) : age <= 3 -> F(l*1.2)\nA : step != 2 -> F(0.5)-(step*10)A",
        "axiom AAA\nA -> B\nB : step == 5 -> F\nB : step == 3 -> F(0.5)[+B]\ninterpret B -> F(0.1+0.01*step)",
    };
    for (const char* text : texts)
        EXPECT_GT(expect_as_reference(text, 7), 8) << text;
}

class RandomGrammar {
  public:
    explicit RandomGrammar(unsigned seed) : random_(seed) {}

    std::string text() {
        std::string text = "angle 35\naxiom " + string(3) + "\n";
        for (const char* symbol : {"A", "B", "C"})
            for (unsigned i = 1 + draw(2); i > 0; --i)
                text += fmt::format("{}{} -> {}\n", symbol, condition(), string(symbol[0] == 'A' ? 4 : 3));
        if (draw(2)) text += "decompose B" + condition() + " -> F(0.3)[-C]C\n";
        if (draw(2)) text += "interpret A" + condition() + " -> DF(0.2 + 0.05*age)\n";
        if (draw(2)) text += "interpret C -> +(5*age)F(0.1 + 0.02*step)\n";
        return text + "interpret D : age > 1.2 -> [^F(0.1*age)]\nmodules D\n";
    }

  private:
    unsigned draw(unsigned count) { return static_cast<unsigned>(random_() % count); }

    std::string condition() {
        switch (draw(6)) {
        case 0:
            return fmt::format(" : step < {}", 1 + draw(6));
        case 1:
            return fmt::format(" : age >= {}", 1 + draw(4));
        case 2:
            return fmt::format(" : step % {} == 0", 2 + draw(2));
        case 3:
            return fmt::format(" : age == {} || step > {}", 1 + draw(3), 3 + draw(3));
        default:
            return "";
        }
    }

    std::string string(unsigned length) {
        std::string out;
        for (unsigned i = 0; i < length; ++i)
            switch (draw(7)) {
            case 0:
                out += "[+" + std::string(1, static_cast<char>('A' + draw(3))) + "]";
                break;
            case 1:
                out += "F(0.5)";
                break;
            case 2:
                out += "-(20)F";
                break;
            case 3:
                out += "/(40)";
                break;
            case 4:
                out += draw(4) == 0 ? "[%]" : "&(10)";
                break;
            default:
                out += static_cast<char>('A' + draw(3));
            }
        return out;
    }

    std::mt19937 random_;
};

TEST(LsysTime, randomGrammarsAreTheReference) {
    int drawn = 0;
    for (unsigned seed = 0; seed < 150; ++seed)
        drawn += expect_as_reference(RandomGrammar(seed).text(), 5);
    EXPECT_GT(drawn, 1000);
}

TEST(LsysTime, modelsThatDoNotReadItCostNoMore) {
    const std::string bush = "width 0.25\naxiom A\nA -> F[+A][-A]L\n";
    const auto parts = [&](const std::string& rest) {
        return CompiledLsys(bush + rest, 12).derivation->parts;
    };
    const std::size_t plain = parts("interpret L -> F(0.3)");
    EXPECT_EQ(parts("interpret L : step > 3 -> F(0.3)"), plain);
    EXPECT_LE(parts("interpret L -> F(0.3*age)"), plain + 12);
}

TEST(LsysTime, growthIsContinuous) {
    const std::string stem = "axiom A\nA -> I[+(40)I]A\ninterpret I -> F(smooth(0, 3, age))";
    double before = 0.3;
    for (int i = 11; i <= 60; ++i) {
        const double time = i / 10.0;
        const CompiledLsys compiled("width 0.25\n" + stem, static_cast<unsigned>(time), {.time = time});
        double length = 0;
        for (const Stroke& stroke : Unfolding(compiled.graph).strokes)
            length += glm::distance(stroke.from, stroke.to);
        EXPECT_LE(std::abs(length - before), 0.35) << time;
        before = length;
    }
}

/// Strokes that are there on both sides of a whole step are the same ones.
TEST(LsysTime, chanceKeepsItsChoicesFromStepToStep) {
    const std::string bush =
        "axiom A(1)\nA(l) -> I(l)[&(20)A(l*0.9)]/(170)[&(50)A(l*0.8)]\n"
        "interpret I(l) -> +(normal(0, 30))F(l*smooth(0, 2, age))[/(random(0, 360))+F(age/10)]";
    const CompiledLsys before("width 0.25\n" + bush, 5, {.time = 5.9999999});
    const CompiledLsys after("width 0.25\n" + bush, 6, {.time = 6});
    const auto strokes = [](const CompiledLsys& compiled) {
        std::vector<Stroke> grown;
        for (const Stroke& stroke : Unfolding(compiled.graph).strokes)
            if (glm::distance(stroke.from, stroke.to) > 1e-3) grown.push_back(stroke);
        return grown;
    };
    const std::vector<Stroke> a = strokes(before), b = strokes(after);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.size(), 2u * 31);
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_LE(glm::distance(a[i].to, b[i].to), 1e-5) << i;
}

std::string errors_of(const std::string& text, const LowerOptions& options,
                      const std::string& name = "m.lsys") {
    SourceMap sources;
    Diagnostics diagnostics;
    lower_text(name, text, options, sources, diagnostics);
    return diagnostics.render(sources);
}

TEST(LsysTime, waitingForEverEnds) {
    const std::string text = "lsys m {\nsteps 10000\nwidth 0.1\naxiom A(0)\nA(n) -> FB(n)A(n+1)\n"
                             "B(n) : step == n + 20000 -> F\nmodules B\n}\n";
    EXPECT_THAT(errors_of(text, {}), ::testing::AnyOf("", HasSubstr("the productions of 'B' must handle")));
}

TEST(LsysTime, faults) {
    const std::string tree = "lsys m {\nsteps infinite\naxiom A\nA -> F[+A]\ninterpret A -> F(age)\n}\n";
    EXPECT_THAT(errors_of(tree, {}),
                HasSubstr("m.lsys:2:1: error: productions that read 'step' or 'age' have no limit"));
    EXPECT_EQ(errors_of(tree, {.time = 2.5}), "");
    EXPECT_THAT(errors_of("object a { sphere }", {.time = 2.5}, "a.inst"),
                HasSubstr("only L-systems have times between two steps, such as 2.5"));
    EXPECT_EQ(errors_of("object a { sphere }", {.steps = 2, .time = 2.5}, "a.inst"), "");
    EXPECT_THAT(errors_of("lsys m {\nsteps 3\naxiom A\nA -> FA\ninterpret A -> F(1/(age - 0))\n}", {}),
                HasSubstr("m.lsys:5:18: error: division by zero"));
}

// A module that chance leaves as it is grows older. Derived, with contexts and in order too, and composed.
TEST(LsysTime, ModulesThatStayByChanceKeepTheirAge) {
    const std::string alike(60, 'A');
    std::string different; // enough to be derived module by module
    for (int i = 0; i < 60; ++i)
        different += "A(" + std::to_string(i) + ")";
    const std::pair<std::string, std::string> models[] = {
        {alike, "A -> B : 0.3\ninterpret A -> F"},
        {alike, "A -> B : 0.3\nZ < Y -> Y\ninterpret A -> F"},
        {alike, "variable n = 0\nA : {n = n + 1} * -> B : 0.3\ninterpret A -> F"},
        {alike, "A -> B : 0.3\ndecompose C -> D\ninterpret A -> F"},
        {different, "A(n) -> B : 0.3\ninterpret A(n) -> F"}};
    for (const auto& [axiom, rules] : models)
        for (const bool exact : {false, true}) {
            LowerOptions options;
            options.in_place = LowerOptions::InPlace::plant;
            options.exact = exact;
            options.run_from = 1;
            SourceMap sources;
            Diagnostics diagnostics;
            const std::string text = "lsys a {\nsteps 4\naxiom " + axiom + "\n" + rules + "\n}\n";
            const auto plant = lower_text("m.lsys", text, options, sources, diagnostics).notes.plant;
            ASSERT_TRUE(plant) << diagnostics.render(sources);
            std::size_t stayed = 0;
            double oldest = 0;
            for (const PlantModule& module : plant->modules) {
                const std::string& name = plant->names[module.name];
                if (name == "A") {
                    EXPECT_EQ(module.age, 4) << rules;
                }
                if (name == "B") oldest = std::max(oldest, module.age);
                stayed += name == "A";
            }
            EXPECT_GT(stayed, 4u) << rules;
            EXPECT_LT(stayed, 40u) << rules;
            EXPECT_EQ(oldest, 3) << rules;
        }
}

TEST(LsysTime, AgesAreHandedOnToWhatIsDrawnAsAged) {
    LsysModel model("axiom A\ninterpret {\nA -> B\nB -> [C]\nC : age > 1 -> D\nE -> A\nG -> F\n}");
    const LsysGrammar& grammar = model.rewriter().grammar();
    std::string aged;
    for (std::size_t symbol = 0; symbol < grammar.symbols.size(); ++symbol)
        if (grammar.ages[symbol]) aged += grammar.symbols[symbol];
    std::ranges::sort(aged);
    EXPECT_EQ(aged, "ABCE");
}

} // namespace
} // namespace graftal
