#include "compiler/cut/shell_work.h"

#include <algorithm>

#include "compiler/cut/shell_points.h"
#include "compiler/cut/work.h"

namespace graftal {

ShellWork::ShellWork(const CutGraph& cut, const std::vector<BakeRequest>& requests) : cut_(cut) {
    for (const BakeRequest& request : requests)
        if (request.shell) cells_left_ += cells(request);
}

std::uint64_t ShellWork::take(const BakeRequest& shell, double seconds_left) {
    constexpr double share_of_shells = 0.75;
    const double share = share_of_shells * cells(shell) / std::max(cells_left_, cells(shell));
    cells_left_ -= cells(shell);
    return static_cast<std::uint64_t>(share * std::min(seconds_left, 1e6) * WorkRates::shell_points);
}

double ShellWork::cells(const BakeRequest& shell) const {
    const double across = 2 * cut_.nodes[shell.representative].ball.radius * shell.detail_per_unit;
    return std::clamp(across * across, 1.0, most_shell_cells);
}

} // namespace graftal
