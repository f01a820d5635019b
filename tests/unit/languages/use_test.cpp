// `use NAME = "file"`: other models inside a model.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/import/importers.h"
#include "compiler/languages/lower.h"
#include "runtime/system/disk_files.h"
#include "tests/unit/languages/lower_file.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// Models in a folder that goes when the test does.
class Use : public ::testing::Test {
  protected:
    Use() { std::filesystem::create_directories(folder_ / "parts"); }
    ~Use() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

    void lower(const std::string& name, const LowerOptions& options = {}) {
        sources_ = SourceMap();
        diagnostics_ = Diagnostics();
        const LowerHelp help{.translator = translator_, .files = &disk_files()};
        graph_ =
            test::lower_file((folder_ / name).string(), options, sources_, diagnostics_, status_, help).graph;
    }
    std::string errors() const { return diagnostics_.render(sources_); }
    const Object& object(std::string_view name) const {
        for (const Object& object : graph_->objects)
            if (object.name == name) return object;
        throw std::runtime_error("no object " + std::string(name));
    }
    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const Object& object : graph_->objects)
            out.push_back(object.name);
        return out;
    }

    const std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                          ("graftal_use_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    Translator translator_ = importing_translator();
    SourceMap sources_;
    Diagnostics diagnostics_;
    Status status_;
    std::optional<Graph> graph_;
};

TEST_F(Use, objects_are_prefixed_primitives_shared_and_settings_ignored) {
    write("parts/leaf.inst",
          "camera { angle: 3 } steps: 7 let k = 2\n"
          "canonical object tip(n) { sphere scale: n } object leaf { union: tip(k), cube }");
    write("a.inst", "use leaf = \"parts/leaf.inst\"\nobject a { union: leaf, sphere, leaf.tip(2) }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_THAT(names(), UnorderedElementsAre("a", "leaf.leaf", "leaf.tip(2)", "sphere", "cube"));
    EXPECT_EQ(graph_->settings, SceneSettings());
    const std::vector<Instance>& instances = object("a").instances;
    EXPECT_EQ(graph_->objects[instances[0].master].name, "leaf.leaf");
    EXPECT_EQ(graph_->objects[instances[2].master].name, "leaf.tip(2)");
    EXPECT_EQ(instances[1].master, object("leaf.tip(2)").instances[0].master);
}

TEST_F(Use, primitives_that_the_user_has_are_shared_and_others_added_once) {
    std::string many = "object many {";
    for (int i = 1; i <= 100; ++i)
        many += fmt::format(" instance: frustum({})", i / 128.0);
    write("many.inst", many + " instance: sphere }");
    write("a.inst", "use m = \"many.inst\"\nobject a { union: frustum(0.25), sphere, m }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    std::vector<std::string> all = names();
    EXPECT_EQ(all.size(), 103u) << "two objects and 101 primitives";
    std::sort(all.begin(), all.end());
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
    const std::vector<Instance>& instances = object("a").instances;
    EXPECT_EQ(object("m.many").instances[31].master, instances[0].master) << "the same frustum";
    EXPECT_EQ(object("m.many").instances[100].master, instances[1].master);
}

TEST_F(Use, parts_take_arguments_from_outside) {
    write("wood.inst", "let k = 3 canonical object twig { cylinder scale: 1, k, 1 }\n"
                       "canonical object bough(0) { twig }\n"
                       "canonical object bough(n) { twig scale: n instance: bough(n - 1) }\n"
                       "canonical object knot(k) { sphere scale: k*random(1, 2) }\n"
                       "object wood { bough(1) }");
    write("park.inst", "use w = \"wood.inst\" object park { w }");
    write("a.inst", "use w = \"wood.inst\" use p = \"park.inst\"\n"
                    "object a { union: w, w.bough(2), w.knot(5), w.bough(2), p.w.bough(1), p.w.bough(2) }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_THAT(names(), UnorderedElementsAre("cylinder", "sphere", "a", "w.wood", "w.twig", "w.bough(0)",
                                              "w.bough(1)", "w.bough(2)", "w.knot(5)", "p.park", "p.w.wood",
                                              "p.w.twig", "p.w.bough(0)", "p.w.bough(1)", "p.w.bough(2)"));
    EXPECT_EQ(object("w.twig").instances[0].parent_from_child.linear[1][1], 3);
    EXPECT_EQ(graph_->objects[object("w.bough(2)").instances[1].master].name, "w.bough(1)");
    const double knot = object("w.knot(5)").instances[0].parent_from_child.linear[0][0];
    EXPECT_GE(knot, 5);
    EXPECT_LE(knot, 10);
    LowerOptions options;
    options.seed = 7;
    lower("a.inst", options);
    EXPECT_NE(object("w.knot(5)").instances[0].parent_from_child.linear[0][0], knot);
}

TEST_F(Use, models_of_other_programs_have_parts_where_their_translations_have) {
    write("tree.es", "twig\nrule twig md 3 > leaf { box { y 1 } twig }\nrule leaf { sphere }");
    write("tile.cfdg",
          "startshape A\nshape A { B(2) [] SQUARE [] }\nshape B(n) { loop (n) [x 1] CIRCLE [] }");
    write("a.inst", "use t = \"tree.es\" use c = \"tile.cfdg\" object a { t.leaf, c.B }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_EQ(object("t.leaf").instances.size(), 1u);
    EXPECT_EQ(object("c.B").instances.size(), 2u);
    write("lines.ls", "2\n90\n10\nF\nF=FF\n@\n");
    write("b.inst", "use l = \"lines.ls\" object b { l.F }");
    lower("b.inst");
    EXPECT_THAT(errors(), HasSubstr("'l.F'"));
}

// A grammar that begins with another shape gives a part of any arguments.
TEST_F(Use, parts_of_grammars_take_arguments_by_a_start_of_their_own) {
    write("tile.cfdg",
          "startshape A\nshape A { B(2) [] SQUARE [] }\nshape B(n) { loop (n) [x 1] CIRCLE [] }");
    write("three.cfdg", "startshape B(3)\nimport tile.cfdg\n");
    write("a.inst", "use c = \"three.cfdg\" object a { c }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_EQ(object("c.B").instances.size(), 3u);
}

TEST_F(Use, a_seed_is_that_of_used_grammars_too) {
    write("dot.cfdg", "startshape A\nshape A { SQUARE [x (rand(1))] }");
    write("a.inst", "use c = \"dot.cfdg\" object a { c.A }");
    const auto place = [&](std::optional<std::uint64_t> seed) {
        LowerOptions options;
        options.seed = seed;
        lower("a.inst", options);
        EXPECT_TRUE(graph_) << errors();
        return object("c.A").instances.at(0).parent_from_child.translation.x;
    };
    EXPECT_EQ(place(0), place({}));
    EXPECT_GT(std::abs(place(7) - place({})), 1e-3);
}

TEST_F(Use, models_of_other_programs_are_read_by_the_translator_that_is_handed_in) {
    write("tree.es", "box { y 1 }");
    write("a.inst", "use t = \"tree.es\" object a { t }");
    translator_ = no_translator();
    lower("a.inst");
    EXPECT_FALSE(graph_);
    EXPECT_THAT(errors(), HasSubstr("names of models end in .lsys, .rifs or .inst"));

    translator_.own_text = [](FileId file, std::string_view, SourceMap& sources, Diagnostics&,
                              const TranslateOptions&, WorkMeter*) -> std::optional<FileId> {
        if (!sources.name(file).ends_with(".es")) return file;
        return sources.add_translation("tree.inst", "object tree { sphere, cube }\n", file, {});
    };
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_EQ(object("t.tree").instances.size(), 2u);
}

TEST_F(Use, parts_that_are_not_there_are_errors_of_the_user) {
    write("wood.inst", "canonical object bough(n) { cylinder scale: n } \n"
                       "object wood { bough(1) }");
    write("plant.lsys", "lsys plant {\nsteps 1\naxiom F\n}");
    write("a.inst", "use w = \"wood.inst\" object a { w.bow(2) }");
    lower("a.inst");
    EXPECT_THAT(errors(), HasSubstr("a.inst:1:32: error: unknown object 'w.bow(2)'"));
    write("a.inst", "use p = \"plant.lsys\" object a { p.F(2) }");
    lower("a.inst");
    EXPECT_THAT(errors(), HasSubstr("a.inst:1:33: error: unknown object 'p.F(2)'"));
    write("a.inst", "use w = \"wood.inst\" object a { w.bough(0) }");
    lower("a.inst");
    EXPECT_THAT(errors(), HasSubstr("wood.inst:1:38: error: this scale"));
    write("a.inst", "use w = \"wood.inst\" canonical object f(0) { w } canonical object f(n) { w.bough(n) "
                    "instance: f(n - 1) } object a { f(5000) }");
    lower("a.inst");
    EXPECT_THAT(errors(), HasSubstr("asks its used models for more than 1000 objects"));
}

TEST_F(Use, paths_start_at_the_using_file) {
    write("parts/leaf.inst", "use vein = \"vein.inst\" object leaf { vein }");
    write("parts/vein.inst", "object vein { cylinder }");
    write("a.inst", "use leaf = \"./parts/../parts/leaf.inst\"\nobject a { leaf }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_THAT(names(), UnorderedElementsAre("a", "leaf.leaf", "leaf.vein.vein", "cylinder"));
}

TEST_F(Use, equal_materials_are_shared_and_others_renamed) {
    write("leaf.inst", "material green { color: 0, 1, 0 } material bark { color: 1, 0, 0 }\n"
                       "object leaf { sphere material: green instance: cube material: bark }");
    write("a.inst",
          "use l = \"leaf.inst\"\nmaterial bark { color: 0, 0, 1 } material l.bark { color: 1, 1, 1 }\n"
          "material green { color: 0, 1, 0 } object a { l material: bark }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    std::vector<std::string> materials;
    for (const Material& material : graph_->materials)
        materials.push_back(material.name);
    EXPECT_THAT(materials, ::testing::ElementsAre("bark", "l.bark", "green", "l.bark_2"));
    EXPECT_EQ(object("l.leaf").instances[0].material, MaterialId(2));
    EXPECT_EQ(object("l.leaf").instances[1].material, MaterialId(3));
    EXPECT_EQ(object("a").instances[0].material, MaterialId(0));
}

TEST_F(Use, a_model_may_be_used_twice) {
    write("leaf.inst", "object leaf { sphere }");
    write("a.inst", "use l = \"leaf.inst\"\nuse m = \"leaf.inst\"\nobject a { union: l, m }");
    lower("a.inst");
    ASSERT_TRUE(graph_) << errors();
    EXPECT_THAT(names(), UnorderedElementsAre("a", "l.leaf", "m.leaf", "sphere"));
    EXPECT_EQ(sources_.size(), 2u) << "read once";
}

TEST_F(Use, set_speaks_to_the_root_model_only) {
    write("leaf.inst", "let k = 2 object leaf { sphere scale: k }");
    write("a.inst", "use l = \"leaf.inst\"\nlet k = 3\nobject a { l scale: k }");
    LowerOptions options;
    options.set = {{"k", 10}};
    lower("a.inst", options);
    ASSERT_TRUE(graph_) << errors();
    EXPECT_EQ(object("a").instances[0].parent_from_child.linear[0][0], 10);
    EXPECT_EQ(object("l.leaf").instances[0].parent_from_child.linear[0][0], 2);
}

TEST_F(Use, a_seed_reaches_used_models) {
    const std::string tree = "lsys tree {\nwidth 0.1\nsteps 4\naxiom A\nA -> F[+(random(0, 90))A]A\nseed ";
    write("one.lsys", tree + "1\n}");
    write("two.lsys", tree + "2\n}");
    write("bush.inst", "object bush { cube scale: random(1, 2) }");
    write("wood.inst", "use bush = \"bush.inst\" object wood { scatter: bush count: 9 over: disc 9 }");
    const auto printed = [&](const std::string& name, std::optional<std::uint64_t> seed) {
        write("a.inst", "use m = \"" + name + "\" object a { m }");
        LowerOptions options;
        options.seed = seed;
        lower("a.inst", options);
        return graph_ ? print(*graph_) : errors();
    };
    for (const char* name : {"one.lsys", "wood.inst"}) {
        EXPECT_EQ(printed(name, 5), printed(name, 5)) << name;
        EXPECT_NE(printed(name, 5), printed(name, 6)) << name;
        EXPECT_NE(printed(name, 5), printed(name, std::nullopt)) << name;
    }
    EXPECT_NE(printed("one.lsys", 5), printed("two.lsys", 5));
}

TEST_F(Use, uses_that_double_the_model_are_bounded) {
    write("m0.inst", "object o { sphere }");
    for (int i = 1; i <= 25; ++i) {
        const std::string below = "m" + std::to_string(i - 1) + ".inst";
        write("m" + std::to_string(i) + ".inst",
              "use a = \"" + below + "\"\nuse b = \"" + below + "\"\nobject o { union: a, b }");
    }
    lower("m12.inst");
    EXPECT_TRUE(graph_) << errors();
    LowerOptions options;
    options.max_objects = 20'000;
    lower("m25.inst", options);
    EXPECT_FALSE(graph_);
    EXPECT_THAT(errors(), HasSubstr("error: the model has more than 20000 objects"));
}

TEST_F(Use, a_long_chain_of_uses_is_an_error) {
    for (int i = 0; i < 50; ++i)
        write("m" + std::to_string(i) + ".inst",
              "use a = \"m" + std::to_string(i + 1) + ".inst\"\nobject o { a }");
    lower("m0.inst");
    EXPECT_FALSE(graph_);
    EXPECT_THAT(errors(), HasSubstr("models are used more than 32 deep"));
    write("m31.inst", "object o { sphere }");
    lower("m0.inst");
    EXPECT_TRUE(graph_) << errors();
}

TEST_F(Use, a_device_is_refused_and_not_read) {
    write("a.inst", "use z = \"/dev/zero\"\nobject a { z }");
    lower("a.inst");
    EXPECT_FALSE(graph_);
    EXPECT_THAT(errors(), HasSubstr("'/dev/zero' is not a regular file"));
}

TEST_F(Use, an_orbit_fails_whatever_failed_before) {
    write("points.rifs", "orbit o {\n start <1, 1>\n map m {\n  x = y\n  y = x\n }\n}");
    write("a.inst", "let b = nothing\nuse z = \"points.rifs\"\nobject a { z }");
    lower("a.inst");
    EXPECT_FALSE(graph_);
    EXPECT_THAT(errors(), HasSubstr("no model can use it"));
}

TEST_F(Use, files_are_told_before_they_are_read_there_or_not) {
    write("parts/leaf.inst", "material bark { texture: \"bark.png\" } object leaf { sphere material: bark }");
    write("a.inst", "use leaf = \"parts/leaf.inst\" use none = \"none.inst\" use far = \"../far.inst\"\n"
                    "object a { union: leaf, none, far  instance: mesh \"a.obj\" }");
    std::vector<std::string> told;
    const HeardFiles files(disk_files(), [&](const std::string& path) {
        told.push_back(std::filesystem::path(path).lexically_relative(folder_).string());
    });
    const LowerHelp help{.files = &files};
    test::lower_file((folder_ / "a.inst").string(), {.root = folder_.string()}, sources_, diagnostics_,
                     status_, help);
    EXPECT_THAT(told, ::testing::IsSupersetOf({"parts/leaf.inst", "none.inst"})) << errors();
    EXPECT_THAT(told, ::testing::Not(::testing::Contains("../far.inst"))) << "beyond the root";
    told.clear();
    write("a.inst", "use leaf = \"parts/leaf.inst\"\nobject a { union: leaf  instance: mesh \"a.obj\" }");
    test::lower_file((folder_ / "a.inst").string(), {}, sources_, diagnostics_, status_, help);
    EXPECT_THAT(told, UnorderedElementsAre("parts/leaf.inst", "parts/bark.png", "a.obj")) << errors();
}

TEST_F(Use, a_root_model_that_is_not_there_is_a_failed_status) {
    lower("nowhere.inst");
    EXPECT_FALSE(graph_);
    EXPECT_FALSE(status_.ok());
    EXPECT_FALSE(diagnostics_.has_errors());
}

TEST(Language, follows_the_name_of_the_file) {
    SourceMap sources;
    Diagnostics diagnostics;
    EXPECT_FALSE(lower_text("tree.lsys", "lsys tree { }", {}, sources, diagnostics).graph);
    EXPECT_THAT(diagnostics.render(sources), HasSubstr("tree.lsys:1:6: error: 'lsys tree' has no axiom"));
    Diagnostics unknown;
    EXPECT_FALSE(lower_text("tree.doc", "", {}, sources, unknown).graph);
    EXPECT_THAT(unknown.render(sources), HasSubstr("hint: the names of models end in .lsys, .rifs or .inst"));
    for (const std::string name : {"a.STL", "a.obj", "a.ply"}) {
        Diagnostics mesh;
        EXPECT_FALSE(lower_text("parts/" + name, "", {}, sources, mesh).graph);
        EXPECT_THAT(mesh.render(sources),
                    HasSubstr("write 'object thing { mesh \"" + name + "\" }' into an"));
    }
}

TEST(Language, of_standard_input_follows_its_first_word) {
    SourceMap sources;
    Diagnostics diagnostics;
    EXPECT_TRUE(lower_text("-", "# rifs\nlet a = 1\nobject rifs { sphere }", {}, sources, diagnostics).graph);
    EXPECT_TRUE(
        lower_text("-", "let a = 2\nrifs r {\n map m { scale 1/a }\n}", {}, sources, diagnostics).graph)
        << diagnostics.render(sources);
    EXPECT_FALSE(lower_text("-", "let a = 1\nlsys tree { }", {}, sources, diagnostics).graph);
    EXPECT_THAT(diagnostics.render(sources), HasSubstr("<stdin>:2:6: error: 'lsys tree' has no axiom"));
}

} // namespace
} // namespace graftal
