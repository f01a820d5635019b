// Deep zooms: a self-similar place looks the same at every period, to the last pixel; and a zoom that doubles
// can still hold is what moving the camera gives.

#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/image/drawing.h"

namespace graftal {
namespace {

StageOptions zoomed(const std::string& at, const std::string& zoom, ImageSize size) {
    StageOptions options;
    options.view.size = size;
    std::string problem;
    options.view.light = DefaultLight::plain; // of dozens of lights, roundings add up
    options.view.zoom.at = parse_address(at, problem);
    EXPECT_EQ(problem, "");
    options.view.zoom.zoom = Magnification::parse(zoom);
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
        StageOptions moved;
        moved.view.size = {240, 135};
        const Vec3 from_focus(1.2, 1.1, 3.1);
        moved.view.camera.location = corner + from_focus;
        moved.view.camera.look_at = corner;
        moved.view.camera.angle_deg = 40;
        StageOptions zoom = moved;
        std::string problem;
        zoom.view.zoom.at = parse_address(address, problem);
        zoom.view.zoom.zoom = Magnification::of(16);
        moved.view.camera.location = corner + from_focus / 16.0;
        const auto by_zoom = compile_file(model, zoom), by_camera = compile_file(model, moved);
        ASSERT_TRUE(by_zoom && by_camera);
        const ImageDifference difference =
            compare_images(draw(*by_zoom, SampleFormat::srgb8), draw(*by_camera, SampleFormat::srgb8));
        RecordProperty("mean", std::to_string(difference.mean));
        EXPECT_LT(difference.mean, 0.004);
    }
}

/// What frame i shows if it is made of the parts chosen for frame i + 1: the same picture, except where
/// a part changed its level. `GRAFTAL_POP=MODEL ADDRESS FROM TO FRAMES` measures a whole animation and prints
/// every pair (docs/benchmarks/popping.md).
struct Popping {
    std::string model = "scenes/ifs/sierpinski_tetrahedron.rifs", address = "(a.b)*";
    double from = 4, to = 4.2; ///< zoom, as powers of two
    int frames = 3;
    bool print = false;
};

TEST(Zoom, NothingPopsFromFrameToFrame) {
    Popping p;
    if (const char* const asked = std::getenv("GRAFTAL_POP")) {
        std::istringstream words(asked);
        ASSERT_TRUE(words >> p.model >> p.address >> p.from >> p.to >> p.frames);
        p.print = true;
    }
    const double step = (p.to - p.from) / std::max(1, p.frames - 1);
    const auto compiled = [&](int frame) {
        StageOptions options = zoomed(p.address, "1", {160, 90});
        options.view.zoom.zoom = Magnification::exp2(p.from + step * frame);
        return compile_file(p.model, options);
    };
    double worst_mean = 0, worst_p99 = 0, natural = 0;
    const auto first = compiled(0);
    ASSERT_TRUE(first);
    Image picture = draw(*first, SampleFormat::srgb8, 3);
    for (int i = 0; i + 1 < p.frames; ++i) {
        auto next = compiled(i + 1);
        ASSERT_TRUE(next);
        const Image next_picture = draw(*next, SampleFormat::srgb8, 3);
        // The focus is the origin of both.
        const Affine here_from_next = Affine::scale(Vec3(std::exp2(-step)));
        CompiledModel swapped = *next;
        swapped.cut.bounds = transformed(here_from_next, next->cut.bounds);
        for (PlacementGroup& group : swapped.cut.groups)
            for (Placement& placement : group.placements)
                placement.world_from_body = here_from_next * placement.world_from_body;
        const ImageDifference by_level = compare_images(picture, draw(swapped, SampleFormat::srgb8, 3));
        const ImageDifference by_motion = compare_images(picture, next_picture);
        if (p.print)
            fmt::print("{} {:.3f} {:.3f} {:.1f} {:.3f}\n", i, p.from + step * i, 255 * by_level.mean,
                       255 * by_level.p99, 255 * by_motion.mean);
        worst_mean = std::max(worst_mean, by_level.mean);
        worst_p99 = std::max(worst_p99, by_level.p99);
        natural = std::max(natural, by_motion.mean);
        picture = next_picture;
    }
    RecordProperty("worst_mean_in_255ths", std::to_string(255 * worst_mean));
    RecordProperty("worst_p99_in_255ths", std::to_string(255 * worst_p99));
    EXPECT_LT(worst_mean, p.print ? 1.0 : 0.012);
    EXPECT_LT(worst_mean, natural);
}

} // namespace
} // namespace graftal
