// Drawings in layers, which single precision does not tell apart: Context Free's art by its importer.

#include "runtime/gpu/near_layers.h"

#include <gtest/gtest.h>

#include "tests/unit/unfolded/models.h"

namespace graftal {
namespace {

/// Discs of a ten-thousandth's thickness, each so far over the one before and so far beside it.
bool has_near(double over, double beside, double ray_length = 0, double thickness = 1e-4) {
    Graph graph = test::empty_graph();
    const ObjectId disc = graph.primitive(PrimitiveKind::cylinder);
    for (int i = 0; i < 5; ++i)
        test::place(graph, graph.root, disc,
                    Affine::translate({beside * i, 0, over * i}) * Affine::rotate({1, 0, 0}, 90) *
                        Affine::scale({1, thickness, 1}));
    const std::shared_ptr<const PreparedGraph> prepared = test::prepared(graph, {});
    return has_near_layers(drawn_bounds(layered(prepared->cut, prepared->root_steps).cut), ray_length);
}

TEST(NearLayers, AreFoundWhereTheyCoverEachOther) {
    EXPECT_TRUE(has_near(1e-12, 0.5));
    EXPECT_TRUE(has_near(1e-6, 0.5));
    EXPECT_FALSE(has_near(0, 0.5)); // in one plane
    EXPECT_FALSE(has_near(1e-3, 0.5));
    EXPECT_FALSE(has_near(1e-6, 2.1));       // side by side
    EXPECT_FALSE(has_near(1e-6, 0.5, 0, 1)); // solids
}

TEST(NearLayers, LieNearerWhereRaysAreLong) {
    EXPECT_TRUE(has_near(1e-3, 0.5, 1000));
    EXPECT_FALSE(has_near(1e-3, 0.5, 10));
}

} // namespace
} // namespace graftal
