#include "compiler/graph/verify.h"
#include "tests/unit/broken_invariant.h"

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using testing::HasSubstr;

Instance halved(ObjectId master) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = Affine::scale(Vec3(0.5));
    return instance;
}

/// root -> loop -> loop, sphere; with a terminal, a material and a tint.
class Verify : public testing::Test {
  protected:
    Verify() {
        graph_.materials.push_back({});
        graph_.materials[0].name = "bark";
        Object root_object, loop_object;
        root_object.name = "root";
        loop_object.name = "loop(3, -0.5)";
        root = graph_.add(root_object);
        loop = graph_.add(loop_object);
        sphere = graph_.primitive(PrimitiveKind::sphere);
        graph_.objects[root].instances = {halved(loop)};
        graph_.objects[loop].instances = {halved(loop), halved(sphere)};
        graph_.objects[loop].terminal = halved(sphere);
        graph_.objects[loop].instances[0].material = 0;
        graph_.objects[loop].instances[0].tint = {{0, 1, 0.5}, 1};
        graph_.root = root;
    }

    Instance& first() { return graph_.objects[root].instances[0]; }

    /// Expects one flaw, of this object, that says this.
    void expect_flaw(ObjectId object, const std::string& message) {
        const std::vector<Flaw> flaws = verify(graph_);
        ASSERT_EQ(flaws.size(), 1u);
        EXPECT_EQ(flaws[0].object, object);
        EXPECT_EQ(flaws[0].message, message);
    }

    Graph graph_;
    ObjectId root = 0, loop = 0, sphere = 0;
};

TEST_F(Verify, AcceptsAGoodGraph) {
    EXPECT_TRUE(verify(graph_).empty());
}

TEST_F(Verify, TheRootExistsAndIsAUnion) {
    graph_.root = 7;
    expect_flaw(7, "the root is object 7 of 3");
    graph_.root = sphere;
    expect_flaw(sphere, "the root is a primitive, not a union");
    EXPECT_FALSE(verify(Graph()).empty()) << "an empty graph has no root";
}

TEST_F(Verify, MastersAndMaterialsExist) {
    first().master = 3;
    expect_flaw(root, "instance 0 has master 3 of 3 objects");
    first().master = loop;
    first().material = 1;
    expect_flaw(root, "instance 0 has material 1 of 1");
    first().material.reset();
    graph_.objects[loop].terminal->master = UINT32_MAX;
    expect_flaw(loop, "the terminal has master 4294967295 of 3 objects");
}

TEST_F(Verify, PrimitivesAreBareAndUnionsAreNot) {
    graph_.objects[sphere].instances = {halved(root)};
    expect_flaw(sphere, "a primitive with instances");
    graph_.objects[sphere].instances.clear();
    graph_.objects[sphere].terminal = halved(sphere);
    expect_flaw(sphere, "a primitive with a terminal");
    graph_.objects[sphere].terminal.reset();
    graph_.objects[sphere].terminal_px = 3;
    expect_flaw(sphere, "a terminal drawn below 3 px");
    graph_.objects[sphere].terminal_px = 0;
    graph_.objects[root].instances.clear();
    expect_flaw(root, "an empty union");
}

TEST_F(Verify, NamesAreUniqueAndOfTheRightKind) {
    graph_.objects[root].name = "loop(3, -0.5)";
    expect_flaw(loop, "the name is that of object 0 too");
    graph_.objects[root].name = "cube";
    expect_flaw(root, "a union with a primitive's name");
    graph_.objects[root].name = "root";
    graph_.objects[sphere].name = "ball";
    expect_flaw(sphere, "a primitive 'sphere' under another name");
}

TEST_F(Verify, NamesCanBeWrittenAndReadBack) {
    for (const char* good : {"a", "_a", "leaf.llr", "a1.b_2.c", "tip(3)", "f(1, 2.5, -1e-05)", "a.b(0)"}) {
        graph_.objects[root].name = good;
        EXPECT_TRUE(verify(graph_).empty()) << good;
    }
    for (const char* bad :
         {"",         "1a",    ".a",     "a.",     "a..b",   "a.1",      "a b",    "a\n",    "a{",
          "\xC3\xA4", "a()",   "a(3",    "a(x)",   "a(1,2)", "a(1,  2)", "a(1, )", "a(, 1)", "a(1)(2)",
          "a(1)b",    "a(01)", "a(3.0)", "a(nan)", "a(inf)", "(3)",      "a(-0)"}) {
        graph_.objects[root].name = bad;
        expect_flaw(root, "the name cannot be written in .inst");
    }
}

TEST_F(Verify, TransformsAreFiniteAndNotZero) {
    for (const double bad : {std::nan(""), HUGE_VAL}) {
        first().parent_from_child.linear[2][1] = bad;
        expect_flaw(root, "instance 0 has a transform that is not finite");
        first().parent_from_child = Affine::translate({0, bad, 0});
        expect_flaw(root, "instance 0 has a transform that is not finite");
    }
    first().parent_from_child = Affine::scale(Vec3(0.0));
    expect_flaw(root, "instance 0 has a linear part of zero");
    first().parent_from_child = Affine::scale({0, 1e-300, 0});
    EXPECT_TRUE(verify(graph_).empty()) << "flat and tiny are allowed";
}

TEST_F(Verify, TintsLieInTheUnitInterval) {
    first().tint = {{0, 0, 0}, 1.5};
    expect_flaw(root, "instance 0 has tint (0, 0, 0) 1.5 outside [0, 1]");
    first().tint = {{0, -0.25, 0}, 0};
    expect_flaw(root, "instance 0 has tint (0, -0.25, 0) 0 outside [0, 1]");
    first().tint = {{0, 0, std::nan("")}, 0};
    expect_flaw(root, "instance 0 has tint (0, 0, nan) 0 outside [0, 1]");
}

TEST_F(Verify, TerminalsEnd) {
    graph_.objects[root].terminal = halved(loop);
    expect_flaw(root, "the terminal 'loop(3, -0.5)' is unending");
    graph_.objects[root].terminal = halved(sphere);
    EXPECT_TRUE(verify(graph_).empty());
}

TEST_F(Verify, PlanesStayOutOfCycles) {
    const ObjectId plane = graph_.primitive(PrimitiveKind::plane);
    Object floor_object;
    floor_object.name = "floor";
    floor_object.instances = {halved(plane)};
    const ObjectId floor = graph_.add(floor_object);
    graph_.objects[root].instances.push_back(halved(floor));
    EXPECT_TRUE(verify(graph_).empty()) << "beside a cycle";
    graph_.objects[loop].terminal->master = floor;
    expect_flaw(loop, "a plane is reached through a cycle");
    graph_.objects[loop].terminal.reset();
    graph_.objects[loop].instances.push_back(halved(floor));
    expect_flaw(loop, "a plane is reached through a cycle");
}

TEST_F(Verify, MaterialsAndSettings) {
    graph_.materials[0].roughness = std::nan("");
    expect_flaw(root, "material 'bark' has a number that is not finite");
    graph_.materials[0].roughness = 0.1;
    graph_.materials.push_back(graph_.materials[0]);
    expect_flaw(root, "two materials are named 'bark'");
    graph_.materials[1].name = "b{}";
    expect_flaw(root, "the name of material 'b{}' cannot be written in .inst");
    graph_.materials.pop_back();
    graph_.settings.ground = GroundSetting{0, "moss", {}};
    expect_flaw(root, "the ground's material 'moss' does not exist");
    graph_.settings.ground->material = "bark";
}

TEST_F(Verify, EveryNumberOfTheSettingsIsFinite) {
    using Spoil = void (*)(SceneSettings&, double);
    constexpr std::pair<const char*, Spoil> faults[] = {
        {"camera", [](SceneSettings& s, double x) { s.camera->location = Vec3(0, x, 0); }},
        {"camera", [](SceneSettings& s, double x) { s.camera->look_at = Vec3(x, 0, 0); }},
        {"camera", [](SceneSettings& s, double x) { s.camera->up = Vec3(0, x, 0); }},
        {"camera", [](SceneSettings& s, double x) { s.camera->direction = Vec3(0, 0, x); }},
        {"camera", [](SceneSettings& s, double x) { s.camera->angle_deg = x; }},
        {"camera", [](SceneSettings& s, double x) { s.camera->width = x; }},
        {"camera", [](SceneSettings& s, double x) { s.camera->height = x; }},
        {"camera", [](SceneSettings& s, double x) { s.camera->aperture = x; }},
        {"camera", [](SceneSettings& s, double x) { s.camera->focus = Vec3(x, 0, 0); }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].location.z = x; }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].rgb.g = x; }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].angle_deg = x; }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].width = x; }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].height = x; }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].radius = x; }},
        {"light", [](SceneSettings& s, double x) { s.lights[1].look_at = Vec3(0, x, 0); }},
        {"background", [](SceneSettings& s, double x) { s.background->rgb.b = x; }},
        {"background", [](SceneSettings& s, double x) { s.background->horizon = Rgb(x, 0, 0); }},
        {"ground", [](SceneSettings& s, double x) { s.ground->height = x; }},
        {"ground", [](SceneSettings& s, double x) { s.ground->rgb = Rgb(0, 0, x); }},
        {"ground",
         [](SceneSettings& s, double x) {
             s.ground->area = FlatArea::round({x, 0}, 1);
         }},
        {"ground",
         [](SceneSettings& s, double x) {
             s.ground->area = FlatArea::round({0, 0}, x);
         }},
        {"ground",
         [](SceneSettings& s, double x) {
             s.ground->area = FlatArea::rectangle({0, 0}, {1, x});
         }},
        {"sky", [](SceneSettings& s, double x) { s.sky->zenith.r = x; }},
        {"sky", [](SceneSettings& s, double x) { s.sky->horizon.r = x; }},
        {"sky", [](SceneSettings& s, double x) { s.sky->below.r = x; }},
        {"sky", [](SceneSettings& s, double x) { s.sky->turbidity = x; }},
        {"sky", [](SceneSettings& s, double x) { s.sky->clouds = x; }},
        {"sky", [](SceneSettings& s, double x) { s.sky->turn_deg = x; }},
        {"sky", [](SceneSettings& s, double x) { s.sky->brightness = x; }},
        {"film", [](SceneSettings& s, double x) { s.film->exposure = x; }},
        {"film", [](SceneSettings& s, double x) { s.film->white_k = x; }},
        {"haze", [](SceneSettings& s, double x) { s.haze->distance = x; }},
        {"haze", [](SceneSettings& s, double x) { s.haze->base = x; }},
        {"haze", [](SceneSettings& s, double x) { s.haze->height = x; }},
        {"haze", [](SceneSettings& s, double x) { s.haze->rgb = Rgb(0, x, 0); }},
        {"haze", [](SceneSettings& s, double x) { s.haze->sun = x; }},
    };
    SceneSettings whole;
    whole.camera.emplace();
    whole.lights.resize(2);
    whole.background.emplace();
    whole.ground.emplace();
    whole.sky.emplace();
    whole.film.emplace();
    whole.haze.emplace();
    int number = 0;
    for (const auto& [statement, spoil] : faults) {
        SCOPED_TRACE(number++);
        for (const double bad : {std::nan(""), HUGE_VAL}) {
            graph_.settings = whole;
            spoil(graph_.settings, bad);
            expect_flaw(root, "the " + std::string(statement) + " has a number that is not finite");
        }
    }
    graph_.settings = whole;
    EXPECT_TRUE(verify(graph_).empty());
}

TEST_F(Verify, AllFlawsOfAGraphAreFound) {
    first().tint.alpha = 2;
    graph_.objects[loop].instances[0].parent_from_child.translation.x = HUGE_VAL;
    EXPECT_EQ(verify(graph_).size(), 2u);
}

using VerifyCheck = Verify;

TEST_F(VerifyCheck, TheFaultNamesStageAndObject) {
    check_verified(graph_, "after pass x");
    graph_.objects[loop].instances.clear();
    EXPECT_BROKEN(check_verified(graph_, "after pass merge"),
                  "\\(after pass merge: object loop\\(3, -0.5\\): an empty union\\)");
    graph_.root = 99;
    EXPECT_BROKEN(check_verified(graph_, "after lowering"), "after lowering: object \\(none\\): the root is");
}

} // namespace
} // namespace graftal
