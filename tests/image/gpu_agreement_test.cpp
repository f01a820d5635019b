// The GPU's kernel against the native engine: through the middle of each pixel both meet the same part at the
// same distance. Light comes after that. Devices by software will do, and tools/bench/gpu asks for more
// models.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "runtime/gpu/gpu_picture.h"
#include "runtime/system/disk_files.h"
#include "runtime/trace/picture_tracer.h"
#include "tests/image/random_model.h"

namespace graftal {
namespace {

struct Agreement {
    std::string name;
    std::size_t rays = 0, met = 0, differ = 0;

    Agreement& operator+=(const Agreement& other) {
        rays += other.rays;
        met += other.met;
        differ += other.differ;
        return *this;
    }
};

/// A number of models that tools/bench/gpu asks for; else few, for each has a kernel of its own.
std::uint64_t models_a_language() {
    const char* const asked = std::getenv("GRAFTAL_AGREEMENT_MODELS");
    return asked ? static_cast<std::uint64_t>(std::atoi(asked)) : 1;
}

StageOptions seen_in(ImageSize size) {
    StageOptions options;
    options.view.size = size;
    return options;
}

/// Where surfaces lie in each other either may be met. `near_enough`: so far apart either engine takes any.
bool same(const AovPixel& gpu, const AovPixel& native, float near_enough) {
    if (gpu.coverage != native.coverage) return false;
    if (gpu.coverage == 0) return true;
    const float apart = std::abs(gpu.depth - native.depth) / std::abs(native.depth);
    return apart <= std::max(2e-6f, near_enough) ||
           (apart <= 1e-4f && gpu.node == native.node && gpu.levels == native.levels);
}

/// `near_enough_px`: as in same().
Agreement compare(const std::string& name, Session& session, const StageOptions& options,
                  double near_enough_px = 0) {
    Agreement seen{name};
    Compilation compilation;
    const auto viewed = session.viewed(options, compilation);
    const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
    EXPECT_TRUE(prepared) << name << compilation.diagnostics.render(compilation.sources);
    if (!prepared) return seen;
    TraceModel model(prepared, viewed->view, resolved(options.detail, *viewed));
    model.has_shells = false; // where the native engine saves work by a mesh about many parts
    std::string why;
    const std::optional<FlatModel> flat =
        flat_model({*prepared, model.view, model.options, model.textures, {}, {}}, why);
    setenv("GALLIVM_PERF", "nopt", 0); // llvmpipe takes longer to make a kernel than to run it
    Status status;
    const std::unique_ptr<Gpu> gpu = Gpu::open(0, status);
    EXPECT_TRUE(flat && gpu) << name << ": " << why << status.message();
    if (!flat || !gpu) return seen;
    const Tile window{0, 0, model.view.size.width, model.view.size.height};
    AovPicture by_gpu, by_native(window.pixels());
    bool lost = true;
    for (const std::uint32_t frames : GpuPicture::rooms) {
        if (!lost) break;
        GpuPicture picture({gpu.get()}, model.view.size, window, {.aovs = true});
        EXPECT_TRUE(picture.prepare(*flat, frames).ok());
        EXPECT_TRUE(picture.sample(1, [](double) { return true; }).ok());
        EXPECT_TRUE(picture.read_aovs(*flat, by_gpu, lost).ok());
    }
    EXPECT_FALSE(lost) << name;
    Image light;
    light.width = window.width;
    light.height = window.height;
    light.channels = 3;
    light.pixels.resize(3 * window.pixels());
    Sampling once;
    once.most_samples = 1;
    PictureTracer(model).trace(once, {}, light, &by_native);
    const double pixel =
        2 * std::tan(model.view.camera.angle_deg * std::numbers::pi / 360) / model.view.size.width;
    for (std::size_t i = 0; i < window.pixels(); ++i) {
        ++seen.rays;
        seen.met += by_native.pixels[i].coverage > 0;
        seen.differ +=
            !same(by_gpu.pixels[i], by_native.pixels[i], static_cast<float>(near_enough_px * pixel));
    }
    std::printf("agreement %s: %zu of %zu differ, %zu met\n", name.c_str(), seen.differ, seen.rays, seen.met);
    return seen;
}

/// `most`: the share of rays that may differ, where they pass an edge by less than a rounding error.
void expect_agreement(const Agreement& seen, double most) {
    EXPECT_GT(seen.met, seen.rays / 10);
    EXPECT_LE(static_cast<double>(seen.differ), most * static_cast<double>(seen.rays)) << seen.name;
}

TEST(GpuAgreement, RandomModelsOfAllLanguages) {
    Agreement all{"random models"};
    for (std::uint64_t seed = 1; seed <= models_a_language(); ++seed)
        for (const auto& [ending, text] :
             {std::pair(".rifs", random_rifs(seed)), std::pair(".inst", random_inst(seed)),
              std::pair(".lsys", random_lsys(seed))}) {
            Session session("random" + std::to_string(seed) + ending, text);
            all += compare(std::to_string(seed) + ending, session, seen_in({80, 60}));
        }
    expect_agreement(all, 1e-3);
}

TEST(GpuAgreement, Scenes) {
    Agreement all{"scenes"};
    std::size_t left = 3 * models_a_language();
    for (const char* const path : {"hart/sierpinski.inst",
                                   "hart/pound_sign.rifs",
                                   "hart/elm.inst",
                                   "showpieces/leaf_fans.inst",
                                   "ifs/menger_sponge.rifs",
                                   "ifs/sierpinski_tetrahedron.rifs",
                                   "hart/ternary_tree.inst",
                                   "shapes/shapes.inst",
                                   "shapes/blur.inst",
                                   "light/noon.inst",
                                   "showpieces/sponge_in_sand.inst",
                                   "abop/fig2_8b.lsys",
                                   "abop/fig1_31a.lsys",
                                   "plants/mimosa.inst",
                                   "showpieces/sunflower.inst",
                                   "showpieces/plant_at_dusk.inst",
                                   "showpieces/maple_crown.inst",
                                   "showpieces/gosper_brass.inst",
                                   "showpieces/dragon_neon.inst",
                                   "showpieces/winter_elm.inst",
                                   "shapes/materials.inst",
                                   "light/window.inst",
                                   "showpieces/lone_tree.inst"}) {
        if (left-- == 0) break;
        Session session(GRAFTAL_SOURCE_DIR "/scenes/" + std::string(path), disk_files());
        all += compare(path, session, seen_in({160, 120}));
    }
    expect_agreement(all, 1e-3);
}

/// Thousands of parts lie in each other where singular maps crush them, all about a pixel wide.
TEST(GpuAgreement, CrushedParts) {
    Agreement all{"crushed parts"};
    std::size_t left = models_a_language();
    for (const char* const path : {"ifs/fern.rifs", "ifs/fern_3d.rifs", "ifs/bent_fern.rifs",
                                   "showpieces/fern_rosette.inst", "showpieces/fern_cloth.inst"}) {
        if (left-- == 0) break;
        Session session(GRAFTAL_SOURCE_DIR "/scenes/" + std::string(path), disk_files());
        all += compare(path, session, seen_in({160, 120}), 1);
    }
    expect_agreement(all, 1e-3);
}

/// Where the view is small beside the root, places have two floats for each number.
TEST(GpuAgreement, Zooms) {
    Agreement all{"zooms"};
    std::size_t left = models_a_language();
    for (const char* const zoom : {"1e12", "1e6", "1e3"})
        for (const char* const path : {"ifs/menger_sponge.rifs", "hart/pound_sign.rifs"}) {
            if (left-- == 0) return expect_agreement(all, 5e-4);
            StageOptions options = seen_in({160, 120});
            options.view.zoom.zoom = Magnification::parse(zoom);
            Session session(GRAFTAL_SOURCE_DIR "/scenes/" + std::string(path), disk_files());
            all += compare(std::string(path) + " x " + zoom, session, options);
        }
    expect_agreement(all, 5e-4);
}

} // namespace
} // namespace graftal
