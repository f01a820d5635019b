#include "runtime/inverse/lsystem/found_lsystem.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/support/control.h"
#include "compiler/support/stage_work.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/inverse/lsystem/grammar_search.h"
#include "runtime/inverse/lsystem/stroke_graph.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

class FoundLsystemTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    std::string path(const std::string& name) const { return directory_.path() + "/" + name; }

    /// The strokes that an L-system draws.
    static Strokes drawing(const std::string& text, std::optional<unsigned> steps = std::nullopt) {
        Session session("m.lsys", text);
        StageOptions options;
        options.lower.steps = steps;
        Compilation compilation;
        std::optional<Strokes> strokes = model_strokes(session, options, compilation);
        EXPECT_TRUE(strokes) << compilation.diagnostics.render(compilation.sources) << text;
        return strokes.value_or(Strokes());
    }

    /// A list of lines in another order, turned and scaled; each coordinate is off by up to `noise`.
    std::string listed(Strokes strokes, double noise = 0) const {
        std::uint64_t state = 1;
        const auto random = [&] {
            return state = state * 6364136223846793005ull + 1442695040888963407ull, state >> 33;
        };
        for (std::size_t i = strokes.size(); i > 1; --i)
            std::swap(strokes[i - 1], strokes[random() % i]);
        std::string text = "x1,y1,x2,y2\n";
        const auto moved = [&](Vec2 p) {
            const auto off = [&] { return noise * (static_cast<double>(random() % 2001) / 1000 - 1); };
            return fmt::format("{},{}", 3 * (p.x * 0.8 - p.y * 0.6 + off()) + 7,
                               3 * (p.x * 0.6 + p.y * 0.8 + off()));
        };
        for (const Stroke& stroke : strokes)
            text += moved(stroke.from) + "," + moved(stroke.to) + "\n";
        return text;
    }

    std::optional<FoundLsystem> find(const std::string& name, const std::string& text, double seconds = 20,
                                     const CancelFlag& cancel = {}) {
        EXPECT_TRUE(write_text(path(name), text).ok());
        options_.drawing = path(name);
        options_.seconds = seconds;
        Compilation compilation;
        auto found = find_lsystem(options_, cancel, compilation);
        message_ = compilation.diagnostics.render(compilation.sources) + compilation.status.message();
        return found;
    }

    TemporaryDirectory directory_;
    FindLsystemOptions options_;
    std::string message_;
};

/// Numbers of a drawing that no turn or shift changes: strokes, and squares of their distances from the
/// middle.
std::pair<std::size_t, double> measure(const Strokes& strokes) {
    Vec2 middle(0.0);
    for (const Stroke& stroke : strokes)
        middle += (stroke.from + stroke.to) / (2.0 * static_cast<double>(strokes.size()));
    double sum = 0;
    for (const Stroke& stroke : strokes)
        sum += std::pow(std::hypot(stroke.from.x - middle.x, stroke.from.y - middle.y), 2) +
               3 * std::pow(std::hypot(stroke.to.x - middle.x, stroke.to.y - middle.y), 2);
    return {strokes.size(), sum};
}

TEST_F(FoundLsystemTest, ClassicsAreFoundFromShuffledLines) {
    const struct {
        const char* name;
        std::string body;
        std::size_t letters;
        unsigned steps;
    } cases[] = {
        {"Koch curve", "angle 60\nsteps 4\naxiom F\nF -> F+F--F+F", 3, 8}, // by a root of its rule
        {"island of a long rule", "angle 90\nsteps 2\naxiom F-F-F-F\nF -> F+FF-FF-F-F+F+FF-F-F+F+FF+FF-F", 22,
         2},
        {"dragon", "angle 90\nsteps 8\naxiom A\nA -> A+B+\nB -> -A-B\ninterpret A -> F\ninterpret B -> F", 5,
         8},
        {"weed", "angle 25.7\nsteps 4\naxiom F\nF -> F[+F]F[-F]F", 6, 4},
        {"bush by nodes", "angle 22.5\nsteps 4\naxiom X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF", 10, 4},
        {"Hilbert's curve", "angle 90\nsteps 4\naxiom L\nL -> +RF-LFL-FR+\nR -> -LF+RFR+FL-", 15, 4},
    };
    for (const auto& [name, body, letters, steps] : cases) {
        SCOPED_TRACE(name);
        const std::string truth = "lsys m {\n" + body + "\n}\n";
        const auto found = find("d.csv", listed(drawing(truth)));
        ASSERT_TRUE(found) << message_;
        EXPECT_EQ(found->redrawn, found->strokes);
        EXPECT_LT(found->farthest, 1e-6);
        EXPECT_LE(found->letters, letters) << found->text;
        EXPECT_EQ(found->steps, steps) << found->text;
        const unsigned deeper = steps == 8 && letters == 3 ? 10 : steps + 1;
        const auto expected = measure(drawing(truth, steps == 8 && letters == 3 ? 5 : steps + 1)),
                   got = measure(drawing(found->text, deeper));
        EXPECT_EQ(got.first, expected.first) << found->text;
        EXPECT_NEAR(got.second, expected.second, 1e-6 * expected.second) << found->text;
    }
}

TEST_F(FoundLsystemTest, LengthsMayShrinkFromStepToStep) {
    const auto found = find("d.csv", listed(drawing("lsys m {\nangle 30\nsteps 6\naxiom A(1)\n"
                                                    "A(s) -> F(s)[+A(s*0.7)][-A(s*0.7)]\n}\n")));
    ASSERT_TRUE(found) << message_;
    EXPECT_EQ(found->redrawn, 63);
    EXPECT_NEAR(found->factor, 0.7, 1e-9);
    EXPECT_EQ(found->steps, 6);
    EXPECT_THAT(found->text, HasSubstr("X(s) -> F(s)["));
    EXPECT_THAT(found->text, HasSubstr("X(s*0.7)"));
}

TEST_F(FoundLsystemTest, DirectionsThatGoRoundAreFollowedFromAnyLine) {
    const std::string truth = "lsys m {\nangle 25.7\nsteps 4\naxiom F\nF -> +FF+F+FF\n}\n";
    const auto found = find("d.csv", listed(drawing(truth)), 2);
    ASSERT_TRUE(found) << message_;
    EXPECT_EQ(found->angle_deg, 25.7);
    EXPECT_EQ(found->letters, 6);
    EXPECT_EQ(found->redrawn, 625);
}

TEST_F(FoundLsystemTest, StartsThatATurnExchangesAreTriedOnce) {
    const auto starts = [&](const std::string& axiom) {
        const Strokes strokes =
            drawing("lsys m {\nangle 90\nsteps 2\naxiom " + axiom + "\nF -> F+F-F-FF+F+F-F\n}\n");
        StageWork work;
        const Control control{{}, {}, &work};
        WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
        std::string problem;
        const auto graphs = stroke_graphs(strokes, 0.01, meter, problem);
        EXPECT_EQ(graphs.size(), 1u) << problem;
        return std::pair(graphs.at(0).starts.size(), graphs.at(0).places.size());
    };
    const auto [island, places] = starts("F+F+F+F");
    EXPECT_GT(places, 100u);
    EXPECT_EQ(4 * island, places);
    EXPECT_EQ(starts("F").first, 1u) << "a half turn takes the curve to itself, but not its directions";
}

TEST_F(FoundLsystemTest, ATurnedDrawingComesBackTurned) {
    const auto found =
        find("d.csv", listed(drawing("lsys m {\nangle 90\nsteps 4\naxiom F\nF -> F+F-F-F+F\n}\n")));
    ASSERT_TRUE(found) << message_;
    EXPECT_THAT(found->text, HasSubstr("axiom +(36.8698976)F")) << "3, 4 and 5";
}

TEST_F(FoundLsystemTest, ToleranceAllowsForNoise) {
    const Strokes drawn = drawing("lsys m {\nangle 60\nsteps 4\naxiom F\nF -> F+F--F+F\n}\n");
    EXPECT_FALSE(find("d.csv", listed(drawn, 0.02), 2));
    options_.tolerance = 0.1;
    const auto found = find("d.csv", listed(drawn, 0.02), 2);
    ASSERT_TRUE(found) << message_;
    EXPECT_EQ(found->redrawn, found->strokes);
    EXPECT_EQ(found->angle_deg, 60);
}

TEST_F(FoundLsystemTest, SvgsAreRead) {
    const std::string head = "<svg xmlns='http://www.w3.org/2000/svg'>";
    const std::string ways[] = {
        "<path d='M0 0h1v1H2V0l1-.0e0z'/>",
        "<line x1='0' y1='0' x2='1' y2='0'/><polyline points='1,0 1,1 2 1 2,0,3,0 0 0'/>",
        "<defs><path id='a' d='M0,0 1,0'/></defs><g transform='translate(1) scale(2)'>"
        "<use href='#a' transform='matrix(.5 0 0 .5 -.5 0)'/></g>"
        "<path d='M 1 0 m 0,0 L1 1 l 1,0 0,-1 L3 0'/><polygon points='3 0 0 0'/>"};
    for (const std::string& way : ways) {
        std::string problem;
        const auto strokes = svg_strokes(head + way + "</svg>", problem);
        ASSERT_TRUE(strokes) << problem << way;
        ASSERT_EQ(strokes->size(), 6) << way;
        EXPECT_NEAR((*strokes)[0].from.x, 0, 1e-12);
        EXPECT_NEAR((*strokes)[0].to.x, 1, 1e-12);
        EXPECT_EQ((*strokes)[1].to, Vec2(1, -1)) << "y points up";
        EXPECT_EQ((*strokes)[4].to, Vec2(3, 0));
    }
}

TEST_F(FoundLsystemTest, BrokenSvgsAreRefused) {
    const struct {
        std::string text, problem;
    } cases[] = {
        {"", "XML is broken"},
        {"<svg><g></svg>", "XML is broken"},
        {"<html/>", "no element 'svg'"},
        {"<svg><path d='M0 0 C1 1 2 2 3 3'/></svg>", "'C' is no straight line"},
        {"<svg><path d='M0'/></svg>", "a number is missing"},
        {"<svg><path d='L'/></svg>", "a number is missing"},
        {"<svg><path d='1 2'/></svg>", "begins without a command"},
        {"<svg><polyline points='1 2 3'/></svg>", "odd number"},
        {"<svg><polyline points='1 2 nan 4'/></svg>", "is broken"},
        {"<svg><g transform='turn(3)'/></svg>", "transform 'turn(3)' is broken"},
        {"<svg><use href='#a'/></svg>", "which is not there"},
        {"<svg><g id='a'><use href='#a'/></g></svg>", "too deep"},
    };
    for (const auto& [text, problem] : cases) {
        std::string said;
        EXPECT_FALSE(svg_strokes(text, said)) << text;
        EXPECT_THAT(said, HasSubstr(problem)) << text;
    }
    std::string bomb = "<svg><defs><line id='a0' x2='1'/>";
    for (int i = 0; i < 40; ++i)
        bomb += fmt::format("<g id='a{1}'><use href='#a{0}'/><use href='#a{0}'/></g>", i, i + 1);
    std::string said;
    EXPECT_FALSE(svg_strokes(bomb + "</defs><use href='#a40'/></svg>", said));
    EXPECT_THAT(said, HasSubstr("it has more than"));
}

TEST_F(FoundLsystemTest, HostileDrawingsAreRefused) {
    const struct {
        std::string text, problem;
    } cases[] = {
        {"", "only 0 lines"},
        {"0 0 1 1\n", "only 1 line"},
        {"0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n", "only 0 lines"},
        {"x\n0 0 nan 1\n", "line 2 has no four numbers"},
        {"0 0 1 1\n1 2 3\n", "line 2 has no four numbers"},
        {"0 0 1e300 1\n0 0 1 1\n0 0 2 1\n0 0 3 1\n1e300 4 -1e300 2\n", "is no L-system's"},
        {"0 0 1 0\n5 5 6 5\n9 9 9 10\n3 3 4 3\n", "do not all hang together"},
        {"0 0 1 0\n1 0 1 1.37\n1 1.37 3 1\n3 1 2 8\n2 8 3 9\n", "is no L-system's"},
        {"0,0,1,0\n1,0,1,1\n1,1,2,1\n2,1,400000002,1\n", "no L-system"}, // 400 million units
        {"0,0,1,O\n0,0,1,0\n", "line 1 has no four numbers"},
        {"# lines\n\nx1,y1,x2,y2\nx1,y1,x2,y2\n", "line 4 has no four numbers"},
    };
    for (const auto& [text, problem] : cases) {
        EXPECT_FALSE(find("d.txt", text, 1)) << text;
        EXPECT_THAT(message_, HasSubstr(problem)) << text;
    }
    std::string copies, noise;
    for (int i = 0; i < 1000; ++i)
        copies += "0 0 1 0\n";
    if (const auto found = find("d.txt", copies, 1)) {
        EXPECT_EQ(found->redrawn, 1000) << "branches that lie on each other";
    }
    std::uint64_t state = 1;
    const auto random = [&] {
        return state = state * 6364136223846793005ull + 1442695040888963407ull, (state >> 33) % 100;
    };
    for (int i = 0; i < 100'000; ++i)
        noise += fmt::format("{} {} {} {}\n", random(), random(), random(), random());
    EXPECT_FALSE(find("d.txt", noise, 1));
    EXPECT_THAT(message_, HasSubstr("is no L-system's"));
    std::string steps; // a random walk on a grid has an angle, and no rules
    for (int i = 0, x = 0, y = 0; i < 100'000; ++i) {
        const int dx = random() % 2 ? 0 : random() % 2 ? 1 : -1, dy = dx ? 0 : random() % 2 ? 1 : -1;
        steps += fmt::format("{} {} {} {}\n", x, y, x + dx, y + dy);
        x += dx, y += dy;
    }
    EXPECT_FALSE(find("d.txt", steps, 1));
    EXPECT_THAT(message_, HasSubstr("no L-system"));
}

TEST_F(FoundLsystemTest, ListsMayBeginWithAMarkCommentsAndNames) {
    const std::string lines = "0 0 1 0\n1 0 1 1\n";
    for (const std::string head :
         {"", "\xEF\xBB\xBF", "# a\n\n", "x1;y1;x2;y2\r\n", "\xEF\xBB\xBF# a\nx y u v\n"}) {
        ASSERT_TRUE(write_text(path("d.csv"), head + lines).ok());
        Compilation compilation;
        const auto strokes = read_drawing(path("d.csv"), {}, {}, compilation);
        ASSERT_TRUE(strokes) << head << compilation.diagnostics.render(compilation.sources);
        EXPECT_EQ(strokes->size(), 2) << head;
    }
}

/// Strokes from one place in these directions, and one that leads there.
Strokes star(std::size_t count, double angle_deg, std::size_t directions) {
    Strokes strokes = {{{-1, 0}, {0, 0}}};
    for (std::size_t i = 0; i < count; ++i) {
        const double rad = angle_deg * static_cast<double>(i % directions) * std::numbers::pi / 180;
        strokes.push_back({{0, 0}, {std::cos(rad), std::sin(rad)}});
    }
    return strokes;
}

TEST(StrokeGraphs, StrokesThatMeetAreFollowedByCountedWork) {
    std::string problem;
    const auto graphs = [&](const Strokes& strokes, StageWork& work, const CancelFlag& cancel = {}) {
        const Control control{cancel, {}, &work};
        WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
        return stroke_graphs(strokes, 0.001, meter, problem);
    };
    // A hundred multiples of the angle are too many for a grid of directions: turns are followed.
    StageWork work;
    const std::vector<StrokeGraph> found = graphs(star(10'000, 1.7, 100), work);
    ASSERT_EQ(found.size(), 1u) << problem;
    EXPECT_NEAR(found[0].angle_deg, 1.7, 1e-9);
    EXPECT_EQ(found[0].directions, 0);
    EXPECT_EQ(found[0].strokes, 10'001u);
    EXPECT_LT(work.seconds(), 1'000'000 * seconds_of_unfolded_module) << "not 10,000 squared";
    // Few of these directions differ by a multiple of one turn.
    const Strokes golden = star(3000, 137.50776, 3000);
    StageWork little(0.02);
    EXPECT_THROW(graphs(golden, little), OutOfWork);
    StageWork much;
    int asked = 0;
    EXPECT_THROW(graphs(golden, much, CancelFlag([&] { return ++asked > 10; })), Cancelled);
    EXPECT_EQ(asked, 11);
}

TEST(StrokeGraphs, ManySizesOfTurnsAreNoAngles) {
    Strokes strokes;
    double degrees = 0;
    Vec2 at(0.0);
    for (int i = 0; i < 1500; ++i) {
        degrees += 1 + 0.1 * i;
        const double rad = degrees * std::numbers::pi / 180;
        const Vec2 to = at + Vec2(std::cos(rad), std::sin(rad));
        strokes.push_back({at, to});
        at = to;
    }
    StageWork work;
    const Control control{{}, {}, &work};
    WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
    std::string problem;
    EXPECT_TRUE(stroke_graphs(strokes, 1e-6, meter, problem).empty());
    EXPECT_THAT(problem, HasSubstr("no angle"));
    EXPECT_EQ(work.seconds(), 0);
}

TEST(StrokeGraphs, APointIsOnePlaceWhateverComesBetween) {
    // The points at -0.006 are within reach of the places at 0 and at -0.012, which comes later.
    const Strokes strokes = {
        {{0, 0}, {-1, 0}}, {{-0.006, -1}, {-0.006, 0}}, {{-1, 0}, {-0.012, 0}}, {{-0.006, 0}, {0.994, 0}}};
    StageWork work;
    const Control control{{}, {}, &work};
    WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
    std::string problem;
    const auto graphs = stroke_graphs(strokes, 0.01, meter, problem);
    ASSERT_FALSE(graphs.empty()) << problem;
    EXPECT_EQ(graphs[0].places.size(), 5u);
    EXPECT_EQ(graphs[0].ways(0).size(), 2u) << "two strokes leave the first place";
}

TEST(Growths, SegmentsOfPartsOfRulesAreBounded) {
    LsysGrowth growth{.letters = 2, .drawn = 2, .steps = 2};
    PartialRules rules;
    rules[0] = {{1, 0}, 1, 0}; // A -> A?
    rules[1] = {{0, 3}, 0, 0}; // B -> BBB
    const SegmentRange edges = segment_range(growth, rules, 1000);
    EXPECT_EQ(edges.least, 4u) << "AA";
    EXPECT_EQ(edges.most, 5u) << "AB: 2 and 3";
    growth = {.letters = 2, .drawn = 1, .straight = 2, .axiom_letter = 1, .steps = 3};
    rules[0] = {{2, 0}, 0, 0}; // F -> FF
    rules[1] = {{1, 0}, 0, 2}; // X -> F??
    const SegmentRange nodes = segment_range(growth, rules, 1000);
    EXPECT_EQ(nodes.least, 12u) << "X -> FXX: 1, 4, 12";
    EXPECT_EQ(nodes.most, 12u);
    EXPECT_EQ(segment_range(growth, rules, 10).most, 10u);
}

TEST(Growths, LengthsOfRulesAreListedOnceEach) {
    StageWork work;
    const Control control{{}, {}, &work};
    WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
    const auto lengths = [&](GrowthKind kind, std::size_t most) {
        std::vector<std::string> all;
        for (const LsysGrowth& growth : growths(64, kind, false, meter))
            if (growth.size() <= most)
                all.push_back(fmt::format("{}x{} {},{} after {}", growth.axiom, growth.axiom_letter,
                                          growth.drawn_in(0), growth.letters > 1 ? growth.drawn_in(1) : 0,
                                          growth.steps));
        return all;
    };
    EXPECT_THAT(lengths(GrowthKind::one_edge, 5),
                ElementsAre("1x0 2,0 after 6", "2x0 2,0 after 5", "1x0 4,0 after 3"));
    std::vector<std::string> two = lengths(GrowthKind::two_edges, 17);
    EXPECT_THAT(two, IsSupersetOf({"1x0 2,2 after 6", "1x0 4,4 after 3", "2x0 2,2 after 5"}));
    std::ranges::sort(two);
    EXPECT_EQ(std::ranges::adjacent_find(two), two.end());
    EXPECT_THAT(two, Not(Contains("1x0 3,3 after 4"))) << "81 segments";
}

TEST(Unfoldings, EachOrderOfGuessesFindsTheSystem) {
    Strokes strokes; // F -> F[+F]F[-F]F with an angle of 30 degrees, after 2 steps
    const auto draw = [&](const auto& self, Vec2 at, double deg, int level) -> Vec2 {
        const Vec2 step(std::cos(deg * std::numbers::pi / 180), std::sin(deg * std::numbers::pi / 180));
        if (level == 0) return strokes.push_back({at, at + step}), at + step;
        for (const double branch : {30.0, -30.0, 0.0}) {
            at = self(self, at, deg, level - 1);
            if (branch != 0) self(self, at, deg + branch, level - 1);
        }
        return at;
    };
    draw(draw, {0, 0}, 90, 2);
    StageWork work;
    const Control control{{}, {}, &work};
    WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
    std::string problem;
    const auto graphs = stroke_graphs(strokes, 0.01, meter, problem);
    ASSERT_EQ(graphs.size(), 1u) << problem;
    const StrokeGraph& graph = graphs[0];
    LsysGrowth growth{.steps = 2};
    growth.rules[0] = {5};
    Unfolding unfolding(graph, meter);
    ASSERT_EQ(graph.starts.size(), 1u);
    for (unsigned order = 0; order < 8; ++order) {
        EXPECT_TRUE(unfolding.find(growth, graph.starts[0], 0, 100'000, order)) << order;
        EXPECT_FALSE(unfolding.find(growth, graph.starts[0], 1, 100'000, order)) << "no stroke begins so";
        EXPECT_FALSE(unfolding.gave_up());
    }
}

TEST_F(FoundLsystemTest, RulesOfLettersThatDrawMayHaveAnyLengths) {
    const auto found = find("d.csv",
                            listed(drawing("lsys m {\nangle 36\nsteps 4\naxiom A\nA -> A+AB-A\nB -> B-A\n"
                                           "interpret A -> F\ninterpret B -> F\n}\n")),
                            2);
    ASSERT_TRUE(found) << message_;
    EXPECT_EQ(found->redrawn, found->strokes);
    EXPECT_LE(found->letters, 7u) << found->text;
}

TEST_F(FoundLsystemTest, ModelsInSpaceAreRefused) {
    EXPECT_FALSE(find("m.lsys", "lsys m {\naxiom F&F\nF -> F^F\nsteps 3\n}\n"));
    EXPECT_THAT(message_, HasSubstr("draws in space"));
}

TEST_F(FoundLsystemTest, AnInterruptionEndsIt) {
    EXPECT_FALSE(find("m.lsys", "lsys m {\nangle 60\nsteps 4\naxiom F\nF -> F+F--F+F\n}\n", 20,
                      CancelFlag([] { return true; })));
    EXPECT_THAT(message_, HasSubstr("interrupted"));
}

TEST_F(FoundLsystemTest, TheBytesAreAlwaysTheSame) {
    const std::string text = listed(drawing("lsys m {\nangle 36\nsteps 4\naxiom F\nF -> F+F[-F]F\n}\n"));
    const auto one = find("d.csv", text), two = find("d.csv", text);
    ASSERT_TRUE(one && two) << message_;
    EXPECT_EQ(one->text, two->text);
}

} // namespace
} // namespace graftal
