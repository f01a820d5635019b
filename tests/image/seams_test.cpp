// Faces that share edges leave no gap: rays at what they cover together meet it, those at the edges and
// corners, too.

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "compiler/support/counter_random.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {
namespace {

class Draw {
  public:
    explicit Draw(std::uint64_t seed) : random_(seed) {}

    double between(double least, double most) {
        return least + (most - least) * CounterRandom::unit(random_(count_++));
    }
    int whole(int least, int most) { return least + static_cast<int>(between(0, 1) * (most - least + 1)); }

  private:
    CounterRandom random_;
    std::uint64_t count_ = 0;
};

/// A flat shape in z = 0, and points of it, some of them on edges and corners of its faces.
struct Covered {
    std::string text; ///< of objects; the last is `flat`
    std::string mesh; ///< an OBJ, if the text uses one
    std::vector<Vec3> points;
};

/// Triangles about one point, by instances.
Covered fan(Draw& draw) {
    const int count = draw.whole(3, 60);
    const double step = 2 * std::numbers::pi / count;
    Covered covered;
    covered.text =
        fmt::format("canonical object T {{ polygon(0, 0, cos({0}), sin({0}), cos({0}), -sin({0})) }}\n"
                    "canonical object flat {{ repeat {1} {{ rotate: z, {2} }} T }}\n",
                    180.0 / count, count, 360.0 / count);
    covered.points.emplace_back(0, 0, 0);
    for (int i = 0; i < 300; ++i) {
        const double on_spoke = (draw.whole(0, count - 1) + 0.5) * step;
        const double angle = i % 2 ? on_spoke : draw.between(0, 2 * std::numbers::pi);
        const double r = draw.between(0, 0.99 * std::cos(step / 2));
        covered.points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    return covered;
}

/// Squares side by side, by instances.
Covered squares(Draw& draw) {
    const int across = draw.whole(1, 9), up = draw.whole(1, 9);
    const double side = draw.between(0.1, 3);
    Covered covered;
    covered.text = fmt::format("canonical object S {{ polygon(0, 0, {0}, 0, {0}, {0}, 0, {0}) }}\n"
                               "canonical object flat {{ repeat {1} {{ translate: {0}, 0, 0 }} "
                               "repeat {2} {{ translate: 0, {0}, 0 }} S }}\n",
                               side, across, up);
    for (int i = 0; i < 300; ++i) {
        Vec3 point(draw.between(0.001, across - 0.001), draw.between(0.001, up - 0.001), 0);
        if (i % 3 > 0 && across > 1) point.x = draw.whole(1, across - 1);
        if (i % 3 > 1 && up > 1) point.y = draw.whole(1, up - 1);
        covered.points.push_back(side * point);
    }
    return covered;
}

/// A net of triangles whose inner corners are moved, in one mesh.
Covered net(Draw& draw) {
    const int cells = draw.whole(1, 20);
    std::vector<Vec3> corners;
    Covered covered;
    covered.text = "canonical object flat { mesh \"net.obj\" }\n";
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const bool inside = i > 0 && j > 0 && i < cells && j < cells;
            const auto moved = [&](int k) { return (k + (inside ? draw.between(-0.3, 0.3) : 0)) / cells; };
            const double x = moved(i);
            corners.emplace_back(x, moved(j), 0);
            covered.mesh += fmt::format("v {} {} 0\n", corners.back().x, corners.back().y);
        }
    const auto number = [&](int i, int j) { return j * (cells + 1) + i; };
    const auto middle = [&](int a, int b, double share) {
        return glm::mix(corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)], share);
    };
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const int a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
            covered.mesh += fmt::format("f {} {} {}\nf {} {} {}\n", a + 1, b + 1, c + 1, a + 1, c + 1, d + 1);
            covered.points.push_back(middle(a, c, draw.between(0.001, 0.999)));
            if (i > 0 && j > 0) covered.points.push_back(corners[static_cast<std::size_t>(a)]);
            if (j > 0) covered.points.push_back(middle(a, b, draw.between(0.001, 0.999)));
            covered.points.push_back(middle(b, d, draw.between(0.01, 0.99)));
        }
    return covered;
}

std::unique_ptr<TraceModel> load(const Covered& covered, const std::string& place) {
    TemporaryDirectory directory;
    EXPECT_TRUE(directory.create().ok());
    const std::string path = directory.path() + "/m.inst";
    EXPECT_TRUE(write_text(path, covered.text + "object m { flat " + place + " }\n").ok());
    EXPECT_TRUE(write_text(directory.path() + "/net.obj", covered.mesh).ok());
    StageOptions options;
    options.view.light = DefaultLight::plain;
    Compilation compilation;
    Session session(path, disk_files());
    const auto viewed = session.viewed(options, compilation);
    const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
    if (!prepared) return nullptr;
    return std::make_unique<TraceModel>(prepared, viewed->view, resolved(options.detail, *viewed));
}

TEST(Seams, NoRayPassesBetweenFacesWithCommonEdges) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Draw draw(seed);
        const Covered covered = seed % 3 == 0 ? fan(draw) : seed % 3 == 1 ? squares(draw) : net(draw);
        const double scale = std::exp(draw.between(-4, 4));
        const Vec3 to(draw.between(-9, 9), draw.between(-9, 9), draw.between(-9, 9));
        const auto model =
            load(covered, fmt::format("scale: {} translate: {}, {}, {}", scale, to.x, to.y, to.z));
        ASSERT_TRUE(model) << covered.text;
        Traversal alone(*model), together(*model);
        std::vector<Ray> rays;
        for (const Vec3& point : covered.points) {
            const Vec3 direction = glm::normalize(Vec3(draw.between(-1, 1), draw.between(-1, 1), -1));
            const double away = scale * draw.between(0.5, 20);
            rays.push_back({scale * point + to - away * direction, direction});
        }
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SurfaceHit hit;
            ASSERT_TRUE(alone.closest(rays[i], {}, hit)) << "seed " << seed << ", point " << i << "\n"
                                                         << covered.text;
        }
        std::array<SurfaceHit, Surfaces::most_together> hits;
        for (std::size_t i = 0; i + hits.size() <= rays.size(); i += hits.size()) {
            const std::uint32_t met =
                together.closest_each(std::span(rays).subspan(i, hits.size()), {}, hits);
            ASSERT_EQ(met, (1u << hits.size()) - 1) << "seed " << seed << ", points from " << i << "\n"
                                                    << covered.text;
        }
    }
}

} // namespace
} // namespace graftal
