#include "compiler/import/cfdg/paint_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

namespace graftal::cfdg {

namespace {

/// Logarithms of sizes that differ by less are those of equal sizes.
constexpr double same_size = 1e-6;
/// Equal sizes of translucent shapes, by logarithms: finer ones would need heights that engines round.
constexpr double same_size_of_veils = 1e-3;
/// The share of the picture's size by which sizes of a ratio of e lie apart.
constexpr double flatness = 1e-3;
/// The share of the picture's size from which on both engines see one veil behind another.
constexpr double least_gap_of_veils = 1e-5;
/// Lines of an object, and of all levels, that heights tell apart.
constexpr double most_width = 1e7, most_lines = 1e8;
/// Sizes smaller by more than this logarithm are too small to be seen, and so many sizes of objects are told
/// apart.
constexpr double least_log_seen = 10;
constexpr std::size_t most_sizes = 300'000;
/// The factor by which depths lie farther apart than all other heights.
constexpr double depth_factor = 1000;

bool is_equal(const PaintedLine& line) {
    return line.is_call && std::abs(line.log_shrunk) <= same_size;
}

/// The objects below the root, those that others draw before these.
std::vector<std::size_t> from_the_leaves(const std::vector<std::vector<PaintedLine>>& objects,
                                         std::size_t root) {
    std::vector<std::size_t> order;
    std::vector<bool> seen(objects.size());
    std::vector<std::pair<std::size_t, std::size_t>> path = {{root, 0}};
    seen[root] = true;
    while (!path.empty()) {
        auto& [object, line] = path.back();
        if (line == objects[object].size()) {
            order.push_back(object);
            path.pop_back();
            continue;
        }
        const std::size_t next = objects[object][line++].node;
        if (next == PaintedLine::none || seen[next]) continue;
        seen[next] = true;
        path.emplace_back(next, 0);
    }
    return order;
}

/// The least logarithm by which sizes of seen shapes differ, at least `same_size`: two thirds of a size apart
/// leave room for a million heights of each size, millionths for one. O(n log n) in sizes of objects.
double least_step_of_sizes(const std::vector<std::vector<PaintedLine>>& objects, std::size_t root) {
    std::set<std::pair<std::size_t, std::int64_t>> seen;
    std::vector<std::pair<std::size_t, double>> open = {{root, 0}};
    std::vector<double> sizes = {0};
    while (!open.empty()) {
        const auto [object, size] = open.back();
        open.pop_back();
        for (const PaintedLine& line : objects[object]) {
            if (line.node == PaintedLine::none) continue;
            const double next = size + (line.is_call ? line.log_shrunk : 0);
            if (!(std::abs(next) <= least_log_seen)) continue;
            if (!seen.emplace(line.node, std::llround(next / same_size)).second) continue;
            if (seen.size() > most_sizes) return same_size;
            sizes.push_back(next);
            open.emplace_back(line.node, next);
        }
    }
    std::ranges::sort(sizes);
    double least = least_log_seen;
    for (std::size_t i = 1; i < sizes.size(); ++i)
        if (const double step = sizes[i] - sizes[i - 1]; step > same_size) least = std::min(least, step);
    return std::max(least, same_size);
}

} // namespace

PaintOrder::PaintOrder(const std::vector<std::vector<PaintedLine>>& objects, std::size_t root, double extent,
                       std::size_t veils, bool endless)
    : heights_(objects.size()) {
    const std::vector<std::size_t> order = from_the_leaves(objects, root);
    std::vector<Spread> spreads(objects.size(), {1, 0}); // those of an object that contains itself stay so
    double least_depth = std::numeric_limits<double>::infinity();
    for (const std::size_t object : order) {
        Spread spread;
        double painted = 0, called = 0, before = 0;
        for (const PaintedLine& line : objects[object]) {
            double& sum = line.is_call ? called : painted;
            if (line.is_part) painted = called = std::max(painted, called);
            const Spread below = line.node == PaintedLine::none ? Spread{1, 0} : spreads[line.node];
            heights_[object].push_back(line.beside ? before : sum);
            before = heights_[object].back();
            if (!line.beside) sum += below.width;
            if (line.is_part) called = painted;
            spread.levels = std::max(spread.levels, below.levels + (is_equal(line) ? 1 : 0));
            if (line.depth != 0) least_depth = std::min(least_depth, std::abs(line.depth));
        }
        spread.width = std::max({painted, called, 1.0});
        if (spread.width > most_width) {
            for (double& number : heights_[object])
                number *= most_width / spread.width;
            spread.width = most_width;
            crowded_ = true;
        }
        spreads[object] = spread;
    }
    const double levels = spreads[root].levels + 1;
    const double level = std::min(spreads[root].width, most_lines / levels);
    const double lines = level * levels;
    // Heights of endless paths add up at all sizes, so that they must stay small against the least size.
    const double step = endless ? same_size : 1 - std::exp(-least_step_of_sizes(objects, root));
    const double gap = veils > 0 ? static_cast<double>(veils) * least_gap_of_veils * extent
                                 : flatness * extent * step / lines;
    const double size = veils > 0 ? gap * lines / std::max(step, same_size_of_veils) : flatness * extent;
    // The height and depth that each object reaches, without depths first, and then with them.
    std::vector<std::pair<double, double>> reach(objects.size());
    const auto find_reach = [&](double depth) {
        for (const std::size_t object : order) {
            auto& [low, high] = reach[object] = {0, 0};
            for (std::size_t i = 0; i < objects[object].size(); ++i) {
                const PaintedLine& line = objects[object][i];
                const double at = heights_[object][i] + depth * line.depth;
                const auto [below, above] =
                    line.node == PaintedLine::none ? std::pair(0.0, 0.0) : reach[line.node];
                low = std::min(low, at + below);
                high = std::max(high, at + above);
            }
        }
    };
    for (const std::size_t object : order)
        for (std::size_t i = 0; i < objects[object].size(); ++i) {
            const PaintedLine& line = objects[object][i];
            // A shape of a size s lies at the height -log s; at 1 - s where the heights below it shrink too.
            const double shrunk = endless ? 1 - std::exp(-line.log_shrunk) : line.log_shrunk;
            heights_[object][i] = gap * (heights_[object][i] + (is_equal(line) ? level : 0)) + size * shrunk;
        }
    gap_ = gap;
    if (endless) {
        top_ = 2 * size;
        return;
    }
    find_reach(0);
    if (std::isfinite(least_depth)) {
        const double range = std::max(reach[root].second - reach[root].first, gap);
        const double depth = depth_factor * range / least_depth;
        find_reach(depth);
        for (const std::size_t object : order)
            for (std::size_t i = 0; i < objects[object].size(); ++i)
                heights_[object][i] += depth * objects[object][i].depth;
    }
    top_ = reach[root].second;
}

} // namespace graftal::cfdg
