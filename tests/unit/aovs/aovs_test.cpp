// AOVs in EXR files, against closed forms.

#include <bit>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "runtime/render/native_engine.h"
#include "runtime/system/temporary_directory.h"
#include "runtime/trace/mattes.h"

namespace graftal {
namespace {

/// The channels of an EXR, by name.
struct Channels {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> of;
    std::map<float, std::string> names;            ///< by id
    std::map<std::string, std::string> matte_tags; ///< of all layers, without the layer's key

    float at(const std::string& name, int x, int y) const {
        return of.at(name)[static_cast<std::size_t>(y * width + x)];
    }
    Vec3 vector_at(const std::string& name, int x, int y) const {
        return {at(name + ".X", x, y), at(name + ".Y", x, y), at(name + ".Z", x, y)};
    }
    /// The layer that a tag cryptomatte/KEY/... is of.
    static std::string matte_layer(const OIIO::ImageSpec& spec, const std::string& tag) {
        return std::string(spec.get_string_attribute(tag.substr(0, tag.rfind('/')) + "/name"));
    }
    /// The share of a pixel that belongs to a name, by the manifest and the six ranks of the layer.
    float matte(const std::string& layer, const std::string& name, int x, int y) const {
        const nlohmann::json manifest = nlohmann::json::parse(matte_tags.at(layer + "/manifest"));
        if (!manifest.contains(name)) return 0;
        const auto id =
            static_cast<std::uint32_t>(std::stoul(manifest[name].get<std::string>(), nullptr, 16));
        float share = 0;
        for (const std::string channel : {"00", "01", "02"})
            for (const auto& [id_at, share_at] : {std::pair(".R", ".G"), std::pair(".B", ".A")})
                if (std::bit_cast<std::uint32_t>(at(layer + channel + id_at, x, y)) == id)
                    share += at(layer + channel + share_at, x, y);
        return share;
    }
    std::string object_at(int x, int y) const {
        const auto name = names.find(at("id", x, y));
        return name == names.end() ? "" : name->second;
    }
};

class Aovs : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(directory_.create().ok());
        options_.aovs = true;
        options_.antialias.reset();
        options_.compile.view.size = {64, 48};
        options_.compile.view.light = DefaultLight::plain;
        options_.output = directory_.path() + "/m.exr";
    }

    void draw(const std::string& model) {
        const std::string path = directory_.path() + "/m.inst";
        std::ofstream(path) << model;
        PictureSession session(path);
        Compilation compilation;
        ASSERT_TRUE(native_engine.draw(session, options_, compilation))
            << compilation.diagnostics.render(compilation.sources) << compilation.status.message();
    }

    Channels read() const {
        Channels channels;
        const auto input = OIIO::ImageInput::open(options_.output);
        EXPECT_TRUE(input) << OIIO::geterror();
        if (!input) return channels;
        const OIIO::ImageSpec& spec = input->spec();
        channels.width = spec.width;
        channels.height = spec.height;
        std::vector<float> samples(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
        EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, samples.data()));
        for (std::size_t i = 0; i < samples.size(); ++i)
            channels.of[spec.channelnames[i % spec.channelnames.size()]].push_back(samples[i]);
        for (const OIIO::ParamValue& tag : spec.extra_attribs)
            if (const std::string key = tag.name().string(); key.starts_with("cryptomatte/"))
                channels.matte_tags[channels.matte_layer(spec, key) + key.substr(key.rfind('/'))] =
                    tag.get_string();
        std::istringstream ids{std::string(spec.get_string_attribute("graftal:ids"))};
        std::string name;
        for (float id = 0; ids >> id >> name;)
            channels.names[id] = name;
        return channels;
    }
    Channels drawn(const std::string& model) {
        draw(model);
        return read();
    }

    std::string bytes() const {
        std::ifstream file(options_.output, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    TemporaryDirectory directory_;
    RenderOptions options_;
};

const std::string parallel = "camera { location: 0,0,5 look_at: 0,0,0 orthographic width: 4 }\n";
const std::string perspective = "camera { location: 0,0,5 look_at: 0,0,0 angle: 60 }\n";
const std::string ball = "object m { instance: sphere }\n";

TEST_F(Aovs, AreTheChannelsThatTheDocumentationNames) {
    const Channels channels = drawn(parallel + ball);
    std::vector<std::string> names;
    for (const auto& [name, samples] : channels.of) {
        names.push_back(name);
        EXPECT_EQ(samples.size(), 64u * 48) << name;
    }
    std::erase_if(names, [](const std::string& name) { return name.starts_with("Crypto"); });
    EXPECT_EQ(channels.of.size() - names.size(), 36u); // mattes, below
    EXPECT_THAT(names, testing::UnorderedElementsAre("R", "G", "B", "A", "coverage", "Z", "normal.X",
                                                     "normal.Y", "normal.Z", "albedo.R", "albedo.G",
                                                     "albedo.B", "id", "levels"));
}

TEST_F(Aovs, OfASphereUnderParallelRays) {
    const Channels channels = drawn(parallel + "material red { color: 0.8, 0.2, 0.1 }\n"
                                               "object m { instance: sphere material: red }\n");
    int met = 0;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            const double x = (i + 0.5) / 16 - 2, y = 1.5 - (j + 0.5) / 16, square = 1 - x * x - y * y;
            EXPECT_EQ(channels.at("A", i, j), 1);
            EXPECT_EQ(channels.at("coverage", i, j), square > 0 ? 1 : 0);
            if (square <= 0) {
                EXPECT_EQ(channels.at("Z", i, j), std::numeric_limits<float>::infinity());
                EXPECT_EQ(channels.vector_at("normal", i, j), Vec3(0.0));
                EXPECT_EQ(channels.at("id", i, j), 0);
                continue;
            }
            ++met;
            const Vec3 normal(x, y, std::sqrt(square));
            EXPECT_NEAR(channels.at("Z", i, j), 5 - normal.z, 1e-6);
            EXPECT_LT(glm::length(channels.vector_at("normal", i, j) - normal), 1e-6);
            EXPECT_FLOAT_EQ(channels.at("albedo.R", i, j), 0.8f);
            EXPECT_FLOAT_EQ(channels.at("albedo.G", i, j), 0.2f);
            EXPECT_FLOAT_EQ(channels.at("albedo.B", i, j), 0.1f);
            EXPECT_EQ(channels.object_at(i, j), "m");
        }
    EXPECT_GT(met, 700);
}

/// The depth of a wall that faces the camera is everywhere the same, unlike the distance.
TEST_F(Aovs, DepthIsAlongTheCamerasDirection) {
    const Channels channels =
        drawn(perspective + "object m { instance: cube scale: 20, 20, 1 }\n"); // its face at z = 1/2 or 1
    const float depth = channels.at("Z", 32, 24);
    EXPECT_TRUE(depth == 4 || depth == 4.5f) << depth;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            EXPECT_NEAR(channels.at("Z", i, j), depth, 1e-5);
            EXPECT_LT(glm::length(channels.vector_at("normal", i, j) - Vec3(0, 0, 1)), 1e-6);
        }
}

TEST_F(Aovs, OfTheGround) {
    const Channels channels =
        drawn(perspective + "ground { height: -2 }\n"
                            "object m { instance: sphere scale: 0.1 translate: 0, 1, 0 }\n");
    const double slope = std::tan(std::numbers::pi / 6) / 32; // of a pixel
    for (int j = 26; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            const double depth = 2 / (slope * (j + 0.5 - 24));
            EXPECT_NEAR(channels.at("Z", i, j), depth, 1e-5 * depth);
            EXPECT_EQ(channels.vector_at("normal", i, j), Vec3(0, 1, 0));
            EXPECT_EQ(channels.object_at(i, j), "(ground)");
            EXPECT_EQ(channels.at("levels", i, j), 0);
        }
    EXPECT_EQ(channels.object_at(0, 0), "");
}

TEST_F(Aovs, MeansAreOverTheSamplesThatMeet) {
    options_.antialias = 4;
    const Channels channels = drawn(parallel + ball);
    double area = 0;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            const float coverage = channels.at("coverage", i, j), depth = channels.at("Z", i, j);
            area += coverage / 256;
            EXPECT_EQ(std::isfinite(depth), coverage > 0);
            if (coverage > 0) {
                EXPECT_TRUE(4 <= depth && depth <= 5) << depth;
            }
            // The nearest sample is the pixel's middle.
            const double x = (i + 0.5) / 16 - 2, y = 1.5 - (j + 0.5) / 16;
            EXPECT_EQ(channels.object_at(i, j), x * x + y * y < 1 ? "m" : "");
        }
    EXPECT_NEAR(area, std::numbers::pi, 0.01);
    // In the middle of the sphere it is (x^2 + y^2) / 2 deeper; the means over 8 cells of each side.
    EXPECT_NEAR(channels.at("Z", 32, 24), 4 + (1.0 / 3 + 1.0 / 6 / 64) / 256, 3e-6);
}

TEST_F(Aovs, IdsTellObjectsApart) {
    const std::string model =
        parallel + "canonical object left { instance: sphere }\ncanonical object right { instance: cube }\n"
                   "object m { instance: left scale: 0.5 translate: -1, 0, 0\n"
                   "  instance: right scale: 0.5 translate: 1, 0, 0 }\n";
    const Channels channels = drawn(model);
    EXPECT_EQ(channels.object_at(16, 24), "left");
    EXPECT_EQ(channels.object_at(48, 24), "right");
    EXPECT_NE(channels.at("id", 16, 24), channels.at("id", 48, 24));
    EXPECT_EQ(channels.names.size(), 2u) << "of what is seen";
    EXPECT_EQ(channels.object_at(32, 24), "");
    options_.compile.view.camera.location = Vec3(3, 0, 5);
    EXPECT_EQ(drawn(model).names, channels.names) << "from wherever they are seen";
}

TEST_F(Aovs, LevelsAreThoseOfTheRecursion) {
    options_.compile.lower.steps = 3;
    // Balls of radius 2^-k at 0, 1.6, 2.4, 2.8: each in the middle of a row of pixels of its own.
    const Channels channels = drawn("camera { location: 1.5,0,5 look_at: 1.5,0,0 orthographic width: 5 }\n"
                                    "object m { instance: sphere scale: 0.5\n"
                                    "  instance: m scale: 0.5 translate: 1.6, 0, 0 }\n");
    const double at[] = {0, 1.6, 2.4, 2.8};
    for (int k = 0; k < 4; ++k) {
        const int x = static_cast<int>((at[k] + 1) / 5 * 64);
        EXPECT_EQ(channels.at("levels", x, 24), static_cast<float>(k));
        EXPECT_EQ(channels.object_at(x, 24), "m");
    }
}

TEST_F(Aovs, DoNotDependOnThreadsAndLeaveThePicture) {
    const std::string soft = "sky { zenith: 0.3, 0.4, 0.7  horizon: 0.9, 0.8, 0.7 }\n" + perspective + ball;
    for (const std::string& model : {parallel + ball, soft})
        for (const bool progressive : {false, true}) {
            options_.antialias = 2;
            options_.samples = 8;
            options_.denoise = false;
            options_.progressive = progressive;
            options_.threads = 1;
            const Channels channels = drawn(model);
            const std::string one = bytes();
            options_.threads = 3;
            draw(model);
            EXPECT_EQ(bytes(), one);
            options_.aovs = false;
            const Channels plain = drawn(model);
            options_.aovs = true;
            for (const std::string name : {"R", "G", "B"})
                for (std::size_t i = 0; i < plain.of.at(name).size(); ++i)
                    EXPECT_NEAR(plain.of.at(name)[i], channels.of.at(name)[i], 1e-5) << name;
            EXPECT_EQ(channels.at("coverage", 32, 24), 1);
            EXPECT_NEAR(channels.at("Z", 32, 24), 4, 0.01);
        }
}

TEST(Mattes, IdsAreThoseOfTheSpecification) {
    EXPECT_EQ(matte_id("test"), 0xba6bd213u);
    EXPECT_EQ(matte_id("Hello, world!"), 0xc0363e43u);
    EXPECT_EQ(matte_id("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
    for (int i = 0; i < 10000; ++i) // of which one in 128 is no normal number by its hash alone
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(matte_id("name" + std::to_string(i))))) << i;
}

TEST(Mattes, TheLargestSharesCome) {
    MatteSum sum;
    for (std::uint32_t id = 1; id <= 8; ++id)
        sum.add({id, 10, 9}, id);
    sum.add({}, 4); // a sample that meets nothing
    const PixelMattes mattes = sum.shares(40);
    for (std::uint32_t i = 0; i < 6; ++i) {
        EXPECT_EQ(mattes.objects[i].id, 8 - i);
        EXPECT_FLOAT_EQ(mattes.objects[i].share, static_cast<float>(8 - i) / 40);
    }
    EXPECT_EQ(mattes.instances[0].id, 10u);
    EXPECT_EQ(mattes.materials[0].id, 9u);
    EXPECT_FLOAT_EQ(mattes.materials[0].share, 0.9f);
    EXPECT_EQ(mattes.materials[1].id, 0u);
}

const std::string red = "material red { color: 0.8, 0.2, 0.1 }\n";
const std::string front = "canonical object front { instance: sphere scale: 0.6 material: red }\n";
const std::string back = "canonical object back { instance: cube scale: 1.1 translate: 0.4, 0.2, -3 }\n";

TEST_F(Aovs, MattesShareEachPixelAmongWhatItShows) {
    options_.antialias = 4;
    const Channels channels = drawn(parallel + "ground { height: -1 }\n" + red + front + back +
                                    "object m { instance: front\n instance: back }\n");
    EXPECT_EQ(channels.matte_tags.at("CryptoObject/hash"), "MurmurHash3_32");
    EXPECT_EQ(channels.matte_tags.at("CryptoMaterial/conversion"), "uint32_to_float32");
    int shared = 0;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            const float coverage = channels.at("coverage", i, j);
            const float ball = channels.matte("CryptoObject", "front", i, j);
            const float cube = channels.matte("CryptoObject", "back", i, j);
            const float ground = channels.matte("CryptoObject", "(ground)", i, j);
            EXPECT_NEAR(ball + cube + ground, coverage, 1e-6);
            EXPECT_EQ(channels.matte("CryptoMaterial", "red", i, j), ball);
            EXPECT_NEAR(channels.matte("CryptoMaterial", "(plain)", i, j), cube + ground, 1e-6);
            shared += ball > 0 && cube > 0;
        }
    EXPECT_GT(shared, 20);
}

TEST(Mattes, AWayHasTheIdOfItsBytes) {
    const std::uint32_t way[] = {0x74736574}; // "test"
    EXPECT_EQ(matte_id(way), matte_id("test"));
    EXPECT_NE(matte_id(std::vector<std::uint32_t>{1, 2}), matte_id(std::vector<std::uint32_t>{2, 1}));
}

/// Three trees of two leaves, in a row: one object of two parts in six instances.
const std::string six_leaves = "canonical object leaf { instance: sphere scale: 0.2 translate: 0, 0.25, 0\n"
                               "  instance: cube scale: 0.2 translate: 0, -0.25, 0 }\n"
                               "canonical object tree { instance: leaf translate: -0.3, 0, 0\n"
                               "  instance: leaf translate: 0.3, 0, 0 }\n"
                               "object m { instance: tree translate: -1.2, 0, 0\n  instance: tree\n"
                               "  instance: tree translate: 1.2, 0, 0 }\n";

/// Middles of the columns of the pixels of each instance, in the units of a picture four wide.
std::map<std::uint32_t, std::set<double>> columns_of_instances(const Channels& channels) {
    std::map<std::uint32_t, std::set<double>> columns;
    for (int j = 0; j < channels.height; ++j)
        for (int i = 0; i < channels.width; ++i)
            if (channels.at("coverage", i, j) > 0)
                columns[std::bit_cast<std::uint32_t>(channels.at("CryptoInstance00.R", i, j))].insert(
                    4.0 * (i + 0.5) / channels.width - 2);
    return columns;
}

TEST_F(Aovs, EachInstanceOfAnObjectHasAMatte) {
    const Channels channels = drawn(parallel + six_leaves);
    const auto columns = columns_of_instances(channels);
    ASSERT_EQ(columns.size(), 6u); // both parts of a leaf have one
    std::set<double> middles;
    for (const auto& [id, places] : columns) {
        EXPECT_LT(*places.rbegin() - *places.begin(), 0.45);
        middles.insert(std::round(5 * (*places.rbegin() + *places.begin())) / 10);
    }
    EXPECT_THAT(middles, testing::ElementsAre(-1.5, -0.9, -0.3, 0.3, 0.9, 1.5));
    EXPECT_EQ(channels.matte_tags.at("CryptoInstance/manifest"), "{}"); // Blender asks for one

    const Channels moved =
        drawn("camera { location: 0.4,0.1,5 look_at: 0.4,0,0 orthographic width: 4.4 }\n" + six_leaves);
    std::set<std::uint32_t> ids, moved_ids;
    for (const auto& [id, places] : columns)
        ids.insert(id);
    for (const auto& [id, places] : columns_of_instances(moved))
        moved_ids.insert(id);
    EXPECT_EQ(moved_ids, ids);
}

/// Copies of an unending object differ too, and shares of instances add up as those of objects do.
TEST_F(Aovs, MattesOfInstancesShareEachPixel) {
    options_.antialias = 3;
    const Channels channels = drawn("camera { location: 0,2,5 look_at: 0,0,0 orthographic width: 4 }\n"
                                    "ground { height: -1.5 }\n"
                                    "object m { instance: sphere scale: 0.5\n"
                                    "  instance: m scale: 0.5 translate: 1, 0, 0\n"
                                    "  instance: m scale: 0.5 translate: -1, 0.5, 0 }\n");
    std::set<std::uint32_t> ids;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            float instances = 0, objects = 0;
            for (const std::string channel : {"00.G", "00.A", "01.G", "01.A", "02.G", "02.A"}) {
                instances += channels.at("CryptoInstance" + channel, i, j);
                objects += channels.at("CryptoObject" + channel, i, j);
            }
            EXPECT_NEAR(instances, channels.at("coverage", i, j), 0.2);
            EXPECT_NEAR(objects, channels.at("coverage", i, j), 1e-6);
            if (channels.at("CryptoInstance00.G", i, j) == 1)
                ids.insert(std::bit_cast<std::uint32_t>(channels.at("CryptoInstance00.R", i, j)));
        }
    EXPECT_GE(ids.size(), 8u); // the ground, and spheres of three levels
    EXPECT_TRUE(ids.contains(matte_id("(ground)")));
}

/// A mask of what nothing hides is the picture of it alone.
TEST_F(Aovs, AMatteIsThePictureOfItsObjectAlone) {
    options_.samples = 16;
    options_.denoise = false;
    const std::string soft = "sky { zenith: 0.3, 0.4, 0.7  horizon: 0.9, 0.8, 0.7 }\n";
    const Channels both =
        drawn(soft + parallel + red + front + back + "object m { instance: front\n instance: back }\n");
    const Channels alone = drawn(soft + parallel + red + front + "object m { instance: front }\n");
    double edges = 0;
    for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 64; ++i) {
            const float coverage = alone.at("coverage", i, j);
            // Noise may end the samples of a pixel sooner in one of the pictures.
            EXPECT_NEAR(both.matte("CryptoMaterial", "red", i, j), coverage, 0.2);
            edges += coverage > 0 && coverage < 1 ? both.matte("CryptoMaterial", "red", i, j) - coverage : 0;
        }
    EXPECT_NEAR(edges, 0, 1);
}

} // namespace
} // namespace graftal
