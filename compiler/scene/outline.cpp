#include "compiler/scene/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "compiler/analysis/run_bounds.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

namespace {

constexpr std::size_t even_pieces = 1000; // to unfold by size alone
constexpr std::size_t most_pieces = 8000; // in all
constexpr int most_steps_a_direction = 400;
constexpr double small_share = 2e-3; // of the root's size: not unfolded further

struct Piece {
    Affine world_from_object;
    ObjectId object = 0;
    double size = 0; ///< length of the longest axis of its box in the world; 0 if it is not to be unfolded
    Box box;         ///< of the object, or of a range of its run
    std::size_t level = 0, index = 0; ///< of the range (RunBounds)
};

class Outline {
  public:
    Outline(const Graph& graph, const std::vector<ObjectBounds>& bounds) : graph_(graph), bounds_(bounds) {
        add(graph.root, {});
        small_ = pieces_.empty() ? 0 : small_share * pieces_[0].size;
    }

    /// The largest pieces first, so that all get about equally small.
    void unfold_evenly() {
        const auto smaller = [](const Piece& a, const Piece& b) { return a.size < b.size; };
        // Steps are counted too: a chain of single instances has one piece all along.
        for (std::size_t step = 0; step < even_pieces && !pieces_.empty() && pieces_.size() < even_pieces;
             ++step) {
            std::pop_heap(pieces_.begin(), pieces_.end(), smaller);
            const std::size_t before = pieces_.size() - 1;
            if (!unfold_last()) return;
            for (std::size_t i = before + 1; i <= pieces_.size(); ++i)
                std::push_heap(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(i), smaller);
        }
    }

    /// Until the piece that reaches farthest is small.
    void unfold_towards(Vec3 direction) {
        std::vector<double> reaches; // of the pieces
        for (int step = 0; step < most_steps_a_direction && !pieces_.empty(); ++step) {
            for (std::size_t i = reaches.size(); i < pieces_.size(); ++i)
                reaches.push_back(reach(pieces_[i], direction));
            const auto farthest = std::ranges::max_element(reaches) - reaches.begin();
            std::swap(pieces_[static_cast<std::size_t>(farthest)], pieces_.back());
            if (!unfold_last()) return;
            reaches[static_cast<std::size_t>(farthest)] = reaches.back();
            reaches.pop_back();
        }
    }

    std::vector<Vec3> corners() const {
        std::vector<Vec3> points;
        points.reserve(8 * pieces_.size());
        for (const Piece& piece : pieces_) {
            for (const Vec3& corner : hull_points(graph_.objects[piece.object], piece.box))
                points.push_back(piece.world_from_object(corner));
        }
        return points;
    }

  private:
    void add(ObjectId object, const Affine& world_from_object) {
        const Box& box = bounds_[object].box;
        if (box.empty()) return; // nothing but planes
        Piece piece{world_from_object, object, longest_axis(box, world_from_object), box};
        if (graph_.objects[object].primitive || graph_.objects[object].combination == Combination::intersect)
            piece.size = 0;
        if (graph_.objects[object].packed) piece.level = bounds_[object].run->level_count() - 1;
        pieces_.push_back(piece);
    }

    static double longest_axis(const Box& box, const Affine& place) {
        const Vec3 size = box.size();
        double longest = 0;
        for (int axis = 0; axis < 3; ++axis)
            longest = std::max(longest, size[axis] * glm::length(place.linear[axis]));
        return longest;
    }

    /// unfold_last() for a range of a run, whose items are not unfolded further.
    bool unfold_last_range() {
        const Piece piece = pieces_.back();
        const RunBounds& run = *bounds_[piece.object].run;
        const bool items = piece.level == 0;
        const std::size_t width = items ? RunBounds::items_a_range : RunBounds::ranges_a_range;
        const std::size_t count = items ? run.run().size() : run.boxes(piece.level - 1).size();
        const std::size_t first = piece.index * width, end = std::min(first + width, count);
        if (piece.size <= small_ || pieces_.size() + (end - first) > most_pieces) return false;
        pieces_.pop_back();
        for (std::size_t i = first; i < end; ++i) {
            Piece part = piece;
            part.box = items ? box_of(run.run()[i]) : run.boxes(piece.level - 1)[i];
            part.size = items ? 0 : longest_axis(part.box, part.world_from_object);
            part.level = items ? 0 : piece.level - 1;
            part.index = i;
            pieces_.push_back(part);
        }
        return true;
    }

    /// Replaces the last piece by its instances. False if it is small enough or there are too many.
    bool unfold_last() {
        const Piece piece = pieces_.back();
        const Object& object = graph_.objects[piece.object];
        if (object.packed) return unfold_last_range();
        if (piece.size <= small_ || pieces_.size() + object.instances.size() > most_pieces) return false;
        pieces_.pop_back();
        for (const Instance& instance : bounding_instances(object))
            add(instance.master, piece.world_from_object * instance.parent_from_child);
        return true;
    }

    double reach(const Piece& piece, Vec3 direction) const {
        const Box& box = piece.box;
        const Vec3 half = 0.5 * box.size();
        double sum = glm::dot(direction, piece.world_from_object(box.centre()));
        for (int axis = 0; axis < 3; ++axis)
            sum += half[axis] * std::abs(glm::dot(direction, piece.world_from_object.linear[axis]));
        return sum;
    }

    const Graph& graph_;
    const std::vector<ObjectBounds>& bounds_;
    std::vector<Piece> pieces_;
    double small_ = 0;
};

} // namespace

std::vector<Vec3> hull_points(const Object& object, const Box& box) {
    if (box.empty()) return {};
    const auto corners = box.corners();
    if (object.primitive) {
        const std::vector<HullPiece> hull = traits_of(*object.primitive).hull(*object.primitive);
        const bool is_point = std::ranges::all_of(hull, [](const HullPiece& piece) {
            return piece.kind == HullPiece::Kind::point && piece.thickness == 0;
        });
        if (is_point && hull.size() < corners.size()) {
            std::vector<Vec3> points;
            for (const HullPiece& piece : hull)
                points.push_back(piece.place.translation);
            return points;
        }
    }
    return {corners.begin(), corners.end()};
}

std::vector<Vec3> outline(const Graph& graph, const std::vector<ObjectBounds>& bounds,
                          const std::vector<Vec3>& directions) {
    Outline pieces(graph, bounds);
    pieces.unfold_evenly();
    for (const Vec3 direction : directions)
        pieces.unfold_towards(direction);
    return pieces.corners();
}

} // namespace graftal
