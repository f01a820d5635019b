#include "compiler/import/cfdg/evaluate/affine.h"

#include <array>
#include <cmath>
#include <numbers>

namespace graftal::cfdg {

std::vector<const Adjustment*> last_of_each(const Modification& modification,
                                            std::span<const std::string_view> words) {
    std::vector<const Adjustment*> found;
    for (const std::string_view word : words) {
        const Adjustment* last = nullptr;
        for (const Adjustment& adjustment : modification.adjustments)
            if (adjustment.word == word) last = &adjustment;
        if (last) found.push_back(last);
    }
    return found;
}

std::vector<const Adjustment*> moves_of(const Modification& modification) {
    static constexpr std::array<std::string_view, 7> order = {"x", "y", "z", "r", "s", "skew", "f"};
    std::vector<const Adjustment*> moves;
    if (modification.ordered) {
        for (const Adjustment& adjustment : modification.adjustments)
            for (const std::string_view word : order)
                if (adjustment.word == word) moves.push_back(&adjustment);
        return moves;
    }
    return last_of_each(modification, order);
}

double size_of(const Affine& map) {
    const auto& m = map.linear;
    return std::sqrt(std::abs(m[0][0] * m[1][1] - m[0][1] * m[1][0]));
}

std::optional<Affine> affine_of(const Modification& modification, const Expressions& expressions,
                                const Numbers& known) {
    Affine map;
    for (const Adjustment& adjustment : modification.adjustments)
        if (adjustment.word == "trans") return std::nullopt;
    for (const Adjustment* const move : moves_of(modification)) {
        std::vector<double> n;
        for (const Expr& value : move->values) {
            const std::optional<double> number = expressions.number(value, known);
            if (!number) return std::nullopt;
            n.push_back(*number);
        }
        if (n.empty()) return std::nullopt;
        const double second = n.size() > 1 ? n[1] : 0;
        Affine step;
        if (move->word == "x") {
            step = Affine::translate({n[0], second, n.size() > 2 ? n[2] : 0});
        } else if (move->word == "y") {
            step = Affine::translate({0, n[0], second});
        } else if (move->word == "z") {
            step = Affine::translate({0, 0, n[0]});
        } else if (move->word == "r") {
            step = Affine::rotate({0, 0, 1}, n[0]);
        } else if (move->word == "s") {
            const double sy = n.size() > 1 ? n[1] : n[0];
            step = Affine::scale({n[0], sy, std::sqrt(std::abs(n[0] * sy))});
        } else if (move->word == "skew") {
            const auto tangent = [](double degrees) { return std::tan(degrees * std::numbers::pi / 180); };
            step.linear[1][0] = tangent(n[0]);
            step.linear[0][1] = tangent(second);
        } else {
            step = Affine::rotate({0, 0, 1}, n[0]) * Affine::scale({1, -1, 1}) *
                   Affine::rotate({0, 0, 1}, -n[0]);
        }
        map = map * step;
    }
    return map;
}

} // namespace graftal::cfdg
