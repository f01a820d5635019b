#include "compiler/import/cfdg/evaluate/affine.h"

#include <cmath>

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

double size_of(const Affine& map) {
    const auto& m = map.linear;
    return std::sqrt(std::abs(m[0][0] * m[1][1] - m[0][1] * m[1][0]));
}

double largest_factor(const Affine& map) {
    const auto& m = map.linear;
    const double turned = std::hypot(m[0][0] + m[1][1], m[0][1] - m[1][0]);
    const double mirrored = std::hypot(m[0][0] - m[1][1], m[0][1] + m[1][0]);
    return (turned + mirrored) / 2;
}

} // namespace graftal::cfdg
