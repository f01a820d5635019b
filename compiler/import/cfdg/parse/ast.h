#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/source.h"

namespace graftal::cfdg {

struct Modification;

/// An expression of version 3; version 2 has numbers only.
struct Expr {
    enum class Kind : std::uint8_t { number, name, call, unary, binary, list, modification };

    Kind kind = Kind::number;
    double number = 0;
    std::string text; ///< a name, or an operator: + - * / ^ _ < <= > >= == <> && || ^^ ! .. +/-
    std::vector<Expr> operands;
    std::shared_ptr<const Modification> change; ///< of kind modification
    Span span;
};

/// One adjustment: `x 1`, `hue 10`, `|sat 1`, `b 0.1|`.
struct Adjustment {
    std::string word; ///< its short name: x y z r s skew f h sat b a, trans, or another
    std::vector<Expr> values;
    bool sets_target = false; ///< `|hue 60`
    bool to_target = false;   ///< `hue 0.5|`
    Span span;
};

struct Modification {
    std::vector<Adjustment> adjustments;
    bool ordered = false; ///< as written; else x y z r s skew f
    Span span;
};

struct Element;
using Elements = std::vector<Element>;

/// `case 1, 2: ...`; no values of `else:`.
struct Case {
    std::vector<Expr> values;
    Elements body;
};

/// A line of a rule or a path.
struct Element {
    enum class Kind : std::uint8_t { shape, loop, condition, choice, transform, define, path_operation };

    Kind kind = Kind::shape;
    std::string name; ///< of a shape, an index, a variable or a path operation
    /// The arguments of a shape or operation; a transform's adjustments; a count, condition or value.
    std::vector<Expr> arguments;
    bool reuses_arguments = false; ///< `shape(=)`
    bool computed = false;         ///< the shape is what the only argument gives: `if(a, B, C) []`
    bool clones = false;           ///< a transform whose copies draw the same random numbers
    Modification modification;
    Elements body, other; ///< other: of finally or else
    std::vector<Case> cases;
    Span span;
    std::vector<std::string> comments;
};

struct Parameter {
    std::string type; ///< number, natural, adjustment, shape, vector2 and so on
    std::string name;
    Span span;
};

struct Rule {
    std::optional<double> weight;
    bool percent = false;
    Elements body;
    Span span;
    std::vector<std::string> comments;
};

struct Shape {
    std::string name;
    bool is_path = false;
    std::vector<Parameter> parameters;
    std::vector<Rule> rules;
    std::string space; ///< the name space of the file: "a::b::"
    Span span;
    std::vector<std::string> comments;
};

/// `name = value` or `name(a, b) = value`; of the whole file.
struct Definition {
    std::string name;
    bool is_function = false;
    std::vector<Parameter> parameters;
    Expr value;
    std::string space; ///< the name space of the file
    std::string type;  ///< "" where none is written
    Span span;
    std::vector<std::string> comments;
};

/// Finds the meaning of a name used in a name space, the innermost first: "a::b::x", "a::x", "x".
template<typename Found> auto in_spaces(std::string_view name, std::string_view space, const Found& find) {
    while (true) {
        if (auto found = find(std::string(space) + std::string(name)); found || space.empty()) return found;
        const std::size_t outer = space.substr(0, space.size() - 2).rfind("::");
        space = outer == std::string_view::npos ? std::string_view() : space.substr(0, outer + 2);
    }
}

struct Grammar {
    std::vector<Shape> shapes;                  ///< in their order
    std::map<std::string, std::size_t> numbers; ///< of the shapes, by name
    std::vector<Definition> definitions;
    std::set<std::string> defined;         ///< their names
    std::optional<Element> start;          ///< startshape
    std::optional<Element> included_start; ///< startshape of an included file, where this one has none
    std::optional<Modification> background, size, tile;
    std::vector<std::string> tail; ///< comments

    /// The number of a shape, as a name of a file in the name space means it.
    std::optional<std::size_t> shape(std::string_view name, std::string_view space) const;
};

} // namespace graftal::cfdg
