// Inner parameters: models that take the shape that their users ask for.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "compiler/lower/inner_parameters.h"
#include "tests/unit/languages/lower_file.h"

namespace graftal {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Models in a folder that goes when the test does.
class Inner : public ::testing::Test {
  protected:
    Inner() { std::filesystem::create_directories(folder_); }
    ~Inner() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

    void lower(const std::string& name, const LowerOptions& options = {}) {
        sources_ = SourceMap();
        diagnostics_ = Diagnostics();
        LoweredText model =
            test::lower_file((folder_ / name).string(), options, sources_, diagnostics_, status_);
        graph_ = std::move(model.graph);
        derivation_ = std::move(model.notes.derivation);
    }
    std::string report() const { return diagnostics_.render(sources_); }

    /// Of all spheres, as they stand in the world: depth first.
    std::vector<Affine> spheres() const {
        std::vector<Affine> found;
        collect(graph_->root, Affine(), found);
        return found;
    }

    void collect(ObjectId object, const Affine& place, std::vector<Affine>& found) const {
        const Object& o = graph_->objects[object];
        if (o.primitive) found.push_back(place);
        for (const Instance& instance : o.instances)
            collect(instance.master, place * instance.parent_from_child, found);
    }

    std::vector<double> heights() const {
        std::vector<double> heights;
        for (const Affine& place : spheres())
            heights.push_back(place.translation.y);
        return heights;
    }

    const std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                          ("graftal_inner_" + std::to_string(::getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    SourceMap sources_;
    Diagnostics diagnostics_;
    Status status_;
    std::optional<Graph> graph_;
    std::optional<Derivation> derivation_;
};

/// A sphere at the height k (10 times).
constexpr const char* mast = "inner k = 0.5 members 11\n"
                             "object mast { sphere translate: 0, lerp(0, 10, k), 0 }\n";

TEST_F(Inner, isALetOfTheRootModel) {
    write("a.inst", mast);
    lower("a.inst");
    ASSERT_TRUE(graph_) << report();
    EXPECT_THAT(heights(), ElementsAre(5));
    lower("a.inst", {.set = {{"k", 0.72}}});
    ASSERT_TRUE(graph_) << report();
    EXPECT_DOUBLE_EQ(heights().front(), 7.2);
    lower("a.inst", {.set = {{"k", 1.5}}});
    EXPECT_THAT(report(), HasSubstr("'k' as it is set: an inner parameter lies between 0 and 1, not at 1.5"));
}

TEST_F(Inner, condensationSetsHaveArguments) {
    write("mast.inst", mast);
    write("a.rifs",
          "use mast = \"mast.inst\"\nlet third = 0.3\nrifs a { map a { scale 0.5 }\n"
          "condense mast(third + 0.01)\ncondense mast\ncondense frustum(third)\nterminal mast(1)\n}");
    lower("a.rifs");
    ASSERT_TRUE(graph_) << report();
    const Object& root = graph_->objects[graph_->root];
    ASSERT_EQ(root.instances.size(), 4u);
    std::vector<Affine> found;
    for (const std::size_t i : {0u, 1u})
        collect(root.instances[i].master, Affine(), found);
    collect(root.terminal->master, Affine(), found);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_DOUBLE_EQ(found[0].translation.y, 3.1); // as it is said, not rounded
    EXPECT_DOUBLE_EQ(found[1].translation.y, 5);
    EXPECT_DOUBLE_EQ(found[2].translation.y, 10);
    EXPECT_EQ(graph_->objects[root.instances[2].master].primitive, tapered(0.3));
}

TEST_F(Inner, turtlesPlaceTheNearestMember) {
    write("mast.inst", mast);
    write("a.lsys",
          "use mast = \"mast.inst\"\nlsys a { steps 0\naxiom ~mast(0.31)~mast(0.29)~mast(1)~mast\n}");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    const std::vector<double> found = heights();
    ASSERT_EQ(found.size(), 4u);
    EXPECT_DOUBLE_EQ(found[0], 3);
    EXPECT_DOUBLE_EQ(found[1], 3);
    EXPECT_DOUBLE_EQ(found[2], 10);
    EXPECT_DOUBLE_EQ(found[3], 5);
    ASSERT_TRUE(derivation_);
    ASSERT_EQ(derivation_->families.size(), 1u);
    const FamilyReport& family = derivation_->families.front();
    EXPECT_EQ(family.model, "mast");
    EXPECT_THAT(family.parameters, ElementsAre("k"));
    EXPECT_EQ(family.used, 3u);
    EXPECT_EQ(family.possible, 11u);
    EXPECT_NEAR(family.error, 0.01, 1e-12);
}

TEST_F(Inner, aThousandLeavesAreAFamily) {
    write("leaf.rifs",
          "inner k = 0.5 members 8\nrifs leaf { map a { scale 0.5 translate <0, lerp(0.2, 0.6, k), 0> }\n"
          "map b { scale lerp(0.2, 0.4, k) } terminal sphere\n}");
    write("a.lsys",
          "use leaf = \"leaf.rifs\"\nlsys a { steps 1000\naxiom A(0)\nA(n) -> F[+~leaf(n/1000)]A(n+1)\n}");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    EXPECT_EQ(derivation_->families.front().used, 9u); // with the default, 1/2
    std::size_t leaves = 0;
    for (const Object& object : graph_->objects)
        leaves += object.name.ends_with(".leaf");
    EXPECT_EQ(leaves, 9u);
}

TEST_F(Inner, scalesFollowTheInnerArguments) {
    write("mast.inst", mast);
    write("plain.inst", "object plain { sphere\n}");
    write("a.lsys", "use mast = \"mast.inst\"\nuse plain = \"plain.inst\"\n"
                    "lsys a { steps 0\naxiom ~mast(0.1, 3)~mast(0.1, 4, 9)~plain(2)~plain(4, 9)\n}");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    const std::vector<Affine> found = spheres();
    ASSERT_EQ(found.size(), 4u);
    EXPECT_DOUBLE_EQ(found[0].translation.y, 3);
    EXPECT_DOUBLE_EQ(found[0].linear[2].z, 3);
    EXPECT_DOUBLE_EQ(found[1].translation.y, 9);
    EXPECT_DOUBLE_EQ(found[1].linear[0].x, 4);
    EXPECT_DOUBLE_EQ(found[1].linear[2].z, 6);
    EXPECT_DOUBLE_EQ(found[2].linear[2].z, 2);
    EXPECT_DOUBLE_EQ(found[3].linear[1].y, 9);
    EXPECT_DOUBLE_EQ(found[3].linear[2].z, 6);
}

TEST_F(Inner, blocksHaveFamiliesToo) {
    write("a.lsys", "lsys bud { steps 0\ninner k = 0 members 2, l = 0 members 3\naxiom f(k)f(10*l)@O(1)\n}\n"
                    "main lsys a { steps 0\naxiom ~bud(1, 0.4)[+~bud(0.9)]\n}");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    const std::vector<Affine> found = spheres();
    EXPECT_DOUBLE_EQ(found[0].translation.y, 6);
    EXPECT_DOUBLE_EQ(found[1].translation.x, -1);
}

TEST_F(Inner, fileAndMainBlockTogether) {
    write("bud.lsys",
          "inner a = 0 members 3\nlsys bud { steps 0\ninner b = 0 members 3\naxiom f(a)f(10*b)@O(1)\n}");
    write("a.lsys", "use bud = \"bud.lsys\"\nlsys a { steps 0\naxiom ~bud(0.5, 1, 2)\n}");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    EXPECT_DOUBLE_EQ(spheres()[0].translation.y, 21);
}

TEST_F(Inner, familiesWithinFamilies) {
    write("mast.inst", mast);
    write("two.inst", "use mast = \"mast.inst\"\ninner q = 0 members 5\n"
                      "object two { instance: mast(q) instance: mast(1 - q)\n}");
    write("a.lsys", "use two = \"two.inst\"\nlsys a { steps 0\naxiom ~two(0.25)\n}");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    EXPECT_THAT(heights(), ElementsAre(2.5, 7.5));
}

TEST_F(Inner, instancesTakeExactArguments) {
    write("mast.inst", mast);
    write("a.inst", "use mast = \"mast.inst\"\n"
                    "canonical object row(0) { mast\n}\n"
                    "canonical object row(n) { union: mast(n/7), row(n - 1) }\nobject a { row(2)\n}");
    lower("a.inst");
    ASSERT_TRUE(graph_) << report();
    const std::vector<double> found = heights();
    ASSERT_EQ(found.size(), 3u);
    EXPECT_DOUBLE_EQ(found[0], 20.0 / 7);
    EXPECT_DOUBLE_EQ(found[1], 10.0 / 7);
    EXPECT_DOUBLE_EQ(found[2], 5);
}

TEST_F(Inner, materialsAreSharedByAllMembers) {
    write(
        "leaf.inst",
        "inner k = 0\nmaterial leaf { color: 1, 0, 0 }\nobject leaf { sphere scale: 1 + k material: leaf\n}");
    write("a.lsys",
          "use leaf = \"leaf.inst\"\nlsys a { colors leaf\nsteps 0\naxiom F~leaf(0)~leaf(1)~leaf(0.5)\n}\n"
          "material leaf { color: 0, 1, 0 }");
    lower("a.lsys");
    ASSERT_TRUE(graph_) << report();
    std::vector<std::string> names;
    for (const Material& material : graph_->materials)
        names.push_back(material.name);
    EXPECT_THAT(names, ElementsAre("leaf", "leaf.leaf"));
}

TEST_F(Inner, faults) {
    const struct {
        const char* text;
        const char* error;
    } cases[] = {
        {"inner k = 2\nobject a { sphere\n}", "k: an inner parameter lies between 0 and 1, not at 2"},
        {"inner k = 0.5 members 1\nobject a { sphere\n}",
         "'members' must be a whole number from 2 to 256, not 1"},
        {"inner k = 0.5 members 2.5\nobject a { sphere\n}", "'members' must be a whole number"},
        {"inner a = 0 members 20, b = 0 members 20\nobject a { sphere\n}",
         "a family of more than 256 models"},
        {"inner k = 0\nlet k = 1\nobject a { sphere\n}", "duplicate 'let k'"},
        {"inner k = 0\ninner k = 1\nobject a { sphere\n}", "duplicate 'inner k'"},
        {"use mast = \"mast.inst\"\nobject a { mast(0.5, 1)\n}", "'mast' takes 1 argument, not 2"},
        {"use mast = \"mast.inst\"\nobject a { mast(1.2)\n}",
         "a.inst:2:12: error: 'k' of 'mast' lies between 0 and 1, not at 1.2"},
    };
    write("mast.inst", mast);
    for (const auto& [text, error] : cases) {
        write("a.inst", text);
        lower("a.inst");
        EXPECT_THAT(report(), HasSubstr(error)) << text;
    }
    write("b.lsys", "use mast = \"mast.inst\"\nlsys b { steps 2\naxiom A(0.5)\nA(n) -> ~mast(n)A(n*2)\n}");
    lower("b.lsys", {.steps = 3});
    EXPECT_THAT(report(), HasSubstr("b.lsys:4:1: error: 'k' of 'mast' lies between 0 and 1, not at 2"));
    EXPECT_EQ(diagnostics_.error_count(), 1u);
    write("c.lsys", "lsys c { steps 1\ninner = 3\naxiom F\n}");
    lower("c.lsys");
    EXPECT_THAT(report(), HasSubstr("expected a name after 'inner'"));
}

TEST_F(Inner, errorsAndWarningsOfAMemberAreSaidOnce) {
    write("leaf.lsys", "inner k = 0\nlsys leaf { steps 0\naxiom FX(1/k)\n}");
    write("a.lsys",
          "use leaf = \"leaf.lsys\"\nlsys a { steps 0\naxiom ~leaf(1)~leaf(0.5)~leaf(0)~leaf(0.2)\n}");
    lower("a.lsys");
    EXPECT_EQ(diagnostics_.error_count(), 1u) << report();
    EXPECT_THAT(report(), HasSubstr("division by zero"));
    EXPECT_EQ(diagnostics_.all().size(), 2u) << report(); // and that X draws nothing
}

TEST(InnerParameters, membersLeftOutShareTheFamily) {
    SourceMap sources;
    Diagnostics diagnostics;
    const auto sizes = [&](const std::string& text) {
        std::vector<SceneStatement> statements;
        TokenStream stream(lex(sources, sources.add("a.inst", text), diagnostics), diagnostics);
        parse_scene_statement(stream, statements);
        std::vector<std::size_t> members;
        for (const InnerParameter& parameter :
             inner_parameters(statements, {{"a", 0.5}, {"b", 0}, {"c", 1}}, diagnostics))
            members.push_back(parameter.members);
        return members;
    };
    EXPECT_THAT(sizes("inner a = 0.5"), ElementsAre(16));
    EXPECT_THAT(sizes("inner a = 0.5, b = 0"), ElementsAre(16, 16));
    EXPECT_THAT(sizes("inner a = 0.5, b = 0, c = 1"), ElementsAre(6, 6, 6));
    EXPECT_THAT(sizes("inner a = 0.5 members 100, b = 0"), ElementsAre(100, 2));
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
}

TEST(InnerParameters, theDefaultIsAMember) {
    const InnerParameter k{"k", 0.5, 4, {}};
    const std::vector<InnerParameter> family = {k};
    const struct {
        double argument, value;
    } cases[] = {{0, 0}, {0.1, 0}, {0.3, 1.0 / 3}, {0.45, 0.5}, {0.6, 2.0 / 3}, {1 + 1e-12, 1}};
    for (const auto& [argument, value] : cases)
        EXPECT_THAT(nearest_member(family, std::vector{argument}), ElementsAre(value)) << argument;
    EXPECT_THAT(nearest_member(family, {}), ElementsAre(0.5));
}

} // namespace
} // namespace graftal
