#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/expression_functions.h"

namespace graftal {

/// An expression whose names were looked up once, for values that are computed often: of a production's
/// parameters, conditions and probabilities.
class ExpressionCode {
  public:
    /// Names of `variables` are read from the slots of value(), in this order, and hide `constants`. Reports
    /// unknown names and functions and wrong numbers of arguments, and gives nothing then. `expression` must
    /// outlive the code. Each call of `normal` or `random` reads a uniform number of [0, 1) from a slot of
    /// its own. These slots lie behind those of the variables and the first `*draws`, which is counted up;
    /// null: calls are errors. Other names are looked for among the `cells`, which hide constants.
    static std::optional<ExpressionCode> compile(const Expression& expression, const Environment& constants,
                                                 std::span<const std::string_view> variables,
                                                 Diagnostics& diagnostics, std::uint32_t* draws = nullptr,
                                                 const CellPlaces* cells = nullptr);

    /// Whether a slot is looked at.
    bool reads(std::size_t slot) const;
    /// Whether a cell that changes is.
    bool reads_changing_cells() const { return reads_changing_cells_; }

    /// The value, or nothing where evaluate() reports an error. `cells`: the values of those that it was
    /// compiled with.
    std::optional<double> value(std::span<const double> slots, std::span<const double> cells = {}) const;

    /// Reports why value() gave nothing for these slots and cells.
    void report(std::span<const double> slots, const Environment& constants,
                std::span<const std::string_view> variables, Diagnostics& diagnostics,
                std::span<const double> cells = {}) const;

  private:
    enum class Kind : std::uint8_t { number, slot, cell, element, call, negate, invert, binary };

    /// The numbers that value() reads.
    struct Row {
        std::span<const double> slots;
        std::span<const double> cells;
    };

    struct Node {
        Kind kind = Kind::number;
        BinaryOperator op = BinaryOperator::add;
        std::uint32_t slot = 0; ///< or cell, or index into arrays_
        std::array<std::uint32_t, max_function_arity> operands{};
        double number = 0;
        const ExpressionFunction* function = nullptr;
        const std::vector<double>* table = nullptr; ///< in place of a function
    };

    class Compiler;
    class StepWriter;
    friend struct ExpressionSteps;

    explicit ExpressionCode(const Expression& source) : source_(&source) {}
    double value(std::uint32_t node, const Row& row) const;
    double binary(const Node& node, const Row& row) const;
    double call(const Node& node, const Row& row) const;
    double element(const Node& node, const Row& row) const;

    const Expression* source_;
    const CellPlaces* cells_ = nullptr;
    std::vector<CellPlace> arrays_;
    bool reads_changing_cells_ = false;
    std::vector<std::pair<const Expression*, std::uint32_t>> draws_; ///< calls with the slots of their draws
    std::vector<Node> nodes_; ///< operands before what they are of; the whole is the last
};

} // namespace graftal
