#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "compiler/primitives/polygon_rings.h"
#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

/// The corners of all polygons in the picture.
std::vector<Vec3> corners(const std::string& grammar) {
    const ImportedShapes model("a.cfdg", "startshape A\n" + grammar);
    EXPECT_TRUE(model.graph) << model.said() << model.translation;
    std::vector<Vec3> all;
    for (const UnfoldedLeaf& leaf : model.leaves())
        for (const PlanePoint& corner : rings_of(*leaf.primitive).corners)
            all.push_back(leaf.world_from_object(Vec3(corner[0], corner[1], 0)));
    return all;
}

std::pair<double, double> size_of(const std::string& grammar) {
    Vec3 least(1e300), most(-1e300);
    for (const Vec3 corner : corners(grammar)) {
        least = glm::min(least, corner);
        most = glm::max(most, corner);
    }
    return {most.x - least.x, most.y - least.y};
}

// Found by ten triangles around a point, between which lines shone through.
TEST(ContextFreePaths, SharedEdgesAreTheSameToTheLastDigits) {
    for (const std::string turns :
         {"loop 5 [r 72] T [] loop 5 [r 72] T [r 36]", "loop i = 10 [r 36] T [z i]"}) {
        std::vector<Vec3> all = corners("shape A { " + turns +
                                        " }\npath T { MOVETO(0,0) LINETO(cos(18),sin(18)) "
                                        "LINETO(cos(18),sin(-18)) CLOSEPOLY() FILL()[] }");
        ASSERT_EQ(all.size(), 30u);
        for (const Vec3 corner : all) {
            const double angle_deg = std::atan2(corner.y, corner.x) * 180 / std::numbers::pi;
            const double step = std::round((angle_deg - 18) / 36);
            const double radius = std::hypot(corner.x, corner.y);
            if (radius == 0) continue;
            EXPECT_NEAR(radius, 1, 2e-15);
            EXPECT_NEAR(angle_deg, 18 + 36 * step, 2e-13);
        }
    }
    // Coordinates of any size, and moves of any digits.
    for (const double size : {1.0, 54321.0}) {
        const std::string third = std::to_string(size) + "/3";
        const double expected = std::stod(std::to_string(size)) / 3;
        double most = 0;
        for (const Vec3 corner : corners("path A { MOVETO(0,0) LINETO(" + third + ", 0) LINETO(0, " + third +
                                         ") CLOSEPOLY() FILL[] }"))
            most = std::max(most, corner.x);
        EXPECT_EQ(most, expected);
    }
    EXPECT_DOUBLE_EQ(
        size_of("v = 1, 2\nshape A { SQUARE [x (v[0]/3) s (1/3)] SQUARE [x (v[0]/7) s (1/3)] }").first,
        (1.0 / 3 + 1.0 / 6) - (1.0 / 7 - 1.0 / 6));
}

// Found by CF::IsoWidth, which changed nothing.
TEST(ContextFreePaths, StrokesOfOneWidth) {
    const auto width = [](const std::string& flags, const std::string& moves) {
        return size_of("shape A { P [" + moves + "] }\npath P { MOVETO(0,0) LINETO(0,1) STROKE(0.2, " +
                       flags + ")[] }");
    };
    EXPECT_NEAR(width("CF::ButtCap", "s 4 1").first, 0.8, 1e-12);
    EXPECT_NEAR(width("CF::IsoWidth+CF::ButtCap", "s 4 1").first, 0.4, 1e-12);
    EXPECT_NEAR(width("CF::IsoWidth", "s 3").first, 0.6, 1e-12);
    EXPECT_NEAR(width("CF::IsoWidth+CF::SquareCap", "s 4 1").second, 1.4, 1e-12);
    // The stretch of all shapes on the way counts, and each place has its own.
    const auto nested = [](const std::string& moves) {
        return size_of("shape A { B [" + moves +
                       "] }\nshape B { P [] }\npath P { MOVETO(0,0) LINETO(1,0) "
                       "STROKE(0.2, CF::IsoWidth)[] }");
    };
    EXPECT_NEAR(nested("s 4 9").second, 0.2 * 6, 1e-12);
    EXPECT_NEAR(nested("r 90 s 4 1").first, 0.2 * 2, 1e-12);
    EXPECT_NEAR(
        size_of("shape A { B [s 4 1] B [x 100 s 1] }\nshape B { P [] }\npath P { MOVETO(0,0) LINETO(0,1) "
                "STROKE(0.2, CF::IsoWidth)[] }")
            .first,
        100 + 0.2 + 0.1, 1e-12);
    // Version 2, and the command's own size.
    const auto old = [](const std::string& word, const std::string& size) {
        return size_of("rule A { P { s 4 1 } }\npath P { MOVETO { x 0 y 0 } LINETO { x 0 y 1 } STROKE { p " +
                       word + " width 0.2 " + size + " } }")
            .first;
    };
    EXPECT_NEAR(old("isowidth", ""), 0.4, 1e-12);
    EXPECT_NEAR(old("iso", "s 1 4"), 0.8, 1e-12);
    EXPECT_NEAR(old("buttcap", ""), 0.8, 1e-12);
}

// Found by CF::Align, which changed nothing.
TEST(ContextFreePaths, AlignedOutlinesEndInTheirFirstPoint) {
    const auto least_x = [](const std::string& path) {
        double least = 1e300;
        for (const Vec3 corner : corners("path A { " + path + " FILL[] }"))
            least = std::min(least, corner.x);
        return least;
    };
    const std::string last = "MOVETO(0,0) LINETO(2,0) LINETO(2,2) LINETO(-1,0) ";
    EXPECT_EQ(least_x(last + "CLOSEPOLY()"), -1);
    EXPECT_EQ(least_x(last + "CLOSEPOLY(CF::Align)"), 0);
    EXPECT_EQ(least_x("MOVETO { x 0 y 0 } LINETO { x 2 y 0 } LINETO { x 2 y 2 } LINETO { x -1 y 0 } "
                      "CLOSEPOLY { p align }"),
              0);
    // A curve keeps its control points.
    const std::vector<Vec3> curve = corners("path A { MOVETO(0,0) LINETO(2,0) CURVETO(0.5,0.5, 2,2, 0,2) "
                                            "CLOSEPOLY(CF::Align) FILL[] }");
    const auto point = [&](double t) {
        const double u = 1 - t;
        return Vec3(3 * u * u * t * 2 + u * u * u * 2, 3 * u * u * t * 2 + 3 * u * t * t * 2, 0);
    };
    for (const double t : {0.25, 0.5, 0.75})
        EXPECT_TRUE(std::ranges::any_of(curve, [&](Vec3 corner) {
            return glm::length(corner - point(t)) < 1e-12;
        })) << t;
}

TEST(ContextFreePaths, NoFlagAndNoNumberIsDroppedInSilence) {
    const auto said = [](const std::string& line) {
        return ImportedShapes("a.cfdg", "startshape A\npath A { MOVETO(0,0) LINETO(2,0) LINETO(2,2)\n" +
                                            line + "\nFILL[] STROKE[] }")
            .said();
    };
    const std::map<std::string, std::string> faults = {
        {"STROKE(CF::Thick)[]", "a.cfdg:3:8: error: 'CF::Thick' is no flag of a path"},
        {"STROKE(0.1, 0.2)[]", "a.cfdg:3:1: error: 'STROKE' does not take 2 numbers"},
        {"FILL(3)[]", "'FILL' does not take 1 numbers"},
        {"CLOSEPOLY(2)", "'CLOSEPOLY' does not take 1 numbers"},
        {"LINETO(1, 2, 3)", "'LINETO' does not take 3 numbers"},
        {"ARCTO(1, 2, 3, 4)", "'ARCTO' does not take 4 numbers"},
        {"CURVETO(1, 2, 3, 4, 5, 6, CF::Continuous)", "'CURVETO' does not take 6 numbers"}};
    for (const auto& [line, fault] : faults)
        EXPECT_THAT(said(line), HasSubstr(fault)) << line;
    const std::map<std::string, std::string> notes = {
        {"FILL(CF::RoundCap)[]", "a.cfdg:3:6: note: 'CF::RoundCap' changes nothing in FILL"},
        {"STROKE(CF::Align)[]", "'CF::Align' changes nothing in STROKE"},
        {"CLOSEPOLY(CF::IsoWidth)", "'CF::IsoWidth' changes nothing in CLOSEPOLY"}};
    for (const auto& [line, note] : notes) {
        EXPECT_THAT(said(line), HasSubstr(note)) << line;
        EXPECT_THAT(said(line), ::testing::Not(HasSubstr("error"))) << line;
    }
    const auto old = [](const std::string& line) {
        return ImportedShapes("a.cfdg", "startshape A\nrule A { P {} }\npath P { MOVETO { x 0 y 0 } "
                                        "LINETO { x 2 y 0 } LINETO { x 2 y 2 }\n" +
                                            line + " FILL { } }")
            .said();
    };
    EXPECT_THAT(old("CLOSEPOLY { p loose }"), HasSubstr("a.cfdg:4:13: note: 'p loose' changes nothing here"));
    EXPECT_THAT(old("STROKE { rx 2 }"), HasSubstr("'rx' changes nothing in STROKE"));
    EXPECT_THAT(old("LINETO { x 1 y 3 rx 2 }"), HasSubstr("'rx' changes nothing in LINETO"));
    EXPECT_EQ(old("ARCTO { x 1 y 3 rx 2 p largecw }"), "");
}

} // namespace
} // namespace graftal::testing
