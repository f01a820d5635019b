// Every L-system of the scenes, at several depths: composed part by part, and derived module by module.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "runtime/system/disk_files.h"
#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using ::graftal::testing::Stroke;
using ::graftal::testing::Unfolding;

constexpr double most_modules = 300'000;

std::vector<std::string> lsys_scenes() {
    std::vector<std::string> scenes;
    const std::filesystem::path root = GRAFTAL_SOURCE_DIR;
    for (const char* folder : {"scenes/abop", "scenes/papers"})
        for (const auto& entry : std::filesystem::directory_iterator(root / folder))
            if (entry.path().extension() == ".lsys")
                scenes.push_back(std::filesystem::relative(entry.path(), root).string());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

struct Lowered {
    Graph graph;
    Derivation derivation;
};

std::optional<Lowered> lower(const std::string& path, unsigned steps, bool exact,
                             std::uint64_t run_from = UINT64_MAX) {
    std::ifstream file(path);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    LowerOptions options;
    options.steps = steps;
    options.exact = exact;
    options.run_from = run_from;
    SourceMap sources;
    Diagnostics diagnostics;
    auto [graph, notes] = lower_text(path, text, options, sources, diagnostics, {.files = &disk_files()});
    if (!graph) {
        // Some draw nothing in their first steps.
        EXPECT_NE(diagnostics.render(sources).find("draws nothing"), std::string::npos)
            << diagnostics.render(sources);
        return std::nullopt;
    }
    return Lowered{std::move(*graph), std::move(*notes.derivation)};
}

/// Polygons that begin in one part and end in another come in another order: sorted along no axis of any
/// model.
void sort(std::vector<std::array<Vec3, 3>>& triangles) {
    const auto along = [](const std::array<Vec3, 3>& t) {
        return glm::dot(t[0] + 1.1 * t[1] + 1.3 * t[2], Vec3(0.48273, 0.71931, 0.49942));
    };
    std::ranges::sort(triangles, {}, along);
}

/// What a run draws comes after the models that are placed between its parts.
void sort(std::vector<Stroke>& strokes) {
    const auto along = [](const Stroke& s) {
        return glm::dot(s.from + 1.3 * s.to, Vec3(0.48273, 0.71931, 0.49942));
    };
    std::ranges::sort(strokes, {}, along);
}

void expect_same_drawing(const Graph& a, const Graph& b, const std::string& what, bool in_order = true) {
    Unfolding x(a), y(b);
    sort(x.triangles);
    sort(y.triangles);
    if (!in_order) sort(x.strokes), sort(y.strokes);
    ASSERT_EQ(x.strokes.size(), y.strokes.size()) << what;
    ASSERT_EQ(x.triangles.size(), y.triangles.size()) << what;
    ASSERT_EQ(x.balls, y.balls) << what;
    double size = 0, worst = 0;
    for (std::size_t i = 0; i < x.strokes.size(); ++i) {
        size = std::max(size, glm::length(x.strokes[i].to));
        worst = std::max({worst, glm::distance(x.strokes[i].from, y.strokes[i].from),
                          glm::distance(x.strokes[i].to, y.strokes[i].to)});
    }
    for (std::size_t i = 0; i < x.triangles.size(); ++i)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            size = std::max(size, glm::length(x.triangles[i][corner]));
            worst = std::max(worst, glm::distance(x.triangles[i][corner], y.triangles[i][corner]));
        }
    EXPECT_LE(worst, 1e-9 * size) << what;
}

class LsysScene : public ::testing::TestWithParam<std::string> {};

TEST_P(LsysScene, ComposedIsDerived) {
    const std::string path = std::string(GRAFTAL_SOURCE_DIR) + "/" + GetParam();
    std::size_t compared = 0;
    for (unsigned steps = 0; steps <= 80; steps = steps < 8 ? steps + 1 : steps * 5 / 4) {
        const std::optional<Lowered> composed = lower(path, steps, false);
        if (!composed) continue;
        if (std::stod(composed->derivation.modules) > most_modules) break;
        const std::string what = GetParam() + " after " + std::to_string(steps) + " steps";
        const std::optional<Lowered> derived = lower(path, steps, true);
        ASSERT_TRUE(derived) << what;
        // Module by module, without a word where that can be.
        const std::optional<Lowered> in_run = lower(path, steps, true, 0);
        ASSERT_TRUE(in_run) << what;
        EXPECT_EQ(in_run->derivation.modules, derived->derivation.modules) << what;
        EXPECT_EQ(in_run->derivation.segments, derived->derivation.segments) << what;
        if (derived->derivation.variants == 1) // interpretations are drawn otherwise by chance
            expect_same_drawing(in_run->graph, derived->graph, what + ", in a run", false);
        // Chance falls otherwise in a pool than in a word; contexts are always derived.
        if (composed->derivation.variants > 1) continue;
        EXPECT_EQ(composed->derivation.modules, derived->derivation.modules) << what;
        EXPECT_EQ(composed->derivation.segments, derived->derivation.segments) << what;
        expect_same_drawing(composed->graph, derived->graph, what);
        ++compared;
    }
    RecordProperty("depths", std::to_string(compared));
}

INSTANTIATE_TEST_SUITE_P(Scenes, LsysScene, ::testing::ValuesIn(lsys_scenes()), [](const auto& scene) {
    std::string name = std::filesystem::path(scene.param).stem().string();
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
    return name;
});

} // namespace
} // namespace graftal
