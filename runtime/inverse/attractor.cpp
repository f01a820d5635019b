#include "runtime/inverse/attractor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

template<typename Point> CellLattice<Point> divided(const CellLattice<Point>& grid, std::uint32_t parts) {
    std::array<std::size_t, CellLattice<Point>::dimensions> sides;
    for (std::size_t k = 0; k < sides.size(); ++k)
        sides[k] = parts * grid.side(k);
    return CellLattice<Point>(sides);
}

} // namespace

template<typename Map>
AttractorPainterOf<Map>::AttractorPainterOf(const TargetOf<Map>& target, std::uint32_t parts)
    : target_(target), parts_(parts), part_grid_(divided(target.grid(), parts)),
      neighbours_(target.grid().neighbours()), drawn_(target.grid().cells()),
      drawn_parts_(part_grid_.cells()) {}

template<typename Map> std::uint64_t AttractorPainterOf<Map>::draw(const std::vector<Map>& maps) {
    for (const std::uint32_t part : touched_)
        drawn_parts_[part] = 0;
    for (const std::uint32_t cell : cells_)
        drawn_[cell] = 0;
    touched_.clear();
    cells_.clear();
    outside_ = 0;
    const double parts = parts_;
    queue_.assign(1, fixed_point(maps.front()));
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        const Point p = queue_[i];
        for (const Map& map : maps) {
            const Point q = map(p), fine = parts * q;
            if (!part_grid_.holds(fine)) {
                ++outside_;
                continue;
            }
            const auto part = static_cast<std::uint32_t>(part_grid_.index(fine));
            if (drawn_parts_[part]) continue;
            drawn_parts_[part] = 1;
            touched_.push_back(part);
            queue_.push_back(q);
            const auto cell = static_cast<std::uint32_t>(target_.grid().index(q));
            if (drawn_[cell]) continue;
            drawn_[cell] = 1;
            cells_.push_back(cell);
        }
    }
    return queue_.size() * maps.size();
}

template<typename Map> bool AttractorPainterOf<Map>::reaches(Point point) const {
    const std::size_t cell = target_.grid().index(point);
    for (const std::ptrdiff_t step : neighbours_)
        if (drawn_[cell + static_cast<std::size_t>(step)]) return true;
    return false;
}

template<typename Map> SetAgreement AttractorPainterOf<Map>::agreement() const {
    std::size_t both = 0, false_cells = 0, missed = 0;
    for (const std::uint32_t cell : cells_) {
        both += target_.inside(cell);
        false_cells += !target_.near(cell);
    }
    for (const Point p : target_.points())
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

template<typename Map> SetAgreement AttractorPainterOf<Map>::agreement_in_full() const {
    SetAgreement result = agreement();
    if (cells_.empty()) return result;
    CellSet mine = target_.cells();
    mine.cells.assign(mine.cells.size(), false);
    for (const std::uint32_t cell : cells_)
        mine.cells[cell] = true;
    double there = 0, back = 0;
    for (const std::uint32_t cell : cells_) {
        const Point p = CellLattice<Point>::middle(target_.grid().place(cell)), away = p - target_.nearest(p);
        there += std::sqrt(glm::dot(away, away));
    }
    const std::vector<std::int64_t> squared = squared_distances(mine);
    for (const Point p : target_.points())
        back += std::sqrt(static_cast<double>(squared[target_.grid().index(p)]));
    result.chamfer =
        there / static_cast<double>(cells_.size()) + back / static_cast<double>(target_.points().size());
    return result;
}

template<typename Map> double collage_distance(const TargetOf<Map>& target, const std::vector<Map>& maps) {
    CellSet images = target.cells();
    images.cells.assign(images.cells.size(), false);
    double beyond = 0;
    for (const typename Map::Point p : target.points())
        for (const Map& map : maps) {
            const typename Map::Point q = map(p);
            if (target.grid().holds(q)) {
                images.cells[target.grid().index(q)] = true;
            } else { // to some point of the target: no less than the distance
                beyond = std::max(beyond, glm::length(q - target.nearest(q)));
            }
        }
    if (std::find(images.cells.begin(), images.cells.end(), true) == images.cells.end()) return beyond;
    return std::max(beyond, hausdorff_distance(target.cells(), images));
}

template class AttractorPainterOf<PlaneMap>;
template class AttractorPainterOf<SpaceMap>;
template double collage_distance(const Target&, const PlaneMaps&);
template double collage_distance(const SpaceTarget&, const SpaceMaps&);

} // namespace graftal
