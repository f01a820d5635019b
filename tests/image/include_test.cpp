// A picture of a model and the picture of a scene written by hand that includes the model: camera, light and
// background say the same, so the pictures must be the same.

#include <gtest/gtest.h>

#include "runtime/system/file.h"
#include "tests/image/drawing.h"

namespace graftal {
namespace {

// Drawn at 200 times the model's size: in units so small as the model's POV-Ray loses the finest shadows.
const std::string by_hand_head = "#version 3.7;\n"
                                 "global_settings { assumed_gamma 1 adc_bailout 1e-6 }\n"
                                 "#include \"model.inc\"\n"
                                 "background { rgb <0.2, 0.3, 0.4> }\n";
const std::string settings = "camera { location: 2.1, 1.3, 3.7  look_at: 0, 0.1, 0  angle: 40 }\n"
                             "background: 0.2, 0.3, 0.4\n"
                             "light { location: 4, 7, 5  color: 1, 0.95, 0.9 }\n"
                             "light { location: 9, 1, 2  color: 0.3, 0.3, 0.3  shadowless }\n";

/// The lights, and what the camera has in both systems; z is turned round in POV-Ray's own.
std::string by_hand(const std::string& identifier, bool left_handed) {
    const std::string z = left_handed ? "-" : "";
    return by_hand_head + "camera { location 200*<2.1, 1.3, " + z + "3.7> right " +
           (left_handed ? "x" : "-x") + "*image_width/image_height look_at 200*<0, 0.1, 0> angle 40 }\n" +
           "light_source { 200*<4, 7, " + z + "5> rgb <1, 0.95, 0.9> }\n" + "light_source { 200*<9, 1, " + z +
           "2> rgb 0.3 shadowless }\n" + "object { " + identifier + (left_handed ? " scale <1, 1, -1>" : "") +
           " scale 200 }\n";
}

void expect_the_same_by_hand(const std::string& path, const std::string& identifier,
                             const StageOptions& options) {
    std::string text;
    ASSERT_TRUE(read_text(GRAFTAL_SOURCE_DIR "/" + path, text).ok());
    const std::string name = path.substr(path.rfind('/') + 1);
    const std::optional<CompiledModel> model = compile_text(name, settings + text, options);
    ASSERT_TRUE(model);
    EXPECT_GT(model->cut.placement_count, 10u);
    const Image emitted = draw(*model, SampleFormat::srgb8);
    EXPECT_GT(share_covered(emitted), 0.02);
    for (const bool left_handed : {false, true}) {
        const ImageDifference difference = compare_images(
            emitted, draw_by_hand(*model, by_hand(identifier, left_handed), SampleFormat::srgb8));
        EXPECT_TRUE(difference.same_size);
        EXPECT_EQ(difference.differing, 0u) << (left_handed ? "left" : "right") << "-handed";
    }
}

TEST(Include, PoundSign) {
    expect_the_same_by_hand("scenes/hart/pound_sign.rifs", "Pound_sign", whole({240, 160}, 5));
}

TEST(Include, Elm) {
    StageOptions options = whole({240, 160});
    options.lower.set["levels"] = 5;
    expect_the_same_by_hand("scenes/hart/elm.inst", "Elm", options);
}

} // namespace
} // namespace graftal
