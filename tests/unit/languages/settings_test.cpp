// Scene statements and lets, through the .inst front-end.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/languages/lower.h"
#include "compiler/lower/named_materials.h"
#include "compiler/support/files.h"
#include "compiler/support/texture_facts.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

struct Model {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph;

    explicit Model(const std::string& statements, const LowerOptions& options = {}) {
        graph = lower_text("m.inst", statements + "\nobject top { sphere scale: 2 }\n", options, sources,
                           diagnostics)
                    .graph;
    }
    std::string errors() const { return diagnostics.render(sources); }
    const SceneSettings& settings() const { return graph->settings; }
};

TEST(Settings, LightsAreAsBrightAsOneLikes) {
    const Model model("light { sun: 0, 1, 0  color: 5, 40.5, 0 }");
    ASSERT_TRUE(model.graph) << model.errors();
    EXPECT_EQ(model.settings().lights[0].rgb, Rgb(5, 40.5, 0));
    EXPECT_NE(Model("light { sun: 0, 1, 0  color: 5, -1, 0 }").errors().find("brightness of a light"),
              std::string::npos);
}

TEST(Settings, all_statements) {
    const Model model(R"(
        camera { location: 3, 2, 5  look_at: <0, 1, 0>  up: 0, 0, 1  angle: 40 }
        light { location: 10, 20, 30  color: 1, 0.5, 0.25  shadowless }
        light { sun: 1, 2, 3 }
        background { zenith: 0.2, 0.4, 0.9  horizon: rgb <1, 1, 1> }
        ground { height: -2  color: 0.1, 0.2, 0.3  material: stone }
        material stone { color: 0.5, 0.5, 0.5  ambient: .2 diffuse: .7 specular: .3 roughness: .01 reflection: .4 }
        steps: 12)");
    ASSERT_TRUE(model.graph) << model.errors();
    CameraSetting camera;
    camera.location = Vec3(3, 2, 5);
    camera.look_at = Vec3(0, 1, 0);
    camera.up = Vec3(0, 0, 1);
    camera.angle_deg = 40;
    EXPECT_EQ(model.settings().camera, camera);
    ASSERT_EQ(model.settings().lights.size(), 2u);
    EXPECT_EQ(model.settings().lights[0], (LightSetting{{10, 20, 30}, false, {1, 0.5, 0.25}, true}));
    EXPECT_EQ(model.settings().lights[1], (LightSetting{{1, 2, 3}, true, {1, 1, 1}, false}));
    EXPECT_EQ(model.settings().background, (BackgroundSetting{{0.2, 0.4, 0.9}, Rgb(1, 1, 1)}));
    EXPECT_EQ(model.settings().ground, (GroundSetting{-2, "stone", Rgb(0.1, 0.2, 0.3)}));
    EXPECT_EQ(model.settings().steps, 12u);
    ASSERT_EQ(model.graph->materials.size(), 1u);
    EXPECT_EQ(model.graph->materials[0], (Material{"stone", Rgb(0.5), .2, .7, .3, .01, .4, {}}));
}

const Material* material_of(const std::optional<Graph>& graph, std::string_view name) {
    if (!graph) return nullptr;
    const auto found = std::ranges::find(graph->materials, name, &Material::name);
    return found == graph->materials.end() ? nullptr : &*found;
}

TEST(Settings, EveryLanguageKnowsTheNamedMaterials) {
    for (const Material& material : named_materials()) {
        SCOPED_TRACE(material.name);
        const std::string name = material.name;
        for (const auto& [file, text] :
             {std::pair<std::string, std::string>{"m.inst", "object a { sphere material " + name + " }"},
              {"m.inst", "ground { material: " + name + " } object a { sphere }"},
              {"m.rifs", "rifs r { map a { scale 1/2 } terminal sphere material " + name + " }"},
              {"m.lsys", "lsys a {\nsteps 1\nwidth 0.1\ncolors " + name + "\naxiom F\n}"}}) {
            SourceMap sources;
            Diagnostics diagnostics;
            const std::optional<Graph> graph = lower_text(file, text, {}, sources, diagnostics).graph;
            ASSERT_TRUE(graph) << diagnostics.render(sources);
            ASSERT_TRUE(material_of(graph, name)) << file;
            EXPECT_EQ(*material_of(graph, name), material) << file;
        }
    }
}

TEST(Settings, AMaterialOfTheFileTakesPrecedence) {
    const Model model("material gold { color: 0, 0, 1 }\nobject a { sphere material gold }");
    ASSERT_TRUE(model.graph) << model.errors();
    ASSERT_EQ(model.graph->materials.size(), 1u);
    EXPECT_EQ(model.graph->materials[0].rgb, Rgb(0, 0, 1));
    EXPECT_EQ(model.graph->materials[0].metallic, 0);
}

TEST(Settings, AMaterialMayStartFromAnother) {
    const Model model("material gold { from: gold  roughness: 0.5 }\n"
                      "material brass { from: gold  color: 0.8, 0.6, 0.2 }\n"
                      "material pond { from: water  absorption: 3 }\n"
                      "material ice { from: pond  transparency: 0 }");
    ASSERT_TRUE(model.graph) << model.errors();
    const Material &gold = *material_of(model.graph, "gold"), &brass = *material_of(model.graph, "brass");
    EXPECT_EQ(gold.metallic, 1);
    EXPECT_EQ(gold.roughness, 0.5);
    EXPECT_EQ(brass.roughness, 0.5);
    EXPECT_EQ(brass.rgb, Rgb(0.8, 0.6, 0.2));
    EXPECT_EQ(material_of(model.graph, "pond")->absorption, 3);
    EXPECT_EQ(material_of(model.graph, "ice")->absorption, 0) << "nothing goes through";
}

TEST(Settings, AnIndexOfRefractionBringsItsReflection) {
    const Model model("material a { ior: 1.5 }\nmaterial b { ior: 1.5 reflection: 0.2 }\n"
                      "material c { ior: 1 }\nmaterial d { from: glass ior: 1.3 }");
    ASSERT_TRUE(model.graph) << model.errors();
    EXPECT_EQ(material_of(model.graph, "a")->reflection, 1);
    EXPECT_EQ(material_of(model.graph, "b")->reflection, 0.2);
    EXPECT_EQ(material_of(model.graph, "c")->reflection, 0);
    EXPECT_EQ(material_of(model.graph, "d")->reflection, 1);
}

TEST(Settings, colons_and_commas_may_be_left_out_and_short_forms_work) {
    const Model model("camera { orthographic, width 2.5 look_at 0,0,0 }\nbackground 0, 0, 1\nsteps 3");
    ASSERT_TRUE(model.graph) << model.errors();
    EXPECT_TRUE(model.settings().camera->orthographic);
    EXPECT_EQ(model.settings().camera->width, 2.5);
    EXPECT_EQ(model.settings().background, (BackgroundSetting{{0, 0, 1}, {}}));
    EXPECT_EQ(model.settings().steps, 3u);
}

TEST(Settings, a_model_without_statements_says_nothing) {
    const Model model("");
    ASSERT_TRUE(model.graph);
    EXPECT_EQ(model.settings(), SceneSettings());
}

TEST(Settings, lets_are_constants_in_the_order_of_the_text) {
    const Model model("let a = 2, b = a*3\nlet c = b + 1\nbackground: 1/c, 0, 0");
    ASSERT_TRUE(model.graph) << model.errors();
    EXPECT_EQ(model.settings().background->rgb.r, 1.0 / 7);
}

TEST(Settings, set_replaces_a_let_and_what_follows_from_it) {
    LowerOptions options;
    options.set = {{"a", 4}};
    const Model model("let a = 2, b = a/10\nbackground: b, 0, 0", options);
    ASSERT_TRUE(model.graph) << model.errors();
    EXPECT_EQ(model.settings().background->rgb.r, 0.4);
}

TEST(Settings, set_of_an_unknown_let_is_an_error_with_a_suggestion) {
    LowerOptions options;
    options.set = {{"lenght", 4}};
    const Model model("let length = 2", options);
    EXPECT_FALSE(model.graph);
    EXPECT_EQ(model.errors(), "graftal: error: the model has no 'let lenght' to set\n"
                              "    hint: did you mean 'length'? known here: length, steps\n");
}

TEST(Settings, set_of_nothing_finite_is_an_error) {
    LowerOptions options;
    options.set = {{"a", std::numeric_limits<double>::quiet_NaN()}};
    EXPECT_THAT(Model("let a = 2", options).errors(), HasSubstr("'a' is set to a value that is not finite"));
}

TEST(Settings, angles_just_inside_the_range_are_good) {
    EXPECT_TRUE(Model("camera { angle: 179.999 }").graph);
    EXPECT_TRUE(Model("camera { angle: 1e-3 }").graph);
    EXPECT_FALSE(Model("camera { angle: 0 }").graph);
    EXPECT_TRUE(Model("steps: 1000000000").graph);
    EXPECT_FALSE(Model("steps: 1000000001").graph);
    EXPECT_TRUE(Model("steps: 0").graph);
}

TEST(Settings, APatternHasLayersAndColours) {
    const Model model(
        "material rock { color: 0.4, 0.4, 0.2  pattern: cells  scale: 2  warp: 1  space: world\n"
        "  plus: noise  scale: 0.3  octaves: 6  share: 0.25  high: 1, 1, 1  bump: 2 }\n"
        "material moss { from: rock  color: 0.1, 0.2, 0 }\n"
        "material bare { from: rock  pattern: none }\n"
        "object o { sphere material rock }");
    ASSERT_TRUE(model.graph) << model.errors();
    const SolidPattern& rock = material_of(model.graph, "rock")->pattern;
    ASSERT_EQ(rock.layers.size(), 2u);
    EXPECT_EQ(rock.layers[0],
              (PatternLayer{.kind = PatternKind::cells, .scale = 2, .of_world = true, .warp = 1}));
    EXPECT_EQ(rock.layers[1],
              (PatternLayer{.kind = PatternKind::noise, .scale = 0.3, .octaves = 6, .share = 0.25}));
    EXPECT_EQ(rock.high, Rgb(1.0));
    EXPECT_NEAR(rock.low.r, 0.65 * 0.4, 1e-12);
    EXPECT_EQ(rock.bump, 2);
    const SolidPattern& moss = material_of(model.graph, "moss")->pattern;
    EXPECT_EQ(moss.layers, rock.layers);
    EXPECT_NEAR(moss.high.g, 1.35 * 0.2, 1e-12) << "colours go with the material's";
    EXPECT_FALSE(material_of(model.graph, "bare")->pattern);
    // The text that graftal writes reads back equal.
    SourceMap sources;
    Diagnostics diagnostics;
    const auto again = lower_text("again.inst", print(*model.graph), {}, sources, diagnostics).graph;
    ASSERT_TRUE(again) << diagnostics.render(sources);
    EXPECT_EQ(again->materials, model.graph->materials);
}

TEST(Settings, FaultsOfPatterns) {
    const std::pair<const char*, const char*> cases[] = {
        {"pattern: marble", "there is no pattern 'marble'"},
        {"scale: 2", "'scale' belongs to a pattern, and this material has none"},
        {"plus: noise", "'plus' belongs to a pattern"},
        {"pattern: noise octaves: 0", "'octaves' must be a whole number between 1 and 10"},
        {"pattern: noise octaves: 2.5", "'octaves' must be a whole number"},
        {"pattern: noise stretch: 0, 1, 1", "each factor of 'stretch' must lie between 0.001 and 1000"},
        {"pattern: noise scale: 0", "'scale' must be positive"},
        {"pattern: noise space: room", "there is no space 'room'"},
        {"pattern: noise share: 0.5", "'share' is that of a pattern on another one"},
        {"pattern: noise plus: cells share: 1", "must be above 0 and below 1"},
        {"pattern: noise plus: cells plus: cells plus: bands plus: noise", "a pattern has at most 4 layers"},
        {"pattern: noise scale: 1 scale: 2", "duplicate 'scale'"},
        {"pattern: noise bump: 1e9", "must lie between -10 and 10"},
        {"pattern: noise texture: \"x.png\"", "a material has a picture or a pattern"},
    };
    for (const auto& [fields, message] : cases) {
        const Model model("material m { " + std::string(fields) + " }\nobject o { sphere material m }");
        EXPECT_THAT(model.errors(), HasSubstr(message)) << fields;
    }
}

TEST(Settings, OnlyThePictureThatAMaterialShowsHasClearParts) {
    MemoryFiles files;
    files.set("leaf.png", "");
    const LowerHelp help{.look_at_texture =
                             [](const std::string&, TextureFacts& facts) {
                                 facts.coverage = 0.5;
                                 return Status();
                             },
                         .files = &files};
    const auto lowered = [&](const std::string& fields, Diagnostics& diagnostics) {
        SourceMap sources;
        return lower_text("m.inst",
                          "material leaf { texture: \"leaf.png\" }\nmaterial m { from: leaf " + fields +
                              " }\nobject o { sphere material m }",
                          {}, sources, diagnostics, help)
            .graph;
    };
    Diagnostics glass, stone;
    EXPECT_FALSE(lowered("ior: 1.5", glass));
    ASSERT_EQ(glass.all().size(), 1u);
    EXPECT_THAT(glass.all()[0].message, HasSubstr("the picture of this material has clear parts"));
    const std::optional<Graph> graph = lowered("ior: 1.5  pattern: noise", stone);
    ASSERT_TRUE(graph);
    EXPECT_EQ(material_of(graph, "m")->coverage, 1);
}

TEST(Settings, EachParameterIsNotedOnce) {
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText lowered =
        lower_text("m.inst", "let a = 2\nlet b = a\nobject o { sphere scale: b }", {}, sources, diagnostics);
    ASSERT_EQ(lowered.notes.parameters.size(), 2u) << diagnostics.render(sources);
    EXPECT_EQ(lowered.notes.parameters[0].name, "a");
    EXPECT_EQ(lowered.notes.parameters[1].value, 2);
}

} // namespace
} // namespace graftal
