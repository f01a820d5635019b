#pragma once

#include <cstdint>
#include <vector>

#include "compiler/cut/bake.h"
#include "compiler/cut/cut_graph.h"

namespace graftal {

/// Deals out the work that shells may take, by the number of their cells: what one leaves is for those after it.
class ShellWork {
  public:
    /// Keeps a reference to the graph.
    ShellWork(const CutGraph& cut, const std::vector<BakeRequest>& requests);

    /// What the shell may take, in moves of a point (shell_points.h), where so many seconds are left (work.h).
    /// The rest is for what else is to be done, and a shell may take somewhat more. Requires to be asked once
    /// for each shell of the requests.
    std::uint64_t take(const BakeRequest& shell, double seconds_left);

  private:
    double cells(const BakeRequest& shell) const;

    const CutGraph& cut_;
    double cells_left_ = 0;
};

} // namespace graftal
