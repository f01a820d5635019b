// A session gives what a fresh run gives, bit for bit, whatever was asked of it before; and it runs a stage
// again exactly if an input of that stage is another one.

#include "compiler/session/session.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/povray/cut/compile.h"
#include "compiler/povray/emit/scene.h"
#include "compiler/session/shared_framing.h"
#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "runtime/trace/picture_tracer.h"
#include "tests/property/random_graph.h"

namespace graftal {
namespace {

using graftal::testing::Choices;

/// A small model with numbers that edits change. `{0}` and `{1}` stand for numbers.
struct Template {
    const char* name;
    const char* text;
    const char* parameter; ///< of `--set`
};

const Template templates[] = {
    {"plant.lsys",
     "lsys plant {{\n  let bend = {0}\n  steps 3\n  seed 4\n  angle 25.7\n  axiom X\n"
     "  X -> F[+(bend)X][-X]FX : 0.7\n  X -> F[-(bend)X]{1}X : 0.3\n  F -> FF\n}}\n",
     "bend"},
    {"crystal.rifs",
     "let share = 1 / (2 + {0} / 100)\nrifs crystal {{\n  map a {{ scale share  translate <0, 1/2, 0>  tint "
     "rgb "
     "<0.2, 0.5, 0.9> 0.5 }}\n  map b {{ scale share  rotate y 40  translate <1/2, 0, 0> }}\n"
     "  map c {{ scale 1/3  translate <0, -1/2, 0.1>  {1} }}\n  terminal sphere\n}}\n",
     "share"},
    {"tower.inst",
     "let turn = {0}\nobject tower {{\n  union: cube scale: 0.4, 0.1, 0.4\n  instance: tower scale: 0.8 "
     "rotate: y, turn translate: 0, 0.5, 0 tint: 0.9, 0.4, 0.1, 0.3\n  instance: twig translate: {1}, 0, "
     "0\n}}\n"
     "canonical object twig {{ instance: twig scale: 0.4 translate: 0, 1, 0  instance: cylinder scale: 0.1, "
     "1, "
     "0.1 }}\n",
     "turn"},
};

/// What goes into {1}: some of it is wrong in each of the languages.
const char* const inserts[3][4] = {{"F", "FF", "G", "&F"},
                                   {"", "tint rgb <1, 0, 0> 0.4", "rotate z 20", "scale 7"},
                                   {"0.5", "-0.3", "1 / 4", "nothing"}};

/// A model that is being edited.
struct Draft {
    std::string text;
    StageOptions options;
};

std::string text_of(std::size_t language, Choices& choices) {
    return fmt::format(fmt::runtime(templates[language].text), choices.below(9) * 5 + 5,
                       inserts[language][choices.below(4)]);
}

/// One edit, of whatever kind.
void edit(Draft& draft, std::size_t language, Choices& choices) {
    ViewOptions& view = draft.options.view;
    LowerOptions& lower = draft.options.lower;
    DetailOptions& detail = draft.options.detail;
    switch (choices.below(10)) {
    case 0:
        draft.text = text_of(language, choices);
        break;
    case 1:
        lower.set[templates[language].parameter] = 0.1 + 0.1 * choices.below(3);
        break;
    case 2:
        lower.set.clear();
        break;
    case 3:
        lower.seed.reset();
        if (choices.one_in(2)) lower.seed = choices.below(3);
        break;
    case 4:
        lower.steps.reset();
        if (choices.one_in(2)) lower.steps = choices.below(5);
        break;
    case 5:
        view.camera = {};
        if (choices.one_in(2)) view.camera.angle_deg = 20 + 10 * choices.below(3);
        if (choices.one_in(2)) view.camera.location = Vec3(3, 1 + choices.below(2), 4);
        break;
    case 6:
        view.size = {16 + 8 * static_cast<int>(choices.below(3)), 16};
        break;
    case 7:
        view.zoom = {};
        if (choices.one_in(2)) view.zoom.zoom = Magnification::of(1 + choices.below(3));
        break;
    case 8:
        detail.error_px = 0.5 * choices.below(4);
        break;
    default:
        detail.error_world.reset();
        if (choices.one_in(2)) detail.error_world = 0.05 * (1 + choices.below(2));
    }
}

std::string sdl_of(const CompiledModel& model) {
    std::string text;
    std::vector<PaletteImage> palettes;
    emit_povray(
        model.cut, model.view, {.scene_name = "model"},
        [&](std::string_view piece) { return text += piece, true; }, palettes);
    return text;
}

std::vector<float> picture_of(const ViewedModel& viewed, std::shared_ptr<const PreparedGraph> prepared,
                              const DetailOptions& detail) {
    const TraceModel model(std::move(prepared), viewed.view, resolved(detail, viewed));
    Image picture{viewed.view.size.width, viewed.view.size.height, 3, {}};
    picture.pixels.resize(3u * static_cast<std::size_t>(picture.width) *
                          static_cast<std::size_t>(picture.height));
    EXPECT_TRUE(PictureTracer(model).trace({}, {}, picture));
    return picture.pixels;
}

/// All that a model's user can see.
struct Seen {
    std::string stats, sdl, messages;
    std::vector<float> picture;
    bool operator==(const Seen&) const = default;
};

Seen look(Session& session, const StageOptions& options, bool with_picture) {
    Seen seen;
    Compilation compilation;
    const auto tell = [&] {
        seen.messages += compilation.diagnostics.render(compilation.sources) + compilation.status.message();
    };
    if (const auto model = session.analysed(options, compilation, true))
        seen.stats = stats_json(*model, levels_of(*model, options.lower.steps), compilation.sources);
    tell();
    if (const auto model = compile_scene(session, options, compilation)) seen.sdl = sdl_of(*model);
    tell();
    if (!with_picture) return seen;
    const auto viewed = session.viewed(options, compilation);
    const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
    if (prepared) seen.picture = picture_of(*viewed, prepared, options.detail);
    tell();
    return seen;
}

class Edited : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Edited, GivesWhatAFreshRunGives) {
    constexpr int edits = 334, edits_a_picture = 8;
    const std::size_t language = GetParam();
    Choices choices(2024 + language);
    Draft draft{text_of(language, choices), {}};
    draft.options.view.size = {24, 16};
    draft.options.detail.work_seconds = 1;
    Session session(templates[language].name, draft.text);
    int good = 0, pictures = 0;
    for (int i = 0; i < edits; ++i) {
        const std::string before = draft.text;
        edit(draft, language, choices);
        if (draft.text != before) session.edit(draft.text);
        const bool with_picture = i % edits_a_picture == 0;
        Session fresh(templates[language].name, draft.text);
        const Seen expected = look(fresh, draft.options, with_picture);
        const Seen found = look(session, draft.options, with_picture);
        ASSERT_EQ(found.messages, expected.messages) << "edit " << i << " of\n" << draft.text;
        ASSERT_EQ(found.stats, expected.stats) << "edit " << i << " of\n" << draft.text;
        ASSERT_EQ(found.sdl, expected.sdl) << "edit " << i << " of\n" << draft.text;
        ASSERT_EQ(found.picture, expected.picture) << "edit " << i << " of\n" << draft.text;
        good += !found.sdl.empty();
        pictures += !found.picture.empty();
    }
    EXPECT_GT(good, edits / 3);
    EXPECT_GT(pictures, edits / edits_a_picture / 3);
    const StageRuns runs = session.runs();
    EXPECT_LT(runs.lowered, edits / 2u);
    EXPECT_LT(runs.prepared, edits - edits / 10u);
}

INSTANTIATE_TEST_SUITE_P(Languages, Edited, ::testing::Values(0, 1, 2),
                         [](const auto& param) { return std::string(templates[param.param].name, 5); });

class Runs : public ::testing::TestWithParam<std::size_t> {
  protected:
    Runs()
        : session_(templates[GetParam()].name,
                   fmt::format(fmt::runtime(templates[GetParam()].text), 10, inserts[GetParam()][0])) {
        options_.view.size = {24, 16};
        options_.lower.steps = 3;
        make();
    }

    void make() {
        Compilation compilation;
        EXPECT_TRUE(session_.prepared(options_, compilation))
            << compilation.diagnostics.render(compilation.sources);
    }

    /// How often the stages ran for this edit.
    template<typename Edit> StageRuns after(const Edit& change) {
        const StageRuns before = session_.runs();
        change();
        make();
        const StageRuns now = session_.runs();
        return {now.source - before.source,     now.parsed - before.parsed, now.lowered - before.lowered,
                now.analysed - before.analysed, now.viewed - before.viewed, now.prepared - before.prepared};
    }

    bool is_lsys() const { return GetParam() == 0; }

    Session session_;
    StageOptions options_;
};

TEST_P(Runs, AStageRunsAgainIfAnInputOfItsOwnDiffers) {
    EXPECT_EQ(session_.runs(), (StageRuns{1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(after([] {}), StageRuns());
    EXPECT_EQ(after([&] { options_.view.camera.angle_deg = 30; }), (StageRuns{0, 0, 0, 0, 1, 0}));
    EXPECT_EQ(after([&] { options_.view.size.width = 32; }), (StageRuns{0, 0, 0, 0, 1, 0}));
    EXPECT_EQ(after([&] { options_.detail.error_px = 2; }), StageRuns());
    EXPECT_EQ(after([&] { options_.detail.error_px = 0; }), (StageRuns{0, 0, 0, 0, 0, 1}));
    // The steps of an L-system are spent on its text; those of others are levels of the picture.
    EXPECT_EQ(after([&] { options_.lower.steps = 2; }),
              is_lsys() ? (StageRuns{0, 0, 1, 1, 1, 1}) : (StageRuns{0, 0, 0, 0, 1, 1}));
    EXPECT_EQ(after([&] { options_.lower.set[templates[GetParam()].parameter] = 0.2; }),
              (StageRuns{0, 0, 1, 1, 1, 1}));
    // A zoom gives the graph that was analysed a new root.
    EXPECT_EQ(after([&] { options_.view.zoom.zoom = Magnification::of(2); }), (StageRuns{0, 0, 0, 0, 1, 1}));
    EXPECT_EQ(after([&] { options_.view.camera.angle_deg = 40; }), (StageRuns{0, 0, 0, 0, 1, 1}));
}

TEST_P(Runs, ATextThatIsTheSameIsNoEdit) {
    const std::string text =
        fmt::format(fmt::runtime(templates[GetParam()].text), 10, inserts[GetParam()][0]);
    EXPECT_EQ(after([&] { session_.edit(text); }), (StageRuns{1, 0, 0, 0, 0, 0}));
    EXPECT_EQ(after([&] { session_.edit(text + "\n"); }), (StageRuns{1, 1, 1, 1, 1, 1}));
}

INSTANTIATE_TEST_SUITE_P(Languages, Runs, ::testing::Values(0, 1, 2),
                         [](const auto& param) { return std::string(templates[param.param].name, 5); });

/// What `Keep` gives up is made again, and is the same.
TEST(Session, WhatWasGivenUpIsMadeAgain) {
    const std::string text = fmt::format(fmt::runtime(templates[0].text), 10, "F");
    StageOptions options;
    options.view.size = {24, 16};
    std::string expected;
    for (const Keep keep : {Keep::everything, Keep::for_views, Keep::nothing}) {
        Session session("plant.lsys", text, keep);
        Compilation compilation;
        const auto first = compile_scene(session, options, compilation);
        ASSERT_TRUE(first);
        if (expected.empty()) expected = sdl_of(*first);
        session.yield_memory();
        const auto again = compile_scene(session, options, compilation);
        ASSERT_TRUE(again);
        EXPECT_EQ(sdl_of(*first), expected);
        EXPECT_EQ(sdl_of(*again), expected);
        options.view.size.width = 32;
        EXPECT_TRUE(compile_scene(session, options, compilation));
        options.view.size.width = 24;
    }
}

/// To draw the clouds takes longer than to frame a small model.
TEST(Session, ViewsOfASessionShareTheirClouds) {
    const std::string text = "sky { clouds: 0.4 }\nlight { sun: 1, 1, 1 }\nobject a { instance: sphere }\n";
    Session session("a.inst", text);
    const auto sky_of = [&](int width) {
        StageOptions options;
        options.view.size = {width, 16};
        Compilation compilation;
        const auto viewed = session.viewed(options, compilation);
        return viewed ? viewed->view.sky_light->picture : nullptr;
    };
    const auto sky = sky_of(24);
    ASSERT_TRUE(sky);
    EXPECT_EQ(sky_of(32), sky);
    session.edit(text + "object b { instance: cube }\n");
    EXPECT_EQ(sky_of(24), sky) << "another model under the same sky";
}

/// Files that the model names are inputs too.
TEST(Session, ReloadingSeesWhatHasChanged) {
    TemporaryDirectory directory;
    ASSERT_TRUE(directory.create().ok());
    const std::string model = directory.path() + "/a.inst", part = directory.path() + "/b.inst";
    const auto written = [](const std::string& path, const std::string& text) {
        EXPECT_TRUE(write_text(path, text).ok());
    };
    written(model, "use b = \"b.inst\"\nobject a { instance: b }\n");
    Session session(model, disk_files());
    const auto most_x = [&] {
        Compilation compilation;
        const auto analysed = session.analysed({}, compilation);
        return analysed ? analysed->bounds[analysed->graph.root].box.max.x : 0;
    };
    EXPECT_EQ(most_x(), 0) << "b.inst is not there";
    written(part, "object b { instance: sphere }\n");
    session.reload();
    EXPECT_NEAR(most_x(), 1, 1e-9);
    const StageRuns before = session.runs();
    session.reload();
    EXPECT_NEAR(most_x(), 1, 1e-9);
    EXPECT_EQ(session.runs().lowered, before.lowered) << "nothing has changed";
    written(part, "object b { instance: sphere scale: 3 }\n");
    EXPECT_NEAR(most_x(), 1, 1e-9) << "nobody has asked for the files";
    session.reload();
    EXPECT_NEAR(most_x(), 3, 1e-9);
    const std::string mesh = directory.path() + "/c.obj";
    written(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    written(part, "object b { instance: mesh \"c.obj\" }\n");
    session.reload();
    EXPECT_NEAR(most_x(), 1, 1e-9);
    written(mesh, "v 0 0 0\nv 12 0 0\nv 0 1 0\nf 1 2 3\n");
    session.reload();
    EXPECT_NEAR(most_x(), 12, 1e-9);
}

/// Wherever it is cancelled a session ends at the next time that it asks, and goes on as if nothing had been.
TEST(Session, EndsWhereItIsCancelled) {
    const std::string text = fmt::format(fmt::runtime(templates[2].text), 40, "0.5");
    StageOptions options;
    options.view.size = {240, 160};
    options.detail.error_px = 0.2;
    std::string expected;
    std::set<std::string> stages;
    std::uint64_t asked = 0, most = 0;
    {
        Session session("tower.inst", text);
        session.set_control({CancelFlag([&] { return ++asked, false; }),
                             [&](const Progress& progress) { stages.emplace(progress.stage); }});
        Compilation compilation;
        const auto whole = compile_scene(session, options, compilation);
        ASSERT_TRUE(whole);
        expected = sdl_of(*whole);
        most = asked;
    }
    EXPECT_EQ(stages,
              (std::set<std::string>{"lower", "passes", "contraction", "bounding", "prepare", "cut"}));
    for (std::uint64_t last = 0; last < most; last += 1 + most / 40) {
        Session session("tower.inst", text);
        asked = 0;
        bool may_be_raised = true;
        session.set_control({CancelFlag([&] { return ++asked > last && may_be_raised; }), {}});
        Compilation compilation;
        EXPECT_FALSE(compile_scene(session, options, compilation));
        EXPECT_EQ(compilation.status.message(), "interrupted");
        EXPECT_EQ(asked, last + 1) << "it went on";
        may_be_raised = false;
        Compilation again;
        const auto whole = compile_scene(session, options, again);
        ASSERT_TRUE(whole);
        EXPECT_EQ(sdl_of(*whole), expected);
    }
}

/// A model that failed fails the same way when it is asked for again, and is not lowered for that.
TEST(Session, AFailureIsKept) {
    Session session("broken.inst", "object a { instance: b }\n");
    std::string first;
    for (int i = 0; i < 3; ++i) {
        Compilation compilation;
        EXPECT_FALSE(compile_scene(session, {}, compilation));
        const std::string said = compilation.diagnostics.render(compilation.sources);
        if (i == 0) first = said;
        EXPECT_EQ(said, first);
    }
    EXPECT_NE(first, "");
    EXPECT_EQ(session.runs().lowered, 1u);
}

const char* const spiral =
    "object a { instance: cube scale: 0.3  instance: a scale: 0.5 translate: 1, 0, 0 }\n";

/// The picture has as much work left at every depth.
TEST(Session, AZoomedModelHasTheAccountOfTheModel) {
    StageOptions options;
    options.view.size = {24, 16};
    Session session("a.inst", spiral);
    const auto work_of = [&] {
        Compilation compilation;
        const auto viewed = session.viewed(options, compilation);
        return viewed ? viewed->model->work_seconds : -1;
    };
    const double whole = work_of();
    EXPECT_GT(whole, 0);
    for (const char* const zoom : {"2", "1e30", "1e1000"}) {
        options.view.zoom.zoom = Magnification::parse(zoom);
        EXPECT_EQ(work_of(), whole) << zoom;
    }
}

TEST(Session, ADeepZoomEndsWhereItIsCancelled) {
    StageOptions options;
    options.view.size = {24, 16};
    options.view.zoom.zoom = Magnification::parse("1e10000");
    Session session("a.inst", spiral);
    bool zooms = false;
    session.set_control({CancelFlag([&] { return zooms; }),
                         [&](const Progress& progress) { zooms = progress.stage == "frame"; }});
    Compilation compilation;
    EXPECT_FALSE(session.viewed(options, compilation));
    EXPECT_EQ(compilation.status.message(), "interrupted");
}

TEST(Session, AZoomSaysThatItHasNoLens) {
    StageOptions options;
    options.view.size = {24, 16};
    options.view.camera.location = Vec3(0, 0, 9);
    options.view.camera.aperture = 0.1;
    const auto said = [&] {
        Compilation compilation;
        Session session("a.inst", spiral);
        const auto viewed = session.viewed(options, compilation);
        EXPECT_TRUE(viewed);
        if (viewed) {
            EXPECT_EQ(viewed->view.lens.radius > 0, compilation.diagnostics.all().empty());
        }
        return compilation.diagnostics.render(compilation.sources);
    };
    EXPECT_EQ(said(), "");
    options.view.zoom.zoom = Magnification::of(2);
    options.view.zoom.eye = Vec3(0, 0, 9);
    EXPECT_NE(said().find("the camera has no lens here"), std::string::npos);
}

/// The help lists the keys that the text may have (`graftal stats --help`).
TEST(Session, EachKeyOfStatsIsListed) {
    const std::pair<std::string, std::string> models[] = {
        {"a.inst", spiral},
        {"plane.inst", "object a { plane }\n"},
        {"wide.inst", "object a { instance: sphere  instance: a scale: 2 }\n"},
        {"plant.lsys", fmt::format(fmt::runtime(templates[0].text), 10, "F")}};
    for (const auto& [name, text] : models) {
        Session session(name, text);
        Compilation compilation;
        const auto model = session.analysed({}, compilation, true);
        ASSERT_TRUE(model) << name;
        const BoxCount none;
        std::istringstream lines(stats_text(*model, {}, compilation.sources, &none));
        for (std::string line; std::getline(lines, line);)
            EXPECT_TRUE(std::ranges::any_of(stats_keys(), [&](const StatsKey& key) {
                return line.starts_with(fmt::format("{:<28} ", key.name));
            })) << line;
    }
}

} // namespace
} // namespace graftal
