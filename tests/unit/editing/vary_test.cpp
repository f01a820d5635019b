#include "compiler/editing/vary.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace graftal {
namespace {

const std::string plant = "let lean = 25, ratio = 0.7\n"
                          "lsys plant {\n"
                          "  angle lean\n"
                          "  axiom A(1)\n"
                          "  A(l) -> F(l)[+A(l*ratio)][-(30)A(l*0.6)]\n"
                          "}\n";
const std::string gasket =
    "rifs g {\n  map a { scale 1/2 translate 0, 0.5 }\n  map b { scale 1/2 rotate z, 30 }\n}\n";

std::vector<ModelParameter> parameters() {
    using Kind = ModelParameter::Kind;
    return {{Kind::let, "lean", 25, {}, true},
            {Kind::let, "ratio", 0.7, {}, true},
            {Kind::inner, "bend", 0.9, {}, true},
            {Kind::setting, "steps", 7, {}, true}};
}

TEST(Vary, SeedsAreDifferentAndTheSameForOneSeed) {
    const Document document("m.lsys", plant);
    const auto children = vary(document, {}, {.kind = VariationKind::seed, .count = 8, .seed = 3});
    ASSERT_EQ(children.size(), 8u);
    const auto again = vary(document, {}, {.kind = VariationKind::seed, .count = 8, .seed = 3});
    const auto others = vary(document, {}, {.kind = VariationKind::seed, .count = 8, .seed = 4});
    for (std::size_t i = 0; i < children.size(); ++i) {
        EXPECT_EQ(children[i].seed, again[i].seed);
        EXPECT_NE(children[i].seed, others[i].seed);
        EXPECT_EQ(children[i].says, "seed " + std::to_string(*children[i].seed));
    }
}

TEST(Vary, ParametersStayWithinTheirRanges) {
    const Document document("m.lsys", plant);
    const auto children = vary(document, parameters(),
                               {.kind = VariationKind::parameters, .count = 50, .spread = 1, .seed = 1});
    ASSERT_EQ(children.size(), 50u);
    for (const Variation& child : children) {
        EXPECT_FALSE(child.set.empty());
        EXPECT_FALSE(child.set.contains("steps"));
        for (const ModelParameter& parameter : parameters()) {
            const auto value = child.set.find(parameter.name);
            if (value == child.set.end()) continue;
            EXPECT_NE(value->second, parameter.value);
            EXPECT_GE(value->second, range_of(parameter).least);
            EXPECT_LE(value->second, range_of(parameter).most);
            EXPECT_NE(child.says.find(parameter.name), std::string::npos) << child.says;
        }
        if (const auto lean = child.set.find("lean"); lean != child.set.end()) {
            EXPECT_EQ(lean->second, std::round(lean->second)); // as its text is whole
        }
    }
    // A small spread stays near.
    for (const Variation& child :
         vary(document, parameters(), {.kind = VariationKind::parameters, .count = 9, .spread = 0.1}))
        if (const auto ratio = child.set.find("ratio"); ratio != child.set.end()) {
            EXPECT_NEAR(ratio->second, 0.7, 0.07 + 1e-9);
        }
}

TEST(Vary, RulesAreReadAndSayWhatChanged) {
    for (const auto& [name, text] :
         {std::pair<std::string, std::string>{"m.lsys", plant}, {"m.rifs", gasket}}) {
        const Document document(name, text);
        const VariationOptions options{.kind = VariationKind::rules, .count = 9, .spread = 0.5, .seed = 2};
        const auto children = vary(document, {}, options);
        EXPECT_EQ(children.size(), 9u) << name;
        const auto again = vary(document, {}, options);
        for (std::size_t i = 0; i < children.size(); ++i) {
            ASSERT_TRUE(children[i].text);
            EXPECT_EQ(children[i].text, again[i].text);
            EXPECT_NE(*children[i].text, text);
            EXPECT_FALSE(Document(name, *children[i].text).findings().has_errors()) << *children[i].text;
            EXPECT_TRUE(children[i].says.starts_with("line ")) << children[i].says;
            const auto brackets = [](const std::string& s) { return std::ranges::count(s, '['); };
            EXPECT_EQ(brackets(*children[i].text), brackets(text));
            if (name == "m.rifs") {
                EXPECT_TRUE(check_contraction(name, *children[i].text, {}).contracts);
            }
        }
    }
}

TEST(Vary, NothingWhereNothingCanVary) {
    EXPECT_TRUE(vary(Document("m.inst", "object a { cube }"), {}, {.kind = VariationKind::rules}).empty());
    EXPECT_TRUE(
        vary(Document("m.inst", "object a { cube }"), {}, {.kind = VariationKind::parameters}).empty());
}

} // namespace
} // namespace graftal
