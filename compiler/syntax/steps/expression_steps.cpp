#include "compiler/syntax/steps/expression_steps.h"

#include <algorithm>
#include <optional>

#include "compiler/support/check.h"

namespace graftal {

/// Walks the tree of a code, operands first.
class ExpressionCode::StepWriter {
  public:
    StepWriter(const ExpressionCode& code, std::uint32_t before, ExpressionSteps& to)
        : code_(code), before_(before), to_(to) {}

    /// The operand that stands for a node, whose steps may use the slots from `free` on.
    std::optional<std::uint32_t> operand(std::uint32_t index, std::uint32_t free) {
        const Node& node = code_.nodes_[index];
        if (node.kind == Kind::number) return number(static_cast<float>(node.number));
        if (node.kind == Kind::slot) return slot(before_ + node.slot);
        return write(index, free, free) ? std::optional(free) : std::nullopt;
    }

    bool write(std::uint32_t index, std::uint32_t free, std::uint32_t result) {
        const Node& node = code_.nodes_[index];
        std::uint32_t arity = 1;
        ExpressionStep step;
        step.result = result;
        switch (node.kind) {
        case Kind::number:
        case Kind::slot:
            step.operation = ExpressionStep::copy;
            break;
        case Kind::negate:
            step.operation = ExpressionStep::negate;
            break;
        case Kind::invert:
            step.operation = ExpressionStep::invert;
            break;
        case Kind::binary:
            step.operation = static_cast<std::uint32_t>(node.op);
            arity = 2;
            break;
        case Kind::call:
            step.operation = node.table ? ExpressionStep::table : operation_of(*node.function);
            arity = node.table ? 1 : static_cast<std::uint32_t>(node.function->arity);
            break;
        case Kind::cell:
        case Kind::element:
            return false;
        }
        if (step.operation == ExpressionStep::copy) {
            const auto copied = operand(index, free);
            if (!copied) return false;
            step.operands.fill(*copied);
        } else if (!write_operands(node, arity, free, step))
            return false;
        if (node.kind == Kind::call && node.table && !write_table(*node.table, step)) return false;
        to_.slots = std::max(to_.slots, result + 1);
        to_.steps.push_back(step);
        return true;
    }

  private:
    static std::uint32_t operation_of(const ExpressionFunction& function) {
        for (const auto& [all, first] : {std::pair(expression_functions(), ExpressionStep::functions),
                                         std::pair(chance_functions(), ExpressionStep::chances)})
            for (std::size_t i = 0; i < all.size(); ++i)
                if (&all[i] == &function) return first + static_cast<std::uint32_t>(i);
        GRAFTAL_CHECK(false, "a function that is in no table");
    }

    /// Operands that there are not are as the first.
    bool write_operands(const Node& node, std::uint32_t arity, std::uint32_t free, ExpressionStep& step) {
        for (std::uint32_t i = 0; i < arity; ++i) {
            const auto written = operand(node.operands[i], free);
            if (!written) return false;
            if (i == 0) step.operands.fill(*written);
            step.operands[i] = *written;
            if (*written == free) ++free;
        }
        return true;
    }

    bool write_table(const std::vector<double>& table, ExpressionStep& step) {
        const auto first = static_cast<std::uint32_t>(to_.numbers.size());
        for (const double value : table)
            to_.numbers.push_back(static_cast<float>(value));
        step.operands[1] = first | ExpressionSteps::is_number;
        step.pieces = static_cast<std::uint32_t>(table.size() - 1);
        return to_.numbers.size() < ExpressionSteps::is_number;
    }

    std::optional<std::uint32_t> number(float value) {
        const auto place =
            static_cast<std::uint32_t>(std::ranges::find(to_.numbers, value) - to_.numbers.begin());
        if (place == to_.numbers.size()) to_.numbers.push_back(value);
        if (place >= ExpressionSteps::is_number) return std::nullopt;
        return place | ExpressionSteps::is_number;
    }

    std::optional<std::uint32_t> slot(std::uint32_t place) {
        if (place >= ExpressionSteps::is_number) return std::nullopt;
        to_.slots = std::max(to_.slots, place + 1);
        return place;
    }

    const ExpressionCode& code_;
    std::uint32_t before_;
    ExpressionSteps& to_;
};

bool ExpressionSteps::add(const ExpressionCode& code, std::uint32_t before, std::uint32_t free,
                          std::uint32_t result) {
    ExpressionCode::StepWriter writer(code, before, *this);
    if (!writer.write(static_cast<std::uint32_t>(code.nodes_.size() - 1), free, result)) return false;
    steps.back().whole = true;
    return slots < is_number;
}

void ExpressionSteps::add_draw(std::uint32_t result) {
    slots = std::max(slots, result + 1);
    steps.push_back({.operation = ExpressionStep::draw, .result = result});
}

} // namespace graftal
