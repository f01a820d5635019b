#include "compiler/graph/text/print.h"

#include <gtest/gtest.h>

#include "tests/unit/primitives/all_primitives.h"

namespace graftal {
namespace {

Instance placed(ObjectId master, const Affine& parent_from_child = {}) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = parent_from_child;
    return instance;
}

ObjectId add_union(Graph& graph, const char* name, std::vector<Instance> instances) {
    Object object;
    object.name = name;
    object.instances = std::move(instances);
    return graph.add(std::move(object));
}

TEST(Print, ObjectsInOrderInstancesGroupedAsHartWritesThem) {
    Graph graph;
    const ObjectId triangle = graph.primitive(PrimitiveKind::triangle);
    const ObjectId gasket = add_union(graph, "gasket", {});
    const Affine half = Affine::scale(Vec3(0.5));
    const ObjectId up = add_union(graph, "up", {placed(gasket, Affine::translate({0, 0.5, 0}) * half)});
    const ObjectId tip = add_union(graph, "tip(3, -0.5)", {placed(triangle)});
    graph.objects[gasket].instances = {placed(up), placed(up), placed(tip, half), placed(triangle, half),
                                       placed(up)};
    graph.objects[gasket].terminal = placed(tip);
    graph.objects[gasket].terminal_px = 7.5;
    graph.root = gasket;
    EXPECT_EQ(print(graph), "object gasket {\n"
                            "  union: up, up\n"
                            "  union: tip(3, -0.5), triangle\n"
                            "    matrix: 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0\n"
                            "  instance: up\n"
                            "  terminal: tip(3, -0.5)\n"
                            "  below: 7.5\n"
                            "}\n\n"
                            "canonical object up {\n"
                            "  instance: gasket\n"
                            "    matrix: 0.5, 0, 0, 0, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0\n"
                            "}\n\n"
                            "canonical object tip(3, -0.5) {\n"
                            "  instance: triangle\n"
                            "}\n\n");
}

TEST(Print, MatricesGoRowByRowAndFlatOnesAreProjections) {
    Graph graph;
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Affine a;
    a.linear = Mat3(11, 21, 31, 12, 22, 32, 13, 23, 34); // m[column][row]
    a.translation = {14, 24, 0.1};
    graph.root = add_union(graph, "a",
                           {placed(cube, a), placed(cube, Affine::scale({1, 1, 0})),
                            placed(cube, Affine::scale(Vec3(-0.0, -0.0, 1e-200)))});
    EXPECT_EQ(print(graph), "object a {\n"
                            "  instance: cube\n"
                            "    matrix: 11, 12, 13, 14, 21, 22, 23, 24, 31, 32, 34, 0.1\n"
                            "  instance: cube\n"
                            "    projection: 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0\n"
                            "  instance: cube\n"
                            "    projection: 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1e-200, 0\n"
                            "}\n\n");
}

TEST(Print, ChancesThatAreStated) {
    Graph graph;
    const ObjectId cone = graph.primitive(PrimitiveKind::cone);
    Instance rare = placed(cone), never = rare, often = rare;
    rare.chance = 0.1;
    often.chance = 2;
    graph.root = add_union(graph, "a", {rare, rare, never, often});
    EXPECT_EQ(print(graph), "object a {\n"
                            "  union: cone, cone\n"
                            "    chance: 0.1\n"
                            "  instance: cone\n"
                            "  instance: cone\n"
                            "    chance: 2\n"
                            "}\n\n");
    Graph other = graph;
    EXPECT_TRUE(equal(graph, other));
    other.objects[other.root].instances[3].chance = 1;
    EXPECT_FALSE(equal(graph, other));
}

TEST(Print, TintsAndMaterials) {
    Graph graph;
    graph.materials.push_back({});
    graph.materials[0].name = "bark";
    const ObjectId cone = graph.primitive(PrimitiveKind::cone);
    Instance plain = placed(cone), clear = plain, brown = plain;
    clear.tint = {{1, 0, 0}, 0}; // draws nothing, but is not the default
    brown.tint = {{0.5, 0.25, 0}, 0.9};
    brown.material = 0;
    graph.root = add_union(graph, "a", {plain, clear, brown});
    graph.objects[graph.root].terminal = brown;
    EXPECT_EQ(print(graph), "material bark {\n"
                            "  color: 0.8, 0.8, 0.8\n"
                            "  ambient: 0.1\n"
                            "  diffuse: 0.8\n"
                            "  specular: 0.1\n"
                            "  roughness: 0.05\n"
                            "  reflection: 0\n"
                            "}\n\n"
                            "object a {\n"
                            "  instance: cone\n"
                            "  instance: cone\n"
                            "    tint: 1, 0, 0, 0\n"
                            "  instance: cone\n"
                            "    tint: 0.5, 0.25, 0, 0.9\n"
                            "    material: bark\n"
                            "  terminal: cone\n"
                            "    tint: 0.5, 0.25, 0, 0.9\n"
                            "    material: bark\n"
                            "}\n\n");
}

TEST(Print, SceneStatements) {
    Graph graph;
    graph.root = add_union(graph, "a", {placed(graph.primitive(PrimitiveKind::sphere))});
    SceneSettings& settings = graph.settings;
    settings.camera.emplace();
    settings.camera->location = Vec3(0, 1, -5);
    settings.camera->look_at = Vec3(0.0);
    settings.camera->up = Vec3(0, 0, 1);
    settings.camera->angle_deg = 40.5;
    settings.camera->orthographic = true;
    settings.camera->width = 3;
    settings.lights = {{Vec3(1, 2, 3), false, Rgb(1.0), true}, {Vec3(0, 1, 0), true, Rgb(0.5, 0, 0), false}};
    settings.background = BackgroundSetting{Rgb(0, 0, 1), Rgb(1.0)};
    settings.ground = GroundSetting{-0.5, "grass", Rgb(0, 1, 0)};
    settings.steps = 4000000000u;
    const std::string text = print(graph);
    EXPECT_EQ(text.substr(0, text.find("\n\n")), "camera {\n"
                                                 "  location: 0, 1, -5\n"
                                                 "  look_at: 0, 0, 0\n"
                                                 "  up: 0, 0, 1\n"
                                                 "  angle: 40.5\n"
                                                 "  orthographic\n"
                                                 "  width: 3\n"
                                                 "}\n"
                                                 "light {\n"
                                                 "  location: 1, 2, 3\n"
                                                 "  color: 1, 1, 1\n"
                                                 "  shadowless\n"
                                                 "}\n"
                                                 "light {\n"
                                                 "  sun: 0, 1, 0\n"
                                                 "  color: 0.5, 0, 0\n"
                                                 "}\n"
                                                 "background {\n"
                                                 "  zenith: 0, 0, 1\n"
                                                 "  horizon: 1, 1, 1\n"
                                                 "}\n"
                                                 "ground {\n"
                                                 "  height: -0.5\n"
                                                 "  material: grass\n"
                                                 "  color: 0, 1, 0\n"
                                                 "}\n"
                                                 "steps: 4000000000");
    settings = {};
    settings.camera = CameraSetting{};
    settings.background = BackgroundSetting{Rgb(1, 0.5, 0), {}};
    EXPECT_TRUE(print(graph).starts_with("camera {\n}\nbackground: 1, 0.5, 0\n\nobject a {\n"));
}

TEST(Equal, SeesEveryDifferenceThatCounts) {
    Graph graph;
    graph.materials.push_back({});
    graph.materials[0].name = "m";
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId b = add_union(graph, "b", {placed(sphere), placed(sphere, Affine::scale(Vec3(2.0)))});
    graph.root = add_union(graph, "a", {placed(b)});
    EXPECT_TRUE(equal(graph, graph));

    Graph spans = graph;
    spans.objects[b].span = spans.objects[b].instances[0].span = {0, 1, 2};
    EXPECT_TRUE(equal(graph, spans)) << "spans do not count";
    Graph zeros = graph;
    zeros.objects[b].instances[0].parent_from_child.translation.x = -0.0;
    EXPECT_TRUE(equal(graph, zeros)) << "-0 is 0";

    const auto differs = [&](auto change) {
        Graph other = graph;
        change(other);
        return !equal(graph, other) && !equal(other, graph);
    };
    EXPECT_TRUE(differs([&](Graph& g) { g.root = b; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.objects[b].name = "c"; }));
    EXPECT_TRUE(differs([&](Graph& g) { std::swap(g.objects[b].instances[0], g.objects[b].instances[1]); }));
    EXPECT_TRUE(differs([&](Graph& g) { g.objects[b].instances.pop_back(); }));
    EXPECT_TRUE(
        differs([&](Graph& g) { g.objects[b].instances[0].parent_from_child.linear[0][0] = 1 + 2.3e-16; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.objects[b].instances[0].tint.rgb.r = 1; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.objects[b].instances[0].material = 0; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.objects[b].terminal = placed(sphere); }));
    EXPECT_TRUE(differs([&](Graph& g) { g.objects[b].terminal_px = 3; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.materials[0].roughness = 1; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.settings.steps = 3; }));
    EXPECT_TRUE(differs([&](Graph& g) { g.primitive(PrimitiveKind::cone); }));
}

TEST(Primitive, IsMadeOnceAndNamesGoBothWays) {
    Graph graph;
    const ObjectId first = graph.primitive(PrimitiveKind::torus);
    EXPECT_EQ(graph.primitive(PrimitiveKind::torus), first);
    EXPECT_NE(graph.primitive(PrimitiveKind::cone), first);
    for (const Primitive& primitive : test::all_primitives())
        EXPECT_EQ(primitive_named(name_of(primitive)), primitive);
    EXPECT_EQ(primitive_named("frustum"), std::nullopt);
    EXPECT_EQ(primitive_named("Sphere"), std::nullopt);
    EXPECT_EQ(primitive_named(""), std::nullopt);
}

} // namespace
} // namespace graftal
