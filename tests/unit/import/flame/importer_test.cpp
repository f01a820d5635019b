#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "compiler/import/flame/parametric.h"
#include "tests/unit/import/imported_shapes.h"

namespace graftal::testing {
namespace {

using ::testing::HasSubstr;

std::string flame(const std::string& maps) {
    return "<flames><flame name=\"a b\" size=\"640 480\" center=\"1 2\" scale=\"160\">\n" + maps +
           "</flame></flames>";
}

TEST(Flame, AffineMapsThatShrinkAreALimitSet) {
    const ImportedShapes model(
        "a.flame",
        flame("<xform weight=\"3\" color=\"0\" linear=\"0.5\" coefs=\"1 0 0 1 0 0\"/>\n"
              "<xform weight=\"1\" color=\"1\" linear=\"1\" coefs=\"0 .5 -.5 0 1 2\" post=\"1 0 0 1 3 0\"/>\n"
              "<color index=\"0\" rgb=\"255 0 0\"/><color index=\"255\" rgb=\"0 0 255\"/>"));
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("rifs a_b {\n"));
    EXPECT_THAT(model.translation, HasSubstr("0.5 0 0 0.5  0 0  0.75  tint rgb <1, 0, 0> 0.5\n"));
    EXPECT_THAT(model.translation, HasSubstr("0 -0.5 0.5 0  4 2  0.25  tint rgb <0, 0, 1> 0.5\n"));
    EXPECT_THAT(model.translation, HasSubstr("width: 4 }"));
}

TEST(Flame, TakesAnAttributeThatIsNoNumberForMissing) {
    const std::string coefs = "linear=\"1\" coefs=\".5 0 0 .5 ";
    const auto translation = [&](const std::string& attributes) {
        const ImportedShapes model("a.flame", flame("<xform weight=\"1\" " + attributes + coefs +
                                                    "1 0\"/><xform weight=\"1\" " + coefs + "0 0\"/>"));
        EXPECT_TRUE(model.graph) << attributes << model.said();
        return model.translation;
    };
    const std::string plain = translation("");
    for (const char* const attributes :
         {"color_speed=\"nan\" ", "opacity=\"inf\" ", "symmetry=\"\" ", "color_speed=\"1e400\" "})
        EXPECT_EQ(translation(attributes), plain) << attributes;
    const ImportedShapes weightless("a.flame", flame("<xform weight=\"nan\" " + coefs + "1 0\"/>" +
                                                     "<xform weight=\"2\" " + coefs + "0 0\"/>"));
    EXPECT_THAT(weightless.translation, ::testing::Not(HasSubstr("nan")));
}

TEST(Flame, ChaosIsTheDigraph) {
    const std::string half = "linear=\".5\" coefs=\"1 0 0 1 ";
    const ImportedShapes model("a.flame",
                               flame("<xform weight=\"1\" chaos=\"0 1\" " + half +
                                     "1 0\"/><xform weight=\"1\" chaos=\"1 1\" " + half + "0 0\"/>"));
    ASSERT_TRUE(model.graph) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("follow matrix {   # 'chaos'\n    0 1\n    0.5 0.5\n  }\n"));
    std::size_t instances = 0;
    for (const Object& object : model.graph->objects)
        if (object.name == "w1") instances = object.instances.size();
    EXPECT_EQ(instances, 1u); // w1 follows w2 only
}

/// By map: the share of the random points that it is applied to last.
std::vector<double> shares(const ImportedShapes& model) {
    EXPECT_TRUE(model.graph) << model.said();
    std::vector<double> all;
    if (!model.graph) return all;
    double sum = 0;
    for (const Instance& instance : model.graph->objects[model.graph->root].instances)
        sum += all.emplace_back(instance.chance);
    for (double& share : all)
        share /= sum;
    return all;
}

// flam3 chooses map j behind map i by weight_j * chaos_ij.
TEST(Flame, ChaosMultipliesTheWeightsOnce) {
    const std::string half = "linear=\".5\" coefs=\"1 0 0 1 ";
    const auto xform = [&](const std::string& weight, const std::string& chaos, const std::string& at) {
        return "<xform weight=\"" + weight + "\" chaos=\"" + chaos + "\" " + half + at + " 0\"/>\n";
    };
    // p1 = p2 / 4, p2 = p1 + 3/4 p2
    const std::vector<double> two =
        shares(ImportedShapes("a.flame", flame(xform("1", "0 1", "1") + xform("3", "1 1", "0"))));
    ASSERT_EQ(two.size(), 2u);
    EXPECT_NEAR(two[0], 0.2, 1e-9);
    EXPECT_NEAR(two[1], 0.8, 1e-9);
    // A map without weight is drawn never, and its factors stand for nothing.
    EXPECT_EQ(shares(ImportedShapes("a.flame", flame(xform("1", "0 7 1", "1") + xform("0", "1 1 1", "2") +
                                                     xform("3", "1 7 1", "0")))),
              two);
    const std::vector<double> factors = shares(
        ImportedShapes("a.flame", flame(xform("1", "2 2", "1") + xform("3", "5 5", "0")))); // are but ratios
    ASSERT_EQ(factors.size(), 2u);
    EXPECT_NEAR(factors[0], 0.25, 1e-9);
}

TEST(Flame, AttributesAreNoVariations) {
    const auto imported = [](const std::string& map) {
        return ImportedShapes(
            "a.flame", flame("<xform weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 0 0\" " + map + "/>"));
    };
    const ImportedShapes curve = imported(
        "someCurve_enabled=\"false\" someCurve_view_xmax=\"70.0\" someCurve_interpolation=\"SPLINE\" "
        "mod_hue=\"0.5\" material=\"1\" yzCoefs=\"1 0 0 1 0 0\" label=\"left\" wobble=\"0.0\" "
        "weird=\"true\"");
    EXPECT_TRUE(curve.graph) << curve.said();
    EXPECT_THAT(curve.said(), HasSubstr("a.flame:2:2: warning: the flame is drawn without the attributes "
                                        "'label', 'material', 'mod_hue', 'someCurve_*', 'weird', 'wobble', "
                                        "'yzCoefs'\n"));
    EXPECT_EQ(imported("name=\"left\" chaos=\"1 1\" julian_power=\"3\" swirl=\"0\"").said(), "");
    EXPECT_THAT(imported("flatten=\"1\" zscale=\"0.5\" ztranslate=\"0.3\" zcone=\"0\"").said(),
                HasSubstr("warning: the flame is drawn without the attributes 'zscale', 'ztranslate'\n"))
        << "what leads out of the plane is named";
    EXPECT_THAT(imported("swirl=\"true\"").said(), HasSubstr("error: 'swirl' takes a number, not 'true'"));
    EXPECT_THAT(imported("linear_fx_priority=\"-1\"").said(),
                HasSubstr("'linear_fx_priority' is not translated"));
}

TEST(Flame, OthersAreOrbits) {
    const ImportedShapes model("a.flame",
                               flame("<xform weight=\"1\" swirl=\"1\" linear=\".2\" coefs=\".5 0 0 .5 0 0\"/>"
                                     "<xform weight=\"1\" julia=\"1\" coefs=\"1 0 0 1 0 0\"/>"));
    EXPECT_TRUE(model.orbit) << model.said() << model.translation;
    EXPECT_THAT(model.translation, HasSubstr("probability 0.25")); // two branches of julia
}

TEST(Flame, OrbitsHaveChaosAndAFinalMap) {
    const ImportedShapes model("a.flame",
                               flame("<xform weight=\"1\" chaos=\"0 2\" swirl=\"1\" coefs=\".5 0 0 .5 0 0\"/>"
                                     "<xform weight=\"1\" julia=\"1\" coefs=\"1 0 0 1 0 0\"/>"
                                     "<finalxform julia=\"2\" bubble=\"1\" coefs=\"1 0 0 1 3 0\"/>"));
    EXPECT_TRUE(model.orbit) << model.said() << model.translation;
    EXPECT_THAT(model.translation,
                HasSubstr("    0 2 2\n    1 1 1\n    1 1 1\n  }\n")); // julia has two branches
    EXPECT_THAT(model.translation, HasSubstr("  final {\n    let way = random(0, 2)\n"));
    EXPECT_THAT(model.translation, HasSubstr("(2) * (choose(way < 1, sqrt(r) * "));
}

/// Random numbers of two variations of one map are their own; a blur before all others moves their point.
TEST(Flame, BlursDrawRandomNumbers) {
    const ImportedShapes model(
        "a.flame", flame("<xform weight=\"1\" blur=\"2\" pre_blur=\".5\" pie=\"1\" pie_slices=\"3\" "
                         "linear=\"1\" coefs=\"1 0 0 1 0 0\"/>"));
    EXPECT_TRUE(model.orbit) << model.said() << model.translation;
    EXPECT_THAT(model.translation, HasSubstr("let turn1 = random(0, 360), far1 = random(0, 1)\n"));
    EXPECT_THAT(model.translation,
                HasSubstr("let u = (1) * x + (0) * y + (0) + (0.5) * (far2 * cos(turn2))\n"));
    EXPECT_THAT(model.translation, HasSubstr("let slice3 = random(0, 3), part3 = random(0, 1), far3 = "));
    EXPECT_THAT(model.translation, HasSubstr("let p = (2) * (far1 * cos(turn1)) + (1) * (far3 * cos("));
}

TEST(Flame, WhatHasNoFormulaIsNamed) {
    const auto said = [](const std::string& maps) { return ImportedShapes("a.flame", flame(maps)).said(); };
    EXPECT_THAT(said("<xform weight=\"1\" wobble=\"1\" coefs=\"1 0 0 1 0 0\"/>"),
                HasSubstr("a.flame:2:2: error: the variation 'wobble' is not translated"));
    EXPECT_THAT(said("<xform weight=\"1\" linear=\"1\" coefs=\"1 0 0\"/>"),
                HasSubstr("'coefs' takes six numbers"));
    EXPECT_THAT(said("<xform"), HasSubstr("this is no XML"));
    EXPECT_THAT(said(""), HasSubstr("no maps"));
}

TEST(Flame, WhatIsUnknownIsNamedAlsoBehindAnUnderscore) {
    const auto said = [](const std::string& map) {
        return ImportedShapes("a.flame", flame("<xform weight=\"1\" coefs=\".5 0 0 .5 0 0\" " + map + "/>"))
            .said();
    };
    EXPECT_THAT(said("linear=\"1\" pre_wobble=\"1\""),
                HasSubstr("the variation 'pre_wobble' is not translated"));
    EXPECT_THAT(said("linear=\"1\" julian_power=\"3\" blob_low=\"1\""),
                ::testing::Not(HasSubstr("not translated")));
    EXPECT_THAT(said("linear=\"1\" flatten=\"1\" pre_flatten=\"1\""),
                ::testing::Not(HasSubstr("not translated")));
    EXPECT_THAT(said("wobble=\"1\" Speed_Q=\"4\""), ::testing::Not(HasSubstr("variation 'Speed_Q'")))
        << "a number of 'wobble'";
    EXPECT_THAT(said("julian=\"1\" julian_power=\"2.5\""), HasSubstr("'julian'")) << "roots of unlike chance";
    EXPECT_THAT(said("var1=\"2\""), ::testing::Not(HasSubstr("not translated")));
}

using Point = std::complex<double>;

/// What the formula makes of a point, computed by graftal.
Point value(const flame::Formula& formula, Point at) {
    const auto text = [](double number) { return std::to_string(number); };
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText lowered = lower_text("m.inst",
                                           "let u = " + text(at.real()) + "\nlet v = " + text(at.imag()) +
                                               "\nlet r2 = u*u + v*v\nlet r = sqrt(r2)\nlet theta = pi / 180 "
                                               "* atan2(u, v)\nobject all {\n    sphere translate: " +
                                               formula.x + ", " + formula.y + ", 0\n}\n",
                                           {}, sources, diagnostics);
    EXPECT_TRUE(lowered.graph) << diagnostics.render(sources);
    Point found;
    if (lowered.graph)
        unfold(*lowered.graph, strong_components(*lowered.graph), std::nullopt, 10,
               [&](const UnfoldedLeaf& leaf) {
                   found = {leaf.world_from_object.translation.x, leaf.world_from_object.translation.y};
                   return true;
               });
    return found;
}

std::vector<flame::Formula> formulas(const std::string& variation,
                                     const std::map<std::string, double>& numbers = {}) {
    const Affine pre = Affine::translate({0.3, -0.2, 0});
    const flame::Setting setting{
        .pre = pre, .weight = 0.7, .number = [&](const std::string& name, double otherwise) {
            const auto known = numbers.find(name);
            return known == numbers.end() ? otherwise : known->second;
        }};
    return flame::formulas_of(variation, setting);
}

// Most formulas of flam3 are functions of complex numbers, which the library knows.
TEST(Flame, FormulasOfComplexNumbers) {
    using Function = std::function<Point(Point)>;
    const Point a(0.2, 0.4), b(-0.3, 0.1), c(0.5, -0.6), d(1.1, 0.2), i(0, 1);
    const std::map<std::string, double> mobius = {
        {"mobius_re_a", 0.2}, {"mobius_im_a", 0.4},  {"mobius_re_b", -0.3}, {"mobius_im_b", 0.1},
        {"mobius_re_c", 0.5}, {"mobius_im_c", -0.6}, {"mobius_re_d", 1.1},  {"mobius_im_d", 0.2}};
    const std::map<std::string, std::pair<Function, std::map<std::string, double>>> known = {
        {"exp", {[](Point z) { return std::exp(z); }, {}}},
        {"log", {[](Point z) { return std::log(z); }, {}}},
        {"sin", {[](Point z) { return std::sin(z); }, {}}},
        {"cos", {[](Point z) { return std::cos(z); }, {}}},
        {"tan", {[](Point z) { return std::tan(z); }, {}}},
        {"sec", {[](Point z) { return 1.0 / std::cos(z); }, {}}},
        {"csc", {[](Point z) { return 1.0 / std::sin(z); }, {}}},
        {"cot", {[](Point z) { return 1.0 / std::tan(z); }, {}}},
        {"sinh", {[](Point z) { return std::sinh(z); }, {}}},
        {"cosh", {[](Point z) { return std::cosh(z); }, {}}},
        {"tanh", {[](Point z) { return std::tanh(z); }, {}}},
        {"sech", {[](Point z) { return 1.0 / std::cosh(z); }, {}}},
        {"csch", {[](Point z) { return 1.0 / std::sinh(z); }, {}}},
        {"coth", {[](Point z) { return std::conj(1.0 / std::tanh(z)); }, {}}},
        {"curl",
         {[](Point z) { return z / (1.0 + 0.3 * z + 0.7 * z * z); }, {{"curl_c1", 0.3}, {"curl_c2", 0.7}}}},
        {"escher",
         {[&](Point z) { return std::pow(z, (1.0 + std::exp(0.8 * i)) / 2.0); }, {{"escher_beta", 0.8}}}},
        {"foci",
         {[](Point z) {
              return std::tanh(z / 2.0) * std::norm(std::cosh(z / 2.0)) / std::norm(std::sinh(z / 2.0));
          },
          {}}},
        {"mobius", {[&](Point z) { return (a * z + b) / (c * z + d); }, mobius}},
        {"wedge", {[](Point z) { return z; }, {}}},
        {"stripes", {[](Point z) { return z; }, {}}},
        {"waves2",
         {[](Point z) { return z + Point(2 * std::sin(3 * z.imag()), 0); },
          {{"waves2_scalex", 2}, {"waves2_freqx", 3}}}},
        {"popcorn2",
         {[](Point z) { return z + Point(0, 0.5 * std::sin(std::tan(2 * z.real()))); },
          {{"popcorn2_c", 2}, {"popcorn2_y", 0.5}}}},
    };
    for (const auto& [name, expected] : known)
        for (const Point z : {Point(0.3, 0.8), Point(-0.6, 0.4), Point(-0.2, -1.1), Point(1.3, -0.5)}) {
            const std::vector<flame::Formula> found = formulas(name, expected.second);
            ASSERT_EQ(found.size(), 1u) << name;
            EXPECT_NEAR(std::abs(value(found[0], z) - expected.first(z)), 0, 1e-6) << name << " of " << z;
        }
}

TEST(Flame, FormulasOfJWildfire) {
    struct Case {
        const char* name;
        std::map<std::string, double> numbers;
        std::function<Point(double x, double y)> expected;
    };
    const Case cases[] = {
        {"spherical3D", {}, [](double x, double y) { return Point(x, y) / (x * x + y * y); }},
        {"petal",
         {},
         [](double x, double y) {
             const double a = std::cos(x);
             return a * Point(std::pow(std::cos(x) * std::cos(y), 3), std::pow(std::sin(x) * std::cos(y), 3));
         }},
        {"henon",
         {{"henon_a", 1.4}, {"henon_b", 0.3}},
         [](double x, double y) { return Point(1 - 1.4 * x * x + y, 0.3 * x); }},
        {"lozi", {{"lozi_c", 2}}, [](double x, double y) { return Point(2 - 0.5 * std::abs(x) + y, x); }},
        {"clifford_js",
         {{"clifford_js_a", -1.4}},
         [](double x, double y) {
             return Point(std::sin(-1.4 * y) + std::cos(-1.4 * x),
                          std::sin(1.6 * x) + 0.7 * std::cos(1.6 * y));
         }},
    };
    for (const Case& expected : cases)
        for (const Point z : {Point(0.3, 0.8), Point(-0.6, -0.4)}) {
            const std::vector<flame::Formula> found = formulas(expected.name, expected.numbers);
            ASSERT_EQ(found.size(), 1u) << expected.name;
            EXPECT_NEAR(std::abs(value(found[0], z) - expected.expected(z.real(), z.imag())), 0, 1e-6)
                << expected.name << " of " << z;
        }
}

TEST(Flame, NamesOfOtherPrograms) {
    const auto said = [](const std::string& map) {
        const ImportedShapes model("a.flame",
                                   flame("<xform weight=\"1\" coefs=\"1 0 0 1 0 0\" " + map + "/>"));
        return model.said() + model.translation;
    };
    for (const char* map :
         {"Mobius=\"1\" Re_A=\"7\" Im_D=\"3\"", "Mobius=\"1\" Mobius_Re_A=\"7\" Mobius_Im_D=\"3\"",
          "mobius=\"1\" mobius_re_a=\"7\" mobius_im_d=\"3\""})
        EXPECT_THAT(said(map), HasSubstr("7 * u")) << map;
    for (const char* map :
         {"oscilloscope=\"1\" oscope_damping=\"7\"", "oscilloscope=\"1\" oscilloscope_damping=\"7\""})
        EXPECT_THAT(said(map), HasSubstr("exp(-abs(u) * 7)")) << map;
}

TEST(Flame, TheViewIsThatOfTheFile) {
    const std::string view =
        "size=\"600 400\" center=\"1 2\" scale=\"50\" rotate=\"90\" background=\"1 0 0\" ";
    for (const auto& [zoom, map] : {std::pair("zoom=\"1\"", "linear=\".5\""),
                                    {"zoom=\"1\"", "swirl=\".5\""},
                                    {"cam_zoom=\"2\"", "swirl=\".5\""}}) {
        const ImportedShapes model("a.flame", "<flame name=\"a\" " + view + zoom +
                                                  "><xform weight=\"1\" coefs=\"1 0 0 1 0 0\" " + map +
                                                  "/></flame>");
        EXPECT_TRUE(model.orbit || model.graph) << model.said();
        EXPECT_THAT(model.translation, HasSubstr("background: 1, 0, 0\n"));
        EXPECT_THAT(model.translation,
                    HasSubstr("location: 1,2,-10  look_at: 1,2,0  up: -1,0,0  width: 6 }"));
    }
}

// A point that runs away begins anew, as in flam3, which has no other end for a map that grows.
TEST(Flame, PointsThatRunAwayBeginAnew) {
    const ImportedShapes model("a.flame", flame("<xform weight=\"1\" linear=\"1\" coefs=\"3 0 0 3 0 0\"/>"));
    ASSERT_TRUE(model.orbit) << model.said();
    EXPECT_THAT(model.translation, HasSubstr("start 0.1, 0.2\n  restart 1 "));
}

TEST(Flame, RootsAreTheBranches) {
    const Point z(-0.4, 0.9);
    for (const std::string variation : {"julian", "juliascope"}) {
        const std::vector<flame::Formula> roots = formulas(variation, {{variation + "_power", 3}});
        ASSERT_EQ(roots.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) {
            const Point cube = std::pow(value(roots[k], z), 3);
            // juliascope turns every other one over.
            EXPECT_NEAR(std::abs(cube - (variation == "juliascope" && k == 1 ? std::conj(z) : z)), 0, 1e-6)
                << variation << k;
        }
    }
    EXPECT_EQ(formulas("julian", {{"julian_power", -4}}).size(), 4u);
    EXPECT_TRUE(formulas("julian", {{"julian_power", 1000}}).empty());
    const ImportedShapes many("a.flame",
                              flame("<xform weight=\"1\" julian=\"1\" julian_power=\"40\" julia=\"1\" "
                                    "coefs=\"1 0 0 1 0 0\"/>"));
    EXPECT_THAT(many.said(), HasSubstr("have no whole number of branches from 1 to 64")) << "80 maps for one";
}

// What they are was read from flam3; here that graftal can compute them at all.
TEST(Flame, EveryFormulaHasAValue) {
    for (const std::string name :
         {"rings",     "fan",        "blob",        "pdj",    "fan2",       "rings2",       "perspective",
          "julian",    "juliascope", "wedge_julia", "curl",   "rectangles", "secant2",      "disc2",
          "bent2",     "bipolar",    "butterfly",   "cell",   "curve",      "edisc",        "elliptic",
          "escher",    "foci",       "lazysusan",   "loonie", "modulus",    "oscilloscope", "polar2",
          "popcorn2",  "scry",       "separation",  "split",  "splits",     "stripes",      "wedge",
          "wedge_sph", "whorl",      "waves2",      "auger",  "flux",       "mobius",       "hemisphere"})
        for (const Point z : {Point(0.3, 0.8), Point(-0.6, -0.4)}) {
            const std::vector<flame::Formula> found = formulas(
                name, {{"perspective_dist", 2}, {"mobius_re_d", 1}, {"cell_size", 0.3}, {"modulus_x", 0.1}});
            ASSERT_EQ(found.size(), 1u) << name;
            const Point point = value(found[0], z);
            EXPECT_TRUE(std::isfinite(point.real()) && std::isfinite(point.imag())) << name;
        }
}

} // namespace
} // namespace graftal::testing
