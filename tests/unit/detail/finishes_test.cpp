// Which finish stands for many.

#include <initializer_list>
#include <optional>

#include <gtest/gtest.h>

#include "compiler/detail/cut_graph.h"

namespace graftal {
namespace {

constexpr MaterialId bark = 0, leaf = 1, glass = 2, printed = 3;
constexpr NodeId solid = 0;

class Finishes : public testing::Test {
  protected:
    Finishes() {
        cut.materials.resize(4);
        cut.materials[glass].transparency = 0.9;
        cut.materials[printed].texture = "bark.png";
        cut.nodes.emplace_back().primitive = PrimitiveKind::sphere;
    }

    struct Seen {
        NodeId child;
        double weight;
        std::optional<MaterialId> material = {};
    };

    NodeId add(std::initializer_list<Seen> parts) {
        CutNode& node = cut.nodes.emplace_back();
        for (const Seen& part : parts) {
            CutEdge& edge = node.edges.emplace_back();
            edge.child = part.child;
            edge.weight = part.weight;
            edge.material = part.material;
        }
        return static_cast<NodeId>(cut.nodes.size() - 1);
    }

    std::optional<MaterialId> finish(NodeId node) {
        set_finishes(cut);
        return cut.nodes[node].finish;
    }

    CutGraph cut;
};

TEST_F(Finishes, AreOfTheMaterialThatIsSeenMost) {
    const NodeId twig = add({{solid, 1, bark}, {solid, 3, leaf}});
    EXPECT_EQ(finish(twig), leaf);
    EXPECT_EQ(finish(add({{twig, 1}, {solid, 1, bark}})), bark); // 5 of 8
}

TEST_F(Finishes, OfWhatMostlyInheritsAreNone) {
    EXPECT_EQ(finish(add({{solid, 2}, {solid, 1, leaf}})), std::nullopt);
    const NodeId plain = add({{solid, 1}});
    EXPECT_EQ(finish(add({{plain, 1, leaf}})), leaf);
}

TEST_F(Finishes, OfCyclesAreThoseOfTheLimit) {
    // Two thirds of a bough are the bough again, of which a third is bark and two thirds are leaf in the end.
    const NodeId bough = add({{solid, 1, bark}, {solid, 2, leaf}});
    cut.nodes[bough].edges.push_back({});
    cut.nodes[bough].edges.back().child = bough;
    cut.nodes[bough].edges.back().weight = 6;
    EXPECT_EQ(finish(bough), leaf);
}

TEST_F(Finishes, ArePlainForGlassAndPictures) {
    EXPECT_EQ(finish(add({{solid, 2, glass}, {solid, 1, leaf}})), std::nullopt);
    EXPECT_EQ(finish(add({{solid, 2, printed}, {solid, 1, leaf}})), std::nullopt);
}

} // namespace
} // namespace graftal
