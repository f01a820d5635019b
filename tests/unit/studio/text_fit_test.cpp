// The ask `fit`: maps of a text move until their attractor is a target.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/editing/maps/maps.h"
#include "runtime/inverse/plane_map.h"
#include "tests/unit/studio/page.h"

namespace graftal {
namespace {

using nlohmann::json;

/// Three copies side by side, the last one turned, in the square from <0, 0> to <1, 1>.
const PlaneMaps chair = {{0.5, 0, 0, 0.5, 0, 0}, {0.5, 0, 0, 0.5, 0.5, 0}, {0, -0.5, 0.5, 0, 0.5, 0.5}};
constexpr int side = 200;

/// The field `target` of a picture of so many pixels whose dark ones `dark` chooses by column and row.
template<typename Dark> json target_of(int width, int height, const Dark& dark) {
    json runs = json::array({0});
    bool inside = false;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (dark(x, y) != inside) runs.push_back(0);
            inside = dark(x, y);
            runs.back() = runs.back().get<int>() + 1;
        }
    return {{"width", width}, {"height", height}, {"cell", 1}, {"runs", runs}};
}

/// The chair by the chaos game (Barnsley 1988), which shares nothing with the fit.
json chair_target() {
    std::vector<bool> dark(side * side);
    Draws draws(CounterRandom(9), 0);
    Vec2 p = fixed_point(chair.front());
    for (int i = 0; i < 500'000; ++i) {
        p = chair[draws.below(chair.size())](p);
        const int x = static_cast<int>(p.x * side), y = side - 1 - static_cast<int>(p.y * side);
        if (x >= 0 && y >= 0 && x < side && y < side) dark[static_cast<std::size_t>(y * side + x)] = true;
    }
    return target_of(side, side,
                     [&](int x, int y) -> bool { return dark[static_cast<std::size_t>(y * side + x)]; });
}

/// The chair as a text, its numbers off by random ones of this size.
std::string chair_text(double off) {
    Draws draws(CounterRandom(4), 0);
    std::string text = "# by hand\nrifs chair {\n  codes 2d {\n";
    for (const PlaneMap& map : chair) {
        for (const double number : {map.a, map.b, map.c, map.d, map.e, map.f})
            text += fmt::format(" {:.3f}", number + off * draws.normal());
        text += "  0.25  tint rgb <0, 0.5, 0> 0.5 # a copy\n";
    }
    return text + "  }\n}\n";
}

std::string edited(const std::string& text, const json& edits) {
    std::vector<TextEdit> list;
    for (const json& edit : edits)
        list.push_back({edit["from"], edit["to"], edit["text"]});
    return applied(text, list);
}

/// The farthest that a map of the text takes a corner of the square from where the chair's takes it, in
/// pixels.
double farthest_px(const std::string& text) {
    const std::vector<EditableMap> maps = maps_of({"chair.rifs", text});
    double far = maps.size() == chair.size() ? 0 : 1e9;
    for (std::size_t i = 0; i < std::min(maps.size(), chair.size()); ++i)
        for (const Vec2 p : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
            const Vec3 q = maps[i].matrix(Vec3(p.x, p.y, 0));
            const Vec2 away = Vec2(q.x, q.y) - chair[i](p);
            far = std::max(far, side * std::hypot(away.x, away.y));
        }
    return far;
}

/// Runs numbers backwards, as one of three.
class BackwardsWorkers final : public Workers {
  public:
    int count() const override { return 3; }
    int for_each(std::uint64_t count,
                 const std::function<void(int worker, std::uint64_t number)>& work) const override {
        for (std::uint64_t number = count; number-- > 0;)
            work(static_cast<int>(number % 3), number);
        return 1;
    }
};

/// A page that shows the text.
void show_text(Page& page, const std::string& text, json more = json::object()) {
    more["name"] = "chair.rifs";
    more["text"] = text;
    page.show(more);
    page.work();
}

TEST(TextFit, MapsALittleOffComeWithinACell) {
    Page page;
    const std::string text = chair_text(0.03);
    show_text(page, text);
    page.heard.clear();
    const json answer = page.ask("fit", {{"target", chair_target()}});
    ASSERT_FALSE(answer.contains("error")) << answer;
    const std::string after = edited(text, answer["edits"]);
    EXPECT_GT(farthest_px(text), 10);
    EXPECT_LT(farthest_px(after), 1) << after;
    EXPECT_LT(answer["before"], 0.7);
    EXPECT_GT(answer["iou_within_a_cell"], 0.998);
    EXPECT_GT(answer["iou"], 0.95);
    EXPECT_LT(answer["chamfer_cells"], 0.05);
    EXPECT_LE(answer["work_seconds"], 5.5);
    EXPECT_EQ(after.find("# by hand\nrifs chair {"), 0u);
    for (std::size_t at = 0, i = 0; i < chair.size(); ++i, ++at)
        EXPECT_NE(at = after.find("  0.25  tint rgb <0, 0.5, 0> 0.5 # a copy\n", at), std::string::npos)
            << after;
    // Shares grow to the end, by thousandths.
    double share = 0;
    for (const json& said : page.heard)
        if (said["type"] == "progress") {
            EXPECT_EQ(said["number"], answer["id"]);
            EXPECT_EQ(said["stage"], "fit");
            EXPECT_GT(std::floor(1000 * said["share"].get<double>()), std::floor(1000 * share));
            share = said["share"];
        }
    EXPECT_GT(share, 0.05);
}

TEST(TextFit, TheAnswerDependsOnNoWorkersAndNoView) {
    const std::string text = chair_text(0.02);
    const json ask{{"target", chair_target()}, {"work", 0.3}};
    Page one, three;
    show_text(one, text);
    const json answer = one.ask("fit", ask);
    const BackwardsWorkers backwards;
    three.home.hands = &backwards;
    show_text(three, text);
    bool panned = false;
    three.on_message = [&] {
        if (!std::exchange(panned, three.count("progress") > 1) && panned)
            three.show({{"name", "chair.rifs"},
                        {"camera", {{"location", {0.5, 0.5, 3}}, {"look_at", {0.5, 0.5, 0}}}}});
    };
    EXPECT_EQ(three.ask("fit", ask), answer);
    EXPECT_TRUE(panned);
}

TEST(TextFit, AStopKeepsTheBestAndAnotherTextEndsIt) {
    const std::string text = chair_text(0.05);
    for (const bool stops : {true, false}) {
        Page page;
        show_text(page, text);
        page.on_message = [&] {
            if (page.heard.back()["type"] != "progress") return;
            if (stops)
                page.say({{"type", "ask"}, {"id", 1u << 31u}, {"what", "stop"}, {"number", page.id}});
            else
                page.show({{"name", "chair.rifs"}, {"text", text + "\n"}});
        };
        const json answer = page.ask("fit", {{"target", chair_target()}, {"work", 60}});
        EXPECT_EQ(page.count("progress"), 1u);
        if (stops) {
            EXPECT_GE(answer["iou_within_a_cell"], answer["before"]);
            EXPECT_LT(answer["work_seconds"], 10);
        } else {
            EXPECT_EQ(answer["error"], "the model was changed meanwhile");
        }
        EXPECT_EQ(page.ask("hover", {{"offset", 0}})["type"], "answer") << "the session goes on";
    }
}

struct Refusal {
    const char* name;
    std::string text;
    json ask;
    const char* says;
};

TEST(TextFit, RefusalsSayWhatToDo) {
    const std::string text = chair_text(0.01),
                      head =
                          "rifs chair {\n map a { scale 1/2 }\n map b { scale 1/2 translate <1/2, 0, 0> }\n";
    const json target = chair_target(), whole{{"target", target}};
    const auto sent = [&](const char* field, json value) {
        json changed = whole;
        changed["target"][field] = std::move(value);
        return changed;
    };
    const Refusal refusals[] = {
        {"none", text, json::object(), "'target' is missing"},
        {"empty", text, {{"target", target_of(50, 50, [](int, int) { return false; })}}, "has 0 dark"},
        {"a pixel", text, {{"target", target_of(1, 1, [](int, int) { return true; })}}, "has 1 dark"},
        {"no side", text, sent("width", 0), "no pixel"},
        {"huge", text, sent("width", 1e9), "'width'"},
        {"too many cells", text, sent("width", 2000), "at most 1024"},
        {"runs too long", text, sent("runs", {0, 40001}), "'runs' are not"},
        {"runs below none", text, sent("runs", {-1, 5}), "'runs' are not"},
        {"runs of none", text, sent("runs", "x"), "no list"},
        {"work", text, {{"target", target}, {"work", 1e9}}, "'work'"},
        {"errors", head, whole, "mend them"},
        {"digraph", head + " follow all except self\n}\n", whole, "without 'follow'"},
        {"space", head + " map c { scale 1/2 translate <0, 0, 1> }\n}\n", whole, "of the plane"},
        {"far", "rifs far {\n codes 2d {\n .5 0 0 .5 50 40\n .5 0 0 .5 60 40\n .5 0 0 .5 50 50\n }\n}\n",
         whole, "multiply what each map translates by"},
    };
    Page page;
    std::string shown;
    for (const Refusal& refusal : refusals) {
        if (std::exchange(shown, refusal.text) != refusal.text) show_text(page, refusal.text);
        const json answer = page.ask("fit", refusal.ask);
        ASSERT_TRUE(answer.contains("error")) << refusal.name << answer;
        EXPECT_NE(answer["error"].get<std::string>().find(refusal.says), std::string::npos)
            << refusal.name << ": " << answer["error"];
    }
}

} // namespace
} // namespace graftal
