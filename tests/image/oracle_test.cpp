// The native engine against POV-Ray. Of a flattened cut both draw the same parts, so that they must show the
// same of them through every pixel, but where a ray runs along an edge.

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "tests/image/oracle.h"
#include "tests/image/random_model.h"

namespace graftal {
namespace {

constexpr ImageSize small{160, 120};

StageOptions plain(double error_px = 0.5) {
    StageOptions options;
    options.view.size = small;
    options.view.light = DefaultLight::plain;
    options.detail.error_px = error_px;
    return options;
}

StageOptions seen_from(const CameraSetting& camera, double error_px = 0.5) {
    StageOptions options = plain(error_px);
    options.view.camera = camera;
    return options;
}

StageOptions zoomed(const std::string& at, const std::string& zoom, double error_px) {
    StageOptions options = plain(error_px);
    std::string problem;
    options.view.zoom.at = parse_address(at, problem);
    EXPECT_EQ(problem, "");
    if (!zoom.empty()) options.view.zoom.zoom = Magnification::parse(zoom);
    return options;
}

StageOptions stopped_after(unsigned steps) {
    StageOptions options = plain();
    options.lower.steps = steps;
    return options;
}

struct Question {
    const char* name;
    std::string path; ///< of a file of the project, or the name of what `text` would be in
    StageOptions options;
    double least_covered = 0.03;
    std::string text = {};
    bool overlaps = false; ///< parts of several colours lie one in the other, and either may be seen

    friend std::ostream& operator<<(std::ostream& out, const Question& question) {
        return out << question.name;
    }
};

/// Every kind of primitive, stretched too, with tints, materials, a mirror and the ground that takes shadows.
const std::string still_life = R"(
    material gloss { color: 0.5, 0.2, 0.1 ambient: 0.1 diffuse: 0.6 specular: 0.7 roughness: 0.02 }
    material mirror { ambient: 0.02 diffuse: 0.2 specular: 0.4 roughness: 0.01 reflection: 0.7 }
    object ring { instance: torus scale: 1, 1, 1.2 material: gloss }
    object things {
        ring rotate: x, 70 translate: -2, 1, 0 tint: 0.1, 0.4, 0.9, 0.6
        cone scale: 0.7, 2.3, 0.4 rotate: z, -20 translate: 0, 0, -1 material: gloss
        frustum(0.4) scale: 0.8, 1.5, 0.8 translate: 1.7, 0, 0.5 tint: 0.3, 0.8, 0.2, 0.4
        cylinder scale: 0.2, 2, 0.3 rotate: <1, 0, 1>, 50 translate: 0.3, 0.5, 1
        sphere scale: 1.2 translate: 3.6, 1.2, -1.5 material: mirror
        cube scale: 0.4 rotate: <1, 2, 3>, 40 translate: -0.5, 0.7, 2 material: mirror tint: 1, 1, 0, 0.5
        triangle rotate: x, -30 translate: -3.3, 1, -1 tint: 0.9, 0.1, 0.7, 1
    }
    camera { location: 2, 4, 9 look_at: 0.4, 1, 0 angle: 45 }
    light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
    light { location: 3, 5, 4 color: 0.3, 0.4, 0.6 }
    ground { height: 0 }
)";

/// A recursion that is stopped by its levels, each stop drawn by a terminal of its own colour.
const std::string stopped = R"(
    material leaf { color: 0.2, 0.6, 0.1 }
    canonical object bud { sphere scale: 0.4, 0.9, 0.4 material: leaf }
    canonical object branch {
        cylinder scale: 0.08, 1, 0.08 tint: 0.5, 0.3, 0.1, 0.8
        branch scale: 0.7 rotate: z, 31 translate: 0, 0.9, 0 tint: 0.9, 0.5, 0.2, 0.1
        branch scale: 0.6 rotate: z, -44 rotate: y, 70 translate: 0, 0.7, 0
        terminal bud scale: 0.6 tint: 0.9, 0.9, 0.2, 0.3
    }
    object plant { branch }
)";

/// What numbers make, stretched too, with a mirror, and holes that show what is behind them.
const std::string shapes = R"(
    material gloss { color: 0.5, 0.2, 0.1 ambient: 0.1 diffuse: 0.6 specular: 0.7 roughness: 0.02 }
    material mirror { ambient: 0.02 diffuse: 0.2 specular: 0.4 roughness: 0.01 reflection: 0.7 }
    object things {
        superellipsoid(0.3, 0.3) scale: 0.8, 1, 0.6 rotate: y, 30 translate: -2, 1, 0 material: gloss
        superellipsoid(1, 0.5) rotate: x, 25 translate: 0.3, 1.2, -0.5 tint: 0.3, 0.8, 0.2, 0.4
        superellipsoid(1.6, 1.2) scale: 0.9 translate: 2.4, 0.9, 0.5 material: mirror
        polygon(-1, -1, 1, -1, 1, 1, -1, 1, -1, -1, -0.6, -0.6, 0.6, -0.6, 0, 0.6, -0.6, -0.6)
            rotate: y, -20 translate: 0.5, 1, 1.6 tint: 0.9, 0.1, 0.7, 1
    }
    camera { location: 2, 4, 9 look_at: 0.4, 1, 0 angle: 45 }
    light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
    light { location: 3, 5, 4 color: 0.3, 0.4, 0.6 }
    ground { height: 0 }
)";

/// Solids cut by planes that are turned, stretched, mirrored and united, and by what planes have cut.
const std::string half_spaces = R"(
    material cut { color: 0.2, 0.3, 0.8 }
    canonical object wedge {
        plane rotate: z, 50
        plane scale: 0.3, 2, 5 rotate: x, -70
    }
    canonical object corner {
        intersection: plane scale: 7 translate: 0, 0.4, 0
        plane scale: 1, -1, 1 translate: 0, -0.5, 0 material: cut
        sphere
    }
    object things {
        corner translate: -2.4, 1, 0
        corner scale: -0.8, 1.1, 0.9 rotate: <1, 2, 3>, 50 translate: 0, 1.2, -0.5 tint: 0.3, 0.8, 0.2, 0.4
        notched scale: 0.9, 0.9, -0.9 translate: 2.2, 1, 0.4
        dented translate: 0.2, 0.9, 2
    }
    canonical object notched {
        difference: cube scale: 0.9
        wedge scale: 40 translate: -0.3, -0.2, 0.2 material: cut
    }
    canonical object dented {
        difference: superellipsoid(0.3, 0.3) scale: 0.7
        corner scale: 0.6 translate: 0.3, 0.5, 0.4 material: cut
    }
    camera { location: 2, 4, 9 look_at: 0.2, 1, 0 angle: 40 }
    light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
    light { location: 3, 5, 4 color: 0.3, 0.4, 0.6 }
    ground { height: 0 }
)";

/// Solids that combine what is left of their operands where levels end.
const std::string ending_operands = R"(
    canonical object specks {
        cube scale: 0.2 translate: 0.5, 0, 0
        specks scale: 0.5 translate: 0.2, 0.1, 0
    }
    object half {
        intersection: sphere scale: 1.5
        specks
        plane rotate: z, 20
    }
    object notched {
        difference: cube scale: 0.8 translate: 3, 0, 0
        specks translate: 3, 0, 0
        sphere translate: 3.4, 0.8, 0.8
    }
    camera { location: 2, 4, 9 look_at: 1.2, 0, 0 angle: 40 }
    light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
    ground { height: -1.6 }
)";

/// Operands whose faces coincide, one within the other, and an intersection of which nothing is left.
const std::string flush_operands = R"(
    material cut { color: 0.9, 0.7, 0.1 specular: 0 }
    material within { color: 0.1, 0.4, 0.9 specular: 0 }
    canonical object corner {
        difference: cube
        cube scale: 0.5 translate: 0.5, 0.5, 0.5 material: cut
    }
    canonical object tube {
        difference: cylinder
        cylinder scale: 0.5, 1, 0.5 material: cut
    }
    canonical object slab {
        intersection: cube
        cube scale: 1, 0.5, 1 translate: 0, 0.5, 0 material: cut
    }
    canonical object step {
        difference: cube
        corner scale: 1, 1, 0.5 translate: 0, 0, 0.5 material: within
    }
    canonical object nothing {
        intersection: cube
        sphere translate: 3, 0, 0
    }
    object things {
        corner rotate: <1, 2, 3>, 20 translate: -2.4, 1, 0
        tube rotate: <1, 0, 2>, 30 translate: 0, 1.2, -0.5
        slab rotate: <3, 1, 0>, 25 translate: 2.4, 1, 0
        step rotate: <1, 2, 0>, 15 translate: 0, 1.2, 2.6
        nothing
    }
    camera { location: 2, 4, 9 look_at: 0.2, 1, 0 angle: 40 }
    light { sun: -1, 2, 1.5 color: 0.8, 0.7, 0.6 }
    ground { height: -1.6 }
)";

const CameraSetting parallel_from_above{.location = Vec3(2.1, 3.3, 1.7),
                                        .look_at = Vec3(0.0),
                                        .up = Vec3(0.2, 0, -1),
                                        .orthographic = true,
                                        .width = 4.1};
const CameraSetting inside{
    .location = Vec3(0.05, 0.02, 0.4), .look_at = Vec3(0.2, -0.1, -1), .angle_deg = 70.0};

/// The gasket, and its images on lines.
const char* const crushed = R"(rifs m {
  codes 2d {
    0.7 0 0 0 -3 5
    0.5 0 0 0.5 0 0
    0.5 0 0 0.5 1 0
    0.5 0 0 0.5 0 1
  }
}
)";

/// Unequal scales in space, and a terminal.
const char* const dust = R"(rifs m {
  map a { scale <0.3, 0.1, 0.2> rotate <1, 2, 3>, 40 }
  map b { scale <0.2, 0.3, 0.1> rotate <1, 0, 3>, 110 translate <1, 0.5, 0> }
  map c { scale <0.25, 0.1, 0.1> translate <0.2, 1, 0.7> }
  map d { scale 0.2 rotate <1, 1, 0>, 70 translate <0.7, -0.4, 0.6> }
  terminal cube scale 0.5
}
)";

const Question questions[] = {
    {"FlatFigure", "scenes/hart/pound_sign_2d.rifs", plain(3)},
    {"FlatFigureAPixelWide", "scenes/hart/pound_sign_2d.rifs", plain(1.5), 0.03, {}, true},
    {"FlatTintedTilesClose", "scenes/tilings/penrose.rifs",
     seen_from({.location = Vec3(0.1, 0.2, 3),
                .look_at = Vec3(0.1, 0.2, 0),
                .up = Vec3(0.3, 1, 0),
                .orthographic = true,
                .width = 0.9},
               2)},
    {"CurveOfLines", "scenes/abop/fig1_10a.lsys", plain()},
    {"FrustaAndLeaves", "scenes/abop/fig2_6a.lsys", plain()},
    {"ManyMaterials", "scenes/abop/fig3_04.lsys", plain()},
    {"TintedElmCulled", "scenes/hart/elm.inst", plain(3)},
    {"ProxiesFromInside", "scenes/ifs/menger_sponge.rifs", seen_from(inside, 4)},
    {"ProxiesInParallel", "scenes/ifs/graph_directed.rifs", seen_from(parallel_from_above, 4)},
    {"CubesForPoundSign", "scenes/hart/pound_sign.rifs", plain(6)},
    {"LimitOfATree", "scenes/limits/tree.lsys", plain(4)},
    {"DeepZoom", "scenes/hart/pound_sign.rifs", zoomed("(urf.llf)*", "4^40", 6)},
    {"AddressAlone", "scenes/hart/sierpinski.inst", zoomed("left.up", "", 1)},
    {"EveryPrimitive", "still_life.inst", plain(), 0.1, still_life},
    {"ShapesOfNumbers", "shapes.inst", plain(), 0.1, shapes},
    {"FlushOperands", "flush_operands.inst", plain(), 0.1, flush_operands},
    {"OperandsWhereLevelsEnd", "ending_operands.inst", stopped_after(1), 0.03, ending_operands},
    {"HalfSpaces", "half_spaces.inst", plain(), 0.1, half_spaces},
    {"MeshAndShapes", "scenes/shapes/shapes.inst", plain(), 0.1},
    {"SpecksOfACurve", "scenes/ifs/koch_curve.rifs", plain(), 0.01},
    {"TrianglesAPixelWide", "scenes/hart/sierpinski.inst", plain()},
    {"CrushedOntoLines", "crushed.rifs",
     seen_from({.location = Vec3(-6, -8, 16), .look_at = Vec3(-4, 2.5, 0), .angle_deg = 40}, 16), 0.01,
     crushed},
    {"SpecksOfDust", "dust.rifs", plain(), 0.001, dust},
    {"StoppedByLevels", "stopped.inst", stopped_after(4), 0.03, stopped},
};

Compilation& expect_compiled(Compilation& compilation, bool compiled) {
    EXPECT_TRUE(compiled) << compilation.diagnostics.render(compilation.sources)
                          << compilation.status.message();
    return compilation;
}

std::optional<OracleReport> answer_to(const Question& question) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    std::string path = GRAFTAL_SOURCE_DIR "/" + question.path;
    if (!question.text.empty()) {
        path = directory.path() + "/" + question.path;
        EXPECT_TRUE(write_text(path, question.text).ok());
    }
    Compilation compilation;
    std::optional<OracleReport> report = ask_oracle(path, question.options, {}, compilation);
    expect_compiled(compilation, report.has_value());
    return report;
}

void expect_agreement(const OracleReport& report, double least_covered, bool overlaps = false) {
    testing::Test::RecordProperty("report", summary(report));
    const auto pixels = static_cast<double>(report.pixels);
    EXPECT_GT(static_cast<double>(report.hits) / pixels, least_covered) << "hardly anything was drawn";
    EXPECT_EQ(report.mask.untied, 0u) << summary(report);
    EXPECT_LE(static_cast<double>(report.mask.pixels) / pixels, 0.0005) << summary(report);
    EXPECT_EQ(report.depth.untied, 0u) << summary(report);
    EXPECT_EQ(report.colour.untied - (overlaps ? report.colour.coinciding : 0), 0u) << summary(report);
    EXPECT_LE(report.mean, 0.05) << summary(report);
}

class Oracle : public testing::TestWithParam<Question> {};

TEST_P(Oracle, SeesTheSame) {
    const std::optional<OracleReport> report = answer_to(GetParam());
    ASSERT_TRUE(report);
    expect_agreement(*report, GetParam().least_covered, GetParam().overlaps);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Oracle, testing::ValuesIn(questions),
                         [](const auto& question) { return std::string(question.param.name); });

void expect_agreement_at_random(const std::string& name, std::string (*text_of)(std::uint64_t)) {
    for (std::uint64_t seed = 101; seed <= 104; ++seed) {
        SCOPED_TRACE(seed);
        // Culled by size in half of them, by levels in the others.
        StageOptions options = seed % 2 ? plain(5) : plain(0);
        if (seed % 2 == 0) options.lower.steps = 3;
        const std::optional<OracleReport> report = answer_to({"random", name, options, 0, text_of(seed)});
        ASSERT_TRUE(report);
        expect_agreement(*report, 0.01);
    }
}

TEST(OracleAtRandom, Rifs) {
    expect_agreement_at_random("random.rifs", random_rifs);
}

TEST(OracleAtRandom, Inst) {
    expect_agreement_at_random("random.inst", random_inst);
}

// What is not the same is seen: here a figure that ends a level earlier, and one that lies elsewhere by a
// fifth of a pixel.
TEST(OracleItself, CanSayNo) {
    Compilation compilation;
    const std::string path = GRAFTAL_SOURCE_DIR "/scenes/hart/pound_sign.rifs";
    const DetailedModel ours = look_at_file(path, stopped_after(2), compilation);
    const DetailedModel coarser = look_at_file(path, stopped_after(1), compilation);
    ASSERT_TRUE(ours.viewed && coarser.viewed);
    Session session(path, disk_files());
    const auto compiled = compile_scene(session, stopped_after(2), compilation, {.flatten = true});
    ASSERT_TRUE(compiled);
    CompiledModel theirs = *compiled;
    Status status;
    const auto ask = [&](const DetailedModel& viewed_model) {
        return ask_oracle(theirs, viewed_model, {}, status);
    };
    const std::optional<OracleReport> same = ask(ours), other = ask(coarser);
    ASSERT_TRUE(same && other);
    expect_agreement(*same, 0.1);
    EXPECT_GT(other->mask.untied + other->depth.untied, 100u) << summary(*other);
    EXPECT_GT(other->colour.untied, 100u) << summary(*other);

    const double pixel = 2 * std::tan(theirs.view.camera.angle_deg * 3.14159 / 360) / small.width;
    theirs.view.camera.location +=
        0.2 * pixel * glm::length(theirs.view.camera.location) * theirs.view.camera.right;
    const std::optional<OracleReport> moved = ask(ours);
    ASSERT_TRUE(moved);
    EXPECT_GT(moved->mask.untied, 10u) << summary(*moved);
}

} // namespace
} // namespace graftal
