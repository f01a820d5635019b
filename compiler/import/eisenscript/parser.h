#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/import/eisenscript/tokens.h"

namespace graftal::eisenscript {

/// A number, and the `#define` that it comes from, if any.
struct Value {
    double number = 0;
    std::string constant;
};

/// One operator of `{ x 1 rz 30 hue 10 }`.
struct Operator {
    enum class Kind : std::uint8_t {
        x,
        y,
        z,
        rx,
        ry,
        rz,
        size,
        matrix,
        reflect,
        hue,
        saturation,
        brightness,
        alpha,
        colour,
        blend
    };

    Kind kind = Kind::x;
    std::vector<Value> numbers;
    std::optional<std::array<double, 3>> colour; ///< sRGB; none of `color random`
    Span span;

    bool moves() const { return kind <= Kind::reflect; }
};

/// `3 * { ... }`; without a count once.
struct Loop {
    Value count{1, {}};
    std::vector<Operator> operators;
    Span span;
};

/// `set KEY VALUE`.
struct Setting {
    std::string key;
    std::string value;
    Span span;
};

/// `3 * { x 1 } 4 * { y 2 } box`.
struct Action {
    std::vector<Loop> loops; ///< the outermost first
    Token target;
    std::vector<std::string> comments;
    Span span;
};

struct Rule {
    Token name;
    Value weight{1, {}};
    std::optional<int> depth;      ///< maxdepth
    std::optional<Token> fallback; ///< the rule that follows then
    std::vector<Action> actions;
    std::vector<Setting> settings;
    std::vector<std::string> comments;
    std::vector<std::string> tail; ///< comments before the '}'
};

struct Script {
    std::vector<Rule> rules; ///< the first is the text outside of rules, without a name
    std::vector<Constant> constants;
    std::vector<std::string> tail; ///< comments
};

/// Reports what cannot be read, as far as it can be told apart.
Script parse(const ForeignFile& file);

} // namespace graftal::eisenscript
