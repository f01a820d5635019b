// What is culled has the light of what it stands for, in both engines.

#include <cmath>
#include <regex>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/render/file_film.h"
#include "runtime/render/native_engine.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "tests/image/drawing.h"
#include "tests/image/render_helpers.h"

namespace graftal {
namespace {

/// A background that no surface shows.
const std::string before_magenta = "\nbackground: 0.93, 0.07, 0.91\n";

std::string model_of(const std::string& path) {
    std::string text;
    EXPECT_TRUE(read_text(GRAFTAL_SOURCE_DIR "/" + path, text).ok());
    return std::regex_replace(text, std::regex("(^|\n)(ground|background)[^\n]*"), "");
}

/// The mean light, in 255ths, where the model covers the picture.
double mean_light(const Image& picture) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i + 2 < picture.pixels.size(); i += 3) {
        const float* const rgb = picture.pixels.data() + i;
        if (std::abs(rgb[0] - 0.93) + std::abs(rgb[1] - 0.07) + std::abs(rgb[2] - 0.91) < 1e-3) continue;
        sum += (rgb[0] + rgb[1] + rgb[2]) / 3;
        ++count;
    }
    EXPECT_GT(count, 100);
    return 255 * sum / count;
}

RenderOptions options_for(int width, double error_px, DefaultLight light) {
    RenderOptions options = measured(width, width * 9 / 16);
    options.compile.detail.error_px = error_px;
    options.compile.view.light = light;
    options.compile.view.quality = Quality::draft;
    options.listed_lights = true;
    return options;
}

struct LitModel {
    const char* name;
    const char* file; ///< its name tells the language; a model of the project if there is no text
    std::string text;
    int width = 320; ///< of its pictures
};

void PrintTo(const LitModel& model, std::ostream* out) {
    *out << model.name;
}

class CulledParts : public testing::TestWithParam<LitModel> {
  protected:
    static std::string text(const std::string& more) {
        const LitModel& model = GetParam();
        return (model.text.empty() ? model_of(model.file) : model.text) + before_magenta + more;
    }

    static double native(const std::string& more, double error_px, DefaultLight light) {
        TemporaryDirectory directory;
        EXPECT_TRUE(directory.create().ok());
        const std::string file = GetParam().file;
        const std::string path = directory.path() + "/" + file.substr(file.rfind('/') + 1);
        EXPECT_TRUE(write_text(path, text(more)).ok());
        PictureSession session(path);
        Compilation compilation;
        RenderOptions options = options_for(GetParam().width, error_px, light);
        MemoryFilm film(options);
        options.film = &film;
        const auto report = render_natively(session, options, compilation);
        EXPECT_TRUE(report) << compilation.diagnostics.render(compilation.sources);
        return mean_light(film.picture());
    }

    static double povray(const std::string& more, double error_px, DefaultLight light) {
        return mean_light(
            render_model_text(GetParam().file, text(more), options_for(GetParam().width, error_px, light)));
    }
};

constexpr double most_255 = 2;
const std::string sky = "sky { zenith: 0.5, 0.5, 0.5  horizon: 0.9, 0.9, 0.9 }\n";

TEST_P(CulledParts, HaveTheLightOfFinerOnesUnderOneSun) {
    const double fine = native("", 0.5, DefaultLight::plain), coarse = native("", 4, DefaultLight::plain);
    RecordProperty("error_255", fmt::format("{:.2f}", coarse - fine));
    EXPECT_NEAR(coarse, fine, most_255);
    // POV-Ray's meshes show the limit's normals of fewer levels: another light, which stays as well.
    EXPECT_NEAR(povray("", 4, DefaultLight::plain), povray("", 0.5, DefaultLight::plain), most_255);
}

TEST_P(CulledParts, HaveTheLightOfFinerOnesUnderASky) {
    const double fine = native(sky, 0.5, DefaultLight::studio), coarse = native(sky, 4, DefaultLight::studio);
    RecordProperty("error_255", fmt::format("{:.2f}", coarse - fine));
    EXPECT_NEAR(coarse, fine, most_255);
}

const std::string random_bush = R"(
material leaf { color: 0.2, 0.5, 0.1 }
lsys bush {
  seed 7
  steps 9
  colors leaf
  axiom A(1)
  A(l) -> !(0.1*l)F(l)[&(35)A(l*0.72)]/(120)[&(40)A(l*0.68)]/(120)[&(30)A(l*0.75)] : 0.6
  A(l) -> !(0.1*l)F(l)/(70)[&(50)A(l*0.7)]/(150)[&(25)A(l*0.7)] : 0.4
}
)";

INSTANTIATE_TEST_SUITE_P(SelfShadow, CulledParts,
                         testing::Values(LitModel{"pound_sign", "scenes/hart/pound_sign.rifs", {}},
                                         LitModel{"sponge", "scenes/ifs/menger_sponge.rifs", {}},
                                         LitModel{"limit_tree", "scenes/limits/tree.lsys", {}},
                                         LitModel{"random_bush", "bush.lsys", random_bush}),
                         [](const auto& model) { return model.param.name; });

/// Light comes through the leaves, and not through the solids that stand for twigs.
std::string thin_leaves() {
    return std::regex_replace(model_of("scenes/abop/fig2_8a.lsys"),
                              std::regex("\n(light|sky|haze|film)[^\n]*"), "");
}

class ThinLeaves : public CulledParts {};

/// The solids have one finish for bark and leaves, so the light is not that of the finer picture to the last
/// part in ten.
TEST_P(ThinLeaves, KeepTheirLight) {
    for (const auto& [more, light] :
         {std::pair{std::string(), DefaultLight::plain}, {sky, DefaultLight::studio}}) {
        const double fine = native(more, 0.5, light), coarse = native(more, 4, light);
        EXPECT_NEAR(coarse / fine, 1, 0.1) << more;
    }
}

INSTANTIATE_TEST_SUITE_P(SelfShadow, ThinLeaves,
                         testing::Values(LitModel{"tree", "leaves.lsys", thin_leaves(), 64}),
                         [](const auto& model) { return model.param.name; });

} // namespace
} // namespace graftal
