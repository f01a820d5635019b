#include "compiler/import/cfdg/evaluate/chance.h"

#include <algorithm>
#include <vector>

namespace graftal::cfdg {

bool any_part(const Expr& expression, const ExprTest& test) {
    return test(expression) || (expression.change && any_part(*expression.change, test)) ||
           std::ranges::any_of(expression.operands,
                               [&](const Expr& operand) { return any_part(operand, test); });
}

bool any_part(const Modification& modification, const ExprTest& test) {
    return std::ranges::any_of(modification.adjustments, [&](const Adjustment& adjustment) {
        return std::ranges::any_of(adjustment.values,
                                   [&](const Expr& value) { return any_part(value, test); });
    });
}

bool any_part(const Elements& elements, const ExprTest& test) {
    const auto value = [&](const Expr& expression) { return any_part(expression, test); };
    const auto label = [&](const Expr& expression) { // a range such as `1..3` draws no number
        return expression.text == ".." ? std::ranges::any_of(expression.operands, value) : value(expression);
    };
    return std::ranges::any_of(elements, [&](const Element& element) {
        return std::ranges::any_of(element.arguments, value) || any_part(element.modification, test) ||
               any_part(element.body, test) || any_part(element.other, test) ||
               std::ranges::any_of(element.cases, [&](const Case& one) {
                   return std::ranges::any_of(one.values, label) || any_part(one.body, test);
               });
    });
}

/// Functions draw, or call others that do.
Chance::Chance(const Grammar& grammar) {
    for (const Definition& definition : grammar.definitions)
        if (definition.is_function) functions_.emplace(definition.name, &definition);
    std::map<const Definition*, std::vector<const Definition*>> callers;
    std::vector<const Definition*> open;
    for (const auto& named : functions_) {
        const Definition* const function = named.second;
        if (any_part(function->value, draws(function->space))) open.push_back(function);
        any_part(function->value, [&](const Expr& expression) {
            if (const Definition* const called = function_named(expression, function->space))
                callers[called].push_back(function);
            return false;
        });
    }
    while (!open.empty()) {
        const Definition* const function = open.back();
        open.pop_back();
        if (random_functions_.insert(function).second)
            open.insert(open.end(), callers[function].begin(), callers[function].end());
    }
}

bool Chance::decides(const Elements& elements, const std::string& space) const {
    return any_part(elements, draws(space));
}

bool Chance::decides(const Modification& modification, const std::string& space) const {
    return any_part(modification, draws(space));
}

bool Chance::decides(const Expr& expression, const std::string& space) const {
    return any_part(expression, draws(space));
}

ExprTest Chance::draws(const std::string& space) const {
    return [this, &space](const Expr& expression) {
        if (expression.kind == Expr::Kind::binary) return expression.text == ".." || expression.text == "+/-";
        if (expression.kind != Expr::Kind::call) return false;
        if (expression.text.starts_with("rand") && expression.text != "rand_static") return true;
        const Definition* const function = function_named(expression, space);
        return function && random_functions_.contains(function);
    };
}

const Definition* Chance::function_named(const Expr& expression, const std::string& space) const {
    if (expression.kind != Expr::Kind::call) return nullptr;
    return in_spaces(expression.text, space, [&](const std::string& name) -> const Definition* {
        const auto found = functions_.find(name);
        return found == functions_.end() ? nullptr : found->second;
    });
}

} // namespace graftal::cfdg
