#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compiler/support/affine.h"

namespace graftal::cfdg {

enum class Channel : std::uint8_t { hue, saturation, brightness, alpha };

/// One change of a colour or of its target.
struct ColourStep {
    enum class Kind : std::uint8_t {
        change,        ///< a hue by degrees; else a share of the way to 1, or to 0 if it is negative
        toward,        ///< a share of the way to `goal`; if it is negative, away from it
        toward_target, ///< the same, to the target of the shape
        target,        ///< of the target, as `change`
    };

    Kind kind = Kind::change;
    Channel channel = Channel::hue;
    double amount = 0;
    double goal = 0;

    bool operator==(const ColourStep&) const = default;
};

/// An adjustment whose numbers are known.
struct Change {
    Affine map; ///< z apart from x and y
    std::vector<ColourStep> colours;

    bool operator==(const Change&) const = default;
    /// First the colours of this, and `inner` within its map.
    void add(const Change& inner) {
        map = map * inner.map;
        colours.insert(colours.end(), inner.colours.begin(), inner.colours.end());
    }
};

struct Value;

/// A shape with its arguments.
struct ShapeValue {
    std::string name; ///< with its name space, as the grammar has it
    std::vector<Value> arguments;
};

/// The result of an expression.
struct Value {
    enum class Kind : std::uint8_t { numbers, change, shape, flags };

    Kind kind = Kind::numbers;
    std::vector<double> numbers; ///< one, or those of a vector
    Change change;
    std::shared_ptr<const ShapeValue> shape;
    std::string flags; ///< names of `CF::` one after the other

    static Value of(double number) { return {.numbers = {number}}; }
};

/// The values of the names of a rule.
using Values = std::map<std::string, Value>;

/// A text that only equal values share.
std::string key_of(const Value& value);

} // namespace graftal::cfdg
