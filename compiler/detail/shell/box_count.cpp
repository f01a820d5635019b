#include "compiler/detail/shell/box_count.h"

#include <algorithm>
#include <cmath>

#include "compiler/detail/shell/point_system.h"

namespace graftal {

namespace {

constexpr double first_boxes_across = 4;
/// Numbers of boxes along a side fit in `index_bits`.
constexpr int most_rows = 19, index_bits = 21;
constexpr std::size_t least_rows = 3;
/// Rows left out where there are enough: the boxes of the first are as wide as the figure's own parts, those
/// of the last as its points lie apart.
constexpr std::size_t coarse_rows = 2, fine_rows = 2;

/// Boxes of one grid that the points meet, of `rows` sides that halve: the last is `finest`.
std::vector<BoxCount::Row> boxes_about(const std::vector<PointSystem::Point>& points, double finest,
                                       int rows) {
    PointSystem::Point least = points.front();
    for (const PointSystem::Point& point : points)
        for (std::size_t axis = 0; axis < 3; ++axis)
            least[axis] = std::min(least[axis], point[axis]);
    std::vector<std::uint64_t> boxes;
    for (const PointSystem::Point& point : points) {
        std::uint64_t box = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            box =
                box << index_bits | static_cast<std::uint64_t>((double{point[axis]} - least[axis]) / finest);
        boxes.push_back(box);
    }
    std::vector<BoxCount::Row> found;
    constexpr std::uint64_t one = (std::uint64_t{1} << index_bits) - 1;
    constexpr std::uint64_t coarser = (one >> 1) * (1 + (one + 1) + (one + 1) * (one + 1));
    for (int row = 0; row < rows; ++row, finest *= 2) {
        std::ranges::sort(boxes);
        boxes.erase(std::unique(boxes.begin(), boxes.end()), boxes.end());
        found.push_back({finest, boxes.size()});
        for (std::uint64_t& box : boxes)
            box = box >> 1 & coarser;
    }
    std::ranges::reverse(found);
    return found;
}

/// Least squares of y = a + b x.
void lay_line(BoxCount& count) {
    if (count.rows.size() < least_rows) return;
    count.rows.resize(count.rows.size() - std::min(fine_rows, count.rows.size() - least_rows));
    const std::size_t rows = count.rows.size();
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

BoxCount count_boxes(const DetailGraph& cut, NodeId node, std::uint32_t steps, std::uint64_t most_work,
                     std::size_t most_boxes) {
    BoxCount count;
    const DetailNode& whole = cut.nodes[node];
    if (whole.unbounded || !(whole.ball.radius > 0)) return count;
    if (std::ranges::any_of(cut.nodes, &DetailNode::is_combined)) return count; // its parts are not all of it
    PointSystem system(cut, most_boxes);
    double side = 2 * whole.ball.radius / first_boxes_across;
    std::vector<PointSystem::Point> points;
    int rows = 0;
    for (; rows < most_rows && system.all_work() < most_work; ++rows, side /= 2) {
        if (!system.run(node, steps, side, {}, most_work - system.all_work())) break;
        points = system.root().points;
    }
    if (!points.empty()) count.rows = boxes_about(points, 2 * side, rows);
    lay_line(count);
    return count;
}

} // namespace graftal
