#include "compiler/zoom/address.h"

#include <gtest/gtest.h>

#include "compiler/support/stage_price.h"

namespace graftal {
namespace {

std::string text_of(const std::vector<AddressStep>& steps) {
    std::string text;
    for (const AddressStep& step : steps) {
        text += text.empty() ? "" : " ";
        text += step.name + (step.index ? "#" + std::to_string(step.index) : "");
    }
    return text;
}

TEST(Address, IsWrittenOut) {
    struct Case {
        const char* text;
        const char* steps;
        const char* cycle;
    };
    const Case cases[] = {
        {"up", "up", ""},
        {"up.left.(right.up)*2", "up left right up right up", ""},
        {"up*3", "up up up", ""},
        {"up*0.left", "left", ""},
        {"(up)*", "", "up"},
        {"a.(b.c)*", "a", "b c"},
        {"a.b*", "a", "b"},
        {"((a.b)*2.c)*2", "a b a b c a b a b c", ""},
        {"X#2.#3", "X#2 #3", ""},
        {"tip(3).trunk(1,2)", "tip(3) trunk(1,2)", ""},
        {"\"leaf.llr\".x", "leaf.llr x", ""},
        {"(a)", "a", ""},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.text);
        std::string problem;
        const auto address = parse_address(c.text, problem);
        ASSERT_TRUE(address) << problem;
        EXPECT_EQ(text_of(address->steps), c.steps);
        EXPECT_EQ(text_of(address->cycle), c.cycle);
    }
}

TEST(Address, SaysWhatIsWrong) {
    struct Case {
        std::string text;
        const char* problem;
    };
    const Case cases[] = {
        {"", "expected a name"},
        {"a.", "expected a name"},
        {".a", "expected a name, not '.'"},
        {"a..b", "expected a name, not '.'"},
        {"(a", "')' expected"},
        {"a)", "unexpected ')'"},
        {"a#0", "expected a number, 1 or more, after '#'"},
        {"a#x", "expected a number, 1 or more, after '#'"},
        {"(a)*.b", "no step can follow an endless repetition"},
        {"((a)*)*3", "only the end of an address can repeat forever"},
        {"\"a", "the closing quote is missing"},
        {"\"\"", "an empty name"},
        {"a*9999999", "more than 1000000 steps"},
        {"a*99999999999", "more than 1000000 steps"},
        {"((((a)*1000)*1000)*1000)*1000", "more than 1000000 steps"},
        {std::string(1000, '('), "the brackets nest too deep"},
    };
    for (const Case& c : cases) {
        std::string problem;
        EXPECT_FALSE(parse_address(c.text, problem)) << c.text;
        EXPECT_EQ(problem.substr(0, problem.find(" at character")), c.problem) << c.text;
    }
}

/// a { b c c }, b { a }, c { sphere }, deep { one } in front of an import's `leaf.vein`, `tip(2)` and a
/// variant.
Graph model() {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const auto add = [&](const char* name) { return graph.add({name, {}, {}, {}, {}}); };
    const ObjectId root = add("root"), a = add("a"), b = add("b"), c = add("c"), vein = add("leaf.vein"),
                   tip = add("tip(2)"), arm = add("arm.v12.hue3(4)");
    const auto place = [&](ObjectId parent, ObjectId master) {
        graph.objects[parent].instances.push_back({master, Affine::scale(Vec3(0.5)), {}, {}, {}});
    };
    place(root, a);
    place(a, b);
    place(a, c);
    place(a, c);
    place(a, vein);
    place(a, tip);
    place(a, arm);
    place(b, a);
    place(c, sphere);
    place(vein, sphere);
    place(tip, sphere);
    place(arm, sphere);
    graph.root = root;
    return graph;
}

struct Found {
    std::string path; ///< instance numbers
    std::string cycle;
    std::string error;
};

Found find(const std::string& text) {
    std::string problem;
    const auto address = parse_address(text, problem);
    EXPECT_TRUE(address) << problem;
    Diagnostics diagnostics;
    Found found;
    const auto path = find_path(model(), *address, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics.all())
        found.error += diagnostic.message + "; " + diagnostic.hint;
    if (!path) return found;
    for (const GraphStep& step : path->steps)
        found.path += std::to_string(step.instance);
    for (const GraphStep& step : path->cycle)
        found.cycle += std::to_string(step.instance);
    return found;
}

TEST(Address, IsFoundInAGraph) {
    EXPECT_EQ(find("a.b.a.b").path, "0000");
    EXPECT_EQ(find("a.c#2").path, "02");
    EXPECT_EQ(find("#1.#3").path, "02");
    EXPECT_EQ(find("a.vein").path, "03") << "the last part of an imported name";
    EXPECT_EQ(find("a.\"leaf.vein\"").path, "03");
    EXPECT_EQ(find("a.tip").path, "04") << "without its arguments";
    EXPECT_EQ(find("a.tip(2)").path, "04");
    for (const char* const arm : {"a.arm", "a.arm(4)", "a.\"arm.v12.hue3(4)\""})
        EXPECT_EQ(find(arm).path, "05") << arm;
    EXPECT_EQ(find("b").path, "00") << "through an object of one instance";
    EXPECT_EQ(find("c#1").path, "01");
    EXPECT_EQ(find("c#1.sphere").path, "010");
}

TEST(Address, RepeatsForEver) {
    const Found found = find("a.(b.a)*");
    EXPECT_EQ(found.path, "0");
    EXPECT_EQ(found.cycle, "00");
    const Found ends = find("a.(c#1.sphere)*");
    EXPECT_EQ(ends.path, "010") << "the graph ends there";
    EXPECT_EQ(ends.cycle, "");
}

TEST(Address, NotFoundSaysWhy) {
    EXPECT_EQ(find("a.c").error,
              "the address is ambiguous: 'a' has 2 instances of 'c'; say which: c#1 to c#2");
    EXPECT_EQ(find("a.d").error, "the address does not exist: 'a' has no part 'd'; its parts are b, c, "
                                 "leaf.vein, tip(2), arm.v12.hue3(4)");
    EXPECT_EQ(find("a.c#3").error, "the address does not exist: 'a' has no part 'c#3'; it has 2 that fit");
    EXPECT_EQ(find("a.c#1.sphere.x").error,
              "the address does not exist: 'sphere' has no part 'x'; it is a primitive and has no parts");
}

/// Objects that each place the next, and the last of them the first.
Graph ring(ObjectId count) {
    Graph graph;
    for (ObjectId id = 0; id < count; ++id) {
        Object object;
        object.name = "o" + std::to_string(id);
        object.instances.push_back({(id + 1) % count, Affine::scale(Vec3(0.5)), {}, {}, {}});
        graph.add(std::move(object));
    }
    return graph;
}

TEST(Address, AnEndlessPathIsOfLimitedLength) {
    struct Case {
        ObjectId ring;
        const char* address;
        std::size_t cycle; // 0: refused
    };
    for (const Case& c : {Case{11, "((#1)*1000)*", 11'000}, Case{1, "((#1)*1000000)*", 1'000'000},
                          Case{1009, "((#1)*100000)*", 0}}) {
        std::string problem;
        const auto address = parse_address(c.address, problem);
        ASSERT_TRUE(address) << problem;
        StageWork work;
        Control control;
        control.work = &work;
        Diagnostics diagnostics;
        const auto path = find_path(ring(c.ring), *address, diagnostics, control);
        EXPECT_EQ(path.has_value(), c.cycle > 0) << c.address;
        if (path)
            EXPECT_EQ(path->cycle.size(), c.cycle) << c.address;
        else
            EXPECT_EQ(diagnostics.all()[0].message, "the address leads through more than 1000000 instances");
        EXPECT_LE(work.seconds(), 2.1e6 * StagePrice::name) << c.address;
    }
}

TEST(Address, AmbiguousInALaterRoundIsAnError) {
    Graph graph = ring(1);
    graph.objects[0].instances.push_back(graph.objects[0].instances[0]);
    Object root;
    root.name = "root";
    root.instances.push_back({0, {}, {}, {}, {}});
    graph.root = graph.add(std::move(root));
    std::string problem;
    Diagnostics diagnostics;
    EXPECT_FALSE(find_path(graph, *parse_address("(o0)*", problem), diagnostics));
    EXPECT_EQ(diagnostics.error_count(), 1u);
}

} // namespace
} // namespace graftal
