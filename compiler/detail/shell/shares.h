#pragma once

#include <cstdint>
#include <vector>

#include "compiler/detail/bake.h"
#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// Limits of one shell.
struct ShellShare {
    std::uint64_t work = 0; ///< in moves of a point (points.h)
    std::size_t triangles = 0;
};

/// Deals out the work and the triangles that shells may take, by the number of their cells: what one leaves
/// is for those after it.
class ShellShares {
  public:
    /// Keeps a reference to the graph.
    ShellShares(const DetailGraph& cut, const std::vector<BakeRequest>& requests);

    /// The limits of the shell, where these seconds (work.h) and triangles are left. The rest is for other
    /// work, and a shell may take somewhat more. Requires to be asked once for each shell of the requests.
    ShellShare take(const BakeRequest& shell, double seconds_left, std::size_t triangles_left);

  private:
    double cells(const BakeRequest& shell) const;

    const DetailGraph& cut_;
    double cells_left_ = 0;
};

} // namespace graftal
