#include "compiler/detail/graph/piece_kind.h"

#include <algorithm>
#include <cmath>

#include "compiler/detail/graph/ending.h"

namespace graftal {

double PieceKind::steps_of(double detail) {
    return std::log2(std::max(detail, 1e-300)) * steps_an_octave;
}

std::int32_t PieceKind::step_of(double detail) {
    if (!std::isfinite(detail)) return endless_detail;
    return static_cast<std::int32_t>(std::ceil(steps_of(detail) - 1e-6));
}

std::size_t PieceKindHash::operator()(const PieceKind& kind) const {
    std::uint64_t h = kind.node;
    h = (h ^ kind.steps) * 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 29) ^ static_cast<std::uint32_t>(kind.unit_step)) * 0xBF58476D1CE4E5B9ull;
    return h ^ (h >> 32);
}

double cut_detail(const DetailNode& node, double error_px) {
    return error_px > 0 ? std::max(1.0, node.terminal_px / error_px) : 1;
}

bool ends_by(const DetailNode& node, std::uint32_t steps, bool small) {
    if (node.primitive || node.unbounded) return false;
    return ends_recursion(node, steps, small);
}

bool is_cut(const DetailNode& node, std::uint32_t steps, double detail, double error_px) {
    return ends_by(node, steps, detail <= cut_detail(node, error_px));
}

} // namespace graftal
