// Maps by images of points, and rows of barycentric weights (Kocic's affine invariant systems).

#include <array>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "compiler/lower/point_maps.h"

namespace graftal {
namespace {

/// Maps of a text, as its graph has them: those of the instances of the first object of each map.
std::vector<Affine> maps_of(const std::string& text, std::string* messages = nullptr) {
    SourceMap sources;
    Diagnostics diagnostics;
    const std::optional<Graph> graph = lower_text("m.rifs", text, {}, sources, diagnostics).graph;
    if (messages)
        *messages = diagnostics.render(sources);
    else
        EXPECT_EQ(diagnostics.render(sources), "");
    std::vector<Affine> maps;
    if (!graph) return maps;
    for (const Object& object : graph->objects)
        if (&object != &graph->objects[graph->root] && !object.primitive)
            maps.push_back(object.instances.front().parent_from_child);
    return maps;
}

double difference(const Affine& a, const Affine& b) {
    double most = glm::length(a.translation - b.translation);
    for (int i = 0; i < 3; ++i)
        most = std::max(most, glm::length(a.linear[i] - b.linear[i]));
    return most;
}

std::string text_of(const std::vector<Vec3>& points, int dimensions) {
    std::string text;
    for (const Vec3& p : points)
        text += (text.empty() ? "" : ", ") +
                (dimensions == 2 ? fmt::format("<{:.17g}, {:.17g}>", p.x, p.y)
                                 : fmt::format("<{:.17g}, {:.17g}, {:.17g}>", p.x, p.y, p.z));
    return text;
}

TEST(MapsByPoints, AreThoseThatTakeThePointsToTheirImages) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const int kind = i % 3, dimensions = kind == 2 ? 3 : 2;
        const auto vector = [&](double size) {
            return size * Vec3(number(random), number(random), dimensions == 3 ? number(random) : 0);
        };
        Affine map{Mat3(vector(0.5), vector(0.5), vector(0.5)), vector(1)};
        const Vec3 x = map.linear[0];
        if (kind == 0) map = flat_map(x, {-x.y, x.x, 0}, map.translation);
        if (kind == 1) map = flat_map(x, map.linear[1], map.translation);
        std::vector<Vec3> points, images;
        for (int k = 0; k < kind + 2; ++k) {
            points.push_back(vector(3));
            images.push_back(map(points.back()));
        }
        const std::vector<Affine> maps =
            maps_of(fmt::format("rifs a {{ map m {{ points {} -> {} }} map n {{ scale 1/2 }} }}",
                                text_of(points, dimensions), text_of(images, dimensions)));
        ASSERT_EQ(maps.size(), 2u);
        EXPECT_LT(difference(maps[0], map), 1e-9) << i;
    }
}

TEST(MapsByPoints, SayWhatIsWrong) {
    const auto said = [](const std::string& points) {
        std::string messages;
        maps_of("rifs a { map m { points " + points + " } }", &messages);
        return messages;
    };
    const auto has = [&](const std::string& points, const std::string& part) {
        EXPECT_NE(said(points).find(part), std::string::npos) << said(points);
    };
    has("<0, 0>, <1, 1>, <2, 2> -> <0, 0>, <1, 0>, <0, 1>", "these three points lie on one line");
    has("<0, 0>, <0, 0> -> <0, 0>, <1, 0>", "these two points are one");
    has("<0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> -> <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <0, 0, 1>",
        "these four points lie in one plane");
    has("<0, 0>, <1, 0> -> <0, 0>", "2 points have 1 images");
    has("<0, 0>, <1, 0, 0> -> <0, 0>, <1, 0>", "this point has 3 coordinates, the first one has 2");
    has("<0, 0> -> <1, 0>", "1 points with 2 coordinates make no map");
    has("<0, 0>, <1, 0>", "expected '->' and the images of the points");
    has("0, 0", "expected a point, which begins with '<'");
    has("<0, 0>, <1, 0>, <0, 1> -> <0, 0>, <1, 0>, <2, 0>", "singular");
}

/// Rows of `codes 2d`.
using Codes = std::vector<std::array<double, 6>>;

/// Weights of the control points in the images of each under a flat map.
std::string weights(const std::vector<Vec3>& control, const Affine& map) {
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Affine shares = *map_by_points(control, corners);
    std::string row;
    for (const Vec3& point : control) {
        const Vec3 at = shares(map(point));
        row += fmt::format("{:.17g} {:.17g} {:.17g} ", 1 - at.x - at.y, at.x, at.y);
    }
    return row;
}

TEST(Barycentric, MapsFollowTheControlPoints) {
    const Codes gasket = {{.5, 0, 0, .5, 0, 0}, {.5, 0, 0, .5, .5, 0}, {.5, 0, 0, .5, 0, .5}};
    const Codes fern = {
        {.85, .04, -.04, .85, 0, 1.6}, {.2, -.26, .23, .22, 0, 1.6}, {-.15, .28, .26, .24, 0, .44}};
    const Codes dragon = {{.5, -.5, .5, .5, 0, 0}, {-.5, -.5, .5, -.5, 1, 0}};
    const std::vector<Vec3> control = {{-1, 0, 0}, {2, 0.5, 0}, {0.3, 3, 0}};
    const std::vector<std::vector<Vec3>> places = {
        control,
        {{-1, 0, 0}, {2, 0.5, 0}, {1.5, 2, 0}},
        {{-3, -1, 0}, {2, 0.5, 0}, {1.5, 2, 0}},
        {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, // mirrored
        {{-1e3, 0, 0}, {1e3, 0, 0}, {0, 7, 0}},
    };
    for (const Codes& system : {gasket, fern, dragon}) {
        std::vector<Affine> by_hand;
        std::string rows;
        for (const auto& [a, b, c, d, e, f] : system) {
            by_hand.push_back(flat_map({a, c, 0}, {b, d, 0}, {e, f, 0}));
            rows += "    " + weights(control, by_hand.back()) + "\n";
        }
        for (const std::vector<Vec3>& moved : places) {
            const std::vector<Affine> maps = maps_of("rifs a {\n  codes barycentric {\n" + rows +
                                                     "  }\n  control " + text_of(moved, 2) + "\n}\n");
            ASSERT_EQ(maps.size(), by_hand.size());
            // The set is bent by the map of the control points, and with it each map.
            const Affine bend = *map_by_points(control, moved);
            for (std::size_t i = 0; i < maps.size(); ++i) {
                const Affine wanted = bend * by_hand[i] * inverse(bend);
                EXPECT_LT(
                    difference(maps[i], flat_map(wanted.linear[0], wanted.linear[1], wanted.translation)),
                    1e-12 * (1 + 1e3 * glm::length(wanted.translation)));
            }
        }
    }
}

TEST(Barycentric, OfSpace) {
    const std::vector<Affine> maps = maps_of("rifs a {\n"
                                             "  control <1, 1, 1>, <1, -1, -1>, <-1, 1, -1>, <-1, -1, 1>\n"
                                             "  codes barycentric {\n"
                                             "    a: 1 0 0 0  .5 .5 0 0  .5 0 .5 0  .5 0 0 .5  1\n"
                                             "  }\n}\n");
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_LT(difference(maps[0], Affine::translate(Vec3(0.5)) * Affine::scale(Vec3(0.5))), 1e-15);
}

TEST(Barycentric, SaysWhatIsWrong) {
    const auto has = [&](const std::string& items, const std::string& part) {
        std::string messages;
        maps_of("rifs a {\n" + items + "\n}\n", &messages);
        EXPECT_NE(messages.find(part), std::string::npos) << messages;
    };
    const std::string row = "codes barycentric { 1 0 0  .5 .5 0  .5 0 .5 }";
    has(row, "'rifs a' has no control points for this row");
    has("control <0, 0>, <1, 0>\n" + row, "2 control points with 2 coordinates");
    has("control <0, 0>, <1, 0>, <2, 0>\n" + row, "these control points lie on one line");
    has("control <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <0, 0, 1>\n" + row, "this row has 9 weights");
    has("control <0, 0>, <1, 0>, <0, 1>\ncodes barycentric { 1 0 0  .5 .4 0  .5 0 .5 }",
        "the weights of this image add up to 0.9, not 1");
    has("control <0, 0>, <1, 0>, <0, 1>\ncontrol <0, 0>, <1, 0>, <0, 1>\n" + row, "duplicate 'control'");
    has("control <0, 0>, <1, 0>, <0, 1>\ncodes barycentric { 1 0 0  .5 .5 0 }", "takes 9 or 10");
}

} // namespace
} // namespace graftal
