// Deep zooms: a self-similar place looks the same at every period, to the last pixel; and a zoom that doubles
// can still hold is what moving the camera gives.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/image/drawing.h"

namespace graftal {
namespace {

CompileOptions zoomed(const std::string& at, const std::string& zoom, ImageSize size) {
    CompileOptions options;
    options.size = size;
    std::string problem;
    options.zoom.at = parse_address(at, problem);
    EXPECT_EQ(problem, "");
    options.zoom.zoom = Magnification::parse(zoom);
    return options;
}

struct Place {
    const char* model;
    const char* address;
    const char* base;        ///< the zoom of one period
    std::vector<int> powers; ///< beyond the depth where the tints of the levels have settled
};

void PrintTo(const Place& place, std::ostream* out) {
    *out << place.model << " at " << place.address;
}

class SelfSimilarPlace : public testing::TestWithParam<Place> {};

TEST_P(SelfSimilarPlace, LooksTheSameAtEveryDepth) {
    const Place& place = GetParam();
    Image first;
    for (const int power : place.powers) {
        const auto model = compile_file(
            place.model, zoomed(place.address, fmt::format("{}^{}", place.base, power), {240, 135}));
        ASSERT_TRUE(model);
        const Image picture = draw(*model, SampleFormat::srgb8);
        if (first.pixels.empty()) {
            first = picture;
            EXPECT_GT(share_covered(picture), 0.005);
            continue;
        }
        EXPECT_EQ(compare_images(first, picture).differing, 0u) << power;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Zoom, SelfSimilarPlace,
    testing::Values(Place{"scenes/hart/sierpinski.inst", "(up)*", "2", {2, 3, 17, 100, 329, 330}},
                    Place{"scenes/hart/sierpinski.inst", "left.(right)*", "2", {6, 7, 330, 331}},
                    Place{"scenes/hart/pound_sign_2d.rifs", "(ll.ur)*", "4", {12, 13, 165, 166}},
                    Place{"scenes/hart/pound_sign.rifs", "(llf.urf)*", "4", {14, 166}},
                    Place{"scenes/ifs/menger_sponge.rifs", "(lbr.rtf)*", "9", {8, 105}}));

TEST(Zoom, IsWhatMovingTheCameraGives) {
    // The camera at a sixteenth of its distance, the same directions; the error as a length, so that both cut
    // alike.
    for (const char* model : {"scenes/hart/pound_sign.rifs", "scenes/ifs/sierpinski_tetrahedron.rifs"}) {
        SCOPED_TRACE(model);
        const Vec3 corner =
            std::string(model).find("pound") != std::string::npos ? Vec3(1.0 / 3, 1.0 / 3, 1) : Vec3(1, 1, 1);
        const char* const address =
            std::string(model).find("pound") != std::string::npos ? "(urf.llf)*" : "(a)*";
        CompileOptions moved;
        moved.size = {240, 135};
        const Vec3 from_focus(1.2, 1.1, 3.1);
        moved.camera.location = corner + from_focus;
        moved.camera.look_at = corner;
        moved.camera.angle_deg = 40;
        CompileOptions zoom = moved;
        std::string problem;
        zoom.zoom.at = parse_address(address, problem);
        zoom.zoom.zoom = Magnification::of(16);
        moved.camera.location = corner + from_focus / 16.0;
        const auto by_zoom = compile_file(model, zoom), by_camera = compile_file(model, moved);
        ASSERT_TRUE(by_zoom && by_camera);
        const ImageDifference difference =
            compare_images(draw(*by_zoom, SampleFormat::srgb8), draw(*by_camera, SampleFormat::srgb8));
        RecordProperty("mean", std::to_string(difference.mean));
        EXPECT_LT(difference.mean, 0.004);
    }
}

} // namespace
} // namespace graftal
