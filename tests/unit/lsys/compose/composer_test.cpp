#include "compiler/lsys/compose/composer.h"

#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using testing::CompiledLsys;
using testing::Figure;
using testing::plain_figure;
using testing::Stroke;
using testing::Unfolding;

constexpr double start_width = 0.25;

std::string lsys_block(const std::string& statements) {
    return "width 0.25\n" + statements;
}

struct GrowingModel {
    const char* name;
    std::string text;
    unsigned most_steps;
};

std::vector<GrowingModel> growing_models() {
    return {
        {"koch", lsys_block("angle 60\naxiom F--F--F\nF -> F+F--F+F"), 5},
        {"islands", lsys_block("axiom F+F+F+F\nF -> F+f-FF+F+FF+Ff+FF-f+FF-F-FF-Ff-FFF\nf -> ffffff"), 2},
        {"dragon", lsys_block("modules l r\naxiom Fl\nl -> l+rF+\nr -> -Fl-r"), 10},
        {"gosper",
         lsys_block("modules F_l F_r\nangle 60\naxiom F_l\nF_l -> F_l+F_r++F_r-F_l--F_lF_l-F_r+\n"
                    "F_r -> -F_l+F_rF_r++F_r+F_l--F_l-F_r\ninterpret {\nF_l -> F\nF_r -> F\n}"),
         4},
        {"hilbert",
         lsys_block("axiom A\nA -> B-F+CFC+F-D&F^D-F+&&CFC+F+B//\nB -> A&F^CFB^F^D^^-F-D^|F^B|FC^F^A//\n"
                    "C -> |D^|F^B-F+C^F^A&&FA&F^C+F+B^F^D//\nD -> |CFB-F+B|FA&F^A&&FB-F+B|FC//"),
         3},
        {"plant", lsys_block("angle 22.5\naxiom X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF"), 5},
        {"bush",
         lsys_block("angle 22.5\naxiom A\nA -> [&FL!A]/////'[&FL!A]///////'[&FL!A]\nF -> S/////F\nS -> FL\n"
                    "L -> ['''^^{-f+f+f-|-f+f+f}]"),
         5},
        {"sympodial",
         lsys_block("axiom A(1,0.1)\nA(l,w) -> !(w)F(l)[&(10)B(l*0.9,w*0.7)]/(180)[&(60)B(l*0.7,w*0.7)]\n"
                    "B(l,w) -> !(w)F(l)[+(10)$B(l*0.9,w*0.7)][-(60)$B(l*0.7,w*0.7)]"),
         8},
        {"tropism",
         lsys_block("tropism 0.3, -1, 0.2\naxiom T(0.22)!(1)F(2)/(45)A\n"
                    "A -> !(1.732)F(0.5)[&(19)F(0.5)A]/(95)[&(19)F(0.5)A]/(133)[&(19)F(0.5)A]\n"
                    "F(l) -> F(l*1.109)\n!(w) -> !(w*1.732)"),
         5},
        {"stems", lsys_block("angle 30\naxiom A\nA -> T(0.3)F$[+A]F[-;(3)!A]T,A"), 5},
        {"counting",
         lsys_block("axiom A(3,1)\nA(t,l) : t > 0 -> F(l)[+(30)A(t-1,l/2)]A(t-1,l)\n"
                    "A(t,l) : t <= 0 -> F(l)-(l*10)A(2,l*0.7)"),
         7},
        {"cordate", lsys_block("angle 18\naxiom F[A][B]\nA -> [+A{.].C.}\nB -> [-B{.].C.}\nC -> gC"), 7},
        {"polygons over productions",
         lsys_block("angle 40\naxiom F{A}\nA -> .G[+B{.]f+A\nB -> f.+f.-B}[&{C]\nC -> f-.fC."), 5},
        {"decomposed", lsys_block("axiom A\nA -> I(5)[+A]A\ndecompose I(n) : n > 0 -> F(n)+(n)I(n-1)"), 5},
        {"cut", lsys_block("axiom A\nA -> F[+A]F[-A]B\nB -> FF%FA"), 5},
        {"branch that is cut", lsys_block("axiom A\nA -> F[+AB]-A\nB -> %"), 6},
        {"twigs finer than branches",
         lsys_block("taper 0.8\nangle 25\naxiom X\nX -> F[+X[-F]]F[-!X]X\nF -> FF"), 5},
        {"finer only so many times", lsys_block("taper 0.8\nangle 25\naxiom X\nX -> [+X]F"), 16},
        {"nothing alike",
         lsys_block("axiom A(1)\nA(x) -> F(x)[+(x)A(x*0.93+0.11)]\\(x*7)^(3)F(x/3)A(x*0.81+0.2)"), 8},
    };
}

void expect_same(const Figure& wanted, const Graph& graph, const std::string& what, double tolerance = 1e-9) {
    const Unfolding found(graph);
    ASSERT_EQ(found.strokes.size(), wanted.strokes.size()) << what;
    EXPECT_EQ(found.balls, wanted.strokes.size()) << what;
    double size = 1;
    for (const Stroke& stroke : wanted.strokes)
        size = std::max(size, glm::length(stroke.to));
    double worst = 0, worst_width = 0;
    std::map<int, int> material_of_colour;
    for (std::size_t i = 0; i < wanted.strokes.size(); ++i) {
        const Stroke& a = wanted.strokes[i];
        const Stroke& b = found.strokes[i];
        worst = std::max({worst, glm::distance(a.from, b.from), glm::distance(a.to, b.to)});
        worst_width = std::max(worst_width, std::abs(a.width - b.width) / a.width);
        const int colour = (a.colour % 8 + 8) % 8;
        EXPECT_EQ(material_of_colour.try_emplace(colour, b.colour).first->second, b.colour) << what;
    }
    EXPECT_LE(worst, tolerance * size) << what;
    EXPECT_LE(worst_width, 1e-9) << what;
}

/// The vector area, which every way to cut the polygon into triangles has, flat or not.
Vec3 area(const std::vector<Vec3>& corners) {
    Vec3 normal(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    return 0.5 * normal;
}

void expect_same_area(const Figure& wanted, const Graph& graph, const std::string& what) {
    Vec3 in_polygons(0.0), in_triangles(0.0);
    double size = 1;
    for (const auto& polygon : wanted.polygons) {
        in_polygons += area(polygon);
        size += glm::length(area(polygon));
    }
    for (const auto& [a, b, c] : Unfolding(graph).triangles)
        in_triangles += area({a, b, c});
    EXPECT_LE(glm::distance(in_triangles, in_polygons), 1e-9 * size) << what;
}

/// Of all segments, the greatest over the least.
double range_of_widths(const std::string& statements, unsigned steps) {
    const CompiledLsys compiled(statements, steps);
    const std::vector<Stroke> strokes = Unfolding(compiled.graph).strokes;
    const auto [least, most] = std::ranges::minmax_element(strokes, {}, &Stroke::width);
    return most->width / least->width;
}

TEST(LsysComposer, drawsPlantsInLinesWhoseTwigsAreFine) {
    const std::string plant = "angle 25\naxiom X\nX -> F[+X][-X]FX\nF -> FF";
    EXPECT_NEAR(range_of_widths(plant, 3), std::pow(0.85, -2), 1e-9); // the last X draw nothing
    EXPECT_NEAR(range_of_widths("taper 0.5\n" + plant, 3), 4, 1e-9);
    EXPECT_NEAR(range_of_widths("taper 1\n" + plant, 3), 1, 1e-9);
    EXPECT_NEAR(range_of_widths("width 0.1\n" + plant, 3), 1, 1e-9);
    EXPECT_NEAR(range_of_widths("angle 36\naxiom [X]+[X]\nX -> F[+X]F", 3), 1, 1e-9);    // a tiling
    EXPECT_NEAR(range_of_widths("axiom X(1)\nX(s) -> F(s)[+X(s/2)]F(s/3)", 3), 1, 1e-9); // of lengths
    EXPECT_NEAR(range_of_widths("axiom X\nX -> F[+{.f.+f.}X]F", 3), 1, 1e-9);            // of leaves
}

TEST(LsysComposer, drawsWhatThePlainTurtleDraws) {
    for (const GrowingModel& model : growing_models())
        for (unsigned steps = 0; steps <= model.most_steps; ++steps) {
            const std::string what = fmt::format("{} after {} steps", model.name, steps);
            const Figure wanted = plain_figure(model.text, steps, start_width);
            if (wanted.strokes.empty() && wanted.polygons.empty()) continue;
            for (const bool exact : {false, true}) {
                LowerOptions options;
                options.exact = exact;
                const CompiledLsys compiled(model.text, steps, options);
                expect_same(wanted, compiled.graph, what);
                expect_same_area(wanted, compiled.graph, what);
                EXPECT_EQ(compiled.derivation->modules, std::to_string(wanted.modules)) << what;
                EXPECT_EQ(compiled.derivation->error, 0) << what;
            }
        }
}

/// A grammar with some symbols, parameters, turns in space, branches, widths, colours, levels and tropism.
std::string random_statements(std::mt19937& random) {
    const auto number = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    const auto pick = [&](std::initializer_list<const char*> choices) {
        return std::string(choices.begin()[random() % choices.size()]);
    };
    // Turned about from the direction that it bends to, a turtle stands on a knife's edge: then rounding
    // decides.
    const bool bends = random() % 3 == 0;
    const auto string = [&](bool parameters) {
        std::string out;
        std::size_t open = 0;
        for (int i = 0; i < 12; ++i) {
            switch (random() % 8) {
            case 0:
                out += fmt::format("F({})", number(0.2, 1));
                break;
            case 1:
                out += "[", ++open;
                break;
            case 2:
                if (open > 0) out += "]", --open;
                break;
            case 3:
                out += pick({"+", "-", "&", "^", "/", "\\", bends ? "^" : "|"});
                break;
            case 4:
                out += pick({"+(17)", "&(31)", "/(137.5)", "$", "!", ";", ",", "!(0.3)", ";(2)", "f"});
                break;
            case 5:
                out += parameters ? fmt::format("A(x*{:.2f},y+1)", number(0.5, 0.9)) : "A(1,0)";
                break;
            case 6:
                out += parameters ? fmt::format("B(y,x*{:.2f})", number(0.5, 0.9)) : "B(0,1)";
                break;
            default:
                out += parameters ? "F(x)" : "F";
                break;
            }
        }
        return out + std::string(open, ']');
    };
    return fmt::format(
        "width 0.25\ntaper {}\nangle {}\ntropism {},-1,0\naxiom {}F{}\nA(x,y) : y < 3 -> {}\nA(x,y) -> "
        "{}\nB(x,y) -> {}\n"
        "F(x) : x > 0.9 -> F(x/2)F(x/3)",
        pick({"1", "0.7"}), pick({"90", "60", "25.7", "22.5"}), number(-1, 1), bends ? "T(0.1)" : "",
        string(false), string(true), string(true), string(true));
}

TEST(LsysComposer, drawsRandomModels) {
    std::mt19937 random(20261121);
    std::size_t strokes = 0;
    for (int i = 0; i < 400; ++i) {
        const std::string text = random_statements(random);
        for (unsigned steps = 0; steps <= 4; ++steps) {
            const Figure wanted = plain_figure(text, steps, start_width);
            if (wanted.modules > 100'000) break;
            const CompiledLsys compiled(text, steps);
            expect_same(wanted, compiled.graph, fmt::format("{}\nafter {} steps", text, steps));
            EXPECT_EQ(compiled.derivation->modules, std::to_string(wanted.modules)) << text;
            if (HasFailure()) return;
            strokes += wanted.strokes.size();
        }
    }
    EXPECT_GT(strokes, 100'000u);
}

std::size_t object_count(const std::string& text, unsigned steps) {
    return CompiledLsys(text, steps).graph.objects.size();
}

TEST(LsysComposer, sharesWhatIsAlikeUpToItsSize) {
    const std::string sympodial =
        "axiom A(1,10)\nA(l,w) -> !(w)F(l)[&(5)B(l*0.9,w*0.707)]/(180)[&(65)B(l*0.7,w*0.707)]\n"
        "B(l,w) -> !(w)F(l)[+(5)$B(l*0.9,w*0.707)][-(65)$B(l*0.7,w*0.707)]";
    EXPECT_LE(object_count(sympodial, 20), 250u);
    // All widths in proportion, as in a skeleton.
    const std::string skeleton = "axiom A(1)\nA(l) -> !(l)F(l)[&(5)B(l*0.9)]/(180)[&(65)B(l*0.7)]\n"
                                 "B(l) -> !(l)F(l)[+(5)$B(l*0.9)][-(65)$B(l*0.7)]";
    EXPECT_LE(object_count(skeleton, 10), 70u);
    EXPECT_EQ(CompiledLsys(skeleton, 11).derivation->segments, "2047");
    EXPECT_LE(object_count("width 1\naxiom F\nF -> F+F--F+F", 6), 10u);
}

/// Kind and place of all bodies, in order.
void list_bodies(const Graph& graph, ObjectId id, const Affine& place,
                 std::vector<std::pair<Primitive, Affine>>& out) {
    const Object& object = graph.objects[id];
    if (object.primitive) out.emplace_back(*object.primitive, place);
    for (const Instance& instance : object.instances)
        list_bodies(graph, instance.master, place * instance.parent_from_child, out);
}

TEST(LsysComposer, generalisedCylindersTaper) {
    const CompiledLsys whole("axiom !(1)@GsF!(0.5)@Gc+(90)F(2)!(0.75)@Ge-(90)F", 0);
    std::vector<std::pair<Primitive, Affine>> bodies;
    list_bodies(whole.graph, whole.graph.root, {}, bodies);
    ASSERT_EQ(bodies.size(), 6u); // two frusta, a cylinder, a ball each
    EXPECT_EQ(bodies[0].first, tapered(0.5));
    EXPECT_LE(glm::distance(bodies[0].second({0, 1, 0}), Vec3(0, 1, 0)), 1e-12);
    EXPECT_NEAR(glm::length(bodies[0].second.linear[0]), 0.5, 1e-12);
    // It gets wider: the base is at the far end.
    EXPECT_EQ(bodies[2].first, tapered(0.5 / 0.75));
    EXPECT_LE(glm::distance(bodies[2].second({0, 0, 0}), Vec3(-2, 1, 0)), 1e-12);
    EXPECT_LE(glm::distance(bodies[2].second({0, 1, 0}), Vec3(0, 1, 0)), 1e-12);
    EXPECT_EQ(bodies[4].first, PrimitiveKind::cylinder);

    // Over productions and branches: the same as in one string.
    const CompiledLsys parts(
        "modules A B\naxiom !(1)@GsA(1)\nA(w) -> F!(w/2)B(w/2)[+(30)F@Ge]A(w/2)\nB(w) -> &(10)F@Gc", 3);
    const CompiledLsys word(
        "modules A\naxiom !(1)@GsF!(0.5)&(10)F@Gc[+(30)F@Ge]F!(0.25)&(10)F@Gc[+(30)F@Ge]F!(0.125)"
        "B(0.125)[+(30)F@Ge]A(0.125)\nmodules B",
        0);
    std::vector<std::pair<Primitive, Affine>> a, b;
    list_bodies(parts.graph, parts.graph.root, {}, a);
    list_bodies(word.graph, word.graph.root, {}, b);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].first, b[i].first) << i;
        for (const Vec3& point : {Vec3(0.0), Vec3(1, 0, 0), Vec3(0, 1, 0)})
            EXPECT_LE(glm::distance(a[i].second(point), b[i].second(point)), 1e-10) << i;
    }
}

TEST(LsysComposer, countsAreExactAtAnyDepth) {
    const CompiledLsys koch("angle 60\naxiom F\nF -> F+F--F+F", 200);
    EXPECT_EQ(BigCount(koch.derivation->segments), boost::multiprecision::pow(BigCount(4), 200));
    const CompiledLsys dragon("modules l r\naxiom l\nl -> l+r+\nr -> -l-r\ninterpret {\nl -> F\nr -> F\n}",
                              200);
    EXPECT_EQ(BigCount(dragon.derivation->segments), BigCount(1) << 200);
    EXPECT_EQ(BigCount(dragon.derivation->modules), 3 * (BigCount(1) << 200) - 2);
}

/// A composer with all that it needs.
struct Composing {
    Composing(const std::string& statements, const LsysLimits& limits)
        : model(statements), bodies(graph, {Material()}), context{bodies, model.diagnostics()}, pool(graph),
          composer(model.rewriter(), context, pool, no_models, Variants(0, 1), limits) {}

    testing::LsysModel model;
    Graph graph;
    TurtleBodies bodies;
    TurtleContext context;
    ObjectPool pool;
    ModelPlacer no_models;
    LsysComposer composer;
};

TEST(LsysComposer, PartsThatTakeTooMuchRoomAreAnError) {
    // A million of them took 3 GB.
    Composing composing("axiom A(1, 1)\nA(l, k) -> F(l)[+(k)A(l*0.9, 2*k)][-A(l*0.8, 2*k + 1)]",
                        {.max_bytes = std::size_t{1} << 20});
    EXPECT_FALSE(composing.composer.compose(30, {}));
    EXPECT_TRUE(composing.composer.too_many_parts());
    EXPECT_LT(composing.composer.part_count(), 2000u);
    EXPECT_NE(composing.model.errors().find("different parts, and they take over 1 MiB"), std::string::npos)
        << composing.model.errors();
}

/// Composes with directions snapped to an angle; gives the bound and the farthest stroke from its place.
std::pair<double, double> snapped(const std::string& statements, unsigned steps, double angle_deg) {
    Composing composing(statements, {.snap_angle = angle_deg * std::numbers::pi / 180});
    Graph& graph = composing.graph;
    TurtleState start;
    start.width = start_width;
    start.tropism = Vec3(0, -1, 0);
    start.vertical = Vec3(0, 1, 0);
    auto part = composing.composer.compose(steps, start);
    if (!part) throw std::runtime_error(composing.model.errors());
    Object root;
    root.name = "root";
    root.instances = part->instances;
    graph.root = graph.add(std::move(root));
    const Unfolding found(graph);
    const Figure wanted = plain_figure(statements, steps, start_width);
    double worst = 0;
    for (std::size_t i = 0; i < wanted.strokes.size(); ++i)
        worst = std::max({worst, glm::distance(wanted.strokes[i].from, found.strokes.at(i).from),
                          glm::distance(wanted.strokes[i].to, found.strokes.at(i).to)});
    return {part->error.farthest, worst};
}

TEST(LsysComposer, snappedDirectionsStayWithinTheBound) {
    const std::string ternary =
        "axiom T(0.22)F(2)/(45)A\n"
        "A -> F(0.5)[&(19)F(0.5)A]/(95)[&(19)F(0.5)A]/(133)[&(19)F(0.5)A]\nF(l) -> F(l*1.109)";
    const std::string levelled = "axiom A(1)\nA(l) -> F(l)[&(5)B(l*0.9)]/(180)[&(65)B(l*0.7)]\n"
                                 "B(l) -> F(l)[+(18)$B(l*0.9)][-(65)$B(l*0.7)]";
    const std::string both = "axiom T(0.1)A(1)\nA(l) -> F(l)[&(15)B(l*0.9)]/(180)[&(65)B(l*0.7)]\n"
                             "B(l) -> F(l)[+(18)$B(l*0.9)][-(65)$/(30)B(l*0.7)]";
    for (const auto& [text, steps] : {std::pair(ternary, 8u), std::pair(levelled, 9u), std::pair(both, 8u)}) {
        for (const double angle_deg : {4.0, 2.0, 1.0}) {
            const auto [bound, worst] = snapped(text, steps, angle_deg);
            EXPECT_GT(worst, 0) << angle_deg; // something was snapped
            EXPECT_LE(worst, bound) << angle_deg;
        }
    }
}

TEST(LsysComposer, theBoundIsNoLargerThanTheWaysGone) {
    // '$' turns a heading that is nearly vertical by any angle, however little the heading is off.
    const std::string upright =
        "axiom A(3)\nA(k) -> F(1)[&(k)/(7)$[&(40)F(1)]A(k*0.8+1)][^(k)/(130)$A(k*0.7+2)]\n";
    const auto [bound, worst] = snapped(upright, 7, 4);
    constexpr double longest_way = 8; // a segment a step, and one aside
    EXPECT_GT(worst, 0);
    EXPECT_LE(worst, bound);
    EXPECT_LE(bound, 2 * longest_way * (1 + 1e-12));
}

} // namespace
} // namespace graftal
