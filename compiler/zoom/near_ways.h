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

    /// Steps of all ways.
    std::size_t steps() const { return steps_.size(); }
    /// Forgets steps that lead to none of these ways, and gives the ways their new numbers.
    void keep_only(const std::vector<std::uint32_t*>& ways) {
        std::vector<std::uint32_t> now(steps_.size(), root);
        for (const std::uint32_t* way : ways)
            for (std::uint32_t step = *way; step != root && now[step] == root; step = steps_[step].before)
                now[step] = 0;
        std::uint32_t count = 0;
        for (std::size_t step = 0; step < now.size(); ++step) {
            if (now[step] == root) continue;
            const std::uint32_t before = steps_[step].before;
            steps_[count] = {before == root ? root : now[before], steps_[step].step};
            now[step] = count++;
        }
        steps_.resize(count);
        for (std::uint32_t* way : ways)
            if (*way != root) *way = now[*way];
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
