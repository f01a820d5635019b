#pragma once

#include <cstdint>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// A set covered by boxes of several sides (K. Falconer, "Fractal Geometry", 3.1).
struct BoxCount {
    struct Row {
        double side = 0; ///< in the node's units
        std::uint64_t boxes = 0;
    };
    std::vector<Row> rows;     ///< each side half of that before it
    std::size_t first_row = 0; ///< of those that the line is laid through; the ones before it are too coarse
    double dimension = 0;      ///< slope of log boxes over log 1/side
    double error = 0;          ///< its standard error
    double least_slope = 0, most_slope = 0; ///< between two rows that follow each other
};

/// Counts boxes of one grid that the node meets, by points of its unfolding (PointSystem) that lie a
/// quarter of the smallest boxes apart; so it misses boxes that the node hardly enters. Points get closer
/// until `most_work` moves of one (WorkRates::shell_points) or `most_boxes` points end that. A solid counts
/// by its surface. No rows for an unbounded node, and no slope from less than three rows. Requires a bounded
/// radius.
BoxCount count_boxes(const DetailGraph& cut, NodeId node, std::uint32_t steps, std::uint64_t most_work,
                     std::size_t most_boxes = 4'000'000);

} // namespace graftal
