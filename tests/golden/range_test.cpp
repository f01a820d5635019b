// Numbers at the ends of what doubles hold, wherever a model or an option takes one: each is a picture, or an
// error that says where the number stands.

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

class Range : public CommandLine {
  protected:
    /// N stands for the number. All are tried by one shell, which prints `status:first line of the message`.
    void
    try_models(const std::string& extension, const std::vector<std::string>& models,
               const std::string& numbers,
               const std::string& commands = "'compile -o out.pov' 'render --engine native -o out.png'") {
        for (std::size_t i = 0; i < models.size(); ++i)
            write(std::to_string(i) + ".template", models[i] + "\n");
        const RunResult result =
            shell("for n in " + numbers + "; do for t in *.template; do m=${t%.template}_$n." + extension +
                  "; sed s/N/$n/g $t > $m\n"
                  "for c in " +
                  commands +
                  "; do\n"
                  "timeout 60 $graftal $c -q --size 32x18 $m 2>err\n"
                  "echo $?:$m:$(head -n 1 err)\nrm -f out.* err; done; done; done");
        expect_placed(result.out,
                      "[01]:[^:]*:|1:([^:]*):\\1:[0-9]+:[0-9]+: error: .*|0:[^:]*:.*(?:warning|note): .*",
                      models.size());
        shell("rm -f *.template *." + extension);
        EXPECT_EQ(files(), "") << "nothing else is left";
    }

    static void expect_placed(const std::string& lines, const std::string& good, std::size_t least) {
        const std::regex pattern(good);
        std::istringstream text(lines);
        std::size_t count = 0;
        for (std::string line; std::getline(text, line); ++count)
            EXPECT_TRUE(std::regex_match(line, pattern)) << line;
        EXPECT_GE(count, least);
    }
};

// The ends of doubles, and beyond the range of models, in sizes and in products of two.
const std::string ends = "5e-324 1e-308 1e-101 1e-60 1e60 1e101 1e308";

TEST_F(Range, OfInstances) {
    const std::string cycle = "object a {\n sphere\n a scale: 0.5 translate: 1,0,0\n a scale: 0.5\n";
    try_models(
        "inst",
        {"object a { sphere scale: N }", "object a { sphere translate: N, -N, 0 }",
         "object a {\n sphere\n cube translate: N,0,0\n}",
         "object a { sphere projection: N,0,0,0, 0,N,0,0, 0,0,0,0 }",
         "object a { sphere rotate: <N,N,0>, N }", "object a {\n sphere\n a scale: 0.5 translate: N,0,0\n}",
         "canonical object b { sphere scale: N }\ncanonical object c { b scale: N }\nobject d { c scale: N }",
         cycle + " terminal: sphere scale: N\n}", cycle + " terminal: sphere translate: N,N,0\n}",
         "object a {\n sphere\n plane translate: 0,-N,0\n}"},
        ends);
}

TEST_F(Range, OfChances) {
    const std::string points = "'compile -o out.pov' 'points --points 1000 -o out.png'";
    try_models("inst",
               {"object a {\n sphere chance: 1\n a scale: 0.5 chance: N\n a scale: 0.5 translate: 1,0,0 "
                "chance: N\n}"},
               ends, points);
    try_models("rifs", {"rifs m {\n codes 2d {\n 0.5 0 0 0.5 0 0 N\n 0.5 0 0 0.5 1 0 0.5\n }\n}"}, ends,
               points);
}

TEST_F(Range, OfScenes) {
    const std::string a = "\nobject a { sphere }";
    try_models("inst",
               {"camera { location: 0,N,5, look_at: 0,0,0 }" + a, "camera { look_at: N,0,0 }" + a,
                "camera { location: 0,0,N, look_at: 0,0,0 }" + a, "camera { orthographic, width: N }" + a,
                "camera { up: N,N,0 }" + a, "camera { angle: N }" + a, "light { sun: N,N,0 }" + a,
                "light { location: N,N,0 }" + a, "ground { height: N }" + a, "ground { height: -N }" + a,
                "object a { scatter: cube  over: disc N  count: 10 }",
                "object a { scatter: cube  over: disc 10  count: 10  size: N }",
                "ground { height: N area: disc 5 }\nobject a { scatter: cube over: ground count: 10 }"},
               ends);
}

TEST_F(Range, OfFunctionSystems) {
    const std::string half = "\n map b { scale 1/2 }";
    try_models("rifs",
               {"rifs m {\n map a { scale 1/2 translate <N,0,0> }" + half + "\n}",
                "rifs m {\n map a { scale N translate <1,0,0> }" + half + "\n}",
                "rifs m {\n codes 2d {\n N 0 0 0.5 0 0\n 0.5 0 0 0.5 1 0\n }\n}",
                "rifs m {\n codes 2d {\n 0.5 0 0 0.5 N N\n 0.5 0 0 0.5 1 0\n }\n}",
                "rifs m {\n codes 2d {\n 0.5 0 0 0.5 0 0 N\n 0.5 0 0 0.5 1 0 0.5\n }\n}",
                "rifs m {\n codes polar {\n N N 30 30 0 0\n 0.5 0.5 0 0 1 0\n }\n}",
                "rifs m {\n map a { scale 1/2 translate <1,0,0> }" + half + "\n terminal sphere scale N\n}",
                "rifs m {\n map a { scale 1/2 translate <1,0,0> }" + half +
                    "\n terminal sphere translate <N,0,0>\n}",
                "rifs m {\n condense cube scale N\n map a { scale N translate <1,0,0> }" + half + "\n}"},
               ends);
}

TEST_F(Range, OfTurtles) {
    std::vector<std::string> models;
    for (const char* statements :
         {"steps 0\n axiom F(N)F(1)", "steps 0\n axiom !(N)F", "steps 0\n width N\n axiom FF",
          "steps 0\n step N\n axiom F+F", "steps 0\n axiom @O(N)F", "steps 0\n axiom F~cube(N,N)",
          "steps 0\n axiom {.f(N).+f(N).+f(1).}", "steps 40\n axiom A(N)\n A(s) -> F(s)A(s*N)",
          "steps 40\n axiom A(1)\n A(s) -> F(s)[+A(s*N)]A(s*0.5)",
          "steps 0\n tropism N,N,0\n axiom T(0.1)F+F", "steps infinite\n axiom A(1)\n A(s) -> F(s)[+A(s*N)]",
          "steps 300\n axiom A\n A -> #(N)FA"})
        models.push_back(std::string("lsys m {\n ") + statements + "\n}");
    try_models("lsys", models, ends);
}

TEST_F(Range, OfOptions) {
    write("m.inst", "let k = 1\nobject a {\n sphere\n a scale: 0.5 translate: k,0,0\n a scale: 0.5\n}\n");
    write("m.rifs", "let k = 1\nrifs m {\n map a { scale 1/2 translate <k,0,0> }\n map b { scale 1/2 }\n}\n");
    write("m.lsys", "lsys m {\n let k = 1\n steps 5\n axiom A(k)\n A(s) -> F(s)[+A(s*0.5)]-A(s*0.7)\n}\n");
    const RunResult result =
        shell("for n in " + ends +
              "; do for m in m.inst m.rifs m.lsys; do\n"
              "for o in '--camera location=0,0,'$n '--camera look_at='$n',0,0' '--camera up='$n','$n',0' "
              "'--camera width='$n '--camera angle='$n --set=k=$n --zoom=$n --error-world=$n; do\n"
              "timeout 60 $graftal compile $m -q --size 32x18 $o -o out.pov 2>err\n"
              "echo $?:$o:$(head -n 1 err); rm -f out.* err; done; done; done");
    // What is wrong on the command line has its option for a place.
    expect_placed(result.out,
                  "0:[^:]*:|0:[^:]*:.*(?:warning|note): .*|2:.*(--[a-z-]+)[= ].*:graftal.*: \\1: .*|"
                  "1:[^:]*:m\\.[a-z]*:[0-9]+:[0-9]+: error: .*",
                  100);
    EXPECT_EQ(files(), "m.inst m.lsys m.rifs");
}

TEST_F(Range, ZoomsGoDeeperThanSizes) {
    write("m.rifs", "rifs m {\n map a { scale 1/2 translate <1,0,0> }\n map b { scale 1/2 }\n"
                    " map c { scale 1/2 translate <0,1,0> }\n}\n");
    for (const char* zoom : {"1e100", "1e300", "1e1000"}) {
        const RunResult result =
            graftal(std::string("compile m.rifs -q --size 32x18 -o a.pov --zoom ") + zoom);
        EXPECT_EQ(result.status, 0) << result.err;
    }
}

TEST_F(Range, MessagesSayWhere) {
    struct Case {
        const char *name, *text, *message;
    };
    const Case cases[] = {
        {"a.inst", "object a { sphere scale: 1e-308 }",
         "a.inst:1:19: error: this scale shrinks to less than 1e-100\n"
         "    object a { sphere scale: 1e-308 }\n"
         "                      ^~~~~~~~~~~~~\n"
         "    hint: the sizes and coordinates of a model lie between 1e-100 and 1e+100, and --zoom looks "
         "closer than that\n"},
        {"b.inst", "canonical object b { sphere scale: 1e-60 }\nobject c { b scale: 1e-60 }",
         "b.inst:2:8: error: the model is smaller than 1e-100 units"},
        {"c.inst",
         "object a {\n sphere\n a scale: 0.5 translate: 1,0,0\n terminal: sphere translate: 1e15,0,0\n}",
         "c.inst:4:12: error: the terminal of 'a' reaches 4.99e+14 times as far as 'a'\n"},
        {"d.inst", "camera { orthographic, width: 1e308 }\nobject a { sphere }",
         "d.inst:1:31: error: 'width' must have a size between 1e-100 and 1e+100, not 1e+308\n"},
        {"e.inst", "ground { height: 1e308 }\nobject a { sphere }",
         "e.inst:1:18: error: 'height' must lie within 1e+100 units of the origin, not 1e+308\n"},
        {"a.rifs", "rifs m {\n codes 2d {\n 1e-200 0 0 1e-200 0 0\n .5 0 0 .5 1 0\n }\n}",
         "a.rifs:3:2: error: this row shrinks to less than 1e-100\n"},
        {"a.lsys", "lsys m {\n steps 0\n width 5e-324\n axiom F\n}",
         "a.lsys:3:8: error: 'width' must lie between 1e-100 and 1e+100, not 5e-324\n"},
    };
    for (const Case& c : cases) {
        write(c.name, std::string(c.text) + "\n");
        const RunResult result = graftal("check " + std::string(c.name));
        EXPECT_EQ(result.status, 1) << c.text;
        EXPECT_THAT(result.err, HasSubstr(c.message)) << c.text;
    }
}

} // namespace
} // namespace graftal
