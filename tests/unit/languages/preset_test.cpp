// Presets: values under one name, in all languages.

#include <string>

#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/languages/lower.h"

namespace graftal {
namespace {

struct Lowered {
    std::string printed, messages;
};

Lowered lower(const std::string& name, const std::string& text, const std::string& preset,
              std::map<std::string, double, std::less<>> set = {}) {
    LowerOptions options;
    options.preset = preset;
    options.set = std::move(set);
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText model = lower_text(name, text, options, sources, diagnostics);
    return {model.graph ? print(*model.graph) : "", diagnostics.render(sources)};
}

constexpr const char* presets = "preset small { size = 1/4 }\npreset large { size = 3, lean: 40 }\n"
                                "let size = 1, lean = 0\n";

const std::pair<std::string, std::string> models[] = {
    {"m.inst", "object a { union: cube\n scale: size\n rotate: z, lean }\n"},
    {"m.rifs", "rifs a { map m { scale size/8  rotate z, lean } map n { scale 1/2 } }\n"},
    {"m.lsys", "lsys a {\n  steps 0\n  axiom +(lean)F(size)\n}\n"},
};

TEST(Presets, AreWhatSetSets) {
    for (const auto& [name, text] : models) {
        const std::string whole = presets + text;
        EXPECT_EQ(lower(name, whole, "").messages, "") << name;
        EXPECT_EQ(lower(name, whole, "small").printed, lower(name, whole, "", {{"size", 0.25}}).printed);
        EXPECT_EQ(lower(name, whole, "large").printed,
                  lower(name, whole, "", {{"size", 3}, {"lean", 40}}).printed);
        EXPECT_NE(lower(name, whole, "small").printed, lower(name, whole, "").printed) << name;
        EXPECT_EQ(lower(name, whole, "large", {{"lean", 10}}).printed,
                  lower(name, whole, "", {{"size", 3}, {"lean", 10}}).printed);
    }
}

TEST(Presets, SayWhatIsWrong) {
    for (const auto& [name, text] : models) {
        EXPECT_NE(lower(name, presets + text, "lage").messages.find("the model has no preset 'lage'"),
                  std::string::npos);
        EXPECT_NE(lower(name, presets + text, "lage").messages.find("did you mean 'large'?"),
                  std::string::npos);
        EXPECT_NE(lower(name, text + "let size = 1, lean = 0\n", "x")
                      .messages.find("'preset x { NAME = NUMBER }' defines one"),
                  std::string::npos);
        const std::string unknown = std::string("preset p { sise = 2 }\n") + presets + text;
        EXPECT_NE(lower(name, unknown, "p").messages.find("no 'let sise' to set"), std::string::npos);
        EXPECT_NE(
            lower(name, std::string(presets) + presets + text, "").messages.find("duplicate preset 'small'"),
            std::string::npos);
        EXPECT_NE(lower(name, std::string("preset p { size 2 }\n") + presets + text, "")
                      .messages.find("expected '=' after 'size'"),
                  std::string::npos);
    }
}

TEST(Presets, AreCheckedWhetherTheyAreTakenOrNot) {
    for (const auto& [name, text] : models) {
        const std::string unknown = std::string("preset p { sise = 2 }\n") + presets + text;
        for (const char* const taken : {"", "small", "p"}) {
            const std::string messages = lower(name, unknown, taken).messages;
            EXPECT_NE(messages.find(name + ":1:12: error: preset 'p': the model has no 'let sise' to set"),
                      std::string::npos)
                << name << ", " << taken << ": " << messages;
            EXPECT_EQ(messages.find("no 'let sise'"), messages.rfind("no 'let sise'"))
                << name << ", " << taken;
        }
        const std::string lost = std::string("preset p { size = lean }\n") + presets + text;
        EXPECT_NE(lower(name, lost, "").messages, "") << name;
    }
}

/// The word is young: parts of older models may have it for a name.
TEST(Presets, IsANameElsewhere) {
    EXPECT_EQ(
        lower("m.inst", "canonical object preset { union: cube }\nobject b { union: preset }\n", "").messages,
        "");
}

} // namespace
} // namespace graftal
