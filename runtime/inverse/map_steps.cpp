#include "runtime/inverse/map_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace graftal {

namespace {

double angle(Draws& draws) {
    return draws.between(-std::numbers::pi, std::numbers::pi);
}

/// A length, each order of magnitude as likely.
double length(double least, double most, Draws& draws) {
    return std::exp(draws.between(std::log(least), std::log(most)));
}

void drop(PlaneMaps& maps, Draws& draws) {
    maps.erase(maps.begin() + static_cast<std::ptrdiff_t>(draws.below(maps.size())));
}

} // namespace

/// The map with these stretches whose image has its middle there.
PlaneMap MapSteps::placed(const PlaneStretch& stretch, Vec2 image) const {
    return ruled(map_of(stretch, target_.centre(), image), target_, rules_);
}

/// Changes all numbers of the map, the linear part or the image's place alone, or one number.
void MapSteps::shake(PlaneMap& map, Draws& draws) const {
    const double kind = draws.unit(), size = length(0.03, 0.45 * target_.spread(), draws);
    const std::size_t only = draws.below(6);
    std::array<double, 6> step{};
    for (std::size_t k = 0; k < step.size(); ++k) {
        const bool place = k % 3 == 2;
        if (kind < 0.3 ? !place : kind < 0.5 ? place : kind < 0.65 && k != only) continue;
        step[k] = size * draws.normal() * (place ? 1 : 1 / target_.spread());
    }
    map = ruled(moved(map, step.data(), target_.centre(), rules_.most_stretch), target_, rules_);
}

/// Makes the image longer or shorter along one of its axes; about one end stays.
void MapSteps::stretch(PlaneMap& map, Draws& draws) const {
    PlaneStretch stretch = stretch_of(map);
    const bool longer = draws.unit() < 0.5;
    double& factor = longer ? stretch.largest : stretch.least;
    const double before = factor, size = 0.5 * length(0.03, 0.45 * target_.spread(), draws);
    factor = std::clamp(before + size / target_.spread() * draws.normal(), -rules_.most_stretch,
                        rules_.most_stretch);
    const double along = stretch.left_rad + (longer ? 0 : std::numbers::pi / 2);
    const double end = (draws.unit() < 0.5 ? 1.5 : -1.5) * target_.spread() * (factor - before);
    map = placed(stretch, map(target_.centre()) + end * Vec2(std::cos(along), std::sin(along)));
}

/// Turns or mirrors the target before the map squeezes it, or turns its image a little.
void MapSteps::turn(PlaneMap& map, Draws& draws) const {
    PlaneStretch stretch = stretch_of(map);
    const double kind = draws.unit();
    if (kind < 0.3)
        stretch.right_rad += std::numbers::pi;
    else if (kind < 0.6)
        stretch.least = -stretch.least;
    else if (kind < 0.8)
        stretch.right_rad = angle(draws);
    else
        stretch.left_rad += 0.3 * draws.normal();
    map = placed(stretch, map(target_.centre()));
}

/// A small map to a missed point, or one of the maps moved there.
PlaneMap MapSteps::fresh(const PlaneMaps& maps, std::span<const Vec2> missed, Draws& draws) const {
    const std::span<const Vec2> places = missed.empty() ? std::span(target_.points()) : missed;
    const Vec2 place = places[draws.below(places.size())];
    if (draws.unit() < 0.3) return placed(stretch_of(maps[draws.below(maps.size())]), place);
    const double reach = length(0.3, 0.6 * target_.spread(), draws) / target_.spread(), left = angle(draws);
    return placed({reach, reach * draws.unit(), left, angle(draws)}, place);
}

/// Where there is no room for one more, another map goes.
void MapSteps::add(PlaneMaps& maps, const PlaneMap& map, Draws& draws) const {
    if (maps.size() >= most_maps_) drop(maps, draws);
    maps.push_back(map);
}

/// Puts two shorter images side by side in place of one.
void MapSteps::split(PlaneMaps& maps, std::size_t which, Draws& draws) const {
    PlaneStretch stretch = stretch_of(maps[which]);
    stretch.largest *= 0.6;
    stretch.least = std::clamp(stretch.least, -stretch.largest, stretch.largest);
    const Vec2 middle = maps[which](target_.centre());
    const Vec2 away = 0.7 * stretch.largest * target_.spread() *
                      Vec2(std::cos(stretch.left_rad), std::sin(stretch.left_rad));
    maps[which] = placed(stretch, middle - away);
    add(maps, placed(stretch, middle + away), draws);
}

void MapSteps::step(PlaneMaps& maps, std::span<const Vec2> missed, Draws& draws) const {
    const double kind = draws.unit();
    const std::size_t which = draws.below(maps.size());
    if (kind < 0.45) {
        shake(maps[which], draws);
    } else if (kind < 0.6) {
        stretch(maps[which], draws);
    } else if (kind < 0.7) {
        shake(maps[which], draws);
        shake(maps[draws.below(maps.size())], draws);
    } else if (kind < 0.78) {
        turn(maps[which], draws);
    } else if (kind < 0.86) {
        add(maps, fresh(maps, missed, draws), draws);
    } else if (kind < 0.92) {
        maps[which] = fresh(maps, missed, draws);
    } else if (kind < 0.96 || maps.size() <= 2) {
        split(maps, which, draws);
    } else {
        drop(maps, draws);
    }
}

} // namespace graftal
