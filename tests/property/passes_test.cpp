// Laws that hold for every pass and any graph.

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/passes/merge_equivalent.h"
#include "tests/property/meaning.h"
#include "tests/property/random_graph.h"

namespace graftal::testing {
namespace {

constexpr std::uint64_t graph_count = 1000;

TEST(RandomGraph, IsAlwaysValidAndVariesEnough) {
    int cyclic = 0, of_many = 0, terminals = 0, tinted = 0, unreachable = 0;
    for (std::uint64_t seed = 0; seed < graph_count; ++seed) {
        Choices choices(seed);
        const Graph graph = random_graph(choices, {.cycles = seed % 3 != 0});
        const std::vector<Flaw> flaws = verify(graph);
        ASSERT_TRUE(flaws.empty()) << "seed " << seed << ": " << flaws.front().message << "\n"
                                   << print(graph);
        const Components components = strong_components(graph);
        cyclic += components.unending[graph.root];
        bool many = false, terminal = false, tint = false;
        for (const auto& members : components.members)
            many = many || members.size() > 1;
        for (const Object& object : graph.objects) {
            terminal = terminal || object.terminal;
            for (const Instance& instance : object.instances)
                tint = tint || instance.tint.alpha > 0;
        }
        of_many += many;
        terminals += terminal;
        tinted += tint;
        unreachable += drop_unreachable(graph).graph.objects.size() < graph.objects.size();
    }
    for (const int count : {cyclic, of_many, terminals, tinted, unreachable})
        EXPECT_GT(count, static_cast<int>(graph_count) / 5);
}

TEST(Passes, KeepWhatAGraphUnfoldsTo) {
    unsigned depths = 0, merged = 0;
    for (std::uint64_t seed = 0; seed < graph_count; ++seed) {
        Choices choices(seed);
        const Graph graph =
            random_graph(choices, {.cycles = seed % 3 != 0, .settings = false, .runs = seed % 4 == 0});
        const LawCheck check = check_laws(model_passes(), {graph, {}}, 5, 1000);
        ASSERT_EQ(check.violation, "") << "seed " << seed << "\n" << print(graph);
        depths += check.depths_compared;
        const Graph reachable = drop_unreachable(graph).graph;
        merged += merge_equivalent(reachable).graph.objects.size() < reachable.objects.size();
    }
    EXPECT_GT(depths, 5 * graph_count) << "too few comparisons to trust the law";
    EXPECT_GT(merged, graph_count / 4) << "too few graphs in which something merged";
}

TEST(Passes, ForDetailKeepWhatAGraphUnfoldsToAndWhereItsObjectsAre) {
    unsigned depths = 0, moved = 0, parts = 0;
    for (std::uint64_t seed = 0; seed < graph_count; ++seed) {
        Choices choices(seed);
        const Graph graph = random_graph(choices, {.cycles = seed % 5 != 0,
                                                   .duplicates = false,
                                                   .settings = false,
                                                   .runs = seed % 4 == 0,
                                                   .exact = true,
                                                   .mirrored = true});
        const Components components = strong_components(graph);
        const Contraction contraction = decide_contraction(graph, components);
        ASSERT_TRUE(contraction.verdict == Verdict::proved || contraction.verdict == Verdict::acyclic);
        const LawCheck check =
            check_laws(detail_passes(), {graph, bound_objects(graph, components, contraction)}, 4, 1000);
        ASSERT_EQ(check.violation, "") << "seed " << seed << "\n" << print(graph);
        depths += check.depths_compared;
        moved += check.moved;
        parts += check.parts;
    }
    EXPECT_GT(depths, 8 * graph_count) << "too few comparisons to trust the law";
    EXPECT_GT(moved, graph_count / 5);
    EXPECT_GT(parts, graph_count / 4);
}

TEST(MergeEquivalent, UndoesPlantedDuplicates) {
    unsigned cyclic = 0;
    for (std::uint64_t seed = 0; seed < graph_count; ++seed) {
        Choices choices(seed);
        const Graph plain = merge_equivalent(random_graph(choices, {.duplicates = false})).graph;
        Graph planted = plain;
        plant_duplicates(planted, choices);
        ASSERT_GT(planted.objects.size(), plain.objects.size());
        const Graph merged = merge_equivalent(planted).graph;
        ASSERT_EQ(merged.objects.size(), plain.objects.size()) << "seed " << seed << "\n" << print(planted);
        EXPECT_TRUE(equal(merged, plain)) << "seed " << seed << ": the first of the equals keeps its name";
        cyclic += strong_components(plain).any_cycle();
    }
    EXPECT_GT(cyclic, graph_count / 3);
}

TEST(MergeEquivalent, TheOrderOfObjectsDoesNotMatter) {
    for (std::uint64_t seed = 0; seed < graph_count; ++seed) {
        Choices choices(seed);
        const Graph graph = random_graph(choices, {.settings = false});
        const Graph other = permuted(graph, choices);
        ASSERT_TRUE(equal(graph, other));
        const Graph merged = merge_equivalent(graph).graph, other_merged = merge_equivalent(other).graph;
        ASSERT_EQ(merged.objects.size(), other_merged.objects.size()) << "seed " << seed;
    }
}

/// Objects that differ only in the objects that they lead to, so that only refinement tells them apart.
Graph uniform_graph(Choices& choices) {
    Graph graph;
    const ObjectId ends[] = {graph.primitive(PrimitiveKind::sphere), graph.primitive(PrimitiveKind::cube)};
    const std::uint32_t count = 2 + choices.below(60);
    const std::uint32_t degree = 1 + choices.below(3);
    for (std::uint32_t i = 0; i < count; ++i) {
        Object object;
        object.name = "o" + std::to_string(i);
        for (std::uint32_t k = 0; k < degree; ++k) {
            Instance instance;
            const bool ending = choices.one_in(12);
            instance.master = ending ? ends[choices.below(2)] : 2 + choices.below(count);
            instance.tint.alpha = k == 2 ? 1 : 0;
            object.instances.push_back(instance);
        }
        graph.add(std::move(object));
    }
    graph.root = 2;
    return graph;
}

/// The number of classes of a uniform graph by definition: split by what the instances lead to until nothing
/// splits.
std::size_t class_count(const Graph& graph) {
    using Signature = std::pair<int, std::vector<std::pair<double, std::size_t>>>;
    std::vector<std::size_t> class_of(graph.objects.size(), 0);
    for (std::size_t count = 0;;) {
        std::map<Signature, std::size_t> classes;
        std::vector<std::size_t> next;
        for (const Object& object : graph.objects) {
            Signature signature{object.primitive ? 1 + static_cast<int>(object.primitive->kind()) * 256 +
                                                       object.primitive->steps()
                                                 : 0,
                                {}};
            for (const Instance& instance : object.instances)
                signature.second.emplace_back(instance.tint.alpha, class_of[instance.master]);
            std::sort(signature.second.begin(), signature.second.end());
            next.push_back(classes.emplace(std::move(signature), classes.size()).first->second);
        }
        class_of = std::move(next);
        if (classes.size() == count) return count;
        count = classes.size();
    }
}

TEST(MergeEquivalent, IsTheCoarsestPartition) {
    unsigned merged = 0;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        Choices choices(seed);
        Graph graph = uniform_graph(choices);
        if (choices.one_in(2)) plant_duplicates(graph, choices);
        const std::size_t expected = class_count(graph);
        ASSERT_EQ(merge_equivalent(graph).graph.objects.size(), expected) << "seed " << seed << "\n"
                                                                          << print(graph);
        merged += expected < graph.objects.size();
    }
    EXPECT_GT(merged, 1500u);
}

} // namespace
} // namespace graftal::testing
