#include "tests/image/render_helpers.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(RenderHelpers, DrawAModelGivenAsText) {
    PovrayReport report;
    const Image image = render_model_text(
        "ball.inst", "object top {\n    union: sphere\n}\ncamera { location 0, 0, 9 look_at 0, 0, 0 }\n",
        measured(40, 30), &report);
    ASSERT_EQ(image.width, 40);
    ASSERT_EQ(image.height, 30);
    EXPECT_EQ(report.leaf_count, 1);
    const auto pixel = [&](int x, int y) { return image.pixels[static_cast<std::size_t>(3 * (y * 40 + x))]; };
    EXPECT_NE(pixel(20, 15), pixel(0, 0)) << "the ball stands out from the background";
}

TEST(RenderHelpers, DrawAModelOfTheProject) {
    EXPECT_EQ(render_model_file("scenes/hart/sierpinski.inst", measured(32, 18)).width, 32);
}

} // namespace
} // namespace graftal
