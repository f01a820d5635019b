// What is culled covers as much of the picture as it did.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/image/drawing.h"
#include "tests/image/silhouette.h"

namespace graftal {
namespace {

/// Covered area of the picture, in pixels, drawn with 16 rays a pixel.
double covered_px(const std::string& path, double error_px) {
    StageOptions options;
    options.view.size = {80, 45};
    options.view.light = DefaultLight::plain;
    options.detail.error_px = error_px;
    const std::optional<CompiledModel> model = compile_file(path, options);
    if (!model) return 0;
    constexpr int magnification = 4;
    const Silhouette silhouette = silhouette_of(*model, magnification);
    return static_cast<double>(std::count(silhouette.hit.begin(), silhouette.hit.end(), true)) /
           (magnification * magnification);
}

// By the ellipsoid in its box each twig covered so much that the elm in the distance grew by a fifth.
TEST(Coverage, OfAnElmFarAway) {
    const double whole = covered_px("scenes/hart/elm.inst", 0);
    EXPECT_NEAR(covered_px("scenes/hart/elm.inst", 2) / whole, 1, 0.02);
    EXPECT_NEAR(covered_px("scenes/hart/elm.inst", 4) / whole, 1, 0.04);
}

TEST(Coverage, OfAPlantBesideWhichNothingStands) {
    const double whole = covered_px("scenes/abop/fig1_25.lsys", 0);
    EXPECT_NEAR(covered_px("scenes/abop/fig1_25.lsys", 4) / whole, 1, 0.04);
}

} // namespace
} // namespace graftal
