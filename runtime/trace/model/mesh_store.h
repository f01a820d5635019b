#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/prepare.h"
#include "compiler/primitives/intersect.h"
#include "compiler/support/control.h"
#include "runtime/trace/model/box_tree.h"

namespace graftal {

/// The part of the graph below a node as triangles, in the node's own frame (TraceNode).
struct TraceMesh {
    struct Triangle {
        std::array<Vec3, 3> corners;
        std::array<Vec3, 3> normals; ///< of unit length; all zero: flat
    };
    /// fixed + open * (the colour that the node inherits), without the tints on the way to the node.
    struct Colour {
        Rgb fixed{0.0};
        Rgb open{1.0};
        std::optional<MaterialId> material; ///< nothing: the one that the node inherits
    };

    std::vector<Vec3> vertices;
    std::vector<Vec3> normals; ///< by vertex, of unit length or 0
    std::vector<std::array<std::uint32_t, 3>> corners;
    std::vector<std::uint32_t> colour_of_triangle;
    std::vector<Colour> colours;
    std::vector<BoxNode> boxes;
    std::uint32_t tree = no_tree; ///< its root in `boxes`
    double cell = 0;              ///< side of a cell of the shell: what is smaller is not drawn

    Triangle triangle(std::uint32_t number) const {
        Triangle triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.corners[k] = vertices[corners[number][k]];
            triangle.normals[k] = normals[corners[number][k]];
        }
        return triangle;
    }
};

/// Meets a triangle from either side, as intersect() of intersect.h does a primitive (triangle_ray.h).
bool intersect(const TraceMesh::Triangle& triangle, const Ray& ray, const RayRange& range, PrimitiveHit& hit);

/// Bakes the shells (detail/shell/shell.h) of what rays would not come through, where they come to it, once
/// for each half octave of sizes. Used by many threads.
class MeshStore {
  public:
    /// Keeps a reference. `most_shell_work`: points moved for one shell; it gets coarser by that.
    MeshStore(const PreparedGraph& prepared, std::uint64_t most_shell_work);

    /// The key of the shell of a crowded node where a unit of its frame has this detail (Projection). Keys
    /// tell half octaves apart.
    PieceKind key(NodeId node, const Affine& graph_from_frame, std::uint32_t steps,
                  double detail_per_unit) const;
    /// Notes a shell that was seen with cells of this detail there (Projection).
    void note(double cell_detail);

    /// The largest detail of a cell that was seen so far, 0 if none was: more than 1 where shells had to be
    /// coarser.
    double coarsest_shell() const { return coarsest_shell_; }
    /// Work of shells so far, in moves of a point (WorkRates).
    std::uint64_t shell_work() const { return shell_work_; }
    /// From so much work on, a mesh that is not there yet is not made: mesh() gives an empty one. For looks
    /// that are given up then. Requires that nobody asks for meshes meanwhile.
    void make_until(std::uint64_t most_work) { most_work_ = most_work; }
    /// Once this flag is raised, meshes that are not there yet are empty: what they are for is given up.
    /// Requires that nobody asks for meshes meanwhile.
    void cancel_by(const CancelFlag& cancel) { cancel_ = cancel; }

    /// The node in its frame. The same node, with as many steps, is always asked for in the same frame. The
    /// reference stays.
    const TraceMesh& mesh(const PieceKind& key, const Affine& graph_from_frame);

  private:
    struct Entry {
        std::once_flag baked;
        std::atomic<bool> made = false;
        std::unique_ptr<TraceMesh> mesh;
    };

    std::unique_ptr<TraceMesh> bake_shell(const PieceKind& key, const Affine& graph_from_frame) const;

    const PreparedGraph& prepared_;
    const std::uint64_t most_shell_work_;
    std::mutex mutex_;
    std::uint64_t most_work_ = UINT64_MAX;
    CancelFlag cancel_;
    std::unordered_map<PieceKind, Entry, PieceKindHash> meshes_;
    std::atomic<double> coarsest_shell_ = 0;
    mutable std::atomic<std::uint64_t> shell_work_ = 0;
};

} // namespace graftal
