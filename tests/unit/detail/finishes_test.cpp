// Which finish stands for many.

#include <initializer_list>
#include <optional>

#include <gtest/gtest.h>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/shadow/lit_colours.h"

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
        DetailNode& node = cut.nodes.emplace_back();
        for (const Seen& part : parts) {
            DetailEdge& edge = node.edges.emplace_back();
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

    DetailGraph cut;
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

// Found beside ABOP's Fig. 2.8a: bark looked too bright in what stood for leaves, which scatter more light.
TEST_F(Finishes, ColoursCountByTheLightThatTheyScatter) {
    cut.materials[bark] = {.rgb = {0.8, 0.2, 0}, .diffuse = 0.4};
    cut.materials[leaf] = {.rgb = {0, 0.6, 0.1}, .diffuse = 0.8, .translucency = 0.2};
    const NodeId twig = add({{solid, 1, bark}, {solid, 3, leaf}});
    const NodeId tinted = add({{twig, 1}});
    cut.nodes[tinted].edges.front().tint = PathTint{Rgb(0.3, 0, 0), 0.5};
    const NodeId inheriting = add({{twig, 1}, {solid, 1}});
    set_mean_colours(cut);
    set_finishes(cut);
    set_lit_colours(cut);
    const auto expect = [&](NodeId node, Rgb colour, double open) {
        ASSERT_TRUE(cut.nodes[node].lit);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(cut.nodes[node].lit->fixed[c], colour[c], 1e-9) << node << " " << c;
        EXPECT_NEAR(cut.nodes[node].lit->open, open, 1e-9) << node;
    };
    // A quarter of it scatters 0.4 of its colour, the rest all; the leaf's finish all, too.
    expect(twig, {0.25 * 0.4 * 0.8, 0.25 * 0.4 * 0.2 + 0.75 * 0.6, 0.75 * 0.1}, 0);
    const double scatter = 0.25 * 0.4 + 0.75;
    expect(tinted, {0.3 * scatter + 0.5 * 0.08, 0.5 * 0.47, 0.5 * 0.075}, 0);
    EXPECT_EQ(cut.nodes[inheriting].finish, std::nullopt);
    expect(inheriting, 0.5 * Rgb(0.08, 0.47, 0.075) / Material().diffuse, 0.5);
    EXPECT_NEAR(cut.nodes[twig].mean.fixed.r, 0.2, 1e-9) << "the pigment's mean stays what it was";
}

// Found by reading: no colour of a black fractal changes from sweep to sweep, and its openness was left at
// once.
TEST_F(Finishes, OfBlackCyclesInheritNothing) {
    cut.materials[bark] = {.rgb = {0, 0, 0}};
    const NodeId bough = add({{solid, 1, bark}});
    cut.nodes[bough].edges.push_back({});
    cut.nodes[bough].edges.back().child = bough;
    cut.nodes[bough].edges.back().weight = 1;
    set_mean_colours(cut);
    EXPECT_LT(cut.nodes[bough].mean.open, 1e-6);
}

// Found by a reader of the papers: the crown of a tree without end was a quarter grey, and its trunk brown.
TEST_F(Finishes, OfCyclesThatDrawLittleBesidesThemselvesSettleToo) {
    cut.materials[bark] = {.rgb = {0.3, 0.17, 0.08}};
    const NodeId bough = add({{solid, 1, bark}});
    cut.nodes[bough].edges.push_back({});
    cut.nodes[bough].edges.back().child = bough;
    cut.nodes[bough].edges.back().weight = 500;
    set_mean_colours(cut);
    EXPECT_LT(cut.nodes[bough].mean.open, 1e-3);
    EXPECT_NEAR(cut.nodes[bough].mean.fixed.r, 0.3, 1e-3);
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
