#include "compiler/syntax/expression.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/syntax/expression_code.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// The value of `text`, or NaN; errors in `errors`.
double value(const std::string& text, std::string* errors = nullptr, const Environment& environment = {}) {
    SourceMap sources;
    Diagnostics diagnostics;
    TokenStream stream(lex(sources, sources.add("t", text), diagnostics), diagnostics);
    const std::optional<Expression> expression = parse_expression(stream);
    std::optional<double> result;
    if (expression && !stream.at_end()) stream.expected("the end");
    if (expression && !diagnostics.has_errors()) result = evaluate(*expression, environment, diagnostics);
    if (errors) *errors = diagnostics.render(sources);
    return result.value_or(nothing);
}

std::string error(const std::string& text, const Environment& environment = {}) {
    std::string errors;
    EXPECT_TRUE(std::isnan(value(text, &errors, environment))) << text;
    return errors;
}

TEST(Expression, precedence_and_associativity) {
    EXPECT_EQ(value("1 + 2*3 - 4/2"), 5);
    EXPECT_EQ(value("10 - 3 - 2"), 5);
    EXPECT_EQ(value("64/4/2"), 8);
    EXPECT_EQ(value("2^3^2"), 512);
    EXPECT_EQ(value("-2^2"), -4);
    EXPECT_EQ(value("2^-1"), 0.5);
    EXPECT_EQ(value("(1+2)*3"), 9);
    EXPECT_EQ(value("7 % 4 * 2"), 6);
    EXPECT_EQ(value("1/2"), 0.5);
    EXPECT_EQ(value("--3"), 3);
    EXPECT_EQ(value("+3 - -4"), 7);
}

TEST(Expression, comparisons_and_logic_give_one_or_zero) {
    EXPECT_EQ(value("1 < 2 && 3 >= 3"), 1);
    EXPECT_EQ(value("1 == 2 || 1 != 1"), 0);
    EXPECT_EQ(value("!0 + !5"), 1);
    EXPECT_EQ(value("1 + 1 < 3"), 1);
    EXPECT_EQ(value("0 && 1/0"), 0) << "the right side is not reached";
    EXPECT_EQ(value("1 || 1/0"), 1);
}

TEST(Expression, trigonometry_is_in_degrees_and_exact_at_right_angles) {
    EXPECT_EQ(value("sin(30)"), 0.5);
    EXPECT_EQ(value("sin(180)"), 0);
    EXPECT_EQ(value("cos(90)"), 0);
    EXPECT_EQ(value("cos(60)"), 0.5);
    EXPECT_EQ(value("cos(-180)"), -1);
    EXPECT_EQ(value("sin(270)"), -1);
    EXPECT_EQ(value("cos(720)"), 1);
    EXPECT_EQ(value("atan2(1, -1)"), 135);
    EXPECT_EQ(value("asin(1) + acos(-1) + atan(1)"), 90 + 180 + 45);
    for (int degrees = -400; degrees < 400; degrees += 7) {
        const std::string angle = std::to_string(degrees);
        EXPECT_NEAR(value("sin(" + angle + ")"), std::sin(degrees * M_PI / 180), 1e-15);
        EXPECT_NEAR(value("cos(" + angle + ")"), std::cos(degrees * M_PI / 180), 1e-15);
    }
}

TEST(Expression, functions_and_names) {
    EXPECT_EQ(value("sqrt(2)^2"), std::pow(std::sqrt(2.0), 2));
    EXPECT_EQ(value("floor(-1.5) + ceil(1.2) + abs(-3) + sign(-8)"), -2 + 2 + 3 - 1);
    EXPECT_EQ(value("lerp(2, 6, 0.25)"), 3);
    EXPECT_EQ(value("lerp(2, 6, 1.5)"), 8);
    EXPECT_EQ(value("smooth(1, 3, 0)"), 0);
    EXPECT_EQ(value("smooth(1, 3, 2)"), 0.5);
    EXPECT_EQ(value("smooth(1, 3, 9)"), 1);
    EXPECT_EQ(value("smooth(2, 2, 2) + smooth(2, 2, 1.9)"), 1);
    EXPECT_EQ(value("logistic(5, 8, 2, 5)"), 4);
    EXPECT_EQ(value("logistic(-1e9, 8, 2, 5)"), 0);
    EXPECT_NEAR(value("logistic(6, 1, 1, 5)"), 0.7310585786300049, 1e-15);
    EXPECT_EQ(value("min(2, -1) + max(3, 4) + mod(7, 4) + pow(2, 10)"), -1 + 4 + 3 + 1024);
    EXPECT_EQ(value("exp(0) + log(1)"), 1);
    EXPECT_EQ(value("2*pi"), 2 * M_PI);
    EXPECT_EQ(value("11 - n", nullptr, {{"n", 4}}), 7);
    EXPECT_TRUE(std::signbit(value("-0")));
}

TEST(Expression, errors_say_what_is_wrong_and_where) {
    EXPECT_EQ(error("1 + lenght", {{"length", 1}}),
              "t:1:5: error: unknown name 'lenght'\n"
              "    1 + lenght\n"
              "        ^~~~~~\n"
              "    hint: did you mean 'length'? known here: pi, length\n");
    EXPECT_THAT(error("1/(2-2)"), HasSubstr("t:1:1: error: division by zero"));
    EXPECT_THAT(error("5 % 0"), HasSubstr("division by zero"));
    EXPECT_THAT(error("mod(5, 0)"), HasSubstr("division by zero"));
    EXPECT_THAT(error("sqrt(-1)"), HasSubstr("sqrt(-1) is not a finite number"));
    EXPECT_THAT(error("1e308*10"), HasSubstr("1e+308 * 10 is not a finite number"));
    EXPECT_THAT(error("lerp(1, 2)"), HasSubstr("'lerp' takes 3 arguments, not 2"));
    EXPECT_THAT(error("lerp(1e308, -1e308, 2)"),
                HasSubstr("lerp(1e+308, -1e+308, 2) is not a finite number"));
    EXPECT_THAT(error("pow(0, -1)"), HasSubstr("pow(0, -1) is not a finite number"));
    EXPECT_THAT(error("log(0)"), HasSubstr("log(0) is not a finite number"));
    EXPECT_THAT(error("tan(90)"), HasSubstr("tan(90) is not a finite number"));
    EXPECT_THAT(error("nan"), HasSubstr("unknown name 'nan'"));
    EXPECT_THAT(error("inf"), HasSubstr("unknown name 'inf'"));
    EXPECT_THAT(error("sqr(2)"), HasSubstr("unknown function 'sqr'"));
    EXPECT_THAT(error("sqr(2)"), HasSubstr("did you mean 'sqrt'?"));
    EXPECT_THAT(error("sin(1, 2)"), HasSubstr("'sin' takes 1 argument, not 2"));
    EXPECT_THAT(error("atan2()"), HasSubstr("'atan2' takes 2 arguments, not 0"));
    EXPECT_THAT(error("2*sin"), HasSubstr("'sin' is a function"));
    EXPECT_THAT(error("1 +"), HasSubstr("expected a number, found the end of the file"));
    EXPECT_THAT(error("(1 + 2"), HasSubstr("note: to close this '('"));
    EXPECT_THAT(error("* 2"), HasSubstr("expected a number, found '*'"));
}

/// A number `n` of 2, an array `a` of 5, 6, 7 and an array `b` of two rows, 1 2 and 3 4; a name `x` of 1.
/// Evaluated and compiled, which must agree. Errors in `errors`.
double value_of_cells(const std::string& text, std::string* errors = nullptr) {
    const CellPlaces places = {{"n", {.first = 0}},
                               {"a", {.first = 1, .dimensions = 1, .sizes = {3, 1}}},
                               {"b", {.first = 4, .dimensions = 2, .sizes = {2, 2}}}};
    const std::vector<double> cells = {2, 5, 6, 7, 1, 2, 3, 4};
    const std::array<std::string_view, 1> names = {"x"};
    const std::array slots = {1.0};
    SourceMap sources;
    Diagnostics diagnostics;
    TokenStream stream(lex(sources, sources.add("t", text), diagnostics), diagnostics);
    const std::optional<Expression> expression = parse_expression(stream);
    if (expression && !stream.at_end()) stream.expected("the end");
    double result = nothing;
    if (expression && !diagnostics.has_errors()) {
        result = evaluate(*expression, {{"x", 1}}, diagnostics, {}, {&places, cells}).value_or(nothing);
        const std::string said = diagnostics.render(sources);
        Diagnostics again;
        const auto code = ExpressionCode::compile(*expression, {}, names, again, nullptr, &places);
        const std::optional<double> compiled = code ? code->value(slots, cells) : std::nullopt;
        EXPECT_EQ(compiled.has_value(), !std::isnan(result)) << text;
        if (compiled) {
            EXPECT_EQ(*compiled, result) << text;
        }
        if (code && !compiled) code->report(slots, {}, names, again, cells);
        EXPECT_EQ(again.render(sources), said) << text;
    }
    if (errors) *errors = diagnostics.render(sources);
    return result;
}

TEST(Expression, cells_have_names_and_indices) {
    EXPECT_EQ(value_of_cells("n"), 2);
    EXPECT_EQ(value_of_cells("a[0] + 10*a[n]"), 75);
    EXPECT_EQ(value_of_cells("a[1.9]"), 6);
    EXPECT_EQ(value_of_cells("a[2 - 1e-12]"), 7); // rounding
    EXPECT_EQ(value_of_cells("b[x][0]^2"), 9);
    EXPECT_EQ(value_of_cells("-b[a[0] - 5][b[0][0]]"), -2);
    EXPECT_EQ(value_of_cells("max(a[0], a[1])"), 6);
}

TEST(Expression, wrong_indices_are_errors) {
    const auto said = [](const std::string& text) {
        std::string errors;
        EXPECT_TRUE(std::isnan(value_of_cells(text, &errors))) << text;
        return errors;
    };
    EXPECT_THAT(said("a[3]"),
                HasSubstr("t:1:3: error: this index of 'a' must lie between 0 and 2, but is 3"));
    EXPECT_THAT(said("a[-1]"), HasSubstr("must lie between 0 and 2, but is -1"));
    EXPECT_THAT(said("b[1][n]"), HasSubstr("t:1:6: error: this index of 'b' must lie between 0 and 1"));
    EXPECT_THAT(said("a[1/0]"), HasSubstr("division by zero"));
    EXPECT_THAT(said("a"), HasSubstr("'a' is an array"));
    EXPECT_THAT(said("a[1][1]"), HasSubstr("'a' has 1 index, not 2"));
    EXPECT_THAT(said("b[1]"), HasSubstr("'b' has 2 indices, not 1"));
    EXPECT_THAT(said("n[1]"), HasSubstr("'n' is a number, not an array"));
    EXPECT_THAT(said("x[1]"), HasSubstr("'x' is a number, not an array"));
    EXPECT_THAT(said("c[1]"), HasSubstr("unknown array 'c'"));
    EXPECT_THAT(said("b[1][1][1]"), HasSubstr("an array has one or two indices"));
    EXPECT_THAT(said("a[1"), HasSubstr("note: to close this '['"));
    EXPECT_THAT(error("a[1]"), HasSubstr("only a block of an L-system has arrays"));
}

TEST(Expression, depth_and_length_are_bounded) {
    EXPECT_EQ(value(std::string(200, '(') + "1" + std::string(200, ')')), 1);
    EXPECT_THAT(error(std::string(100'000, '(')), HasSubstr("nest more than 256 deep"));
    EXPECT_THAT(error(std::string(100'000, '-') + "1"), HasSubstr("nest more than 256 deep"));
    std::string powers = "1", sums = "1", calls;
    for (int i = 0; i < 100'000; ++i) {
        powers += "^1";
        sums += "+1";
    }
    EXPECT_THAT(error(powers), HasSubstr("nest more than 256 deep"));
    EXPECT_THAT(error(sums), HasSubstr("more than 1000 terms"));
}

/// The numbers that a parse function finds, then what it leaves.
template<typename Parse> std::vector<double> numbers(const std::string& text, const Parse& parse) {
    SourceMap sources;
    Diagnostics diagnostics;
    TokenStream stream(lex(sources, sources.add("t", text), diagnostics), diagnostics);
    std::vector<double> out;
    if (const auto found = parse(stream))
        for (const Expression& e : *found)
            out.push_back(evaluate(e, {}, diagnostics).value_or(nothing));
    EXPECT_EQ(diagnostics.render(sources), "") << text;
    return out;
}

TEST(ExpressionLists, vectors_colours_and_tints) {
    const auto vector = [](TokenStream& s) { return parse_vector(s, "v"); };
    EXPECT_THAT(numbers("1, -2, 3/4 rotate", vector), ElementsAre(1, -2, 0.75));
    EXPECT_THAT(numbers("<-1/2, 1, (2 > 1)>", vector), ElementsAre(-0.5, 1, 1));
    EXPECT_THAT(numbers("1, 2, 3, scale: 2", vector), ElementsAre(1, 2, 3));
    const auto tint = [](TokenStream& s) { return parse_tint(s, "tint"); };
    EXPECT_THAT(numbers("rgb <1, 0, .5> 0.25", tint), ElementsAre(1, 0, 0.5, 0.25));
    EXPECT_THAT(numbers("1, 0, .5, .25", tint), ElementsAre(1, 0, 0.5, 0.25));
    const auto color = [](TokenStream& s) { return parse_color(s, "color"); };
    EXPECT_THAT(numbers("rgb <1, 0, .5>", color), ElementsAre(1, 0, 0.5));
}

TEST(ExpressionLists, rows_need_no_commas) {
    const auto row = [](TokenStream& s) {
        std::optional<std::vector<Expression>> out(std::in_place);
        while (!s.at_end())
            if (std::optional<Expression> e = parse_row_expression(s)) out->push_back(*e);
        return out;
    };
    EXPECT_THAT(numbers("1 -2 3-1 4 - 1 1/3*3 -(2 -1) .5", row), ElementsAre(1, -2, 2, 3, 1, -1, 0.5));
}

TEST(ExpressionLists, every_list_of_numbers_may_be_a_row) {
    const auto vector = [](TokenStream& s) { return parse_vector(s, "v"); };
    EXPECT_THAT(numbers("0 -1 0 rotate", vector), ElementsAre(0, -1, 0));
    EXPECT_THAT(numbers("<0 -1 0>", vector), ElementsAre(0, -1, 0));
    EXPECT_THAT(numbers("1 - 2 3*2 (4) scale 2", vector), ElementsAre(-1, 6, 4));
    EXPECT_THAT(numbers("1 -2, 3, 4", vector), ElementsAre(-1, 3, 4))
        << "where commas stand it is a difference";
    EXPECT_THAT(numbers("1, 2 3", vector), ElementsAre(1, 2, 3));
    EXPECT_THAT(numbers("1 2\n3 4", vector), ElementsAre(1, 2, 3)) << "on the next line what is missing";
    EXPECT_THAT(numbers("1 pi 2", vector).size(), 3u);
    EXPECT_THAT(numbers("1, 0 .5 .25", [](TokenStream& s) { return parse_tint(s, "tint"); }),
                ElementsAre(1, 0, 0.5, 0.25));
    const auto scale = [](TokenStream& s) { return parse_numbers(s, 1, 3, "scale"); };
    EXPECT_THAT(numbers("2 -3", scale), ElementsAre(2, -3));
    EXPECT_THAT(numbers("2 rotate 3", scale), ElementsAre(2));
    EXPECT_THAT(numbers("2\n3", scale), ElementsAre(2)) << "a row that may end does so with its line";
    EXPECT_THAT(numbers("3 -1", [](TokenStream& s) { return parse_numbers(s, 1, 1, "steps"); }),
                ElementsAre(2));
}

TEST(ExpressionLists, wrong_counts_are_errors) {
    const auto errors = [](const std::string& text) {
        SourceMap sources;
        Diagnostics diagnostics;
        TokenStream stream(lex(sources, sources.add("t", text), diagnostics), diagnostics);
        EXPECT_FALSE(parse_numbers(stream, 1, 3, "'scale'"));
        return diagnostics.render(sources);
    };
    EXPECT_THAT(errors("1, 2, 3, 4"), HasSubstr("'scale' takes 1 to 3 numbers, not more"));
    EXPECT_THAT(errors("<1, 2"), HasSubstr("expected '>', found the end of the file"));
    EXPECT_THAT(errors("{"), HasSubstr("expected a number, found '{'"));
    EXPECT_THAT(errors("[1 2]"), HasSubstr("write a vector as x, y, z or <x, y, z>"));
    EXPECT_THAT(errors("(1, 2)"), HasSubstr("write a vector as x, y, z or <x, y, z>"));
    EXPECT_THAT(errors("50%"), HasSubstr("0.5 instead of 50%"));
}

} // namespace
} // namespace graftal
