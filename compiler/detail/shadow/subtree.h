#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/shadow/shadow.h"

namespace graftal {

/// Effort for a node.
struct Effort {
    static constexpr int coarse_grid = 64, fine_grid = 128;

    std::size_t pieces = 0; ///< parts of its unfolded subtree
    int grid = coarse_grid; ///< or fine_grid: rows of samples
};

/// A subtree's shadow. Areas are in squares of the radius of the node's ball.
struct SubtreeShadow {
    std::vector<double> area; ///< by direction
    double mean = 0;
    Vec3 centre{0.0};         ///< of what casts it
    std::vector<double> seen; ///< by edge
};

/// Measures the shadows of a graph's subtrees, each unfolded to its largest parts: a primitive casts its own,
/// and what is not unfolded that of its proxy.
class ShadowMeasurer {
  public:
    /// Keeps a reference to the graph, whose proxies may change between two measurements. Looks along
    /// `direction_count` directions: 16 at most.
    ShadowMeasurer(const DetailGraph& cut, std::size_t direction_count);

    const std::vector<Vec3>& along() const { return directions_; }
    /// Bodies drawn so far: what all this costs.
    std::uint64_t draws() const { return coarse_.bodies_drawn() + fine_.bodies_drawn(); }

    /// `ended`: of what is drawn where the node is cut; it has such edges.
    SubtreeShadow measure(NodeId node, const Effort& effort, bool ended = false);

  private:
    struct Part {
        NodeId node = 0;
        Affine place;
        double scale = 1;
        std::uint32_t edge = 0; ///< of the subtree's root, that it hangs on
        std::optional<MaterialId> material;
    };

    struct Body {
        Primitive primitive = PrimitiveKind::sphere;
        Affine place;
        Vec3 centre{0.0};
    };

    std::size_t bodies_of(const Part& part) const;
    void unfold(NodeId root, std::size_t most, bool ended);
    void place_bodies();
    Affine solid_part(const DetailNode& primitive, const Part& part) const;
    double draw(Shadow& shadow, std::vector<double>& seen);

    const DetailGraph& cut_;
    std::vector<Vec3> directions_;
    Shadow coarse_, fine_;
    std::vector<Part> parts_;
    std::vector<Body> bodies_;
    std::vector<double> area_of_part_;
    std::vector<std::pair<double, std::size_t>> order_;
};

} // namespace graftal
