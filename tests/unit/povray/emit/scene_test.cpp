#include "compiler/povray/emit/scene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/primitives/tessellate.h"
#include "tests/unit/broken_invariant.h"
#include "tests/unit/povray/scene_by_hand.h"

namespace graftal {
namespace {

using namespace by_hand;
using testing::HasSubstr;
using testing::Not;

TEST(EmitPovray, BeginsWithTheVersionAndIsLinear) {
    const std::string text = one_sphere().text();
    EXPECT_EQ(text.rfind("#version 3.7;\n", 0), 0u);
    EXPECT_THAT(text, HasSubstr("assumed_gamma 1 "));
    EXPECT_EQ(count(text, "{"), count(text, "}"));
}

TEST(EmitPovray, IsTheSameEveryTime) {
    EXPECT_EQ(one_sphere().text(), one_sphere().text());
}

const Material glass{.diffuse = 0, .specular = 0.5, .reflection = 1, .transparency = 0.9, .ior = 1.5};

/// A ray that goes into one of them may come out of another.
TEST(EmitPovray, OneInteriorForAllThatHasIt) {
    Scene scene;
    const std::uint32_t sphere = scene.body(PrimitiveKind::sphere);
    const auto add = [&](Rgb rgb, const Material& material) {
        scene.group(scene.palette({rgb}), {{sphere, {}}, {sphere, place({2, 0, 0}, Vec3(1))}}).material =
            material;
    };
    add(Rgb(1), {});
    add({1, 0, 0}, glass);
    add({0, 1, 0}, glass);
    Material water = glass;
    water.ior = 1.33;
    water.rgb = {0.5, 1, 1};
    water.absorption = 2;
    add(Rgb(1), water);
    const std::string text = scene.text();
    EXPECT_EQ(count(text, "interior {"), 2);
    EXPECT_THAT(text, HasSubstr("interior { ior 1.5 } hollow"));
    EXPECT_THAT(text, HasSubstr("interior { ior 1.33 media { method 1 intervals 1 samples 1,1 absorption rgb "
                                "<0.000693147181,0,0> } } hollow"));
    EXPECT_THAT(text, HasSubstr("rgb <1,0,0> filter 0.9"));
    EXPECT_THAT(text, HasSubstr("transmit 0.9"));
    EXPECT_THAT(text, HasSubstr("max_trace_level 32"));
    EXPECT_EQ(count(text, "{"), count(text, "}"));
}

TEST(EmitPovray, ACoatIsALayerOfItsOwn) {
    Scene scene;
    Material lacquer = glass;
    lacquer.transparency = 0;
    scene.group(scene.palette({Rgb(0.5)}), {{scene.body(PrimitiveKind::sphere), {}}}).material = lacquer;
    const std::string text = scene.text();
    EXPECT_THAT(text, HasSubstr("texture { pigment { rgbt 1 } finish { F_default_coat } }"));
    EXPECT_THAT(text,
                HasSubstr("ambient 0 diffuse 0 specular 0.5 roughness 0.05 reflection { 0, 1 fresnel on } "
                          "conserve_energy"));
}

TEST(EmitPovray, MetalsHaveTheirColourInOneLayer) {
    Scene scene;
    PathTint tint;
    tint.premultiplied = {0.2, 0, 0};
    tint.alpha = 0.25;
    PlacementGroup& group = scene.group(scene.palette({Rgb(1), Rgb(0.5)}), {{scene.mesh("m", 2), {}}}, tint);
    group.material.metallic = 0.5;
    group.material.reflection = 0.75;
    const std::string text = scene.text();
    EXPECT_THAT(text, HasSubstr("average pigment_map { [0.75 P_1] [0.25 rgb <0.8,0,0>] }"));
    EXPECT_THAT(text, HasSubstr("specular 0.1 roughness 0.05 metallic 0.5 reflection { 0.75 metallic 0.5 }"));
}

TEST(EmitPovray, PrimitivesThatNeedNoMatrixHaveNone) {
    struct Case {
        Primitive kind = PrimitiveKind::sphere;
        Affine a;
        const char* text;
    };
    const Affine turned = Affine::rotate({0, 0, 1}, -90);
    const Case cases[] = {
        {PrimitiveKind::sphere, place({1, 0, 0}, Vec3(0.5)) * Affine::rotate({1, 2, 3}, 40),
         "sphere { <500,0,0>, 250"},
        {PrimitiveKind::sphere, place({0, 0, 0}, {-1, 1, 1}), "sphere { <0,0,0>, 500"},
        {PrimitiveKind::sphere, place({0, 0, 0}, {1, 1, 0.5}),
         "sphere { 0, 1 matrix <500,0,0,0,500,0,0,0,250,0,0,0>"},
        {PrimitiveKind::cube, place({1, 0, 0}, {1, 0.1, -0.2}), "box { <0,-50,-100>, <1000,50,100>"},
        {PrimitiveKind::cube, turned * Affine::scale({1, 0.1, 0.2}), "box { <-50,-500,-100>, <50,500,100>"},
        {PrimitiveKind::cube, {Mat3(1, 0, 0, 2, 0, 0, 0, 0, 1), Vec3(0)}, "box { -1, 1 matrix <"},
        {PrimitiveKind::cylinder, place({0, 1, 0}, {0.1, 2, 0.1}), "cylinder { <0,500,0>, <0,1500,0>, 50"},
        {PrimitiveKind::cylinder, turned * Affine::scale({1, 2, 1}), "cylinder { <0,0,0>, <1000,0,0>, 500"},
        {PrimitiveKind::cylinder,
         {Mat3(1, 0, 0, 0.1, 1, 0, 0, 0, 1), Vec3(0)},
         "cylinder { 0, y, 1 matrix <"},
        {PrimitiveKind::cone, place({0, 1, 0}, {0.1, 2, 0.1}), "cone { <0,500,0>, 50, <0,1500,0>, 0"},
        {PrimitiveKind::cone, place({0, 1, 0}, {0.1, 2, 0.2}), "cone { 0, 1, y, 0 matrix <"},
        {PrimitiveKind::torus, {}, "torus { 1, 0.25 matrix <500,"},
        {PrimitiveKind::plane, place({0, 1, 0}, {2, 3, 4}), "plane { <0,1,0>, 500"},
        {PrimitiveKind::plane, place({0, 1, 0}, {2, 3, -4}), "plane { <0,1,0>, 500"},
        {PrimitiveKind::plane, place({0, 1, 0}, {2, -3, 4}), "plane { <0,-1,0>, -500"},
        {PrimitiveKind::plane, turned * place({0, 1, 0}, {2, 3, 4}), "plane { <1,0,0>, 500"},
        {PrimitiveKind::plane, place({0, 1, 0}, {2, 0, 4}), "plane { y, 0 matrix <"},
        {PrimitiveKind::triangle, place({0, 0, 0}, {1, 2, 0}),
         "triangle { <0,1000,0>, <-433.012702,-500,0>, <433.012702,-500,0>"},
        {PrimitiveKind::triangle, place({0, 0, 0}, Vec3(1e-8)),
         "triangle { <0,1,0>, <-0.86602540378443865,-0.5,0>"},
        {PrimitiveKind::sphere, place({0, 0, 0}, Vec3(1e-8)), "sphere { 0, 1 matrix <"}};
    for (const Case& c : cases) {
        Scene scene;
        scene.group(scene.palette({Rgb(1)}), {{scene.body(c.kind), c.a}});
        EXPECT_THAT(scene.text(), HasSubstr(c.text)) << name_of(c.kind);
    }
}

TEST(EmitPovray, MeshesAreDeclaredOnceAndPlacedByMatrix) {
    Scene scene;
    const std::uint32_t leaf = scene.mesh("leaf(3)");
    scene.mesh("never placed");
    scene.group(scene.palette({Rgb(0, 1, 0)}), {{leaf, {}}, {leaf, place({1, 0, 0}, Vec3(0.5))}});
    const std::string text = scene.text();
    EXPECT_THAT(text, HasSubstr("// leaf(3): 2 triangles\n#declare M_leaf_3 = mesh2 {"));
    EXPECT_THAT(text, HasSubstr("vertex_vectors { 4,\n    <0,0,0>,<1,0,0>,<1,1,0>,<0,1,0> }"));
    EXPECT_THAT(text, HasSubstr("face_indices { 2,\n    <0,1,2>,<0,2,3> }"));
    EXPECT_THAT(text, HasSubstr("union {\nobject { M_leaf_3 matrix <500,0,0,0,500,0,0,0,500,0,0,0> }\n"
                                "object { M_leaf_3 matrix <250,0,0,0,250,0,0,0,250,500,0,0> }\n"
                                "  texture { pigment { rgb <0,1,0> } finish { F_default } }\n}"));
    EXPECT_EQ(count(text, "mesh2"), 1u);
    EXPECT_THAT(text, Not(HasSubstr("uv_")));
    EXPECT_THAT(text, Not(HasSubstr("normal_vectors")));
}

TEST(EmitPovray, SmoothMeshesHaveNormals) {
    Scene scene;
    const TessellatedPrimitive& sphere = tessellated(PrimitiveKind::sphere, 0);
    Mesh mesh;
    mesh.vertices = sphere.vertices;
    mesh.normals = sphere.normals;
    mesh.triangles = sphere.triangles;
    scene.cut.bodies.push_back({"ball", mesh});
    scene.group(scene.palette({Rgb(0, 1, 0)}), {{0, {}}});
    EXPECT_THAT(scene.text(), HasSubstr("normal_vectors { 6,\n    <1,0,0>,<-1,0,0>"));
}

TEST(EmitPovray, FlattenedPlacementsCanBeInverted) {
    Scene scene;
    scene.group(scene.palette({Rgb(1)}), {{scene.mesh("leaf"), place({0, 0, 0}, {1, 1, 0})}});
    EXPECT_THAT(scene.text(), HasSubstr("matrix <500,0,0,0,500,0,0,0,0.0005,0,0,0>"));
}

constexpr const char* clear_within = "interior_texture { pigment { rgbt 1 } }";

// From within, the far face of a sheet is clear: light comes through the sheet once.
TEST(EmitPovray, TranslucentSheetsAreOneSurface) {
    for (const double thickness : {0.002, 0.0}) {
        Scene scene;
        const std::uint32_t disc = scene.body(PrimitiveKind::cylinder);
        scene.group(scene.palette({Rgb(1)}), {{disc, place({0, 0, 0}, {1, thickness, 1})}})
            .material.translucency = 0.5;
        EXPECT_EQ(count(scene.text(), clear_within), 1u);
        EXPECT_EQ(count(scene.text(), "union"), 0u);
    }
}

TEST(EmitPovray, OtherSolidsAreOpaqueWithin) {
    const auto text_of = [](Vec3 size, const Material& material) {
        Scene scene;
        scene.group(scene.palette({Rgb(1)}), {{scene.body(PrimitiveKind::cylinder), place({0, 0, 0}, size)}})
            .material = material;
        return scene.text();
    };
    EXPECT_EQ(count(text_of({1, 1, 1}, {.translucency = 0.5}), clear_within), 0u);
    EXPECT_EQ(count(text_of({1, 0.002, 1}, {}), clear_within), 0u);
    EXPECT_EQ(count(text_of({1, 0.002, 1}, {.translucency = 0.5, .transparency = 0.5}), clear_within), 0u);
}

TEST(EmitPovray, SheetsHaveAUnionBesideThatOfOtherSolids) {
    Scene scene;
    const std::uint32_t body = scene.body(PrimitiveKind::cylinder);
    const Affine thick = place({0, 0, 0}, {1, 1, 1}), thin = place({0, 0, 0}, {1, 0.002, 1});
    scene.group(scene.palette({Rgb(1)}), {{body, thick}, {body, thin}, {body, thin}, {body, thick}})
        .material.translucency = 0.5;
    for (const bool include : {false, true}) {
        scene.options.include = include;
        const std::string text = scene.text();
        EXPECT_EQ(count(text, "{"), count(text, "}"));
        EXPECT_EQ(count(text, clear_within), 1u);
        EXPECT_EQ(count(text, "union {"), 3u);
        EXPECT_EQ(count(text, "cylinder {"), 4u);
    }
}

TEST(EmitPovray, GroupsThatLookAlikeShareAUnion) {
    Scene scene;
    const std::uint32_t ball = scene.body(PrimitiveKind::sphere);
    scene.group(scene.palette({Rgb(0.5)}), {{ball, {}}});
    scene.group(scene.palette({Rgb(0.9)}), {{ball, {}}});
    scene.group(scene.palette({Rgb(0)}), {{ball, {}}}, PathTint(Tint{Rgb(1), 0.5}));
    const std::string text = scene.text();
    EXPECT_EQ(count(text, "union {"), 1u);
    EXPECT_EQ(count(text, "rgb <0.5,0.5,0.5>"), 1u);
    EXPECT_EQ(count(text, "sphere { <"), 3u);
}

TEST(EmitPovray, OnePlacementIsNoUnion) {
    EXPECT_THAT(one_sphere().text(), Not(HasSubstr("union")));
}

TEST(EmitPovray, PlanesAreObjectsOfTheirOwn) {
    Scene scene;
    const std::uint32_t plane = scene.body(PrimitiveKind::plane), ball = scene.body(PrimitiveKind::sphere);
    scene.group(scene.palette({Rgb(0.5)}), {{plane, {}}, {ball, {}}, {ball, {}}, {plane, {}}, {ball, {}}});
    const std::string text = scene.text();
    const std::size_t begin = text.find("union {"), end = text.find("\n}\n", begin);
    EXPECT_EQ(count(text.substr(begin, end - begin), "sphere {"), 3u);
    EXPECT_EQ(count(text.substr(begin, end - begin), "plane {"), 0u);
    EXPECT_EQ(count(text, "plane {"), 2u);
}

TEST(EmitPovray, TintsOverOneColourAreComposedByEquations9And10) {
    Scene scene;
    const PathTint tint = PathTint(Tint{Rgb(1, 0, 0), 0.5}) * PathTint(Tint{Rgb(0, 1, 0), 0.25});
    scene.group(scene.palette({Rgb(0.8)}), {{scene.body(PrimitiveKind::sphere), {}}}, tint);
    // 0.5 red + 0.5 (0.25 green + 0.75 * 0.8)
    EXPECT_THAT(scene.text(), HasSubstr("rgb <0.8,0.425,0.3>"));
}

TEST(EmitPovray, TintsOverPalettesAreALayerThatAloneShines) {
    Scene scene;
    const std::uint32_t colours = scene.palette({Rgb(0.1), Rgb(0.2), Rgb(0.3)});
    const std::uint32_t leaf = scene.mesh("leaf", 3);
    scene.group(colours, {{leaf, {}}}, PathTint(Tint{Rgb(1, 0.5, 0), 0.25})).material.reflection = 0.5;
    const std::string text = scene.text();
    EXPECT_THAT(text, HasSubstr("#declare P_1 = pigment { uv_mapping gradient x color_map {"));
    EXPECT_THAT(
        text,
        HasSubstr("texture { pigment { P_1 } finish { F_default_matt } }\n"
                  "          texture { pigment { rgb <1,0.5,0> transmit 0.75 } finish { F_default } }"));
    EXPECT_THAT(text, HasSubstr("F_default_matt = finish { ambient 0.1 diffuse 0.8 }"));
    EXPECT_THAT(
        text,
        HasSubstr(
            "F_default = finish { ambient 0.1 diffuse 0.8 specular 0.1 roughness 0.05 reflection 0.5 }"));
    EXPECT_THAT(text, HasSubstr("uv_vectors { 2,\n    <0.833333333,0.5>,<0.166666667,0.5> }"));
    EXPECT_THAT(text, HasSubstr("uv_indices { 2,\n    <0,0,0>,<1,1,1> }"));
}

TEST(EmitPovray, TintsThatHideAlmostAllStillShowWhatIsBelow) {
    for (const double alpha : {0.99, 0.999}) {
        Scene scene;
        const std::uint32_t colours = scene.palette({Rgb(0.1), Rgb(0.2), Rgb(0.3)});
        scene.group(colours, {{scene.mesh("leaf", 3), {}}}, PathTint(Tint{Rgb(1, 0.5, 0), alpha}));
        const std::size_t expected = alpha > 1 - 1.0 / 255;
        EXPECT_EQ(count(scene.text(), "global_settings { assumed_gamma 1 adc_bailout 1e-6 }"), expected);
        scene.options.include = true;
        EXPECT_EQ(count(scene.text(), "with assumed_gamma 1 and adc_bailout 1e-6:\n"), expected);
    }
}

TEST(EmitPovray, TintsThatHideAllOrNothingAreOneLayer) {
    for (const double alpha : {0.0, 1.0}) {
        Scene scene;
        const std::uint32_t colours = scene.palette({Rgb(0.1), Rgb(0.2), Rgb(0.3)});
        scene.group(colours, {{scene.mesh("leaf", 3), {}}}, PathTint(Tint{Rgb(1, 0.5, 0), alpha}));
        const std::string text = scene.text();
        EXPECT_EQ(count(text, "texture {"), 1u);
        EXPECT_EQ(count(text, "P_1"), alpha == 0 ? 2u : 0u);
        EXPECT_EQ(count(text, "transmit"), 0u);
        EXPECT_THAT(text, HasSubstr("finish { F_default }"));
    }
}

TEST(EmitPovray, LargePalettesArePicturesBesideTheScene) {
    Scene scene;
    scene.options.scene_name = "a/b c";
    Palette many;
    for (int i = 0; i < 200; ++i)
        many.emplace_back(i / 200.0);
    const std::uint32_t first = scene.palette(many), second = scene.palette(Palette(200, Rgb(0.5)));
    const std::uint32_t leaf = scene.mesh("leaf", 200);
    scene.group(first, {{leaf, {}}});
    scene.group(second, {{leaf, {}}});
    scene.group(first, {{leaf, {}}}, PathTint(Tint{Rgb(1), 0.5}));
    const std::string text = scene.text();
    ASSERT_EQ(scene.pictures.size(), 2u);
    EXPECT_EQ(scene.pictures[0].file_name, "a_b_c_P_1.png");
    EXPECT_EQ(scene.pictures[1].file_name, "a_b_c_P_2.png");
    EXPECT_EQ(count(text, "image_map { png \"a_b_c_P_1.png\" gamma 1.0 }"), 1u);
    EXPECT_EQ(scene.pictures[0].pixels[7], many[7]);
    scene.options = {.scene_name = "a.rifs", .include = true, .file_name = "far.inc"};
    scene.text();
    EXPECT_EQ(scene.pictures[0].file_name, "far_P_1.png") << "beside others of the same model";
    scene.options = {.scene_name = "a.rifs", .file_name = "near.pov"};
    scene.text();
    EXPECT_EQ(scene.pictures[0].file_name, "near_P_1.png");
}

TEST(EmitPovray, TextOfTheModelNeverBecomesSdl) {
    Scene scene = one_sphere();
    const std::string evil = "x\n#include \"secret\"\n} */ ; #declare Sphere";
    scene.options.scene_name = evil;
    scene.group(scene.palette({Rgb(0.1), Rgb(1)}), {{scene.mesh(evil, 2), {}}}).material.name = evil;
    scene.options.file_name = evil;
    for (const bool include : {false, true}) {
        scene.options.include = include;
        const std::string text = scene.text();
        EXPECT_EQ(count(text, "\n#include"), 0u);
        EXPECT_EQ(count(text, "\"secret"), 0u);
        EXPECT_EQ(count(text, "*/"), 0u);
        EXPECT_EQ(count(text, "#declare Sphere"), 0u);
        EXPECT_EQ(count(text, "{"), count(text, "}"));
    }
}

/// What POV-Ray reads.
std::string without_comments(const std::string& text) {
    std::string out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("//")) out += line + "\n";
    return out;
}

TEST(EmitPovray, IncludesDeclareTheObjectAndDrawNothing) {
    Scene scene = one_sphere();
    scene.options = {.scene_name = "union.rifs", .include = true, .file_name = "a.inc"};
    scene.cut.bounds = {{-1, 0, 0.1}, {1, 2, 3}};
    scene.group(scene.palette({Rgb(0.1), Rgb(1)}), {{scene.mesh("leaf", 2), place({1, 0, 0}, Vec3(1))}});
    const std::string text = scene.text(), sdl = without_comments(text);
    for (const char* const word : {"camera {", "light_source", "background", "sky_sphere", "global_settings"})
        EXPECT_THAT(text, Not(HasSubstr(word)));
    EXPECT_THAT(sdl, HasSubstr("#declare Union =\nunion {\nsphere { <0,0,0>, 1\n"));
    EXPECT_THAT(sdl, HasSubstr("object { Union_M_leaf matrix <1,0,0,0,1,0,0,0,1,1,0,0>"));
    EXPECT_THAT(sdl, HasSubstr("#declare Union_min = <-1,0,0.1>;\n#declare Union_max = <1,2,3>;\n"));
    EXPECT_EQ(count(sdl, "#declare Union"), count(sdl, "#declare")) << "no name but its own";
    EXPECT_EQ(count(sdl, "{"), count(sdl, "}"));
    EXPECT_THAT(text, HasSubstr("//     #include \"a.inc\"\n"));
    EXPECT_THAT(text, HasSubstr("povray +LFOLDER"));

    // A union of one would be a warning.
    Scene single = one_sphere();
    single.options = {.scene_name = "ball", .include = true};
    EXPECT_THAT(single.text(), HasSubstr("#declare Ball =\nsphere {"));

    scene.options.identifier = "Other";
    EXPECT_EQ(count(without_comments(scene.text()), "Union"), 0u);
}

TEST(EmitPovray, TexturesOfIncludesCanBeDeclaredBefore) {
    Scene scene = one_sphere();
    scene.options = {.scene_name = "tree", .include = true};
    const std::uint32_t grey = scene.palette({Rgb(0.5)}), ball = scene.body(PrimitiveKind::sphere);
    const std::string one = scene.text();
    EXPECT_THAT(one, HasSubstr("#ifndef (Tree_T_default)\n#declare Tree_T_default = texture {"));
    EXPECT_THAT(one, HasSubstr("\n  texture { Tree_T_default } }\n"))
        << "its own, so that one around it hides it";
    EXPECT_THAT(one, HasSubstr("// For a texture of your own: object { Tree texture { ... } }\n"));

    // Two materials, one of them under two tints; a third that looks like the second.
    scene.group(grey, {{ball, {}}}).material.name = "wood";
    scene.group(grey, {{ball, {}}}, PathTint(Tint{Rgb(1, 0, 0), 0.5})).material.name = "wood";
    scene.group(grey, {{ball, {}}}).material.name = "leaf";
    const std::string text = scene.text(), sdl = without_comments(text);
    EXPECT_THAT(sdl, HasSubstr("#ifndef (Tree_T_wood)\n#declare Tree_T_wood_2 = texture {"));
    EXPECT_THAT(sdl, HasSubstr("#else\n#declare Tree_T_wood_2 = texture { Tree_T_wood }\n"
                               "#declare Tree_T_wood_3 = texture { Tree_T_wood }\n#end\n"));
    EXPECT_THAT(sdl, HasSubstr("#ifndef (Tree_T_leaf)\n#declare Tree_T_leaf = texture {"));
    EXPECT_THAT(sdl, HasSubstr("#ifndef (Tree_bare) texture { Tree_T_leaf } #end"));
    EXPECT_THAT(text, HasSubstr("//     #declare Tree_T_wood = texture { ... }\n"));
    EXPECT_THAT(text, HasSubstr("//     #declare Tree_bare = yes;"));
}

TEST(EmitPovray, ProgressCountsToAHundred) {
    Scene scene;
    const std::uint32_t ball = scene.body(PrimitiveKind::sphere), leaf = scene.mesh("leaf");
    PlacementGroup& group = scene.group(scene.palette({Rgb(1)}), {});
    for (int i = 0; i < 5000; ++i)
        group.placements.push_back({i % 2 ? ball : leaf, place({i / 5000.0, 0, 0}, Vec3(0.01))});
    scene.cut.placement_count = 5000;
    EXPECT_EQ(count(scene.text(), "#debug"), 0u);
    scene.options.progress = true;
    const std::string text = scene.text();
    int last = 0, marks = 0;
    for (std::size_t at = text.find("#debug"); at != std::string::npos; at = text.find("#debug", at + 1)) {
        const int percent = std::atoi(text.c_str() + at + 10);
        EXPECT_EQ(text.substr(at - 1, 11), "\n#debug \"@@");
        EXPECT_GT(percent, last);
        last = percent;
        ++marks;
    }
    EXPECT_EQ(last, 100);
    EXPECT_GE(marks, 95);
    EXPECT_LE(marks, 100);
}

TEST(EmitPovray, SinksMayStopAtAnyPiece) {
    Scene scene;
    const std::uint32_t ball = scene.body(PrimitiveKind::sphere);
    PlacementGroup& group = scene.group(scene.palette({Rgb(1)}), {});
    for (int i = 0; i < 50'000; ++i)
        group.placements.push_back({ball, place({i / 5e4, 0, 0}, Vec3(0.01))});
    std::size_t pieces = 0;
    const auto emit = [&](std::size_t allowed) {
        pieces = 0;
        return emit_povray(
            scene.cut, scene.view(), scene.options, [&](std::string_view) { return ++pieces < allowed; },
            scene.pictures);
    };
    EXPECT_TRUE(emit(SIZE_MAX));
    const std::size_t all = pieces;
    EXPECT_GT(all, 5u);
    for (std::size_t allowed = 1; allowed <= all; ++allowed) {
        EXPECT_FALSE(emit(allowed));
        EXPECT_EQ(pieces, allowed);
    }
}

TEST(EmitPovray, BrokenCutsAreBugs) {
    Scene scene;
    scene.group(scene.palette({Rgb(1)}), {{7, {}}});
    EXPECT_BROKEN(scene.text(), "without a body");
    Scene empty;
    empty.cut.bodies.push_back({"none", Mesh{}});
    empty.group(empty.palette({Rgb(1)}), {{0, {}}});
    EXPECT_BROKEN(empty.text(), "without triangles");
    Scene nan = one_sphere();
    nan.cut.groups[0].placements[0].world_from_body.translation.x = std::nan("");
    EXPECT_BROKEN(nan.text(), "finite");
}

TEST(EmitPovray, APictureLiesOnTheGround) {
    Scene scene;
    scene.group(scene.palette({Rgb(1)}), {});
    View view;
    view.ground = Ground{.height = 3, .material = {.texture = "soil.png", .around = 4}};
    std::string text = scene.text(view);
    EXPECT_THAT(text, HasSubstr("image_map { png \"model_I_1.png\" }"));
    EXPECT_THAT(text, HasSubstr("texture { pigment { I_1 matrix <"));
    EXPECT_THAT(text, Not(HasSubstr("_shape")));
    view.ground->material.coverage = 0.9;
    text = scene.text(view);
    EXPECT_THAT(text, HasSubstr("pigment_pattern { I_1_shape }"));
    EXPECT_THAT(text, HasSubstr("[0.5 pigment { I_1 } finish"));
    EXPECT_THAT(text, HasSubstr("}] } matrix <"));
    ASSERT_FALSE(scene.pictures.empty());
    EXPECT_EQ(scene.pictures[0].texture, "soil.png");
}

// With use_alpha POV-Ray's pattern is 1 where the picture is clear; tests/image looks at what comes of it.
TEST(EmitPovray, PicturesLieBehindTints) {
    Scene scene;
    const std::uint32_t mesh = scene.mesh("bark");
    std::get<Mesh>(scene.cut.bodies[mesh].shape).uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const std::uint32_t white = scene.palette({Rgb(1)});
    for (const double alpha : {0.0, 0.25, 1.0}) {
        PlacementGroup& group = scene.group(white, {{mesh, {}}}, {alpha * Rgb(0, 1, 0), alpha});
        group.material.texture = "any \"picture\".png";
        group.material.coverage = 0.5;
    }
    const std::string text = scene.text();
    EXPECT_THAT(text, HasSubstr("uv_vectors { 4,\n    <0,0>,<1,0>,<1,1>,<0,1> }"));
    EXPECT_THAT(text, HasSubstr("#declare I_1 = pigment { image_map { png \"model_I_1.png\" } }"));
    EXPECT_THAT(text, HasSubstr("[0.5 pigment { I_1 } finish { F_default }] } }"));
    EXPECT_THAT(text, HasSubstr("{ average pigment_map { [0.75 I_1] [0.25 rgb <0,1,0>] } } finish"));
    EXPECT_THAT(text, HasSubstr("[0.5 pigment { rgb <0,1,0> } finish"));
    EXPECT_THAT(text, Not(HasSubstr("any")));
    ASSERT_EQ(scene.pictures.size(), 1u);
    EXPECT_EQ(scene.pictures[0].file_name, "model_I_1.png");
    EXPECT_EQ(scene.pictures[0].texture, "any \"picture\".png");

    // Nothing is cut out of pictures that have no clear parts.
    for (PlacementGroup& group : scene.cut.groups)
        group.material.coverage = 1;
    const std::string opaque = scene.text();
    EXPECT_THAT(opaque, HasSubstr("texture { pigment { uv_mapping I_1 } finish { F_default } }"));
    EXPECT_THAT(opaque, HasSubstr("pigment { uv_mapping average pigment_map { [0.75 I_1] "));
    EXPECT_THAT(opaque, HasSubstr("texture { pigment { rgb <0,1,0> } finish"));
    EXPECT_THAT(opaque, Not(HasSubstr("_shape")));
}

} // namespace
} // namespace graftal
