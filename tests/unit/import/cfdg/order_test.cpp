#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

/// The red part of each shape's colour, in tenths, from the lowest to the highest. Of squares and triangles:
/// circles are thick.
std::string painted(const std::string& grammar, std::optional<unsigned> steps = {}) {
    const ImportedShapes model("a.cfdg", "startshape A\n" + grammar);
    EXPECT_TRUE(model.graph) << model.said() << model.translation.substr(0, 2000);
    std::vector<std::pair<double, char>> shapes;
    for (const UnfoldedLeaf& leaf : model.leaves(steps)) {
        const double red = std::pow(leaf.tint.over(Rgb(0.5)).r, 1 / 2.3); // as on a screen, nearly
        shapes.emplace_back(leaf.world_from_object.translation.z,
                            static_cast<char>('0' + std::lround(10 * red)));
    }
    std::ranges::sort(shapes);
    std::string order;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        order += shapes[i].second;
        if (i == 0) continue;
        EXPECT_LT(shapes[i - 1].first, shapes[i].first) << "which of two lies in front, in " << grammar;
    }
    return order;
}

std::string repeated(std::size_t count, const std::string& text) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i)
        all += text;
    return all;
}

// Found by a loop of 1100 turns: its last squares covered the smaller circle.
TEST(ContextFreeOrder, SmallerShapesLieInFrontHoweverLongALoopIs) {
    for (const char* const turns : {"3", "1100", "5000"}) {
        const std::size_t count = std::stoul(turns);
        const std::string loop = std::string("loop ") + turns + " [x 0.0001] ";
        EXPECT_EQ(painted("shape A { B [s 0.5] " + loop + "C [] }\nshape B { TRIANGLE [b 1] }\n" +
                          "shape C { SQUARE [] }"),
                  repeated(count, "0") + ":");
        EXPECT_EQ(painted("shape A { B [s 0.999] " + loop + "{ SQUARE [] SQUARE [b 0.5] } }\n" +
                          "shape B { TRIANGLE [b 1] }"),
                  repeated(count, "05") + ":");
    }
}

// Found by a stranger's tiles of half a veil each: 25 copies shared the distance of one.
TEST(ContextFreeOrder, CopiesOfVeilsLieAsFarApartAsEnginesTell) {
    const ImportedShapes model("a.cfdg", "startshape A\nCF::Tile = [s 4]\nCF::Size = [s 4]\n"
                                         "shape A { SQUARE [a -0.5 s 1 16 r -17] }");
    ASSERT_TRUE(model.graph) << model.said();
    std::vector<double> heights;
    for (const UnfoldedLeaf& leaf : model.leaves({}))
        heights.push_back(leaf.world_from_object.translation.z);
    ASSERT_GT(heights.size(), 4u);
    std::ranges::sort(heights);
    for (std::size_t i = 1; i < heights.size(); ++i)
        EXPECT_GE(heights[i] - heights[i - 1], 0.99e-5 * 4);
}

TEST(ContextFreeOrder, TurnsOfLoopsLieOverEachOther) {
    const std::string inner = "shape B { loop 3 [y 1] { SQUARE [] TRIANGLE [b 0.5] } }";
    // A shape's content over that of the same shape before it.
    EXPECT_EQ(painted("shape A { loop 2 [x 0.1] { B [] } B [b 0.5] }\n" + inner), "050505"
                                                                                  "050505"
                                                                                  "585858");
    EXPECT_EQ(painted("shape A { loop 2 [x 0.1] loop 2 [y 0.1] { SQUARE [] SQUARE [b 1] } }"), "0:0:0:0:");
    // Turns that become smaller.
    EXPECT_EQ(painted("shape A { SQUARE [b 1] loop 3 [s 0.5] { SQUARE [] SQUARE [b 0.5] } }"), ":050505");
    EXPECT_EQ(painted("shape A { loop 3 [s 0.5] { B [] } SQUARE [b 1] }\nshape B { SQUARE [] }"), ":000");
    // The number of turns is a parameter, or each turn is another.
    EXPECT_EQ(
        painted(
            "shape A { B(3) [] SQUARE [b 1] }\nshape B(n) { loop n [x 1] { SQUARE [] TRIANGLE [b 0.5] } }"),
        ":050505");
    EXPECT_EQ(painted("shape A { loop i = 3 [x 1] { SQUARE [x i] SQUARE [b 0.5] } SQUARE [b 1] }"),
              "050505:");
}

// A rule's own primitives are painted before the shapes that it calls, and those in the order of their calls.
TEST(ContextFreeOrder, PrimitivesOfARuleLieBelowWhatItCalls) {
    EXPECT_EQ(painted("shape A { B [] SQUARE [] }\nshape B { SQUARE [b 1] }"), "0:");
    // Those of a generation before those of the next one.
    EXPECT_EQ(painted("shape A { B [] C [] }\nshape B { D [] }\n"
                      "shape D { SQUARE [b 1] }\nshape C { SQUARE [] }"),
              "0:");
}

TEST(ContextFreeOrder, LongRecursionKeepsItsOrder) {
    const std::string order = painted("CF::Size = [s 4]\nshape A { C(0) [] }\nshape B { TRIANGLE [b 1] }\n"
                                      "shape C(n) { SQUARE [] C(n + 1) [x 0.01 s 0.999] B [s 0.5] }");
    // Triangles of half the size of the shape that draws them come where recursion is as small.
    const std::size_t first = order.find(':');
    EXPECT_EQ(first, static_cast<std::size_t>(std::ceil(std::log(0.5) / std::log(0.999))));
    EXPECT_GT(order.size(), 1000u);
    // Recursion without end keeps the same order.
    const std::string endless =
        painted("shape A { SQUARE [] A [x 0.01 s 0.9] B [s 0.5] }\nshape B { TRIANGLE [b 1] }", 100);
    EXPECT_EQ(endless.find(':'), static_cast<std::size_t>(std::ceil(std::log(0.5) / std::log(0.9))));
    EXPECT_GT(endless.size(), 190u);
}

// Found by discs that vanished in squares of the same rule: a million shapes of one size left a distance of
// 1e-16 between the lines of a rule, which no ray can tell.
TEST(ContextFreeOrder, LinesOfARuleLieApartHoweverManyShapesThereAre) {
    for (const char* const shrinks : {"0.7", "0.75"}) {
        const std::string call = std::string(" r 45 s ") + shrinks + " b 0.2] ";
        const ImportedShapes model("a.cfdg",
                                   "startshape A\nshape A { SQUARE [s 0.3] TRIANGLE [s 0.2 b 1] A [x 1" +
                                       call + "A [x -1" + call + "}");
        ASSERT_TRUE(model.graph) << model.said();
        const auto leaves = model.leaves({});
        ASSERT_GT(leaves.size(), 1000u);
        for (std::size_t i = 0; i + 1 < leaves.size(); i += 2)
            EXPECT_GT(std::abs(leaves[i + 1].world_from_object.translation.z -
                               leaves[i].world_from_object.translation.z),
                      1e-13)
                << shrinks;
    }
}

// Found by 'CIRCLE [a 0]', which made a grammar cost as much as one of veils.
TEST(ContextFreeOrder, NoLessAlphaIsOpaque) {
    const auto drawn = [](const std::string& adjustment) {
        return ImportedShapes("a.cfdg", "startshape A\nshape A { CIRCLE [" + adjustment + "] }").translation;
    };
    for (const char* const opaque : {"a 0", "a 0.5", "alpha 1", "b 0.5"})
        EXPECT_THAT(drawn(opaque), HasSubstr("cylinder")) << opaque;
    for (const char* const veil : {"a -0.5", "a (0 - 0.5)", "|a 0.5 a 0.5|"})
        EXPECT_THAT(drawn(veil), HasSubstr("polygon")) << veil;
}

// Found by 'z 1' in a shape of half the size, which lay below a 'z 0.7' beside it.
TEST(ContextFreeOrder, DepthComesFirstAndHasASizeOfItsOwn) {
    const auto front = [](const std::string& rest) { return painted("shape A { " + rest).back(); };
    const std::string deep = "\nshape B { SQUARE [z 1 b 1] }";
    EXPECT_EQ(front("B [s 0.5] TRIANGLE [s 2 z 0.7] }" + deep), ':');
    EXPECT_EQ(front("B [s 0.5] TRIANGLE [s 2 z 1.1] }" + deep), '0');
    EXPECT_EQ(front("B [s 0.5 0.5 3] TRIANGLE [z 2.9] }" + deep), ':');
    EXPECT_EQ(front("B [s 0.5 0.5 3] TRIANGLE [z 3.1] }" + deep), '0');
    EXPECT_EQ(front("B [s 2 2 0.1 z 0.5] TRIANGLE [z 0.59] }" + deep), ':');
    EXPECT_EQ(front("B [x 0 0 -0.5 s 0.1] TRIANGLE [z 0.6] }" + deep), '0');
    // However many shapes lie between, and however small the steps are.
    EXPECT_EQ(front("SQUARE [z 0.001 b 1] loop 3000 [] B [s 0.5] }\nshape B { SQUARE [] }"), ':');
    EXPECT_EQ(front("SQUARE [z -0.001] loop 3000 [z -0.001] SQUARE [z -0.002] SQUARE [b 1] }"), ':');
}

TEST(ContextFreeOrder, ManyVeilsKeepTheirOrder) {
    EXPECT_EQ(painted("shape A { loop 500 [] SQUARE [a -0.5] B [s 0.99] }\nshape B { SQUARE [b 1] }"),
              repeated(500, "0") + ":");
}

// Found by a lawn that took 75 s, of a chain of 2000 objects.
TEST(ContextFreeOrder, LongRecursionMakesNoLongChains) {
    const ImportedShapes model("a.cfdg", R"(startshape field
tile { s 150 }
rule field { grass { hue 97 sat 0.72 b 0.76 } }
rule grass 5 { seedling {} grass {} }
rule grass { grass { b 0.2 } }
rule grass { grass { b -0.1 } }
rule grass 10 { grass { r 5 } }
rule grass 10 { grass { r -5 } }
rule grass { grass { x 10 } }
rule grass 0.01 { }
rule seedling { SQUARE {} seedling { y 1 r -2 s 0.991 } }
rule seedling { SQUARE {} seedling { y 1 r 2 s 0.991 } }
)");
    ASSERT_TRUE(model.graph) << model.said();
    std::size_t objects = 0;
    for (std::size_t at = 0; (at = model.translation.find("canonical object", at)) != std::string::npos; ++at)
        ++objects;
    EXPECT_LE(objects, 70u); // 64 blades, the field, a square
    // The levels of objects within objects.
    const Graph& graph = *model.graph;
    std::vector<std::size_t> levels(graph.objects.size());
    const auto level = [&](const auto& self, ObjectId object) -> std::size_t {
        std::size_t& known = levels[object];
        if (known > 0) return known;
        std::size_t most = 0;
        for (const Instance& instance : graph.objects[object].instances)
            most = std::max(most, self(self, instance.master));
        return known = most + 1;
    };
    EXPECT_LE(level(level, graph.root), 6u);
    EXPECT_THAT(model.said(), ::testing::Not(HasSubstr("too many different inks")));
}

} // namespace
} // namespace graftal::testing
