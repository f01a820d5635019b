#include "compiler/analysis/contraction.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/analysis/systems.h"

namespace graftal {
namespace {

using namespace test;

struct Decided {
    Graph graph;
    Components components;
    Contraction contraction;

    bool holds(const ContractionCertificate& certificate) const {
        return certificate_holds(graph, components, certificate);
    }
};

Decided decide(Graph graph) {
    Components components = strong_components(graph);
    Contraction contraction = decide_contraction(graph, components);
    return {std::move(graph), std::move(components), std::move(contraction)};
}

void expect_proved(const Decided& decided, double rate, double tolerance = 1e-9) {
    const Contraction& c = decided.contraction;
    EXPECT_EQ(c.verdict, Verdict::proved);
    EXPECT_NEAR(c.rate(), rate, tolerance);
    EXPECT_LE(c.lower, c.upper);
    EXPECT_LT(c.upper, 1);
    EXPECT_TRUE(decided.holds(c.certificate));
}

/// The steps must follow each other and come back; their product must have the radius that was stated.
void expect_cycle_gives_lower(const Decided& decided) {
    const std::vector<GraphStep>& cycle = decided.contraction.worst_cycle;
    ASSERT_FALSE(cycle.empty());
    for (std::size_t i = 0; i < cycle.size(); ++i) {
        const Object& object = decided.graph.objects[cycle[i].object];
        ASSERT_LT(cycle[i].instance, object.instances.size());
        EXPECT_EQ(object.instances[cycle[i].instance].master, cycle[(i + 1) % cycle.size()].object);
    }
    // Radius by repeated multiplication: |M^k|^(1/k) tends to it from above.
    Mat3 product(1.0);
    double log_size = 0;
    const int rounds = static_cast<int>(1 + 4000 / cycle.size());
    for (int round = 0; round < rounds; ++round) {
        for (const GraphStep& step : cycle) {
            product = product *
                      decided.graph.objects[step.object].instances[step.instance].parent_from_child.linear;
            const double size = norm(product);
            ASSERT_GT(size, 0);
            product *= 1 / size;
            log_size += std::log(size);
        }
    }
    EXPECT_NEAR(std::exp(log_size / (rounds * static_cast<double>(cycle.size()))), decided.contraction.lower,
                4e-3 * decided.contraction.lower);
}

const Affine shear = linear_map(.5, 2, 0, .5);
const Affine sheared_right = linear_map(.6, 1.5, 0, .6);
const Affine sheared_up = linear_map(.6, 0, 1.5, .6);

TEST(Contraction, EndingGraphsAreAcyclic) {
    Graph graph;
    graph.root = graph.primitive(PrimitiveKind::cube);
    const Decided decided = decide(std::move(graph));
    EXPECT_EQ(decided.contraction.verdict, Verdict::acyclic);
    EXPECT_TRUE(decided.contraction.worst_cycle.empty());
}

TEST(Contraction, SimilaritiesAreExact) {
    for (const int dimension : {2, 3}) {
        const Decided pound = decide(pound_sign(dimension));
        expect_proved(pound, 0.5);
        EXPECT_EQ(pound.contraction.lower, pound.contraction.upper);
        expect_cycle_gives_lower(pound);
    }
    expect_proved(decide(menger_digraph()), 1.0 / 3);
    const Decided dragon = decide(ifs(twin_dragon()));
    expect_proved(dragon, std::sqrt(.5));
    EXPECT_EQ(dragon.contraction.lower, dragon.contraction.upper);
}

TEST(Contraction, AShearContractsThoughItsNormIsOverTwo) {
    const Decided decided = decide(ifs({shear, shear, shear}));
    expect_proved(decided, 0.5);
    EXPECT_LT(decided.contraction.upper, 0.51);
    expect_cycle_gives_lower(decided);
}

TEST(Contraction, OpposedShearsContract) {
    const Decided decided = decide(ifs({linear_map(.7, 1, 0, .7), linear_map(.7, -1, 0, .7)}));
    expect_proved(decided, 0.7);
    EXPECT_LT(decided.contraction.upper, 0.75);
}

TEST(Contraction, EdgesMayExpandWithinContractingCycles) {
    const Decided scales = decide(digraph(2, {{0, 1, scaled(2, Vec3(1.0))}, {1, 0, scaled(.2, Vec3(0.0))}}));
    expect_proved(scales, std::sqrt(.4));
    EXPECT_EQ(scales.contraction.lower, scales.contraction.upper);
    const Affine turned = Affine::rotate({0, 0, 1}, 30) * linear_map(.5, .1, 0, .4);
    const Decided affine =
        decide(digraph(2, {{0, 1, scaled(2, Vec3(1.0))}, {1, 0, scaled(.2, Vec3(0.0))}, {0, 0, turned}}));
    expect_proved(affine, std::sqrt(.4), 1e-6);
    EXPECT_LT(affine.contraction.upper, 0.6425);
}

TEST(Contraction, ACycleThatExpandsByItsOrderIsRefutedAndNamed) {
    const Decided decided = decide(ifs({sheared_right, sheared_up}));
    const Contraction& c = decided.contraction;
    EXPECT_EQ(c.verdict, Verdict::refuted);
    EXPECT_NEAR(c.lower, 1.7105, 1e-4);
    ASSERT_EQ(c.worst_cycle.size(), 2u);
    EXPECT_NE(c.worst_cycle[0].instance, c.worst_cycle[1].instance);
    expect_cycle_gives_lower(decided);
    EXPECT_EQ(describe_cycle(decided.graph, c.worst_cycle), "all -> all -> all");
}

TEST(Contraction, ADigraphThatForbidsTheExpandingOrderContracts) {
    // Each map follows itself; one may be followed by the other, but never the other way round.
    const Decided decided =
        decide(digraph(2, {{0, 0, sheared_right}, {0, 1, sheared_right}, {1, 1, sheared_up}}));
    expect_proved(decided, 0.6);
    EXPECT_LT(decided.contraction.upper, 0.61);
    EXPECT_EQ(decided.contraction.worst_cycle.size(), 1u);
}

TEST(Contraction, TwoCyclesOfWhichOneExpandsAreRefutedByThatOne) {
    const Decided decided = decide(digraph(4, {{0, 1, scaled(.5, Vec3(0.0))},
                                               {1, 0, scaled(.5, Vec3(0.0))},
                                               {1, 2, Affine{}},
                                               {2, 3, scaled(3, Vec3(0.0))},
                                               {3, 2, scaled(.5, Vec3(0.0))}}));
    EXPECT_EQ(decided.contraction.verdict, Verdict::refuted);
    EXPECT_NEAR(decided.contraction.lower, std::sqrt(1.5), 1e-12);
    EXPECT_EQ(describe_cycle(decided.graph, decided.contraction.worst_cycle), "o2 -> o3 -> o2");
}

TEST(Contraction, SelvesThatDoNotShrinkAreRefuted) {
    EXPECT_EQ(decide(ifs({Affine{}})).contraction.verdict, Verdict::refuted);
    EXPECT_EQ(decide(ifs({Affine::rotate({1, 2, 3}, 40)})).contraction.verdict, Verdict::refuted);
    EXPECT_EQ(decide(ifs({Affine::scale({1, .1, .1})})).contraction.verdict, Verdict::refuted);
    EXPECT_EQ(decide(ifs({scaled(.5, Vec3(1.0)), Affine::translate({0, 1, 0})})).contraction.verdict,
              Verdict::refuted);
    // Not by the norm of any one instance: a rotation by way of a detour through another shape.
    const Affine out = linear_map(2, 3, 0, 1), back = inverse(out);
    EXPECT_EQ(decide(digraph(2, {{0, 1, out}, {1, 0, back}})).contraction.verdict, Verdict::refuted);
}

TEST(Contraction, SingularPartsAreFine) {
    Affine onto_line;
    onto_line.linear = Mat3(0.0);
    onto_line.linear[0] = {.5, .5, 0};
    expect_proved(decide(ifs({onto_line, scaled(.3, Vec3(1.0))})), 0.5);
    // Nilpotent: each product of two vanishes, whatever the norms.
    const Decided nilpotent =
        decide(digraph(2, {{0, 1, Affine::scale({5, 0, 0})}, {1, 0, Affine::scale({0, 7, 0})}}));
    EXPECT_EQ(nilpotent.contraction.verdict, Verdict::proved);
    Affine step_down;
    step_down.linear = Mat3(0.0);
    step_down.linear[1][0] = 100; // x takes 100 y; nothing takes x
    EXPECT_EQ(decide(ifs({step_down})).contraction.verdict, Verdict::proved);
    Affine tiny;
    tiny.linear = Mat3(1e-300);
    EXPECT_EQ(decide(ifs({tiny, scaled(1e-200, Vec3(0.0))})).contraction.verdict, Verdict::proved);
    EXPECT_EQ(decide(digraph(2, {{0, 1, tiny}, {1, 0, scaled(1e299, Vec3(0.0))}})).contraction.verdict,
              Verdict::proved);
}

TEST(Contraction, ObjectsMayHaveVeryDifferentUnits) {
    expect_proved(decide(digraph(2, {{0, 1, scaled(1e12, Vec3(0.0))}, {1, 0, scaled(1e-13, Vec3(0.0))}})),
                  std::sqrt(.1));
    const Affine big = Affine::scale({1e100, 1e100, 1e99});
    expect_proved(decide(digraph(2, {{0, 1, big}, {1, 0, scaled(1e-101, Vec3(0.0))}})), std::sqrt(.1));
}

TEST(Contraction, ALongCycleIsDecidedByItsProduct) {
    const Decided turning = decide(long_cycle(100'000, [](std::size_t i) {
        return Affine::rotate({1, 2, static_cast<double>(i)}, 31) * scaled(i == 77 ? .5 : 1, Vec3(1.0));
    }));
    expect_proved(turning, std::pow(.5, 1e-5), 1e-12);
    EXPECT_EQ(turning.contraction.worst_cycle.size(), 100'000u);
    EXPECT_EQ(describe_cycle(turning.graph, turning.contraction.worst_cycle),
              "o0 -> o1 -> o2 -> o3 -> ... (99992 more) -> o99996 -> o99997 -> o99998 -> o99999 -> o0");
    // Up by 2^50000 and down again by a little more: weights far outside the range of doubles.
    expect_proved(
        decide(long_cycle(100'000, [](std::size_t i) { return scaled(i < 50'000 ? 2 : .49, Vec3(1.0)); })),
        std::sqrt(.98), 1e-9);
    EXPECT_EQ(decide(long_cycle(100'000, [](std::size_t) { return Affine{}; })).contraction.verdict,
              Verdict::refuted);
}

TEST(Contraction, ALargeComponentTakesLittleTime) {
    // 30,000 objects, 90,000 affine instances that no unit makes contract one by one.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> entry(-.4, .4);
    std::vector<Edge> edges;
    for (ObjectId i = 0; i < 30'000; ++i) {
        edges.push_back({i, (i + 1) % 30'000, linear_map(.5, 1, 0, .5)});
        for (int k = 0; k < 2; ++k)
            edges.push_back({i, static_cast<ObjectId>(random() % 30'000),
                             linear_map(entry(random), entry(random), entry(random), entry(random))});
    }
    const Decided decided = decide(digraph(30'000, edges));
    EXPECT_LE(decided.contraction.lower, decided.contraction.upper);
}

TEST(Contraction, ManySmallCyclesAreDecidedOneByOne) {
    std::vector<Edge> edges;
    for (ObjectId i = 0; i < 50'000; ++i) {
        edges.push_back({i, i, i == 4711 ? shear : scaled(.25, Vec3(1.0))});
        if (i > 0) edges.push_back({i, i - 1, Affine{}});
    }
    expect_proved(decide(digraph(50'000, edges)), .5, 1e-6);
}

TEST(Contraction, CyclesAreDescribedByName) {
    Graph graph = digraph(14, {});
    EXPECT_EQ(describe_cycle(graph, {}), "");
    EXPECT_EQ(describe_cycle(graph, {{3, 0}}), "o3 -> o3");
    EXPECT_EQ(describe_cycle(graph, {{3, 0}, {5, 1}}), "o3 -> o5 -> o3");
    std::vector<GraphStep> cycle;
    for (ObjectId i = 0; i < 13; ++i)
        cycle.push_back({i, 0});
    EXPECT_EQ(describe_cycle(graph, cycle),
              "o0 -> o1 -> o2 -> o3 -> ... (5 more) -> o9 -> o10 -> o11 -> o12 -> o0");
}

/// Three objects, six instances, entries normally distributed: the research notes' population.
Graph random_system(std::mt19937& random, int dimension, double size) {
    std::normal_distribution<double> normal(0, size);
    std::vector<Edge> edges;
    for (ObjectId e = 0; e < 6; ++e) {
        Affine map;
        map.linear = Mat3(0.0);
        for (int column = 0; column < dimension; ++column)
            for (int row = 0; row < dimension; ++row)
                map.linear[column][row] = normal(random);
        edges.push_back({e % 3, e < 3 ? (e + 1) % 3 : static_cast<ObjectId>(random() % 3), map});
    }
    return digraph(3, edges);
}

TEST(Contraction, RandomSystemsAreDecidedRight) {
    std::mt19937 random(20240501);
    int undecided = 0, refuted = 0, deep = 0;
    for (int i = 0; i < 400; ++i) {
        const int dimension = 2 + i % 2;
        const Decided decided = decide(random_system(random, dimension, dimension == 2 ? .5 : .4));
        const Contraction& c = decided.contraction;
        expect_cycle_gives_lower(decided);
        EXPECT_LE(c.lower, c.upper);
        EXPECT_EQ(c.verdict == Verdict::refuted, c.lower >= 1 - 1e-12);
        EXPECT_EQ(c.verdict == Verdict::proved, decided.holds(c.certificate));
        undecided += c.verdict == Verdict::undecided;
        refuted += c.verdict == Verdict::refuted;
        deep += c.verdict == Verdict::proved && c.certificate.depth > 1;
    }
    EXPECT_LE(undecided, 4);
    EXPECT_GT(refuted, 20);
    EXPECT_GT(deep, 5); // or the certificates of step 3 go untested here
}

TEST(Certificate, DoesNotHoldWhenTamperedWith) {
    std::mt19937 random(7);
    int tried = 0;
    while (tried < 60) {
        const Decided decided = decide(random_system(random, 3, .35));
        const ContractionCertificate& good = decided.contraction.certificate;
        if (decided.contraction.verdict != Verdict::proved) continue;
        ++tried;
        ContractionCertificate bad = good;
        bad.rate = 0.9 * decided.contraction.lower;
        EXPECT_FALSE(decided.holds(bad)) << "a rate below the spectral radius of a cycle";
        bad = good;
        bad.rate = 1;
        EXPECT_FALSE(decided.holds(bad));
        bad = good;
        bad.metric[1] *= 100;
        EXPECT_FALSE(decided.holds(bad));
        bad = good;
        bad.log_weight[2] = NAN;
        EXPECT_FALSE(decided.holds(bad));
        bad = good;
        bad.metric[0][1][1] = 0;
        EXPECT_FALSE(decided.holds(bad));
        bad = good;
        bad.metric.pop_back();
        EXPECT_FALSE(decided.holds(bad));
        EXPECT_FALSE(decided.holds({}));
    }
}

TEST(Certificate, OfOneGraphDoesNotHoldForAGrownOne) {
    Decided decided = decide(ifs({shear, scaled(.3, Vec3(1.0))}));
    ASSERT_TRUE(decided.holds(decided.contraction.certificate));
    decided.graph.objects[0].instances[1].parent_from_child = scaled(.99, Vec3(1.0));
    EXPECT_FALSE(decided.holds(decided.contraction.certificate));
}

} // namespace
} // namespace graftal
