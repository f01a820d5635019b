// Random numbers in successors: they have the distribution that is asked for, in every way of compiling.

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using testing::CompiledLsys;
using testing::derived;
using ::testing::HasSubstr;
using testing::LsysModel;
using testing::Stroke;
using testing::Unfolding;

/// Of a normal distribution cut off at three deviations, in units of its variance.
const double cut_variance = 1 - 2 * 3 * std::exp(-4.5) / std::sqrt(2 * M_PI) / std::erf(3 / std::sqrt(2.0));

struct Sample {
    void add(double x) {
        values.push_back(x);
        sum += x;
        squares += x * x;
    }
    double mean() const { return sum / static_cast<double>(values.size()); }
    double variance() const { return squares / static_cast<double>(values.size()) - mean() * mean(); }
    double least() const { return *std::ranges::min_element(values); }
    double most() const { return *std::ranges::max_element(values); }

    std::vector<double> values;
    double sum = 0, squares = 0;
};

TEST(LsysChance, thePoolHasTheDistribution) {
    LsysModel model("axiom A\nA -> B(normal(10, 2), random(3, 5), normal(0, 1))");
    const ModuleId a = model.rewriter().axiom()->front();
    const Alternative& alternative = model.rewriter().alternatives(RuleKind::produce, a, {})->front();
    Sample normal, uniform, other;
    double product = 0;
    for (std::uint32_t set = 0; set < draw_sets; ++set) {
        const ModuleString* string = model.rewriter().successor(alternative, a, {}, {.set = set});
        const auto parameters = model.rewriter().modules().parameters(string->front());
        normal.add(parameters[0]);
        uniform.add(parameters[1]);
        other.add(parameters[2]);
        product += (parameters[0] - 10) / 2 * parameters[2] / draw_sets;
    }
    EXPECT_NEAR(normal.mean(), 10, 0.03);
    EXPECT_NEAR(normal.variance(), 4 * cut_variance, 0.15);
    EXPECT_GE(normal.least(), 4);
    EXPECT_LE(normal.most(), 16);
    EXPECT_NEAR(uniform.mean(), 4, 0.01);
    EXPECT_NEAR(uniform.variance(), 1.0 / 3, 0.01);
    EXPECT_NEAR(other.mean(), 0, 0.03);
    EXPECT_NEAR(product, 0, 0.4); // the calls have nothing to do with each other
}

/// Leaves of random lengths on a stem, by either way of compiling.
Sample leaves(const std::string& statements, unsigned steps, const LowerOptions& options) {
    const CompiledLsys compiled("width 0.1\n" + statements, steps, options);
    Sample sample;
    for (const Stroke& stroke : Unfolding(compiled.graph).strokes)
        sample.add(glm::distance(stroke.from, stroke.to));
    return sample;
}

/// Kolmogorov's distance of a sample from the normal distribution that is cut at three deviations.
double farthest_from_cut_normal(const std::set<double>& sample, double mean, double deviation) {
    const auto below = [&](double x) { return 0.5 * std::erfc((mean - x) / (deviation * std::sqrt(2.0))); };
    const double first = below(mean - 3 * deviation), within = 1 - 2 * first;
    double farthest = 0, rank = 0;
    for (const double x : sample) {
        const double expected = (below(x) - first) / within, size = static_cast<double>(sample.size());
        farthest =
            std::max({farthest, std::abs(expected - rank / size), std::abs(expected - (rank + 1) / size)});
        ++rank;
    }
    return farthest;
}

TEST(LsysChance, everyWayOfCompilingDealsItOut) {
    const char* const texts[] = {
        "axiom A\nA -> f[+L]A\ninterpret L -> F(normal(2, 0.3))",
        "axiom A\nA -> f[+L]A\nL -> F(normal(2, 0.3))",
        "axiom A\nA -> f[+L]A\ndecompose L -> F(normal(2, 0.3))",
        "axiom A\nA -> f[+F(normal(2, 0.3))]A",
        "axiom BA\nB < A -> f[+L]BA\ninterpret L -> F(normal(2, 0.3))",
        "axiom A\nA -> f[+L]A\nL -> F(normal(2, 0.3)) : 0.5\nL -> F(normal(2, 0.3)) : 0.5",
    };
    for (const char* text : texts)
        for (const bool exact : {false, true})
            for (const std::uint64_t seed : {1, 2}) {
                const Sample sample = leaves(text, 1000, {.seed = seed, .exact = exact});
                EXPECT_GE(sample.values.size(), 999u) << text;
                EXPECT_NEAR(sample.mean(), 2, 0.04) << text << exact;
                EXPECT_NEAR(std::sqrt(sample.variance()), 0.3 * std::sqrt(cut_variance), 0.03)
                    << text << exact;
                const std::set<double> different(sample.values.begin(), sample.values.end());
                EXPECT_GT(different.size(), 50u) << text << exact;
                if (!exact) continue;
                EXPECT_EQ(different.size(), sample.values.size()) << text;
                EXPECT_GT(*different.begin(), 2 - 3 * 0.3) << text;
                EXPECT_LT(*different.begin(), 2 - 2.2 * 0.3) << text;
                EXPECT_LT(*different.rbegin(), 2 + 3 * 0.3) << text;
                EXPECT_GT(*different.rbegin(), 2 + 2.2 * 0.3) << text;
                EXPECT_LT(farthest_from_cut_normal(different, 2, 0.3), 1.63 / std::sqrt(1000.0)) << text;
            }
}

TEST(LsysChance, whatIsOnlyDrawnCostsOnePool) {
    const CompiledLsys compiled("width 0.1\naxiom A\nA -> f[+L][-A]A\ninterpret L -> F(normal(2, 0.3))", 30);
    EXPECT_LE(compiled.derivation->parts, (30 + 1) * draw_sets + draw_sets);
    EXPECT_EQ(compiled.derivation->segments, "1073741823");
}

TEST(LsysChance, theSeedDecides) {
    const std::string text =
        "axiom A\nA -> F(random(1, 2))[+A]/(random(0, 360))A\ninterpret A -> F(normal(1, 0.1))";
    for (const bool exact : {false, true}) {
        const auto printed = [&](std::uint64_t seed) {
            return print(CompiledLsys(text, 4, {.seed = seed, .exact = exact}).graph);
        };
        EXPECT_EQ(printed(1), printed(1));
        EXPECT_NE(printed(1), printed(2));
    }
}

TEST(LsysChance, variantsAreJudgedByThoseThereIsRoomFor) {
    LowerOptions options;
    options.max_objects = 50'000;
    const CompiledLsys compiled("angle 25\nwidth 0.1\naxiom A\n"
                                "A -> F[$+(normal(30, 8))A][$-(normal(30, 8))A]/(137)A",
                                9, options);
    EXPECT_GE(compiled.derivation->variants, draw_sets);
    EXPECT_LE(compiled.derivation->parts, options.max_objects);
    EXPECT_EQ(compiled.derivation->segments, std::to_string((19683 - 1) / 2));
}

TEST(LsysChance, parametersAreArguments) {
    const Sample sample =
        leaves("axiom A(1)\nA(n) : n <= 64 -> [+L(n)]A(n+1)\nL(n) -> F(random(n, n + 1))", 65, {});
    ASSERT_EQ(sample.values.size(), 64u);
    for (std::size_t i = 0; i < 64; ++i) {
        EXPECT_GE(sample.values[i], 1.0 + static_cast<double>(i));
        EXPECT_LE(sample.values[i], 2.0 + static_cast<double>(i));
    }
    EXPECT_EQ(derived("axiom A\nA -> B(normal(3, 0), random(4, 4))", 1), "B(3,4)");
}

TEST(LsysChance, faults) {
    const struct {
        const char* statements;
        const char* error;
    } cases[] = {
        {"axiom A\nA -> B : random(0, 1)", "'random' draws random numbers"},
        {"axiom A(normal(0, 1))\nA(x) -> F", "'normal' draws random numbers"},
        {"let x = normal(0, 1)\naxiom F", "'normal' draws random numbers"},
        {"axiom A\nA -> F(normal(1))", "'normal' takes 2 arguments, not 1"},
        {"axiom A(1)\nA(x) -> F(normal(1, -x))", "3:21: error: a deviation must not be negative, but is -1"},
        {"axiom A(1)\nA(x) -> F(1 + random(0, 1/(x-1)))", "division by zero"},
        {"axiom A(1)\nA(x) -> F(random(-1e308, 1e308)*10)", "is not a finite number"},
    };
    for (const auto& [statements, error] : cases)
        for (const char* kind : {"", "context"}) {
            std::string text = statements;
            if (*kind) text += "\nB < C -> D\nmodules C D B";
            const std::string found = derived(text, 1);
            EXPECT_THAT(found, HasSubstr(error)) << text;
        }
    for (const char* text :
         {"axiom A(1)\nA(x) -> F(normal(1, -x))", "axiom A(1)\ninterpret A(x) -> F(normal(1, -x))"}) {
        try {
            CompiledLsys(text, 2);
            FAIL() << text;
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), HasSubstr("a deviation must not be negative"));
        }
    }
}

TEST(LsysChance, infinitelyManyStepsHaveNone) {
    SourceMap sources;
    Diagnostics diagnostics;
    lower_text("m.lsys", "lsys m {\nsteps infinite\naxiom A\nA -> F(random(1, 2))A\n}\n", {}, sources,
               diagnostics);
    EXPECT_THAT(diagnostics.render(sources), HasSubstr("productions with random numbers have no limit"));
}

TEST(LsysChance, exploding_parts_are_explained) {
    SourceMap sources;
    Diagnostics diagnostics;
    lower_text(
        "m.lsys",
        "lsys m {\nsteps 20\naxiom A(1)\nA(l) -> F(l)[+A(l*normal(0.8, 0.1))]A(l*normal(0.8, 0.1))\n}\n",
        {.max_objects = 3000}, sources, diagnostics);
    EXPECT_THAT(diagnostics.render(sources), HasSubstr("draw them in 'interpret'"));
}

} // namespace
} // namespace graftal
