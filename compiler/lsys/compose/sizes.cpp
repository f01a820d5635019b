#include "compiler/lsys/compose/sizes.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace graftal {

namespace {

/// The power `of` its sizes with which an expression grows.
struct Degree {
    bool any = false;         ///< it is 0, which goes with every power
    std::optional<double> of; ///< nothing: with none
};

constexpr Degree of(double degree) {
    return {false, degree};
}
constexpr Degree no_degree{};

/// The degree of a sum, and of all functions that take sizes of one kind only.
Degree alike(Degree a, Degree b) {
    if (a.any) return b;
    if (b.any || (a.of && b.of && *a.of == *b.of)) return a;
    return no_degree;
}

Degree number_if(Degree a) {
    return a.any || a.of == 0.0 ? of(0) : no_degree;
}

/// The degree of a comparison: both sides grow alike, so that the answer stays.
Degree answer_if(Degree a) {
    return a.any || a.of ? of(0) : no_degree;
}

/// Where sizes are named; variables by their place.
struct SizeNames {
    const std::vector<std::string_view>& names;
    const std::vector<bool>& is_size;

    std::optional<std::size_t> find(std::string_view name) const {
        const auto found = std::ranges::find(names, name);
        const auto at = static_cast<std::size_t>(found - names.begin());
        if (at >= is_size.size() || !is_size[at]) return std::nullopt;
        return at;
    }
};

Degree degree_of(const Expression& e, const SizeNames& sizes);

Degree power_of(const Expression& base, const Expression& exponent, const SizeNames& sizes) {
    const Degree b = degree_of(base, sizes);
    if (!number_if(degree_of(exponent, sizes)).of) return no_degree;
    if (number_if(b).of) return of(0);
    if (!b.of || exponent.kind != Expression::Kind::number) return no_degree;
    return of(*b.of * exponent.number);
}

Degree degree_of_call(const Expression& e, const SizeNames& sizes) {
    const auto operand = [&](std::size_t i) { return degree_of(e.operands[i], sizes); };
    const std::size_t count = e.operands.size();
    if (e.text == "abs" && count == 1) return operand(0);
    if (e.text == "sign" && count == 1) return answer_if(operand(0));
    if (e.text == "pow" && count == 2) return power_of(e.operands[0], e.operands[1], sizes);
    if (e.text == "sqrt" && count == 1) {
        const Degree d = operand(0);
        return d.of ? of(*d.of / 2) : d;
    }
    if (e.text == "atan2" && count == 2) return answer_if(alike(operand(0), operand(1)));
    const bool mixes =
        e.text == "min" || e.text == "max" || e.text == "mod" || e.text == "normal" || e.text == "random";
    if (mixes && count == 2) return alike(operand(0), operand(1));
    if (e.text == "choose" && count == 3)
        return number_if(operand(0)).of ? alike(operand(1), operand(2)) : no_degree;
    if (e.text == "lerp" && count == 3)
        return number_if(operand(2)).of ? alike(operand(0), operand(1)) : no_degree;
    for (std::size_t i = 0; i < count; ++i)
        if (!number_if(operand(i)).of) return no_degree;
    return of(0);
}

Degree degree_of_binary(const Expression& e, const SizeNames& sizes) {
    if (e.text == "^") return power_of(e.operands[0], e.operands[1], sizes);
    const Degree a = degree_of(e.operands[0], sizes), b = degree_of(e.operands[1], sizes);
    if (e.text == "+" || e.text == "-" || e.text == "%") return alike(a, b);
    if (e.text == "*") {
        if (a.any || b.any) return a.any ? a : b;
        return a.of && b.of ? of(*a.of + *b.of) : no_degree;
    }
    if (e.text == "/") {
        if (a.any) return a;
        return a.of && b.of ? of(*a.of - *b.of) : no_degree;
    }
    if (e.text == "&&" || e.text == "||") return answer_if(a).of && answer_if(b).of ? of(0) : no_degree;
    return answer_if(alike(a, b));
}

Degree degree_of(const Expression& e, const SizeNames& sizes) {
    switch (e.kind) {
    case Expression::Kind::number:
        return e.number == 0 ? Degree{true, {}} : of(0);
    case Expression::Kind::name:
        return of(sizes.find(e.text) ? 1 : 0);
    case Expression::Kind::unary:
        return e.text == "!" ? answer_if(degree_of(e.operands[0], sizes)) : degree_of(e.operands[0], sizes);
    case Expression::Kind::binary:
        return degree_of_binary(e, sizes);
    case Expression::Kind::call:
        return degree_of_call(e, sizes);
    case Expression::Kind::element:
        return std::ranges::all_of(
                   e.operands,
                   [&](const Expression& index) { return number_if(degree_of(index, sizes)).of.has_value(); })
                   ? of(0)
                   : no_degree;
    }
    return no_degree;
}

/// The sizes that an expression names, as often as it does.
void gather_sizes(const Expression& e, const SizeNames& sizes, std::vector<std::size_t>& found) {
    if (e.kind == Expression::Kind::name)
        if (const auto at = sizes.find(e.text)) found.push_back(*at);
    for (const Expression& operand : e.operands)
        gather_sizes(operand, sizes, found);
}

} // namespace

std::optional<ParameterRole> size_role(const LsysGrammar& grammar, SymbolId symbol) {
    switch (grammar.commands[symbol]) {
    case TurtleCommand::draw:
    case TurtleCommand::draw_unrecorded:
    case TurtleCommand::draw_always:
    case TurtleCommand::move:
    case TurtleCommand::move_unrecorded:
        return ParameterRole::length;
    case TurtleCommand::width:
        if (grammar.thickness) return std::nullopt;
        return ParameterRole::width;
    case TurtleCommand::sphere:
    case TurtleCommand::disc:
        return ParameterRole::width;
    default:
        return std::nullopt;
    }
}

/// Takes all parameters for sizes, and then those back for which that does not hold.
class LsysSizes::Inference {
  public:
    Inference(const LsysGrammar& grammar, LsysSizes& result)
        : grammar_(grammar), inner_(result.inner_), roles_(result.roles_) {}

    void run() {
        for (const LsysTemplate& module : grammar_.axiom)
            add(module.symbol, module.parameters.size());
        for (const LsysRule& rule : grammar_.rules) {
            add(rule.predecessor.symbol, rule.predecessor.arity);
            for (const LsysTemplate& module : rule.successor)
                add(module.symbol, module.parameters.size());
        }
        for (const LsysRule& rule : grammar_.rules) // nobody knows what blocks make of sizes
            if (rule.has_blocks()) roles(rule).assign(roles(rule).size(), ParameterRole::number);
        // Chains of productions take a round each; so long ones are nobody's.
        constexpr int most_rounds = 200;
        int rounds = 0;
        do
            while (take_back_sizes(false) && ++rounds < most_rounds) {
            }
        while (take_back_sizes(true) && ++rounds < most_rounds);
        while (rounds < most_rounds && take_back_widths())
            ++rounds;
        if (rounds >= most_rounds)
            for (auto& [module, roles] : roles_)
                roles.assign(roles.size(), ParameterRole::number);
    }

  private:
    using Roles = std::vector<ParameterRole>;

    void add(SymbolId symbol, std::size_t arity) {
        const auto [place, fresh] = roles_.try_emplace({symbol, arity});
        if (!fresh) return;
        Roles& roles = place->second;
        roles.assign(arity, ParameterRole::number);
        const TurtleCommand command = grammar_.commands[symbol];
        if (command == TurtleCommand::none) {
            roles.assign(arity, ParameterRole::width);
        } else if (command == TurtleCommand::model) {
            const auto inner = inner_.find(symbol);
            for (std::size_t i = inner == inner_.end() ? 0 : inner->second; i < arity; ++i)
                roles[i] = ParameterRole::length;
        } else if (const auto role = size_role(grammar_, symbol); role && arity > 0) {
            if (grammar_.is_rewritten(symbol)) roles.assign(arity, ParameterRole::width);
            roles[0] = *role;
        }
    }

    Roles& roles(SymbolId symbol, std::size_t arity) { return roles_.at({symbol, arity}); }
    Roles& roles(const LsysRule& rule) { return roles(rule.predecessor.symbol, rule.predecessor.arity); }

    static std::vector<bool> sizes_of(const Roles& roles) {
        std::vector<bool> sizes;
        for (const ParameterRole role : roles)
            sizes.push_back(role != ParameterRole::number);
        return sizes;
    }

    /// True if some were; those of which it is open which to take back only if `guessing`, and then of one
    /// expression.
    bool take_back_sizes(bool guessing) {
        bool changed = false;
        for (const LsysRule& rule : grammar_.rules) {
            for (const auto* plain : {&rule.source->condition, &rule.source->probability})
                changed |= *plain && take_back_in(rule, **plain, false, guessing && !changed);
            for (std::size_t i = 0; i < rule.successor.size(); ++i) {
                const auto& expressions = rule.source->successor.modules[i].parameters;
                const LsysTemplate& module = rule.successor[i];
                for (std::size_t k = 0; k < expressions.size(); ++k) {
                    const bool to_size = roles(module.symbol, expressions.size())[k] != ParameterRole::number;
                    changed |= take_back_in(rule, expressions[k], to_size, guessing && !changed);
                }
                changed |= take_back_mixed(rule, module, expressions);
            }
        }
        return changed;
    }

    bool take_back_in(const LsysRule& rule, const Expression& e, bool to_size, bool guessing) {
        Roles& from = roles(rule);
        std::vector<bool> is_size = sizes_of(from);
        const SizeNames names{rule.variables, is_size};
        const auto fits = [&] {
            const Degree degree = degree_of(e, names);
            return degree.any || degree.of == 0.0 || (to_size && degree.of == 1.0);
        };
        if (fits()) return false;
        std::vector<std::size_t> found;
        gather_sizes(e, names, found);
        std::ranges::sort(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
        if (found.size() > 1 && !guessing) return false;
        for (auto one = found.rbegin(); one != found.rend(); ++one) {
            is_size[*one] = false;
            if (fits()) {
                from[*one] = ParameterRole::number;
                return true;
            }
            is_size[*one] = true;
        }
        for (const std::size_t one : found)
            from[one] = ParameterRole::number;
        return true;
    }

    /// A module with sizes that came from the predecessor and sizes of the production's own keeps the former.
    bool take_back_mixed(const LsysRule& rule, const LsysTemplate& module,
                         const std::vector<Expression>& expressions) {
        const std::vector<bool> is_size = sizes_of(roles(rule));
        const SizeNames names{rule.variables, is_size};
        Roles& to = roles(module.symbol, expressions.size());
        std::vector<std::size_t> absolute;
        bool scaled = false;
        for (std::size_t k = 0; k < expressions.size(); ++k) {
            if (to[k] == ParameterRole::number) continue;
            const Degree degree = degree_of(expressions[k], names);
            if (degree.of == 0.0) absolute.push_back(k);
            scaled = scaled || degree.of == 1.0;
        }
        if (!scaled || absolute.empty()) return false;
        for (const std::size_t k : absolute)
            to[k] = ParameterRole::number;
        return true;
    }

    /// Widths are multiplied by numbers, and nothing else is done with them: then a width that is off by a
    /// share is off by that share wherever it is drawn.
    bool take_back_widths() {
        bool changed = false;
        for (const LsysRule& rule : grammar_.rules) {
            const std::vector<bool> is_size = sizes_of(roles(rule));
            const SizeNames names{rule.variables, is_size};
            const auto take_back = [&](const Expression& e, bool to_width) {
                std::vector<std::size_t> found;
                gather_sizes(e, names, found);
                if (to_width && found.size() <= 1) return;
                for (const std::size_t one : found) {
                    ParameterRole& role = roles(rule)[one];
                    changed = changed || role == ParameterRole::width;
                    role = ParameterRole::length;
                }
            };
            for (const auto* plain : {&rule.source->condition, &rule.source->probability})
                if (*plain) take_back(**plain, false);
            for (std::size_t i = 0; i < rule.successor.size(); ++i) {
                const auto& expressions = rule.source->successor.modules[i].parameters;
                for (std::size_t k = 0; k < expressions.size(); ++k)
                    take_back(expressions[k],
                              roles(rule.successor[i].symbol, expressions.size())[k] == ParameterRole::width);
            }
        }
        return changed;
    }

    const LsysGrammar& grammar_;
    const std::map<SymbolId, std::size_t>& inner_;
    std::map<std::pair<SymbolId, std::size_t>, Roles>& roles_;
};

LsysSizes::LsysSizes(const LsysGrammar& grammar, std::map<SymbolId, std::size_t> inner)
    : rules_(grammar.rules.data()), inner_(std::move(inner)) {
    Inference(grammar, *this).run();
    for (const LsysRule& rule : grammar.rules) {
        std::vector<bool> is_size;
        for (const ParameterRole role : roles(rule.predecessor.symbol, rule.predecessor.arity))
            is_size.push_back(role != ParameterRole::number);
        any_ = any_ || std::ranges::find(is_size, true) != is_size.end();
        const SizeNames names{rule.variables, is_size};
        std::vector<bool>& absolute = absolute_.emplace_back();
        for (std::size_t i = 0; i < rule.successor.size(); ++i) {
            const auto& expressions = rule.source->successor.modules[i].parameters;
            const auto to = roles(rule.successor[i].symbol, expressions.size());
            bool sized = false, scaled = false;
            for (std::size_t k = 0; k < to.size(); ++k) {
                if (to[k] == ParameterRole::number) continue;
                const Degree degree = degree_of(expressions[k], names);
                sized = sized || degree.of == 0.0;
                scaled = scaled || degree.of == 1.0;
            }
            absolute.push_back(sized && !scaled);
        }
    }
}

std::span<const ParameterRole> LsysSizes::roles(SymbolId symbol, std::size_t arity) const {
    const auto found = roles_.find({symbol, arity});
    return found == roles_.end() ? std::span<const ParameterRole>() : found->second;
}

bool LsysSizes::gives_scale(SymbolId model, std::size_t arity) const {
    const auto inner = inner_.find(model);
    return arity > (inner == inner_.end() ? 0 : inner->second);
}

bool LsysSizes::is_absolute(const LsysRule& rule, std::size_t module) const {
    return absolute_[static_cast<std::size_t>(&rule - rules_)][module];
}

} // namespace graftal
