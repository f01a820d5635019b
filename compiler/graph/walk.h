#pragma once

// The one walk over all that unfolds. The caller says what a state is and what lies below it; the walk says
// which comes next and when it ends.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "compiler/support/control.h"

namespace graftal {

/// The limits that end a walk early.
struct WalkLimits {
    std::uint64_t most_visits = UINT64_MAX;
    WorkMeter* meter = nullptr; ///< counts visits, and throws Cancelled; null: nobody does
};

/// The order in which children follow their parent at once, the first of them first.
struct DepthFirst {};

/// States that wait to be visited. `Smaller` orders them, and the largest comes next, as std::priority_queue
/// has it; or it is DepthFirst. Memory: the states that wait.
template<typename State, typename Smaller = DepthFirst> class Walk {
  public:
    explicit Walk(const WalkLimits& limits = {}) : limits_(limits) {}

    /// A state to be visited: a root, or a child of the last that came.
    void push(State state) {
        waiting_.push_back(std::move(state));
        if constexpr (!depth_first) std::push_heap(waiting_.begin(), waiting_.end(), Smaller());
    }

    /// The next state. False at the end, or after the most visits.
    bool next(State& state) {
        if constexpr (depth_first) std::reverse(waiting_.begin() + first_child(), waiting_.end());
        if (waiting_.empty()) return false;
        if (visits_ == limits_.most_visits) {
            stopped_ = true;
            return false;
        }
        ++visits_;
        if (limits_.meter) limits_.meter->add();
        if constexpr (!depth_first) std::pop_heap(waiting_.begin(), waiting_.end(), Smaller());
        state = std::move(waiting_.back());
        waiting_.pop_back();
        first_child_ = waiting_.size();
        return true;
    }

    /// Takes back children of the last state, in their order. Only depth first.
    template<typename Unwanted> void drop_children_if(const Unwanted& unwanted) {
        static_assert(depth_first);
        waiting_.erase(std::remove_if(waiting_.begin() + first_child(), waiting_.end(), unwanted),
                       waiting_.end());
    }
    void drop_children() {
        static_assert(depth_first);
        waiting_.resize(first_child_);
    }

    std::size_t waiting() const { return waiting_.size(); }
    /// The children that the last state has got so far. Only depth first.
    std::size_t children() const { return waiting_.size() - first_child_; }
    std::uint64_t visits() const { return visits_; }
    /// Whether there were more visits than the limit.
    bool stopped() const { return stopped_; }

  private:
    static constexpr bool depth_first = std::is_same_v<Smaller, DepthFirst>;

    std::ptrdiff_t first_child() const { return static_cast<std::ptrdiff_t>(first_child_); }

    WalkLimits limits_;
    std::vector<State> waiting_;  ///< depth first: the next is the last, but the newest children lie in order
    std::size_t first_child_ = 0; ///< of the last state
    std::uint64_t visits_ = 0;
    bool stopped_ = false;
};

} // namespace graftal
