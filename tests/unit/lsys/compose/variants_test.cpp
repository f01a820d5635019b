// Pools of variants against honest derivations: counts and heights have the same means and variances.

#include "compiler/lsys/compose/variants.h"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using testing::CompiledLsys;
using testing::Figure;
using testing::LsysModel;
using testing::PlainTurtle;
using testing::Unfolding;

constexpr int honest_trees = 10'000;
constexpr int pooled_trees = 1500;
/// Of a normal variate: exceeded by chance once in 2000 times on either side, and the seeds are fixed.
constexpr double most_deviations = 3.5;

struct Moments {
    void add(double x) {
        ++count;
        for (int k = 0; k < 4; ++k)
            sums[k] += std::pow(x, k + 1);
    }
    double mean() const { return sums[0] / count; }
    double variance() const { return (sums[1] / count - mean() * mean()) * count / (count - 1); }
    /// Of the estimate of the variance.
    double variance_of_variance() const {
        const double m = mean();
        const double fourth =
            sums[3] / count - 4 * m * sums[2] / count + 6 * m * m * sums[1] / count - 3 * m * m * m * m;
        return (fourth - variance() * variance()) / count;
    }

    double count = 0;
    double sums[4] = {};
};

void expect_alike(const Moments& honest, const Moments& pooled, const std::string& what) {
    const double z_mean = (honest.mean() - pooled.mean()) /
                          std::sqrt(honest.variance() / honest.count + pooled.variance() / pooled.count);
    const double z_variance = (honest.variance() - pooled.variance()) /
                              std::sqrt(honest.variance_of_variance() + pooled.variance_of_variance());
    EXPECT_LE(std::abs(z_mean), most_deviations) << what;
    EXPECT_LE(std::abs(z_variance), most_deviations) << what;
    std::printf("%-24s mean %.4g and %.4g (z %.2f), variance %.4g and %.4g (z %.2f)\n", what.c_str(),
                honest.mean(), pooled.mean(), z_mean, honest.variance(), pooled.variance(), z_variance);
}

double height(const std::vector<testing::Stroke>& strokes) {
    double top = 0;
    for (const testing::Stroke& stroke : strokes)
        top = std::max(top, stroke.to.y);
    return top;
}

void compare(const std::string& name, const std::string& statements, unsigned steps) {
    Moments honest_segments, honest_height, pooled_segments, pooled_height;
    LsysModel model(statements);
    for (int seed = 1; seed <= honest_trees; ++seed) {
        const auto word = model.derive(steps, static_cast<std::uint64_t>(seed));
        ASSERT_TRUE(word) << model.errors();
        const Figure figure =
            PlainTurtle(model.rewriter().grammar(), model.rewriter().modules(), 1).draw(*word);
        honest_segments.add(static_cast<double>(figure.strokes.size()));
        honest_height.add(height(figure.strokes));
    }
    std::uint32_t variants = 0;
    for (int seed = 1; seed <= pooled_trees; ++seed) {
        LowerOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        const CompiledLsys compiled(statements, steps, options);
        pooled_segments.add(std::stod(compiled.derivation->segments));
        pooled_height.add(height(Unfolding(compiled.graph).strokes));
        variants = compiled.derivation->variants;
        EXPECT_LE(compiled.derivation->drift, 0.051);
    }
    EXPECT_GT(variants, 8u);
    expect_alike(honest_segments, pooled_segments, name + " segments");
    expect_alike(honest_height, pooled_height, name + " height");
}

TEST(LsysVariants, stochasticPlantOfTheBook) {
    compare("fig. 1.27",
            "angle 30\nwidth 1\naxiom F\nF -> F[+F]F[-F]F : .33\nF -> F[+F]F : .33\nF -> F[-F]F : .34", 4);
}

TEST(LsysVariants, parametersAndUnequalChances) {
    compare("parametric",
            "width 1\naxiom A(4)\nA(l) : l > 1 -> F(l)[+(30)A(l*0.7)][-(40)A(l*0.6)] : 0.6\n"
            "A(l) : l > 1 -> F(l/2)A(l*0.9) : 0.3\nA(l) : l > 1 -> F(l) : 0.1",
            8);
}

TEST(LsysVariants, eachChildIsUsedEquallyOften) {
    for (const std::uint32_t count : {1u, 2u, 16u, 128u, 4096u}) {
        const Variants variants(7, count);
        for (std::size_t place = 0; place < 5; ++place) {
            std::set<std::uint32_t> used;
            for (std::uint32_t i = 0; i < count; ++i)
                used.insert(variants.child(i, 3, 9, place));
            EXPECT_EQ(used.size(), count);
        }
    }
}

TEST(LsysVariants, alternativesAreDealtOutInProportion) {
    const Variants variants(11, 1024);
    std::vector<Alternative> alternatives = {
        {{nullptr, 0.5}, {0}}, {{nullptr, 0.375}, {1}}, {{nullptr, 0.125}, {2}}};
    share_draws(alternatives, 1);
    for (ModuleId module = 0; module < 20; ++module) {
        std::map<ModuleId, int> seen;
        for (std::uint32_t i = 0; i < 1024; ++i)
            ++seen[variants.choose(alternatives, i, module, 4).entrant->successor[0]];
        EXPECT_NEAR(seen[0], 512, 1);
        EXPECT_NEAR(seen[1], 384, 1);
        EXPECT_NEAR(seen[2], 128, 1);
    }
}

} // namespace
} // namespace graftal
