#pragma once

#include <cstdint>

#include "compiler/analysis/outer.h"
#include "compiler/graph/graph.h"
#include "compiler/support/control.h"

namespace graftal {

/// A small ball about an object's limit set: the smallest one about the balls of its pieces. Pieces that
/// hold it up are split until they are small against it, or about `most_pieces` were made. A true bound if
/// the outers of the masters are. Requires an object that is no primitive and not empty. The flag ends
/// it by Cancelled.
Ball tight_ball(const Graph& graph, const Outers& outers, ObjectId id, std::size_t most_pieces,
                const CancelFlag& cancel);

} // namespace graftal
