// Files that nobody would write, in each format: what nests deep, is long, large or endless. Each ends soon
// with an error or a model.

#include <ctime>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/support/control.h"
#include "compiler/support/stage_work.h"
#include "tests/unit/import/imported.h"

namespace graftal::testing {
namespace {

std::string times(int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i)
        all += text;
    return all;
}

/// A text of each format, with a word or a number of ours where it has one.
struct Format {
    const char* file;
    std::string before_name, before_expression, after;
    const char* open;
    const char* close;
    const char* rule; ///< `%` stands for the number of the rule
};

const std::vector<Format>& formats() {
    static const std::vector<Format> all = {
        {"a.l", "", " {\n Angle 4\n Axiom F\n F=F@", "F\n}\n", "[", "]", " F=F+F\n"},
        {"a.ls", "recursion 3\nangle 30\naxiom A\nrule A = F;# ", "\nrule F = F(", ")F\n", "[", "]",
         "rule F = FF\n"},
        {"b.l", "Lsystem: 1\nderivation length: 3\nAxiom: A(1)\n", "(x) --> F(x)\nA(x) --> F(",
         ")A(x/2)\nendlsystem\n", "(", ")", "M%(x) --> M%(x) A(x)\n"},
        {"a.ifs", "", " {\n .5 0 0 .5 0 ", " 1\n .5 0 0 .5 0 0 1\n}\n", "{", "}", " .5 0 0 .5 1 1 1\n"},
        {"a.flame", "<flame name=\"", "\"><xform weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 0 ",
         "\"/></flame>\n", "<a>", "</a>", "<xform weight=\"1\" linear=\"1\" coefs=\".5 0 0 .5 0 0\"/>\n"},
        {"a.es", "a\nrule ", " { box }\nrule a { { x ", " } box }\n", "(", ")",
         "rule a { { x 1 } r% box }\n"},
        {"a.lpy", "Axiom: A(1)\nderivation length: 3\nproduction:\nA(", ") --> F(", ")A(0.5)\nendlsystem\n",
         "(", ")", "M%(x) --> M%(x)A(x)\n"},
        {"a.txt", "Premise: A(1)\nGenerations: 3\nRule 1: A(", ")=F(", ")A\nAngle: 9\n", "(", ")",
         "Rule %: A(x)=FA(x)\n"},
        {"b.txt", "axiom = F", "\nF -> F[+", "]F\nangle = 60\niterations = 3\n", "[", "]", "F -> FF\n"},
        {"a.cfdg", "startshape A\nshape ", " { SQUARE [] }\nshape A { SQUARE [x ", "] }\n", "(", ")",
         "shape M% { A [s 0.5] }\n"},
    };
    return all;
}

/// What ends it, and the processor time that it takes in seconds.
double tried(const char* file, const std::string& text) {
    const std::clock_t begin = std::clock();
    const Imported model(file, text, {.max_modules = 100'000, .max_objects = 1000});
    EXPECT_TRUE(model.graph || model.derivation || model.diagnostics.has_errors()) << file << "\n"
                                                                                   << text.substr(0, 200);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Linear work takes some hundredths of a second.
constexpr double soon_s = 10;

class Hostile : public ::testing::TestWithParam<Format> {
  protected:
    std::string with(const std::string& name, const std::string& expression) const {
        const Format& format = GetParam();
        return format.before_name + name + format.before_expression + expression + format.after;
    }
    void expect_soon(const std::string& text) const { EXPECT_LT(tried(GetParam().file, text), soon_s); }
};

TEST_P(Hostile, WhatNestsDeep) {
    for (const int deep : {200, 100'000}) {
        const std::string open = times(deep, GetParam().open);
        expect_soon(with("B", open + "1" + times(deep, GetParam().close)));
        expect_soon(with("B", open));
        expect_soon(with("B", times(deep, "-") + "1"));
    }
    expect_soon(with("B", "1" + times(700, " + 1")));
    expect_soon(with("B", "1" + times(100'000, " + 1")));
}

TEST_P(Hostile, NumbersWithoutMeasure) {
    for (const char* const number :
         {"1e999", "-1e999", "1e308", "1e-320", "nan", "0", "99999999999999999999999", "-1"})
        expect_soon(with("B", number));
    expect_soon(with("B", times(100'000, "9")));
}

TEST_P(Hostile, LongNamesAndBytesThatAreNoText) {
    expect_soon(with(times(100'000, "B"), "1"));
    const std::string none(1, '\0');
    for (const std::string& bytes : std::vector<std::string>{none, "\xe9\xff", "\xef\xbb\xbf", "\r"}) {
        expect_soon(with("B" + bytes, "1"));
        expect_soon(with("B", "1" + bytes));
        expect_soon(bytes + with("B", "1"));
    }
    std::string lines_of_dos, wide = "\xff\xfe";
    for (const char c : with("B", "1")) {
        lines_of_dos += c == '\n' ? "\r\n" : std::string(1, c);
        wide += std::string{c, '\0'};
    }
    expect_soon(lines_of_dos);
    expect_soon(wide);
}

TEST_P(Hostile, ManyRules) {
    std::string rules;
    for (int i = 0; i < 20'000; ++i)
        for (const char c : std::string(GetParam().rule))
            rules += c == '%' ? std::to_string(i) : std::string(1, c);
    std::string text = with("B", "1");
    // Before the last line, where it closes the model.
    const std::size_t end = text.rfind('\n', text.size() - 2);
    expect_soon(text.insert(end + 1, rules));
    expect_soon(with("B", "1") + rules);
}

/// The stage in which the translation of the first model goes beyond the seconds of work; "": it does not.
std::string stage_out_of_work(const char* file, const std::string& text, double most_seconds) {
    StageWork work(most_seconds);
    Control control;
    control.work = &work;
    SourceMap sources;
    Diagnostics diagnostics;
    try {
        WorkMeter meter(control, "import", 1000);
        own_text(sources.add(file, text), "", sources, diagnostics, {}, &meter);
    } catch (const OutOfWork& fault) {
        return fault.stage();
    }
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.render(sources);
    return "";
}

TEST_P(Hostile, ReadsWithinTheWorkOfTheCommand) {
    const std::string text = with("B", "1") + times(100'000, "\n"); // 15 ms by the price of a byte
    EXPECT_EQ(stage_out_of_work(GetParam().file, text, 0.01), "import");
    EXPECT_EQ(stage_out_of_work(GetParam().file, text, 10), "");
}

TEST(HostileGrammar, IsComputedWithinTheWorkOfTheCommand) {
    // A vector as a parameter has no word of ours.
    const std::string turns = "startshape A\nshape A { loop i = 20000 [x 1] B((i, i)) [] }\n"
                              "shape B(vector2 v) { SQUARE [x (v[0])] }\n";
    EXPECT_EQ(stage_out_of_work("a.cfdg", turns, 0.02), "import");
    EXPECT_EQ(stage_out_of_work("a.cfdg", turns, 10), "");
    // A function that calls itself doubles the expressions with each step.
    const std::string calls = "startshape A\nf(n) = if(n < 1, 1, f(n - 1) + f(n - 1))\n"
                              "shape A { SQUARE [s (f(30))] }\n";
    EXPECT_EQ(stage_out_of_work("a.cfdg", calls, 0.1), "import");
}

INSTANTIATE_TEST_SUITE_P(Import, Hostile, ::testing::ValuesIn(formats()), [](const auto& format) {
    std::string name;
    for (const char c : std::string(format.param.file))
        name += c == '.' ? '_' : c;
    return name;
});

} // namespace
} // namespace graftal::testing
