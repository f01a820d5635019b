#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "compiler/cut/prepare.h"
#include "runtime/trace/box_tree.h"
#include "runtime/trace/intersect.h"

namespace graftal {

/// The part of the graph below a node as triangles, in the node's own frame (TraceNode).
struct TraceMesh {
    struct Triangle {
        std::array<Vec3, 3> corners;
        std::array<Vec3, 3> normals; ///< of unit length; all zero: flat
        std::uint32_t colour = 0;
    };
    /// fixed + open * (the colour that the node inherits), without the tints on the way to the node.
    struct Colour {
        Rgb fixed{0.0};
        Rgb open{1.0};
        std::optional<MaterialId> material; ///< nothing: the one that the node inherits
    };

    std::vector<Triangle> triangles;
    std::vector<Colour> colours;
    std::vector<BoxNode> boxes;
    std::uint32_t tree = no_tree; ///< its root in `boxes`
};

/// Meets a triangle from either side, as intersect() of intersect.h does a primitive (T. Moeller and B. Trumbore,
/// "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
bool intersect(const TraceMesh::Triangle& triangle, const Ray& ray, const RayRange& range, PrimitiveHit& hit);

/// Bakes what rays cannot be taken into, where they come to it: maps that crush space have no inverse. Baked
/// as the cut bakes it (bake.h), once for each half octave of sizes. Used by many threads.
class MeshStore {
  public:
    /// Keeps a reference.
    /// `error_px`: as Projection::error_px().
    MeshStore(const PreparedCut& prepared, double error_px);

    /// What one mesh serves.
    struct Key {
        NodeId node = 0;
        std::uint32_t steps = 0;
        int detail = 0; ///< in steps, on a logarithmic scale,
        int pixels = 0; ///< as these
        auto operator<=>(const Key&) const = default;
    };

    /// The node as it is drawn where a unit of its frame has this detail and so many pixels (detail.h).
    Key key(NodeId node, const Affine& graph_from_frame, std::uint32_t steps, double detail_per_unit,
            double pixels_per_unit) const;

    /// The node in its frame. The same node, with as many steps, is always asked for in the same frame. The
    /// reference stays.
    const TraceMesh& mesh(const Key& key, const Affine& graph_from_frame);

  private:
    struct Entry {
        std::once_flag baked;
        std::unique_ptr<TraceMesh> mesh;
    };

    /// Of a unit of the node: where it is drawn no finer.
    double finest_detail(NodeId node) const;
    std::unique_ptr<TraceMesh> bake_mesh(const Key& key, const Affine& graph_from_frame) const;

    const PreparedCut& prepared_;
    const double error_px_;
    std::mutex mutex_;
    std::map<Key, Entry> meshes_;
};

} // namespace graftal
