// What the files say.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/primitives/mesh_file.h"
#include "runtime/image_files/image_files.h"
#include "runtime/image_files/texture_store.h"
#include "tests/unit/export/exporting.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using Facet = std::array<std::array<float, 3>, 3>;

std::vector<Facet> stl_facets(const std::string& bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    EXPECT_EQ(bytes.size(), 84 + 50 * static_cast<std::size_t>(count));
    std::vector<Facet> facets(count);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(&facets[i], bytes.data() + 84 + 50 * i + 12, sizeof(Facet));
    return facets;
}

/// Edges that have not as many facets on one side as on the other.
std::size_t open_edges(const std::vector<Facet>& facets) {
    using Corner = std::array<float, 3>;
    std::map<std::pair<Corner, Corner>, int> edges;
    for (const Facet& facet : facets)
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner &a = facet[i], &b = facet[(i + 1) % 3];
            a < b ? ++edges[{a, b}] : --edges[{b, a}];
        }
    return static_cast<std::size_t>(
        std::ranges::count_if(edges, [](const auto& edge) { return edge.second != 0; }));
}

struct Sizes {
    double area = 0, volume = 0;
};

Sizes sizes_of(const MeshData& mesh) {
    Sizes sizes;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
        const Vec3 across(((b - a).y * (c - a).z - (b - a).z * (c - a).y),
                          ((b - a).z * (c - a).x - (b - a).x * (c - a).z),
                          ((b - a).x * (c - a).y - (b - a).y * (c - a).x));
        sizes.area += 0.5 * std::sqrt(across.x * across.x + across.y * across.y + across.z * across.z);
        sizes.volume += (a.x * across.x + a.y * across.y + a.z * across.z) / 6;
    }
    return sizes;
}

struct NamedText {
    std::string name, text;
};

TEST(Stl, SolidsAreWatertight) {
    const NamedText models[] = {
        {"cubes.rifs", cubes},
        {"round.inst",
         "object m {\n sphere scale: 1, 0.3, 2 rotate: x, 33\n torus rotate: z, 10 translate: 3, 0, "
         "0\n}\n"},
        {"long.inst",
         "object m {\n frustum(0.5) rotate: x, 20\n cone scale: 0.001, 5, 1 translate: 2, 0, 0\n "
         "cylinder scale: -1, 2, 1\n}\n"},
        {"swept.inst",
         "object m {\n superellipsoid(0.5, 1.5) rotate: x, 7\n sphere_sweep(0, 0, 0, 0.2, 1, 1, 0, "
         "0.1, 2, 0, 1, 0.3) scale: 1, 2, 1\n}\n"},
        {"skin.lsys", "lsys m {\n skin 0.05\n width 0.4\n angle 33\n steps 5\n axiom A\n"
                      " A -> F![+A]/(50)F![&!A]^(12)A\n}\n"},
        {"shrub.inst", shrub}};
    for (const auto& [name, text] : models) {
        Exporting exporting(name, text);
        exporting.options.compile.lower.steps = 4;
        if (!std::string(name).ends_with(".rifs")) exporting.options.compile.lower.steps.reset();
        exporting.options.file.unit_mm = 1e-3; // small numbers are rounded as large ones are
        ASSERT_TRUE(exporting.to("m.stl")) << name << exporting.said();
        const std::vector<Facet> facets = stl_facets(exporting.read("m.stl"));
        EXPECT_GT(facets.size(), 10u) << name;
        EXPECT_EQ(open_edges(facets), 0u) << name;
    }
}

TEST(Stl, SaysHowManySurfacesAreOpen) {
    const auto said_of = [](const std::string& text) {
        Exporting exporting("m.inst", text);
        EXPECT_TRUE(exporting.to("m.stl")) << exporting.said();
        return exporting.said();
    };
    const std::string leaves =
        said_of("canonical object leaf { triangle }\nobject m {\n leaf\n leaf translate: 3, 0, 0\n"
                " cube translate: 0, 5, 0\n}\n");
    EXPECT_THAT(leaves, HasSubstr("2 of 3 surfaces are not closed"));
    EXPECT_THAT(leaves, HasSubstr("--part"));
    EXPECT_EQ(leaves.find("not closed"), leaves.rfind("not closed"));
    EXPECT_THAT(said_of("object m {\n cube\n sphere translate: 3, 0, 0\n}\n"),
                testing::Not(HasSubstr("not closed")));
}

TEST(Stl, IsInMillimetresWithZUp) {
    Exporting exporting("m.inst", "object m { cube scale: 1, 2, 3 translate: 0, 10, 0 }\n");
    exporting.options.file.unit_mm = 25.4;
    const auto said = exporting.to("m.stl");
    ASSERT_TRUE(said) << exporting.said();
    EXPECT_THAT(*said, HasSubstr("12 triangles, 50.8 x 152 x 102 mm"));
    Box box;
    for (const Facet& facet : stl_facets(exporting.read("m.stl")))
        for (const auto& corner : facet)
            box.include({corner[0], corner[1], corner[2]});
    EXPECT_NEAR(box.min.z, 25.4 * 8, 1e-3);
    EXPECT_NEAR(box.max.z, 25.4 * 12, 1e-3);
}

TEST(FlatFiles, HaveTheSameMesh) {
    Exporting exporting("m.inst", shrub);
    for (const char* name : {"m.obj", "m.ply"})
        ASSERT_TRUE(exporting.to(name)) << exporting.said();
    std::string fault;
    const auto obj = read_obj(exporting.read("m.obj"), fault);
    ASSERT_TRUE(obj) << fault;
    const auto ply = read_ply(exporting.read("m.ply"), fault);
    ASSERT_TRUE(ply) << fault;
    ASSERT_EQ(obj->triangles.size(), ply->triangles.size());
    const Sizes a = sizes_of(*obj), b = sizes_of(*ply);
    EXPECT_NEAR(a.area, b.area, 1e-6 * b.area);
    EXPECT_NEAR(a.volume, b.volume, 1e-6 * b.volume);
    EXPECT_GT(b.volume, 0); // mirrored parts too are seen from outside
    // A volume known: 6 solids of each kind scaled; here the cylinder of the first twig alone bounds it.
    EXPECT_EQ(obj->normals.size(), obj->vertices.size());
}

TEST(FlatFiles, AMirroredPartIsNotInsideOut) {
    for (const char* scale : {"1", "-1, 1, 1", "-1", "1, -1, -1"}) {
        Exporting exporting("m.inst", std::string("object m { torus scale: ") + scale + " }\n");
        ASSERT_TRUE(exporting.to("m.ply")) << exporting.said();
        std::string fault;
        const auto mesh = read_ply(exporting.read("m.ply"), fault);
        ASSERT_TRUE(mesh) << fault;
        EXPECT_GT(sizes_of(*mesh).volume, 1.1) << scale; // 2 pi^2 / 16 = 1.23
    }
}

TEST(Obj, NamesMaterialsThatItsMtlHas) {
    Exporting exporting("m.inst", shrub);
    ASSERT_TRUE(exporting.to("m.obj")) << exporting.said();
    const std::string obj = exporting.read("m.obj"), mtl = exporting.read("m.mtl");
    EXPECT_THAT(obj, HasSubstr("mtllib m.mtl\n"));
    std::size_t used = 0;
    for (std::size_t at = 0; (at = obj.find("usemtl ", at)) != std::string::npos; ++used) {
        const std::string name = obj.substr(at + 7, obj.find('\n', at) - at - 7);
        EXPECT_THAT(mtl, HasSubstr("newmtl " + name + "\n"));
        at += 7;
    }
    EXPECT_GT(used, 8u);
    EXPECT_THAT(mtl, HasSubstr("newmtl bark_0\nKd 0.4 0.3 0.2\n"));
}

TEST(FlatFiles, AreRefusedWithTheirSize) {
    Exporting exporting("m.rifs", cubes);
    exporting.options.compile.lower.steps = 60;
    exporting.options.compile.detail.error_px = 0;
    exporting.options.error_asked = true; // else graftal leaves out what is too much
    for (const char* name : {"m.obj", "m.ply", "m.stl"}) {
        EXPECT_FALSE(exporting.to(name));
        EXPECT_THAT(exporting.said(), HasSubstr("would have 4.23e+28 primitives with 5.08e+29 triangles"));
        EXPECT_FALSE(std::filesystem::exists(exporting.path(name)));
    }
}

TEST(FlatFiles, AreRefusedWhereTheirNumbersDoNotHoldTheModel) {
    for (const char* text : {"object m { cube scale: 1e30 }\n", "object m { cube scale: 1e-30 }\n",
                             "object m { cube translate: 1e40, 0, 0 }\n"})
        for (const ExportFormat& format : export_formats()) {
            Exporting exporting("m.inst", text);
            EXPECT_FALSE(exporting.to("m" + std::string(format.extension))) << text << format.name;
            EXPECT_TRUE(exporting.compilation.diagnostics.has_errors()) << text << format.name;
            EXPECT_FALSE(std::filesystem::exists(exporting.path("m" + std::string(format.extension))));
        }
}

TEST(Formats, WriteTheSameBytesAgain) {
    for (const ExportFormat& format : export_formats()) {
        const std::string name = "m" + std::string(format.extension);
        std::string first;
        for (const int time : {0, 1}) {
            Exporting exporting(
                "m.inst", format.extension == ".svg" ? "object m { cube scale: 1, 1, 0.001 }\n" : shrub);
            ASSERT_TRUE(exporting.to(name)) << format.name << exporting.said();
            if (time == 0)
                first = exporting.read(name);
            else
                EXPECT_TRUE(first == exporting.read(name)) << format.name;
        }
        EXPECT_GT(first.size(), 100u) << format.name;
    }
}

TEST(Formats, CoverByTheShareOfAVeil) {
    const std::map<std::string, std::string> says = {{"m.gltf", "\"alphaMode\": \"BLEND\""},
                                                     {"m.usda", "float inputs:opacity = 0.25\n"},
                                                     {"m.mtl", "d 0.25\n"},
                                                     {"m.svg", "fill-opacity=\"0.25\""},
                                                     {"m.xml", "<float name=\"opacity\" value=\"0.25\"/>"},
                                                     {"m.pbrt", "\"float alpha\" [ 0.25 ]"}};
    for (const auto& [name, text] : says) {
        Exporting exporting("m.inst", "material veil { color: 1, 0, 0  transparency: 0.75  filter: 0 }\n"
                                      "object m { cube scale: 1, 1, 0.001  material: veil }\n");
        ASSERT_TRUE(exporting.to(name == "m.mtl" ? "m.obj" : name)) << name << exporting.said();
        EXPECT_THAT(exporting.read(name), HasSubstr(text)) << name;
    }
}

TEST(Formats, CutHolesOnlyWherePicturesHaveThem) {
    for (const bool clear : {false, true}) {
        Exporting exporting("m.inst", "material bark { texture: \"bark.png\" }\n"
                                      "object top { cube material: bark }\n");
        Texture picture;
        picture.width = 2;
        picture.height = 1;
        picture.texels = {{{200, 100, 50}, false}, {{20, 30, 40}, clear}};
        PendingFile file(exporting.path("bark.png"));
        ASSERT_TRUE(write_texture(file, picture).ok());
        ASSERT_TRUE(file.commit().ok());
        for (const auto& [name, sign] : {std::pair("m.glb", "MASK"),
                                         {"m.usda", "opacityThreshold"},
                                         {"m.pbrt", "texture alpha"},
                                         {"m.xml", "\"mask\""}}) {
            ASSERT_TRUE(exporting.to(name)) << exporting.said();
            EXPECT_EQ(exporting.read(name).find(sign) != std::string::npos, clear) << name;
        }
    }
}

TEST(Formats, NameMaterialsPicturesAndLight) {
    Exporting exporting("m.inst",
                        "light { sun: 1,2,3  angle: 0.5  brightness: 1.5 }\n"
                        "sky { environment: \"half.exr\"  brightness: 2 }\n"
                        "material bark { texture: \"bark.png\" }\n"
                        "material blade { color: 0.2,0.5,0.1  diffuse: 0.6  translucency: 0.4 }\n"
                        "object m {\n cube material: bark\n cube material: blade  translate: 3, 0, 0\n}\n");
    write_bark(exporting);
    Image sky{2, 2, 3, {1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0}};
    ASSERT_TRUE(write_image(exporting.path("half.exr"), sky, SampleFormat::linear16).ok());
    ASSERT_TRUE(exporting.to("m.usda")) << exporting.said();
    const std::string usd = exporting.read("m.usda");
    EXPECT_EQ(exporting.files(), "bark.png half.exr m.inst m.usda m_bark.png m_sky.exr");
    for (const char* text :
         {"def Scope \"materials\"\n{\n def Material \"bark\"", "\n def Material \"blade\"",
          "references = </materials/bark>", "references = </materials/blade>", "@m_bark.png@",
          "float inputs:intensity = 3.1415927\n  float inputs:angle = 0.5\n  bool inputs:normalize = 1\n",
          "color3f inputs:color = (2, 2, 2)\n  asset inputs:texture:file = @m_sky.exr@"})
        EXPECT_THAT(usd, HasSubstr(text));
    EXPECT_EQ(usd.find("\"look\""), std::string::npos);
    Image copy;
    ASSERT_TRUE(read_image(exporting.path("m_sky.exr"), copy).ok());
    EXPECT_EQ(copy.pixels.front(), 1);
    EXPECT_EQ(copy.pixels.back(), 0);
    ASSERT_TRUE(exporting.to("m.gltf")) << exporting.said();
    EXPECT_THAT(exporting.read("m.gltf"), testing::ContainsRegex("\"diffuseTransmissionFactor\": 0.4[,\n]"));
    EXPECT_THAT(exporting.read("m.gltf"), testing::ContainsRegex("\"name\": \"bark\"[^{}]*\\}"));
    EXPECT_THAT(exporting.said(), HasSubstr("no light of the sky"));
    ASSERT_TRUE(exporting.to("m.pbrt")) << exporting.said();
    EXPECT_THAT(exporting.read("m.pbrt"),
                testing::ContainsRegex("\"infinite\" \"rgb L\" \\[ (1|0\\.99999999)")); // the mean
}

/// Without that, the copy of one picture would be written over another.
TEST(Formats, CopyPicturesBesideThoseOfTheModel) {
    Exporting exporting("m.inst",
                        "material a { texture: \"bark.png\" }\n"
                        "material b { texture: \"m_bark.png\" }\n"
                        "object m {\n cube material: a\n cube material: b  translate: 3, 0, 0\n}\n");
    std::vector<std::string> before;
    for (const auto& [name, red] : {std::pair("bark.png", 200), {"m_bark.png", 100}}) {
        Texture picture;
        picture.width = picture.height = 1;
        picture.texels = {{{static_cast<std::uint8_t>(red), 0, 0}, false}};
        PendingFile file(exporting.path(name));
        ASSERT_TRUE(write_texture(file, picture).ok());
        ASSERT_TRUE(file.commit().ok());
        before.push_back(exporting.read(name));
    }
    ASSERT_TRUE(exporting.to("m.obj")) << exporting.said();
    EXPECT_EQ(exporting.files(), "bark.png m.inst m.mtl m.obj m_bark.png m_bark_2.png m_m_bark.png");
    EXPECT_EQ(exporting.read("bark.png"), before[0]);
    EXPECT_EQ(exporting.read("m_bark.png"), before[1]);
    EXPECT_EQ(exporting.read("m_bark_2.png"), before[0]);
    EXPECT_EQ(exporting.read("m_m_bark.png"), before[1]);
    EXPECT_THAT(exporting.read("m.mtl"), HasSubstr("map_Kd m_bark_2.png\n"));
}

// Corners of one height were compared with each other, all with all.
TEST(FlatFiles, HoldManyTrianglesInAPlane) {
    constexpr int steps = 40000;
    std::string strip = "v 0 0 0\nv 0 1 0\n";
    for (int i = 1; i <= steps; ++i)
        strip += fmt::format("v 0 0 {0}\nv 0 1 {0}\nf -4 -3 -2\nf -3 -1 -2\n", i);
    Exporting exporting("m.inst", "object top { mesh(\"strip.obj\") }\n");
    ASSERT_TRUE(write_text(exporting.path("strip.obj"), strip).ok());
    ASSERT_TRUE(exporting.to("m.stl")) << exporting.said();
    EXPECT_EQ(exporting.read("m.stl").size(), 84u + 50u * 2 * steps);
}

/// The lines of a file that begin with a word, without it.
std::vector<std::string> lines_after(const std::string& text, const std::string& word) {
    std::vector<std::string> lines;
    for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
        end = std::min(text.find('\n', at), text.size());
        if (text.compare(at, word.size(), word) == 0)
            lines.push_back(text.substr(at + word.size(), end - at));
    }
    return lines;
}

/// The length of the longest list of vectors that a text has behind these words.
std::size_t most_listed(const std::string& text, const std::string& words) {
    std::size_t most = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
        const std::string list =
            text.substr(at + words.size(), text.find(']', at + words.size()) - at - words.size());
        most = std::max(most, static_cast<std::size_t>(std::ranges::count(list, '(')));
    }
    return most;
}

/// A picture makes no soup of triangles: corners that agree in place, normal and texture point are one
/// vertex.
TEST(Formats, ShareTheVerticesOfWhatHasAPicture) {
    const std::string bark = "material bark { texture: \"bark.png\" }\n";
    const NamedText models[] = {
        {"cube.inst", bark + "object m { cube material: bark }\n"},
        {"round.inst", bark + "object m { cylinder material: bark }\n"},
        {"skin.lsys",
         bark + "lsys m {\n skin 0.05\n width 0.4\n colors bark\n steps 0\n axiom F+(20)F\n}\n"}};
    for (const auto& [name, text] : models) {
        Exporting exporting(name, text);
        write_bark(exporting);
        for (const char* const written : {"m.obj", "m.ply", "m.usda", "m.gltf"})
            ASSERT_TRUE(exporting.to(written)) << exporting.said();
        const std::string obj = exporting.read("m.obj");
        const std::vector<std::string> places = lines_after(obj, "v "), normals = lines_after(obj, "vn "),
                                       points = lines_after(obj, "vt ");
        const std::size_t triangles = lines_after(obj, "f ").size(), vertices = places.size();
        ASSERT_EQ(normals.size(), vertices);
        ASSERT_EQ(points.size(), vertices);
        std::set<std::string> different;
        for (std::size_t i = 0; i < vertices; ++i)
            different.insert(places[i] + normals[i] + points[i]);
        EXPECT_EQ(different.size(), vertices) << name;
        EXPECT_LE(vertices, 2 * triangles) << name;
        if (name == "cube.inst") {
            EXPECT_EQ(vertices, 24u); // four a face
        }
        if (name == "skin.lsys") {
            EXPECT_LT(vertices, triangles); // of a closed surface half as many, without its seams
        }
        const auto head = exporting.read("m.ply").substr(0, 1000);
        EXPECT_THAT(head, HasSubstr(fmt::format("element vertex {}\n", vertices)));
        EXPECT_THAT(head, HasSubstr(fmt::format("element face {}\n", triangles)));
        const std::string usd = exporting.read("m.usda");
        EXPECT_EQ(most_listed(usd, "point3f[] points = ["), most_listed(usd, "texCoord2f[] primvars:st = ["));
        EXPECT_LE(most_listed(usd, "point3f[] points = ["), vertices);
        EXPECT_THAT(exporting.read("m.gltf"), HasSubstr(fmt::format("\"count\": {}", vertices)));
    }
}

/// A turtle's polygon as one of `.inst`: its triangles have parts of one picture.
TEST(Formats, CoverATurtlesPolygonOnce) {
    const std::string bark = "material bark { texture: \"bark.png\" }\n";
    const NamedText models[] = {
        {"m.lsys", bark + "lsys m { steps 0\n colors bark\n"
                          " axiom {.+(28)f(0.5)-(28)f(0.4)-(40)f(0.35)-(104)f(0.35)-(40)f(0.4)}\n}\n"},
        {"m.inst", bark + "object m { polygon(0,0, -0.2347,0.4415, -0.2347,0.8415, -0.0098,1.1096,"
                          " 0.196,0.8264, 0.1681,0.4274) material: bark }\n"}};
    for (const auto& [name, text] : models) {
        Exporting exporting(name, text);
        write_bark(exporting);
        ASSERT_TRUE(exporting.to("m.obj")) << exporting.said();
        const std::string obj = exporting.read("m.obj");
        const std::vector<std::string> places = lines_after(obj, "v "), points = lines_after(obj, "vt ");
        ASSERT_GE(places.size(), 6u) << name;
        ASSERT_EQ(points.size(), places.size()) << name;
        for (std::size_t i = 0; i < places.size(); ++i) {
            double x = 0, y = 0, u = 0, v = 0;
            ASSERT_EQ(std::sscanf(places[i].c_str(), "%lf %lf", &x, &y), 2);
            ASSERT_EQ(std::sscanf(points[i].c_str(), "%lf %lf", &u, &v), 2);
            EXPECT_NEAR(u, (x + 0.2347) / (0.196 + 0.2347), 1e-3) << name << places[i];
            EXPECT_NEAR(v, y / 1.1096, 1e-3) << name << places[i];
        }
    }
}

/// Bark can be put on later.
TEST(Formats, KeepThePlacesOfSkinsWithoutAPicture) {
    const auto model = [](const std::string& look, const std::string& more) {
        return "material rind { " + look + " }\nlsys m {\n skin 0.05\n width 0.4\n colors rind\n steps 0\n" +
               " axiom F+(20)F" + more + "\n}\n";
    };
    const auto places = [](Exporting& exporting) {
        EXPECT_TRUE(exporting.to("m.usda")) << exporting.said();
        const std::string usd = exporting.read("m.usda");
        const std::size_t at = usd.find("primvars:st = [");
        return at == std::string::npos ? std::string() : usd.substr(at, usd.find(']', at) - at);
    };
    Exporting plain("m.lsys", model("color: 0.4, 0.3, 0.2", ""));
    Exporting pictured("m.lsys", model("texture: \"bark.png\"", ""));
    write_bark(pictured);
    EXPECT_GT(places(plain).size(), 100u);
    EXPECT_EQ(places(plain), places(pictured));
    ASSERT_TRUE(plain.to("m.obj")) << plain.said();
    EXPECT_TRUE(lines_after(plain.read("m.obj"), "vt ").empty());
    // A ball of the same material stays without.
    Exporting mixed("m.lsys", model("color: 0.4, 0.3, 0.2", "@O(2)"));
    ASSERT_TRUE(mixed.to("m.gltf")) << mixed.said();
    const std::string gltf = mixed.read("m.gltf");
    const auto count_of = [&](const std::string& words) {
        std::size_t count = 0;
        for (std::size_t at = gltf.find(words); at != std::string::npos; at = gltf.find(words, at + 1))
            ++count;
        return count;
    };
    EXPECT_EQ(count_of("\"POSITION\""), 2u);
    EXPECT_EQ(count_of("\"TEXCOORD_0\""), 1u);
}

TEST(Formats, HoldAPictureOfTwoMaterialsOnce) {
    Exporting exporting("m.inst", "material a { texture: \"bark.png\" }\n"
                                  "material b { texture: \"bark.png\"  specular: 0.5 }\n"
                                  "object m {\n torus material: a\n sphere material: b\n}\n");
    write_bark(exporting);
    ASSERT_TRUE(exporting.to("m.gltf")) << exporting.said();
    const std::string gltf = exporting.read("m.gltf");
    const std::size_t first = gltf.find("image/png");
    EXPECT_NE(first, std::string::npos);
    EXPECT_EQ(gltf.find("image/png", first + 1), std::string::npos);
    EXPECT_NE(gltf.find("\"name\": \"b\""), std::string::npos);
}

/// A limit below three corners for each triangle holds the file all the same.
TEST(FlatFiles, AreNotRefusedForVerticesThatAreShared) {
    Exporting exporting("m.inst",
                        "material bark { texture: \"bark.png\" }\nobject m { torus material: bark }\n");
    write_bark(exporting);
    exporting.options.error_asked = true;
    ASSERT_TRUE(exporting.to("m.ply")) << exporting.said();
    exporting.options.file.most_bytes = exporting.read("m.ply").size();
    ASSERT_TRUE(exporting.to("m.ply")) << exporting.said();
    --exporting.options.file.most_bytes;
    EXPECT_FALSE(exporting.to("m.ply"));
    EXPECT_THAT(exporting.said(), HasSubstr("--limit"));
}

TEST(Formats, HoldModelsOfNothingButPlanes) {
    for (const ExportFormat& format : export_formats()) {
        Exporting exporting("m.inst", "object m { plane }\n");
        const auto said = exporting.to("m" + std::string(format.extension));
        // No plane has an end: nothing is left, which is a file or an error, but no crash.
        EXPECT_TRUE(said || exporting.compilation.diagnostics.has_errors()) << format.name;
    }
}

TEST(Formats, AreFoundByTheirEndings) {
    for (const ExportFormat& format : export_formats()) {
        EXPECT_EQ(find_export_format("a.b/model" + std::string(format.extension))->extension,
                  format.extension);
        EXPECT_THAT(export_endings(), HasSubstr(std::string(format.extension)));
    }
    EXPECT_EQ(find_export_format("MODEL.STL")->extension, ".stl");
    EXPECT_EQ(find_export_format("model"), nullptr);
    EXPECT_EQ(find_export_format("model.fbx"), nullptr);
}

} // namespace
} // namespace graftal
