#include "compiler/analysis/counts.h"

#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/analysis/decimal.h"
#include "tests/unit/analysis/systems.h"

namespace graftal {
namespace {

using namespace test;
using boost::multiprecision::cpp_int;
using boost::multiprecision::pow;

std::optional<std::string> count(const Graph& graph, std::optional<unsigned> steps = std::nullopt) {
    return count_leaves(graph, strong_components(graph), steps);
}

std::string power(int base, unsigned exponent, int factor = 1) {
    return to_decimal(factor * pow(cpp_int(base), exponent));
}

TEST(Counts, PoundSignHasEightTimesSevenToTheStepsLessOne) {
    const std::vector<std::string> first = {"8", "56", "392", "2744", "19208", "134456"};
    for (unsigned n = 1; n <= first.size(); ++n)
        EXPECT_EQ(count(pound_sign(3), n), first[n - 1]);
    EXPECT_EQ(count(pound_sign(3), 0), "1");
    EXPECT_EQ(count(pound_sign(3), 40), power(7, 39, 8));
    EXPECT_EQ(count(pound_sign(3), 100), power(7, 99, 8));
    EXPECT_EQ(count(pound_sign(2), 100), power(3, 99, 4));
}

TEST(Counts, UnendingGraphsNeedStepsWithinTheLimit) {
    EXPECT_EQ(count(pound_sign(2)), std::nullopt);
    EXPECT_EQ(count(pound_sign(2), max_counted_steps + 1), std::nullopt);
    EXPECT_EQ(count(pound_sign(2), 4'000'000'000u), std::nullopt);
}

TEST(Counts, AHundredThousandStepsAreExact) {
    EXPECT_EQ(count(pound_sign(3), 100'000), power(7, 99'999, 8));
    EXPECT_EQ(count(menger_digraph(), 100'000), power(20, 100'000));
}

TEST(Counts, FibonacciGrowthWithoutEqualObjectsIsExact) {
    const Affine half = scaled(0.5, Vec3(0.0));
    const Graph graph = digraph(2, {{0, 0, half}, {0, 1, half}, {1, 0, half}});
    EXPECT_EQ(count(graph, 10), "144");
    cpp_int a = 1, b = 1;
    for (int i = 0; i < 5000; ++i) {
        const cpp_int next = a + b;
        b = a;
        a = next;
    }
    EXPECT_EQ(count(graph, 5000), to_decimal(a));
}

/// A tree with a trunk: draws its trunk at every level, and its tip, if given, where it is cut.
Graph trunk_and_two_branches(bool terminal) {
    Graph graph;
    const ObjectId cylinder = graph.primitive(PrimitiveKind::cylinder);
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Object leaf = named("leaf");
    for (int i = 0; i < 3; ++i)
        leaf.instances.push_back(instance(sphere, Affine{}));
    const ObjectId leaf_id = graph.add(std::move(leaf));
    Object tree = named("tree");
    const auto self = static_cast<ObjectId>(graph.objects.size());
    tree.instances = {instance(self, scaled(.5, {0, 1, 0})), instance(cylinder, Affine{}),
                      instance(self, scaled(.4, {0, 1, 0}))};
    if (terminal) tree.terminal = instance(leaf_id, Affine{});
    graph.root = graph.add(std::move(tree));
    return graph;
}

TEST(Counts, CutObjectsDrawTheirTerminalOrElseTheirTrunk) {
    EXPECT_EQ(count(trunk_and_two_branches(false), 0), "1");
    EXPECT_EQ(count(trunk_and_two_branches(false), 3), "15");
    EXPECT_EQ(count(trunk_and_two_branches(true), 0), "3");
    EXPECT_EQ(count(trunk_and_two_branches(true), 3), "31"); // 7 trunks and 8 leaves of 3
}

TEST(Counts, TerminalsMayComeFromLaterComponents) {
    // The terminal is reached by nothing else, and has the larger number.
    Graph graph;
    Object object = named("a");
    object.instances = {instance(0, scaled(.5, Vec3(0.0))), instance(0, scaled(.5, Vec3(1.0)))};
    object.terminal = instance(1, Affine{});
    graph.add(std::move(object));
    Object pair = named("pair");
    pair.instances = {instance(2, Affine{}), instance(2, Affine{})};
    graph.add(std::move(pair));
    graph.primitive(PrimitiveKind::cube);
    EXPECT_EQ(count(graph, 5), "64");
}

TEST(Counts, EndingGraphsIgnoreSteps) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Object twice = named("twice");
    twice.instances = {instance(sphere, Affine{}), instance(sphere, Affine{})};
    graph.root = graph.add(std::move(twice));
    EXPECT_EQ(count(graph), "2");
    EXPECT_EQ(count(graph, 0), "2");
    EXPECT_EQ(count(graph, 4'000'000'000u), "2");
}

Graph doublings(std::size_t size, unsigned times = 2) {
    Graph graph;
    ObjectId below = graph.primitive(PrimitiveKind::sphere);
    for (std::size_t i = 0; i < size; ++i) {
        Object object = named(numbered("d", i));
        for (unsigned t = 0; t < times; ++t)
            object.instances.push_back(instance(below, Affine{}));
        below = graph.add(std::move(object));
    }
    graph.root = below;
    return graph;
}

TEST(Counts, AChainOfAHundredThousandDoublingsIsExact) {
    EXPECT_EQ(count(doublings(100'000)), power(2, 100'000));
}

TEST(Counts, LongNumbersTakeLittleMemoryAtATime) {
    EXPECT_EQ(count(doublings(60'000, 10)), power(10, 60'000));
    EXPECT_EQ(count(ifs(std::vector<Affine>(1000, scaled(.01, Vec3(0.0)))), 50'000), power(10, 150'000));
}

TEST(Counts, WhatTakesTooLongIsGivenUp) {
    // 2000 objects in one cycle, no two alike.
    std::vector<Edge> edges;
    const Affine half = scaled(.5, Vec3(0.0));
    for (ObjectId i = 0; i < 2000; ++i) {
        edges.push_back({i, (i + 1) % 2000, half});
        for (ObjectId k = 0; k < i % 7 + (i == 0); ++k)
            edges.push_back({i, (i * 31 + k) % 2000, half});
    }
    EXPECT_EQ(count(digraph(2000, edges), 100'000), std::nullopt);
}

TEST(Decimal, EqualsTheLibraryAtEveryLength) {
    EXPECT_EQ(to_decimal(0), "0");
    cpp_int number = 1;
    for (int i = 0; i < 400; ++i) {
        EXPECT_EQ(to_decimal(number), number.str());
        number = number * 1'000'003 + i;
    }
    for (const unsigned digits : {511u, 512u, 513u, 1024u, 4096u}) {
        EXPECT_EQ(to_decimal(pow(cpp_int(10), digits)), std::string("1").append(digits, '0'));
        EXPECT_EQ(to_decimal(pow(cpp_int(10), digits) - 1), std::string(digits, '9'));
    }
}

} // namespace
} // namespace graftal
