#include "runtime/inverse/attractor.h"

#include <algorithm>
#include <cmath>

namespace graftal {

AttractorPainter::AttractorPainter(const Target& target, std::uint32_t parts)
    : target_(target), parts_(parts),
      drawn_(static_cast<std::size_t>(target.width()) * static_cast<std::size_t>(target.height())),
      drawn_parts_(drawn_.size() * parts * parts) {}

std::uint64_t AttractorPainter::draw(const PlaneMaps& maps) {
    for (const std::uint32_t part : touched_)
        drawn_parts_[part] = 0;
    for (const std::uint32_t cell : cells_)
        drawn_[cell] = 0;
    touched_.clear();
    cells_.clear();
    outside_ = 0;
    const auto cells_a_row = static_cast<std::uint32_t>(target_.width());
    const double parts = parts_, width = parts * target_.width(), height = parts * target_.height();
    queue_.assign(1, fixed_point(maps.front()));
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        const Vec2 p = queue_[i];
        for (const PlaneMap& map : maps) {
            const Vec2 q = map(p);
            const double column = parts * q.x, row = parts * q.y;
            if (!(column >= 0 && row >= 0 && column < width && row < height)) {
                ++outside_;
                continue;
            }
            const auto x = static_cast<std::uint32_t>(column), y = static_cast<std::uint32_t>(row);
            const std::uint32_t part = y * cells_a_row * parts_ + x;
            if (drawn_parts_[part]) continue;
            drawn_parts_[part] = 1;
            touched_.push_back(part);
            queue_.push_back(q);
            const std::uint32_t cell =
                static_cast<std::uint32_t>(q.y) * cells_a_row + static_cast<std::uint32_t>(q.x);
            if (drawn_[cell]) continue;
            drawn_[cell] = 1;
            cells_.push_back(cell);
        }
    }
    return queue_.size() * maps.size();
}

bool AttractorPainter::beside(std::size_t cell) const {
    const auto width = static_cast<std::size_t>(target_.width());
    for (std::size_t row = cell - width; row <= cell + width; row += width)
        if (drawn_[row - 1] || drawn_[row] || drawn_[row + 1]) return true;
    return false;
}

bool AttractorPainter::reaches(Vec2 point) const {
    return beside(static_cast<std::size_t>(point.y) * static_cast<std::size_t>(target_.width()) +
                  static_cast<std::size_t>(point.x));
}

SetAgreement AttractorPainter::agreement() const {
    std::size_t both = 0, false_cells = 0, missed = 0;
    for (const std::uint32_t cell : cells_) {
        both += target_.inside(cell);
        false_cells += !target_.near(cell);
    }
    for (const Vec2 p : target_.points())
        missed += !reaches(p);
    const auto drawn = static_cast<double>(cells_.size() + outside_);
    const auto wanted = static_cast<double>(target_.points().size());
    const auto wrong = static_cast<double>(false_cells + outside_), lost = static_cast<double>(missed);
    const double found = (drawn - wrong + wanted - lost) / 2;
    SetAgreement result;
    result.strict = static_cast<double>(both) / (drawn + wanted - static_cast<double>(both));
    result.tolerant = found / (found + wrong + lost);
    return result;
}

SetAgreement AttractorPainter::agreement_in_full() const {
    SetAgreement result = agreement();
    if (cells_.empty()) return result;
    CellSet mine(target_.width(), target_.height());
    for (const std::uint32_t cell : cells_)
        mine.cells[cell] = true;
    const auto width = static_cast<std::size_t>(target_.width());
    double there = 0, back = 0;
    for (const std::uint32_t cell : cells_) {
        const Vec2 p{static_cast<double>(cell % width) + 0.5, static_cast<double>(cell / width) + 0.5};
        const Vec2 away = p - target_.nearest(p);
        there += std::sqrt(away.x * away.x + away.y * away.y);
    }
    const std::vector<std::int64_t> squared = squared_distances(mine);
    for (const Vec2 p : target_.points())
        back += std::sqrt(static_cast<double>(
            squared[static_cast<std::size_t>(p.y) * width + static_cast<std::size_t>(p.x)]));
    result.chamfer =
        there / static_cast<double>(cells_.size()) + back / static_cast<double>(target_.points().size());
    return result;
}

} // namespace graftal
