#include "compiler/detail/mesh/facet_set.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

constexpr std::uint32_t none = Facet::no_corner;

/// The unit square at a height, seen from above or from below.
Facet square(FacetSet& set, double height, bool from_above, std::uint32_t leaf) {
    const std::uint32_t a = set.vertex({0, 0, height}), b = set.vertex({1, 0, height}),
                        c = set.vertex({1, 1, height}), d = set.vertex({0, 1, height});
    Facet facet{.corners = {a, b, c, d}, .leaf = leaf, .solid = true};
    if (!from_above) facet.corners = {c, b, a, d};
    return facet;
}

TEST(FacetSet, PointsThatAreNearlyEqualAreOneVertex) {
    FacetSet set;
    const std::uint32_t a = set.vertex({0.1, -0.2, 0.3});
    EXPECT_EQ(set.vertex({0.1 + 1e-9, -0.2, 0.3 - 1e-9}), a);
    EXPECT_NE(set.vertex({0.1 + 1e-6, -0.2, 0.3}), a);
    EXPECT_EQ(set.vertices().size(), 2u);
}

TEST(FacetSet, BodiesBackToBackHideWhatTheyShare) {
    FacetSet set;
    set.add(square(set, 0, true, 0));
    set.add(square(set, 0, true, 1)); // the same once more
    EXPECT_EQ(set.triangle_count(), 2u);
    set.add(square(set, 0, false, 2));
    EXPECT_EQ(set.triangle_count(), 0u);
    ASSERT_EQ(set.facets().size(), 1u);
    EXPECT_TRUE(set.facets()[0].hidden);
}

// A cube thinner than what is welded: its front and its back have the same corners.
TEST(FacetSet, FacesOfOneBodyDoNotHideEachOther) {
    FacetSet set;
    set.add(square(set, 0, true, 0));
    set.add(square(set, 0, false, 0));
    EXPECT_EQ(set.triangle_count(), 2u);
    EXPECT_FALSE(set.facets()[0].hidden);
}

TEST(FacetSet, SheetsHideNothing) {
    FacetSet set;
    Facet sheet = square(set, 0, true, 0);
    sheet.solid = false;
    set.add(sheet);
    set.add(square(set, 0, false, 1));
    EXPECT_EQ(set.triangle_count(), 2u);
}

TEST(FacetSet, FlatFacetsAreNone) {
    FacetSet set;
    const std::uint32_t a = set.vertex({0, 0, 0}), b = set.vertex({1, 0, 0});
    set.add({.corners = {a, b, b, a}});
    set.add({.corners = {a, b, a, none}});
    EXPECT_TRUE(set.facets().empty());
}

TEST(FacetSet, MovingMeetsWhatIsThereAndKeepsTheOrder) {
    FacetSet part, all;
    part.add(square(part, 0, true, 0));
    part.add(square(part, 1, true, 1));
    part.add(square(part, 2, true, 2));
    part.add(square(part, 2, false, 3));
    part.move_to(all);
    EXPECT_TRUE(part.facets().empty());
    EXPECT_TRUE(part.vertices().empty());
    EXPECT_EQ(part.triangle_count(), 0u);
    ASSERT_EQ(all.facets().size(), 2u) << "the hidden one stays behind";
    EXPECT_EQ(all.facets()[1].leaf, 1u);
    EXPECT_EQ(all.vertices().size(), 8u);
    part.add(square(part, 1, false, 4));
    part.move_to(all);
    EXPECT_FALSE(all.facets()[0].hidden);
    EXPECT_TRUE(all.facets()[1].hidden);
    EXPECT_EQ(all.triangle_count(), 2u);
}

TEST(FacetSet, ManyVerticesKeepTheirNumbers) {
    FacetSet set;
    for (int round = 0; round < 2; ++round)
        for (std::uint32_t i = 0; i < 20'000; ++i)
            ASSERT_EQ(set.vertex({i % 32 / 16.0, i / 32 % 32 / 16.0, i / 1024 / 16.0}), i);
}

} // namespace
} // namespace graftal
