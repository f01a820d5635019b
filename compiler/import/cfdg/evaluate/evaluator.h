#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/import/cfdg/evaluate/draws.h"
#include "compiler/import/cfdg/evaluate/value.h"
#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/importer.h"
#include "compiler/support/counter_random.h"

namespace graftal::cfdg {

/// Where an expression stands.
struct Surroundings {
    Values values;                ///< of parameters, variables and indices
    std::string space;            ///< the name space
    const Shape* shape = nullptr; ///< whose parameters `(=)` hands on
};

struct LoopBounds {
    double begin = 0, end = 0, step = 1;

    bool goes_on(double index) const { return step > 0 ? index < end - 1e-9 : index > end + 1e-9; }
    double turns() const {
        const double left = step > 0 ? end - 1e-9 - begin : begin - end - 1e-9;
        return std::max(0.0, std::ceil(left / std::abs(step)));
    }
};

/// Evaluates expressions and adjustments whose names all have values. Functions give nothing after an error.
class Evaluator {
  public:
    /// Both must outlive this.
    Evaluator(const ForeignFile& file, const Grammar& grammar)
        : seed(file.seed == 0 ? 0 : CounterRandom::scrambled(file.seed)), file_(file), grammar_(grammar) {
        for (const Definition& definition : grammar_.definitions)
            definitions_.emplace(definition.name, &definition);
    }

    std::optional<Value> value(const Expr& expression, const Surroundings& at);
    /// The numbers of an expression: those of vectors and lists one after the other.
    std::optional<std::vector<double>> numbers(const Expr& expression, const Surroundings& at);
    std::optional<double> number(const Expr& expression, const Surroundings& at);
    std::optional<Change> change(const Modification& modification, const Surroundings& at);
    /// The shape that an element names, with its arguments; it may be a primitive.
    std::optional<ShapeValue> shape(const Element& element, const Surroundings& at);
    /// The values of the parameters: one argument each, or as many numbers as their types hold.
    std::optional<Values> bind(const std::vector<Parameter>& parameters, const std::vector<Value>& arguments,
                               Span place);

    /// The rule of a shape that chance chooses. Requires that there is one.
    const Rule& rule(const Shape& shape);
    /// The lines of a `switch` that count; null if none do, or after an error.
    const Elements* choice(const Element& element, const Surroundings& at);
    std::optional<LoopBounds> bounds(const Element& loop, const Surroundings& at);

    /// Notes what changes nothing, once for each place.
    void note(Span place, std::string message);
    std::nullopt_t fail(Span place, std::string message, std::string hint = "");

    /// The random numbers of the rule that is evaluated.
    Draws draws;
    /// A part of the key of all random numbers.
    const std::uint64_t seed;
    /// Comparisons of sides that are left for the outlines of all paths.
    std::size_t outline_work = 100'000'000;

  private:
    std::optional<Value> value_of_name(const Expr& expression, const Surroundings& at);
    std::optional<Value> global(const Definition& definition);
    std::optional<Value> list(const Expr& expression, const Surroundings& at);
    std::optional<Value> unary(const Expr& expression, const Surroundings& at);
    std::optional<Value> operation(const Expr& expression, const Surroundings& at);
    std::optional<Value> value_of_kind(const Expr& expression, const Surroundings& at);
    std::optional<Value> combined(const Expr& expression, const Value& left, const Value& right);
    std::optional<Value> change_value(const Modification& modification, const Surroundings& at);
    std::optional<Value> call(const Expr& expression, const Surroundings& at);
    std::optional<Value> function(const Definition& function, const Expr& expression, const Surroundings& at);
    std::optional<Value> element(const Expr& expression, const Surroundings& at);
    std::optional<Value> let(const Expr& expression, const Surroundings& at);
    std::optional<Value> select(const Expr& expression, const Surroundings& at);
    std::optional<Value> random(const Expr& expression, const std::vector<double>& n);
    std::optional<Value> of_numbers(const Expr& expression, const std::vector<double>& n);
    std::optional<Value> shape_value(const Expr& expression, std::string_view name, const Surroundings& at);
    std::optional<std::vector<Value>> arguments(const std::vector<Expr>& expressions, const Surroundings& at);
    std::optional<Affine> move(const Adjustment& adjustment, const std::vector<double>& n);
    bool colour(const Adjustment& adjustment, const std::vector<double>& n, std::vector<ColourStep>& steps);
    const Definition* definition(std::string_view name, std::string_view space) const;
    bool spend(Span place);

    const ForeignFile& file_;
    const Grammar& grammar_;
    std::map<std::string, const Definition*> definitions_;
    std::map<std::string, Value> globals_;
    std::set<std::string> open_;    ///< globals that are being evaluated
    std::set<std::uint32_t> noted_; ///< places with a note
    int depth_ = 0;
    std::size_t work_ = 0;
};

/// The adjustments of a modification in the order in which they multiply, then colours: x y z, r, s, skew,
/// f, transform. Where the modification keeps its order, they are as written.
std::vector<const Adjustment*> in_order(const Modification& modification);

/// Whether the adjustment belongs to lines of paths, which read it themselves.
bool is_of_paths(std::string_view word);

/// The colour channel that an adjustment steps.
std::optional<Channel> channel_of(const Adjustment& adjustment);

/// Whether the name is that of a primitive: CIRCLE, SQUARE or TRIANGLE, or a sign for one; which one, or "".
std::string_view primitive_named(std::string_view name);

} // namespace graftal::cfdg
