#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

namespace graftal {

/// The text for a symbol in our strings, without and with its number `%` in parentheses; "" for none.
struct LparserCommand {
    char symbol;
    const char* text;
    const char* with_number;
};

// The turtle's axes are those of ABOP, as ours; the program calls the axis opposite to up its up.
inline constexpr LparserCommand lparser_commands[] = {
    {'F', "F", "F(%)"},
    {'f', "f", "f(%)"},
    {'g', "g", "g(%)"},
    {'Z', "Z", "Z(%)"},
    {'z', "z", "z(%)"},
    {'+', "+", "+(%)"},
    {'-', "-", "-(%)"},
    {'&', "&", "&(%)"},
    {'^', "^", "^(%)"},
    {'<', "\\", "\\(%)"},
    {'>', "/", "/(%)"},
    {'|', "|", ""},
    {'%', "/(180)", ""},
    {'$', "$@N(1)", ""}, // its axes are left-handed from then on
    {'t', "t", "t(%)"},
    {'~', "Shake", "Shake(%)"},
    {'!', "@W(0.7)", "@W(%)"},
    {'?', "@W(1/0.7)", "@W(%)"},
    {':', "@A(0.9)", "@A(%)"},
    {';', "@A(1/0.9)", "@A(%)"},
    {'\'', "@S(0.9)", "@S(%)"},
    {'"', "@S(1/0.9)", "@S(%)"},
    {'[', "[", ""},
    {']', "]", ""},
    {'{', "{", ""},
    {'}', "}", ""},
    {'.', ".", ""},
    {'c', ";", ";(%)"},
};

/// A command whose module of the translation needs an interpretation: without a number, and with one.
struct LparserMeaning {
    char symbol;
    const char* plain;
    const char* numbered;
};

inline constexpr LparserMeaning lparser_meanings[] = {
    {'Z', "Z -> @S(1/2)F@S(2)", "Z(l) -> F(l)"},
    {'z', "z -> @S(1/2)f@S(2)", "z(l) -> f(l)"},
    {'t', "t -> @B(0.2)", "t(e) -> @B(e)"},
    {'~', "Shake -> Shake(343.77)", // 6 radians, where it means degrees
     "Shake(a) -> +(random(-a, a))&(random(-a, a))/(random(-a, a))"},
};

/// Null for a symbol that means nothing to the turtle.
inline const LparserCommand* lparser_command(char symbol) {
    const auto* const found = std::ranges::find(lparser_commands, symbol, &LparserCommand::symbol);
    return found == std::end(lparser_commands) ? nullptr : found;
}

} // namespace graftal
