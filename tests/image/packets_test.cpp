// Rays of real scenes meet together what each of them meets alone, to the last bit: those of the camera, and
// those from what they meet to a sun.

#include <array>
#include <bit>
#include <memory>
#include <span>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "runtime/system/disk_files.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {
namespace {

constexpr ImageSize picture_size{96, 64};
constexpr int across = 4, down = 2;
using Packet = std::array<Ray, Surfaces::most_together>;
using Hits = std::array<SurfaceHit, Surfaces::most_together>;

std::unique_ptr<TraceModel> load(const std::string& path) {
    StageOptions options;
    options.view.size = picture_size;
    options.detail.error_px = 1;
    Compilation compilation;
    Session session(std::string(GRAFTAL_SOURCE_DIR "/") + path, disk_files());
    const auto viewed = session.viewed(options, compilation);
    const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
    if (!prepared) return nullptr;
    return std::make_unique<TraceModel>(prepared, viewed->view, resolved(options.detail, *viewed));
}

void expect_same(const SurfaceHit& a, const SurfaceHit& b) {
    ASSERT_EQ(a.t, b.t);
    ASSERT_EQ(a.normal, b.normal);
    ASSERT_EQ(a.rgb, b.rgb);
    ASSERT_EQ(a.material, b.material);
    ASSERT_EQ(a.light_share, b.light_share);
    ASSERT_EQ(a.node, b.node);
    ASSERT_EQ(a.levels, b.levels);
}

void compare(Traversal& together, Traversal& alone, const Packet& rays, int& hits_met) {
    Hits hits;
    const std::uint32_t met = together.closest_each(rays, {}, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        SurfaceHit hit;
        ASSERT_EQ(alone.closest(rays[i], {}, hit), (met >> i & 1) != 0) << i;
        if (!(met >> i & 1)) continue;
        expect_same(hits[i], hit);
    }
    hits_met += std::popcount(met);
}

TEST(Packets, MeetWhatTheirRaysMeetAloneInScenes) {
    for (const char* path : {"scenes/hart/pound_sign.rifs", "scenes/ifs/menger_sponge.rifs",
                             "scenes/ifs/sierpinski_tetrahedron.rifs"}) {
        SCOPED_TRACE(path);
        const auto model = load(path);
        ASSERT_TRUE(model);
        Traversal together(*model), alone(*model);
        EXPECT_TRUE(together.takes_packets());
        const CameraRays camera(model->view);
        int hits = 0;
        for (int y = 0; y < picture_size.height; y += down)
            for (int x = 0; x < picture_size.width; x += across) {
                Packet rays;
                for (std::size_t i = 0; i < rays.size(); ++i)
                    rays[i] = camera.through(x + static_cast<double>(i % across) + 0.5,
                                             y + static_cast<double>(i / across) + 0.5);
                compare(together, alone, rays, hits);
                if (HasFatalFailure()) return;
            }
        EXPECT_GT(hits, 100);
    }
}

} // namespace
} // namespace graftal
