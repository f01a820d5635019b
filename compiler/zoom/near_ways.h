#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "compiler/analysis/contraction.h"

namespace graftal {

/// Paths from the root of a graph, which share their beginnings.
class NearWays {
  public:
    static constexpr std::uint32_t root = UINT32_MAX;

    /// The way that goes on from another by a step.
    std::uint32_t add(std::uint32_t before, const GraphStep& step) {
        steps_.push_back({before, step});
        return static_cast<std::uint32_t>(steps_.size() - 1);
    }

    /// The ways that path() tells of, in this order.
    void set_ends(std::vector<std::uint32_t> ends) { ends_ = std::move(ends); }
    std::size_t size() const { return ends_.size(); }

    /// The steps of end number `index`.
    std::vector<GraphStep> path(std::size_t index) const {
        std::vector<GraphStep> path;
        for (std::uint32_t way = ends_[index]; way != root; way = steps_[way].before)
            path.push_back(steps_[way].step);
        std::ranges::reverse(path);
        return path;
    }

  private:
    struct Step {
        std::uint32_t before = root;
        GraphStep step;
    };
    std::vector<Step> steps_;
    std::vector<std::uint32_t> ends_;
};

} // namespace graftal
