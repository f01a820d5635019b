#pragma once

#include <cstddef>
#include <unordered_map>

#include "compiler/graph/graph.h"

namespace graftal {

/// The objects of primitives, as Graph::primitive() gives them: each object of the graph is looked at once,
/// so that many primitives take no time for each other.
class PrimitiveObjects {
  public:
    /// The graph must outlive this, and keep its objects.
    explicit PrimitiveObjects(Graph& graph) : graph_(graph) {}

    /// The first object of the graph that is this primitive; else a new one.
    ObjectId of(const Primitive& primitive);

  private:
    Graph& graph_;
    std::unordered_map<Primitive, ObjectId> known_; ///< of the first `searched_` objects
    std::size_t searched_ = 0;
};

} // namespace graftal
