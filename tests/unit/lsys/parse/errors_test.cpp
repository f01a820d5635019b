#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/lsys/texts.h"

namespace graftal {
namespace {

using testing::parse;
using testing::ParsedLsys;
using Cases = std::vector<std::pair<std::string, std::string>>; // text, what is said

std::string errors(const std::string& text) {
    ParsedLsys parsed;
    parse(text, parsed);
    return parsed.diagnostics.render(parsed.sources);
}

/// Of statements from line 3 on.
std::string statement_errors(const std::string& statements) {
    return errors("lsys a {\naxiom F\n" + statements + "\n}\n");
}

TEST(LsysErrors, brackets) {
    const Cases cases = {
        {R"e(A -> F[+F
B -> F]
C -> F[+F}
D -> F]])e",
         R"e(m.lsys:3:7: error: this '[' is not closed
    A -> F[+F
          ^
m.lsys:4:7: error: ']' without '['
    B -> F]
          ^
m.lsys:5:7: error: this '[' is not closed
    C -> F[+F}
          ^
m.lsys:6:7: error: ']' without '['
    D -> F]]
          ^
m.lsys:5:10: error: '}' without '{'
    C -> F[+F}
             ^
    hint: the '}' of a block begins a line
)e"},
        {R"e(A -> {.F.}})e", R"e(m.lsys:3:11: error: '}' without '{'
    A -> {.F.}}
              ^
    hint: the '}' of a block begins a line
)e"},
        {R"e(F -> F[(2)])e", R"e(m.lsys:3:8: error: expected a module, found '('
    F -> F[(2)]
           ^
    hint: write parameters after their module: F(1)
)e"},
        {R"e(A(x -> F(x)
B -> F)e",
         R"e(m.lsys:3:2: error: this '(' is not closed
    A(x -> F(x)
     ^
)e"},
        {R"e(A -> F(x
B -> F()e",
         R"e(m.lsys:3:7: error: this '(' is not closed
    A -> F(x
          ^
m.lsys:4:7: error: this '(' is not closed
    B -> F(
          ^
)e"},
    };
    for (const auto& [text, said] : cases)
        EXPECT_EQ(statement_errors(text), said) << text;
}

TEST(LsysErrors, leftSides) {
    const Cases cases = {
        {R"e([ -> F)e", R"e(m.lsys:3:3: error: this successor closes 0 and opens 0 of the word's branches
    [ -> F
      ^~
    hint: the predecessor closes 0 and opens 1, and the word must stay balanced
)e"},
        {R"e(-> F)e", R"e(m.lsys:3:1: error: expected the module that is rewritten, found '->'
    -> F
    ^~
    hint: write a production as A -> B
)e"},
        {R"e(p1: -> F)e", R"e(m.lsys:3:5: error: expected the module that is rewritten, found '->'
    p1: -> F
        ^~
    hint: write a production as A -> B
)e"},
        {R"e(A < -> F)e", R"e(m.lsys:3:5: error: expected the module that is rewritten, found '->'
    A < -> F
        ^~
    hint: write a production as A -> B
)e"},
        {R"e([A] < B > [C -> F)e", R"e(m.lsys:3:1: error: a left context has no brackets
    [A] < B > [C -> F
    ^
    hint: graftal matches it along the way to the root, past all side branches
)e"},
        {R"e(A < B < C -> F)e", R"e(m.lsys:3:7: error: expected '->', found '<'
    A < B < C -> F
          ^
    hint: write the left context first, and only once: A < B > C -> ...
)e"},
        {R"e(A > B < C -> F)e", R"e(m.lsys:3:7: error: expected '->', found '<'
    A > B < C -> F
          ^
    hint: write the left context first, and only once: A < B > C -> ...
)e"},
        {R"e(Bud -> F)e", R"e(m.lsys:3:1: error: 'Bud' is read letter by letter, as modules side by side
    Bud -> F
    ^~~
    hint: declare longer names: modules Bud; or write blanks between the modules
)e"},
        {R"e(Bud : n > 1 -> F)e",
         R"e(m.lsys:3:1: error: 'Bud' is read letter by letter, as modules side by side
    Bud : n > 1 -> F
    ^~~
    hint: declare longer names: modules Bud; or write blanks between the modules
)e"},
        {R"e(interpret A B -> F)e",
         R"e(m.lsys:3:11: error: a production of 'interpret' or 'decompose' rewrites one module, not 2
    interpret A B -> F
              ^~~
    hint: rewrite several modules at once in a derivation step
)e"},
        {R"e(A -(0.33)-> F)e", R"e(m.lsys:3:5: error: expected the name of a parameter, found '0.33'
    A -(0.33)-> F
        ^~~~
    hint: write a probability after the successor: A -> B : 0.5
)e"},
        {R"e(A(0) -> F)e", R"e(m.lsys:3:3: error: expected the name of a parameter, found '0'
    A(0) -> F
      ^
    hint: use a condition to distinguish values: A(n) : n == 0 -> ...
)e"},
        {R"e(A(x) < B(x) -> F)e", R"e(m.lsys:3:10: error: duplicate parameter 'x'
    A(x) < B(x) -> F
             ^
m.lsys:3:3: note: first named here
    A(x) < B(x) -> F
      ^
)e"},
        {R"e(A(x, x) -> F)e", R"e(m.lsys:3:6: error: duplicate parameter 'x'
    A(x, x) -> F
         ^
m.lsys:3:3: note: first named here
    A(x, x) -> F
      ^
)e"},
        {R"e(A() -> F())e", R"e(m.lsys:3:2: error: these parentheses contain no parameter
    A() -> F()
     ^~
    hint: write a module without parameters as 'A'
)e"},
        {R"e(A(x) : x = 1 -> F)e", R"e(m.lsys:3:10: error: expected '->', found '='
    A(x) : x = 1 -> F
             ^
    hint: write equality as ==
)e"},
        {R"e(A(x) : -> F)e", R"e(m.lsys:3:8: error: expected a number, found '->'
    A(x) : -> F
           ^
)e"},
        {R"e(A(x) : x > -> F : 1 2)e", R"e(m.lsys:3:11: error: expected a number, found '->'
    A(x) : x > -> F : 1 2
              ^
)e"},
        {R"e(A(x) : (x > 1 -> F)e", R"e(m.lsys:3:14: error: expected ')', found '->'
    A(x) : (x > 1 -> F
                 ^
m.lsys:3:8: note: to close this '('
    A(x) : (x > 1 -> F
           ^
)e"},
        {R"e(~leaf -> F)e", R"e(m.lsys:3:1: error: only a successor may contain a model
    ~leaf -> F
    ^~~~~
    hint: rewrite a module, and let its successor place the model
)e"},
        {R"e(A(l(2)) -> F)e", R"e(m.lsys:3:4: error: expected ',' or ')', found '('
    A(l(2)) -> F
       ^
)e"},
    };
    for (const auto& [text, said] : cases)
        EXPECT_EQ(statement_errors(text), said) << text;
}

TEST(LsysErrors, successors) {
    const Cases cases = {
        {R"e(A ->(0.33) F)e", R"e(m.lsys:3:5: error: expected a module, found '('
    A ->(0.33) F
        ^
    hint: write a probability after the successor: A -> B : 0.5
)e"},
        {R"e(A -> B -> C)e", R"e(m.lsys:3:8: error: expected a module or the end of the line, found '->'
    A -> B -> C
           ^~
    hint: write every production on its own line
)e"},
        {R"e(A -> F*2)e", R"e(m.lsys:3:7: error: expected a module or the end of the line, found '*'
    A -> F*2
          ^
    hint: write '*' alone, for the empty string
)e"},
        {R"e(A -> F < G)e", R"e(m.lsys:3:8: error: expected a module or the end of the line, found '<'
    A -> F < G
           ^
    hint: write contexts before the arrow: A < B > C -> ...
)e"},
        {R"e(A -> F?G @1 ~ ~3 F))e", R"e(m.lsys:3:7: error: expected a module, found '?'
    A -> F?G @1 ~ ~3 F)
          ^
m.lsys:3:10: error: expected a module, found '@'
    A -> F?G @1 ~ ~3 F)
             ^
    hint: write a directive as '@' and a letter: @o
m.lsys:3:15: error: expected the name of a model after '~', found '~'
    A -> F?G @1 ~ ~3 F)
                  ^
    hint: use leaf = "leaf.rifs" names a model, ~leaf places it
m.lsys:3:16: error: expected the name of a model after '~', found '3'
    A -> F?G @1 ~ ~3 F)
                   ^
    hint: use leaf = "leaf.rifs" names a model, ~leaf places it
m.lsys:3:19: error: expected a module, found ')'
    A -> F?G @1 ~ ~3 F)
                      ^
    hint: this ')' closes nothing
)e"},
        {R"e(A -> ωF)e", R"e(m.lsys:3:6: error: expected a module, found 'ω'
    A -> ωF
         ^
)e"},
        {R"e(A -> F // the branch
A -> F //[//A] // )e",
         R"e(m.lsys:3:8: warning: in a string '//' is two turns, no comment
    A -> F // the branch
           ^~
    hint: begin comments in strings with '#', or write the turns without spaces around them
m.lsys:4:16: warning: in a string '//' is two turns, no comment
    A -> F //[//A] // 
                   ^~
    hint: begin comments in strings with '#', or write the turns without spaces around them
)e"},
        {R"e(A -> F(1 + [2))e", R"e(m.lsys:3:12: error: expected a number, found '['
    A -> F(1 + [2)
               ^
)e"},
    };
    for (const auto& [text, said] : cases)
        EXPECT_EQ(statement_errors(text), said) << text;
}

TEST(LsysErrors, statements) {
    const Cases cases = {
        {R"e(angel 60)e", R"e(m.lsys:3:1: error: unknown statement 'angel'
    angel 60
    ^~~~~
    hint: did you mean 'angle'? known here: let, inner, angle, step, width, steps, seed, ignore, consider, tropism, colors, modules, thickness, thinnest, taper, skin, bending, torque, environment, table, precedence, variable, array, start, end, axiom, interpret, decompose
)e"},
        {R"e(F = F+F)e", R"e(m.lsys:3:3: error: expected '->', found '='
    F = F+F
      ^
    hint: write a production as A -> B, and a named number as 'let a = 3'
)e"},
        {R"e(F → F)e", R"e(m.lsys:3:3: error: expected '->', found '→'
    F → F
      ^
    hint: write a production as A -> B
)e"},
        {R"e(angle
angle: 60 70
angle 5
angle 6)e",
         R"e(m.lsys:3:6: error: expected a number, found the end of the line
    angle
         ^
m.lsys:4:11: error: expected the end of the line, found '70'
    angle: 60 70
              ^~
    hint: every statement stands on its own line
m.lsys:6:1: error: duplicate 'angle'
    angle 6
    ^~~~~
m.lsys:5:1: note: first given here
    angle 5
    ^~~~~
)e"},
        {R"e(steps infinte
steps 4
steps infinite)e",
         R"e(m.lsys:4:1: error: duplicate 'steps'
    steps 4
    ^~~~~
m.lsys:3:1: note: first given here
    steps infinte
    ^~~~~
m.lsys:5:1: error: duplicate 'steps'
    steps infinite
    ^~~~~
m.lsys:3:1: note: first given here
    steps infinte
    ^~~~~
)e"},
        {R"e(axiom G)e", R"e(m.lsys:3:1: error: duplicate 'axiom'
    axiom G
    ^~~~~
m.lsys:2:1: note: first given here
    axiom F
    ^~~~~
)e"},
        {R"e(ignore +-+
ignore [F]
ignore F(2)
ignore
ignore F -> G
ignore F
consider G
ignore H)e",
         R"e(m.lsys:3:10: error: '+' is listed twice
    ignore +-+
             ^
m.lsys:3:8: note: first listed here
    ignore +-+
           ^
m.lsys:4:8: error: contexts cannot ignore or consider brackets
    ignore [F]
           ^
m.lsys:4:10: error: contexts cannot ignore or consider brackets
    ignore [F]
             ^
m.lsys:5:9: error: list symbols without parameters
    ignore F(2)
            ^~~
m.lsys:6:7: error: expected symbols after 'ignore', found the end of the line
    ignore
          ^
m.lsys:7:10: error: expected a module or the end of the line, found '->'
    ignore F -> G
             ^~
    hint: write every statement and every production on its own line, without ';'
m.lsys:9:1: error: a block has either 'ignore' or 'consider'
    consider G
    ^~~~~~~~
m.lsys:8:1: note: the other is given here
    ignore F
    ^~~~~~
m.lsys:10:1: error: duplicate 'ignore'
    ignore H
    ^~~~~~
m.lsys:8:1: note: first given here
    ignore F
    ^~~~~~
)e"},
        {R"e(modules axiom, a.b, Bud
modules Bud 33)e",
         R"e(m.lsys:3:9: error: 'axiom' is a word of the language and cannot name a module
    modules axiom, a.b, Bud
            ^~~~~
m.lsys:3:16: error: the name of a module has no dots
    modules axiom, a.b, Bud
                   ^~~
m.lsys:4:9: error: duplicate module 'Bud'
    modules Bud 33
            ^~~
m.lsys:3:21: note: first declared here
    modules axiom, a.b, Bud
                        ^~~
m.lsys:4:13: error: expected the end of the line, found '33'
    modules Bud 33
                ^~
    hint: every statement stands on its own line
)e"},
        {R"e(let a = , b = 2
let c)e",
         R"e(m.lsys:3:9: error: expected a number, found ','
    let a = , b = 2
            ^
m.lsys:4:6: error: expected '=' after 'c', found the end of the line
    let c
         ^
)e"},
        {R"e(interpret { A < B -> F
 angle 60
})e",
         R"e(m.lsys:3:13: error: productions of 'interpret' and 'decompose' have no context
    interpret { A < B -> F
                ^~~~~~~
m.lsys:4:2: error: 'interpret' may contain only productions, not 'angle'
     angle 60
     ^~~~~
    hint: close it with '}' first
)e"},
        {R"e(interpret)e", R"e(m.lsys:3:10: error: expected a production or '{'
    interpret
             ^
    hint: write interpret A -> F, or interpret { with one production per line }
)e"},
        {R"e(interpret A > B -> F)e",
         R"e(m.lsys:3:11: error: productions of 'interpret' and 'decompose' have no context
    interpret A > B -> F
              ^~~
)e"},
        {R"e(use leaf = "x.rifs"
camera { location: 1, 2, 3
  angle: 40
}
A -> F)e",
         R"e(m.lsys:3:1: error: 'use' must be outside the braces of 'lsys a'
    use leaf = "x.rifs"
    ^~~
    hint: close the block with '}' before it
m.lsys:4:1: error: 'camera' must be outside the braces of 'lsys a'
    camera { location: 1, 2, 3
    ^~~~~~
    hint: close the block with '}' before it
)e"},
        {R"e(angle 60 })e", R"e(m.lsys:3:10: error: expected the end of the line, found '}'
    angle 60 }
             ^
    hint: the '}' of a block begins a line
)e"},
    };
    for (const auto& [text, said] : cases)
        EXPECT_EQ(statement_errors(text), said) << text;
}

TEST(LsysErrors, filesAndBlocks) {
    const Cases cases = {
        {R"e(lsys
)e",
         R"e(m.lsys:1:5: error: expected a name after 'lsys', found the end of the file
    lsys
        ^
)e"},
        {R"e(lsys {
axiom F
}
)e",
         R"e(m.lsys:1:6: error: expected a name after 'lsys', found '{'
    lsys {
         ^
)e"},
        {R"e(lsys a
axiom F

)e",
         R"e(m.lsys:2:1: error: expected '{' after 'a', found 'axiom'
    axiom F
    ^~~~~
)e"},
        {R"e(lsys a {

)e",
         R"e(m.lsys:1:9: error: expected '}' at the end of 'lsys a', found the end of the file
    lsys a {
            ^
m.lsys:1:8: note: to close this '{'
    lsys a {
           ^
m.lsys:1:6: error: 'lsys a' has no axiom
    lsys a {
         ^
    hint: write axiom F for the string that the derivation begins with
)e"},
        {R"e(lsys a {
axiom F

)e",
         R"e(m.lsys:2:8: error: expected '}' at the end of 'lsys a', found the end of the file
    axiom F
           ^
m.lsys:1:8: note: to close this '{'
    lsys a {
           ^
)e"},
        {R"e(lsys a {
axiom F
lsys b {
 axiom F
}
)e",
         R"e(m.lsys:3:1: error: expected '}' at the end of 'lsys a', found 'lsys'
    lsys b {
    ^~~~
m.lsys:1:8: note: to close this '{'
    lsys a {
           ^
)e"},
        {R"e(lsys a { }
)e",
         R"e(m.lsys:1:6: error: 'lsys a' has no axiom
    lsys a { }
         ^
    hint: write axiom F for the string that the derivation begins with
)e"},
        {R"e(lsys a {
axoim F
}
)e",
         R"e(m.lsys:2:1: error: unknown statement 'axoim'
    axoim F
    ^~~~~
    hint: did you mean 'axiom'? known here: let, inner, angle, step, width, steps, seed, ignore, consider, tropism, colors, modules, thickness, thinnest, taper, skin, bending, torque, environment, table, precedence, variable, array, start, end, axiom, interpret, decompose
)e"},
        {R"e(lsysx a {
axiom ''
}
light 3
)e",
         R"e(m.lsys:1:1: error: expected 'lsys', found 'lsysx'
    lsysx a {
    ^~~~~
    hint: did you mean 'lsys'?
m.lsys:4:7: error: expected '{' after 'light', found '3'
    light 3
          ^
    hint: light { sun: 1, 2, 3 } or light { location: 10, 20, 30 }
)e"},
        {R"e(foo { $ }
lsys a {
axiom F }

)e",
         R"e(m.lsys:1:7: error: unexpected character '$'
    foo { $ }
          ^
m.lsys:1:1: error: expected 'lsys', 'use' or a scene statement, found 'foo'
    foo { $ }
    ^~~
    hint: begin a block with its kind: lsys foo {
m.lsys:3:9: error: '}' without '{'
    axiom F }
            ^
    hint: the '}' of a block begins a line
)e"},
        {R"e(camera { location: 1,2,3
lsys a {
axiom F
}
)e",
         R"e(m.lsys:1:25: error: expected '}' at the end of 'camera', found 'lsys'
    camera { location: 1,2,3
                            ^
m.lsys:1:8: note: to close this '{'
    camera { location: 1,2,3
           ^
)e"},
        {R"e(lsys a {
axiom F
}}
lsys b {
axiom F
/* x 
}
)e",
         R"e(m.lsys:3:2: error: expected 'lsys', 'use' or a scene statement, found '}'
    }}
     ^
m.lsys:6:1: error: this comment is not closed
    /* x 
    ^~
    hint: close it with '*/'
m.lsys:7:2: error: expected '}' at the end of 'lsys b', found the end of the file
    }
     ^
m.lsys:4:8: note: to close this '{'
    lsys b {
           ^
)e"},
    };
    for (const auto& [text, said] : cases)
        EXPECT_EQ(errors(text), said) << text;
}

TEST(LsysErrors, limitsAreSaidOnce) {
    const auto first_error = [](const std::string& text) {
        const std::string said = errors(text);
        return said.substr(0, said.find('\n'));
    };
    EXPECT_EQ(first_error("lsys a {\naxiom " + std::string(300, '[') + "\n}"),
              "m.lsys:2:263: error: brackets nest more than 256 deep");
    EXPECT_EQ(
        first_error("lsys a {\naxiom F(" + std::string(300, '(') + "1" + std::string(300, ')') + ")\n}"),
        "m.lsys:2:264: error: brackets nest more than 256 deep");
    std::string many = "lsys a {\naxiom " + std::string(60'000, 'F') + "\nA -> " + std::string(60'000, 'F');
    many += "\nB -> F\nC -> F\n}";
    EXPECT_EQ(first_error(many), "m.lsys:3:40005: error: the strings have more than 100000 modules in all");
    EXPECT_EQ(errors(many).find("error", 60), std::string::npos);
    std::string sum = "1";
    for (int i = 0; i < 400; ++i)
        sum += "+1";
    std::string words = "lsys a {\naxiom ";
    for (int i = 0; i < 6000; ++i)
        words += "F(" + sum + ")";
    const std::string said = first_error(words + "\n}");
    EXPECT_EQ(said.substr(said.find(" error")), " error: expressions have more than 4000000 words in all");
}

TEST(LsysErrors, anErrorSpoilsItsStatementOnly) {
    ParsedLsys parsed;
    parse("lsys a {\naxiom F\nA -> F[+F\nB -> F\nC(x -> F\nD -> F\n}\nlsys b {\naxiom F\n}", parsed);
    EXPECT_EQ(parsed.diagnostics.error_count(), 2u);
    ASSERT_EQ(parsed.file.blocks.size(), 2u);
    ASSERT_EQ(parsed.file.blocks[0].productions.size(), 2u);
    EXPECT_EQ(parsed.file.blocks[0].productions[0].predecessor.symbol, "B");
    EXPECT_EQ(parsed.file.blocks[0].productions[1].predecessor.symbol, "D");
}

} // namespace
} // namespace graftal
