#include "compiler/lsys/compile/settings.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "compiler/primitives/limb_sweep.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

constexpr double largest_seed = 9007199254740992.0; // 2^53

class SettingsBuilder {
  public:
    SettingsBuilder(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics)
        : block_(block), grammar_(grammar), diagnostics_(diagnostics) {}

    void build() {
        const auto any = [](double) { return true; };
        grammar_.angle_deg = setting(block_.angle, any, "angle", "").value_or(grammar_.angle_deg);
        grammar_.step = size(block_.step, "step").value_or(grammar_.step);
        grammar_.width = size(block_.width, "width");
        grammar_.thickness = size(block_.thickness, "thickness");
        grammar_.thinnest = size(block_.thinnest, "thinnest").value_or(0);
        grammar_.taper = setting(
            block_.taper, [](double x) { return x > 0 && x <= 1; }, "taper", "be above 0 and at most 1");
        const auto skin = setting(
            block_.skin, [](double x) { return x >= least_limb_tolerance && x <= most_limb_tolerance; },
            "skin",
            fmt::format("lie between {} and {}", shortest(least_limb_tolerance),
                        shortest(most_limb_tolerance)));
        if (skin) grammar_.skin = limb_sides(*skin);
        if (block_.thinnest && !block_.thickness)
            diagnostics_.error(block_.thinnest->span, "'thinnest' is the least width beside a 'thickness'");
        if (block_.width && block_.thickness)
            diagnostics_.error(block_.thickness->span, "a block has a 'width' or a 'thickness'")
                .with_note(block_.width->span, "the width is here");
        const auto seed = setting(
            block_.seed, [](double x) { return x >= 0 && x <= largest_seed && x == std::floor(x); }, "seed",
            "be a whole number from 0 to 2^53");
        grammar_.seed = static_cast<std::uint64_t>(seed.value_or(0));
        if (!block_.steps) return;
        grammar_.infinite = !block_.steps->value;
        if (grammar_.infinite) return;
        const auto steps = checked(
            *block_.steps->value,
            [](double x) { return x >= 0 && x <= max_derivation_steps && x == std::floor(x); }, "steps",
            fmt::format("be a whole number from 0 to {}, or infinite", max_derivation_steps));
        if (steps) grammar_.steps = static_cast<unsigned>(*steps);
    }

  private:
    template<typename Predicate>
    std::optional<double> setting(const std::optional<LsysValue>& value, const Predicate& good,
                                  std::string_view name, std::string_view demand) {
        if (!value) return std::nullopt;
        return checked(value->value, good, name, demand);
    }

    template<typename Predicate>
    std::optional<double> checked(const Expression& expression, const Predicate& good, std::string_view name,
                                  std::string_view demand) {
        if (const Expression* const variable = variable_in(expression)) {
            diagnostics_.error(variable->span, fmt::format("'{}' is a variable, and '{}' has one value",
                                                           variable->text, name));
            return std::nullopt;
        }
        const std::optional<double> number = evaluate(expression, grammar_.lets, diagnostics_);
        if (!number || good(*number)) return number;
        diagnostics_.error(expression.span,
                           fmt::format("'{}' must {}, not {}", name, demand, shortest(*number)));
        return std::nullopt;
    }

    const Expression* variable_in(const Expression& expression) const {
        const bool names =
            expression.kind == Expression::Kind::name || expression.kind == Expression::Kind::element;
        if (names && grammar_.cells->contains(expression.text)) return &expression;
        for (const Expression& operand : expression.operands)
            if (const Expression* const found = variable_in(operand)) return found;
        return nullptr;
    }

    /// A size that the turtle can take.
    std::optional<double> size(const std::optional<LsysValue>& value, std::string_view name) {
        const auto known = setting(
            value, [](double x) { return x > 0; }, name, "be positive");
        if (!known || (*known >= least_size && *known <= largest_size)) return known;
        diagnostics_.error(value->value.span,
                           fmt::format("'{}' must lie between {} and {}, not {}", name, shortest(least_size),
                                       shortest(largest_size), shortest(*known)));
        return std::nullopt;
    }

    const LsysBlock& block_;
    LsysGrammar& grammar_;
    Diagnostics& diagnostics_;
};

} // namespace

void build_settings(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics) {
    SettingsBuilder(block, grammar, diagnostics).build();
}

} // namespace graftal
