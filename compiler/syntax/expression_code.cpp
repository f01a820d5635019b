#include "compiler/syntax/expression_code.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace graftal {

namespace {

/// Stands for "no value"; values are finite.
constexpr double failed = std::numeric_limits<double>::quiet_NaN();

} // namespace

class ExpressionCode::Compiler {
  public:
    Compiler(ExpressionCode& code, const Environment& constants, std::span<const std::string_view> variables,
             Diagnostics& diagnostics, std::uint32_t* draws, const CellPlaces* cells)
        : code_(code), constants_(constants), variables_(variables), diagnostics_(diagnostics),
          draws_(draws), cells_{cells, {}} {}

    /// The node of the expression. Recursion is as deep as the tree, which the parser bounds.
    std::optional<std::uint32_t> add(const Expression& e) {
        switch (e.kind) {
        case Expression::Kind::number:
            return append({.kind = Kind::number, .number = e.number});
        case Expression::Kind::name:
            return add_name(e);
        case Expression::Kind::call:
            return add_call(e);
        case Expression::Kind::unary:
            return add_operands(e, {.kind = e.text == "!" ? Kind::invert : Kind::negate});
        case Expression::Kind::binary:
            return add_operands(e, {.kind = Kind::binary, .op = binary_operator(e.text)});
        case Expression::Kind::element:
            return add_element(e);
        }
        return std::nullopt;
    }

  private:
    std::uint32_t append(const Node& node) {
        code_.nodes_.push_back(node);
        return static_cast<std::uint32_t>(code_.nodes_.size() - 1);
    }

    std::optional<std::uint32_t> add_name(const Expression& e) {
        const auto slot = std::ranges::find(variables_, e.text);
        if (slot != variables_.end())
            return append(
                {.kind = Kind::slot, .slot = static_cast<std::uint32_t>(slot - variables_.begin())});
        if (const CellPlace* const cell = cells_.find(e.text); cell && cell->dimensions == 0) {
            code_.reads_changing_cells_ |= cell->changes;
            return append({.kind = Kind::cell, .slot = cell->first});
        }
        if (const std::optional<double> number = evaluate(e, visible_names(e), diagnostics_, {}, cells_))
            return append({.kind = Kind::number, .number = *number});
        return std::nullopt;
    }

    std::optional<std::uint32_t> add_element(const Expression& e) {
        const CellPlace* const array = cells_.find(e.text);
        const bool hidden = std::ranges::find(variables_, e.text) != variables_.end();
        if (hidden || !array || array->dimensions != e.operands.size()) {
            evaluate(e, visible_names(e), diagnostics_, {}, cells_);
            return std::nullopt;
        }
        code_.reads_changing_cells_ |= array->changes;
        code_.arrays_.push_back(*array);
        return add_operands(
            e, {.kind = Kind::element, .slot = static_cast<std::uint32_t>(code_.arrays_.size() - 1)});
    }

    /// For the error about an unknown name, those of the variables too.
    Environment visible_names(const Expression& e) const {
        Environment names = constants_;
        if (names.contains(e.text)) return names;
        for (const std::string_view variable : variables_)
            if (!variable.empty()) names.emplace(variable, 0);
        return names;
    }

    std::optional<std::uint32_t> add_call(const Expression& e) {
        const ExpressionFunction* function = expression_function(e.text);
        if (e.table && e.operands.size() == 1)
            return add_operands(e, {.kind = Kind::call, .table = e.table.get()});
        if (chance_function(e.text) && draws_ && e.operands.size() == chance_arguments) return add_chance(e);
        if (!function || e.operands.size() != function->arity) {
            evaluate(e, constants_, diagnostics_);
            return std::nullopt;
        }
        return add_operands(e, {.kind = Kind::call, .function = function});
    }

    /// The draw comes before the arguments of the text.
    std::optional<std::uint32_t> add_chance(const Expression& e) {
        const auto slot = static_cast<std::uint32_t>(variables_.size() + (*draws_)++);
        code_.draws_.emplace_back(&e, slot);
        const std::uint32_t draw = append({.kind = Kind::slot, .slot = slot});
        const auto first = add(e.operands[0]), second = add(e.operands[1]);
        if (!first || !second) return std::nullopt;
        return append(
            {.kind = Kind::call, .operands = {draw, *first, *second}, .function = chance_function(e.text)});
    }

    std::optional<std::uint32_t> add_operands(const Expression& e, Node node) {
        bool good = true;
        for (std::size_t i = 0; i < e.operands.size(); ++i) {
            const std::optional<std::uint32_t> operand = add(e.operands[i]);
            node.operands[i] = operand.value_or(0);
            good = good && operand;
        }
        if (!good) return std::nullopt;
        return append(node);
    }

    ExpressionCode& code_;
    const Environment& constants_;
    std::span<const std::string_view> variables_;
    Diagnostics& diagnostics_;
    std::uint32_t* draws_;
    ExpressionCells cells_;
};

std::optional<ExpressionCode> ExpressionCode::compile(const Expression& expression,
                                                      const Environment& constants,
                                                      std::span<const std::string_view> variables,
                                                      Diagnostics& diagnostics, std::uint32_t* draws,
                                                      const CellPlaces* cells) {
    ExpressionCode code(expression);
    code.cells_ = cells;
    if (!Compiler(code, constants, variables, diagnostics, draws, cells).add(expression)) return std::nullopt;
    return code;
}

bool ExpressionCode::reads(std::size_t slot) const {
    return std::ranges::any_of(
        nodes_, [&](const Node& node) { return node.kind == Kind::slot && node.slot == slot; });
}

std::optional<double> ExpressionCode::value(std::span<const double> slots,
                                            std::span<const double> cells) const {
    const Node& whole = nodes_.back();
    const double result = whole.kind == Kind::slot ? slots[whole.slot]
                          : whole.kind == Kind::number
                              ? whole.number
                              : value(static_cast<std::uint32_t>(nodes_.size() - 1), Row{slots, cells});
    if (std::isfinite(result)) return result;
    return std::nullopt;
}

double ExpressionCode::value(std::uint32_t index, const Row& row) const {
    const Node& node = nodes_[index];
    switch (node.kind) {
    case Kind::number:
        return node.number;
    case Kind::slot:
        return row.slots[node.slot];
    case Kind::cell:
        return row.cells[node.slot];
    case Kind::element:
        return element(node, row);
    case Kind::negate:
        return -value(node.operands[0], row);
    case Kind::invert: {
        const double operand = value(node.operands[0], row);
        return std::isnan(operand) ? failed : static_cast<double>(operand == 0);
    }
    case Kind::call:
        return call(node, row);
    case Kind::binary:
        return binary(node, row);
    }
    return failed;
}

double ExpressionCode::binary(const Node& node, const Row& row) const {
    // Most operands are numbers and names: to call for them would take most of the time.
    const auto value_of = [&](std::uint32_t operand) {
        const Node& leaf = nodes_[operand];
        return leaf.kind == Kind::slot     ? row.slots[leaf.slot]
               : leaf.kind == Kind::number ? leaf.number
                                           : value(operand, row);
    };
    const double left = value_of(node.operands[0]);
    if (!std::isfinite(left)) return failed;
    if (node.op == BinaryOperator::logical_and && left == 0) return 0;
    if (node.op == BinaryOperator::logical_or && left != 0) return 1;
    const double right = value_of(node.operands[1]);
    if (!std::isfinite(right)) return failed;
    const bool divides = node.op == BinaryOperator::divide || node.op == BinaryOperator::remainder;
    if (divides && right == 0) return failed;
    return apply_binary(node.op, left, right);
}

double ExpressionCode::call(const Node& node, const Row& row) const {
    if (node.table) {
        const double x = value(node.operands[0], row);
        return std::isfinite(x) ? table_value(*node.table, x) : failed;
    }
    if (node.function->chooses) {
        const double condition = value(node.operands[0], row);
        return std::isfinite(condition) ? value(node.operands[condition != 0 ? 1 : 2], row) : failed;
    }
    std::array<double, max_function_arity> arguments{};
    const std::size_t arity = node.function->arity;
    for (std::size_t i = 0; i < arity; ++i) {
        arguments[i] = value(node.operands[i], row);
        if (!std::isfinite(arguments[i])) return failed;
    }
    return node.function->apply(std::span(arguments).first(arity));
}

double ExpressionCode::element(const Node& node, const Row& row) const {
    const CellPlace& array = arrays_[node.slot];
    std::uint32_t at = 0;
    for (std::uint32_t i = 0; i < array.dimensions; ++i) {
        const double number = value(node.operands[i], row);
        const std::optional<std::uint32_t> index =
            std::isfinite(number) ? cell_index(number, array.sizes[i]) : std::nullopt;
        if (!index) return failed;
        at = at * array.sizes[i] + *index;
    }
    return row.cells[array.first + at];
}

void ExpressionCode::report(std::span<const double> slots, const Environment& constants,
                            std::span<const std::string_view> variables, Diagnostics& diagnostics,
                            std::span<const double> cells) const {
    Environment environment = constants;
    for (std::size_t i = 0; i < std::min(variables.size(), slots.size()); ++i)
        if (!variables[i].empty()) environment.insert_or_assign(std::string(variables[i]), slots[i]);
    ChanceDraws draws;
    for (const auto& [call, slot] : draws_)
        draws[call] = slots[slot];
    evaluate(*source_, environment, diagnostics, draws, {cells_, cells});
}

} // namespace graftal
