#include "runtime/inverse/lsystem/equal_parts.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/support/stage_work.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/inverse/lsystem/grammar_search.h"

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const char* const four_rules = "angle 30\nsteps 4\naxiom X\nF -> FF\n"
                               "X -> -F+Y[+Z]-ZX+\nY -> F+ZZ\nZ -> F-Z[-X]F\n";

class EqualPartsTest : public ::testing::Test {
  protected:
    StrokeGraph graph_of(const std::string& body) {
        Session session("m.lsys", "lsys m {\n" + body + "}\n");
        Compilation compilation;
        const std::optional<Strokes> strokes = model_strokes(session, {}, compilation);
        EXPECT_TRUE(strokes) << compilation.diagnostics.render(compilation.sources);
        std::string problem;
        return stroke_graphs(strokes.value(), 0.01, meter_, problem).at(0);
    }

    /// All rules that are found, and whether some turns make them draw the tree.
    std::vector<std::string> rules_of(const StrokeGraph& graph, const LsysGrowth& growth) {
        std::vector<std::string> found;
        Unfolding unfolding(graph, meter_);
        EqualParts(graph, meter_).find(growth, [&](const BareRules& rules) {
            std::string& text = found.emplace_back();
            for (std::size_t rule = 1; rule < growth.letters; ++rule, text += ' ')
                for (const std::int8_t symbol : rules[rule])
                    text += symbol == bare_open    ? '['
                            : symbol == bare_close ? ']'
                                                   : "FXYZ"[static_cast<std::size_t>(symbol)];
            for (const StrokeWay& way : graph.ways(graph.starts.at(0)))
                text +=
                    unfolding.find(growth, graph.starts[0], way.direction, 3000, 0, &rules) ? "draws" : "";
            return false;
        });
        return found;
    }

    StageWork work_{5};
    Control control_{{}, {}, &work_};
    WorkMeter meter_{control_, "search", 4096, seconds_of_unfolded_module};
};

TEST_F(EqualPartsTest, NumbersTellTheOrderOfLettersInATree) {
    const StrokeGraph graph = graph_of(four_rules);
    ASSERT_EQ(graph.strokes, 104u);
    LsysGrowth growth{.letters = 4, .drawn = 1, .straight = 2, .axiom_letter = 1, .steps = 4};
    growth.rules = {{{2}, {1, 1, 1, 2}, {1, 0, 0, 2}, {2, 1, 0, 1}}};
    EXPECT_THAT(rules_of(graph, growth), ElementsAre("FY[ZX]Z FZZ FZ[X]F draws", "FY[Z]ZX FZZ FZ[X]F draws"))
        << "the axis may end in X or in the second Z";
    growth.rules = {{{2}, {3, 1, 0, 2}, {1, 0, 0, 2}, {2, 1, 0, 1}}};
    EXPECT_THAT(rules_of(graph, growth), IsEmpty()) << "another number of segments";
    growth.rules = {{{2}, {1, 1, 1, 2}, {1, 1, 0, 1}, {2, 1, 0, 1}}};
    EXPECT_THAT(rules_of(graph, growth), IsEmpty()) << "104 segments, too, whose parts would not be equal";
}

TEST_F(EqualPartsTest, FourRulesOfATreeAreFound) {
    const std::optional<FoundGrammar> found = find_grammar(graph_of(four_rules), meter_, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->growth.steps, 4u);
    EXPECT_THAT(found->growth.rules, ElementsAre(ElementsAre(2, 0, 0, 0), ElementsAre(1, 1, 1, 2),
                                                 ElementsAre(1, 0, 0, 2), ElementsAre(2, 1, 0, 1)));
}

TEST_F(EqualPartsTest, TreesReachEachPlaceOnce) {
    const auto is_tree = [&](const std::string& word) {
        return EqualParts(graph_of("angle 90\nsteps 0\naxiom " + word + "\n"), meter_).is_tree();
    };
    EXPECT_TRUE(is_tree("FF[+F]F"));
    EXPECT_TRUE(is_tree("F+F-FF")) << "a path";
    EXPECT_FALSE(is_tree("F+F+F+F")) << "back to the start";
    EXPECT_FALSE(is_tree("FF[+F][+F]F")) << "a stroke twice";
    EXPECT_FALSE(is_tree("F[+F-F]F+F")) << "a place by two ways";
}

} // namespace
} // namespace graftal
