#include "compiler/zoom/neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/graph/path.h"
#include "compiler/graph/walk.h"

namespace graftal {

namespace {

/// Bounds the rounding of one product of affine maps, in units of the largest number that takes part.
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
/// Maps that differ by more than this share of the object are never the same.
constexpr double most_snapped = 1e-7;
/// Known maps that are looked at, of a pair of objects and of all, the first ones.
constexpr std::size_t most_known = 512;
/// A piece that rounding has moved by this share of its size is lost.
constexpr double lost_share = 0.05;

double reach_of(const Affine& a, const Ball& ball) {
    return glm::length(a(ball.centre)) + norm(a.linear) * (glm::length(ball.centre) + ball.radius);
}

/// Largest distance between the places where two maps bring a point of the ball.
double difference(const Affine& a, const Affine& b, const Ball& ball) {
    const Affine d{a.linear - b.linear, a.translation - b.translation};
    return glm::length(d(ball.centre)) + norm(d.linear) * std::max(ball.radius, 0.0);
}

/// From a point to the image of a box: exact if the image is a box, else no more than it is. 0 if the map
/// flattens the box.
double distance_to_box(const Affine& map, const Box& box, Vec3 point) {
    const Mat3& linear = map.linear;
    const Vec3 lengths(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
    const double least = std::min({lengths.x, lengths.y, lengths.z});
    if (box.empty() || !(least > 1e-12 * std::max({lengths.x, lengths.y, lengths.z})) || is_singular(map))
        return 0;
    const Vec3 local = inverse(map)(point);
    const Vec3 outside = glm::max(glm::max(box.min - local, local - box.max), Vec3(0.0));
    const auto cosine = [&](int i, int j) {
        return std::abs(glm::dot(linear[i], linear[j])) / (lengths[i] * lengths[j]);
    };
    const bool upright = std::max({cosine(0, 1), cosine(0, 2), cosine(1, 2)}) < 1e-9;
    return upright ? glm::length(outside * lengths) * (1 - 1e-6)
                   : glm::length(outside) * singular_values(linear).z;
}

} // namespace

Neighbourhood::Neighbourhood(const Graph& graph, const Components& components,
                             const std::vector<ObjectBounds>& bounds, std::optional<unsigned> steps,
                             WorkMeter& meter)
    : graph_(graph), components_(components), bounds_(bounds), steps_(steps), meter_(meter) {
    own_.object = graph.root;
}

double Neighbourhood::radius(const NearPiece& piece) const {
    return norm(piece.frame_from_piece.linear) * std::max(bounds_[piece.object].ball.radius, 0.0);
}

/// Nothing where no level is left for it.
std::optional<NearPiece> Neighbourhood::child(const NearPiece& piece, std::uint32_t number) {
    const Instance& instance = graph_.objects[piece.object].instances[number];
    const PathState path =
        graftal::descend({piece.object, piece.frame_from_piece, piece.tint, piece.material, piece.levels},
                         instance, components_);
    NearPiece child{path.object, path.world_from_object, piece.error, path.tint, path.material, path.levels};
    child.error += rounding * reach_of(child.frame_from_piece, bounds_[instance.master].ball);
    if (steps_ && child.levels > *steps_) return std::nullopt;
    child.way = ways_.add(piece.way, {piece.object, number});
    return child;
}

bool Neighbourhood::in_reach(const NearPiece& piece, Vec3 focus, double reach) const {
    const ObjectBounds& bounds = bounds_[piece.object];
    if (graph_.objects[piece.object].primitive == PrimitiveKind::plane) {
        const Mat3& linear = piece.frame_from_piece.linear;
        const Vec3 normal = glm::cross(linear[2], linear[0]);
        const double length = glm::length(normal);
        if (!(length > 0)) return true;
        const double distance = glm::dot(normal, focus - piece.frame_from_piece.translation) / length;
        return std::abs(distance) <= reach + piece.error;
    }
    if (bounds.unbounded) return true;
    if (bounds.ball.empty()) return false;
    const double distance = glm::distance(piece.frame_from_piece(bounds.ball.centre), focus);
    if (distance > radius(piece) + reach + piece.error) return false;
    return distance_to_box(piece.frame_from_piece, bounds.box, focus) <= reach + piece.error;
}

bool Neighbourhood::divisible(const NearPiece& piece) const {
    const Object& object = graph_.objects[piece.object];
    if (object.primitive || object.packed || object.is_combined()) return false;
    // Where no level is left, the object is drawn by what ends it.
    return !steps_ || !components_.unending[piece.object] || piece.levels < *steps_;
}

bool Neighbourhood::keep(NearPiece first, Vec3 focus, double reach, double size,
                         std::vector<NearPiece>& kept) {
    Walk<NearPiece> walk({.meter = &meter_});
    walk.push(std::move(first));
    for (NearPiece piece; walk.next(piece);) {
        if (++looks_ > most_looks) return false;
        if (!in_reach(piece, focus, reach)) continue;
        if (piece.error > lost_share * size) {
            ++lost_;
            continue;
        }
        const bool endless_plane = bounds_[piece.object].unbounded && !components_.unending[piece.object];
        if (!divisible(piece) || (radius(piece) <= size && !endless_plane)) {
            if (kept.size() >= most_pieces) return false;
            kept.push_back(piece);
            continue;
        }
        if (walk.waiting() + kept.size() > 2 * most_pieces) return false;
        const std::size_t parts = graph_.objects[piece.object].instances.size();
        for (std::uint32_t i = 0; i < parts; ++i)
            if (std::optional<NearPiece> part = child(piece, i)) walk.push(std::move(*part));
    }
    return true;
}

Neighbourhood::Outcome Neighbourhood::descend(std::uint32_t instance, Vec3 focus, double reach) {
    looks_ = 0;
    meter_.add();
    const std::vector<Instance>& instances = graph_.objects[own_.object].instances;
    const Instance& step = instances[instance];
    if (is_singular(step.parent_from_child)) return Outcome::flat;
    const Affine new_from_old = inverse(step.parent_from_child);
    if (!is_finite(new_from_old)) return Outcome::flat;
    const std::optional<NearPiece> next = child(own_, instance);
    if (!next) return Outcome::no_level;
    const double enlargement = norm(new_from_old.linear);
    const double size = std::max(bounds_[step.master].ball.radius * (1 + 1e-6), reach);
    std::vector<NearPiece> kept;
    const auto carry_over = [&](NearPiece piece) {
        piece.frame_from_piece = new_from_old * piece.frame_from_piece;
        piece.error = enlargement * piece.error +
                      rounding * (reach_of(piece.frame_from_piece, bounds_[piece.object].ball) +
                                  glm::length(new_from_old.translation));
        return keep(std::move(piece), focus, reach, size, kept);
    };
    for (const NearPiece& piece : others_)
        if (!carry_over(piece)) return Outcome::too_many;
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        if (i == instance) continue;
        std::optional<NearPiece> sibling = child(own_, i);
        if (sibling && !carry_over(std::move(*sibling))) return Outcome::too_many;
    }
    own_ = *next;
    own_.frame_from_piece = {};
    own_.error = 0;
    for (NearPiece& piece : kept)
        snap(piece);
    tidy(kept, size);
    others_ = std::move(kept);
    forget_ways();
    return Outcome::done;
}

bool Neighbourhood::spread(Vec3 focus, double reach, double size) {
    looks_ = 0;
    std::vector<NearPiece> kept;
    if (!keep(own_, focus, reach, size, kept)) return false;
    for (const NearPiece& piece : others_)
        if (!keep(piece, focus, reach, size, kept)) return false;
    others_ = std::move(kept);
    return true;
}

void Neighbourhood::forget_ways() {
    if (ways_.steps() < most_way_steps_) return;
    std::vector<std::uint32_t*> ways = {&own_.way};
    for (NearPiece& piece : others_)
        ways.push_back(&piece.way);
    ways_.keep_only(ways);
    most_way_steps_ = std::max(most_way_steps_, 2 * ways_.steps());
}

void Neighbourhood::snap(NearPiece& piece) {
    std::vector<KnownMap>& of_pair = known_of_pair_[{own_.object, piece.object}];
    const Ball& ball = bounds_[piece.object].ball;
    const double most = most_snapped * bounds_[own_.object].ball.radius;
    const auto snap_to = [&](const KnownMap& map) {
        const double allowed = std::min(most, 4 * (map.error + piece.error));
        const Affine& a = map.frame_from_piece;
        const Affine& b = piece.frame_from_piece;
        // The cheap look first: most differ by far.
        if (glm::distance(a(ball.centre), b(ball.centre)) > allowed || difference(a, b, ball) > allowed)
            return false;
        piece.frame_from_piece = a;
        piece.error = map.error;
        return true;
    };
    for (const KnownMap& map : of_pair)
        if (snap_to(map)) return;
    for (const KnownMap& map : known_)
        if (snap_to(map)) break;
    const KnownMap found{piece.frame_from_piece, piece.error};
    if (of_pair.size() < most_known) of_pair.push_back(found);
    if (known_.size() < most_known) known_.push_back(found);
}

/// Sorts, so that equal surroundings come in one order whatever way led there, and drops what coincides.
void Neighbourhood::tidy(std::vector<NearPiece>& pieces, double size) const {
    struct Keyed {
        std::array<double, 13> key;
        NearPiece piece;
    };
    std::vector<Keyed> keyed;
    for (NearPiece& piece : pieces) {
        Keyed k;
        k.key[0] = piece.object;
        const double grain = 1e-6 * std::max(size, 1e-300);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) {
                const double entry = column == 3 ? piece.frame_from_piece.translation[row] / grain
                                                 : piece.frame_from_piece.linear[column][row] * 1e6;
                k.key[static_cast<std::size_t>(1 + 3 * column + row)] = std::round(entry);
            }
        k.piece = std::move(piece);
        keyed.push_back(std::move(k));
    }
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    pieces.clear();
    const auto coincide = [](const NearPiece& a, const NearPiece& b) {
        return a.object == b.object && a.frame_from_piece == b.frame_from_piece && a.levels == b.levels;
    };
    for (Keyed& k : keyed)
        if (pieces.empty() || !coincide(pieces.back(), k.piece)) pieces.push_back(std::move(k.piece));
}

} // namespace graftal
