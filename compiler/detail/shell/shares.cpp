#include "compiler/detail/shell/shares.h"

#include <algorithm>

#include "compiler/detail/shell/points.h"
#include "compiler/detail/work.h"

namespace graftal {

ShellShares::ShellShares(const DetailGraph& cut, const std::vector<BakeRequest>& requests) : cut_(cut) {
    for (const BakeRequest& request : requests)
        if (request.shell) cells_left_ += cells(request);
}

ShellShare ShellShares::take(const BakeRequest& shell, double seconds_left, std::size_t triangles_left) {
    constexpr double share_of_shells = 0.75;
    const double share = share_of_shells * cells(shell) / std::max(cells_left_, cells(shell));
    cells_left_ -= cells(shell);
    return {static_cast<std::uint64_t>(share * std::min(seconds_left, 1e6) * WorkRates::shell_points),
            static_cast<std::size_t>(share * static_cast<double>(triangles_left))};
}

double ShellShares::cells(const BakeRequest& shell) const {
    const double across = 2 * cut_.nodes[shell.representative].ball.radius * shell.detail_per_unit;
    return std::clamp(across * across, 1.0, most_shell_cells);
}

} // namespace graftal
