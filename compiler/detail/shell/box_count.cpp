#include "compiler/detail/shell/box_count.h"

#include <algorithm>
#include <cmath>

#include "compiler/detail/shell/point_system.h"

namespace graftal {

namespace {

constexpr double first_boxes_across = 4;
constexpr int most_rows = 40;
/// Rows left out of the line where there are enough: their boxes are as wide as the figure's own parts.
constexpr std::size_t coarse_rows = 2, least_rows = 3;

/// Least squares of y = a + b x.
void lay_line(BoxCount& count) {
    const std::size_t rows = count.rows.size();
    if (rows < least_rows) return;
    count.first_row = std::min(coarse_rows, rows - least_rows);
    const auto n = static_cast<double>(rows - count.first_row);
    const auto x = [&](std::size_t i) { return -std::log2(count.rows[i].side); };
    const auto y = [&](std::size_t i) { return std::log2(static_cast<double>(count.rows[i].boxes)); };
    double mean_x = 0, mean_y = 0;
    for (std::size_t i = count.first_row; i < rows; ++i) {
        mean_x += x(i) / n;
        mean_y += y(i) / n;
    }
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = count.first_row; i < rows; ++i) {
        xx += (x(i) - mean_x) * (x(i) - mean_x);
        xy += (x(i) - mean_x) * (y(i) - mean_y);
        yy += (y(i) - mean_y) * (y(i) - mean_y);
    }
    count.dimension = xy / xx;
    count.error = std::sqrt(std::max(0.0, yy - xy * count.dimension) / (n - 2) / xx);
    count.least_slope = count.most_slope = y(count.first_row + 1) - y(count.first_row);
    for (std::size_t i = count.first_row + 1; i < rows; ++i) {
        count.least_slope = std::min(count.least_slope, y(i) - y(i - 1));
        count.most_slope = std::max(count.most_slope, y(i) - y(i - 1));
    }
}

} // namespace

BoxCount count_boxes(const CutGraph& cut, NodeId node, std::uint32_t steps, std::uint64_t most_work,
                     std::size_t most_boxes) {
    BoxCount count;
    const CutNode& whole = cut.nodes[node];
    if (whole.unbounded || !(whole.ball.radius > 0)) return count;
    if (std::ranges::any_of(cut.nodes, &CutNode::is_combined)) return count; // its parts are not all of it
    PointSystem system(cut, most_boxes);
    double side = 2 * whole.ball.radius / first_boxes_across;
    for (int row = 0; row < most_rows && system.all_work() < most_work; ++row, side /= 2) {
        if (!system.run(node, steps, side, {}, most_work - system.all_work())) break;
        count.rows.push_back({side, system.root().points.size()});
    }
    lay_line(count);
    return count;
}

} // namespace graftal
