#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Imported bourke(const std::string& text) {
    return Imported("plant.txt", text);
}

/// The ends of the segments of an axiom that nothing rewrites.
std::vector<Vec3> bourke_ends(const std::string& axiom, const std::string& parameters = "angle = 90\n") {
    return bourke("axiom = " + axiom + "\nZ -> Z\n" + parameters).ends();
}

struct Box {
    double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
};

Box box_of(const Imported& model) {
    EXPECT_TRUE(model.graph) << model.said();
    Box box;
    for (const auto& [from, to] : model.segments())
        for (const Vec3 end : {from, to})
            box = {std::min(box.min_x, end.x), std::max(box.max_x, end.x), std::min(box.min_y, end.y),
                   std::max(box.max_y, end.y)};
    return box;
}

void expect_box(const Imported& model, Box box) {
    const Box found = box_of(model);
    EXPECT_NEAR(found.min_x, box.min_x, 1e-9);
    EXPECT_NEAR(found.max_x, box.max_x, 1e-9);
    EXPECT_NEAR(found.min_y, box.min_y, 1e-9);
    EXPECT_NEAR(found.max_y, box.max_y, 1e-9);
}

const std::string island = "axiom = F+F+F+F\nF -> F+F-F-FF+F+F-F\nangle = 90\n";
const std::string weed = "axiom = F\nF -> F[+FF][-FF]F[-F][+F]F\nangle = 35\n";
const std::string bush = "axiom = VZFFF\nV -> [+++W][---W]YV\nW -> +X[-W]Z\nX -> -W[+X]Z\nY -> YZ\n"
                         "Z -> [-FFF][+FFF]F\nangle = 20\n";
const std::string arrowhead = "axiom = YF\nX -> YF+XF+Y\nY -> XF-YF-X\nangle = 60\n";
const std::string leaf = "axiom = a\nF -> >F<\na -> F[+x]Fb\nb -> F[-y]Fa\nx -> a\ny -> b\nangle = 45\n"
                         "length factor = 1.36\n";
const std::string tree = "axiom = FX\nX -> >[-FX]+FX\nangle = 40\nlength growth factor = 0.6\n";
const std::string pentaplexity = "axiom = F++F++F++F++F\nF -> F++F++F|F-F++F\nangle = 36\n";

TEST(Bourke, PublishedCurvesHaveTheirSegmentsAndTheirSize) {
    expect_box(bourke(island + "iterations = 2\n"), {-21, 5, -5, 21});
    EXPECT_EQ(bourke(island + "iterations = 2\n").segment_count(), "256"); // 4 * 8^2
    EXPECT_EQ(
        bourke("Crystal\naxiom = F+F+F+F\nF -> FF+F++F+F\nangle = 90\niterations = 2\n").segment_count(),
        "100");                                                                  // 4 * 5^2
    EXPECT_EQ(bourke(pentaplexity + "iterations = 2\n").segment_count(), "180"); // 5 * 6^2
    const double side = 15 * std::sqrt(0.75);
    expect_box(bourke(arrowhead + "iterations = 4\n"), {-side, 0, 0, 16});
    EXPECT_EQ(bourke(arrowhead + "iterations = 4\n").segment_count(), "81"); // 3^4
}

TEST(Bourke, PublishedPlantsGrowUpwards) {
    EXPECT_EQ(bourke(weed + "iterations = 2\n").segment_count(), "81"); // 9^2
    EXPECT_NEAR(box_of(bourke(weed + "iterations = 2\n")).max_y, 9, 1e-9);
    EXPECT_EQ(bourke(bush + "iterations = 5\n").segment_count(), "206");
    EXPECT_NEAR(box_of(bourke(bush + "iterations = 5\n")).max_y, 10, 1e-9);
}

TEST(Bourke, LengthFactorsScaleTheLines) {
    expect_box(bourke(leaf + "iterations = 3\n"), {-std::sqrt(2), 0, 0, 8.4192});
    EXPECT_EQ(bourke(leaf + "iterations = 3\n").segment_count(), "8");
    const double angle = 40 * std::acos(-1.0) / 180;
    expect_box(bourke(tree + "iterations = 1\n"),
               {-0.6 * std::sin(angle), 0.6 * std::sin(angle), 0, 1 + 0.6 * std::cos(angle)});
    EXPECT_EQ(bourke(tree + "iterations = 3\n").segment_count(), "15");
    EXPECT_NEAR(box_of(bourke(tree + "iterations = 3\n")).max_y, 1.9850922655850862, 1e-9);
    expect_near(bourke_ends(">F<<F", "length = 3\nlength factor = 2\n").back(), {0, 7.5, 0});
}

TEST(Bourke, TheStepsAreAsManyAsDrawFewLines) {
    EXPECT_EQ(bourke(weed).segment_count(), "6561");
    EXPECT_THAT(bourke(weed).translation,
                HasSubstr("  steps 4   # the text has none; with these it draws 6561"));
    EXPECT_EQ(bourke(island).segment_count(), "2048");
    EXPECT_EQ(bourke(bush).segment_count(), "7290");
    EXPECT_EQ(bourke(leaf).segment_count(), "1972");
}

TEST(Bourke, TurnsAreThoseOfTheNotes) {
    expect_near(bourke_ends("+F").back(), {-1, 0, 0}); // to the left
    expect_near(bourke_ends("-F").back(), {1, 0, 0});
    expect_near(bourke_ends("|F").back(), {0, -1, 0});
    expect_near(bourke_ends("fF").back(), {0, 2, 0});
    EXPECT_EQ(bourke_ends("fF").size(), 1u);
    expect_near(bourke_ends("[+F]F").back(), {0, 1, 0});
    expect_near(bourke_ends("&+F").back(), {1, 0, 0});
    expect_near(bourke_ends("&&+F").back(), {-1, 0, 0});
    expect_near(bourke_ends("[&]+F").back(), {-1, 0, 0});
}

TEST(Bourke, TheTurningAngleChangesByItsIncrement) {
    const std::string parameters = "angle = 90\nangle increment = 45\n";
    const double half = std::sqrt(0.5);
    expect_near(bourke_ends("(+F", parameters).back(), {-half, half, 0});
    expect_near(bourke_ends(")+F", parameters).back(), {-half, -half, 0});
    expect_near(bourke_ends("()+F", parameters).back(), {-1, 0, 0});
    expect_near(bourke_ends("[(]+F", parameters).back(), {-1, 0, 0});
    expect_near(bourke_ends("((+F", parameters).back(), {0, 1, 0});
    EXPECT_THAT(bourke("axiom = (((+F\nZ -> Z\n" + parameters).said(),
                HasSubstr("plant.txt:1:11: error: the turning angle is 0 here"));
    EXPECT_THAT(bourke("axiom = F\nF -> F)+F\n" + parameters).said(),
                HasSubstr("plant.txt:2:7: error: '(' and ')' have a translation in the axiom only"));
    // A kolam that is published without an increment.
    const Imported kolam = bourke("axiom = (-D--D)\nA -> F++FFFF--F--FFFF++F++FFFF--F\n"
                                  "B -> F--FFFF++F++FFFF--F--FFFF++F\nC -> BFA--BFA\nD -> CFC--CFC\n"
                                  "angle = 45\niterations = 6\n");
    EXPECT_EQ(kolam.segment_count(), "532");
    EXPECT_THAT(kolam.said(), HasSubstr("plant.txt:1:9: warning: '(' and ')' are left out"));
}

TEST(Bourke, WidthsGrowByTheirIncrement) {
    const Imported lines =
        bourke("axiom = F#F!!F\nZ -> Z\nlength = 1\nline width = 0.2\nline width increment = 0.1\n");
    const std::vector<double> radii = lines.radii();
    ASSERT_EQ(radii.size(), 3u) << lines.said();
    for (const double radius : {0.1, 0.15, 0.05})
        EXPECT_TRUE(std::ranges::any_of(radii, [&](double r) { return std::abs(r - radius) < 1e-9; }))
            << radius;
    const Imported without = bourke("axiom = F#F\nZ -> Z\nline width = 3\n");
    EXPECT_THAT(without.said(), HasSubstr("plant.txt:3:14: warning: the line width is left out"));
    EXPECT_THAT(without.said(), HasSubstr("plant.txt:1:10: warning: '#' and '!'"));
    EXPECT_THAT(without.translation, Not(HasSubstr("width")));
}

TEST(Bourke, ADotHasTheWidthAsItsRadius) {
    const Imported dot = bourke("axiom = @f\nZ -> Z\nlength = 1\nline width = 0.2\n");
    ASSERT_TRUE(dot.graph) << dot.said();
    std::vector<double> radii;
    unfold(*dot.graph, strong_components(*dot.graph), std::nullopt, 100, [&](const UnfoldedLeaf& placed) {
        if (placed.primitive && placed.primitive->kind() == PrimitiveKind::sphere)
            radii.push_back(glm::length(placed.world_from_object.linear[0]));
        return true;
    });
    ASSERT_EQ(radii.size(), 1u);
    EXPECT_NEAR(radii[0], 0.2, 1e-9);
}

TEST(Bourke, APolygonBeginsWhereItOpens) {
    const Imported mango = bourke("axiom = Y---Y\nX -> {F-F}{F-F}--[--X]{F-F}{F-F}--{F-F}{F-F}--\n"
                                  "Y -> f-F+X+F-fY\nangle = 60\niterations = 3\n");
    ASSERT_TRUE(mango.graph) << mango.said();
    EXPECT_THAT(mango.translation, HasSubstr("  X -> {.F-F}{.F-F}--[--X]"));
    const Imported triangle = bourke("axiom = {F-F}\nZ -> Z\nangle = 120\n");
    ASSERT_TRUE(triangle.graph) << triangle.said();
    std::size_t drawn = 0;
    unfold(*triangle.graph, strong_components(*triangle.graph), std::nullopt, 100,
           [&](const UnfoldedLeaf& placed) {
               drawn += placed.primitive ? 1 : 0;
               return true;
           });
    EXPECT_EQ(drawn, 1u);
}

TEST(Bourke, CommandsMayHaveRules) {
    EXPECT_EQ(bourke("axiom = +\n+ -> +F\nangle = 90\niterations = 2\n").segment_count(), "2");
    EXPECT_EQ(bourke("axiom = #\n# -> #F\niterations = 2\n").segment_count(), "2");
    EXPECT_EQ(bourke("axiom = >\n> -> >F\nlength factor = 2\niterations = 2\n").segment_count(), "2");
}

TEST(Bourke, LinesAreWrittenInManyWays) {
    for (const char* const text :
         {"axiom = F\nF -> F+F\nangle = 90\niterations = 3\n", "axiom F\nF->F+F\nangle 90\niterations 3\n",
          "Axiom: F\nRules:\nF \u2192 F + F\nAngle: 90 degrees\nIterations: 3\n",
          "Figure 3 (b)\n  AXIOM=F\n  F  ->  F+F\n  Turning  Angle = 90\u00b0\n\nwritten by hand\nDepth = "
          "3\n",
          "angle 90\niterations 3\naxiom F\nF -> F+F\nVersion 2.5, July 1991\n"}) {
        const Imported model = bourke(text);
        EXPECT_EQ(model.segment_count(), "8") << text << model.said();
        EXPECT_EQ(model.diagnostics.render(model.sources), "") << text;
    }
    const std::string titled = bourke("Crystal\naxiom = F\nafter Koch\nF -> F+F\nangle = 90\n").translation;
    EXPECT_EQ(titled.substr(0, titled.find("lsys")), "# Crystal\n");
    EXPECT_THAT(titled, HasSubstr("  # after Koch\n  F -> F+F\n"));
}

TEST(Bourke, EachAxiomBeginsAModel) {
    const std::string text =
        "One\naxiom = F\nF -> FF\niterations = 1\n\nTwo\nand more\naxiom = FFF\nF -> FF\n"
        "iterations = 1\n";
    EXPECT_EQ(Imported("plant.txt:plant_1", text).segment_count(), "2");
    const Imported second("plant.txt:plant_2", text);
    EXPECT_EQ(second.segment_count(), "6");
    EXPECT_THAT(second.translation, HasSubstr("# Two\n# and more\nlsys"));
    EXPECT_THAT(bourke(text).said(), HasSubstr("'plant.txt' holds 2 models"));
}

TEST(Bourke, IsToldFromOtherLSystems) {
    for (const char* const name : {"a.ls", "a.l", "a.lsystem", "a.txt"})
        EXPECT_EQ(Imported(name, "axiom F\nangle 90\niterations 1\nF -> F+F\n").segment_count(), "2") << name;
    EXPECT_EQ(Imported("a.ls", "axiom F\nangle 90\nrecursion 1\nrule F = F->F\n").segment_count(), "2");
    EXPECT_THAT(Imported("a.txt", "lsys a {\n axiom F\n F -> F+F\n}\n").said(), HasSubstr("write 'Angle 6'"))
        << "Fractint's";
    EXPECT_THAT(Imported("a.txt", "Crystal\naxiom = F\nangle = 90\n").said(), HasSubstr("is no"));
}

TEST(Bourke, SaysWhatIsWrong) {
    const auto said = [](const std::string& lines) { return bourke("axiom = F\n" + lines).said(); };
    EXPECT_THAT(said("F -> F+F\n"), HasSubstr("plant.txt:2:7: error: the model has no angle"));
    EXPECT_THAT(said("F -> F>F\n"), HasSubstr("plant.txt:2:7: error: the model has no length factor"));
    EXPECT_THAT(said("F -> FF\nangle = wide\n"),
                HasSubstr("plant.txt:3:9: error: expected a number, found 'wide'"));
    EXPECT_THAT(said("F -> FF\nangle = 1/2\n"), HasSubstr("expected a number, found '1/2'"));
    EXPECT_THAT(said("F -> FF\nlength factor = 0\n"), HasSubstr("a length factor must be above 0"));
    EXPECT_THAT(said("F -> FF\nangle = 9\nAngle = 8\n"), HasSubstr("plant.txt:4:1: error: a second 'Angle'"));
    EXPECT_THAT(said("F -> FF\nF -> F\n"), HasSubstr("plant.txt:3:1: error: a second rule for 'F'"));
    EXPECT_THAT(said("F -> FF\n[ -> F\n"), HasSubstr("plant.txt:3:1: error: a rule for '[' has no"));
    EXPECT_THAT(said("F -> FF\nG = F\n"), HasSubstr("plant.txt:3:1: error: 'G' is no parameter"));
    EXPECT_THAT(said("F -> [F\n"), HasSubstr("plant.txt:2:1: note: translated from here"));
    EXPECT_THAT(bourke("axiom =\nF -> FF\n").said(), HasSubstr("plant.txt:1:1: error: the axiom is empty"));
    EXPECT_EQ(said("F -> FF\n"), "");
}

} // namespace
} // namespace graftal::testing
