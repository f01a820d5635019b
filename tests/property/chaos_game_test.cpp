// The oracle of the cut: points of the limit set, found by random walks that know nothing of bounds, cuts or
// meshes, against the geometry that would be sent to POV-Ray.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/povray/cut/compile.h"
#include "runtime/system/disk_files.h"
#include "tests/property/nearest.h"

namespace graftal {
namespace {

using ::graftal::testing::farthest_from;

constexpr int walk_count = 100'000;

/// Random points of the limit set: each walk goes down from the root until its ball is a point. Instances are
/// chosen by the square of their stretch, so that large parts get many points, with a floor for the thin.
std::vector<Vec3> chaos_points(const AnalysedModel& model) {
    std::mt19937 random(20240607);
    const auto& objects = model.graph.objects;
    std::vector<std::discrete_distribution<int>> choice(objects.size());
    std::vector<double> widest(objects.size(), 1);
    for (ObjectId id = 0; id < objects.size(); ++id)
        if (!objects[id].primitive) {
            widest[id] = 0;
            for (const Instance& instance : objects[id].instances)
                widest[id] = std::max(widest[id], norm(instance.parent_from_child.linear));
        }
    for (ObjectId id = 0; id < objects.size(); ++id) {
        std::vector<double> weights;
        for (const Instance& instance : objects[id].instances) {
            // All instances of an IFS object share its map: what tells them apart is the next one.
            const double stretch = norm(instance.parent_from_child.linear) * widest[instance.master];
            weights.push_back(model.components.unending[instance.master] ? std::max(0.005, stretch * stretch)
                                                                         : 0);
        }
        if (std::any_of(weights.begin(), weights.end(), [](double w) { return w > 0; }))
            choice[id] = std::discrete_distribution<int>(weights.begin(), weights.end());
    }
    const double size = model.bounds[model.graph.root].ball.radius;
    std::vector<Vec3> points;
    for (int walk = 0; walk < walk_count; ++walk) {
        ObjectId id = model.graph.root;
        Affine world_from_object;
        for (int step = 0; step < 100'000; ++step) {
            const Instance& instance = objects[id].instances[choice[id](random)];
            world_from_object = world_from_object * instance.parent_from_child;
            id = instance.master;
            if (norm(world_from_object.linear) * model.bounds[id].ball.radius < 1e-5 * size) break;
        }
        points.push_back(world_from_object(model.bounds[id].ball.centre));
    }
    return points;
}

/// All corners of all bodies, in the world.
std::vector<Vec3> drawn_points(const Cut& cut) {
    std::vector<Vec3> points;
    for (const PlacementGroup& group : cut.groups)
        for (const Placement& placement : group.placements) {
            const Body& body = cut.bodies[placement.body];
            if (const Mesh* mesh = std::get_if<Mesh>(&body.shape))
                for (const Vec3& vertex : mesh->vertices)
                    points.push_back(placement.world_from_body(vertex));
            else
                points.push_back(placement.world_from_body.translation);
        }
    return points;
}

/// About `count` of the points, evenly spread over their order.
std::vector<Vec3> every_nth(const std::vector<Vec3>& points, std::size_t count) {
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / count)
        kept.push_back(points[i]);
    return kept;
}

std::vector<std::string> recursive_scenes() {
    std::vector<std::string> scenes;
    const std::filesystem::path root = GRAFTAL_SOURCE_DIR;
    for (const char* folder : {"scenes/ifs", "scenes/hart"})
        for (const auto& entry : std::filesystem::directory_iterator(root / folder))
            if (entry.path().extension() == ".rifs" || entry.path().filename() == "sierpinski.inst")
                scenes.push_back(std::filesystem::relative(entry.path(), root).string());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

class ChaosGame : public ::testing::TestWithParam<std::string> {};

// Every part that is culled has a diameter of at most the error and is drawn within its own ball or box, so
// each point lies within sqrt(3) errors of a corner; drawn corners lie near points up to how densely 10^5
// points can cover the set.
TEST_P(ChaosGame, PointsAndGeometryAreCloseBothWays) {
    StageOptions options;
    options.view.size = {320, 240};
    options.detail.error_px = 8;
    Compilation compilation;
    Session session(std::string(GRAFTAL_SOURCE_DIR) + "/" + GetParam(), disk_files());
    const std::shared_ptr<const CompiledModel> compiled = compile_scene(session, options, compilation);
    ASSERT_TRUE(compiled) << compilation.diagnostics.render(compilation.sources);
    const std::vector<Vec3> points = chaos_points(*compiled->model);
    const std::vector<Vec3> drawn = drawn_points(compiled->cut);
    ASSERT_FALSE(drawn.empty());

    const Ball& ball = compiled->model->bounds[compiled->model->graph.root].ball;
    const Camera& camera = compiled->view.camera;
    // The least resolution over the model gives the largest error in scene units.
    const double pixels_per_unit =
        camera.pixels_per_unit(ball.centre + camera.direction * ball.radius, options.view.size.width);
    const double error = compiled->cut.error_px / pixels_per_unit;
    RecordProperty("error", std::to_string(error));

    const double to_geometry = farthest_from(drawn, points);
    EXPECT_LE(to_geometry, std::sqrt(3.0) * error);
    const double coverage = 0.06 * ball.radius;
    const double to_points = farthest_from(points, every_nth(drawn, 20'000));
    EXPECT_LE(to_points, std::sqrt(3.0) * error + coverage);
    std::printf("%-40s error %.4g  points to geometry %.4g  geometry to points %.4g (of radius %.3g)\n",
                GetParam().c_str(), error, to_geometry, to_points, ball.radius);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ChaosGame, ::testing::ValuesIn(recursive_scenes()), [](const auto& scene) {
    std::string name = scene.param;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
    return name;
});

} // namespace
} // namespace graftal
