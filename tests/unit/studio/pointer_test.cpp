#include <cmath>

#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "runtime/studio/address_text.h"
#include "tests/unit/studio/page.h"

namespace graftal {
namespace {

using nlohmann::json;

/// A flat gasket of squares, seen face on.
constexpr const char* carpet = "rifs carpet {\n"
                               "  map a { scale 1/3  translate <-2/3, -2/3, 0> }\n"
                               "  map b { scale 1/3  translate <2/3, -2/3, 0> }\n"
                               "  map c { scale 1/3  translate <-2/3, 2/3, 0> }\n"
                               "  map d { scale 1/3  translate <2/3, 2/3, 0> }\n"
                               "  map e { scale 1/3 }\n"
                               "  terminal cube\n"
                               "}\n"
                               "camera { location <0, 0, 5>  look_at <0, 0, 0>  angle 40 }\n";

Vec3 vector_of(const json& numbers) {
    return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

/// Where the page's camera shows a point, in a picture of 64x36 pixels.
glm::dvec2 pixel_of(const json& camera, Vec3 point) {
    const Vec3 location = vector_of(camera["location"]);
    const Vec3 into = glm::normalize(vector_of(camera["look_at"]) - location);
    const Vec3 right = glm::normalize(glm::cross(into, vector_of(camera["up"])));
    const Vec3 up = glm::cross(right, into);
    const double depth = glm::dot(point - location, into);
    const double half =
        depth * std::tan(0.5 * camera["angle_deg"].get<double>() * 3.14159265358979323846 / 180);
    return {32 + 32 * glm::dot(point - location, right) / half,
            18 - 32 * glm::dot(point - location, up) / half};
}

TEST(Pointer, PickNamesThePartUnderThePixel) {
    Page page;
    page.show({{"text", carpet}, {"name", "carpet.rifs"}});
    page.work();
    const json camera = page.last("model")["camera"];
    const glm::dvec2 pixel = pixel_of(camera, {2.0 / 3, 2.0 / 3, 0});
    const json picked = page.ask("pick", {{"x", pixel.x}, {"y", pixel.y}});
    ASSERT_TRUE(picked.contains("address")) << picked;
    EXPECT_EQ(picked["address"].get<std::string>().substr(0, 1), "d") << picked;
    EXPECT_EQ(picked["path"][0], "d");
    EXPECT_NEAR(picked["point"][0].get<double>(), 2.0 / 3, 0.1);
    EXPECT_EQ(std::string(carpet).substr(picked["from"], 3), "e {") << "the map of the last step: " << picked;
    EXPECT_FALSE(page.ask("pick", {{"x", 1}, {"y", 1}}).contains("point")) << "the background";
}

TEST(Pointer, AZoomKeepsThePointUnderThePixelAndLeadsBackToTheVeryView) {
    Page page;
    json view{{"at", nullptr}, {"zoom", nullptr}, {"camera", nullptr}};
    const auto show = [&] {
        json state{{"text", carpet}, {"name", "carpet.rifs"}};
        state.update(view);
        page.show(state);
        page.work();
        ASSERT_EQ(page.last("pass")["number"], page.number) << page.heard.back();
    };
    show();
    const std::string whole = page.picture();
    const glm::dvec2 pixel = pixel_of(page.last("model")["camera"], {2.0 / 3, 2.0 / 3, 0});
    std::vector<json> views;
    for (int i = 0; i < 40; ++i) {
        views.push_back(view);
        const json nearer = page.ask("zoom", {{"x", pixel.x}, {"y", pixel.y}, {"factor", 8}});
        ASSERT_FALSE(nearer.contains("error")) << i << nearer;
        for (const char* const field : {"at", "zoom", "camera"})
            view[field] = nearer[field];
        if (i % 10 == 9)
            show();
        else {
            json state{{"text", carpet}, {"name", "carpet.rifs"}};
            state.update(view);
            page.show(state);
        }
    }
    show();
    EXPECT_FALSE(view["at"].is_null());
    EXPECT_GT(std::log10(std::stod(view["zoom"].get<std::string>())), 30) << view;
    const json picked = page.ask("pick", {{"x", pixel.x}, {"y", pixel.y}});
    ASSERT_TRUE(picked.contains("point")) << "the part is still there";
    EXPECT_EQ(picked["path"][0], "d");
    EXPECT_GT(picked["path"].size(), 40u);
    for (int i = 39; i >= 0; --i) {
        const json farther = page.ask("zoom", {{"x", pixel.x}, {"y", pixel.y}, {"factor", 0.125}});
        for (const char* const field : {"at", "zoom", "camera"})
            view[field] = farther[field];
        EXPECT_EQ(view, views[static_cast<std::size_t>(i)]) << i;
        json state{{"text", carpet}, {"name", "carpet.rifs"}};
        state.update(view);
        page.show(state);
    }
    page.work();
    EXPECT_EQ(page.picture(), whole);
}

TEST(Pointer, AZoomOutElsewhereLeadsToTheWholeToo) {
    Page page;
    json view{{"text", carpet}, {"name", "carpet.rifs"}};
    page.show(view);
    page.work();
    const glm::dvec2 pixel = pixel_of(page.last("model")["camera"], {2.0 / 3, 2.0 / 3, 0});
    const auto zoom = [&](double x, double y, double factor) {
        const json next = page.ask("zoom", {{"x", x}, {"y", y}, {"factor", factor}});
        ASSERT_FALSE(next.contains("error")) << next;
        for (const char* const field : {"at", "zoom", "camera"})
            view[field] = next[field];
        page.show(view);
    };
    for (int i = 0; i < 8; ++i)
        zoom(pixel.x, pixel.y, 4);
    EXPECT_FALSE(view["zoom"].is_null());
    for (int i = 0; i < 16; ++i)
        zoom(32, 18, 0.25);
    EXPECT_TRUE(view["zoom"].is_null()) << view;
    EXPECT_GT(glm::length(vector_of(view["camera"]["location"])), 5);
}

TEST(AddressText, FindsThePathAgain) {
    Session session("carpet.rifs", carpet);
    Compilation compilation;
    StageOptions options;
    options.stop_after = "drop_unreachable";
    const auto model = session.analysed(options, compilation);
    ASSERT_TRUE(model);
    const Graph& graph = model->graph;
    std::vector<GraphStep> path;
    for (const std::uint32_t instance : {0u, 0u, 0u, 0u, 0u, 1u, 2u, 1u, 2u, 1u, 2u, 3u}) {
        const ObjectId object =
            path.empty() ? graph.root
                         : graph.objects[path.back().object].instances[path.back().instance].master;
        if (graph.objects[object].instances.size() <= instance) break;
        path.push_back({object, instance});
    }
    const std::string text = address_of(graph, path);
    std::string problem;
    const auto address = parse_address(text, problem);
    ASSERT_TRUE(address) << text << problem;
    Diagnostics diagnostics;
    const auto found = find_path(graph, *address, diagnostics);
    ASSERT_TRUE(found) << text;
    EXPECT_EQ(found->steps, path) << text;
    EXPECT_LT(text.size(), 40u) << text;
}

} // namespace
} // namespace graftal
