#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/cut/cut.h"
#include "compiler/cut/cut_graph.h"
#include "compiler/cut/least_width.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// How large things look. A *detail* is a length measured in units of the error allowed: what measures at
/// most 1 may be culled. Infinite where nothing is culled.
class Projection {
  public:
    /// `near` is the least distance that counts, so that the eye may lie on the model.
    Projection(const View& view, const CutOptions& options, double error_px, double near);

    /// Pixels that one scene unit measures at the ball's nearest point, at most.
    double pixels_per_unit(const Ball& world_ball) const;
    /// The same as far as it matters: less out of the picture, from where only shadows and reflections come.
    double pixels_that_matter(const Ball& world_ball) const;
    /// The detail of one scene unit there; less out of the picture too.
    double detail_per_unit(const Ball& world_ball) const;
    /// No ball within the region has less detail_per_unit().
    double least_detail_per_unit(const Ball& region) const;

    /// Half of what a part measures at least that has no width of its own (least_width.h), in scene units:
    /// where the error is a length, that length. 0 where nothing is culled.
    double least_half_width(const Ball& world_ball) const;
    /// No ball within the region has more.
    double most_half_width(const Ball& region) const;

    /// False if no point of the ball can be in the picture.
    bool sees(const Ball& world_ball) const;
    /// True if the ball is out of the picture, and such parts are to be left out.
    bool drops(const Ball& world_ball) const { return visible_only_ && !sees(world_ball); }

    /// Whether there may be such parts.
    bool drops_any() const { return visible_only_; }

    bool culls() const { return culls_; }
    /// Pixels of a detail of 1; 0 where the error is a length in the scene, so that a detail tells no pixels.
    double error_px() const { return error_world_ > 0 ? 0 : error_px_; }

    /// How much larger parts may be culled that only throw shadows into the picture, or are reflected in it.
    static constexpr double coarser_out_of_sight = 8;

  private:
    Camera camera_;
    bool visible_only_;
    /// Of half the angle of view, across and up; of parallel rays: half the width or height, and 1.
    struct Edge {
        double sine = 0, cosine = 1;
    };
    std::array<Edge, 2> edges_;
    int width_px_;
    double pixels_per_tangent_;
    double near_;
    double error_px_;
    double error_world_;
    bool culls_;
};

// Inlined: the tracer asks for every part that a ray goes into.

inline bool Projection::sees(const Ball& ball) const {
    const Vec3 from_eye = ball.centre - camera_.location;
    const double aside[2] = {std::abs(glm::dot(from_eye, camera_.right)),
                             std::abs(glm::dot(from_eye, camera_.up))};
    const double depth = camera_.orthographic ? 1 : glm::dot(from_eye, camera_.direction);
    for (int i = 0; i < 2; ++i)
        if (aside[i] * edges_[i].cosine - depth * edges_[i].sine > ball.radius) return false;
    return camera_.orthographic || depth >= -ball.radius;
}

inline double Projection::pixels_per_unit(const Ball& ball) const {
    if (camera_.orthographic) return width_px_ / camera_.width;
    const Vec3 from_eye = ball.centre - camera_.location;
    // Off the axis a length looks larger than its distance says, behind the eye its distance decides.
    const double depth = std::max(glm::dot(from_eye, camera_.direction), 0.5 * glm::length(from_eye));
    return pixels_per_tangent_ / std::max(depth - ball.radius, near_);
}

inline double Projection::pixels_that_matter(const Ball& ball) const {
    return pixels_per_unit(ball) / (sees(ball) ? 1 : coarser_out_of_sight);
}

inline double Projection::least_detail_per_unit(const Ball& region) const {
    if (!culls_) return std::numeric_limits<double>::infinity();
    const double hidden = sees({region.centre, -region.radius}) ? 1 : coarser_out_of_sight;
    if (error_world_ > 0) return 1 / (error_world_ * hidden);
    if (camera_.orthographic) return width_px_ / (camera_.width * error_px_ * hidden);
    const Vec3 from_eye = region.centre - camera_.location;
    const double depth = std::max(glm::dot(from_eye, camera_.direction), 0.5 * glm::length(from_eye));
    return pixels_per_tangent_ / (std::max(depth + region.radius, near_) * error_px_ * hidden);
}

inline double Projection::detail_per_unit(const Ball& ball) const {
    if (!culls_) return std::numeric_limits<double>::infinity();
    if (error_world_ > 0) return 1 / (error_world_ * (sees(ball) ? 1 : coarser_out_of_sight));
    return pixels_that_matter(ball) / error_px_;
}

inline double Projection::least_half_width(const Ball& ball) const {
    if (!culls_) return 0;
    return error_world_ > 0 ? error_world_ : std::min(least_half_width_px, error_px_) / pixels_per_unit(ball);
}

inline double Projection::most_half_width(const Ball& region) const {
    if (!culls_ || error_world_ > 0) return error_world_;
    const double px = std::min(least_half_width_px, error_px_);
    if (camera_.orthographic) return px * camera_.width / width_px_;
    const Vec3 from_eye = region.centre - camera_.location;
    const double depth = std::max(glm::dot(from_eye, camera_.direction), 0.5 * glm::length(from_eye));
    return px * std::max(depth + region.radius, near_) / pixels_per_tangent_;
}

/// A node with the levels it has left and the detail of a unit of its frame: what is baked as one mesh.
/// Details are counted in steps of 2^(1/256). A unit and not the node's diameter: where nothing is scaled on
/// the way down, as in most L-systems, nothing is rounded then, and a node makes one kind.
struct PieceKind {
    NodeId node = 0;
    std::uint32_t steps = unlimited_steps;
    std::int32_t unit_step = endless_detail;

    static constexpr std::int32_t endless_detail = INT32_MAX;
    static constexpr std::int32_t tiny = INT32_MIN; ///< small enough to be culled, with all that is in it
    static constexpr int steps_an_octave = 256;

    /// The step of a detail, rounded up.
    static std::int32_t step_of(double detail);
    bool operator==(const PieceKind&) const = default;
};

struct PieceKindHash {
    std::size_t operator()(const PieceKind& kind) const;
};

/// The details of its diameter at which a node is drawn as its shell (shell.h): where it is crowded itself,
/// and not only some small part of it, and not too large for one. Of larger ones the parts are drawn, up to
/// `parted`, from where a ray would meet too many of them.
struct ShellSizes {
    std::uint32_t octaves = 0; ///< bit i: details from 2^i to 2^(i + 1)
    double parted = std::numeric_limits<double>::infinity();

    bool any() const { return octaves != 0 || parted < std::numeric_limits<double>::infinity(); }
    bool has(double detail) const {
        if (detail > parted) return true;
        const int octave = std::ilogb(detail);
        return octave >= 0 && octave < 32 && (octaves >> octave & 1) != 0;
    }
};

/// Estimates what an unfolded piece holds, by one memoised sweep: O(edges of the kinds reached), and of those
/// no more than some millions.
class Weights {
  public:
    /// `cube_triangles`: how many of a cube's triangles stay visible in a mesh, on average. `px`: pixels of a
    /// detail of 1, which decide how finely curved surfaces are meshed; 0: as coarsely as can be.
    /// `error_px`: as Projection::error_px(). `grain`: that of other weights of this graph, which saves
    /// finding it. `most_visits`: kinds that take more, and more than the graph itself, are told apart less
    /// finely.
    explicit Weights(const CutGraph& cut, double cube_triangles = 12, double px = 0, double error_px = 0,
                     int grain = 1, std::uint64_t most_visits = usual_visits);

    static constexpr std::uint64_t usual_visits = 4'000'000;

    struct Weight {
        double triangles = 0;
        double leaves = 0;
        double curved_leaves = 0; ///< those whose meshes only come near them
        double flat_bytes = 0;    ///< of POV-Ray's memory, where every leaf is a placement of its own
        /// Somewhere in it so many leaves lie in each other that nobody could unfold them: what becomes one mesh becomes
        /// a shell (shell.h).
        bool crowded = false;

        Weight& operator+=(const Weight& other);
        friend Weight operator*(double count, Weight weight) {
            for (double* const sum :
                 {&weight.triangles, &weight.leaves, &weight.curved_leaves, &weight.flat_bytes})
                *sum *= count;
            return weight;
        }
    };

    /// Saturates at infinity; kinds that lead back to themselves without losing detail count as one leaf.
    /// Where there are too many kinds, as many unequal scales make them, details are told apart less finely
    /// from then on.
    Weight of(const PieceKind& kind);

    int grain() const { return grain_; }
    /// Edges of kinds followed so far: what all this costs.
    std::uint64_t visits() const { return visits_; }

    /// Kinds are the same where levels do not matter.
    PieceKind normalised(PieceKind kind) const;

    /// Pieces of congruent nodes, equal steps and equal bins share a mesh. A bin is an octave of leaf counts:
    /// in a strictly self-similar model pieces of one bin unfold alike, in others nearly so.
    std::int32_t mesh_bin(const PieceKind& kind);

    /// The step of the detail of its diameter: what is at most 0 may be culled.
    double detail_step(const PieceKind& kind) const;

    /// Requires a node that is no primitive.
    ShellSizes shell_sizes(NodeId node, std::uint32_t steps);
    /// Whether a shell is drawn of the kind, whatever it costs: rays would walk through all that lies in each other.
    bool is_shell(const PieceKind& kind);

    /// True if the kind is drawn by its stop edges or proxy.
    bool is_cut(const PieceKind& kind) const;

    /// The kind an edge leads to, without looking at where the piece lies.
    PieceKind child_kind(const PieceKind& parent, const CutEdge& edge) const;

  private:
    struct Known {
        PieceKind kind;
        Weight weight;
    };
    struct Frame {
        std::uint32_t number = 0;
        std::size_t next_edge = 0;
        Weight sum;
    };

    std::uint32_t number_of(const PieceKind& kind);
    bool weigh(std::uint32_t start);
    bool too_many_kinds() const;
    void forget_kinds();
    Weight of_primitive(const PieceKind& kind) const;
    Weight of_cell(const PieceKind& kind, const RunCell& cell);
    void crowd(const PieceKind& kind, Weight& weight) const;
    void squeeze(const PieceKind& kind, Weight& weight) const;

    const CutGraph& cut_;
    std::vector<double> diameter_step_; ///< by node
    std::vector<double> cut_step_;      ///< by node, of cut_detail()
    std::vector<bool> flat_;            ///< by node
    double cube_triangles_;
    double px_;
    int grain_; ///< details are told apart by so many steps
    std::map<std::pair<NodeId, std::uint32_t>, ShellSizes> shell_sizes_;
    std::vector<Known> known_;
    IdTable numbers_; ///< of known kinds
    std::vector<Frame> stack_;
    std::uint64_t edges_ = 0;                      ///< of the graph
    std::uint64_t most_visits_;
    std::uint64_t visits_ = 0, visits_before_ = 0; ///< all; those when kinds were last forgotten
};

/// Whether so many leaves cannot all lie side by side in a set of this detail across.
bool is_crowded(double leaves, double detail, bool flat);

/// The detail from which down a cullable node is cut, 1 at least: more if its terminal takes its place before it is
/// culled. `error_px`: as Projection::error_px().
double cut_detail(const CutNode& node, double error_px);

/// The rule that ends recursion: no level left, or too small.
bool is_cut(const CutNode& node, std::uint32_t steps, double detail, double error_px);

} // namespace graftal
