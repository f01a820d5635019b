// Primitives that numbers or a file make, from the text to the graph and back.

#include <filesystem>
#include <fstream>
#include <string>

#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/languages/lower.h"
#include "runtime/system/disk_files.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

/// A folder that is removed.
class Folder {
  public:
    Folder() : path_(testing::TempDir() + "shapes_" + std::to_string(counter_++)) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ + "/" + name) << text;
        return path_ + "/" + name;
    }
    const std::string& path() const { return path_; }

  private:
    static inline int counter_ = 0;
    std::string path_;
};

struct Lowered {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph;

    explicit Lowered(const std::string& text, const std::string& folder = ".",
                     const LowerOptions& options = {}) {
        graph = lower_text(folder + "/m.inst", text, options, sources, diagnostics, {.files = &disk_files()})
                    .graph;
    }
    std::string errors() const { return diagnostics.render(sources); }
};

constexpr const char* triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

void expect_reads_back(const Graph& graph) {
    EXPECT_TRUE(verify(graph).empty());
    const Lowered again(print(graph));
    ASSERT_TRUE(again.graph) << again.errors() << print(graph);
    EXPECT_TRUE(equal(graph, *again.graph)) << print(graph);
}

TEST(InstShapes, NumbersMakePrimitives) {
    const Lowered model(
        "let e = 0.5\n"
        "object a {\n  superellipsoid(e, 2 * e)\n  superellipsoid(0.5, 1) translate: 1, 0, 0\n"
        "  polygon(0, 0, 1, 0, 0, 1) scale: 2\n  frustum(0.5) translate: 0, 1, 0\n}\n");
    ASSERT_TRUE(model.graph) << model.errors();
    const Object& root = model.graph->objects[model.graph->root];
    ASSERT_EQ(root.instances.size(), 4u);
    EXPECT_EQ(root.instances[0].master, root.instances[1].master);
    EXPECT_EQ(model.graph->objects[root.instances[0].master].name, "superellipsoid(0.5, 1)");
    EXPECT_EQ(model.graph->objects[root.instances[2].master].primitive->kind(), PrimitiveKind::polygon);
    expect_reads_back(*model.graph);
}

TEST(InstShapes, FaultsAreToldAtTheirPlace) {
    EXPECT_THAT(Lowered("object a { superellipsoid(0.5, 3) }\n").errors(),
                HasSubstr("m.inst:1:12: error: the expon"));
    EXPECT_THAT(Lowered("object a { superellipsoid(1) }\n").errors(), HasSubstr("takes 2 arguments, not 1"));
    EXPECT_THAT(Lowered("object a { polygon(1, 2) }\n").errors(),
                HasSubstr("takes 6 to 2000 arguments, not 2"));
    EXPECT_THAT(Lowered("object a { polygon(0, 0, 2, 2, 2, 0, 0, 1) }\n").errors(),
                HasSubstr("meets itself"));
    EXPECT_THAT(Lowered("object a { mesh }\n").errors(), HasSubstr("'mesh' takes the name of a file"));
    EXPECT_THAT(Lowered("object a { sphere \"leaf.obj\" }\n").errors(), HasSubstr("takes no name of a file"));
}

TEST(InstShapes, AFileMakesAMesh) {
    const Folder folder;
    folder.write("leaf.obj", triangle_obj);
    const Lowered model("object a {\n  mesh \"leaf.obj\"\n  mesh(\"leaf.obj\") translate: 1, 0, 0\n}\n",
                        folder.path());
    ASSERT_TRUE(model.graph) << model.errors();
    const Object& root = model.graph->objects[model.graph->root];
    ASSERT_EQ(root.instances.size(), 2u);
    EXPECT_EQ(root.instances[0].master, root.instances[1].master);
    EXPECT_EQ(model.graph->objects[root.instances[0].master].name,
              "mesh(\"" + folder.path() + "/leaf.obj\")");
    expect_reads_back(*model.graph);
}

TEST(InstShapes, OnlySoundRegularFilesWithinTheRootAreRead) {
    const Folder folder;
    folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    folder.write("leaf.obj", triangle_obj);
    const std::string pipe = folder.path() + "/pipe.obj";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const auto errors = [&](const std::string& file, const LowerOptions& options = {}) {
        return Lowered("object a { mesh \"" + file + "\" }\n", folder.path(), options).errors();
    };
    EXPECT_THAT(errors("bad.obj"), HasSubstr("line 2: '2' names no vertex so far"));
    EXPECT_THAT(errors("bad.obj"), HasSubstr("1:17: error: cannot read"));
    EXPECT_THAT(errors("none.obj"), HasSubstr("cannot open"));
    EXPECT_THAT(errors("pipe.obj"), HasSubstr("is not a regular file"));
    LowerOptions options;
    options.root = folder.path() + "/inner";
    EXPECT_THAT(errors("leaf.obj", options), HasSubstr("leads out of the root folder"));
}

TEST(InstShapes, AModelsOwnNamesHideThoseOfKindsWithShapes) {
    const Folder folder;
    folder.write("leaf.obj", triangle_obj);
    folder.write("stick.inst", "object stick { cylinder }");
    const Lowered own("use sphere_sweep = \"stick.inst\"\n"
                      "canonical object polygon(n) { sphere  scale: n }\n"
                      "canonical object mesh { cube }\n"
                      "object all { union: polygon(2), polygon(0, 0, 1, 0, 0, 1), mesh, sphere_sweep\n"
                      "             mesh \"leaf.obj\" }",
                      folder.path());
    ASSERT_TRUE(own.graph) << own.errors();
    std::vector<std::string> masters;
    for (const Object& object : own.graph->objects)
        if (object.primitive) masters.push_back(object.name);
    EXPECT_THAT(masters,
                ::testing::UnorderedElementsAre("sphere", "cube", "cylinder", "polygon(0, 0, 1, 0, 0, 1)",
                                                "mesh(\"" + folder.path() + "/leaf.obj\")"));
    expect_reads_back(*own.graph);
    EXPECT_THAT(Lowered("canonical object polygon(n) { sphere }\nobject a { polygon(1, 2) }").errors(),
                HasSubstr("'polygon' takes 1 argument, not 2"));
    EXPECT_THAT(Lowered("canonical object cone(n) { sphere }\nobject a { cone(1) }").errors(),
                HasSubstr("'cone' is a primitive and cannot be defined"));
}

TEST(InstShapes, ManyShapesAreOneObjectEach) {
    const Lowered many("canonical object f(0) { sphere }\n"
                       "canonical object f(n) { union: superellipsoid(1, 0.5 + n / 100000), f(n - 1) }\n"
                       "object all { f(30000) }");
    ASSERT_TRUE(many.graph) << many.errors();
    EXPECT_EQ(many.graph->objects.size(), 30000u + 30001u + 2u);
}

} // namespace
} // namespace graftal
