// Limbs under `skin`: chains of segments as one surface each, whatever parts the word is composed of.

#include "compiler/lsys/turtle/skin.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/primitives/limb_sweep.h"
#include "compiler/primitives/solid.h"
#include "compiler/primitives/tessellate.h"
#include "tests/unit/lsys/turtle.h"

namespace graftal::testing {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

/// A limb in the world.
struct Skin {
    double volume = 0;
    Vec3 middle{0.0}, low{INFINITY}, high{-INFINITY};
    int colour = 0;
};

Skin measured(const Primitive& primitive, const Affine& place, int colour) {
    const TessellatedPrimitive& mesh = tessellated(primitive, 0);
    Skin skin{.colour = colour};
    for (const auto& t : mesh.triangles) {
        const Vec3 a = place(mesh.vertices[t[0]]), b = place(mesh.vertices[t[1]]),
                   c = place(mesh.vertices[t[2]]);
        const double share = glm::dot(a, glm::cross(b, c)) / 6;
        skin.volume += share;
        skin.middle += share / 4 * (a + b + c);
        for (const Vec3& corner : {a, b, c}) {
            skin.low = glm::min(skin.low, corner);
            skin.high = glm::max(skin.high, corner);
        }
    }
    skin.middle /= skin.volume;
    skin.volume = std::abs(skin.volume); // of a mirrored one, too
    return skin;
}

void unfold(const Graph& graph, ObjectId id, const Affine& place, int colour, std::vector<Skin>& skins) {
    const Object& object = graph.objects[id];
    if (object.primitive == PrimitiveKind::limb_sweep)
        skins.push_back(measured(*object.primitive, place, colour));
    for (const Instance& instance : object.instances)
        unfold(graph, instance.master, place * instance.parent_from_child,
               instance.material ? static_cast<int>(*instance.material) : colour, skins);
}

std::vector<Skin> skins_of(const Graph& graph) {
    std::vector<Skin> skins;
    unfold(graph, graph.root, Affine(), 0, skins);
    return skins;
}

std::size_t count_of(const Graph& graph, PrimitiveKind kind) {
    return static_cast<std::size_t>(
        std::ranges::count_if(graph.objects, [&](const Object& o) { return o.primitive == kind; }));
}

std::string said(const std::string& statements) {
    SourceMap sources;
    Diagnostics diagnostics;
    lower_text("m.lsys", "lsys m {\n" + statements + "\n}\n", {}, sources, diagnostics);
    return diagnostics.render(sources);
}

double frustum_volume(double length, double a, double b) {
    return pi / 3 * length * (a * a + a * b + b * b);
}

TEST(Skin, AChainOfSegmentsIsOneSurfaceThatTapers) {
    const CompiledLsys model("skin 0.001\nwidth 1\naxiom F(1)!(0.8)F(2)!(0.2)F(3)!(0.000001)F(1)", 0);
    const std::vector<Skin> skins = skins_of(model.graph);
    ASSERT_EQ(skins.size(), 1u);
    EXPECT_EQ(count_of(model.graph, PrimitiveKind::cylinder), 0u);
    EXPECT_EQ(count_of(model.graph, PrimitiveKind::sphere), 0u);
    const double wanted = frustum_volume(1, 0.5, 0.5) + frustum_volume(2, 0.5, 0.4) +
                          frustum_volume(3, 0.4, 0.1) + frustum_volume(1, 0.1, 0);
    EXPECT_NEAR(skins[0].volume, wanted, 1e-5 * wanted);
    EXPECT_NEAR(skins[0].low.y, 0, 1e-6);
    EXPECT_NEAR(skins[0].high.y, 7, 1e-5);
}

TEST(Skin, ControlPointsAreNodesToo) {
    const CompiledLsys model("skin 0.001\nwidth 1\naxiom @GsF(1)!(0.8)@GcF(2)!(0.2)@GcF(1)!(0.000001)@Ge", 0);
    const std::vector<Skin> skins = skins_of(model.graph);
    ASSERT_EQ(skins.size(), 1u);
    const double wanted =
        frustum_volume(1, 0.5, 0.4) + frustum_volume(2, 0.4, 0.1) + frustum_volume(1, 0.1, 0);
    EXPECT_NEAR(skins[0].volume, wanted, 1e-5 * wanted);
}

TEST(Skin, GapsColoursAndBranchesBeginLimbs) {
    const auto count = [](const std::string& axiom) {
        const std::string text = "skin 0.1\nwidth 0.1\nangle 40\naxiom " + axiom;
        return skins_of(CompiledLsys(text, 0).graph).size();
    };
    EXPECT_EQ(count("FF+F-F"), 1u);
    EXPECT_EQ(count("F[+F]F"), 2u);
    EXPECT_EQ(count("F[+F][-F[&F]F]F"), 4u);
    EXPECT_EQ(count("FfF"), 2u);
    EXPECT_EQ(count("Ff(0)F"), 1u);
    EXPECT_EQ(count("F;FF"), 2u);
    EXPECT_EQ(count("F!(0)F!(0.1)F"), 2u) << "no width is a gap";
    EXPECT_EQ(count("F{F+F+F}F"), 2u) << "lines of polygons are no segments";
    EXPECT_EQ(count("F[+F%F]F"), 2u);
    EXPECT_EQ(count(std::string(299, 'F')), 1u);
    EXPECT_EQ(count(std::string(300, 'F')), 2u);
}

/// Parts of a chain are composed from its tip on; none may leave single segments behind.
TEST(Skin, LongChainsOfPartsAreFewLimbs) {
    const auto limbs = [](unsigned steps, const std::string& rule) {
        const CompiledLsys model("skin 0.1\nwidth 0.1\naxiom A\nA -> " + rule, steps);
        return skins_of(model.graph).size();
    };
    EXPECT_EQ(limbs(299, "FA"), 1u);
    EXPECT_EQ(limbs(300, "FA"), 2u);
    EXPECT_EQ(limbs(650, "FA"), 3u);
    EXPECT_EQ(limbs(650, "AF"), 3u);
}

/// A branch has a collar where it leaves a limb, and a flat end where it leaves nothing.
TEST(Skin, CollarsAreSunkInTheLimbThatBearsThem) {
    const auto branch_of = [](const std::string& axiom) {
        const CompiledLsys model("skin 0.001\nwidth 1\naxiom " + axiom, 0);
        std::vector<Skin> skins = skins_of(model.graph);
        return *std::ranges::max_element(skins, {}, [](const Skin& s) { return s.high.x; });
    };
    const Skin borne = branch_of("F(4)[-(90)!(0.4)F(4)]F(4)");
    // Sunk by half a ball no wider than the trunk, which has a radius of 0.5.
    EXPECT_NEAR(borne.low.x, -1.8 * 0.2, 2e-3);
    EXPECT_NEAR(borne.high.y - 4, 1.8 * 0.2, 2e-3);
    const Skin thick = branch_of("F(4)[-(90)!(0.8)F(4)]F(4)");
    EXPECT_LT(thick.high.y - 4, 0.5);
    EXPECT_GT(thick.high.y - 4, 0.48);
    const Skin free = branch_of("f(4)[-(90)!(0.4)F(4)]");
    EXPECT_NEAR(free.low.x, 0, 1e-6);
    EXPECT_NEAR(free.volume, frustum_volume(4, 0.2, 0.2) + 2 * pi / 3 * 0.008, 1e-3);
    const Skin apart = branch_of("F(4)[-(90)!(0.4)f(3)F(4)]F(4)");
    EXPECT_NEAR(apart.low.x, 3, 1e-6);
}

/// Composed parts give the limbs of the derived word, whose pieces are other ones.
TEST(Skin, LimbsRunThroughParts) {
    for (const char* productions :
         {"axiom A\nA -> F[+A]!F[-!A]^A", "axiom A\nA -> F(1)!B[&A]/(70)A\nB -> F+F[-A]",
          "axiom A\nA -> F[+A]fF[-A]F", "axiom FA\nA -> [+A][-!FA]&FA", "axiom A\nF -> FF\nA -> F[+A]-FA",
          "axiom A\nA -> !@GsF+F!@Gc[-A]F@Ge[&A]", "axiom A\nA -> F[+@Di(0.7)!A]@S(0.9)F[@F-A]F",
          "axiom A\nA -> FA%F\nF -> F[+F]", "axiom A(3)\nA(x) -> F(x)[+A(x*0.7)]!F(x)[-A(x*0.6)]"}) {
        const std::string text = std::string("skin 0.1\nangle 25\nwidth 0.3\n") + productions;
        LowerOptions exact;
        exact.exact = true;
        const CompiledLsys composed(text, 4), derived(text, 4, exact);
        std::vector<Skin> some = skins_of(composed.graph), others = skins_of(derived.graph);
        ASSERT_EQ(some.size(), others.size()) << productions;
        ASSERT_GT(some.size(), 3u) << productions;
        for (const Skin& skin : some) {
            const auto same = std::ranges::find_if(others, [&](const Skin& other) {
                return glm::length(skin.middle - other.middle) < 1e-4 && skin.colour == other.colour &&
                       std::abs(skin.volume / other.volume - 1) < 1e-4;
            });
            ASSERT_NE(same, others.end()) << productions;
            others.erase(same);
        }
    }
}

TEST(Skin, EqualLimbsAreMadeOnce) {
    // Twelve levels of a self-similar tree, and of one whose branches turn about its axis.
    const CompiledLsys similar("skin 0.1\nangle 30\nthickness 0.1\naxiom A(1)\n"
                               "A(x) -> F(x)[+A(x/2)][-A(x/2)]",
                               12);
    EXPECT_LE(count_of(similar.graph, PrimitiveKind::limb_sweep), 3u);
    const CompiledLsys turned("skin 0.1\nangle 40\nwidth 0.1\naxiom A\nA -> F[&A]/(137.5)^(3)A", 12);
    EXPECT_LE(count_of(turned.graph, PrimitiveKind::limb_sweep), 13u);
    EXPECT_EQ(skins_of(turned.graph).size(), 2048u);
}

TEST(Skin, NumbersOfALimbAreItsShapeAlone) {
    Limb limb;
    for (const Vec3 place : {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0.5, 2, 0), Vec3(0.5, 3, 0.7)})
        limb.nodes.push_back({place, 0.1 / (1 + place.y)});
    const auto skin = skin_of(limb, 8);
    ASSERT_TRUE(skin);
    std::mt19937_64 random(3);
    const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    for (int i = 0; i < 100; ++i) {
        const Affine turn = Affine::rotate({unit(), unit(), unit()}, 180 * unit());
        const double size = std::pow(10.0, 20 * unit());
        const Vec3 shift = size * Vec3(unit(), unit(), unit());
        Limb moved = limb;
        for (LimbNode& node : moved.nodes)
            node = {turn(size * node.place) + shift, size * node.radius};
        const auto other = skin_of(moved, 8);
        ASSERT_TRUE(other);
        EXPECT_EQ(other->numbers, skin->numbers);
        // In its place the skin has the limb's nodes.
        for (std::size_t k = 0; k < moved.nodes.size(); ++k) {
            const double* const n = &other->numbers[3 + 4 * k];
            const Vec3 place = other->start_from_skin(Vec3(n[0], n[1], n[2]));
            EXPECT_LT(glm::distance(place, moved.nodes[k].place), 1e-5 * size);
        }
    }
}

/// A random word with brackets.
std::string random_word(std::mt19937_64& random) {
    const auto below = [&](unsigned count) { return static_cast<unsigned>(random() % count); };
    std::string word = "F";
    int open = 0;
    for (unsigned left = 5 + below(60); left > 0; --left) {
        switch (below(12)) {
        case 0:
        case 1:
            if (open < 8) word += "[", ++open;
            break;
        case 2:
        case 3:
            if (open > 0) word += "]", --open;
            break;
        case 4:
            word += fmt::format("!({})", below(5) == 0 ? 0.0 : below(1000) / 1000.0);
            break;
        case 5:
            word += fmt::format("{}({})", "+-&^/\\"[below(6)], below(13) * 15);
            break;
        case 6:
            word += below(2) ? "f(0.3)" : "|";
            break;
        case 7:
            word += fmt::format("F({})", below(7) == 0 ? 0.0001 : below(100) / 50.0);
            break;
        case 8:
            word += below(2) ? "@Gs" : "@Gc";
            break;
        default:
            word += "F";
            break;
        }
    }
    return word + std::string(static_cast<std::size_t>(open), ']');
}

TEST(Skin, RandomWordsGiveClosedSurfacesOfFiniteNumbers) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 200; ++i) {
        const std::string word = random_word(random);
        const CompiledLsys model("skin 0.1\nwidth 0.2\naxiom " + word, 0);
        const std::vector<Skin> skins = skins_of(model.graph);
        EXPECT_LE(skins.size(), word.size());
        for (const Skin& skin : skins)
            for (int k = 0; k < 3; ++k)
                EXPECT_TRUE(std::isfinite(skin.low[k]) && std::isfinite(skin.high[k])) << word;
        for (const Object& object : model.graph.objects)
            if (object.primitive == PrimitiveKind::limb_sweep) {
                EXPECT_TRUE(encloses_volume(*object.primitive)) << word;
                EXPECT_LE(limb_triangles(*object.primitive), 300u * word.size()) << word;
            }
    }
}

TEST(Skin, KeepsToALimitOfTriangles) {
    // Each limb is another one, and has some thousand triangles.
    EXPECT_THAT(said("skin 0.001\nwidth 0.1\nsteps 4000\naxiom A(1)\nA(n) -> F[+(n)F(n)F(n+1)]A(n+0.37)"),
                HasSubstr("the skin of the limbs has more than 4000000 triangles"));
    // A chain that doubles at each step is cut into limbs of one kind.
    const CompiledLsys chain("skin 0.1\nwidth 0.1\naxiom F\nF -> FF", 20);
    EXPECT_LE(count_of(chain.graph, PrimitiveKind::limb_sweep), 100u);
}

TEST(Skin, RefusesWhatHasNoLimbs) {
    EXPECT_THAT(said("skin 0.1\nsteps infinite\naxiom A\nA -> F[+A]"), HasSubstr("so no skin"));
    EXPECT_THAT(said("skin 0\naxiom F\nsteps 0"), HasSubstr("'skin' must lie between 0.001 and 0.3, not 0"));
    EXPECT_THAT(said("skin 1\naxiom F\nsteps 0"), HasSubstr("not 1"));
}

} // namespace
} // namespace graftal::testing
