#include "runtime/inverse/found/found_space.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/inverse/found/start_model.h"
#include "runtime/inverse/found/voxel_target.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

void expect_close(Vec3 a, Vec3 b) {
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(a[k], b[k], 1e-9);
}

SpaceMap random_map(Draws& draws) {
    SpaceMap map;
    for (int k = 0; k < 9; ++k)
        map.linear[k / 3][k % 3] = draws.between(-0.5, 0.5);
    return map.taking(Vec3(draws.unit()), Vec3(draws.unit(), draws.unit(), 0));
}

TEST(SpaceMap, ItsInverseFixedPointAndCut) {
    Draws draws(CounterRandom(1), 0);
    const Vec3 centre(5, 7, 9);
    for (int i = 0; i < 50; ++i) {
        const SpaceMap map = random_map(draws);
        const Vec3 p(draws.unit(), draws.unit(), draws.unit());
        expect_close(map(fixed_point(map)), fixed_point(map));
        expect_close(bounded_inverse(map, p, 0)(map(p)), p);
        expect_close(bounded_inverse(map, p, 1e-9)(map(centre)), centre);
        expect_close(map.taking(centre, p)(centre), p);
        EXPECT_NEAR(glm::dot(map.transposed(p), centre), glm::dot(p, map.linear * centre), 1e-12);

        std::array<double, 12> step{};
        step[0] = step[6] = 3;
        step[3] = 2, step[11] = 1;
        const SpaceMap cut = moved(map, step.data(), centre, 0.9);
        EXPECT_NEAR(norm(cut.linear), 0.9, 1e-12);
        expect_close(cut(centre), map(centre) + Vec3(2, 0, 1));

        const SpaceMap similar = nearest_similarity(map, centre);
        const Vec3 stretches = singular_values(similar.linear);
        EXPECT_NEAR(stretches.x, stretches.z, 1e-12);
        EXPECT_EQ(similar.determinant() < 0, map.determinant() < 0);
        for (const auto& way : similar.similar_steps()) {
            std::array<double, 12> small{};
            for (std::size_t k = 0; k < small.size(); ++k)
                small[k] = 1e-6 * way[k];
            const Vec3 after = singular_values(moved(similar, small.data(), centre, 10).linear);
            EXPECT_NEAR(after.x, after.z, 1e-10) << "to first order";
        }
        const std::array<double, 12> slope = map.log_slope();
        for (std::size_t k = 0; k < slope.size(); ++k) {
            std::array<double, 12> small{};
            small[k] = 1e-7;
            const double after = std::log(std::abs(moved(map, small.data(), centre, 10).determinant()));
            const double before = std::log(std::abs(map.determinant()));
            EXPECT_NEAR((after - before) / 1e-7, slope[k], 1e-3 * (1 + slope[k] * slope[k])) << k;
        }
    }
    const SpaceMap stem{{Mat3(0, 0, 0, 0, 0.2, 0, 0, 0, 0), Vec3(0.0)}};
    EXPECT_NEAR(norm(bounded_inverse(stem, centre, 0.01).linear), 100, 1e-9);
}

TEST(SpaceMap, RandomOnesContract) {
    Draws draws(CounterRandom(2), 0);
    double mean = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3 similar = singular_values(SpaceMap::random(false, true, draws).linear);
        EXPECT_NEAR(similar.x, similar.z, 1e-12);
        const SpaceMap map = SpaceMap::random(true, false, draws);
        EXPECT_LT(norm(map.linear), 0.85 + 1e-9);
        mean += map.linear[0][0] / norm(map.linear) / 400;
    }
    EXPECT_NEAR(mean, 0, 0.1) << "no direction is preferred";
}

TEST(VoxelTarget, CellsOfCloudsAndMeshes) {
    std::string fault;
    MeshData line;
    for (int i = 0; i <= 4000; ++i)
        line.vertices.emplace_back(10 + 0.01 * i, 5, -3);
    const auto cells = voxels_of(line, fault);
    ASSERT_TRUE(cells) << fault;
    EXPECT_EQ(cells->set, static_cast<std::size_t>(cells->cells.width));
    EXPECT_EQ(cells->cells.height * cells->cells.depth, 1);
    EXPECT_NEAR(cells->cell * (cells->cells.width - 0.5), 40, 1e-9) << "a quarter of a cell at each end";

    // A square of two triangles: a layer without a hole. The third vertex of the cloud belongs to no face.
    MeshData square;
    square.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {900, 900, 900}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto layer = voxels_of(square, fault);
    ASSERT_TRUE(layer) << fault;
    EXPECT_EQ(layer->cells.depth, 1);
    EXPECT_EQ(layer->cells.width, layer->cells.height);
    EXPECT_EQ(layer->set, static_cast<std::size_t>(layer->cells.width * layer->cells.height));

    // Few points make coarse cells: four points a cell, where that leaves enough cells.
    MeshData few;
    Draws draws(CounterRandom(3), 0);
    for (int i = 0; i < 9000; ++i)
        few.vertices.emplace_back(draws.unit(), draws.unit(), 0);
    const auto coarse = voxels_of(few, fault);
    ASSERT_TRUE(coarse) << fault;
    EXPECT_LE(4 * coarse->set, few.vertices.size());
    EXPECT_GT(coarse->cells.width, 30);
}

TEST(VoxelTarget, HostileDataIsRefused) {
    std::string fault;
    EXPECT_FALSE(voxels_of({}, fault));
    EXPECT_EQ(fault, "it has no points");
    MeshData data;
    data.vertices.assign(100'000, Vec3(1e6, 2, 3));
    EXPECT_FALSE(voxels_of(data, fault));
    EXPECT_THAT(fault, HasSubstr("no farther apart than 0"));
    data.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_FALSE(voxels_of(data, fault));
    EXPECT_THAT(fault, HasSubstr("too small to tell maps by"));
    data.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    data.triangles.assign(1'000'000, {0, 1, 2});
    EXPECT_FALSE(voxels_of(data, fault));
    EXPECT_THAT(fault, HasSubstr("its 1000000 triangles are too many for their size"));
}

class FoundSpaceTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }

    std::string cloud(const std::vector<Vec3>& points) const {
        std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\n"
                                       "property double y\nproperty double z\nend_header\n",
                                       points.size());
        for (const Vec3 p : points)
            text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
        EXPECT_TRUE(write_text(path("t.ply"), text).ok());
        return path("t.ply");
    }

    /// Sierpinski's tetrahedron of this size, with a corner there.
    std::string tetrahedron(double size, Vec3 corner) const {
        Draws draws(CounterRandom(9), 0);
        std::vector<Vec3> points;
        Vec3 p(0.0);
        for (int i = 0; i < 60'000; ++i) {
            const std::size_t map = draws.below(4);
            p *= 0.5;
            if (map > 0) p[static_cast<int>(map) - 1] += 0.5;
            points.push_back(corner + size * p);
        }
        return cloud(points);
    }

    std::optional<FoundSpaceModel> find(const std::string& target, double seconds, int threads = 1,
                                        const CancelFlag& cancel = {}) {
        options_.target = target;
        options_.search.seconds = seconds;
        options_.threads = threads;
        Compilation compilation;
        auto found = find_space_model(options_, cancel, compilation);
        message_ = compilation.diagnostics.render(compilation.sources) + compilation.status.message();
        return found;
    }

    TemporaryDirectory directory_;
    FindSpaceOptions options_;
    std::string message_;
};

TEST_F(FoundSpaceTest, TheTetrahedronIsFoundWhereItLies) {
    const double size = 0.02;
    const Vec3 corner(1000, -5, 2);
    const auto found = find(tetrahedron(size, corner), 8);
    ASSERT_TRUE(found) << message_;
    EXPECT_EQ(found->maps.size(), 4);
    EXPECT_GE(found->agreement.tolerant, 0.99);
    EXPECT_GE(found->agreement.strict, 0.5);
    EXPECT_LT(found->contractivity, 0.6);
    EXPECT_EQ(found->contractivity, largest_stretch(found->maps));
    EXPECT_NEAR(found->bound, (found->epsilon + std::sqrt(0.75)) / (1 - found->contractivity), 1e-9);
    // Each map's image of the whole is a quarter: its middle, and that of the whole, in the target's frame.
    const Vec3 middle = corner + Vec3(0.25 * size);
    std::array<bool, 4> seen{};
    for (const SpaceMap& map : found->maps)
        for (std::size_t i = 0; i < 4; ++i) {
            Vec3 expected = corner + 0.5 * (middle - corner);
            if (i > 0) expected[static_cast<int>(i) - 1] += 0.5 * size;
            if (glm::length(map(middle) - expected) < 1.5 * found->cell) seen[i] = true;
        }
    EXPECT_THAT(seen, ::testing::Each(true));

    // The text is that system.
    ASSERT_TRUE(write_text(path("m.rifs"), found->text).ok());
    Compilation compilation;
    const auto maps = starting_maps(path("m.rifs"), options_.compile, 8, false, compilation);
    ASSERT_TRUE(maps) << compilation.diagnostics.render(compilation.sources) << found->text;
    EXPECT_EQ(compilation.diagnostics.render(compilation.sources), "");
    ASSERT_EQ(maps->size(), found->maps.size());
    for (std::size_t i = 0; i < maps->size(); ++i) {
        EXPECT_EQ((*maps)[i].linear, found->maps[i].linear);
        EXPECT_EQ((*maps)[i].translation, found->maps[i].translation);
    }
    // It goes on from there, at once.
    options_.start = path("m.rifs");
    const auto again = find(path("t.ply"), 0.05);
    ASSERT_TRUE(again) << message_;
    EXPECT_GE(again->agreement.tolerant, found->agreement.tolerant - 0.005);
    options_.search.most_maps = 3;
    EXPECT_FALSE(find(path("t.ply"), 0.05));
    EXPECT_THAT(message_, HasSubstr("4 maps, more than the 3 that the search may use"));
}

TEST_F(FoundSpaceTest, ThreadsDoNotMatterAndSimilaritiesStay) {
    options_.search.rules.similar = true;
    const std::string target = tetrahedron(1, Vec3(0.0));
    const auto one = find(target, 0.5), two = find(target, 0.5, 2);
    ASSERT_TRUE(one && two) << message_;
    EXPECT_EQ(one->text, two->text);
    for (const SpaceMap& map : one->maps) {
        const Vec3 stretches = singular_values(map.linear);
        EXPECT_NEAR(stretches.x, stretches.z, 1e-5);
    }
}

TEST_F(FoundSpaceTest, MeshesAndInterruptionsHaveAnswers) {
    ASSERT_TRUE(write_text(path("t.obj"), "v 0 0 0\nv 8 0 0\nv 0 8 0\nf 1 2 3\n").ok());
    const auto mesh = find(path("t.obj"), 2);
    ASSERT_TRUE(mesh) << message_;
    EXPECT_EQ(mesh->triangles, 1);
    EXPECT_EQ(mesh->depth, 1);
    EXPECT_GE(mesh->agreement.tolerant, 0.9);
    int asked = 0;
    const auto cut = find(tetrahedron(1, Vec3(0.0)), 1000, 1, CancelFlag([&asked] { return ++asked > 40; }));
    ASSERT_TRUE(cut) << message_;
    EXPECT_LT(cut->contractivity, 1);
    EXPECT_THAT(cut->text, HasSubstr("codes 3d"));
}

TEST_F(FoundSpaceTest, HostileTargetsAreAnsweredOrRefused) {
    const auto refused = [&](const std::string& text, const std::string& message) {
        ASSERT_TRUE(write_text(path("h.ply"), text).ok());
        EXPECT_FALSE(find(path("h.ply"), 0.1)) << text;
        EXPECT_THAT(message_, HasSubstr(message));
    };
    refused("", "it has no points");
    refused("v 1 2 3\n", "no farther apart than 0");
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                             "property float z\nend_header\n";
    refused(head + "0 0 0\nnan 0 0\n", "a coordinate is nan");
    refused(head + "0 0 0\n1e300 0 0\n", "and 1000000 is the most");
    refused(head + "0 0 0\n", "the file ends too early");
    EXPECT_FALSE(find(path("none.ply"), 0.1));

    std::vector<Vec3> line, noise;
    Draws draws(CounterRandom(4), 0);
    for (int i = 0; i < 3000; ++i) {
        line.push_back(Vec3(1e6, -1e6, 0) + 0.001 * i * Vec3(-1, 1, 1));
        noise.emplace_back(draws.unit(), draws.unit(), draws.unit());
    }
    const auto thin = find(cloud(line), 1);
    ASSERT_TRUE(thin) << message_;
    EXPECT_GE(thin->agreement.tolerant, 0.9);
    const auto dots = find(cloud(noise), 0.5);
    ASSERT_TRUE(dots) << message_;
    EXPECT_LT(dots->contractivity, 1);
    EXPECT_LT(dots->seconds, 5) << "the work is bounded";
}

} // namespace
} // namespace graftal
