#include "compiler/primitives/mesh_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using ::testing::HasSubstr;

MeshData read(std::string_view bytes) {
    std::string fault;
    const std::optional<MeshData> data = read_mesh(bytes, fault);
    EXPECT_TRUE(data) << fault;
    return data.value_or(MeshData());
}

std::string fault_of_mesh(std::string_view bytes) {
    std::string fault;
    EXPECT_FALSE(read_mesh(bytes, fault));
    return fault;
}

TEST(MeshFile, ReadsObj) {
    const MeshData data = read("# a leaf\nv 0 0 0\nv 1 0 0\r\nv 1 1 0\nv 0 1 0 1.0\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\no leaf\nusemtl green\n"
                               "f 1/1/1 2/2/1 3/3/1 4/1/1\nf -4//1 -2//1 -3//1\n");
    EXPECT_EQ(data.vertices.size(), 4u);
    ASSERT_EQ(data.triangles.size(), 3u);
    EXPECT_EQ(data.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    ASSERT_EQ(data.uv.size(), 3u);
    EXPECT_EQ(data.uv[0][2], (std::array<double, 2>{1, 1}));
    EXPECT_TRUE(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").uv.empty());
}

TEST(MeshFile, ReadsNormals) {
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const MeshData smooth = read(square + "vn 0 0 2\nvn 0 3 4\nf 1//1 2//1 3//2\nf 1//1 3//1 4//1\n");
    ASSERT_EQ(smooth.vertices.size(), 5u); // the third corner has two normals
    ASSERT_EQ(smooth.normals.size(), 5u);
    EXPECT_NEAR(glm::distance(smooth.normals[smooth.triangles[0][2]], Vec3(0, 0.6, 0.8)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(smooth.normals[smooth.triangles[1][1]], Vec3(0, 0, 1)), 0, 1e-15);
    // A corner without a normal, or with one that has no direction, has that of its facet.
    for (const char* const face : {"vn 1 0 0\nf 1//1 2//1 3\n", "vn 1 0 0\nvn 0 0 0\nf 1//1 2//1 3//2\n",
                                   "vn 1 0 0\nvn nan 0 0\nf 1//1 2//1 3//2\n"}) {
        const MeshData partly = read(square + face);
        EXPECT_NEAR(glm::distance(partly.normals[partly.triangles[0][0]], Vec3(1, 0, 0)), 0, 1e-15);
        EXPECT_NEAR(glm::distance(partly.normals[partly.triangles[0][2]], Vec3(0, 0, 1)), 0, 1e-15);
    }
    EXPECT_TRUE(read(square + "vn 0 0 1\nf 1 2 3\n").normals.empty());
    EXPECT_THAT(fault_of_mesh(square + "vn 0 0\n"), HasSubstr("a normal has three numbers"));
    EXPECT_THAT(fault_of_mesh(square + "f 1//1 2//1 3//1\n"), HasSubstr("names no vertex"));
    const MeshData ply = read("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                              "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                              "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 0 0 0 1\n1 0 0 0 3 4\n0 1 0 0 0 0\n3 0 1 2\n");
    ASSERT_EQ(ply.normals.size(), 3u);
    EXPECT_NEAR(glm::distance(ply.normals[1], Vec3(0, 0.6, 0.8)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(ply.normals[2], Vec3(0, 0, 1)), 0, 1e-15);
}

TEST(MeshFile, RefusesDamagedObj) {
    EXPECT_THAT(fault_of_mesh("v 0 0\n"), HasSubstr("line 1: a vertex has three numbers"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nf 1 2 3\n"), HasSubstr("line 2: '2' names no vertex"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nv 1 0 0\nf 1 2\n"), HasSubstr("three corners"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n"),
                HasSubstr("line 2: a coordinate is"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nv 1 0 2e6\n"), HasSubstr("line 2: a coordinate is 2000000"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nvt 1 inf\n"), HasSubstr("line 2: texture: a coordinate is inf"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), HasSubstr("no triangle"));
    EXPECT_THAT(fault_of_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\n"), HasSubstr("it holds no face"));
    for (const char* const strange : {"", "lsys tree { axiom F }\n", "{\"asset\": 1}"})
        EXPECT_THAT(fault_of_mesh(strange), HasSubstr("it holds no vertex")) << strange;
    EXPECT_THAT(fault_of_mesh(std::string("\x80\nv 1", 5) + std::string(2, '\0') + "\nf 1 1 1\n"),
                HasSubstr("it is no OBJ, PLY or STL mesh: byte 6 is zero"));
}

constexpr const char* ply_header = "ply\nformat {} 1.0\ncomment none\nelement vertex 3\nproperty float x\n"
                                   "property float y\nproperty float z\nproperty float s\n"
                                   "property float t\nelement face 1\n"
                                   "property list uchar int vertex_indices\nend_header\n";

std::string header(const std::string& format) {
    std::string text = ply_header;
    return text.replace(text.find("{}"), 2, format);
}

TEST(MeshFile, ReadsPlyAsTextAndBinary) {
    const MeshData text = read(header("ascii") + "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    for (const bool swapped : {false, true}) {
        std::string bytes = header(swapped ? "binary_big_endian" : "binary_little_endian");
        const auto add = [&](auto number) {
            char raw[sizeof(number)];
            std::memcpy(raw, &number, sizeof(number));
            if (swapped) std::reverse(std::begin(raw), std::end(raw));
            bytes.append(raw, sizeof(number));
        };
        for (const float number : {0.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f})
            add(number);
        add(std::uint8_t{3});
        for (const std::int32_t corner : {0, 1, 2})
            add(corner);
        const MeshData binary = read(bytes);
        EXPECT_EQ(binary.vertices, text.vertices);
        EXPECT_EQ(binary.triangles, text.triangles);
        EXPECT_EQ(binary.uv, text.uv);
        const std::string too_early =
            "byte " + std::to_string(bytes.size() - 3) + ": the file ends too early";
        EXPECT_EQ(fault_of_mesh(bytes.substr(0, bytes.size() - 2)), too_early);
    }
    EXPECT_EQ(text.uv[0][1], (std::array<double, 2>{1, 0}));
}

TEST(MeshFile, RefusesDamagedPly) {
    std::string endless = header("ascii");
    endless.replace(endless.find("vertex 3"), 8, "vertex 99999999999");
    EXPECT_THAT(fault_of_mesh(endless + "0 0 0"), HasSubstr("shorter than its header says"));
    EXPECT_THAT(fault_of_mesh(header("ascii") + "0 0 0 0 0 1 0 0 1 0 0 1 0 0 1 3 0 1 7"),
                HasSubstr("names vertex 7"));
    EXPECT_THAT(fault_of_mesh(header("ascii") + "0 0 0 0 0 1 0 0 1 0 0 1 0 0 1 900000 0 1 2"),
                HasSubstr("longer than the file"));
    const std::string start = header("ascii");
    EXPECT_EQ(fault_of_mesh(start + "0 0 nan 0 0 1 0 0 1 0 0 1 0 0 1 3 0 1 2"),
              "byte " + std::to_string(start.size() + 8) + ": a coordinate is nan, and 1000000 is the most");
    EXPECT_THAT(fault_of_mesh(header("cuneiform")), HasSubstr("line 2: 'cuneiform' is no format"));
    EXPECT_THAT(fault_of_mesh(header("binary_middle_endian")), HasSubstr("is no format"));
    EXPECT_THAT(fault_of_mesh("ply\nelement vertex x\n"), HasSubstr("no number of elements"));
    EXPECT_THAT(fault_of_mesh("ply\n"), HasSubstr("does not end"));
}

TEST(MeshFile, CountsThePlyElementsOfOneNameTogether) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    for (int i = 0; i < 11; ++i)
        text += "element vertex 100000\nproperty uchar x\n";
    text += "end_header\n" + std::string(1'100'000, ' ');
    EXPECT_THAT(fault_of_mesh(text), HasSubstr("there are 1100000 vertices, and 1000000 are the most"));
}

/// Bytes of a binary STL file. `head`: its first bytes.
std::string binary_stl(const std::vector<std::array<float, 9>>& facets, std::string head = "") {
    head.resize(80, ' ');
    const auto add = [&](auto number, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i)
            head += static_cast<char>(number >> (8 * i) & 0xff);
    };
    add(static_cast<std::uint32_t>(facets.size()), 4);
    for (const std::array<float, 9>& facet : facets) {
        for (int i = 0; i < 3; ++i) // no normal
            add(0x7fc00000u, 4);
        for (const float number : facet)
            add(std::bit_cast<std::uint32_t>(number), 4);
        add(0x1234u, 2); // some programs put a colour there
    }
    return head;
}

TEST(MeshFile, ReadsStlAsTextAndBinary) {
    std::mt19937 random(26);
    std::uniform_int_distribution<int> whole(-3, 3); // many corners at one place
    std::string obj, text = "solid of facets, and vertex x\n";
    std::vector<std::array<float, 9>> facets(60);
    for (std::array<float, 9>& facet : facets) {
        text += "facet normal nan 0 1e400\r\n  OUTER loop\n";
        for (std::size_t k = 0; k < 9; ++k) {
            facet[k] = static_cast<float>(whole(random)) / 4;
            text += (k % 3 == 0 ? "vertex " : " ") + std::to_string(facet[k]) + (k % 3 == 2 ? "\n" : "");
            obj += (k % 3 == 0 ? "v " : " ") + std::to_string(facet[k]) + (k % 3 == 2 ? "\n" : "");
        }
        text += "endloop endfacet\n";
        obj += "f -3 -2 -1\n";
    }
    const MeshData expected = read(obj), as_text = read(text + "endsolid\nsolid empty\nendsolid empty");
    const auto corners_of = [](const MeshData& data) {
        std::vector<std::array<Vec3, 3>> corners;
        for (const auto& [a, b, c] : data.triangles)
            corners.push_back({data.vertices[a], data.vertices[b], data.vertices[c]});
        return corners;
    };
    EXPECT_EQ(corners_of(as_text), corners_of(expected));
    for (std::size_t i = 0; i < as_text.vertices.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NE(as_text.vertices[i], as_text.vertices[j]) << "one vertex a place";
    EXPECT_LT(as_text.vertices.size(), expected.vertices.size());
    for (const char* const head : {"", "solid of bytes\n", "v 0 0 0\n"}) {
        const MeshData binary = read(binary_stl(facets, head));
        EXPECT_EQ(binary.vertices, as_text.vertices) << head;
        EXPECT_EQ(binary.triangles, as_text.triangles) << head;
    }
    EXPECT_EQ(
        read(binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {-0.f, 0, 0, 0, 1, 0, -1, 0, 0}})).vertices.size(), 4u);
}

TEST(MeshFile, RefusesDamagedStl) {
    const std::array<float, 9> facet = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string binary = binary_stl({facet, facet});
    std::string lying = binary;
    lying[82] = 1;
    EXPECT_THAT(fault_of_mesh(lying),
                HasSubstr("a binary STL file of its number of triangles has 3276984 bytes, "
                          "not 184"));
    lying.replace(80, 4, 4, '\xff');
    EXPECT_THAT(fault_of_mesh(lying), HasSubstr("has 214748364834 bytes, not 184"));
    for (const std::size_t size : {183u, 134u, 90u})
        EXPECT_THAT(fault_of_mesh(binary.substr(0, size)), HasSubstr("has 184 bytes, not")) << size;
    EXPECT_THAT(fault_of_mesh(binary_stl({})), HasSubstr("it holds no vertex"));
    EXPECT_EQ(fault_of_mesh(binary_stl({facet, {0, 0, 0, 1, std::nanf(""), 0, 0, 1, 0}})),
              "byte 159: a coordinate is nan, and 1000000 is the most");
    EXPECT_THAT(fault_of_mesh(binary_stl({{0, 0, 0, 1, 0, 0, 0, 2e6f, 0}})),
                HasSubstr("a coordinate is 2000000"));
    EXPECT_THAT(fault_of_mesh(binary_stl({{0, 0, 0, 1, 0, 0, 2, 0, 0}})),
                HasSubstr("no triangle of the file"));
    EXPECT_THAT(fault_of_mesh(binary_stl(std::vector<std::array<float, 9>>(1'000'001, facet))),
                HasSubstr("there are 1000001 triangles"));
    const std::string loop = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
    for (const auto& [rest, fault] : std::vector<std::pair<std::string, std::string>>{
             {"vertex 0 1 0\nendloop\n", "line 8: the file ends within a facet"},
             {"", "line 6: the file ends within a facet"},
             {"endloop endfacet endsolid", "line 6: a facet has three corners, and then 'endloop'"},
             {"endsolid", "line 6: a facet has three corners, and then 'endloop'"},
             {"vertex 0 1 0\nvertex 1 1 0\nendloop", "line 7: a facet has three corners, and then 'endloop'"},
             {"vertex 0 one 0", "line 6: a vertex has three numbers"},
             {"vertex 0 1", "line 6: a vertex has three numbers"},
             {"vertex 0 1 inf", "line 6: a coordinate is inf, and 1000000 is the most"},
             {"vertex 0 1 0\nendloop\nsphere", "line 8: 'sphere' makes no sense in an STL file"}})
        EXPECT_EQ(fault_of_mesh(loop + rest), fault);
    EXPECT_THAT(fault_of_mesh("solid nothing\nendsolid nothing\n"), HasSubstr("it holds no vertex"));
    EXPECT_EQ(read(loop + "vertex 0 1 0\nendloop\nendfacet\n").triangles.size(), 1u) << "some end so";
}

TEST(MeshFile, KeepsOneOfTrianglesThatCoincide) {
    // The corners turned about, other numbers of the same places, -0 for 0.
    const MeshData data = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\n"
                               "f 1 2 3\nf 2 3 1\nf 4 5 3\nf 1 2 3\n");
    EXPECT_EQ(data.triangles.size(), 1u);
    EXPECT_EQ(data.vertices.size(), 3u);
    // The back of a triangle is another triangle: other programs draw one side only.
    EXPECT_EQ(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n").triangles.size(), 2u);
}

} // namespace
} // namespace graftal
