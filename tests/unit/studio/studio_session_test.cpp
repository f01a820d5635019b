#include "runtime/studio/studio_session.h"

#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "compiler/session/shared_framing.h"
#include "tests/unit/studio/page.h"

namespace graftal {
namespace {

using nlohmann::json;

/// A fern's many maps, drawn for long.
constexpr const char* heavy = "rifs heavy {\n"
                              "  map a { scale 0.7  translate <0.3, 0.3, 0.3> }\n"
                              "  map b { scale 0.7  translate <-0.3, 0.3, -0.3> }\n"
                              "  map c { scale 0.7  translate <0.3, -0.3, -0.3> }\n"
                              "  map d { scale 0.7  translate <-0.3, -0.3, 0.3> }\n"
                              "  map e { scale 0.7  translate <0, 0, 0> }\n"
                              "  terminal sphere\n"
                              "}\n";

TEST(StudioSession, AStateGivesFindingsAModelAndAPicture) {
    Page page;
    page.work();
    EXPECT_EQ(page.last("hello")["home"], "browser");
    EXPECT_EQ(page.last("hello")["name"], "crystal.rifs");
    page.show({{"text", crystal}});
    page.work();
    EXPECT_EQ(page.last("findings"),
              (json{{"type", "findings"}, {"number", 1}, {"findings", json::array()}}));
    const json model = page.last("model");
    EXPECT_EQ(model["number"], 1);
    ASSERT_EQ(model["parameters"].size(), 1u);
    const json spread = model["parameters"][0];
    EXPECT_EQ(spread["name"], "spread");
    EXPECT_EQ(spread["kind"], "let");
    EXPECT_EQ(spread["value"], 0.5);
    const std::string text = crystal;
    EXPECT_EQ(
        text.substr(spread["from"], spread["to"].get<std::size_t>() - spread["from"].get<std::size_t>()),
        "0.5");
    EXPECT_NEAR(model["box"]["most"][1].get<double>(), 1, 1e-6);
    EXPECT_TRUE(model["camera"].contains("location"));
    EXPECT_EQ(page.last("pass")["done"], true);
    EXPECT_EQ(page.last("pass")["samples"], 4) << "a flat set has no soft light";
    EXPECT_EQ(page.count("pass"), page.last("pass")["pass"].get<std::size_t>() + 1);
}

TEST(StudioSession, TilesOfEachPassCoverThePicture) {
    Page page;
    page.show({{"text", crystal}, {"width", 300}, {"height", 170}});
    page.work();
    std::map<std::uint32_t, std::uint64_t> covered;
    for (const SeenTile& tile : page.tiles) {
        EXPECT_TRUE((Tile{tile.x, tile.y, tile.width, tile.height}.lies_in({300, 170})));
        covered[tile.pass] +=
            static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
    }
    EXPECT_EQ(covered.size(), page.count("pass"));
    for (const auto& [pass, pixels] : covered)
        EXPECT_EQ(pixels, 300u * 170u) << pass;
    EXPECT_GT(page.tiles.front().block, page.tiles.back().block);
    EXPECT_EQ(page.tiles.back().block, 1);
}

TEST(StudioSession, ATextWithErrorsHasNoModelAndNoPicture) {
    Page page;
    page.show({{"text", "// \xc3\xa4\xf0\x9f\x8c\xbf\nrifs crystal { map n { skale 1/2 } }"}});
    page.work();
    const json findings = page.last("findings")["findings"];
    ASSERT_GE(findings.size(), 1u);
    EXPECT_EQ(findings[0]["severity"], "error");
    EXPECT_EQ(findings[0]["from"], 30) << "in units of UTF-16";
    EXPECT_EQ(findings[0]["to"], 35);
    EXPECT_NE(findings[0]["hint"].get<std::string>().find("scale"), std::string::npos);
    EXPECT_EQ(page.count("model"), 0u);
    EXPECT_TRUE(page.tiles.empty());
    page.show({{"text", crystal}});
    page.work();
    EXPECT_EQ(page.last("pass")["number"], 2);
}

TEST(StudioSession, ANewCameraLowersNothingAndANewNumberParsesNothing) {
    Page page;
    page.show({{"text", crystal}});
    page.work();
    const StageRuns first = page.session.runs();
    const std::string picture = page.picture();
    page.show({{"camera",
                {{"location", {0, 1, 5}}, {"look_at", {0, 0, 0}}, {"up", {0, 1, 0}}, {"angle_deg", 40}}}});
    page.work();
    StageRuns second = page.session.runs();
    EXPECT_EQ(second.viewed, first.viewed + 1);
    second.viewed = first.viewed;
    EXPECT_EQ(second, first);
    EXPECT_NE(page.picture(), picture);
    page.show({{"set", {{"spread", 0.4}}}});
    page.work();
    const StageRuns third = page.session.runs();
    EXPECT_EQ(third.parsed, first.parsed);
    EXPECT_EQ(third.lowered, first.lowered + 1);
    EXPECT_EQ(page.last("model")["parameters"][0]["value"], 0.4);
    page.show(json::object());
    page.work();
    EXPECT_EQ(page.picture(), picture) << "the same state has the same picture";
}

TEST(StudioSession, ThePictureDoesNotDependOnTheBudget) {
    Page patient, hasty;
    patient.show({{"text", crystal}});
    while (patient.session.work(60)) {
    }
    hasty.show({{"text", crystal}});
    int rounds = 0;
    while (hasty.session.work(0.001))
        ++rounds;
    EXPECT_GT(rounds, 3) << "it goes on where it was";
    EXPECT_EQ(hasty.picture(), patient.picture());
}

TEST(StudioSession, ANewStateEndsTheWorkOnTheOneBefore) {
    Page page;
    page.show(
        {{"text", heavy}, {"name", "heavy.rifs"}, {"quality", "best"}, {"width", 640}, {"height", 360}});
    // The page goes on when something is seen.
    page.on_message = [&] {
        if (page.tiles.size() != 1) return;
        page.on_message = {};
        page.show({{"text", crystal}});
    };
    page.work();
    EXPECT_EQ(page.last("pass")["number"], 2);
    for (const json& said : page.heard)
        EXPECT_FALSE(said["type"] == "pass" && said["number"] == 1 && said["done"] == true);
}

TEST(StudioSession, AnotherThreadEndsWorkWithinAFewRays) {
    Page page;
    page.show(
        {{"text", heavy}, {"name", "heavy.rifs"}, {"quality", "best"}, {"width", 1920}, {"height", 1080}});
    std::thread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        page.session.stop();
    });
    page.work(); // a picture of minutes
    stopper.join();
    EXPECT_FALSE(page.session.work(1));
    EXPECT_NE(page.last("pass")["done"], true);
}

TEST(StudioSession, AsksAreAnsweredWhileAPictureIsDrawn) {
    Page page;
    page.show(
        {{"text", heavy}, {"name", "heavy.rifs"}, {"quality", "best"}, {"width", 640}, {"height", 360}});
    page.work_until([&] { return !page.tiles.empty(); });
    page.say({{"type", "ask"}, {"id", 1u << 30u}, {"what", "command"}});
    page.work_until([&] { return page.count("answer") > 0; });
    EXPECT_NE(page.last("pass")["done"], true);
    page.session.stop();
}

TEST(StudioSession, MessagesThatItCannotReadChangeNothing) {
    Page page;
    page.show({{"text", crystal}});
    page.work();
    const std::size_t heard = page.heard.size();
    std::string deep(100'000, '[');
    const std::string bad[] = {"",
                               "{",
                               "[]",
                               "7",
                               deep,
                               "\xff\xfe",
                               R"({"type": 5})",
                               R"({"type": "stat"})",
                               R"({"type": "state"})",
                               R"({"type": "state", "number": 1})",
                               R"({"type": "state", "number": -1})",
                               R"({"type": "state", "number": 1e30})",
                               R"({"type": "state", "number": 2, "width": 0})",
                               R"({"type": "state", "number": 2, "width": 16384, "height": 16384})",
                               R"({"type": "state", "number": 2, "camera": {"location": [0, 1]}})",
                               R"({"type": "state", "number": 2, "camera": {"angle_deg": 180}})",
                               R"({"type": "state", "number": 2, "camera": {"location": [0, 1, 1e300]}})",
                               R"({"type": "state", "number": 2, "zoom": "much"})",
                               R"({"type": "state", "number": 2, "at": "a..b"})",
                               R"({"type": "state", "number": 2, "quality": "fine"})",
                               R"({"type": "state", "number": 2, "steps": -1})",
                               R"({"type": "state", "number": 2, "set": {"spread": "wide"}})",
                               R"({"type": "ask", "what": "command"})",
                               R"({"type": "ask", "id": 1073741824})",
                               R"({"type": "ask", "id": 5, "what": "command"})",
                               R"({"type": "state", "number": 2, "film": {}})",
                               R"({"type": "state", "number": 2, "film": {"frames": 3, "steps": 4}})",
                               R"({"type": "state", "number": 2, "camera": {"up": [0, 0, 1e300]}})"};
    for (const std::string& message : bad)
        page.session.hear(message);
    page.work();
    EXPECT_EQ(page.heard.size(), heard + std::size(bad));
    EXPECT_EQ(page.count("fault"), std::size(bad));
    EXPECT_EQ(page.session.runs().viewed, 1u);
}

TEST(StudioSession, TheCommandLineSaysTheState) {
    Page page;
    page.show({{"text", crystal},
               {"name", "my model.rifs"},
               {"set", {{"spread", 0.25}}},
               {"seed", 3},
               {"steps", 4},
               {"camera", {{"location", {0, 1, 5}}, {"look_at", {0, 0, 0}}, {"angle_deg", 40}}}});
    page.work();
    EXPECT_EQ(page.ask("command")["command"],
              "graftal render 'my model.rifs' --size 64x36 --set spread=0.25 --steps 4 --seed 3 "
              "--camera 'location=0,1,5 look_at=0,0,0 angle=40' --quality draft --engine native");
    EXPECT_TRUE(page.ask("nonsense").contains("error"));
}

TEST(StudioSession, MomentsOfAFilmHaveItsView) {
    const nlohmann::json film{
        {"frames", 9}, {"fps", 3}, {"set", {{"spread", {{0, 0.1}, {0.5, 2}, {1, 0.5}}}}}};
    const auto camera = [&](double spread, const nlohmann::json& of) {
        Page page;
        page.show({{"text", crystal}, {"set", {{"spread", spread}}}, {"film", of}});
        page.work();
        return page.last("model")["camera"];
    };
    const nlohmann::json first = camera(0.1, film);
    EXPECT_EQ(first, camera(0.5, film));
    EXPECT_EQ(first, camera(2, film)) << "the largest moment";
    EXPECT_NE(first, camera(0.1, nullptr)) << "a single picture is framed by itself";

    Session session("crystal.rifs", crystal);
    SharedFraming all;
    StageOptions stages;
    stages.view.size = {64, 36};
    for (int frame = 0; frame < 9; ++frame) {
        const double t = frame / 8.0;
        stages.lower.set["spread"] = t < 0.5 ? std::lerp(0.1, 2.0, 2 * t) : std::lerp(2.0, 0.5, 2 * t - 1);
        Compilation compilation;
        all.include(*session.analysed(stages, compilation), std::nullopt);
    }
    all.settle({}, stages.view.size, false);
    Compilation compilation;
    const Vec3 expected = all.view(*session.analysed(stages, compilation), stages.view).camera.location;
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(first["location"][axis].get<double>(), expected[axis], 1e-12) << "as `animate` frames it";
}

/// A page that has drawn one state after the other.
Page& shown(Page& page, const std::vector<json>& states) {
    for (const json& state : states) {
        page.show(state);
        page.work();
    }
    return page;
}

TEST(StudioSession, AFilmsViewGoesBackWithItsCamera) {
    const json film{{"frames", 5}, {"set", {{"spread", {{0, 0.1}, {1, 2}}}}}};
    const json plain{{"text", crystal}, {"film", film}}, looked{{"camera", {{"location", {0, 9, 1}}}}};
    Page page, other;
    json from_above = plain;
    from_above.update(looked);
    const json first = shown(page, {plain}).last("model")["camera"];
    EXPECT_NE(shown(other, {from_above}).last("model")["camera"], first);
    EXPECT_EQ(shown(other, {plain}).last("model")["camera"], first);
}

TEST(StudioSession, AStateThatWasNeverDrawnLeavesNothingBehind) {
    const json second{{"text", heavy}}, turned{{"text", heavy}, {"camera", {{"location", {3, 2, 1}}}}};
    Page page, alone;
    shown(page, {{{"text", crystal}}});
    page.show(second);
    page.session.work(0); // compiles it
    shown(page, {turned});
    shown(alone, {turned});
    EXPECT_EQ(page.picture(64, 36), alone.picture(64, 36));
}

TEST(StudioSession, AThumbnailIsDrawnHoweverSmallTheBudget) {
    Page page;
    shown(page, {{{"text", crystal}}});
    page.say({{"type", "ask"},
              {"id", 1u << 30u},
              {"what", "thumbnail"},
              {"text", heavy},
              {"width", 96},
              {"height", 54}});
    int calls = 0;
    while (page.count("answer") == 0 && ++calls < 20'000)
        page.session.work(1e-5);
    EXPECT_FALSE(page.last("answer").contains("error"));
    EXPECT_LT(calls, 20'000);
}

TEST(StudioSession, AThumbnailOfABadFilmIsAnsweredAndThePictureStays) {
    Page page;
    shown(page, {{{"text", crystal}}});
    const json answer = page.ask("thumbnail", {{"width", 64}, {"height", 36}, {"film", json::object()}});
    EXPECT_TRUE(answer.contains("error"));
    EXPECT_EQ(page.count("fault"), 0u);
    EXPECT_FALSE(page.ask("thumbnail", {{"width", 64}, {"height", 36}}).contains("error"));
}

TEST(StudioSession, AsksThatWaitHoldABoundedAmountOfText) {
    Page page;
    const json large{
        {"type", "ask"}, {"id", 1u << 30u}, {"what", "x"}, {"text", std::string(12u << 20u, 'x')}};
    for (int i = 0; i < 4; ++i)
        page.say(large);
    page.work();
    EXPECT_EQ(page.count("answer"), 2u);
    EXPECT_EQ(page.count("fault"), 2u);
}

TEST(StudioSession, AFilmThatCannotBeReadIsAFault) {
    Page page;
    page.show({{"text", crystal}, {"film", {{"frames", 3}, {"set", {{"spread", "wide"}}}}}});
    page.work();
    EXPECT_NE(page.last("fault"), nlohmann::json());
}

constexpr const char* row_of_leaves = "use leaf = \"leaf.inst\"\nobject row { leaf }\n";

TEST(StudioSession, AFileThatComesOrIsWrittenIsReadAgain) {
    Page page;
    shown(page, {{{"name", "row.inst"}, {"text", row_of_leaves}}});
    EXPECT_EQ(page.last("findings")["findings"].size(), 1u);
    EXPECT_EQ(page.count("pass"), 0u);
    const auto work_after_look = [&] {
        page.session.look_at_files();
        page.work();
        return page.session.runs().lowered;
    };
    EXPECT_EQ(work_after_look(), 1u) << "nothing came";
    page.home.texts.set("leaf.inst", "object leaf { sphere }\n");
    EXPECT_EQ(work_after_look(), 2u);
    EXPECT_EQ(page.last("findings")["findings"], json::array());
    EXPECT_EQ(page.last("pass")["done"], true);
    const std::string picture = page.picture();
    page.home.texts.set("leaf.inst", "object leaf { cylinder }\n");
    EXPECT_EQ(work_after_look(), 3u);
    EXPECT_NE(page.picture(), picture);
    EXPECT_EQ(work_after_look(), 3u) << "nothing changed since";
    page.home.texts.remove("leaf.inst");
    shown(page, {{{"name", "row.inst"}}});
    EXPECT_EQ(page.last("findings")["findings"].size(), 1u) << "a state looks, too";
}

TEST(StudioSession, AFindingInAUsedFileNamesItAndPointsAtItsUse) {
    const std::string text = row_of_leaves, path = "\"leaf.inst\"";
    const auto finding = [&](const std::string& leaf, const std::string& folder) {
        Page page;
        page.home.texts.set("leaf.inst", leaf);
        page.home.folder = folder;
        shown(page, {{{"name", "row.inst"}, {"text", text}}});
        return page.last("findings")["findings"].at(0);
    };
    const json missing = finding("\nuse vein = \"vein.rifs\"\nobject leaf { vein }\n", "");
    const json outside = finding("\nuse vein = \"../vein.rifs\"\nobject leaf { vein }\n", ".");
    const json misspelt = finding("\nobject leaf { spere }\n", "");
    for (const json& found : {missing, outside, misspelt}) {
        EXPECT_TRUE(found["text"].get<std::string>().starts_with("leaf.inst, line 2: ")) << found;
        EXPECT_EQ(found["file"], "row.inst");
        EXPECT_EQ(found["from"], text.find(path)) << found;
        EXPECT_EQ(found["to"], text.find(path) + path.size()) << found;
    }
    EXPECT_NE(outside["hint"].get<std::string>().find("'graftal studio' in a folder above"),
              std::string::npos);
}

TEST(StudioSession, AThumbnailIsItsLastPassAlone) {
    Page page;
    shown(page, {{{"text", crystal}}});
    const std::size_t tiles_before = page.tiles.size();
    EXPECT_FALSE(page.ask("thumbnail", {{"width", 100}, {"height", 60}}).contains("error"));
    int pixels = 0;
    for (std::size_t i = tiles_before; i < page.tiles.size(); ++i) {
        const SeenTile& tile = page.tiles[i];
        EXPECT_EQ(tile.number, page.id);
        EXPECT_EQ(tile.pass, 0u) << "nobody waited for a coarse one";
        EXPECT_EQ(tile.block, 1);
        pixels += tile.width * tile.height;
    }
    EXPECT_EQ(pixels, 100 * 60);
}

TEST(StudioSession, AModelSaysWhetherSeedAndStepsChangeIt) {
    const auto told = [](const char* name, const char* text) {
        Page page;
        page.home.texts.set("twig.lsys",
                            "lsys twig {\n steps 2\n axiom F\n F -> FF : 0.5\n F -> F[+F] : 0.5\n}\n");
        const json model = shown(page, {{{"name", name}, {"text", text}}}).last("model");
        return std::pair(model["chance"].get<bool>(), model["grows"].get<bool>());
    };
    using Said = std::pair<bool, bool>;
    EXPECT_EQ(told("crystal.rifs", crystal), Said(false, true));
    EXPECT_EQ(told("a.lsys", "lsys a {\n steps 2\n axiom F\n F -> FF\n}\n"), Said(false, true));
    EXPECT_EQ(told("a.lsys", "lsys a {\n steps 2\n axiom F(1)\n F(s) -> F(normal(s, 0.1))F(s)\n}\n"),
              Said(true, true));
    EXPECT_EQ(told("a.lsys",
                   "lsys b {\n steps 2\n axiom F\n F -> FF\n}\nmain lsys a {\n steps 0\n axiom [~b]f~b\n}\n"),
              Said(false, false))
        << "the steps of a page are those of the main block";
    EXPECT_EQ(told("a.inst", "use twig = \"twig.lsys\"\nobject a { twig }\n"), Said(true, true));
    EXPECT_EQ(told("a.inst", "object a { sphere }\n"), Said(false, true));
    EXPECT_EQ(told("a.inst", "object a { scatter sphere 5 over disc 3 }\n").first, true);
}

/// The last pass of a picture that may take so much work.
ShownPass last_pass(double work_seconds, PicturePasses passes) {
    Session session("heavy.rifs", heavy);
    StageOptions stages;
    stages.view.size = {32, 18};
    Compilation compilation;
    PreparedView prepared;
    prepared.viewed = session.viewed(stages, compilation);
    prepared.detail = resolved(stages.detail, *prepared.viewed);
    prepared.prepared = session.prepared(stages, compilation);
    const SerialWorkers alone;
    ProgressivePicture picture(
        std::move(prepared), PictureWishes{.work_seconds = work_seconds},
        [&]() -> const Workers& { return alone; }, nullptr, 0, passes);
    ShownPass last;
    const auto never = [] { return false; };
    while (
        picture.step(never, never, {[](const ShownTile&) {}, [&](const ShownPass& pass) { last = pass; }})) {
    }
    return last;
}

TEST(ProgressivePicture, ALastPassThatWorkHasEndedSaysWhatTheWholePictureTakes) {
    const ShownPass whole = last_pass(1e6, PicturePasses::all);
    EXPECT_TRUE(whole.done);
    EXPECT_FALSE(whole.whole_seconds);
    const ShownPass ended = last_pass(0.002, PicturePasses::all);
    EXPECT_TRUE(ended.done);
    ASSERT_TRUE(ended.whole_seconds);
    EXPECT_GT(*ended.whole_seconds, 0.002);
    const ShownPass alone = last_pass(0.002, PicturePasses::last);
    EXPECT_EQ(alone.pass, 0);
    EXPECT_EQ(alone.samples, ended.samples);
    EXPECT_EQ(alone.whole_seconds, ended.whole_seconds);
}

} // namespace
} // namespace graftal
