#include "compiler/analysis/tight_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/smallest_ball.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

namespace {

/// Pieces that hold the ball up are split while their radius is over this part of its.
constexpr double small_piece = 0.02;

/// The part that a ball holds, and is split into.
struct Origin {
    enum class Kind { object, primitive, disc, point };
    Kind kind = Kind::point;
    ObjectId object = 0; ///< of `object` and `primitive`
    Affine place;        ///< root from object; a disc has radius 1 about the y axis at y = 0
};

class Pieces {
  public:
    Pieces(const Graph& graph, const Outers& outers, const CancelFlag& cancel)
        : graph_(graph), outers_(outers), cancel_(cancel) {}

    /// Pieces made so far, those since split included.
    std::size_t made() const { return made_; }
    const std::vector<Ball>& balls() const { return balls_; }

    void add_instances(ObjectId id, const Affine& place) {
        for (const Instance& instance : bounding_instances(graph_.objects[id])) {
            if (outers_[instance.master].empty) continue;
            const bool primitive = graph_.objects[instance.master].primitive.has_value();
            // The ball of a run is as tight as can be, that of an intersection as tight as is known.
            const bool whole_ball = outers_[instance.master].run != nullptr ||
                                    graph_.objects[instance.master].combination == Combination::intersect;
            const Affine inner = place * instance.parent_from_child;
            const Ball whole = outers_[instance.master].ball();
            add({inner(whole.centre), within_range(norm(inner.linear) * whole.radius)},
                {whole_ball  ? Origin::Kind::point
                 : primitive ? Origin::Kind::primitive
                             : Origin::Kind::object,
                 instance.master, inner});
        }
    }

    /// Splits all that touch `about`, or nearly so, and are not small against it, as long as fewer than
    /// `most` were made; false if there are none.
    bool split_supporting(const Ball& about, std::size_t most) {
        std::vector<std::size_t> supporting;
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const Ball& ball = balls_[i];
            if (origins_[i].kind == Origin::Kind::point || ball.radius < small_piece * about.radius) continue;
            if (glm::length(ball.centre - about.centre) + ball.radius >=
                (1 - 0.25 * small_piece) * about.radius)
                supporting.push_back(i);
        }
        for (std::size_t k = supporting.size(); k-- > 0 && made_ < most;) {
            const std::size_t i = supporting[k];
            const Origin origin = origins_[i];
            balls_[i] = balls_.back();
            balls_.pop_back();
            origins_[i] = origins_.back();
            origins_.pop_back();
            split(origin);
        }
        return !supporting.empty();
    }

  private:
    void add(const Ball& ball, const Origin& origin) {
        constexpr std::size_t made_a_look = 1024;
        balls_.push_back(ball);
        origins_.push_back(origin);
        if (++made_ % made_a_look == 0 && cancel_.raised()) throw Cancelled();
    }

    void add_point(Vec3 at) { add({at, 0}, {}); }

    /// The ball about a disc, which sticks out of its plane.
    void add_disc(const Affine& place, double thickness) {
        Mat3 flat = place.linear;
        flat[1] = Vec3(0.0);
        if (thickness > 0)
            add({place.translation, norm(flat) + thickness}, {});
        else
            add({place.translation, norm(flat)}, {Origin::Kind::disc, 0, place});
    }

    void split(const Origin& origin) {
        if (origin.kind == Origin::Kind::object)
            add_instances(origin.object, origin.place);
        else if (origin.kind == Origin::Kind::primitive)
            split_primitive(origin.place, *graph_.objects[origin.object].primitive);
        else
            split_disc(origin.place);
    }

    /// Into the corners of a polygon about it.
    void split_disc(const Affine& place) {
        constexpr int corners = 24;
        const double radius = 1 / std::cos(std::numbers::pi / corners);
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * i / corners;
            add_point(place(radius * Vec3(std::cos(angle), 0, std::sin(angle))));
        }
    }

    /// Into things whose hull holds it.
    void split_primitive(const Affine& place, const Primitive& primitive) {
        for (const HullPiece& piece : traits_of(primitive).hull(primitive)) {
            const Affine inner = place * piece.place;
            const double thickness = piece.thickness > 0 ? piece.thickness * norm(place.linear) : 0;
            if (piece.kind == HullPiece::Kind::disc)
                add_disc(inner, thickness);
            else
                add({inner.translation, thickness}, {});
        }
    }

    const Graph& graph_;
    const Outers& outers_;
    const CancelFlag& cancel_;
    std::vector<Ball> balls_;
    std::vector<Origin> origins_;
    std::size_t made_ = 0;
};

} // namespace

Ball tight_ball(const Graph& graph, const Outers& outers, ObjectId id, std::size_t most_pieces,
                const CancelFlag& cancel) {
    const std::size_t most_in_all = 8 * most_pieces; // the last round may make many more
    Pieces pieces(graph, outers, cancel);
    pieces.add_instances(id, Affine{});
    Ball best = smallest_ball(pieces.balls());
    Ball current = best;
    while (pieces.made() < most_pieces && pieces.split_supporting(current, most_in_all)) {
        current = smallest_ball(pieces.balls());
        if (current.radius < best.radius) best = current;
    }
    return best;
}

} // namespace graftal
