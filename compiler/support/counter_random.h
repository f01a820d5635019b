#pragma once

#include <cstddef>
#include <cstdint>

namespace graftal {

/// Random numbers that are a function of key and counter alone (Salmon et al. 2011, "Parallel random
/// numbers: as easy as 1, 2, 3"), so that none depends on those drawn before. They are mixed as in
/// splitmix64 (Steele, Lea and Flood 2014).
class CounterRandom {
  public:
    explicit constexpr CounterRandom(std::uint64_t seed) : key_(mixed(seed)) {}

    /// Uniform over all 64 bits.
    constexpr std::uint64_t operator()(std::uint64_t counter) const { return mixed(key_ + golden * counter); }
    /// Another sequence for each counter.
    constexpr CounterRandom sequence(std::uint64_t counter) const { return CounterRandom((*this)(counter)); }

    /// A draw of 64 bits as a number of [0, 1).
    static constexpr double unit(std::uint64_t draw) { return static_cast<double>(draw >> 11) * 0x1p-53; }
    /// A number that has nothing to do with those of other x.
    static constexpr std::uint64_t scrambled(std::uint64_t x) { return mixed(x + golden); }

  private:
    static constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;

    static constexpr std::uint64_t mixed(std::uint64_t x) {
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
        return x ^ (x >> 31);
    }

    std::uint64_t key_;
};

/// Random numbers one after the other.
class RandomStream {
  public:
    explicit RandomStream(CounterRandom random) : random_(random) {}
    /// One of the sequences of a seed.
    RandomStream(std::uint64_t seed, std::uint64_t sequence)
        : RandomStream(CounterRandom(seed).sequence(sequence)) {}

    std::uint64_t bits() { return random_(count_++); }
    /// A number of [0, 1).
    double unit() { return CounterRandom::unit(bits()); }
    double between(double least, double most) { return least + (most - least) * unit(); }
    /// Requires count > 0.
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(unit() * static_cast<double>(count));
    }

  private:
    CounterRandom random_;
    std::uint64_t count_ = 0;
};

} // namespace graftal
