#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "compiler/support/counter_random.h"

namespace graftal::cfdg {

/// The random numbers of one rule, a function of its key alone.
class Draws {
  public:
    using result_type = std::uint64_t;
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

    explicit Draws(std::uint64_t key = 0) : random_(key) {}

    result_type operator()() { return random_(++drawn_); }
    double unit() { return CounterRandom::unit((*this)()); }
    std::uint64_t drawn() const { return drawn_; }

    /// A number of the distribution `rand::NAME` or `randint::NAME`; nothing if there is none of this name,
    /// or the numbers are none that it takes.
    std::optional<double> distribution(std::string_view name, std::span<const double> numbers);

  private:
    CounterRandom random_;
    std::uint64_t drawn_ = 0;
};

} // namespace graftal::cfdg
