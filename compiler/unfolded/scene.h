#pragma once

// A model as all formats read it: shared shapes, and nodes that place each other. It has no cycles: what has
// no end is cut already, by levels or by size. Nodes that are equal are one node, so that 10^30 leaves may be
// a hundred nodes.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/edge_cell.h"
#include "compiler/graph/material.h"
#include "compiler/scene/scene.h"
#include "compiler/support/big_count.h"
#include "compiler/support/control.h"

namespace graftal {

using SceneId = std::uint32_t;

/// A primitive as a mesh (tessellate.h).
struct SceneShape {
    Primitive primitive;
    int fineness = 0;
    auto operator<=>(const SceneShape&) const = default;
};

/// A node within another.
struct ScenePart {
    SceneId node = 0;
    Affine node_from_part;
    PathTint tint;
    std::optional<MaterialId> material;
    double turns = 1; ///< of a leaf: length_in_turns() of its instance
    /// Once looks are resolved: of all leaves below that are colourless (SceneLook).
    std::optional<Rgb> colour;
};

/// The look at the end of a path from the root.
struct SceneLook : Look {
    double turns = 1;
    bool colourless = false; ///< its colour is the one that a part on the way has

    /// Linear, in [0, 1].
    Rgb colour() const;
    bool is_tinted() const { return tint.alpha > 0; }
};

struct SceneNode {
    std::string name;                     ///< of the model's object; not unique
    std::optional<std::uint32_t> shape;   ///< a leaf, which has no parts
    std::vector<ScenePart> parts;         ///< in the order of the model
    MeanColour whole{Rgb(0.0), 1};        ///< its look from afar
    MeanColour mean{Rgb(0.0), 1};         ///< its colour from the one that it inherits
    std::shared_ptr<const EdgeCell> cell; ///< in place of parts
    double errors_per_unit = 1;           ///< of a cell: decides how fine its shapes are
    SceneLook look;                       ///< of a leaf, once looks are resolved (looks.h)
};

struct UnfoldedScene {
    std::vector<SceneShape> shapes;
    std::vector<SceneNode> nodes;
    std::vector<SceneId> masters_first; ///< all nodes, parts before what holds them
    SceneId root = 0;
    std::vector<Material> materials;
    std::map<SceneShape, SceneId> leaves; ///< by shape: what the parts of cells lead to
    bool one_mesh = false;                ///< of a primitive: shapes are told apart by that alone
    double tolerance_errors = 0.4;        ///< largest error of a mesh, in errors
    Box bounds;                           ///< of the model's limit set
    bool left_out_planes = false;         ///< they have no end, so no mesh
    std::uint64_t thickened = 0;          ///< parts that a map had left no thickness
    bool culled = false;                  ///< parts are left out for their size

    /// The key of `leaves` for a primitive of which `errors_per_unit` measure a unit.
    SceneShape shape_for(const Primitive& primitive, double errors_per_unit) const;
    /// The mesh that suits it.
    int fineness(const Primitive& primitive, double errors_per_unit) const;
};

/// Calls `visit(part)` on the parts of a node in their order, those of its cell too.
template<typename Visit> void for_each_part(const UnfoldedScene& scene, const SceneNode& node, Visit&& visit);

/// Sets masters_first. False if some node leads back to itself.
bool sort_masters_first(UnfoldedScene& scene);

/// The sum over all leaves below the root, where a leaf of each shape counts so much.
BigCount sum_over_leaves(const UnfoldedScene& scene,
                         const std::function<std::uint64_t(const SceneShape&)>& value);

struct SceneCounts {
    BigCount leaves, triangles, vertices;
    std::size_t nodes = 0;
    std::uint64_t parts = 0;
    unsigned depth = 0; ///< parts on the longest way from the root to a leaf
};
SceneCounts count(const UnfoldedScene& scene);

/// "1024", or "1.07e+30" of a number with more than 15 digits.
std::string in_words(const BigCount& number);

struct SceneLeaf {
    SceneId node = 0;
    std::uint32_t shape = 0;
    Affine world_from_shape;
    SceneLook look;
};

/// Visits the leaves below a node, depth first in the order of the parts, looks composed on the way from
/// `look` on. Stops and returns false when `visit` does. Memory O(depth).
bool walk_leaves(const UnfoldedScene& scene, SceneId from, const Affine& world_from_node,
                 const SceneLook& look, const std::function<bool(const SceneLeaf&)>& visit);

/// The look one part further.
SceneLook look_through(const UnfoldedScene& scene, const SceneLook& look, const SceneNode& node,
                       const ScenePart& part);

// Inlined.

template<typename Visit>
void for_each_part(const UnfoldedScene& scene, const SceneNode& node, Visit&& visit) {
    for (const ScenePart& part : node.parts)
        visit(part);
    if (!node.cell) return;
    node.cell->for_each([&](const CellEdge& edge) {
        ScenePart part;
        part.node =
            scene.leaves.at(scene.shape_for(edge.shape.primitive(), node.errors_per_unit * edge.stretch));
        part.node_from_part = edge.node_from_child;
        part.material = edge.material;
        visit(part);
    });
}

} // namespace graftal
