#include "compiler/editing/format.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::string laid_out(const std::string& name, const std::string& text) {
    const Document document(name, text);
    const std::string once = applied(text, format(document));
    EXPECT_EQ(applied(once, format(Document(name, once))), once);
    return once;
}

TEST(Format, Objects) {
    EXPECT_EQ(laid_out("m.inst", "\n\ncanonical object a{instance:cube   scale:1,2,3}   # a part\n\n\n"
                                 "object b {\n\n  a\n\ttranslate : 1 , 0,0 /* kept\n  as it is */\n"
                                 "when 1 {\na}\n\n}"),
              "canonical object a { instance: cube   scale: 1, 2, 3 }   # a part\n\n"
              "object b {\n    a\n    translate: 1, 0, 0 /* kept\n  as it is */\n"
              "    when 1 {\n        a }\n}\n");
}

TEST(Format, MapsAndColumns) {
    EXPECT_EQ(laid_out("m.rifs", "rifs a {\nmap b { scale 1/2 }\n     follow a->b\n}"),
              "rifs a {\n  map b { scale 1/2 }\n  follow a -> b\n}\n");
    EXPECT_EQ(laid_out("m.rifs",
                       "rifs a {\n    codes 2d {\n     .5 -.26 0 .5 0 0\n    -.5 - .26 0 .5 0 0 1\n }\n}"),
              "rifs a {\n  codes 2d {\n     .5 -.26 0 .5 0 0\n    -.5 - .26 0 .5 0 0 1\n  }\n}\n");
}

TEST(Format, SignsBehindCommasAndColons) {
    EXPECT_EQ(laid_out("m.inst", "object a {\ncube\ntranslate:-1,-2,+3\nrotate:<0,-1,0>,90\n}"),
              "object a {\n    cube\n    translate: -1, -2, +3\n    rotate: <0, -1, 0>, 90\n}\n");
    EXPECT_EQ(laid_out("m.rifs", "rifs a {\nmap b{scale 1/2 translate 1,-1}\n}"),
              "rifs a {\n  map b { scale 1/2 translate 1, -1 }\n}\n");
}

TEST(Format, LSystems) {
    EXPECT_EQ(laid_out("m.lsys", "lsys a{\n axiom F[+A]  \n\n\n    A->F[\n      +A\n    ][-A]   # twig\n"
                                 "  interpret {\nA --> @O\n  }\n }\n\n"),
              "lsys a {\n  axiom F[+A]\n\n  A -> F[\n    +A\n  ][-A]   # twig\n"
              "  interpret {\n    A --> @O\n  }\n}\n");
}

TEST(Format, LeavesFaultyTextsAlone) {
    EXPECT_EQ(laid_out("m.inst", "object  a{"), "object  a{");
    EXPECT_EQ(laid_out("m.txt", "a   "), "a   ");
    EXPECT_EQ(laid_out("m.inst", ""), "");
}

} // namespace
} // namespace graftal
