// Pictures by a device of Vulkan, against the native engine's of the same samples. Tests run on Mesa's
// llvmpipe, where no card is.

#include "runtime/gpu/device.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/gpu/gpu_picture.h"
#include "runtime/trace/picture_tracer.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using testing::HasSubstr;

std::unique_ptr<Gpu> first_device() {
    setenv("GALLIVM_PERF", "nopt", 0); // llvmpipe takes longer to make a kernel than to run it
    Status status;
    std::unique_ptr<Gpu> gpu = Gpu::open(0, status);
    EXPECT_TRUE(gpu) << status.message();
    return gpu;
}

View lit_view(const TraceModel& model) {
    View view = model.view;
    view.size = {40, 30};
    view.lights = {{.location = glm::normalize(Vec3(1, 2, 2)), .sun = true, .rgb = Rgb(2), .angle_deg = 3}};
    view.sky_light = SkyLight{.zenith = Rgb(0.3, 0.4, 0.8), .horizon = Rgb(0.8), .below = Rgb(0.2)};
    view.sky_light->bounces = 2;
    view.shows_sky_light = true;
    view.haze = Haze{.distance = 20, .height = 2, .sun = 0.6};
    return view;
}

Image blank(const Tile& window) {
    Image image;
    image.width = window.width;
    image.height = window.height;
    image.channels = 3;
    image.pixels.resize(3 * window.pixels());
    return image;
}

struct Pictures {
    Image gpu, native;
    GpuPicture::Seen seen;
};

Pictures draw(const Graph& graph, const Tile& window, std::uint32_t samples,
              std::uint32_t frames = GpuPicture::rooms.front(), const char* said = "") {
    const auto plain = test::traced(graph, {});
    const TraceModel model(plain->shared, lit_view(*plain), plain->options);
    Sampling sampling;
    sampling.most_samples = static_cast<int>(samples);
    std::string why;
    const std::optional<FlatModel> flat =
        flat_model({model.prepared, model.view, model.options, model.textures, {}, sampling}, why);
    EXPECT_TRUE(flat) << why;
    Pictures pictures{blank(window), blank(window), {}};
    const std::unique_ptr<Gpu> gpu = first_device();
    if (!gpu || !flat) return pictures;
    GpuPicture picture({gpu.get()}, model.view.size, window, {});
    EXPECT_TRUE(picture.prepare(*flat, frames).ok());
    EXPECT_TRUE(picture.sample(samples, [](double) { return true; }).ok());
    const Status status = picture.read({}, 0, pictures.gpu, pictures.seen);
    EXPECT_EQ(status.ok(), *said == 0 || !gpu->info().is_processor);
    EXPECT_THAT(status.message(), HasSubstr(status.ok() ? "" : said));
    PictureTracer(model).trace(sampling, {}, window, pictures.native);
    return pictures;
}

double difference_255(const Pictures& pictures) {
    double sum = 0;
    for (std::size_t i = 0; i < pictures.gpu.pixels.size(); ++i)
        sum += std::abs(pictures.gpu.pixels[i] - pictures.native.pixels[i]);
    return 255 * sum / static_cast<double>(pictures.gpu.pixels.size());
}

TEST(Gpu, DrawsTheNativeEnginesPicture) {
    const Pictures pictures = draw(test::tetrahedron(0.6), {0, 0, 40, 30}, 4);
    EXPECT_LT(difference_255(pictures), 1.2);
    EXPECT_GT(*std::ranges::max_element(pictures.gpu.pixels), 0.1f);
    EXPECT_EQ(pictures.seen.samples, 40 * 30 * 4);
    EXPECT_GT(pictures.seen.steps, 40 * 30 * 4);
}

TEST(Gpu, WindowsHaveThePixelsOfTheWhole) {
    const Pictures whole = draw(test::tetrahedron(0.6), {0, 0, 40, 30}, 2);
    const Tile window{9, 5, 21, 13};
    const Pictures part = draw(test::tetrahedron(0.6), window, 2);
    for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < 3 * window.width; ++x)
            ASSERT_EQ(part.gpu.pixels[static_cast<std::size_t>(3 * window.width * y + x)],
                      whole.gpu.pixels[static_cast<std::size_t>(3 * 40 * (y + window.y) + x + 3 * window.x)]);
}

TEST(Gpu, DevicesShareAPictureToTheLastBit) {
    const auto plain = test::traced(test::tetrahedron(0.6), {});
    const TraceModel model(plain->shared, lit_view(*plain), plain->options);
    std::string why;
    const auto flat = flat_model({model.prepared, model.view, model.options, model.textures, {}, {}}, why);
    const std::unique_ptr<Gpu> first = first_device(), second = first_device(), third = first_device();
    ASSERT_TRUE(flat && first && second && third) << why;
    const Tile window{3, 2, 21, 27}; // four rows of tiles, the last of three pixels
    std::vector<Image> pictures;
    std::vector<AovPicture> aovs(2);
    for (const auto& gpus : {std::vector{first.get()}, std::vector{first.get(), second.get(), third.get()}}) {
        GpuPicture picture(gpus, model.view.size, window, {});
        ASSERT_TRUE(picture.prepare(*flat).ok());
        std::vector<double> shares;
        for (const std::uint32_t count : {1, 3})
            ASSERT_TRUE(picture
                            .sample(count,
                                    [&](double share) {
                                        shares.push_back(share);
                                        return true;
                                    })
                            .ok());
        EXPECT_LE(*std::ranges::max_element(shares), 1);
        GpuPicture::Seen seen;
        ASSERT_TRUE(picture.read({}, 0, pictures.emplace_back(blank(window)), seen).ok());
        EXPECT_EQ(seen.samples, 3 * 21 * 27);
        GpuPicture facts(gpus, model.view.size, window, {.aovs = true});
        bool lost = false;
        ASSERT_TRUE(facts.prepare(*flat).ok());
        ASSERT_TRUE(facts.sample(2, [](double) { return true; }).ok());
        ASSERT_TRUE(facts.read_aovs(*flat, aovs[pictures.size() - 1], lost).ok());
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
    for (std::size_t i = 0; i < window.pixels(); ++i) {
        ASSERT_EQ(aovs[0].pixels[i].depth, aovs[1].pixels[i].depth) << i;
        ASSERT_THAT(aovs[0].pixels[i].normal, testing::ElementsAreArray(aovs[1].pixels[i].normal)) << i;
    }
}

// A stranger to four ways that wait takes one of two by chance: glass had twice the noise of the native
// engine's.
TEST(Gpu, FollowsEachWayThroughManyPanes) {
    Graph graph = test::empty_graph();
    graph.materials = {Material{
        .name = "glass", .diffuse = 0, .specular = 0.3, .reflection = 1, .transparency = 1, .ior = 2.5}};
    for (int i = 0; i < 8; ++i) {
        test::place(graph, graph.root, graph.primitive(PrimitiveKind::cube),
                    Affine::translate({0, 0, -0.5 * i}) *
                        Affine::rotate(glm::normalize(Vec3(1, 0.1 * i, 0)), 4 * i) *
                        Affine::scale(Vec3(1, 1, 0.05)));
        graph.objects[graph.root].instances.back().material = 0;
    }
    EXPECT_LT(difference_255(draw(graph, {12, 8, 16, 14}, 2)), 0.5);
}

/// A chain of objects, each a step further than the one that holds it.
Graph chain(int length) {
    Graph graph = test::empty_graph();
    ObjectId last = graph.root;
    for (int i = 0; i < length; ++i) {
        const ObjectId next = graph.add({"link" + std::to_string(i), {}, {}, {}, {}});
        test::place(graph, last, next, Affine::translate({0.3, 0.05, 0}));
        test::place(graph, next, graph.primitive(PrimitiveKind::cube), Affine::scale(Vec3(0.2)));
        test::place(graph, next, graph.primitive(PrimitiveKind::sphere), Affine::scale(Vec3(0.25)));
        last = next;
    }
    return graph;
}

TEST(Gpu, PartsThatLieTooDeepAreCounted) {
    const Tile middle{16, 12, 8, 6};
    EXPECT_FALSE(draw(chain(20), middle, 1).seen.lost);
    EXPECT_TRUE(draw(chain(600), middle, 1).seen.lost);
    EXPECT_TRUE(draw(chain(5000), middle, 1, GpuPicture::rooms.back()).seen.lost);
}

/// Mesa's llvmpipe ends a shader's loops after 65535 rounds: rays then met what lies behind, or nothing.
TEST(Gpu, DevicesThatEndLoopsEarlyAreFoundOut) {
    Graph graph = test::empty_graph();
    const ObjectId rod = graph.primitive(PrimitiveKind::cylinder);
    for (int i = 0; i < 60000; ++i) // rays go through the boxes of all, and meet none
        test::place(graph, graph.root, rod,
                    Affine::translate({0.3, -0.3, 1e-5 * i}) * Affine::rotate(Vec3(0, 0, 1), -45) *
                        Affine::scale(Vec3(0.001, 1, 0.001)));
    draw(graph, {16, 12, 8, 2}, 1, GpuPicture::rooms.front(), "ends the loops");
}

TEST(Gpu, DrawsAThousandObjectsInEachOther) {
    const Pictures pictures = draw(chain(1000), {10, 8, 20, 14}, 2, GpuPicture::rooms.back());
    EXPECT_FALSE(pictures.seen.lost);
    EXPECT_LT(difference_255(pictures), 0.5);
    EXPECT_GT(*std::ranges::max_element(pictures.gpu.pixels), 0.1f);
}

TEST(Gpu, CanBeInterrupted) {
    const auto plain = test::traced(test::tetrahedron(0.6), {});
    std::string why;
    const auto flat =
        flat_model({plain->prepared, plain->view, plain->options, plain->textures, {}, {}}, why);
    const std::unique_ptr<Gpu> gpu = first_device();
    ASSERT_TRUE(gpu && flat);
    GpuPicture picture({gpu.get()}, {64, 48}, {0, 0, 64, 48}, {.lattice = 1});
    ASSERT_TRUE(picture.prepare(*flat).ok());
    int asked = 0;
    const Status status = picture.sample(1, [&](double) { return ++asked < 2; });
    EXPECT_EQ(status.message(), "interrupted");
    EXPECT_EQ(asked, 2);
}

TEST(Gpu, WantOfMemoryIsAStatus) {
    const std::unique_ptr<Gpu> gpu = first_device();
    ASSERT_TRUE(gpu);
    EXPECT_FALSE(gpu->add_buffer({}, std::size_t{1} << 50).ok());
}

TEST(Gpu, NoSuchDeviceIsAStatus) {
    Status status;
    EXPECT_FALSE(Gpu::open(1000, status));
    EXPECT_THAT(status.message(), HasSubstr("no device number 1000"));
}

TEST(Gpu, WithoutADriverThereIsNoDevice) {
    // The loader reads these variables whenever it makes an instance.
    for (const char* const name : {"VK_ICD_FILENAMES", "VK_DRIVER_FILES"})
        setenv(name, "/nonexistent.json", 1);
    std::string why;
    EXPECT_TRUE(gpu_devices(&why).empty());
    EXPECT_FALSE(why.empty());
    Status status;
    EXPECT_FALSE(Gpu::open(0, status));
    EXPECT_THAT(status.message(), HasSubstr("GPU: "));
    for (const char* const name : {"VK_ICD_FILENAMES", "VK_DRIVER_FILES"})
        unsetenv(name);
}

} // namespace
} // namespace graftal
