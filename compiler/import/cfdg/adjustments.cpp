// The lines of adjustments: moves, and steps of the ink.

#include <cmath>

#include <fmt/format.h>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/writer.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

/// The size in place of 0.
constexpr const char* thinnest = "0.0001";

std::string sum_of(const std::string& a, const std::string& b) {
    return a.empty() ? b : fmt::format("{} + {}", a, b);
}

} // namespace

std::optional<std::string> Writer::text(const Expr& expression, const Scope& scope) {
    return expressions_.text(expression, scope);
}

std::optional<Writer::Lines> Writer::lines_of(const Modification& modification, const Scope& scope,
                                              const Height& height) {
    Lines lines;
    std::array<std::string, 3> moved;
    const auto flush = [&] {
        if (moved[0].empty() && moved[1].empty() && moved[2].empty()) return;
        for (std::string& part : moved)
            if (part.empty()) part = "0";
        lines.moves += fmt::format("  translate: {}, {}, {}", moved[0], moved[1], moved[2]);
        moved = {};
    };
    std::string inner_moves, inner_inks;
    for (const Adjustment& adjustment : modification.adjustments) {
        if (adjustment.word != "trans") continue;
        const Definition* const inner = expressions_.modification(adjustment);
        if (!inner || ++nested_ > 8) {
            nested_ = 0;
            fail(adjustment.span, "this adjustment within an adjustment is not translated");
            return std::nullopt;
        }
        const std::optional<Lines> own = lines_of(*inner->value.change, constants_, {.lifts = height.lifts});
        --nested_;
        if (!own) return std::nullopt;
        inner_moves = own->moves + inner_moves;
        inner_inks += own->inks;
    }
    const std::vector<const Adjustment*> moves = moves_of(modification);
    Size size;
    for (auto at = moves.rbegin(); at != moves.rend(); ++at) {
        const Adjustment& move = **at;
        std::vector<std::string> n;
        std::vector<std::optional<double>> known;
        for (const Expr& value : move.values) {
            std::optional<std::string> words = text(value, scope);
            if (!words) return std::nullopt;
            n.push_back(std::move(*words));
            known.push_back(expressions_.number(value));
        }
        if (n.size() > 3) {
            fail(move.span, "an adjustment takes at most three numbers");
            return std::nullopt;
        }
        if (move.word == "z") continue; // an error says that depth has no words
        if (move.word == "x" || move.word == "y") {
            const std::size_t axis = move.word == "x" ? 0 : 1;
            for (std::size_t i = 0; axis + i < 2 && i < n.size(); ++i)
                moved[axis + i] = sum_of(moved[axis + i], n[i]);
            continue;
        }
        flush();
        if (move.word == "r") {
            lines.moves += fmt::format("  rotate: z, {}", n[0]);
        } else if (move.word == "s") {
            for (std::size_t i = 0; i < n.size(); ++i)
                if (known[i] && *known[i] == 0) n[i] = thinnest;
            const std::optional<Interval> a = expressions_.range(move.values[0]);
            const std::optional<Interval> b = expressions_.range(move.values[n.size() > 1 ? 1 : 0]);
            const std::string second = n.size() > 1 ? n[1] : n[0];
            if (a && b)
                size.known *= std::sqrt(std::abs((a->least + a->most) * (b->least + b->most)) / 4);
            else if (!is_random(n[0]) && !is_random(second))
                size.factors += fmt::format("*sqrt(abs(({})*({})))", n[0], second);
            const bool one = n.size() == 1 && ((known[0] && *known[0] > 0) || is_random(n[0]));
            if (height.block && !height.lifts && !is_random(n[0]))
                lines.moves += fmt::format("  scale: {}, {}, 1", n[0], second);
            else
                lines.moves +=
                    one ? fmt::format("  scale: {}", n[0]) : fmt::format("  scale: {}, {}", n[0], second);
        } else if (move.word == "skew") {
            const std::string along = n[0], up = n.size() > 1 ? n[1] : "0";
            lines.moves +=
                up == "0"
                    ? fmt::format("  shear: xy, tan({})", along)
                    : fmt::format("  matrix: 1, tan({}), 0, 0,  tan({}), 1, 0, 0,  0, 0, 1, 0", along, up);
        } else {
            lines.moves += fmt::format("  rotate: z, -({0})  scale: 1, -1, 1  rotate: z, {0}", n[0]);
        }
    }
    moved[2] = height_text(height, size);
    flush();
    std::optional<std::string> inks = inks_of(modification, scope);
    if (!inks) return std::nullopt;
    lines.inks = *inks + inner_inks;
    lines.moves = inner_moves + lines.moves;
    return lines;
}

std::optional<std::string> Writer::inks_of(const Modification& modification, const Scope& scope) {
    std::string steps;
    const std::size_t errors = file_.diagnostics.error_count();
    for (const Adjustment& adjustment : modification.adjustments) {
        const std::string& word = adjustment.word;
        if (word == "blend")
            fail(adjustment.span, "'blend' is not translated");
        else if (word == "time" || word == "timescale")
            file_.diagnostics.note(adjustment.span, fmt::format("'{}' changes nothing here", word));
        else if (adjustment.sets_target || adjustment.to_target)
            fail(adjustment.span, "colour targets ('|') are not translated",
                 "write the target behind the change: sat 0.4 0.8");
        else if (word == "h" || word == "sat" || word == "b" || word == "a")
            steps += colour_step(adjustment, scope);
    }
    if (file_.diagnostics.error_count() > errors) return std::nullopt;
    return steps.empty() ? steps : fmt::format("  ink {{{} }}", steps);
}

/// `sat 0.1` goes a tenth of the way to 1, `sat -0.1` a tenth of the way to 0.
std::string Writer::colour_step(const Adjustment& adjustment, const Scope& scope) {
    const char* const channel = adjustment.word == "h"     ? "hue"
                                : adjustment.word == "sat" ? "saturation"
                                : adjustment.word == "b"   ? "value"
                                                           : "alpha";
    const std::optional<std::string> change = text(adjustment.values[0], scope);
    if (!change) return "";
    const std::optional<double> known = expressions_.number(adjustment.values[0]);
    const bool hue = adjustment.word == "h";
    if (adjustment.values.size() > 1) {
        const std::optional<std::string> target = text(adjustment.values[1], scope);
        if (!known || *known < 0 || !target) {
            fail(adjustment.span, "a change away from a target is not translated");
            return "";
        }
        return fmt::format(" {} to {} by {}", channel, *target, shortest(std::min(*known, 1.0)));
    }
    if (hue) return fmt::format(" hue {}", *change);
    if (known && *known == 0) return "";
    if (known && *known > 0) return fmt::format(" {} to 1 by {}", channel, shortest(std::min(*known, 1.0)));
    if (known) return fmt::format(" {} {}", channel, shortest(std::max(0.0, 1 + *known)));
    if (!is_random(*change)) return fmt::format(" {0} to ({1} > 0) by min(1, abs({1}))", channel, *change);
    const std::optional<Interval> range = expressions_.range(adjustment.values[0]);
    if (range && range->least >= 0) return fmt::format(" {} to 1 by min(1, {})", channel, *change);
    if (range && range->most <= 0) return fmt::format(" {} max(0, 1 + {})", channel, *change);
    // One draw for both directions: a random number around 0.
    return fmt::format(" {} max(0, 1 + {})", channel, *change);
}

} // namespace graftal::cfdg
