#include "compiler/editing/maps/maps.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "compiler/support/counter_random.h"

namespace graftal {
namespace {

std::string scene(const std::string& name) {
    std::ifstream file(GRAFTAL_SOURCE_DIR "/scenes/" + name);
    return {std::istreambuf_iterator<char>(file), {}};
}

Affine moved(const Affine& map, Vec3 by) {
    return Affine::translate(by) * map;
}

/// The text after a map became another, or "refused: why".
std::string moved_to(const std::string& name, const std::string& text, const std::string& map,
                     const Affine& matrix) {
    const Document document(name, text);
    const MapChange change = move_map(document, map, matrix);
    return change.refusal.empty() ? applied(text, change.edits) : "refused: " + change.refusal;
}

TEST(Maps, ListsThoseOfATextWithTheirBoxes) {
    const std::string text = scene("ifs/fern.rifs");
    Session session("fern.rifs", text);
    Compilation compilation;
    const auto model = session.analysed({}, compilation);
    ASSERT_TRUE(model);
    const std::vector<EditableMap> maps = maps_of(Document("fern.rifs", text), {}, model.get());
    ASSERT_EQ(maps.size(), 4u);
    EXPECT_EQ(maps[1].name, "frond");
    EXPECT_TRUE(maps[1].movable);
    EXPECT_DOUBLE_EQ(maps[1].matrix.linear[1][0], .04);
    EXPECT_NEAR(maps[1].contraction, std::hypot(.85, .04), 1e-12);
    EXPECT_NEAR(maps[1].box.max.y, 9.9983, 1e-3); // the whole fern
    EXPECT_EQ(text.substr(maps[2].span.begin, 5), "left:");
    // Maps of the digraph map what they may follow.
    const std::string sign = scene("hart/pound_sign_2d.rifs");
    EXPECT_EQ(maps_of(Document("p.rifs", sign)).size(), 4u);
}

TEST(Maps, ByPointsMoveTheirImagesOnly) {
    const std::string text = "rifs a {\n  map m { points <0, 0>, <1, 0> -> <0, 0>, <1/2, 0> }\n"
                             "  map n { scale 1/2 }\n}\n";
    const Affine map = Affine::translate({1, 2, 0}) * Affine::scale(Vec3(0.5));
    EXPECT_EQ(moved_to("a.rifs", text, "m", map),
              "rifs a {\n  map m { points <0, 0>, <1, 0> -> <1, 2>, <1.5, 2> }\n"
              "  map n { scale 1/2 }\n}\n");
}

TEST(Maps, OfWeightsKeepTheirControlPoints) {
    const std::string text = "rifs a {\n  control <0, 0>, <2, 0>, <0, 4>\n  codes barycentric {\n"
                             "    m: 1 0 0  .5 .5 0  .5 0 .5   .3 # left\n"
                             "    n: .5 .5 0  0 1 0  0 .5 .5  .7\n  }\n}\n";
    const Affine map = Affine::translate({0, 1, 0}) * Affine::scale(Vec3(0.5));
    EXPECT_EQ(moved_to("a.rifs", text, "m", map),
              "rifs a {\n  control <0, 0>, <2, 0>, <0, 4>\n  codes barycentric {\n"
              "    m: 0.75 0 0.25  0.25 .5 0.25  0.25 0 0.75   .3 # left\n"
              "    n: .5 .5 0  0 1 0  0 .5 .5  .7\n  }\n}\n");
    EXPECT_EQ(moved_to("a.rifs", text, "m", Affine::translate({0, 0, 1}) * map),
              "refused: A row of codes of the plane moves in the plane only.");
}

TEST(Maps, OfObjectsAndWhyNot) {
    const Document document("m.inst",
                            "canonical object tip(n) { instance: cube scale: n, 1, 1 }\n"
                            "object a { tip(1)  translate: 1, 0, 0\n  scatter cube count 3 over disc 1\n"
                            "  instance: cube scale: random(1, 2) }");
    const std::vector<EditableMap> maps = maps_of(document);
    ASSERT_EQ(maps.size(), 4u);
    EXPECT_EQ(maps[0].name, "tip/cube");
    EXPECT_FALSE(maps[0].movable);
    EXPECT_NE(maps[0].why.find("'n'"), std::string::npos) << maps[0].why;
    EXPECT_TRUE(maps[1].movable);
    EXPECT_EQ(maps[2].why, "a scatter places its objects");
    EXPECT_EQ(maps[3].name, "a/cube#2");
    EXPECT_EQ(maps[3].why, "its numbers are random");
}

TEST(Maps, KeepTheFormInWhichTheyAreWritten) {
    const Affine half = Affine::scale(Vec3(0.5));
    EXPECT_EQ(moved_to("m.rifs", "rifs a { map b { scale 1/2  translate <1/2, 0> } }  # kept", "b",
                       moved(half, {0.75, 0.25, 0})),
              "rifs a { map b { scale 1/2  translate <0.75, 0.25> } }  # kept");
    EXPECT_EQ(moved_to("m.rifs", "rifs a { map b { scale: 1/2 } }", "b", moved(half, {1, 2, 0})),
              "rifs a { map b { scale: 1/2  translate: 1, 2 } }");
    EXPECT_EQ(moved_to("m.rifs", "rifs a { map b { scale 1/2 rotate z, 0 translate 1, 0 } }", "b",
                       moved(Affine::rotate({0, 0, 1}, 30) * half, {1, 0, 0})),
              "rifs a { map b { scale 1/2 rotate z, 30 translate 1, 0 } }");
    EXPECT_EQ(moved_to("m.rifs", "rifs a { map b { scale 1/2 } }", "b",
                       Affine::scale({0.5, 0.25, std::sqrt(0.125)})),
              "rifs a { map b { scale 0.5, 0.25 } }");
    // Names stay: a constant is added.
    EXPECT_EQ(moved_to("m.rifs", "let w = 1/4\nrifs a { map b { scale 1/2 translate -w, w+1 } }", "b",
                       moved(half, {-0.5, 1.5, 0})),
              "let w = 1/4\nrifs a { map b { scale 1/2 translate -w-0.25, w+1.25 } }");
    EXPECT_EQ(moved_to("m.rifs",
                       "rifs a { codes 2d {\n  x: .5 -.1 .1 .5 0 1 .3  # first\n  .5 0 0 .5 0 0 .7\n} }", "x",
                       Affine{Mat3(.4, .1, 0, -.2, .5, 0, 0, 0, .5), {1, 1, 0}}),
              "rifs a { codes 2d {\n  x: 0.4 -0.2 .1 .5 1 1 .3  # first\n  .5 0 0 .5 0 0 .7\n} }");
    EXPECT_EQ(moved_to("m.inst", "object a { cube\n  scale: 0.5 # half\n  translate: 1, 0, 0\n}", "a/cube",
                       Affine{Mat3(.5, .1, 0, 0, .5, .2, 0, 0, .5), {1, 0, 0}}),
              "object a { cube\n  matrix: 0.5, 0, 0, 1, 0.1, 0.5, 0, 0, 0, 0.2, 0.5, 0 # half\n  \n}");
}

TEST(Maps, CommentsAmongTheNumbersStay) {
    const auto moved = [](const std::string& list, const Mat3& linear) {
        const std::string text = "rifs r { map a { " + list + " } }";
        const MapChange change = move_map(Document("m.rifs", text), "a", {linear, Vec3(0.0)});
        EXPECT_EQ(change.refusal, "");
        return applied(text, change.edits);
    };
    const Mat3 sheared(0.5, 0.25, 0, 0, 0.5, 0.25, 0, 0, 0.5); // by columns
    EXPECT_EQ(
        moved("rotate z, 10  scale 1/2, /* high */ 1/4 # both\n", sheared),
        "rifs r { map a { matrix 0.5, 0, 0, 0, 0.25, 0.5, 0, 0, 0, 0.25, 0.5, 0   /* high */  # both\n } }");
    EXPECT_EQ(moved("scale 1/2, /* high */ 1/4  rotate x, 90", Mat3(0.5, 0, 0, 0, 0, 0.25, 0, -0.125, 0)),
              "rifs r { map a { scale 0.5, 0.25, 0.125 /* high */   rotate x, 90 } }");
}

TEST(Maps, RefusesWhatATextCannotSay) {
    EXPECT_EQ(moved_to("m.rifs", "rifs a { codes 2d { .5 0 0 .5 0 0\n} }", "w1", moved(Affine(), {0, 0, 1})),
              "refused: A row of codes of the plane moves in the plane only.");
    EXPECT_EQ(moved_to("m.rifs", "rifs a { map b { scale 1/2 } }", "c", Affine()),
              "refused: There is no map 'c'.");
    EXPECT_EQ(moved_to("m.inst", "object a { scatter cube count 3 over disc 1 }", "a/cube", Affine()),
              "refused: 'a/cube' cannot be moved: a scatter places its objects.");
    EXPECT_EQ(moved_to("m.rifs", "rifs a { map b { scale 1/2 } }", "b", Affine::scale(Vec3(std::nan("")))),
              "refused: The matrix has entries that are no numbers.");
}

TEST(Maps, SayWhereAModelWouldNotContract) {
    const std::string text = "rifs a { map b { scale 1/2 translate 1, 0 } map c { scale 1/2 } }";
    const Document document("m.rifs", text);
    const MapChange good = move_map(document, "b", Affine::scale(Vec3(0.75)));
    EXPECT_TRUE(good.contracts);
    EXPECT_NEAR(good.ratio, 0.75, 1e-12);
    const MapChange bad = move_map(document, "b", Affine::scale(Vec3(1.25)));
    EXPECT_FALSE(bad.contracts);
    EXPECT_NE(bad.why.find("the cycle b -> b does not contract: each time around, it grows 1.25 times"),
              std::string::npos)
        << bad.why;
    EXPECT_FALSE(bad.edits.empty()); // the page shows it in red
}

/// A number of [-1, 1).
double number(CounterRandom random, std::uint64_t& counter) {
    return 2 * CounterRandom::unit(random(counter++)) - 1;
}

/// A map as some text writes it; one of many forms.
std::string random_map(CounterRandom random, std::uint64_t& n, int form) {
    const auto some = [&] { return fmt::format("{:.3f}", 0.1 + 0.4 * std::abs(number(random, n))); };
    const auto any = [&] { return fmt::format("{:.3f}", number(random, n)); };
    switch (form) {
    case 0:
        return fmt::format("codes 2d {{\n m: {} {} {} {} {} {} }}", some(), any(), any(), some(), any(),
                           any());
    case 1:
        return fmt::format("codes polar {{\n m: {} {} {} {} {}, {} }}", some(), some(), any(), any(), any(),
                           any());
    case 2:
        return fmt::format("codes 3d {{\n m: {} .1 .2 lean*.1 {} 0 0 0 {} {} {} {} }}", some(), some(),
                           some(), any(), any(), any());
    case 3:
        return fmt::format("map m {{ scale 1/{}  rotate z, {}  translate <{}, {}> }}", "2", any(), any(),
                           any());
    case 4:
        return fmt::format("map m {{ rotate y, {} /* turn */ scale {}, {}, {}\n  translate {} {} {} }}",
                           any(), some(), some(), some(), any(), any(), any());
    case 5:
        return fmt::format("map m {{ translate lean, {}, {}  scale: {} }}", any(), any(), some());
    case 6:
        return "map m { }";
    case 7:
        return fmt::format("map m {{ shear xy, {} scale {} rotate <1, 1, 0>, 20 }}", any(), some());
    default:
        return fmt::format("map m {{ matrix: .5, 0, 0, {},  0, .5, .1, {},  0, 0, {}, 0 }}", any(), any(),
                           some());
    }
}

TEST(Maps, RandomMatricesReadBack) {
    const CounterRandom random(52);
    std::uint64_t n = 0;
    int as_matrix = 0;
    for (int i = 0; i < 200; ++i) {
        const int form = i % 9;
        const std::string text = "let lean = 0.2\nrifs a {\n  " + random_map(random, n, form) +
                                 "  # a remark\n  map o { scale 0.3 }\n}\n";
        const bool flat = form < 2 || (form == 3 && i % 2 == 0);
        Affine wanted;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                wanted.linear[column][row] = flat && (column == 2 || row == 2) ? 0 : number(random, n);
        wanted.translation = {number(random, n), number(random, n), flat ? 0 : number(random, n)};
        const Document document("m.rifs", text);
        const MapChange change = move_map(document, "m", wanted);
        ASSERT_EQ(change.refusal, "") << text;
        const std::string after = applied(text, change.edits);
        EXPECT_NE(after.find("# a remark"), std::string::npos) << after;
        as_matrix += after.find("matrix") != std::string::npos ? 1 : 0;
        const std::vector<EditableMap> maps = maps_of(Document("m.rifs", after));
        ASSERT_EQ(maps.size(), 2u) << after;
        const Affine& read = maps[0].matrix;
        const int size = flat ? 2 : 3;
        for (int row = 0; row < size; ++row) {
            for (int column = 0; column < size; ++column)
                EXPECT_NEAR(read.linear[column][row], wanted.linear[column][row], 1e-12) << after;
            EXPECT_NEAR(read.translation[row], wanted.translation[row], 1e-12) << after;
        }
    }
    EXPECT_LT(as_matrix, 150);
}

/// The most decimals that a number of the text has.
std::size_t most_decimals(const std::string& text) {
    std::size_t most = 0;
    for (std::size_t at = text.find('.'); at != std::string::npos; at = text.find('.', at + 1)) {
        const std::size_t end = text.find_first_not_of("0123456789", at + 1);
        most = std::max(most, std::min(end, text.size()) - at - 1);
    }
    return most;
}

std::size_t most_decimals(const std::vector<TextEdit>& edits) {
    std::size_t most = 0;
    for (const TextEdit& edit : edits)
        most = std::max(most, most_decimals(edit.text));
    return most;
}

TEST(Maps, AHandWritesTheDigitsThatItTells) {
    const CounterRandom random(54);
    std::uint64_t n = 0;
    const Box reach{Vec3(-2.0, -1.0, -1.0), Vec3(3.0, 10.0, 1.0)};
    for (const double grain : {0.02, 0.0003})
        for (int i = 0; i < 90; ++i) {
            const int form = i % 9;
            const std::string text = "let lean = 0.2\nrifs a {\n  " + random_map(random, n, form) + "\n}\n";
            const bool flat = form < 2;
            Affine wanted;
            for (int column = 0; column < 3; ++column)
                for (int row = 0; row < 3; ++row)
                    wanted.linear[column][row] = flat && (column == 2 || row == 2) ? 0 : number(random, n);
            wanted.translation = {number(random, n), number(random, n), flat ? 0 : number(random, n)};
            const MapChange change = move_map(Document("m.rifs", text), "m", wanted, {}, {grain, reach});
            ASSERT_EQ(change.refusal, "") << text;
            const std::string after = applied(text, change.edits);
            EXPECT_LE(most_decimals(change.edits), std::ceil(-std::log10(grain)) + 4) << after;
            const Affine read = maps_of(Document("m.rifs", after)).front().matrix;
            for (Vec3 corner : reach.corners()) {
                if (flat) corner.z = 0;
                EXPECT_LE(glm::distance(read(corner), wanted(corner)), grain) << after;
            }
        }
}

TEST(Maps, ADragOfNothingChangesNothing) {
    const std::string text =
        "rifs a {\n  map m { scale 1/3  rotate z, 20.123456789  translate <1/7, 0.5> }\n}\n";
    const Affine matrix = maps_of(Document("m.rifs", text)).front().matrix;
    EXPECT_TRUE(move_map(Document("m.rifs", text), "m", matrix, {}, {0.01, {}}).edits.empty());
    const std::string after = applied(
        text, move_map(Document("m.rifs", text), "m", moved(matrix, {0.1, 0, 0}), {}, {0.01, {}}).edits);
    EXPECT_EQ(after, "rifs a {\n  map m { scale 1/3  rotate z, 20.123456789  translate <0.243, 0.5> }\n}\n");
}

TEST(Maps, ANumberThatADragOnlyGrazesStays) {
    const std::string text = "rifs a {\n  codes 2d {\n    m: .85 .04 -.04 .85 0 1.6\n  }\n}\n";
    Affine wanted = maps_of(Document("m.rifs", text)).front().matrix;
    wanted.linear[0][0] = 0.9;
    wanted.translation.y = 1.5999999999998888; // as sums of a page have it
    const std::string after =
        applied(text, move_map(Document("m.rifs", text), "m", wanted, {}, {0.004, {}}).edits);
    EXPECT_EQ(after, "rifs a {\n  codes 2d {\n    m: 0.9 .04 -.04 .85 0 1.6\n  }\n}\n");
}

TEST(Pull, AHandWritesTheDigitsThatItTells) {
    const std::string text =
        "let lean = 0.2\nrifs a {\n  map m { scale 1/2  translate <lean, 0.123456789> }\n"
        "  map o { scale 1/2  translate <-0.5, 0> }\n}\n";
    const MapChange change =
        pull(Document("m.rifs", text), "m.o", {0, 0.1, 0}, {0.05, 0.2, 0}, {}, {0.004, {}});
    ASSERT_EQ(change.refusal, "");
    ASSERT_FALSE(change.edits.empty());
    EXPECT_LE(most_decimals(change.edits), 5u) << applied(text, change.edits);
}

TEST(Maps, SimilaritiesKeepTheirWords) {
    const CounterRandom random(53);
    std::uint64_t n = 0;
    for (int i = 0; i < 50; ++i) {
        const std::string text = fmt::format(
            "rifs a {{ map m {{ scale {:.2f}  rotate z, {:.1f}  translate {:.2f}, {:.2f} }} }}",
            0.6 + 0.3 * number(random, n), 170 * number(random, n), number(random, n), number(random, n));
        const Affine wanted = Affine::translate({number(random, n), number(random, n), 0}) *
                              Affine::rotate({0, 0, 1}, 180 * number(random, n)) *
                              Affine::scale(Vec3(0.5 + 0.4 * number(random, n)));
        const Document document("m.rifs", text);
        const MapChange change = move_map(document, "m", wanted);
        ASSERT_EQ(change.refusal, "") << text;
        const std::string after = applied(text, change.edits);
        EXPECT_EQ(after.find("matrix"), std::string::npos) << text << after;
        EXPECT_EQ(after.find(','), after.find(" rotate z,") + 9) << after; // the scale stays one number
        EXPECT_LT(after.size(), 150u) << after;
    }
}

/// The maps of a model by the names of their objects.
Affine map_named(const std::string& name, const std::string& text, const std::string& map) {
    for (const EditableMap& one : maps_of(Document(name, text)))
        if (one.name == map) return one.matrix;
    ADD_FAILURE() << map;
    return {};
}

struct Pulled {
    std::string scene, address;
    std::vector<std::string> maps; ///< of the address, in its order
    std::vector<std::string> cycle;
};

Vec3 point_of(const Pulled& pulled, const std::string& name, const std::string& text) {
    Vec3 point(0.0);
    for (int i = 0; i < 3000 && !pulled.cycle.empty(); ++i)
        for (auto map = pulled.cycle.rbegin(); map != pulled.cycle.rend(); ++map)
            point = map_named(name, text, *map)(point);
    for (auto map = pulled.maps.rbegin(); map != pulled.maps.rend(); ++map)
        point = map_named(name, text, *map)(point);
    return point;
}

TEST(Pull, MovesThePointOfAnAddress) {
    const Pulled cases[] = {
        {"ifs/fern.rifs", "frond*3.left.(right)*", {"frond", "frond", "frond", "left"}, {"right"}},
        {"ifs/heighway_dragon.rifs", "first.(second.first)*", {"first"}, {"second", "first"}},
        {"ifs/sierpinski_tetrahedron.rifs", "a.b.(c)*", {"a", "b"}, {"c"}},
        {"hart/pound_sign_2d.rifs", "ll.(lr.ul)*", {"ll"}, {"lr", "ul"}},
    };
    for (const Pulled& one : cases) {
        std::string text = scene(one.scene);
        // Without the model that the terminal uses, which lies beside the scene.
        for (const char* line : {"use tetra = \"tetrahedron.inst\"", "terminal tetra"})
            if (const std::size_t at = text.find(line); at != std::string::npos)
                text.erase(at, std::string(line).size());
        const Vec3 from = point_of(one, "m.rifs", text);
        const bool flat = one.scene != "ifs/sierpinski_tetrahedron.rifs";
        const Vec3 to = from + Vec3(0.05, -0.03, flat ? 0 : 0.02);
        const MapChange change = pull(Document("m.rifs", text), one.address, from, to);
        ASSERT_EQ(change.refusal, "") << one.scene;
        EXPECT_TRUE(change.contracts) << one.scene << change.why;
        const std::string after = applied(text, change.edits);
        const Vec3 now = point_of(one, "m.rifs", after);
        EXPECT_LT(largest_entry(now - to), 1e-9) << one.scene << "\n" << after;
        EXPECT_EQ(after.find("matrix"), std::string::npos) << after; // the forms stay
    }
}

TEST(Pull, FiniteAddressesKeepTheirPlaceInTheLastObject) {
    const std::string text = scene("hart/sierpinski.inst");
    const std::string spelled = "up/up";
    const Affine before = map_named("m.inst", text, spelled);
    const Vec3 local(0.1, 0.2, 0), from = before(before(local)), to = from + Vec3(0.02, 0.01, 0);
    // top -> up -> up -> up: the instance of `top`, then two of `up`.
    const MapChange change = pull(Document("m.inst", text), "up.up.up", from, to);
    ASSERT_EQ(change.refusal, "");
    EXPECT_TRUE(change.contracts) << change.why;
    const std::string after = applied(text, change.edits);
    const Affine map = map_named("m.inst", after, spelled);
    EXPECT_LT(largest_entry(map(map(local)) - to), 1e-9) << after;
}

TEST(Pull, AddsToTheWholeOfAComparison) {
    const auto pulled = [](const std::string& number) {
        const std::string text = "let k = 1\nrifs r { map a { scale 1/2 translate " + number + ", 0 } }";
        const MapChange change = pull(Document("m.rifs", text), "(a)*", Vec3(0.0), {2.5, 0, 0});
        const std::vector<EditableMap> maps = maps_of(Document("m.rifs", applied(text, change.edits)));
        EXPECT_EQ(maps.size(), 1u);
        const Affine map = maps.empty() ? Affine() : maps.front().matrix;
        EXPECT_NEAR((glm::inverse(Mat3(1.0) - map.linear) * map.translation).x, 2.5, 1e-9) << number;
    };
    pulled("k");
    pulled("(k<2)");
    pulled("k<2");
    pulled("(k<2)==(k<3)");
}

TEST(Pull, RefusesWhatItCannot) {
    const Document document("m.rifs", "rifs a { map b { scale 1/2 } map c { scale 1/2 translate 1, 0 } }");
    EXPECT_EQ(pull(document, "b..", {}, {}).refusal.substr(0, 27), "The address cannot be read:");
    EXPECT_NE(pull(document, "nobody", {}, {}).refusal, "");
    // Nothing keeps contracting that has to reach so far with so little.
    const MapChange far = pull(document, "(b)*", {}, {1e9, 0, 0});
    EXPECT_TRUE(!far.refusal.empty() || far.contracts) << far.why;
}

/// The text after an edge was set, or "refused: why".
std::string with_edge(const std::string& text, const char* from, const char* to, bool edge) {
    const Document document("m.rifs", text);
    const MapChange change = set_edge(document, from, to, edge);
    return change.refusal.empty() ? applied(text, change.edits) : "refused: " + change.refusal;
}

TEST(Edges, ChangeInTheFormOfTheDigraph) {
    const std::string maps = "rifs r { map a { scale 1/2 } map b { scale 1/3 } map c { scale 1/4 }";
    EXPECT_EQ(with_edge(maps + " }", "a", "b", false), maps + "\n  follow all except a -> b }");
    EXPECT_EQ(with_edge(maps + " follow all }", "a", "b", false), maps + " follow all except a -> b }");
    EXPECT_EQ(with_edge(maps + " follow all except a -> b }", "a", "b", true), maps + " follow all  }");
    EXPECT_EQ(with_edge(maps + " follow all except a -> b }", "a", "c", false),
              maps + " follow all except a -> b, c }");
    EXPECT_EQ(with_edge(maps + " follow all except self }", "b", "b", true),
              maps + " follow all except { a -> a  c -> c } }");
    EXPECT_EQ(with_edge(maps + " follow a -> b, c  b -> a }", "a", "b", false),
              maps + " follow a -> c  b -> a }");
    EXPECT_EQ(with_edge(maps + "\n follow a -> b\n follow b -> a }", "b", "a", false),
              maps + "\n follow a -> b\n  }");
    EXPECT_EQ(with_edge(maps + " follow a -> a  b -> a }", "c", "b", true),
              maps + " follow a -> a  b -> a  c -> b }");
    EXPECT_EQ(with_edge(maps + " follow { a -> a } }", "a", "a", false), maps + " follow {  } }");
    EXPECT_EQ(with_edge(maps + " follow matrix {\n 1 0 1\n 1 1 1\n 0 0 1\n } }", "a", "b", true),
              maps + " follow matrix {\n 1 1 1\n 1 1 1\n 0 0 1\n } }");
    EXPECT_EQ(with_edge(maps + " follow matrix {\n .5 0 .5\n 1 0 0\n 0 0 1\n } }", "a", "b", true),
              "refused: The entries of this matrix are probabilities: each row has its sum.");
    EXPECT_EQ(with_edge(maps + " }", "a", "d", false),
              "refused: There are no maps 'a' and 'd' in one block.");
}

TEST(Edges, ThatAreWrittenTwiceGoWithTheirCommas) {
    const std::string maps = "rifs r { map a { scale 1/2 } map b { scale 1/3 } map c { scale 1/4 }";
    EXPECT_EQ(with_edge(maps + " follow { a -> b, a -> b  c -> a } }", "a", "b", false),
              maps + " follow {    c -> a } }");
    EXPECT_EQ(with_edge(maps + " follow { a -> b, a -> b, c -> a } }", "a", "b", false),
              maps + " follow {   c -> a } }");
    EXPECT_EQ(with_edge(maps + " follow { c -> a, a -> b, a -> b } }", "a", "b", false),
              maps + " follow { c -> a } }");
}

TEST(Edges, LeaveCommentsAlone) {
    const std::string maps = "rifs r { map a { scale 1/2 } map b { scale 1/3 } map c { scale 1/4 }";
    EXPECT_EQ(with_edge(maps + " follow { a -> b # one,\n c -> a  b -> b } }", "c", "a", false),
              maps + " follow { a -> b # one,\n   b -> b } }");
    EXPECT_EQ(with_edge(maps + " follow { a -> b, # one\n c -> a } }", "c", "a", false),
              maps + " follow { a -> b # one\n  } }");
    EXPECT_EQ(with_edge(maps + " follow { a -> b /* one */, c -> a } }", "a", "b", false),
              maps + " follow {  /* one */ c -> a } }");
    EXPECT_EQ(with_edge(maps + " follow all /* except a */ except a -> b }", "a", "b", true),
              maps + " follow all /* except a */  }");
    EXPECT_EQ(with_edge(maps + " follow all except self /* self */ }", "b", "b", true),
              maps + " follow all except { a -> a  c -> c } /* self */ }");
    EXPECT_EQ(with_edge(maps + " follow { /* {} */ } }", "b", "b", true),
              maps + " follow { b -> b  /* {} */ } }");
}

TEST(Edges, EachToggleOfEachFormReadsBack) {
    const std::string maps = "rifs r { map a { scale 1/2 } map b { scale 1/3 } map c { scale 1/4 }\n";
    for (const char* follow :
         {"", "follow all", "follow all except self", "follow all except a -> b",
          "follow all except { a -> a\n b -> c }", "follow a -> b, c  b -> a  c -> c",
          "follow a -> b\nfollow b -> c, a\nfollow c -> b", "follow { a -> b, c, b -> a\n c -> b }",
          "follow matrix { 1 1 0\n 0 1 1\n 1 1 1\n }"}) {
        const std::string text = maps + follow + "\n}";
        const Digraph before = digraphs_of(Document("m.rifs", text)).at(0);
        for (std::size_t from = 0; from < 3; ++from)
            for (std::size_t to = 0; to < 3; ++to) {
                const bool edge = !before.edges[from][to];
                const std::string after =
                    with_edge(text, before.maps[from].c_str(), before.maps[to].c_str(), edge);
                if (after.starts_with("refused")) {
                    ADD_FAILURE() << text << "\n" << before.maps[from] << before.maps[to] << after;
                    continue;
                }
                auto wanted = before.edges;
                wanted[from][to] = edge;
                EXPECT_EQ(digraphs_of(Document("m.rifs", after)).at(0).edges, wanted) << after;
            }
    }
}

} // namespace
} // namespace graftal
