// The frames of an animation are framed together: all that is shown is in the picture, and nothing but what
// moves changes.

#include "compiler/session/shared_framing.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "compiler/graph/unfold.h"
#include "compiler/scene/outline.h"
#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "runtime/system/disk_files.h"

namespace graftal {
namespace {

constexpr ImageSize size{400, 300};

/// A model and the levels that are shown of it.
struct Shown {
    std::shared_ptr<const AnalysedModel> model;
    std::optional<unsigned> steps;
};

Shown analysed(const std::string& scene, const StageOptions& options = {}) {
    Compilation compilation;
    Session session(std::string(GRAFTAL_SOURCE_DIR "/scenes/") + scene, disk_files());
    const auto model = session.analysed(options, compilation);
    EXPECT_TRUE(model) << scene << "\n" << compilation.diagnostics.render(compilation.sources);
    return {model, levels_of(*model, options.lower.steps)};
}

SharedFraming framed(const std::vector<Shown>& models, bool turning, const CameraOverride& camera = {}) {
    SharedFraming framing;
    for (const Shown& shown : models)
        framing.include(*shown.model, shown.steps);
    framing.settle(camera, size, turning);
    return framing;
}

/// Where points of the model lie: shares of half the picture's width and height; the farthest from the
/// middle.
struct Spread {
    double x = 0, y = 0;
};

Spread spread(const Shown& shown, const View& view) {
    const AnalysedModel& model = *shown.model;
    const Camera& camera = view.camera;
    const double half = std::tan(camera.angle_deg * std::numbers::pi / 360);
    const double aspect = static_cast<double>(size.width) / size.height;
    Spread most;
    const auto add = [&](const UnfoldedLeaf& leaf) {
        for (const Vec3& corner :
             hull_points(model.graph.objects[leaf.object], model.bounds[leaf.object].box)) {
            const Vec3 sight = leaf.world_from_object(corner) - camera.location;
            const double depth = glm::dot(sight, camera.direction);
            EXPECT_GT(depth, 0);
            const double unit = camera.orthographic ? camera.width / 2 : half * depth;
            most.x = std::max(most.x, std::abs(glm::dot(sight, camera.right)) / unit);
            most.y = std::max(most.y, std::abs(glm::dot(sight, camera.up)) / unit * aspect);
        }
        return true;
    };
    EXPECT_TRUE(unfold(model.graph, model.components, shown.steps, 3'000'000, add));
    return most;
}

bool same(const Camera& a, const Camera& b) {
    return a.location == b.location && a.direction == b.direction && a.up == b.up && a.right == b.right &&
           a.orthographic == b.orthographic && a.angle_deg == b.angle_deg && a.width == b.width;
}

struct TurnCase {
    const char* scene;
    unsigned steps;
};

class Turntable : public ::testing::TestWithParam<TurnCase> {};

TEST_P(Turntable, KeepsTheModelInThePictureAtOneDistance) {
    StageOptions options;
    options.lower.steps = GetParam().steps;
    const Shown model = analysed(GetParam().scene, options);
    const SharedFraming framing = framed({model}, true);
    const View front = framing.view(*model.model, {.turn_deg = 0});
    double widest = 0;
    for (int frame = 0; frame < 16; ++frame) {
        const View view = framing.view(*model.model, {.turn_deg = 360.0 * frame / 16});
        const Spread most = spread(model, view);
        EXPECT_LE(most.x, 0.93) << frame;
        EXPECT_LE(most.y, 0.93) << frame;
        widest = std::max({widest, most.x, most.y});
        EXPECT_EQ(view.camera.angle_deg, front.camera.angle_deg);
        EXPECT_EQ(view.camera.width, front.camera.width);
        EXPECT_EQ(view.camera.location.y, front.camera.location.y);
        EXPECT_EQ(view.sky.zenith, front.sky.zenith);
        if (frame > 0) {
            EXPECT_FALSE(same(view.camera, front.camera));
        }
    }
    EXPECT_GT(widest, 0.7) << "the model fills the picture in some frame";
    EXPECT_TRUE(same(framing.view(*model.model, {.turn_deg = 360}).camera, front.camera))
        << "the loop is closed";
    EXPECT_TRUE(same(framing.view(*model.model, {.turn_deg = -720}).camera, front.camera));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Turntable,
                         ::testing::Values(TurnCase{"hart/pound_sign.rifs", 4},
                                           TurnCase{"hart/sierpinski.inst", 6},
                                           TurnCase{"abop/fig1_25.lsys", 4},
                                           TurnCase{"abop/fig1_24f.lsys", 4},
                                           TurnCase{"ifs/menger_sponge.rifs", 3}));

TEST(SharedFraming, GrowthHappensInThePicture) {
    std::vector<Shown> models;
    for (const unsigned steps : {1u, 2u, 3u, 4u}) {
        StageOptions options;
        options.lower.steps = steps;
        models.push_back(analysed("abop/fig1_24f.lsys", options));
    }
    const SharedFraming framing = framed(models, false);
    const View first = framing.view(*models[0].model, {.turn_deg = 0});
    for (const Shown& model : models) {
        const View view = framing.view(*model.model, {.turn_deg = 0});
        EXPECT_TRUE(same(view.camera, first.camera));
        EXPECT_EQ(view.sky.zenith, first.sky.zenith);
        const Spread most = spread(model, view);
        EXPECT_LE(std::max(most.x, most.y), 0.92);
    }
    const Spread largest = spread(models[3], first);
    EXPECT_GT(std::max(largest.x, largest.y), 0.85);
}

TEST(SharedFraming, AnotherProcessReadsTheVerySame) {
    for (const bool turning : {false, true})
        for (const char* scene : {"hart/pound_sign.rifs", "abop/fig1_24f.lsys"}) {
            const Shown model = analysed(scene, {.lower = {.steps = 4}});
            const SharedFraming framing = framed({model}, turning);
            const auto read = SharedFraming::from_json(framing.json());
            ASSERT_TRUE(read) << scene;
            EXPECT_EQ(read->json(), framing.json());
            EXPECT_EQ(read->turning(), turning);
            // A camera that is half given is completed by what the framing holds.
            for (const ViewOptions& options :
                 {ViewOptions{.turn_deg = 77},
                  ViewOptions{.camera = {.location = Vec3(1, 2, 9)}, .turn_deg = 5}}) {
                const View ours = framing.view(*model.model, options),
                           theirs = read->view(*model.model, options);
                EXPECT_TRUE(same(ours.camera, theirs.camera)) << scene;
                EXPECT_EQ(ours.size, theirs.size);
                EXPECT_EQ(ours.sky.zenith, theirs.sky.zenith);
            }
        }
    for (const char* text : {"", "{}", "[]", "{\"size\": [1]}", "nonsense"})
        EXPECT_FALSE(SharedFraming::from_json(text)) << text;
}

TEST(SharedFraming, WhatIsLeftOpenIsAsInTheFirstFrame) {
    const Shown model = analysed("hart/pound_sign.rifs");
    const CameraOverride wide{.angle_deg = 40}, narrow{.angle_deg = 10};
    const SharedFraming framing = framed({model}, false, wide);
    const Camera first = framing.view(*model.model, {.camera = wide}).camera,
                 last = framing.view(*model.model, {.camera = narrow}).camera;
    EXPECT_EQ(first.location, last.location);
    EXPECT_EQ(last.angle_deg, 10);

    const CameraOverride far{.location = Vec3(0, 0, 20)}, near{.location = Vec3(0, 0, 4)};
    const SharedFraming approach = framed({model}, false, far);
    EXPECT_EQ(approach.view(*model.model, {.camera = far}).camera.angle_deg,
              approach.view(*model.model, {.camera = near}).camera.angle_deg);
}

} // namespace
} // namespace graftal
